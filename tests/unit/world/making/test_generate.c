/* The generated ground and Table 1's objects: rows 1 to 4 of what the thesis states (the world is
 * 50 km square, the counts of Table 1, objects found from their gridsquare, Fort Hunter Liggett).
 */
#include "world/making/generate.h"

#include "world/maths/hash.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SEED 1991u

enum { KIND_OAK, KIND_PINE, KIND_BUSH, KIND_POLE, KIND_HOUSE, KIND_TOWER, KIND_BUNKER, KIND_ROCK };

static const struct kind kinds[] = {
    {.name = "oak",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_TREE,
     .radius_m = 1.8,
     .height_m = 9.0},
    {.name = "pine",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_TREE,
     .radius_m = 1.6,
     .height_m = 16.0},
    {.name = "bush",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_BUSH,
     .radius_m = 1.0,
     .height_m = 1.6},
    {.name = "pole",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_POLE,
     .radius_m = 0.4,
     .height_m = 9.0},
    {.name = "house",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_BUILDING,
     .radius_m = 9.0,
     .height_m = 7.0},
    {.name = "tower",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_WATERTOWER,
     .radius_m = 5.0,
     .height_m = 18.0},
    {.name = "bunker",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_OTHER_MANMADE,
     .radius_m = 5.0,
     .height_m = 3.0},
    {.name = "rock",
     .domain = DOMAIN_FIXED,
     .object_class = OBJECT_OTHER_NATURAL,
     .radius_m = 2.7,
     .height_m = 3.0},
    {.name = "tank", .domain = DOMAIN_LAND, .radius_m = 3.0, .height_m = 2.9},
};
#define KIND_COUNT ((uint32_t)(sizeof kinds / sizeof kinds[0]))

struct ground {
    float *posts;
    uint8_t *cover;
    struct road_point *roads;
    uint32_t road_count;
    struct terrain terrain;
};

/* Made once: the world at the thesis's spacing, and its objects. */
static struct ground coarse;
static struct fixed_object *objects;

static void make_ground(struct ground *g, uint32_t side, uint64_t seed)
{
    g->posts = malloc((size_t)side * side * sizeof *g->posts);
    g->cover = malloc((size_t)side * side);
    g->roads = malloc(GENERATE_ROAD_MAX * sizeof *g->roads);
    assert_non_null(g->posts);
    assert_non_null(g->cover);
    assert_non_null(g->roads);
    assert_int_equal(generate_hunter_liggett(g->posts, g->cover, side, seed, g->roads,
                                             GENERATE_ROAD_MAX, &g->road_count),
                     0);
    g->terrain = (struct terrain){.posts = g->posts,
                                  .cover = g->cover,
                                  .side = side,
                                  .spacing_m = WORLD_SIDE_DEFAULT_M / (side - 1),
                                  .squares = GRIDSQUARES_DEFAULT_INIT};
}

static void free_ground(struct ground *g)
{
    free(g->posts);
    free(g->cover);
    free(g->roads);
}

static struct fixed_object *make_objects(const struct ground *g, uint64_t seed)
{
    struct fixed_object *made = malloc(GENERATE_TABLE1_TOTAL * sizeof *made);
    assert_non_null(made);
    assert_int_equal(generate_table1_objects(made, &g->terrain, kinds, KIND_COUNT, g->roads,
                                             g->road_count, seed),
                     0);
    return made;
}

static int set_up(void **state)
{
    (void)state;
    make_ground(&coarse, 401, SEED);
    objects = make_objects(&coarse, SEED);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(objects);
    free_ground(&coarse);
    return 0;
}

static uint32_t nearest_post(const struct terrain *t, double x, double z)
{
    double column = floor(x / t->spacing_m + 0.5), row = floor(z / t->spacing_m + 0.5);
    return (uint32_t)row * t->side + (uint32_t)column;
}

static float post_at(const struct terrain *t, double latitude, double longitude)
{
    double x, z;
    generate_place(latitude, longitude, &x, &z);
    return t->posts[nearest_post(t, x, z)];
}

static double distance(double x0, double z0, double x1, double z1)
{
    return sqrt((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0));
}

