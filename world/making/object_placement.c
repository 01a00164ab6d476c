/* Where fixed objects may stand, and which kinds they are. */
#include "world/making/object_placement.h"

#include "world/maths/maths.h"
#include "world/maths/noise.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

/* Roads within this distance of a square belong to it: more than the largest fixed object [m]. */
#define ROAD_REACH_M 40.0

enum { NOISE_MIX = 1520 };

static double distance2(double x0, double z0, double x1, double z1)
{
    return (x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0);
}

static int sort_kinds(struct object_placement *p, uint32_t kind_count)
{
    for (uint32_t i = 0; i < kind_count; i++) {
        const struct kind *kind = &p->kinds[i];
        if (kind->domain != DOMAIN_FIXED || kind->object_class >= OBJECT_CLASS_COUNT)
            continue;
        uint16_t *list = p->of_class[kind->object_class];
        uint32_t at = p->class_size[kind->object_class]++;
        for (; at > 0 && p->kinds[list[at - 1]].height_m > kind->height_m; at--)
            list[at] = list[at - 1];
        list[at] = (uint16_t)i;
        if (kind->object_class == OBJECT_TREE || kind->object_class == OBJECT_BUSH)
            p->grown_m =
                maths_max(p->grown_m, kind->radius_m * (1.0 + OBJECT_PLACEMENT_SIZE_SPREAD));
    }
    for (int i = 0; i < OBJECT_CLASS_COUNT; i++) {
        if (p->class_size[i] == 0) {
            errno = EINVAL;
            return -1;
        }
    }
    return 0;
}

static struct gridsquare_box leg_box(const struct gridsquares *squares, const struct road_point *a)
{
    const struct road_point *b = a + 1;
    return gridsquare_box_of(
        squares, maths_min(a->x, b->x) - ROAD_REACH_M, maths_min(a->z, b->z) - ROAD_REACH_M,
        maths_max(a->x, b->x) + ROAD_REACH_M, maths_max(a->z, b->z) + ROAD_REACH_M);
}

/* Indexes the legs of roads by the squares near them: counts first, then fills. */
static int index_roads(struct object_placement *p)
{
    const struct gridsquares *squares = &p->terrain->squares;
    uint32_t *fill = calloc(squares->count, sizeof *fill);
    p->leg_start = calloc(squares->count + 1, sizeof *p->leg_start);
    if (!fill || !p->leg_start)
        goto err;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i + 1 < p->road_count; i++) {
            struct gridsquare_box box = leg_box(squares, &p->roads[i]);
            if (p->roads[i].road != p->roads[i + 1].road)
                continue;
            for (int32_t row = box.z0; row <= box.z1; row++) {
                for (int32_t column = box.x0; column <= box.x1; column++) {
                    uint32_t square = gridsquare_index(squares, column, row);
                    if (pass == 0)
                        p->leg_start[square + 1]++;
                    else
                        p->legs[p->leg_start[square] + fill[square]++] = i;
                }
            }
        }
        if (pass == 1)
            break;
        for (uint32_t i = 0; i < squares->count; i++)
            p->leg_start[i + 1] += p->leg_start[i];
        p->legs = malloc((p->leg_start[squares->count] + 1u) * sizeof *p->legs);
        if (!p->legs)
            goto err;
    }
    free(fill);
    return 0;
err:
    free(fill);
    return -1;
}

static bool near_road(const struct object_placement *p, double x, double z, double free_m)
{
    uint32_t square = gridsquare_of(&p->terrain->squares, x, z);
    for (uint32_t k = p->leg_start[square]; k < p->leg_start[square + 1]; k++) {
        const struct road_point *a = &p->roads[p->legs[k]], *b = a + 1;
        double dx = b->x - a->x, dz = b->z - a->z;
        double length = maths_max(dx * dx + dz * dz, 1e-9);
        double t = ((x - a->x) * dx + (z - a->z) * dz) / length;
        t = maths_clamp(t, 0.0, 1.0);
        if (distance2(x, z, a->x + dx * t, a->z + dz * t) < free_m * free_m)
            return true;
    }
    return false;
}

int object_placement_init(struct object_placement *p, const struct terrain *terrain,
                          const struct kind *kinds, uint32_t kind_count,
                          const struct road_point *roads, uint32_t road_count, uint64_t seed,
                          struct fixed_object *objects)
{
    *p = (struct object_placement){.terrain = terrain,
                                   .kinds = kinds,
                                   .roads = roads,
                                   .road_count = road_count,
                                   .seed = seed,
                                   .objects = objects};
    if (sort_kinds(p, kind_count) == 0 && index_roads(p) == 0)
        return 0;
    object_placement_free(p);
    return -1;
}

void object_placement_free(struct object_placement *p)
{
    free(p->leg_start);
    free(p->legs);
    p->leg_start = NULL;
    p->legs = NULL;
}

uint16_t object_placement_mixed_kind(const struct object_placement *p,
                                     enum object_class object_class, double x, double z,
                                     uint32_t number)
{
    double height = terrain_base_height(p->terrain, x, z);
    double place = 0.45 * noise_at(p->seed + NOISE_MIX, x / 1700.0, z / 1700.0);
    double chance = 0.7 * random_unit(p->seed, 1, number, RANDOM_OBJECT_SHAPE) - 0.35;
    double share = maths_clamp(height / 1100.0 + place + chance, 0.0, 0.999);
    return p->of_class[object_class][(uint32_t)(share * p->class_size[object_class])];
}

bool object_placement_allows(const struct object_placement *p, double x, double z, double radius_m)
{
    const double far = p->terrain->squares.world_m - OBJECT_PLACEMENT_EDGE_FREE_M;
    return x > OBJECT_PLACEMENT_EDGE_FREE_M && z > OBJECT_PLACEMENT_EDGE_FREE_M && x < far &&
           z < far && !cover_is_water(terrain_cover(p->terrain, x, z)) &&
           !near_road(p, x, z, OBJECT_PLACEMENT_ROAD_FREE_M + radius_m);
}

bool object_placement_clear(const struct object_placement *p, uint32_t count, double x, double z,
                            double radius_m)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct fixed_object *o = &p->objects[i];
        double reach = (double)o->radius_m + radius_m + 1.0;
        if (distance2(x, z, o->x, o->z) < reach * reach)
            return false;
    }
    return true;
}

void object_placement_add(struct object_placement *p, double x, double z, uint16_t kind,
                          double size)
{
    const struct kind *k = &p->kinds[kind];
    uint64_t turn = random_u64(p->seed, 2, p->used, RANDOM_OBJECT_SHAPE);
    p->objects[p->used++] = (struct fixed_object){
        .x = x,
        .z = z,
        .y = (float)terrain_base_height(p->terrain, x, z),
        .radius_m = (float)(k->radius_m * size),
        .height_m = (float)(k->height_m * size),
        .kind = kind,
        .turn = (uint16_t)(turn >> 48),
    };
}
