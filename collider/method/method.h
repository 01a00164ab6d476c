/* Ways to find which bodies can meet in a frame. Each is a row of METHODS
 * (world/collision_models.h) and a file:
 *
 *     method_swept      strips of gridsquares, sort and sweep (the broad phase): the default
 *     method_occupancy  Uchiki, Ohashi and Tokoro 1983: bodies claim the space that they occupy
 *     method_hopcroft   Hopcroft, Schwartz and Sharir 1983: sort and sweep over the whole world
 *     method_brute      every pair: the oracle of the others
 *     method_npsnet2    Osborne 1991: gridsquare lists, 100 m test, radii, rays
 *     method_mps        MPS II: near each other on the map
 *
 * The first four find candidates, whose exact contacts are then found in time; the contacts of all
 * four are equal to the bit. The last two decide by the bodies' positions at the frame's end, and
 * miss bodies that pass through each other within the frame. */
#ifndef JOLON_COLLIDER_METHOD_METHOD_H
#define JOLON_COLLIDER_METHOD_METHOD_H

#include "collider/motion/pair_filter.h"
#include "world/collision_models.h"

struct broad_phase;

/* A method's own memory. */
struct method_workspace;

/* Adds every pair that the method finds, each once, in any order. */
typedef void method_pairs_function(const struct method_input *input,
                                   struct method_workspace *workspace, struct pair_list *pairs);

struct method_functions {
    method_pairs_function *pairs;
    enum method_test test;
};

/* method_swept_pairs() and so on, each in its own file. */
#define X(name, value, word, test, text) method_pairs_function method_##word##_pairs;
METHODS(X)
#undef X

const struct method_functions *method_of(enum method method);

/* Returns true for a method that decides by the positions at the frame's end. The pairs of the
 * others are candidates. */
bool method_discrete(enum method method);

/* Returns the memory that any method needs in this world, or NULL with errno ENOMEM. broad is where
 * the method "swept" takes its pairs from; it stays the caller's. */
struct method_workspace *method_workspace_create(const struct world *world,
                                                 const struct broad_phase *broad);
void method_workspace_free(struct method_workspace *workspace);
const struct broad_phase *method_broad_phase(const struct method_workspace *workspace);

/* Returns room for count items of size bytes in the workspace's block of this number (of
 * METHOD_BLOCKS). The blocks from METHOD_BODIES on belong to method_bodies(). The block's former
 * contents may be lost. METHOD_BODY_BYTES for each body and one for each gridsquare are reserved; a
 * block that needs more grows. */
#define METHOD_BLOCKS     13
#define METHOD_BODIES     9
#define METHOD_BODY_BYTES 64u
void *method_block(struct method_workspace *workspace, uint32_t block, size_t count, size_t size);

/* All bodies that can collide in the frame, in one numbering: first the used rows, then the
 * standing fixed objects in gridsquares touched by a row that tests fixed objects. */
struct method_bodies {
    uint32_t count, moving;     /* the first moving are rows */
    const uint32_t *what;       /* [count] a row, or a fixed object with PAIR_FIXED */
    const struct path_box *box; /* [count] a fixed object's is slightly larger than the object */
    const uint8_t *tests_fixed; /* [moving] */
};

/* Fills bodies with arrays in the workspace, which are valid until the next call of
 * method_bodies(). */
void method_bodies(const struct method_input *input, struct method_workspace *workspace,
                   struct method_bodies *bodies);

/* Adds the pair of two bodies if they can meet, by the same predicates as method_brute.c. Two fixed
 * objects cannot. */
void method_meet(const struct method_input *input, const struct method_bodies *bodies, uint32_t i,
                 uint32_t j, struct pair_list *pairs);

#endif