static void assert_between(double value, double low, double high)
{
    if (!(value >= low && value <= high))
        fail_msg("%.9g is not within %.9g and %.9g", value, low, high);
}

/* --- row 1: the square ------------------------------------------------------------------------ */

/* WGS 84 to earth-centred coordinates. */
static struct vec3 ecef(double latitude_deg, double longitude_deg)
{
    const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
    double latitude = latitude_deg * RAD_PER_DEG, longitude = longitude_deg * RAD_PER_DEG;
    double normal = a / sqrt(1.0 - e2 * sin(latitude) * sin(latitude));
    return (struct vec3){normal * cos(latitude) * cos(longitude),
                         normal * cos(latitude) * sin(longitude),
                         normal * (1.0 - e2) * sin(latitude)};
}

/* Row 1: latitude and longitude over the whole square become metres as on ECEF's tangent plane. */
static void place_agrees_with_ecef(void **state)
{
    (void)state;
    const double latitude = 35.95 * RAD_PER_DEG, longitude = -121.25 * RAD_PER_DEG;
    const struct vec3 east = {-sin(longitude), cos(longitude), 0.0};
    const struct vec3 north = {-sin(latitude) * cos(longitude), -sin(latitude) * sin(longitude),
                               cos(latitude)};
    double worst = 0.0;
    for (int i = 0; i <= 20; i++) {
        for (int k = 0; k <= 20; k++) {
            double at_latitude = 35.95 + 0.226 * (i - 10) / 10.0, x, z;
            double at_longitude = -121.25 + 0.278 * (k - 10) / 10.0;
            struct vec3 d = vec3_sub(ecef(at_latitude, at_longitude), ecef(35.95, -121.25));
            generate_place(at_latitude, at_longitude, &x, &z);
            worst = maths_max(
                worst, distance(x, z, 25000.0 + vec3_dot(d, east), 25000.0 - vec3_dot(d, north)));
        }
    }
    assert_between(worst, 0.0, 2.0);
    double x, z;
    generate_place(35.95, -121.25, &x, &z);
    assert_between(distance(x, z, 25000.0, 25000.0), 0.0, 1e-6);
}

/* Row 1: every object is inside the square, every road too. */
static void everything_is_inside(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        assert_between(objects[i].x, 0.0, WORLD_SIDE_DEFAULT_M);
        assert_between(objects[i].z, 0.0, WORLD_SIDE_DEFAULT_M);
    }
    for (uint32_t i = 0; i < coarse.road_count; i++) {
        assert_between(coarse.roads[i].x, 0.0, WORLD_SIDE_DEFAULT_M);
        assert_between(coarse.roads[i].z, 0.0, WORLD_SIDE_DEFAULT_M);
    }
}

/* --- row 4: Fort Hunter Liggett ----------------------------------------------------------------
 */

static void check_anchors(const struct terrain *t)
{
    assert_between((double)post_at(t, 36.1455, -121.4187), 1787.0 - 15.0, 1787.0 + 15.0);
    assert_between((double)post_at(t, 36.0511, -121.4958), 1571.0 - 15.0, 1571.0 + 15.0);
    assert_between((double)post_at(t, 36.0153, -121.2503), 318.5, 321.5);
    assert_between((double)post_at(t, 35.971, -121.176), 294.5, 297.5);
}

/* Nothing within radius_m is higher than the peak by more than the posts' coarseness explains. */
static void check_peak(const struct terrain *t, double latitude, double longitude, double height_m,
                       double radius_m)
{
    double x, z, top = 0.0, top_x = 0.0, top_z = 0.0;
    generate_place(latitude, longitude, &x, &z);
    for (uint32_t i = 0; i < t->side * t->side; i++) {
        double px = i % t->side * t->spacing_m, pz = i / t->side * t->spacing_m;
        if (distance(x, z, px, pz) < radius_m && (double)t->posts[i] > top) {
            top = (double)t->posts[i];
            top_x = px;
            top_z = pz;
        }
    }
    assert_between(top, height_m - 15.0, height_m + 15.0);
    assert_between(distance(x, z, top_x, top_z), 0.0, 200.0);
}

