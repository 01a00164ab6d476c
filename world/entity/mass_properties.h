/* Mass properties of a kind: a box of uniform density with the kind's length, height and width.
 * Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_MASS_PROPERTIES_H
#define JOLON_WORLD_ENTITY_MASS_PROPERTIES_H

#include "world/entity/kind.h"
#include "world/maths/rotation.h"

#define GRAVITY_MPS2 9.80665

/* Share of its weight that a vehicle's tyres or tracks can bear along the ground. */
#define GROUND_GRIP 0.7

struct mass_properties {
    double mass_kg;
    struct vec3 moment; /* [kg m2] about body axes through the centre: x forward, y up, z right */
    double centre_m;    /* height of the centre of mass over the position */
};

/* The position is on the ground below land vehicles and fixed objects, on the water line of ships
 * and in the middle of aircraft and munitions (docs/scenario.md, "Models"). The centre of mass of
 * a land vehicle is at the kind's centre_height_m above it, that of a fixed object at half the
 * height, and that of others at it; a ship floats with its mass about the water line. */
struct mass_properties mass_properties_of(const struct kind *kind);

/* [1/(kg m2)] on world axes, for this rotation of the body (world = turn * body): symmetric to the
 * bit. */
struct mat3 mass_properties_inverse_world(const struct mass_properties *properties,
                                          const struct mat3 *turn);

#endif
