/* The guard at a frame's end skips hulls that a known plane separates. It has to find the same
 * depth to the bit as the search of all hulls. SEED=n tries other pairs. */
#include "collider/geometry/level_exit.h"
#include "collider/geometry/level_gap.h"
#include "collider/narrow_phase/separating_axis.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define PAIRS     3000
#define GAPS_MOST 64u
#define MOVES     8 /* of each pair, with the planes of the place before */

static const char *const kinds[] = {"tank", "jeep", "truck", "helicopter"};

static struct fixture f;

static double uniform(uint64_t *random, double low, double high)
{
    return fixture_uniform(random, low, high);
}

static struct vec3 random_place(uint64_t *random, double far)
{
    return (struct vec3){25000.0 + uniform(random, -far, far), 100.0 + uniform(random, -0.2, 0.2),
                         25000.0 + uniform(random, -far, far)};
}

/* A body of a random kind that stands nearly upright. */
static struct swept_body random_body(uint64_t *random)
{
    const struct world *world = &f.view.world;
    const struct kind *kind = steps_kind(&f, kinds[fixture_random(random) % 4]);
    struct quat turn = rotation_of(uniform(random, 0.0, TWO_PI), uniform(random, -0.2, 0.2),
                                   uniform(random, -0.2, 0.2));
    return (struct swept_body){.hull = world->hulls + kind->first_hull,
                               .hull_count = kind->hull_count,
                               .outer = world->hulls + kind->outer_hull,
                               .vertices = world->hull_vertices,
                               .planes = world->hull_planes,
                               .scale = 1.0,
                               .bound_m = kind->bound_m,
                               .path = {.at = random_place(random, 3.0)},
                               .from = turn,
                               .to = turn};
}

static void move(uint64_t *random, struct swept_body *body)
{
    struct vec3 spin = {0.0, uniform(random, -0.02, 0.02), 0.0};
    struct vec3 by = {uniform(random, -0.05, 0.05), 0.0, uniform(random, -0.05, 0.05)};
    body->path.at = vec3_add(body->path.at, by);
    body->from = body->to = rotation_spun(body->from, spin, 1.0);
}

/* A plane that may separate nothing, or 0. */
static struct vec3 random_plane(uint64_t *random)
{
    struct vec3 n = {uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0),
                     uniform(random, -1.0, 1.0)};
    double length = vec3_length(n);
    return length < 0.3 ? (struct vec3){0.0, 0.0, 0.0} : vec3_scale(n, 1.0 / length);
}

/* A memory of any numbers: it is a hint, which may be of another pair or no sense at all. */
static struct level_gap_memory random_memory(uint64_t *random)
{
    struct level_gap_memory memory;
    for (uint32_t i = 0; i < PERSISTENT_CONTACT_NEAREST; i++) {
        struct nearest_vertices *nearest = &memory.nearest[i];
        nearest->hulls = (uint8_t)(fixture_random(random) % 4);
        nearest->count = (uint8_t)(fixture_random(random) % 5);
        for (uint32_t k = 0; k < 3; k++) {
            nearest->a[k] = (uint8_t)(fixture_random(random) % 40);
            nearest->b[k] = (uint8_t)(fixture_random(random) % 40);
        }
    }
    return memory;
}

static struct axis_side side_of(const struct turned_body *turned)
{
    struct axis_side side;
    axis_side_set(&side, turned->body, 0.0, 0.0);
    return side;
}

/* Returns the depth of two bodies, after a comparison of all ways to find it. */
static double compare(const struct swept_body *a, const struct swept_body *b, struct vec3 *plane,
                      const struct level_gap_memory *memory)
{
    const struct turned_body turned_a = {a, rotation_matrix(a->from)};
    const struct turned_body turned_b = {b, rotation_matrix(b->from)};
    struct axis_side side_a = side_of(&turned_a), side_b = side_of(&turned_b);
    double all = level_gap_least(a, b, 0.0, 0.0);
    bool proof = vec3_dot(plane[0], plane[0]) > 0.0 &&
                 separating_axis_holds(&side_a, &side_b, plane[0], 0.0);
    assert_false(proof && all < 0.0);
    assert_true(level_gap_depth(&turned_a, &turned_b, plane, memory) == all);
    return all;
}

