/* Mass properties of a kind: a box of even density, as long, high and wide as the kind says. Pure;
 * any thread. */
#ifndef JOLON_WORLD_ENTITY_MASS_PROPERTIES_H
#define JOLON_WORLD_ENTITY_MASS_PROPERTIES_H

#include "world/entity/kind.h"
#include "world/maths/rotation.h"

struct mass_properties {
    double mass_kg;
    struct vec3 moment; /* [kg m2] about body axes through the centre: x forward, y up, z right */
    double centre_m;    /* height of the centre of mass over the position */
};

/* The position is on the ground below what stands on it, on the water line of ships and in the
 * middle of what flies (docs/scenario.md, "Models"): the centre is half the height above it on
 * land, and at it elsewhere; a ship floats with its masses about the water line. */
struct mass_properties mass_properties_of(const struct kind *kind);

/* [1/(kg m2)] on world axes, of a body turned so (world = turn * body): symmetric to the bit. */
struct mat3 mass_properties_inverse_world(const struct mass_properties *properties,
                                          const struct mat3 *turn);

/* The spin that keeps angular momentum when a body that nothing holds has turned from before to
 * after with this spin [rad/s, world axes]. */
struct vec3 mass_properties_carried(const struct mass_properties *properties,
                                    const struct mat3 *before, struct vec3 spin_rps,
                                    const struct mat3 *after);

#endif
