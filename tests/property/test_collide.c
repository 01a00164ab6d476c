/* Whole frames against what geometry says: nothing is passed through at any speed (thesis rows 23,
 * 25), nothing is hit that is passed by, and impulses keep momentum (rows 39, 43, 46). SEED=n runs
 * another set. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* --- tunnelling --------------------------------------------------------------------------------*/

#define PAIRS   200
#define AISLE_M 230.0 /* between the lanes of two pairs */

enum course { HEAD_ON, CROSSING, AT_TREE, COURSES };

static const double speeds_mps[] = {10.0, 60.0, 277.0, 1000.0, 3000.0};
static const double rates_hz[] = {10.0, 60.0};

struct run {
    enum course course;
    double speed_mps, hz;
    bool meets; /* else passes by */
};

/* One pair's lane: first runs east along z from `way` before x = 25000, clear of the other at
 * first; there the two are nearest, `beside` apart. */
struct lane {
    double z, beside, way;
};

static struct lane draw_lane(const struct run *run, double reach, uint32_t n, uint64_t *random)
{
    return (struct lane){
        .z = 1000.0 + AISLE_M * (double)n,
        .beside = reach * (run->meets ? fixture_uniform(random, 0.0, 0.999)
                                      : fixture_uniform(random, 1.001, 1.2)),
        .way = 1.5 * reach + run->speed_mps / run->hz * fixture_uniform(random, 1.0, 4.0),
    };
}

/* The text of a world with a tree in every lane, at x = 25000. */
static void tree_text(char *text, size_t bytes, const struct run *run, const struct lane *lanes)
{
    size_t used = (size_t)snprintf(text, bytes,
                                   "world = { seed = 1; capacity = 512; hz = %.1f; };\n"
                                   "collision = { shape = \"sphere\"; response = \"none\"; };\n"
                                   "objects = (\n",
                                   run->hz);
    for (uint32_t n = 0; n < PAIRS; n++)
        used += (size_t)snprintf(text + used, bytes - used,
                                 "{ kind = \"tree\"; at = [25000.0, %.9f]; }%s\n",
                                 lanes[n].z + lanes[n].beside, n + 1 < PAIRS ? "," : " );");
}

static void put_first(struct fixture *f, const struct run *run, const struct lane *lane,
                      const char *kind, double y)
{
    fixture_put(f, (struct fixture_entity){.kind = kind,
                                           .at = {25000.0 - lane->way, y, lane->z},
                                           .velocity = {run->speed_mps, 0.0, 0.0}});
}

static void put_second(struct fixture *f, const struct run *run, const struct lane *lane, double y)
{
    double way = lane->way;
    /* Crossing at right angles, `beside` is seen along the diagonal of the relative motion. */
    struct vec3 head_on = {25000.0 + way, y, lane->z + lane->beside};
    struct vec3 crossing = {25000.0 + lane->beside * 0.70710678118654752, y,
                            lane->z + way - lane->beside * 0.70710678118654752};
    bool opposite = run->course == HEAD_ON;
    fixture_put(f, (struct fixture_entity){
                       .kind = "helicopter",
                       .at = opposite ? head_on : crossing,
                       .velocity = opposite ? (struct vec3){-run->speed_mps, 0.0, 0.0}
                                            : (struct vec3){0.0, 0.0, -run->speed_mps}});
}

static void count_pairs(const struct fixture *f, const struct run *run, uint32_t met[PAIRS])
{
    const struct event *event;
    for (uint32_t n = 0; (event = fixture_event(f, EVENT_COLLISION, n)); n++) {
        uint32_t lane =
            run->course == AT_TREE ? event->collision.a.id - 1 : (event->collision.a.id - 1) / 2;
        if (run->course == AT_TREE)
            assert_int_equal(event->collision.b.fixed, 1);
        else
            assert_int_equal((event->collision.b.id - 1) / 2, lane);
        met[lane]++;
    }
}