static void test_known_planes_change_no_depth(void **state)
{
    (void)state;
    uint64_t random = fixture_seed(13);
    uint32_t apart = 0, overlap = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct vec3 plane[LEVEL_GAP_PLANES] = {random_plane(&random), random_plane(&random)};
        struct swept_body a = random_body(&random), b = random_body(&random);
        for (uint32_t n = 0; n < MOVES; n++) {
            struct level_gap_memory memory = random_memory(&random);
            if (compare(&a, &b, plane, &memory) < 0.0)
                overlap++;
            else
                apart++;
            move(&random, &b);
        }
    }
    print_message("%u places apart, %u in each other\n", apart, overlap);
    assert_true(apart > PAIRS && overlap > PAIRS);
    fixture_close(&f);
}

/* The guard measures no pair that was farther apart than its bodies have come. */
static void test_the_distance_of_all_hulls_is_told(void **state)
{
    const double margin_m = 0.5;
    (void)state;
    uint64_t random = fixture_seed(14);
    uint32_t apart = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        struct level_gap gap[LEVEL_GAPS_MAX];
        double told, exact = maths_min(margin_m, time_of_impact_gap(&a, &b, 0.0));
        struct level_gap_memory memory = random_memory(&random);
        const struct turned_body turned_a = {&a, rotation_matrix(a.from)};
        const struct turned_body turned_b = {&b, rotation_matrix(b.from)};
        level_gap_find_more(&turned_a, &turned_b, margin_m, gap, LEVEL_GAPS_MAX, &told, &memory);
        assert_true(fabs(told - exact) < 1e-9);
        apart += told > 0.0;
    }
    assert_true(apart > PAIRS / 20 && apart < PAIRS);
    fixture_close(&f);
}

/* The guard measures no pair whose near hulls are still apart across the planes that were found
 * when the frame began, if the others were farther apart than the bodies have come since then. */
static void test_planes_that_hold_prove_a_gap(void **state)
{
    const double margin_m = 0.2;
    (void)state;
    uint64_t random = fixture_seed(17);
    uint32_t held = 0, broken = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        struct turned_body turned_a = {&a, rotation_matrix(a.from)};
        struct turned_body turned_b = {&b, rotation_matrix(b.from)};
        struct level_gap_memory memory = {0};
        struct level_gap gap[LEVEL_GAPS_MAX];
        double told;
        uint32_t count = level_gap_find_more(&turned_a, &turned_b, margin_m, gap, LEVEL_GAPS_MAX,
                                             &told, &memory);
        if (count == 0 || count == LEVEL_GAPS_MAX)
            continue;
        bool overlapped = gap[0].gap_m < 0.0;
        move(&random, &b); /* by less than the margin, but for the ends of long bodies */
        turned_b.turn = rotation_matrix(b.from);
        if (!level_gap_planes_hold(&turned_a, &turned_b, gap, count)) {
            broken++;
            continue;
        }
        assert_false(overlapped);
        held++;
        for (uint32_t n = 0; n < count; n++) {
            uint32_t hulls = gap[n].hulls;
            struct swept_body hull_a = a, hull_b = b;
            hull_a.hull = &a.hull[hulls / HULLS_A_MODEL];
            hull_b.hull = &b.hull[hulls % HULLS_A_MODEL];
            hull_a.hull_count = hull_b.hull_count = 1;
            assert_true(time_of_impact_gap(&hull_a, &hull_b, 0.0) > 0.0);
        }
    }
    print_message("planes of %u pairs hold, of %u not\n", held, broken);
    assert_true(held > PAIRS / 50 && broken > PAIRS / 50);
    fixture_close(&f);
}

/* A search that begins where the last one ended, or anywhere, finds the same gaps. */
static void test_a_memory_changes_no_gap(void **state)
{
    const double margin_m = 0.5;
    (void)state;
    uint64_t random = fixture_seed(16);
    uint32_t gaps = 0, remembered = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        struct level_gap_memory memory = random_memory(&random);
        for (uint32_t n = 0; n < MOVES; n++, move(&random, &b)) {
            struct level_gap cold[LEVEL_GAPS_MAX], warm[LEVEL_GAPS_MAX];
            double apart;
            const struct turned_body turned_a = {&a, level_gap_turn(&a, 0.0)};
            const struct turned_body turned_b = {&b, level_gap_turn(&b, 0.0)};
            uint32_t count = level_gap_find(&a, &b, 0.0, margin_m, NULL, cold);
            assert_int_equal(level_gap_find_more(&turned_a, &turned_b, margin_m, warm,
                                                 LEVEL_GAPS_MAX, &apart, &memory),
                             count);
            for (uint32_t g = 0; g < count; g++)
                assert_true(fabs(warm[g].gap_m - cold[g].gap_m) < 1e-6);
            gaps += count;
            remembered += memory.nearest[0].count > 0;
        }
    }
    print_message("%u gaps, %u remembered\n", gaps, remembered);
    assert_true(gaps > PAIRS && remembered > PAIRS / 10);
    fixture_close(&f);
}

