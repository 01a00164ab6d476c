/* Debris that moves: what comes loose when a vehicle fells a fixed object. A bounded list in the
 * head of the state, in the order in which they fell. Written by the collider only. */
#ifndef JOLON_WORLD_ENTITY_DEBRIS_H
#define JOLON_WORLD_ENTITY_DEBRIS_H

#include <stdint.h>

#define DEBRIS_MAX 64u /* in a world at one time */

struct debris {
    double x, z;         /* [m] its centre of mass on the map; it lies on the ground */
    float vx, vz;        /* [m/s] */
    float heading_rad;   /* of a trunk: from its foot to its top, clockwise from north */
    float spin_rps;      /* of a trunk, clockwise */
    float mass_kg;       /* > 0 */
    float half_length_m; /* of a trunk; 0: a heap */
    float radius_m;      /* of the heap, or half the width of the trunk with its branches */
    uint32_t object;     /* the fixed object that it was part of */
    uint32_t fell_tick;
    uint32_t unused; /* 0 */
};

_Static_assert(sizeof(struct debris) % 8 == 0, "no padding at the end");

#endif