static void run_lanes(const struct run *run, uint64_t *random)
{
    static char text[PAIRS * 80 + 400];
    struct lane lanes[PAIRS];
    struct fixture f;
    uint32_t met[PAIRS] = {0}, wrong = 0;
    bool tree = run->course == AT_TREE;
    double reach = tree ? 3.0 + (double)1.8f : 12.0;
    for (uint32_t n = 0; n < PAIRS; n++)
        lanes[n] = draw_lane(run, reach, n, random);
    if (tree)
        tree_text(text, sizeof text, run, lanes);
    else
        snprintf(text, sizeof text,
                 "world = { seed = 1; capacity = 512; hz = %.1f; };\n"
                 "collision = { shape = \"sphere\"; response = \"none\"; };\n",
                 run->hz);
    fixture_open(&f, text);
    for (uint32_t n = 0; n < PAIRS; n++) {
        double y = tree ? 100.0 : 500.0 + 60.0 * (double)n; /* lanes may cross, not touch */
        put_first(&f, run, &lanes[n], tree ? "tank" : "helicopter", y);
        if (!tree)
            put_second(&f, run, &lanes[n], y);
    }
    fixture_run(&f, 6 + (uint32_t)(1.5 * reach * run->hz / run->speed_mps));
    count_pairs(&f, run, met);
    for (uint32_t n = 0; n < PAIRS; n++)
        wrong += (met[n] > 0) != run->meets;
    if (wrong > 0)
        fail_msg("%u of %d wrong: course %d at %.0f m/s and %.0f Hz, should %s", wrong, PAIRS,
                 (int)run->course, run->speed_mps, run->hz, run->meets ? "meet" : "pass");
    fixture_close(&f);
}

static void run_course(enum course course, bool meets, uint64_t *random)
{
    for (size_t speed = 0; speed < sizeof speeds_mps / sizeof speeds_mps[0]; speed++) {
        for (size_t rate = 0; rate < sizeof rates_hz / sizeof rates_hz[0]; rate++)
            run_lanes(&(struct run){course, speeds_mps[speed], rates_hz[rate], meets}, random);
    }
}

static void test_row_25_head_on_none_is_missed(void **state)
{
    uint64_t random = fixture_seed(251);
    (void)state;
    run_course(HEAD_ON, true, &random);
}

static void test_row_25_head_on_none_is_false(void **state)
{
    uint64_t random = fixture_seed(252);
    (void)state;
    run_course(HEAD_ON, false, &random);
}

static void test_row_23_crossing_none_is_missed(void **state)
{
    uint64_t random = fixture_seed(231);
    (void)state;
    run_course(CROSSING, true, &random);
}

static void test_row_23_crossing_none_is_false(void **state)
{
    uint64_t random = fixture_seed(232);
    (void)state;
    run_course(CROSSING, false, &random);
}

static void test_row_23_no_tree_is_driven_through(void **state)
{
    uint64_t random = fixture_seed(233);
    (void)state;
    run_course(AT_TREE, true, &random);
}

static void test_row_23_no_tree_is_hit_that_is_passed(void **state)
{
    uint64_t random = fixture_seed(234);
    (void)state;
    run_course(AT_TREE, false, &random);
}

/* --- impulses ----------------------------------------------------------------------------------*/

#define IMPACTS 500

/* Two kinds of random mass and restitution that take any blow. */
static void draw_kinds(const struct fixture *f, uint64_t *random)
{
    static const char *const names[] = {"helicopter", "jet"};
    for (int i = 0; i < 2; i++) {
        struct kind *kind = steps_kind(f, names[i]);
        double power = fixture_uniform(random, -1.0, 6.0);
        kind->mass_kg = 1.0;
        for (; power > 0.0; power -= 1.0)
            kind->mass_kg *= power > 1.0 ? 10.0 : 1.0 + 9.0 * power;
        kind->restitution = fixture_random(random) % 4 == 0 ? 1.0 : fixture_uniform(random, 0, 1);
        kind->resistance_j = 1e300;
        kind->explosive_kg = 0.0;
    }
}

static struct vec3 draw_vector(uint64_t *random, double most)
{
    return (struct vec3){fixture_uniform(random, -most, most), fixture_uniform(random, -most, most),
                         fixture_uniform(random, -most, most)};
}

struct impact_pair {
    struct fixture_entity first, second;
};