/* A search that is continued with a wider margin finds what one with that margin finds at once. */
static void test_a_search_can_be_continued(void **state)
{
    const double first_m = 0.05, margin_m = 0.5;
    (void)state;
    uint64_t random = fixture_seed(17);
    uint32_t more = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        struct level_gap once[GAPS_MOST], twice[GAPS_MOST];
        struct level_gap_memory memory = random_memory(&random), same = memory;
        double apart;
        const struct turned_body turned_a = {&a, level_gap_turn(&a, 0.0)};
        const struct turned_body turned_b = {&b, level_gap_turn(&b, 0.0)};
        uint32_t count =
            level_gap_find_more(&turned_a, &turned_b, margin_m, once, GAPS_MOST, &apart, &memory);
        uint32_t first =
            level_gap_find_more(&turned_a, &turned_b, first_m, twice, GAPS_MOST, &apart, &same);
        assert_int_equal(
            level_gap_find_wider(&turned_a, &turned_b, margin_m, twice, first, GAPS_MOST, &same),
            count);
        for (uint32_t g = 0; g < count; g++)
            assert_true(fabs(once[g].gap_m - twice[g].gap_m) < 1e-6);
        more += first > 0 && count > first;
    }
    print_message("%u searches went on\n", more);
    assert_true(more > PAIRS / 20);
    fixture_close(&f);
}

/* The way out of one body is the same if only the hulls within its reach are looked at. Rarely a
 * face of a hull beyond shows a shorter one, by chance: where two edges of hulls meet no face does.
 */
static void test_hulls_out_of_reach_change_no_way(void **state)
{
    struct level_exit search;
    (void)state;
    uint64_t random = fixture_seed(18);
    uint32_t ways = 0, longer = 0;
    assert_int_equal(level_exit_init(&search), 0);
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS / 4; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        struct vec3 normal, same;
        struct exit_slope slope = {fixture_uniform(&random, -0.5, 0.5),
                                   fixture_uniform(&random, -0.5, 0.5)};
        level_exit_begin(&search, slope);
        level_exit_add(&search, &a, &b, false);
        double way_m = level_exit_find(&search, false, &normal);
        double same_m = level_exit_of(&search, slope, &a, &b, &same);
        assert_true(same_m >= way_m - 1e-9 && (same_m < INFINITY || way_m == INFINITY));
        longer += same_m > way_m + 1e-9;
        ways += way_m < INFINITY && way_m > 0.5;
    }
    print_message("%u ways longer than half a metre, %u not the shortest\n", ways, longer);
    assert_true(ways > PAIRS / 20 && longer < PAIRS / 200);
    fixture_close(&f);
    level_exit_free(&search);
}

/* An axis that is found, in whatever way, is kept, and shows the same again. */
static void test_an_axis_that_is_found_holds(void **state)
{
    (void)state;
    uint64_t random = fixture_seed(15);
    uint32_t found = 0;
    fixture_open(&f, "world = { seed = 1; };\ncollision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct swept_body a = random_body(&random), b = random_body(&random);
        const struct turned_body turned_a = {&a, rotation_matrix(a.from)};
        const struct turned_body turned_b = {&b, rotation_matrix(b.from)};
        struct axis_side side_a = side_of(&turned_a), side_b = side_of(&turned_b);
        struct vec3 axis = {0.0, 0.0, 0.0};
        double apart;
        if (!separating_axis_find(&side_a, &side_b, 0.0, true, &axis, &apart))
            continue;
        found++;
        assert_true(apart > 0.0 && apart < time_of_impact_gap(&a, &b, 0.0) + 1e-9);
        assert_true(fabs(vec3_length(axis) - 1.0) < 1e-9);
        assert_true(separating_axis_holds(&side_a, &side_b, axis, 0.0));
    }
    assert_true(found > PAIRS / 20);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_planes_change_no_depth),
        cmocka_unit_test(test_the_distance_of_all_hulls_is_told),
        cmocka_unit_test(test_planes_that_hold_prove_a_gap),
        cmocka_unit_test(test_a_memory_changes_no_gap),
        cmocka_unit_test(test_a_search_can_be_continued),
        cmocka_unit_test(test_hulls_out_of_reach_change_no_way),
        cmocka_unit_test(test_an_axis_that_is_found_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