/* Row 4: known heights, whatever the seed. */
static void places_have_their_heights(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct ground g;
        make_ground(&g, 401, seed);
        check_anchors(&g.terrain);
        check_peak(&g.terrain, 36.1455, -121.4187, 1787.0, 80000.0);
        check_peak(&g.terrain, 36.0511, -121.4958, 1571.0, 4000.0);
        free_ground(&g);
    }
}

/* Row 4: the ground at a place does not depend on how dense the posts are. */
static void density_does_not_change_the_ground(void **state)
{
    (void)state;
    for (uint32_t side = 801; side <= 1601; side += 800) {
        struct ground fine;
        uint32_t step = (side - 1) / 400;
        make_ground(&fine, side, SEED);
        check_anchors(&fine.terrain);
        for (uint32_t i = 0; i < 401 * 401; i++) {
            uint32_t same = i / 401 * step * side + i % 401 * step;
            assert_between((double)(fine.posts[same] - coarse.posts[i]), -0.01, 0.01);
            assert_int_equal(cover_is_water(fine.cover[same]), cover_is_water(coarse.cover[i]));
        }
        assert_int_equal(fine.road_count, coarse.road_count);
        assert_memory_equal(fine.roads, coarse.roads, fine.road_count * sizeof *fine.roads);
        bool road_seen = memchr(fine.cover, COVER_ROAD, (size_t)side * side) != NULL;
        assert_int_equal(road_seen, side == 1601);
        free_ground(&fine);
    }
}

/* Row 4: the Pacific is level and in the south-west, land is above it. */
static void sea_is_level_and_land_above_it(void **state)
{
    (void)state;
    uint32_t sea = 0;
    for (uint32_t i = 0; i < 401 * 401; i++) {
        if (coarse.cover[i] == COVER_SEA) {
            sea++;
            assert_true(coarse.posts[i] == 0.0f);
            assert_true(i % 401 < 200 && i / 401 > 120);
        } else {
            assert_true(coarse.posts[i] > 0.5f);
        }
        assert_true(coarse.cover[i] < COVER_COUNT);
    }
    assert_between(sea / (401.0 * 401.0), 0.10, 0.16);
}

/* Row 4: the shore runs past known points, the Santa Lucia Range stands over it. */
static void coast_is_where_it_is(void **state)
{
    (void)state;
    /* Kirk Creek, Cape San Martin, Gorda, Ragged Point. */
    static const double shore[][2] = {
        {35.990, -121.496}, {35.889, -121.465}, {35.876, -121.449}, {35.782, -121.330}};
    for (size_t i = 0; i < sizeof shore / sizeof shore[0]; i++) {
        double x, z;
        generate_place(shore[i][0], shore[i][1], &x, &z);
        assert_int_equal(terrain_cover(&coarse.terrain, x - 1000.0, z + 1000.0), COVER_SEA);
        assert_int_not_equal(terrain_cover(&coarse.terrain, x + 1000.0, z - 1000.0), COVER_SEA);
        float top = 0.0f;
        for (double inland = 2500.0; inland < 8500.0; inland += 100.0)
            top =
                (float)maths_max((double)top, terrain_base_height(&coarse.terrain, x + 0.7 * inland,
                                                                  z - 0.7 * inland));
        assert_between((double)top, 700.0, 1600.0);
    }
}

/* Row 4: the Salinas Valley along the north-east edge falls to King City's 102 m. */
static void salinas_valley_falls_to_king_city(void **state)
{
    (void)state;
    float lowest_north = 1e9f, lowest_east = 1e9f;
    for (uint32_t i = 280; i < 401; i++) {
        float north = coarse.posts[i], east = coarse.posts[(i - 280) * 401 + 400];
        lowest_north = north < lowest_north ? north : lowest_north;
        lowest_east = east < lowest_east ? east : lowest_east;
    }
    assert_between((double)lowest_north, 98.0, 108.0);
    assert_between((double)lowest_east, 110.0, 130.0);
    double x, z;
    generate_place(36.2128, -121.1261, &x, &z);
    assert_true(z < 0.0); /* King City itself is outside */
    assert_between(terrain_base_height(&coarse.terrain, x, 0.0), 98.0, 130.0);
}

