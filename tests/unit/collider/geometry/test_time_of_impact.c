/* Times of impact of boxes that can be worked out by hand. The random ones are in
 * tests/property/collider/geometry/test_time_of_impact.c. */
#include "collider/geometry/time_of_impact.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

/* A cube of half a side of 1; the same 10 m further along its nose; a plate below. */
#define CORNERS(x, y, z, half, high)                                                               \
    {x - half, y - high, z - half}, {x + half, y - high, z - half},                                \
        {x - half, y + high, z - half}, {x + half, y + high, z - half},                            \
        {x - half, y - high, z + half}, {x + half, y - high, z + half},                            \
        {x - half, y + high, z + half},                                                            \
    {                                                                                              \
        x + half, y + high, z + half                                                               \
    }
#define FACES(x, y, z, half, high)                                                                 \
    {{1, 0, 0}, x + half}, {{-1, 0, 0}, half - x}, {{0, 1, 0}, y + high}, {{0, -1, 0}, high - y},  \
        {{0, 0, 1}, z + half},                                                                     \
    {                                                                                              \
        {0, 0, -1}, half - z                                                                       \
    }

static const struct vec3 vertices[] = {CORNERS(0, 0, 0, 1, 1), CORNERS(10, 0, 0, 1, 1),
                                       CORNERS(0, -2, 0, 6, 0.1)};
static const struct hull_plane planes[] = {FACES(0, 0, 0, 1, 1), FACES(10, 0, 0, 1, 1),
                                           FACES(0, -2, 0, 6, 0.1)};
static const struct hull hulls[] = {
    {.vertex_count = 8, .plane_count = 6, .half = {1, 1, 1}, .radius_m = 1.7320508075688774},
    {.first_vertex = 8,
     .vertex_count = 8,
     .first_plane = 6,
     .plane_count = 6,
     .centre = {10, 0, 0},
     .half = {1, 1, 1},
     .radius_m = 1.7320508075688774},
    {.first_vertex = 16,
     .vertex_count = 8,
     .first_plane = 12,
     .plane_count = 6,
     .centre = {0, -2, 0},
     .half = {6, 0.1, 6},
     .radius_m = 8.49},
};

enum { CUBE, FAR_CUBE, PLATE };

static const struct vec3 still = {0, 0, 0};
static struct hull_contact impact;

/* hulls from first on, nose to the east. */
static struct swept_body put(uint32_t first, uint32_t count, struct vec3 at, struct vec3 along)
{
    struct quat east = rotation_of(HALF_PI, 0.0, 0.0);
    return (struct swept_body){.hull = &hulls[first],
                               .hull_count = count,
                               .vertices = vertices,
                               .planes = planes,
                               .scale = 1.0,
                               .bound_m = 12.0,
                               .path = {.at = at, .along = along},
                               .from = east,
                               .to = east};
}

static bool near(struct vec3 a, double x, double y, double z, double slack)
{
    return vec3_length(vec3_sub(a, (struct vec3){x, y, z})) <= slack;
}

/* --- from apart --------------------------------------------------------------------------------*/

static void test_cubes_meet_in_the_middle_of_the_shared_face(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){100, 0, 0}, (struct vec3){2, 0, 0});
    struct swept_body b = put(CUBE, 1, (struct vec3){104, 0.5, 0}, (struct vec3){-2, 0, 0});
    (void)state;
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact)); /* 2 m less the skin at 4 m a frame */
    assert_true(fabs(impact.toi - (2.0 - SKIN_M) / 4.0) < 1e-12);
    assert_true(near(impact.normal, 1, 0, 0, 1e-12));
    assert_true(near(impact.point, 102, 0.25, 0, 0.003));
    assert_true(impact.depth_m == 0.0);
    assert_true(fabs(time_of_impact_gap(&a, &b, impact.toi) - SKIN_M) < 1e-12);
}

static void test_they_do_not_reach_each_other_in_the_frame(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, (struct vec3){0.99, 0, 0});
    struct swept_body b = put(CUBE, 1, (struct vec3){4, 0, 0}, (struct vec3){-1.0, 0, 0});
    (void)state;
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(fabs(time_of_impact_gap(&a, &b, 1.0) - 0.01) < 1e-12);
    assert_true(time_of_impact_excluded(&a, &b, 0.0));
    assert_true(time_of_impact_within(&a, &b, 1.0, 0.0101));
    assert_false(time_of_impact_within(&a, &b, 1.0, 0.0099));
    assert_true(time_of_impact_gap_up_to(&a, &b, 1.0, 0.0101) == time_of_impact_gap(&a, &b, 1.0));
    assert_true(time_of_impact_gap_up_to(&a, &b, 1.0, 0.0099) > 0.0099);
}