/* Two aircraft that meet within the first frame. */
static struct impact_pair draw_impact(double dt_s, double reach, uint64_t *random)
{
    struct vec3 va = draw_vector(random, 400.0), vb = draw_vector(random, 400.0);
    double time = dt_s * fixture_uniform(random, 0.1, 0.9);
    struct vec3 apart = draw_vector(random, 1.0);
    struct vec3 meet = {25000.0 + fixture_uniform(random, -20000, 20000), 3000.0,
                        25000.0 + fixture_uniform(random, -20000, 20000)};
    apart = vec3_scale(apart, reach / maths_max(vec3_length(apart), 1e-3));
    double parting = vec3_dot(apart, vec3_sub(vb, va));
    if (fabs(parting) < 0.02 * reach * vec3_length(vec3_sub(vb, va)))
        return draw_impact(dt_s, reach, random); /* a graze may be one or not */
    if (parting > 0.0)                           /* they are nearing when they touch */
        apart = vec3_scale(apart, -1.0);
    return (struct impact_pair){
        {.kind = "helicopter", .at = vec3_sub(meet, vec3_scale(va, time)), .velocity = va},
        {.kind = "jet",
         .at = vec3_sub(vec3_add(meet, apart), vec3_scale(vb, time)),
         .velocity = vb}};
}

struct motion {
    struct vec3 momentum;
    double energy, scale; /* [J]; [N s] sum of sizes */
};

static struct motion motion_of(const struct fixture *f)
{
    struct entities e = steps_rows(f);
    struct motion motion = {{0.0, 0.0, 0.0}, 0.0, 0.0};
    for (uint32_t i = 0; i < 2; i++) {
        double mass = f->view.world.kinds[e.kind[i]].mass_kg;
        struct vec3 v = entities_velocity(&e, i);
        motion.momentum = vec3_add(motion.momentum, vec3_scale(v, mass));
        motion.energy += 0.5 * mass * vec3_dot(v, v);
        motion.scale += mass * vec3_length(v);
    }
    return motion;
}

static void put_pair(struct fixture *f, const struct impact_pair *pair, bool swapped)
{
    steps_empty(f);
    fixture_put(f, swapped ? pair->second : pair->first);
    fixture_put(f, swapped ? pair->first : pair->second);
}

static double difference(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static void test_impulses_keep_momentum_and_never_add_energy(void **state)
{
    uint64_t random = fixture_seed(43);
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (int n = 0; n < IMPACTS; n++) {
        draw_kinds(&f, &random);
        double reach = 13.0; /* helicopter 6 and jet 7 */
        struct impact_pair pair = draw_impact(1.0 / 60.0, reach, &random);
        put_pair(&f, &pair, false);
        struct motion before = motion_of(&f);
        fixture_run(&f, 1);
        struct motion after = motion_of(&f);
        struct entities e = steps_rows(&f);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
        assert_true(difference(before.momentum, after.momentum) <= 1e-12 * before.scale);
        assert_true(after.energy <= before.energy * (1.0 + 1e-12));
        /* Row 46: they are apart, to the nanometre, when the frame ends. */
        assert_true(difference(entities_position(&e, 0), entities_position(&e, 1)) >= reach - 1e-9);
    }
    fixture_close(&f);
}

static void test_impulses_do_not_know_who_comes_first(void **state)
{
    uint64_t random = fixture_seed(44);
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (int n = 0; n < IMPACTS; n++) {
        struct vec3 velocity[2][2], position[2][2];
        double harm[2][2];
        draw_kinds(&f, &random);
        struct impact_pair pair = draw_impact(1.0 / 60.0, 13.0, &random);
        for (int swapped = 0; swapped < 2; swapped++) {
            put_pair(&f, &pair, swapped);
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            for (uint32_t i = 0; i < 2; i++) {
                velocity[swapped][i] = entities_velocity(&e, i ^ (uint32_t)swapped);
                position[swapped][i] = entities_position(&e, i ^ (uint32_t)swapped);
                harm[swapped][i] = e.harm_j[i ^ (uint32_t)swapped];
            }
        }
        for (int i = 0; i < 2; i++) {
            assert_true(difference(velocity[0][i], velocity[1][i]) < 1e-6);
            assert_true(difference(position[0][i], position[1][i]) < 1e-9);
            assert_true(fabs(harm[0][i] - harm[1][i]) <= 1e-9 * harm[0][i]);
        }
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_25_head_on_none_is_missed),
        cmocka_unit_test(test_row_25_head_on_none_is_false),
        cmocka_unit_test(test_row_23_crossing_none_is_missed),
        cmocka_unit_test(test_row_23_crossing_none_is_false),
        cmocka_unit_test(test_row_23_no_tree_is_driven_through),
        cmocka_unit_test(test_row_23_no_tree_is_hit_that_is_passed),
        cmocka_unit_test(test_impulses_keep_momentum_and_never_add_energy),
        cmocka_unit_test(test_impulses_do_not_know_who_comes_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