/* Row 4: Lake San Antonio lies level at 238 m in the south-east, kilometres long, north-west to
 * south-east, and no ground beside it is below it. */
static void lake_is_a_reservoir(void **state)
{
    (void)state;
    double west = 1e9, east = 0.0, north = 1e9, south = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < 401 * 401; i++) {
        if (coarse.cover[i] != COVER_LAKE)
            continue;
        double x = i % 401 * 125.0, z = i / 401 * 125.0;
        count++;
        assert_true(coarse.posts[i] == 238.0f);
        west = maths_min(west, x);
        east = maths_max(east, x);
        north = maths_min(north, z);
        south = maths_max(south, z);
        if (i % 401 > 0)
            assert_true(coarse.posts[i - 1] >= 238.0f);
        assert_true(coarse.posts[i - 401] >= 238.0f);
    }
    assert_between(count * 125.0 * 125.0 * 1e-6, 4.0, 25.0);
    assert_between(west, 40000.0, 45000.0);
    assert_true(east == WORLD_SIDE_DEFAULT_M);
    assert_between(south - north, 4000.0, 14000.0);
}

/* Row 4: rolling hills, valleys, woods: every cover but road (too narrow for these posts) is there,
 * forest more on slopes that face north. */
static void covers_are_as_in_the_range(void **state)
{
    (void)state;
    uint32_t counts[COVER_COUNT] = {0}, shady = 0, sunny = 0;
    for (uint32_t row = 1; row < 400; row++) {
        for (uint32_t column = 1; column < 400; column++) {
            uint32_t i = row * 401 + column;
            float rise_south = coarse.posts[i + 401] - coarse.posts[i - 401];
            counts[coarse.cover[i]]++;
            shady += coarse.cover[i] == COVER_FOREST && rise_south > 30.0f;
            sunny += coarse.cover[i] == COVER_FOREST && rise_south < -30.0f;
        }
    }
    assert_between(counts[COVER_GRASS], 40000, 100000);
    assert_between(counts[COVER_CHAPARRAL], 20000, 60000);
    assert_between(counts[COVER_FOREST], 10000, 50000);
    assert_between(counts[COVER_ROCK], 100, 6000);
    assert_between(counts[COVER_SAND], 10, 1000);
    assert_int_equal(counts[COVER_ROAD], 0);
    assert_true(shady > 3 * sunny / 2);
}

/* Row 4: roads in one piece each, points close together, none in water, through the Mission and
 * Jolon. */
static void roads_are_dry_and_lead_somewhere(void **state)
{
    (void)state;
    double mission = 1e9, jolon = 1e9, mission_x, mission_z, jolon_x, jolon_z;
    generate_place(36.0153, -121.2503, &mission_x, &mission_z);
    generate_place(35.971, -121.176, &jolon_x, &jolon_z);
    for (uint32_t i = 0; i < coarse.road_count; i++) {
        const struct road_point *p = &coarse.roads[i];
        double x = (double)p->x, z = (double)p->z;
        assert_false(cover_is_water(terrain_cover(&coarse.terrain, x, z)));
        mission = maths_min(mission, distance(x, z, mission_x, mission_z));
        jolon = maths_min(jolon, distance(x, z, jolon_x, jolon_z));
        if (i == 0)
            continue;
        assert_true(p->road == p[-1].road || p->road == p[-1].road + 1);
        if (p->road == p[-1].road)
            assert_between(distance(x, z, (double)p[-1].x, (double)p[-1].z), 0.0, 100.0);
    }
    assert_between(coarse.roads[coarse.road_count - 1].road + 1, 6, 12);
    assert_between(mission, 0.0, 400.0);
    assert_between(jolon, 0.0, 400.0);
}

/* Row 4: the coast road runs along the sea, from edge to edge. */
static void a_road_follows_the_coast(void **state)
{
    (void)state;
    uint32_t beside[16] = {0}, points[16] = {0};
    for (uint32_t i = 0; i < coarse.road_count; i++) {
        const struct road_point *p = &coarse.roads[i];
        assert_true(p->road < 16);
        points[p->road]++;
        for (double away = 125.0; away < 1500.0; away += 125.0) {
            if (terrain_cover(&coarse.terrain, (double)p->x - away, (double)p->z + away) ==
                COVER_SEA) {
                beside[p->road]++;
                break;
            }
        }
    }
    bool found = false;
    for (int i = 0; i < 16; i++)
        found |= points[i] > 500 && beside[i] * 10 > points[i] * 8;
    assert_true(found);
}

