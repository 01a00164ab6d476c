/* Data for placing fixed objects: the kinds of each class, the roads by gridsquare, the objects so
 * far. Private to the making of Table 1's objects. */
#ifndef JOLON_WORLD_MAKING_OBJECT_PLACEMENT_H
#define JOLON_WORLD_MAKING_OBJECT_PLACEMENT_H

#include "world/terrain/fixed.h"
#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

struct road_point;

/* Free ground between a road's middle and an object's sphere [m]. */
#define OBJECT_PLACEMENT_ROAD_FREE_M 8.0

/* Least distance of objects from the world's edge [m]. */
#define OBJECT_PLACEMENT_EDGE_FREE_M 2.0

/* Largest deviation of a tree's or bush's size from its kind's, as a share. */
#define OBJECT_PLACEMENT_SIZE_SPREAD 0.2

struct object_placement {
    const struct terrain *terrain;
    const struct kind *kinds;
    const struct road_point *roads;
    uint32_t road_count;
    uint64_t seed;
    uint16_t of_class[OBJECT_CLASS_COUNT][KIND_COUNT_MAX]; /* low kinds first */
    uint32_t class_size[OBJECT_CLASS_COUNT];
    double grown_m;               /* largest radius of a tree or bush */
    uint32_t *leg_start;          /* [terrain->squares.count + 1] into legs */
    uint32_t *legs;               /* road points whose leg to the next comes near a square */
    struct fixed_object *objects; /* the caller's */
    uint32_t used;
};

/* 0; -1 with errno ENOMEM, or EINVAL when a class has no kind. */
int object_placement_init(struct object_placement *placement, const struct terrain *terrain,
                          const struct kind *kinds, uint32_t kind_count,
                          const struct road_point *roads, uint32_t road_count, uint64_t seed,
                          struct fixed_object *objects);
void object_placement_free(struct object_placement *placement);

/* Returns a kind of the class for a place: low kinds in the valleys, tall ones on the heights,
 * mixed by place and by chance, which number determines. */
uint16_t object_placement_mixed_kind(const struct object_placement *placement,
                                     enum object_class object_class, double x, double z,
                                     uint32_t number);

/* Returns true if an object of this radius may stand at (x, z): dry, off the roads, within the
 * world. */
bool object_placement_allows(const struct object_placement *placement, double x, double z,
                             double radius_m);

/* Returns true if its sphere is a metre away from the first count objects. */
bool object_placement_clear(const struct object_placement *placement, uint32_t count, double x,
                            double z, double radius_m);

/* Adds an object of size times its kind's radius and height. */
void object_placement_add(struct object_placement *placement, double x, double z, uint16_t kind,
                          double size);

#endif