static void test_a_path_that_began_in_mid_frame(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){3, 0, 0}, (struct vec3){-4, 0, 0});
    (void)state;
    b.path.since = 0.5;
    assert_true(time_of_impact_find(&a, &b, 0.5, &impact));
    assert_true(fabs(impact.toi - (0.5 + (1.0 - SKIN_M) / 4.0)) < 1e-12);
    assert_false(time_of_impact_excluded(&a, &b, 0.5));
    b.path.since = 0.8;
    assert_false(time_of_impact_find(&a, &b, 0.8, &impact));
    assert_true(time_of_impact_excluded(&a, &b, 0.8));
    b.path.since = 1.0;
    assert_false(time_of_impact_find(&a, &b, 1.0, &impact));
}

static void test_scale_counts(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){6, 0, 0}, (struct vec3){-4, 0, 0});
    (void)state;
    a.scale = 3.0;
    a.bound_m = 5.2;
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(fabs(impact.toi - (2.0 - SKIN_M) / 4.0) < 1e-12);
}

/* An edge comes round: the cube's diagonal is 1.414 from its axis. */
static void test_a_cube_rotating_on_the_spot_touches_with_its_edge(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){2.3, 0, 0}, still);
    (void)state;
    a.to = rotation_of(HALF_PI - 0.6, 0.0, 0.0);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    double turned = impact.toi, reach; /* at which the edge reaches 1.3 less the skin */
    struct quat now = rotation_between(a.from, a.to, turned);
    struct mat3 turn = rotation_matrix(now);
    reach = rotation_apply(&turn, (struct vec3){1, 0, 1}).x;
    if (rotation_apply(&turn, (struct vec3){1, 0, -1}).x > reach)
        reach = rotation_apply(&turn, (struct vec3){1, 0, -1}).x;
    assert_true(fabs(reach - (1.3 - SKIN_M)) < 1e-9);
    assert_true(near(impact.normal, 1, 0, 0, 1e-9));
    b.path.at.x = 2.42; /* and does not reach 1.42 */
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact));
}

/* An arm 10 m long comes round by half a turn, its end never heading for what it hits. */
static void test_an_arm_that_swings_round(void **state)
{
    struct swept_body a = put(FAR_CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){-9, 0, 0}, still);
    (void)state;
    a.to = rotation_of(3.0 * HALF_PI, 0.0, 0.0);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi > 0.7 && impact.toi < 1.0);
    assert_true(fabs(time_of_impact_gap(&a, &b, impact.toi) - SKIN_M) < 1e-9);
    b.path.at.x = 9.0;
    b.path.at.y = 2.5; /* above it */
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact));
}

/* The same beside a wide plate, whose sphere it is in from the start: as it begins, straight up, it
 * moves along the plate. */
static void test_an_arm_that_swings_down_on_a_plate(void **state)
{
    struct swept_body a = put(FAR_CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(PLATE, 1, (struct vec3){0, 0, 0}, still);
    (void)state;
    a.from = rotation_of(HALF_PI, HALF_PI, 0.0);
    a.to = rotation_spun(a.from, (struct vec3){0, 0, -3.0}, 1.0);
    b.scale = 3.0; /* its top is at -5.7 */
    b.bound_m = 27.0;
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(near(impact.normal, 0, -1, 0, 1e-9) && impact.point.y < -5.6);
    assert_true(fabs(time_of_impact_gap(&a, &b, impact.toi) - SKIN_M) < 1e-9);
}

/* --- from a touch ------------------------------------------------------------------------------*/

static void test_within_the_skin_only_what_comes_nearer_touches(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){2.0005, 0, 0}, (struct vec3){-1, 0, 0});
    (void)state;
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi == 0.0 && impact.depth_m == 0.0);
    assert_true(near(impact.normal, 1, 0, 0, 1e-12));
    b.path.along = still;
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact)); /* at rest */
    b.path.along = (struct vec3){0, 0.5, 0.3};
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact)); /* sliding */
    b.path.along = (struct vec3){1e-9, 0, 0};
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact)); /* parting */
    b.path.along = (struct vec3){-1e-9, 0, 0};
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact)); /* what rounding leaves */
    b.path.along = (struct vec3){-1e-5, 0, 0};
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact) && impact.toi == 0.0);
}

static void test_an_overlap_has_its_direction_and_depth(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(CUBE, 1, (struct vec3){0.5, 1.7, 0.4}, (struct vec3){0, -1, 0});
    (void)state;
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi == 0.0 && fabs(impact.depth_m - 0.3) < 1e-12);
    assert_true(near(impact.normal, 0, 1, 0, 1e-12));
    assert_true(near(impact.point, 0.25, 0.85, 0.2, 0.003));
    b.path.along = (struct vec3){-2, 0.001, 0}; /* deeper in, but not along the direction out */
    assert_false(time_of_impact_find(&a, &b, 0.0, &impact));
}

