/* The methods of collision detection and the responses: one row each. The enums, the words of a
 * scenario and the registries in collider/method and collider/response all follow from these rows.
 *
 * A row is X(NAME, value, word, text), with a METHOD_TESTS_... before the text for a method. Images
 * contain the value, and docs/scenario.md the text. */
#ifndef JOLON_WORLD_COLLISION_MODELS_H
#define JOLON_WORLD_COLLISION_MODELS_H

/* What a method tests of a frame. */
enum method_test {
    METHOD_TESTS_NEAR,  /* the whole paths of bodies that come near others */
    METHOD_TESTS_PATHS, /* the whole paths of all bodies */
    METHOD_TESTS_END,   /* the positions of bodies at its end */
};

/* Swept, occupancy, hopcroft and brute find the same collisions. npsnet2 and mps test only the end
 * of the frame, as published. */
#define METHODS(X)                                                                                 \
    X(SWEPT, 0, swept, METHOD_TESTS_NEAR,                                                          \
      "Tests the whole path of a frame, so that no collision is missed at any speed. Bodies are "  \
      "sorted by gridsquare.")                                                                     \
    X(NPSNET2, 1, npsnet2, METHOD_TESTS_END,                                                       \
      "The thesis's own method: lists of gridsquares, the 100 m test, radii and rays, all at the " \
      "end of the frame. Bodies that pass through each other between two frames are missed.")      \
    X(MPS, 2, mps, METHOD_TESTS_END,                                                               \
      "The method of MPS, which came before NPSNET: two vehicles collide when they are near each " \
      "other on the map at the end of the frame. Fixed objects are not tested.")                   \
    X(OCCUPANCY, 3, occupancy, METHOD_TESTS_PATHS,                                                 \
      "Tests the whole path of a frame; bodies claim the space that they occupy. It finds what "   \
      "`swept` finds, more slowly.")                                                               \
    X(HOPCROFT, 4, hopcroft, METHOD_TESTS_PATHS,                                                   \
      "Tests the whole path of a frame; it sorts all bodies of the world together. It finds what " \
      "`swept` finds, more slowly.")                                                               \
    X(BRUTE, 5, brute, METHOD_TESTS_PATHS,                                                         \
      "Tests the whole path of a frame for every pair of bodies. It finds what `swept` finds, "    \
      "more slowly.")

#define RESPONSE_MODELS(X)                                                                         \
    X(IMPULSE, 1, impulse, "Momentum is conserved. The energy that is lost causes damage.")        \
    X(FIGURE8, 0, figure8, "The rules of the thesis's Figure 8.")                                  \
    X(SPRING, 3, spring, "Bodies are pushed apart by the stiffness of their skins.")               \
    X(MPS, 4, mps,                                                                                 \
      "Both vehicles are destroyed. Fixed objects are not damaged, and vehicles pass through "     \
      "them.")                                                                                     \
    X(NONE, 2, none,                                                                               \
      "Collisions are only reported. Vehicles pass through each other and through fixed objects.")

/* clang-format off */
#define X(name, value, word, test, text) METHOD_##name = (value),
enum method { METHODS(X) };
#undef X
#define X(name, value, word, text) MODEL_##name = (value),
enum response_model { RESPONSE_MODELS(X) };
#undef X
#define X(...) +1
enum { METHOD_COUNT = 0 METHODS(X), MODEL_COUNT = 0 RESPONSE_MODELS(X) };
#undef X
/* clang-format on */

#endif
