/* Table 1's objects on the generated ground: poles along a road, buildings at the Mission and
 * Jolon, rocks in the hills; then trees and bushes (plant_placement.h). */
#include "world/making/generate.h"

#include "world/making/geography.h"
#include "world/making/plant_placement.h"
#include "world/maths/maths.h"
#include "world/making/object_placement.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define POLE_SPACING_M 55.0
#define POLE_OFF_M     11.0 /* from the road's middle */
#define POLE_COUNT     54
#define POLE_START_M   700.0 /* from the road's beginning, a junction, and between tries */
#define POLE_STARTS    5
#define POLE_LINES     4096u /* tried across the country where no road has room */

#define TRIES      16000u /* places tried for one object: out to some 300 m */
#define ROCK_TRIES 200u

/* Table 1 (Osborne 1991, p. 8). */
const uint32_t generate_table1[OBJECT_CLASS_COUNT] = {
    [OBJECT_TREE] = 30813,      [OBJECT_BUSH] = 9422,    [OBJECT_POLE] = POLE_COUNT,
    [OBJECT_BUILDING] = 3,      [OBJECT_WATERTOWER] = 1, [OBJECT_OTHER_MANMADE] = 5,
    [OBJECT_OTHER_NATURAL] = 5,
};

/* Adds one object at the nearest clear, dry place to (x, z): in rings of growing radius. */
static int add_near(struct object_placement *p, enum object_class of, uint32_t number, double x,
                    double z)
{
    uint16_t kind = p->of_class[of][number % p->class_size[of]];
    double radius = p->kinds[kind].radius_m;
    for (uint32_t try = 0; try < TRIES; try++) {
        double away = 2.5 * sqrt((double)try), sine, cosine;
        maths_sincos(2.39996 * try, &sine, &cosine); /* the golden angle: rings fill evenly */
        double px = x + away * cosine, pz = z + away * sine;
        if (object_placement_allows(p, px, pz, radius) &&
            object_placement_clear(p, p->used, px, pz, radius)) {
            object_placement_add(p, px, pz, kind, 1.0);
            return 0;
        }
    }
    errno = ENOSPC;
    return -1;
}

/* Sets the places of a line of poles beside the legs of a road, from start_m on, on its right (side
 * 1) or left (-1). Returns false if the road is too short or a pole is not allowed. */
static bool line_up(const struct object_placement *p, const struct road_point *a,
                    const struct road_point *end, double start_m, double side,
                    double poles[POLE_COUNT][2])
{
    uint32_t done = 0;
    double ahead = start_m;
    for (; a + 1 < end && a[1].road == a->road; a++) {
        double dx = a[1].x - a->x, dz = a[1].z - a->z;
        double length = sqrt(dx * dx + dz * dz), off = side * POLE_OFF_M;
        while (ahead < length) {
            double x = a->x + (dx * ahead - dz * off) / length;
            double z = a->z + (dz * ahead + dx * off) / length;
            if (!object_placement_allows(p, x, z, 0.0))
                return false;
            poles[done][0] = x;
            poles[done][1] = z;
            if (++done == POLE_COUNT)
                return true;
            ahead += POLE_SPACING_M;
        }
        ahead -= length;
    }
    return false;
}

/* Finds the first road, side and beginning along which the poles can stand. */
static bool find_line(const struct object_placement *p, const struct road_point *roads,
                      uint32_t count, double poles[POLE_COUNT][2])
{
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0 && roads[i - 1].road == roads[i].road)
            continue;
        for (int k = 0; k < 2 * POLE_STARTS; k++)
            if (line_up(p, &roads[i], roads + count, POLE_START_M * (1 + k / 2),
                        k % 2 == 0 ? 1.0 : -1.0, poles))
                return true;
    }
    return false;
}

/* Finds a straight line of poles somewhere, where the ground is dry and no road crosses. */
static bool find_open_line(const struct object_placement *p, double poles[POLE_COUNT][2])
{
    const double last = p->terrain->squares.world_m;
    for (uint32_t i = 0; i < POLE_LINES; i++) {
        double x = random_between(p->seed, i, POLE_LINES, RANDOM_OBJECT_X, 0.0, last);
        double z = random_between(p->seed, i, POLE_LINES, RANDOM_OBJECT_Z, 0.0, last);
        double sine, cosine, way_m = POLE_SPACING_M * POLE_COUNT;
        maths_sincos(2.39996 * i, &sine, &cosine);
        const struct road_point line[2] = {{.x = x, .z = z},
                                           {.x = x + way_m * sine, .z = z - way_m * cosine}};
        if (line_up(p, line, line + 2, 0.0, 1.0, poles))
            return true;
    }
    return false;
}

/* Poles beside a road; where no road has room, on the line from Jolon to the Mission, or another
 * one. */