static void test_of_several_overlaps_the_deepest_is_told(void **state)
{
    struct swept_body a = put(CUBE, 2, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(PLATE, 1, (struct vec3){5, 2.95, 0}, (struct vec3){0, 1, 0});
    (void)state;
    /* The plate, 0.2 m thick, lies 0.05 m deep under both; tilted nose up it is deeper in the far
     * one. */
    b.path.at.y = 0.95;
    b.from = b.to = rotation_of(HALF_PI, 0.002, 0.0);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi == 0.0 && impact.point.x > 9.0);
    struct hull_contact swapped;
    assert_true(time_of_impact_find(&b, &a, 0.0, &swapped));
    assert_true(swapped.depth_m == impact.depth_m && swapped.point.x == impact.point.x);
    b.from = b.to = rotation_of(HALF_PI, -0.002, 0.0);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi == 0.0 && impact.point.x < 1.1);
}

/* A plate lies on a cube and tips over its middle: one side parts, the other digs in. */
static void test_where_the_middle_parts_the_side_that_digs_in_touches(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(PLATE, 1, (struct vec3){0, 3.1005, 0}, (struct vec3){0, 0.001, 0});
    (void)state;
    b.to = rotation_of(HALF_PI, 0.2, 0.0); /* nose up: the tail, in the west, goes down */
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi == 0.0 && near(impact.normal, 0, 1, 0, 1e-9));
    assert_true(impact.point.x < -0.99);
}

/* An arm lies beside a wall and swings away, at first faster than its body comes. */
static void test_what_parts_and_comes_back_touches_then(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b =
        put(FAR_CUBE, 1, (struct vec3){-10, 0, 4.0005}, (struct vec3){0, 0, -4.45});
    (void)state;
    a.scale = 3.0;
    b.to = rotation_of(HALF_PI + 0.5, 0.0, 0.0);
    assert_true(time_of_impact_gap(&a, &b, 0.5) > 0.03);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi > 0.5 && impact.toi < 1.0);
    assert_true(fabs(time_of_impact_gap(&a, &b, impact.toi) - SKIN_M) < 1e-9);
}

/* Edges across each other, half a micrometre apart; the upper one comes down ever faster. Across
 * faces they would overlap by far more than they do. */
static void test_edges_that_come_to_overlap_keep_their_normal(void **state)
{
    struct swept_body a = put(CUBE, 1, (struct vec3){0, 0, 0}, still);
    struct swept_body b = put(FAR_CUBE, 1, still, still);
    const double arm = 10.0 * sqrt(0.5);
    (void)state;
    a.from = a.to = rotation_of(HALF_PI, 0.0, 0.25 * PI); /* an edge along x on top */
    b.from = rotation_of(HALF_PI, 0.25 * PI, 0.0);        /* one along z at the bottom */
    b.to = rotation_of(HALF_PI, 0.25 * PI + 0.3, 0.0);
    b.path.at = (struct vec3){-arm, 2.0 * sqrt(2.0) + 5e-7 - arm, 0};
    b.path.along.y = 2e-6 - arm * rotation_speed(b.from, b.to, 0.0).z; /* at first it rises */
    assert_true(time_of_impact_gap(&a, &b, 0.0) > 4e-7 && time_of_impact_gap(&a, &b, 0.0) < 6e-7);
    assert_true(time_of_impact_find(&a, &b, 0.0, &impact));
    assert_true(impact.toi > 0.01 && impact.toi < 0.1);
    assert_true(fabs(impact.depth_m - 0.5 * SKIN_M) < 1e-5);
    assert_true(near(impact.normal, 0, 1, 0, 1e-3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cubes_meet_in_the_middle_of_the_shared_face),
        cmocka_unit_test(test_they_do_not_reach_each_other_in_the_frame),
        cmocka_unit_test(test_a_path_that_began_in_mid_frame),
        cmocka_unit_test(test_scale_counts),
        cmocka_unit_test(test_a_cube_rotating_on_the_spot_touches_with_its_edge),
        cmocka_unit_test(test_an_arm_that_swings_round),
        cmocka_unit_test(test_an_arm_that_swings_down_on_a_plate),
        cmocka_unit_test(test_within_the_skin_only_what_comes_nearer_touches),
        cmocka_unit_test(test_an_overlap_has_its_direction_and_depth),
        cmocka_unit_test(test_of_several_overlaps_the_deepest_is_told),
        cmocka_unit_test(test_where_the_middle_parts_the_side_that_digs_in_touches),
        cmocka_unit_test(test_what_parts_and_comes_back_touches_then),
        cmocka_unit_test(test_edges_that_come_to_overlap_keep_their_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