/* Row 4: too little room for the roads is told, not cut short. */
static void full_road_table_is_refused(void **state)
{
    (void)state;
    struct ground g;
    make_ground(&g, 401, SEED);
    errno = 0;
    assert_int_equal(
        generate_hunter_liggett(g.posts, g.cover, 401, SEED, g.roads, 100, &g.road_count), -1);
    assert_int_equal(errno, ENOBUFS);
    free_ground(&g);
}

/* Row 4: a seed makes one ground, another seed another. */
static void ground_follows_from_the_seed(void **state)
{
    (void)state;
    struct ground same, other;
    make_ground(&same, 401, SEED);
    make_ground(&other, 401, SEED + 1);
    assert_memory_equal(same.posts, coarse.posts, 401 * 401 * sizeof *same.posts);
    assert_memory_equal(same.cover, coarse.cover, 401 * 401);
    assert_int_equal(same.road_count, coarse.road_count);
    assert_memory_equal(same.roads, coarse.roads, same.road_count * sizeof *same.roads);
    assert_memory_not_equal(other.posts, coarse.posts, 401 * 401 * sizeof *other.posts);
    assert_memory_not_equal(other.cover, coarse.cover, 401 * 401);
    free_ground(&same);
    free_ground(&other);
}

/* --- row 2: Table 1 --------------------------------------------------------------------------- */

/* Row 2: exactly the thesis's numbers, written out here once more. */
static void counts_are_table_1(void **state)
{
    (void)state;
    static const uint32_t table1[OBJECT_CLASS_COUNT] = {30813, 9422, 54, 3, 1, 5, 5};
    uint32_t counts[OBJECT_CLASS_COUNT] = {0}, of_kind[KIND_COUNT] = {0};
    assert_int_equal(GENERATE_TABLE1_TOTAL, 40303);
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        assert_true(objects[i].kind < KIND_COUNT && kinds[objects[i].kind].domain == DOMAIN_FIXED);
        counts[kinds[objects[i].kind].object_class]++;
        of_kind[objects[i].kind]++;
    }
    assert_memory_equal(counts, table1, sizeof table1);
    assert_memory_equal(generate_table1, table1, sizeof table1);
    assert_true(of_kind[KIND_OAK] > 3000 && of_kind[KIND_PINE] > 3000); /* mixed */
}

/* Row 2: at most 18 in a square, and 3.9 on the average of the occupied ones. */
static void squares_are_as_full_as_in_table_1(void **state)
{
    (void)state;
    uint8_t *held = calloc(GRIDSQUARES_DEFAULT.count, 1);
    uint32_t occupied = 0, most = 0;
    assert_non_null(held);
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        uint32_t now = ++held[gridsquare_of(&GRIDSQUARES_DEFAULT, objects[i].x, objects[i].z)];
        occupied += now == 1;
        most = now > most ? now : most;
    }
    free(held);
    assert_int_equal(most, 18);
    assert_between((double)GENERATE_TABLE1_TOTAL / occupied, 3.85, 3.95);
}

/* Row 2: a class without a kind is refused. */
static void missing_kind_is_refused(void **state)
{
    (void)state;
    errno = 0;
    assert_int_equal(generate_table1_objects(objects, &coarse.terrain, kinds, KIND_ROCK,
                                             coarse.roads, coarse.road_count, SEED),
                     -1);
    assert_int_equal(errno, EINVAL);
}

/* Row 2: the same objects for the same seed, others for another. */
static void objects_follow_from_the_seed(void **state)
{
    (void)state;
    struct fixed_object *same = make_objects(&coarse, SEED), *other = make_objects(&coarse, 7);
    assert_memory_equal(same, objects, GENERATE_TABLE1_TOTAL * sizeof *same);
    assert_memory_not_equal(other, objects, GENERATE_TABLE1_TOTAL * sizeof *other);
    free(same);
    free(other);
}