static int add_poles(struct object_placement *p, const double jolon[2], const double mission[2])
{
    struct road_point straight[2] = {
        {.x = maths_as_float(jolon[0]), .z = maths_as_float(jolon[1])},
        {.x = maths_as_float(mission[0]), .z = maths_as_float(mission[1])}};
    double poles[POLE_COUNT][2];
    if (!find_line(p, p->roads, p->road_count, poles) && !find_line(p, straight, 2, poles) &&
        !find_open_line(p, poles)) {
        errno = ENOSPC;
        return -1;
    }
    for (uint32_t i = 0; i < POLE_COUNT; i++) {
        uint32_t which = i % p->class_size[OBJECT_POLE];
        object_placement_add(p, poles[i][0], poles[i][1], p->of_class[OBJECT_POLE][which], 1.0);
    }
    return 0;
}

/* Adds a rock at the barest of about a hundred places in the hills around Jolon. */
static int add_rock(struct object_placement *p, uint32_t number, const double jolon[2])
{
    double best = -1.0, x = jolon[0], z = jolon[1];
    for (uint32_t try = 0; try < ROCK_TRIES; try++) {
        double px = jolon[0] + random_between(p->seed, number, try, RANDOM_OBJECT_X, -9e3, 9e3);
        double pz = jolon[1] + random_between(p->seed, number, try, RANDOM_OBJECT_Z, -9e3, 9e3);
        if (!object_placement_allows(p, px, pz, 0.0))
            continue;
        double steep = 1.0 - terrain_normal(p->terrain, NULL, px, pz).y;
        if (steep > best) {
            best = steep;
            x = px;
            z = pz;
        }
    }
    return add_near(p, OBJECT_OTHER_NATURAL, number, x, z);
}

static int add_built(struct object_placement *p)
{
    const struct {
        enum object_class of;
        int jolon;          /* beside Jolon, else beside the Mission */
        double east, south; /* [m] from it */
    } sites[] = {
        {OBJECT_BUILDING, 0, 0, -20},         {OBJECT_BUILDING, 0, 55, -45},
        {OBJECT_BUILDING, 1, 30, 30},         {OBJECT_WATERTOWER, 0, 150, -120},
        {OBJECT_OTHER_MANMADE, 0, -70, -35},  {OBJECT_OTHER_MANMADE, 0, 240, 60},
        {OBJECT_OTHER_MANMADE, 1, -45, 60},   {OBJECT_OTHER_MANMADE, 1, 120, -70},
        {OBJECT_OTHER_MANMADE, 1, 700, -350},
    };
    uint32_t numbers[OBJECT_CLASS_COUNT] = {0};
    double at[2][2];
    /* In a smaller world the two places are nearer to each other. */
    const double share = maths_min(p->terrain->squares.world_m / WORLD_SIDE_DEFAULT_M, 1.0);
    for (int i = 0; i < 2; i++) {
        const struct geography_place *place =
            &geography_places[i == 0 ? GEOGRAPHY_MISSION : GEOGRAPHY_JOLON];
        generate_place(place->latitude_deg, place->longitude_deg, &at[i][0], &at[i][1]);
        at[i][0] *= share;
        at[i][1] *= share;
    }
    if (add_poles(p, at[1], at[0]) != 0)
        return -1;
    for (size_t i = 0; i < sizeof sites / sizeof sites[0]; i++) {
        const double *from = at[sites[i].jolon];
        if (add_near(p, sites[i].of, numbers[sites[i].of]++, from[0] + sites[i].east,
                     from[1] + sites[i].south) != 0)
            return -1;
    }
    for (uint32_t i = 0; i < generate_table1[OBJECT_OTHER_NATURAL]; i++)
        if (add_rock(p, i, at[1]) != 0)
            return -1;
    return 0;
}

/* By gridsquare; within one from west to east, then from north to south. */
static int in_order(const void *left, const void *right, void *squares)
{
    const struct fixed_object *a = left, *b = right;
    uint32_t square_a = gridsquare_of(squares, a->x, a->z),
             square_b = gridsquare_of(squares, b->x, b->z);
    if (square_a != square_b)
        return square_a < square_b ? -1 : 1;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    return (a->z > b->z) - (a->z < b->z);
}

int generate_table1_objects(struct fixed_object *objects, const struct terrain *terrain,
                            const struct kind *kinds, uint32_t kind_count,
                            const struct road_point *roads, uint32_t road_count, uint64_t seed)
{
    struct object_placement placement;
    seed =
        random_u64(seed, 0, 0,
                   RANDOM_FOREST); /* noise functions add to the seed: seeds must not be adjacent */
    if (object_placement_init(&placement, terrain, kinds, kind_count, roads, road_count, seed,
                              objects) != 0)
        return -1;
    struct gridsquares squares = terrain->squares;
    int result = add_built(&placement);
    if (result == 0)
        result = plant_placement_plant(&placement);
    object_placement_free(&placement);
    if (result == 0)
        qsort_r(objects, GENERATE_TABLE1_TOTAL, sizeof *objects, in_order, &squares);
    return result;
}
