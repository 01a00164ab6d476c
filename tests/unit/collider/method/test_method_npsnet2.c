/* NPSNET-2's detection as published (thesis rows 17-21), and what it misses (rows 24, 25, 37). */
#include "collider/method/method_npsnet2.h"

#include "tests/support/pair_search.h"
#include "tests/support/small_world.h"
#include "tests/support/steps.h"
#include "world/model.h"
#include "world/params.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define DT_S     0.1 /* ten frames a second */
#define BORDER_M 25000.0

static const char ten_frames_a_second[] = "world = { seed = 1; capacity = 64; hz = 10.0; };";

static struct small_world w;

/* Tanks are checked with a radius of 3 m, as the thesis's are. */
static int open_world(void **state)
{
    (void)state;
    small_world_begin(&w, 512, 16);
    w.params->hz = 1.0 / DT_S;
    w.params->dt_s = DT_S;
    w.params->collision.nearness = NEARNESS_AND;
    w.kinds[SMALL_TANK].radius_m = 3.0 / METHOD_NPSNET2_RADIUS_SHARE;
    return pair_search_open(&w, 512 * 512);
}

static const struct vec3 still = {0, 0, 0}, eastward = {1, 0, 0};

/* --- fixed objects -----------------------------------------------------------------------------*/

static void test_row_17_above_the_threshold_no_fixed_object_is_tested(void **state)
{
    (void)state;
    w.posts[0] = w.posts[1] = w.posts[2] = w.posts[3] = 10.0f; /* the ground, not the sea, counts */
    small_world_tree(&w, (struct vec3){25010, 60, 25010}, 20.0);
    small_world_index(&w);
    small_world_row(&w, SMALL_JET, (struct vec3){25009, 70.01, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    small_world_move(&w, 0, (struct vec3){25009, 69.99, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    assert_true(pair_search_has(0, 0 | PAIR_FIXED));
}

static void test_row_17_resting_bodies_and_fallen_objects_are_not_tested(void **state)
{
    (void)state;
    small_world_tree(&w, (struct vec3){25010, 0, 25010}, 2.0);
    small_world_index(&w);
    small_world_row(&w, SMALL_TANK, (struct vec3){25010, 0, 25010}, still);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    w.path[0].along = eastward;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    w.damage[0] = DAMAGE_HIGH;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
}

static void test_row_18_after_a_hit_on_a_fixed_object_no_moving_body_is_tested(void **state)
{
    (void)state;
    small_world_tree(&w, (struct vec3){25010, 0, 25010}, 2.0);
    small_world_index(&w);
    /* Nose to tail at a tree: the one behind does not reach the tree, and finds the one in front,
     * which does not look for it. */
    small_world_row(&w, SMALL_TANK, (struct vec3){25008, 0, 25010}, eastward);
    small_world_row(&w, SMALL_TANK, (struct vec3){25004, 0, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 2);
    assert_true(pair_search_has(0, 0 | PAIR_FIXED) && pair_search_has(0, 1));
    /* It has stopped: it is not tested. */
    small_world_move(&w, 1, (struct vec3){25004, 0, 25010}, still);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    /* Both reach the tree: neither looks for the other. */
    small_world_move(&w, 1, (struct vec3){25006, 0, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 2);
    assert_true(pair_search_has(0, 0 | PAIR_FIXED) && pair_search_has(1, 0 | PAIR_FIXED));
}

/* Fig. 9: a house just east of a border, and a tank that comes from the west. */
static void test_row_37_a_border_object_is_found_late(void **state)
{
    double touched = 0.0, found = 0.0;
    (void)state;
    w.kinds[SMALL_TREE].radius_m = 20.0;
    small_world_tree(&w, (struct vec3){BORDER_M + 5.0, 0, 25060}, 20.0);
    small_world_index(&w);
    small_world_row(&w, SMALL_TANK, (struct vec3){24950, 0, 25060}, (struct vec3){1.66, 0, 0});
    for (int frame = 0; frame < 60 && found == 0.0; frame++) {
        struct vec3 at = path_at(&w.path[0], 1.0);
        small_world_move(&w, 0, at, w.path[0].along);
        if (touched == 0.0 && pair_search_run(method_brute_pairs) == 1)
            touched = w.e.row[0].x;
        if (pair_search_run(method_npsnet2_pairs) == 1)
            found = w.e.row[0].x;
    }
    /* 18 m late: when its centre is over the border. */
    assert_true(fabs(touched - (BORDER_M + 5.0 - 23.0)) < 2.0);
    assert_true(found >= BORDER_M && found < BORDER_M + 1.66);
}

static void test_row_37_an_object_of_its_own_square_is_found_in_time(void **state)
{
    (void)state;
    w.kinds[SMALL_TREE].radius_m = 20.0;
    small_world_tree(&w, (struct vec3){BORDER_M + 60.0, 0, 25060}, 20.0);
    small_world_index(&w);
    double reach = 3.0 + METHOD_NPSNET2_RADIUS_SHARE * 20.0;
    small_world_row(&w, SMALL_TANK, (struct vec3){BORDER_M + 60.0 - reach - 1.01, 0, 25060},
                    eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    small_world_move(&w, 0, (struct vec3){BORDER_M + 60.0 - reach - 0.99, 0, 25060}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
}

/* --- moving bodies -----------------------------------------------------------------------------*/

static void test_row_20_radii_are_slightly_smaller_than_the_extent(void **state)
{
    double extent = 3.0 / METHOD_NPSNET2_RADIUS_SHARE;
    (void)state;
    assert_true(METHOD_NPSNET2_RADIUS_SHARE < 1.0 && METHOD_NPSNET2_RADIUS_SHARE > 0.9);
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_TANK, (struct vec3){25001, 0, 25000 + extent + extent - 0.01},
                    (struct vec3){-1, 0, 0});
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    small_world_move(&w, 1, (struct vec3){25001, 0, 25006.001}, (struct vec3){-1, 0, 0});
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    small_world_move(&w, 1, (struct vec3){25001, 0, 25005.999}, (struct vec3){-1, 0, 0});
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1); /* as long as they overlap */
}

static void test_a_munition_is_a_moving_object_and_apart_from_its_shooter(void **state)
{
    (void)state;
    uint32_t tank = small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    uint32_t round =
        small_world_row(&w, SMALL_ROUND, (struct vec3){24999, 0, 25000}, (struct vec3){2, 0, 0});
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    w.e.row[round].owner_slot = tank;
    w.e.row[round].owner_id = w.e.row[tank].id;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    w.e.row[round].owner_id = 0;
    w.e.row[tank].state = ENTITY_FREE;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
}

/* A cross of the map: 100 share the middle one's X, 40 its Z, 5 are in the middle. */
static void test_row_19_or_keeps_a_cross_of_the_map(void **state)
{
    (void)state;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, eastward);
    for (int i = 0; i < 100; i++) /* 200 m apart, so none of them is near another in Z */
        small_world_row(&w, SMALL_TANK, (struct vec3){25001, 0, 100.0 + 200.0 * i}, still);
    for (int i = 0; i < 40; i++)
        small_world_row(&w, SMALL_TANK, (struct vec3){30000.0 + 200.0 * i, 0, 25000}, still);
    for (int i = 0; i < 5; i++)
        small_world_row(&w, SMALL_TANK, (struct vec3){24990, 0, 25010.0 + 10.0 * i}, still);
    const struct method_input input = small_world_input(&w);
    struct method_npsnet2_level1 level1 = method_npsnet2_level1(&input);
    const uint64_t middle = 6;
    assert_int_equal(level1.pairs, 146 * 145 / 2);
    assert_int_equal(level1.kept[NEARNESS_AND], middle * (middle - 1) / 2);
    assert_int_equal(level1.kept[NEARNESS_OR], middle * (middle - 1) / 2         /* the middle */
                                                   + 100 * 99 / 2 + 100 * middle /* along X */
                                                   + 40 * 39 / 2 + 40 * middle); /* along Z */
    w.e.row[0].state = ENTITY_FREE;
    assert_int_equal(method_npsnet2_level1(&input).pairs, 145 * 144 / 2);
}

/* Bodies whose radii sum to more than 100 m: level 1 drops what level 2 would find. */
static void test_row_19_level_1_is_100_m_in_x_or_z(void **state)
{
    static const struct {
        double dx, dz;
        bool by_or, by_and;
    } cases[] = {{99.9, 99.9, true, true},      {100.0, 100.0, true, true},
                 {100.1, 99.9, true, false},    {99.9, -100.1, true, false},
                 {-100.1, 100.1, false, false}, {-99.9, 0.0, true, true}};
    (void)state;
    small_world_row(&w, SMALL_GIANT, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_GIANT, (struct vec3){25000, 0, 25000}, still);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        small_world_move(&w, 1, (struct vec3){25000.0 + cases[i].dx, -8, 25000.0 + cases[i].dz},
                         (struct vec3){0, 8, 0});
        w.params->collision.nearness = NEARNESS_OR;
        assert_int_equal(pair_search_run(method_npsnet2_pairs), cases[i].by_or);
        w.params->collision.nearness = NEARNESS_AND;
        assert_int_equal(pair_search_run(method_npsnet2_pairs), cases[i].by_and);
    }
}

/* --- speed -------------------------------------------------------------------------------------*/

/* Table 2: what vehicles at their limits really go in a frame at ten frames a second. Its last
 * digits are cut off, not rounded. */
static void test_row_24_table_2(void **state)
{
    static const struct {
        const char *kind;
        double kph, height_m, digits; /* after the point: a power of ten */
        int printed;                  /* metres a frame, times digits */
    } rows[] = {{"tank", 60, 0, 100, 166}, {"ship", 50, 0, 100, 138}, {"jet", 1000, 300, 10, 277}};
    struct fixture f;
    (void)state;
    fixture_open(&f, ten_frames_a_second);
    steps_cover(&f, COVER_LAKE, 22000.0, 22000.0, 28000.0, 28000.0);
    for (uint32_t i = 0; i < 3; i++) {
        double x = i == 1 ? 25000.0 : 35000.0; /* the ship is on the lake */
        struct fixture_entity entity = {.kind = rows[i].kind,
                                        .at = {x, FIXTURE_GROUND_M + rows[i].height_m, 25000.0},
                                        .velocity = {rows[i].kph / 3.6, 0, 0}};
        uint32_t row = fixture_put(&f, entity);
        fixture_run(&f, 1);
        double metres = steps_rows(&f).row[row].x - x;
        assert_int_equal((int)(metres * rows[i].digits), rows[i].printed);
    }
    fixture_close(&f);
}

/* Two tanks pass each other this far apart (metres between their paths) at the same speed. Frames
 * fall at the same share of the distance between two of them; 0.5: as far before the meeting as
 * after. In how many frames is the pair found? */
static uint32_t pass(method_pairs_function *method, double apart_m, double speed_mps, double share)
{
    double step = speed_mps * DT_S;
    uint32_t found = 0;
    int frames = (int)(4.0 / step) + 3;
    for (int frame = -frames; frame <= frames; frame++) {
        double along = step * (frame + share); /* at the frame's end */
        small_world_move(&w, 0, (struct vec3){25000.0 + along - step, 0, 25000},
                         (struct vec3){step, 0, 0});
        small_world_move(&w, 1, (struct vec3){25000.0 - along + step, 0, 25000 + apart_m},
                         (struct vec3){-step, 0, 0});
        found += pair_search_run(method);
    }
    return found;
}

static double chord_m(double apart_m)
{
    return 2.0 * sqrt(36.0 - apart_m * apart_m);
}

/* The speed from which a frame can fall before the meeting and the next one after it: the two go 2
 * v dt nearer each other in a frame, and overlap along the chord. */
static void test_row_25_vehicles_faster_than_216_kph_pass_through_each_other(void **state)
{
    static const double apart[] = {0.0, 2.0, 4.0, 5.5, 5.99};
    (void)state;
    small_world_row(&w, SMALL_TANK, still, still);
    small_world_row(&w, SMALL_TANK, still, still);
    for (size_t i = 0; i < sizeof apart / sizeof apart[0]; i++) {
        double low = 0.1, high = 1000.0 / 3.6;
        for (int n = 0; n < 50; n++) {
            double speed = 0.5 * (low + high);
            *(pass(method_npsnet2_pairs, apart[i], speed, 0.5) > 0 ? &low : &high) = speed;
        }
        double kph = low * 3.6;
        assert_true(fabs(kph - 3.6 * 0.5 * chord_m(apart[i]) / DT_S) < 1e-6);
        assert_true(i > 0 || fabs(kph - 216.0) < 1e-6);
    }
}

/* Above the threshold the share of frames' phases that miss is 1 - chord / (2 v dt); no phase hides
 * the pair from a swept method. */
static void test_row_25_how_many_pass_and_that_no_swept_method_misses_one(void **state)
{
    static const struct {
        double apart_m, kph;
    } cases[] = {{0.0, 210.0}, {0.0, 300.0}, {4.0, 210.0}, {0.0, 1000.0}, {5.5, 1000.0}};
    (void)state;
    small_world_row(&w, SMALL_TANK, still, still);
    small_world_row(&w, SMALL_TANK, still, still);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double speed = cases[i].kph / 3.6;
        double wanted = maths_max(0.0, 1.0 - chord_m(cases[i].apart_m) / (2.0 * speed * DT_S));
        uint32_t missed = 0;
        for (int phase = 0; phase < 1000; phase++) {
            double share = (phase + 0.5) / 1000.0;
            missed += pass(method_npsnet2_pairs, cases[i].apart_m, speed, share) == 0;
            if (phase % 50 == 0) {
                assert_true(pass(method_brute_pairs, cases[i].apart_m, speed, share) > 0);
                assert_true(pass(method_occupancy_pairs, cases[i].apart_m, speed, share) > 0);
                assert_true(pass(method_hopcroft_pairs, cases[i].apart_m, speed, share) > 0);
            }
        }
        assert_true(fabs(missed / 1000.0 - wanted) <= 0.002);
    }
}

/* --- level 3 -----------------------------------------------------------------------------------*/

/* Every kind is a cube of 2 m. */
static const struct model cube = {.name = "cube", .triangle_count = 12, .vertex_count = 8};
static const struct model_vertex corners[] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                              {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
static const struct model_triangle faces[] = {
    {.vertex = {0, 3, 2}}, {.vertex = {0, 2, 1}}, {.vertex = {4, 5, 6}}, {.vertex = {4, 6, 7}},
    {.vertex = {0, 4, 7}}, {.vertex = {0, 7, 3}}, {.vertex = {1, 2, 6}}, {.vertex = {1, 6, 5}},
    {.vertex = {0, 1, 5}}, {.vertex = {0, 5, 4}}, {.vertex = {3, 7, 6}}, {.vertex = {3, 6, 2}}};

static void make_cubes(void)
{
    w.params->collision.shape = SHAPE_MODEL;
    w.world.counts.models = 1;
    w.world.counts.model_vertices = 8;
    w.world.counts.model_triangles = 12;
    w.world.models = &cube;
    w.world.model_vertices = corners;
    w.world.model_triangles = faces;
    for (int i = 0; i < SMALL_KINDS; i++) {
        w.kinds[i].radius_m = 2.0;
        w.kinds[i].bound_m = w.kinds[i].reach_m = sqrt(3.0);
        w.kinds[i].level_m = sqrt(2.0);
        w.kinds[i].low_m = -1.0;
        w.kinds[i].high_m = 1.0;
    }
}

static void test_row_21_spheres_that_overlap_without_the_objects_are_no_collision(void **state)
{
    (void)state;
    make_cubes();
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_CAR, (struct vec3){25001.5, 0, 25000}, eastward);
    /* 2.5 m: half a metre between them */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    w.params->collision.shape = SHAPE_SPHERE;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    w.params->collision.shape = SHAPE_MODEL;
    small_world_move(&w, 1, (struct vec3){25000.9, 0, 25000}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1); /* 1.9 m */
}

static void test_row_21_fixed_objects_have_their_polygons_and_their_size(void **state)
{
    (void)state;
    make_cubes();
    small_world_tree(&w, (struct vec3){25010, 0, 25010}, 4.0); /* a cube of 4 m */
    small_world_index(&w);
    small_world_row(&w, SMALL_CAR, (struct vec3){25012.5, 0, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0); /* half a metre between them */
    small_world_move(&w, 0, (struct vec3){25011.9, 0, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    small_world_move(&w, 0, (struct vec3){25012.7, 0, 25010}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    w.fixed[0].turn = 65536 / 8; /* a corner to the car: 2.83 m */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
}

static void test_row_21_an_object_is_hit_as_it_is_turned(void **state)
{
    (void)state;
    make_cubes();
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_CAR, (struct vec3){25001.25, 0, 25000}, eastward);
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0); /* 2.25 m */
    w.e.row[0].heading = w.e.row[1].heading = 0.25 * PI;        /* corner to corner: 2.83 m reach */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
}

static void test_row_21_a_contact_beside_the_line_of_centres_is_missed(void **state)
{
    (void)state;
    make_cubes();
    /* The car's corner is 0.11 m in the house; the line leaves the car 0.46 m before the house. */
    small_world_tree(&w, (struct vec3){25013.3, 0, 25011.9}, 4.0);
    small_world_index(&w);
    small_world_row(&w, SMALL_CAR, (struct vec3){25009, 0, 25010}, eastward);
    w.e.row[0].heading = 0.25 * PI;
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
    w.fixed[0].z = 25010.0; /* the corner is on the line now */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
}

/* Vehicles stand on the ground with air below them: a ray at their positions would meet nothing. */
static void test_row_21_rays_run_at_the_height_of_the_vehicle_and_not_along_the_ground(void **state)
{
    struct model_vertex raised[8];
    (void)state;
    make_cubes();
    memcpy(raised, corners, sizeof raised);
    for (int i = 0; i < 8; i++)
        raised[i].y += 1.5f;
    w.world.model_vertices = raised;
    w.kinds[SMALL_TANK].height_m = w.kinds[SMALL_CAR].height_m = 2.5;
    small_world_row(&w, SMALL_TANK, (struct vec3){25000, 0, 25000}, still);
    small_world_row(&w, SMALL_CAR, (struct vec3){25000.9, 0, 25000}, eastward); /* ends 1.9 m off */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 1);
    w.kinds[SMALL_TANK].height_m = w.kinds[SMALL_CAR].height_m = 0.9; /* below both */
    assert_int_equal(pair_search_run(method_npsnet2_pairs), 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, pair_search_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_row_17_above_the_threshold_no_fixed_object_is_tested),
        TEST(test_row_17_resting_bodies_and_fallen_objects_are_not_tested),
        TEST(test_row_18_after_a_hit_on_a_fixed_object_no_moving_body_is_tested),
        TEST(test_row_37_a_border_object_is_found_late),
        TEST(test_row_37_an_object_of_its_own_square_is_found_in_time),
        TEST(test_row_20_radii_are_slightly_smaller_than_the_extent),
        TEST(test_a_munition_is_a_moving_object_and_apart_from_its_shooter),
        TEST(test_row_19_or_keeps_a_cross_of_the_map),
        TEST(test_row_19_level_1_is_100_m_in_x_or_z),
        TEST(test_row_24_table_2),
        TEST(test_row_25_vehicles_faster_than_216_kph_pass_through_each_other),
        TEST(test_row_25_how_many_pass_and_that_no_swept_method_misses_one),
        TEST(test_row_21_spheres_that_overlap_without_the_objects_are_no_collision),
        TEST(test_row_21_fixed_objects_have_their_polygons_and_their_size),
        TEST(test_row_21_an_object_is_hit_as_it_is_turned),
        TEST(test_row_21_a_contact_beside_the_line_of_centres_is_missed),
        TEST(test_row_21_rays_run_at_the_height_of_the_vehicle_and_not_along_the_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