/* Level ground without roads, of this side in gridsquares. */
static void make_flat(struct ground *flat, uint32_t squares)
{
    uint32_t side = squares + 1;
    *flat =
        (struct ground){.posts = malloc(side * side * sizeof(float)), .cover = malloc(side * side)};
    assert_non_null(flat->posts);
    assert_non_null(flat->cover);
    generate_flat(flat->posts, flat->cover, side, 12.5);
    flat->terrain = (struct terrain){
        .posts = flat->posts, .cover = flat->cover, .side = side, .spacing_m = 125.0};
    flat->terrain.squares = gridsquares_of(125.0 * squares);
}

static void assert_no_room(const struct ground *ground)
{
    struct fixed_object *made = malloc(GENERATE_TABLE1_TOTAL * sizeof *made);
    assert_non_null(made);
    errno = 0;
    assert_int_equal(
        generate_table1_objects(made, &ground->terrain, kinds, KIND_COUNT, NULL, 0, SEED), -1);
    assert_int_equal(errno, ENOSPC);
    free(made);
}

/* Row 2: level ground without roads holds them too. */
static void flat_ground_holds_table_1(void **state)
{
    (void)state;
    struct ground flat;
    make_flat(&flat, 400);
    struct fixed_object *made = make_objects(&flat, SEED);
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++)
        assert_true(made[i].y == 12.5f);
    free(made);
    free_ground(&flat);
}

/* A road of a town has no room for 3 km of poles, and one leads over the line from Jolon to the
 * Mission: they stand on another line. */
static void poles_stand_where_no_road_has_room(void **state)
{
    (void)state;
    struct ground flat;
    make_flat(&flat, 400);
    flat.roads = malloc(8 * sizeof *flat.roads);
    assert_non_null(flat.roads);
    for (uint32_t i = 0; i < 8; i++)
        flat.roads[flat.road_count++] = (struct road_point){
            .x = 25000.0 + 500.0 * i, .z = i % 2 ? 24000.0 : 15000.0, .road = i / 2};
    struct fixed_object *made = make_objects(&flat, SEED);
    uint32_t poles = 0;
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++)
        poles += kinds[made[i].kind].object_class == OBJECT_POLE;
    assert_int_equal(poles, 54);
    free(made);
    free_ground(&flat);
}

/* A smaller world holds them from some 13 km on; a smaller one has no room, and says so. */
static void smaller_worlds_hold_table_1_while_there_is_room(void **state)
{
    (void)state;
    struct ground flat;
    make_flat(&flat, 112);
    free(make_objects(&flat, SEED));
    free_ground(&flat);
    make_flat(&flat, 96);
    assert_no_room(&flat);
    free_ground(&flat);
}

/* Row 2: where there is no dry land, that is said. */
static void water_holds_nothing(void **state)
{
    (void)state;
    struct ground sea;
    make_flat(&sea, 400);
    memset(sea.cover, COVER_SEA, 401 * 401);
    assert_no_room(&sea);
    free_ground(&sea);
}

/* --- row 3: objects by gridsquare --------------------------------------------------------------
 */

/* Row 3: sorted by square, so that a square's objects are one run, and without equals. */
static void objects_lie_in_the_order_of_squares(void **state)
{
    (void)state;
    for (uint32_t i = 1; i < GENERATE_TABLE1_TOTAL; i++) {
        const struct fixed_object *a = &objects[i - 1], *b = &objects[i];
        uint32_t square_a = gridsquare_of(&GRIDSQUARES_DEFAULT, a->x, a->z),
                 square_b = gridsquare_of(&GRIDSQUARES_DEFAULT, b->x, b->z);
        assert_true(square_a <= square_b);
        if (square_a == square_b)
            assert_true(a->x < b->x || (a->x == b->x && a->z < b->z));
    }
}

/* Row 3: no two bounding spheres touch, looked for in the square and its neighbours. */
static void objects_stand_apart(void **state)
{
    (void)state;
    uint32_t *start = calloc(GRIDSQUARES_DEFAULT.count + 1, sizeof *start);
    assert_non_null(start);
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++)
        start[gridsquare_of(&GRIDSQUARES_DEFAULT, objects[i].x, objects[i].z) + 1]++;
    for (uint32_t i = 0; i < GRIDSQUARES_DEFAULT.count; i++)
        start[i + 1] += start[i];
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        const struct fixed_object *a = &objects[i];
        struct gridsquare_box box =
            gridsquare_box_of(&GRIDSQUARES_DEFAULT, a->x - 30, a->z - 30, a->x + 30, a->z + 30);
        for (int32_t row = box.z0; row <= box.z1; row++) {
            uint32_t first = start[gridsquare_index(&GRIDSQUARES_DEFAULT, box.x0, row)];
            uint32_t end = start[gridsquare_index(&GRIDSQUARES_DEFAULT, box.x1, row) + 1];
            for (uint32_t k = first; k < end; k++)
                if (k != i)
                    assert_true(distance(a->x, a->z, objects[k].x, objects[k].z) >
                                (double)(a->radius_m + objects[k].radius_m));
        }
    }
    free(start);
}

/* --- rows 2 and 4: where they stand ------------------------------------------------------------
 */

static double leg_distance(const struct road_point *a, double x, double z)
{
    double dx = (double)(a[1].x - a->x), dz = (double)(a[1].z - a->z);
    double t = ((x - (double)a->x) * dx + (z - (double)a->z) * dz) / (dx * dx + dz * dz + 1e-12);
    t = maths_clamp(t, 0.0, 1.0);
    return distance(x, z, (double)a->x + dx * t, (double)a->z + dz * t);
}

static double road_distance(double x, double z)
{
    double least = 1e9;
    for (uint32_t i = 0; i + 1 < coarse.road_count; i++)
        if (coarse.roads[i].road == coarse.roads[i + 1].road && fabs(coarse.roads[i].x - x) < 400.0)
            least = maths_min(least, leg_distance(&coarse.roads[i], x, z));
    return least;
}

/* Rows 2 and 4: on dry ground at its height, off the roads, of the kind's size. */
static void objects_stand_on_dry_ground(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        const struct fixed_object *o = &objects[i];
        const struct kind *kind = &kinds[o->kind];
        bool grows = kind->object_class == OBJECT_TREE || kind->object_class == OBJECT_BUSH;
        double spread = grows ? 0.2001 : 1e-6;
        assert_false(cover_is_water(terrain_cover(&coarse.terrain, o->x, o->z)));
        assert_true(o->y == (float)terrain_base_height(&coarse.terrain, o->x, o->z));
        assert_between((double)o->radius_m / kind->radius_m, 1.0 - spread, 1.0 + spread);
        assert_between((double)o->height_m / kind->height_m, 1.0 - spread, 1.0 + spread);
        assert_true(road_distance(o->x, o->z) >= 8.0);
    }
}

/* Rows 2 and 4: groves: trees where the ground is wooded, far more often than its share of land,
 * bushes in chaparral, and thick rather than strewn. */
static void groves_stand_in_the_hills(void **state)
{
    (void)state;
    uint32_t trees_in_forest = 0, bushes_in_chaparral = 0, forest = 0, chaparral = 0, land = 0;
    for (uint32_t i = 0; i < 401 * 401; i++) {
        land += !cover_is_water(coarse.cover[i]);
        forest += coarse.cover[i] == COVER_FOREST;
        chaparral += coarse.cover[i] == COVER_CHAPARRAL;
    }
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        enum cover cover = terrain_cover(&coarse.terrain, objects[i].x, objects[i].z);
        enum object_class of = kinds[objects[i].kind].object_class;
        trees_in_forest += of == OBJECT_TREE && cover == COVER_FOREST;
        bushes_in_chaparral += of == OBJECT_BUSH && cover == COVER_CHAPARRAL;
    }
    assert_true(trees_in_forest / 30813.0 > 2.0 * forest / land);
    assert_true(bushes_in_chaparral / 9422.0 > 2.0 * chaparral / land);
}

/* Rows 2 and 4: what men built is at the Mission and Jolon, the poles in a line along a road. */
static void built_objects_are_where_people_are(void **state)
{
    (void)state;
    double mission_x, mission_z, jolon_x, jolon_z;
    const struct fixed_object *poles[54];
    uint32_t pole_count = 0;
    generate_place(36.0153, -121.2503, &mission_x, &mission_z);
    generate_place(35.971, -121.176, &jolon_x, &jolon_z);
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        const struct fixed_object *o = &objects[i];
        double away = maths_min(distance(o->x, o->z, mission_x, mission_z),
                                distance(o->x, o->z, jolon_x, jolon_z));
        if (o->kind == KIND_HOUSE || o->kind == KIND_TOWER || o->kind == KIND_BUNKER)
            assert_between(away, 0.0, 1500.0);
        if (o->kind == KIND_POLE)
            poles[pole_count++] = o;
    }
    assert_int_equal(pole_count, 54);
    uint32_t ends = 0;
    for (uint32_t i = 0; i < 54; i++) {
        uint32_t neighbours = 0;
        assert_between(road_distance(poles[i]->x, poles[i]->z), 8.0, 15.0);
        for (uint32_t k = 0; k < 54; k++)
            if (k != i) {
                double apart = distance(poles[i]->x, poles[i]->z, poles[k]->x, poles[k]->z);
                assert_true(apart > 45.0);
                neighbours += apart < 65.0;
            }
        assert_between(neighbours, 1, 2);
        ends += neighbours == 1;
    }
    assert_int_equal(ends, 2);
}

/* Ground of the seed is the same to the bit in every build. Points of roads are rounded to floats,
 * which gcc 12 leaves out where it makes vectors of (double)(float). */
static void generated_ground_stays(void **state)
{
    XXH64_hash_t hash =
        XXH3_64bits(coarse.posts, coarse.terrain.side * coarse.terrain.side * sizeof(float));
    (void)state;
    hash ^= XXH3_64bits(coarse.cover, (size_t)coarse.terrain.side * coarse.terrain.side);
    for (uint32_t i = 0; i < coarse.road_count; i++) {
        const double at[2] = {coarse.roads[i].x, coarse.roads[i].z};
        hash = XXH3_64bits_withSeed(at, sizeof at, hash);
    }
    for (uint32_t i = 0; i < GENERATE_TABLE1_TOTAL; i++) {
        const double at[3] = {objects[i].x, objects[i].y, objects[i].z};
        hash = XXH3_64bits_withSeed(at, sizeof at, hash);
    }
    assert_int_equal(hash, 0xeade5173d200844c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(generated_ground_stays),
        cmocka_unit_test(place_agrees_with_ecef),
        cmocka_unit_test(everything_is_inside),
        cmocka_unit_test(places_have_their_heights),
        cmocka_unit_test(density_does_not_change_the_ground),
        cmocka_unit_test(sea_is_level_and_land_above_it),
        cmocka_unit_test(coast_is_where_it_is),
        cmocka_unit_test(salinas_valley_falls_to_king_city),
        cmocka_unit_test(lake_is_a_reservoir),
        cmocka_unit_test(covers_are_as_in_the_range),
        cmocka_unit_test(roads_are_dry_and_lead_somewhere),
        cmocka_unit_test(a_road_follows_the_coast),
        cmocka_unit_test(full_road_table_is_refused),
        cmocka_unit_test(ground_follows_from_the_seed),
        cmocka_unit_test(counts_are_table_1),
        cmocka_unit_test(squares_are_as_full_as_in_table_1),
        cmocka_unit_test(objects_follow_from_the_seed),
        cmocka_unit_test(flat_ground_holds_table_1),
        cmocka_unit_test(poles_stand_where_no_road_has_room),
        cmocka_unit_test(smaller_worlds_hold_table_1_while_there_is_room),
        cmocka_unit_test(water_holds_nothing),
        cmocka_unit_test(objects_lie_in_the_order_of_squares),
        cmocka_unit_test(objects_stand_apart),
        cmocka_unit_test(objects_stand_on_dry_ground),
        cmocka_unit_test(groves_stand_in_the_hills),
        cmocka_unit_test(built_objects_are_where_people_are),
        cmocka_unit_test(missing_kind_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
