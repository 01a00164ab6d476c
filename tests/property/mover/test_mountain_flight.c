/* Aircraft of agents and scripts fly over the White Mountains, helicopters also over woods, and
 * none of them strikes the ground or what stands on it. SEED=n begins with another seed, SEEDS=n
 * runs so many of each. */
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define HZ       20u
#define SECONDS  600u
#define JETS     20u
#define HOVERING 36u /* helicopters */
#define ROWS     36u /* aircraft at most */
#define POINTS   5
#define HEIGHT_M 60.0 /* that the scripts give */

static struct fixture f;

static uint64_t seeds(void)
{
    const char *more = getenv("SEEDS");
    return more ? strtoull(more, NULL, 10) : 8;
}

static void open_mountains(uint64_t seed, const char *groups)
{
    static char text[16384];
    (void)snprintf(
        text, sizeof text,
        "world = { seed = %u; capacity = 256; hz = %u.0; };\n"
        "terrain = { source = \"file\"; file = \"%s/grounds/white-mountains.ground\"; };\n"
        "%s",
        (unsigned)(seed & 0xffff), HZ, fixture_shipped_dir(), groups);
    fixture_open(&f, text);
}

/* Returns how many aircraft have struck anything but another vehicle before they were damaged, by
 * the latest events. damaged: by id, from one call to the next. */
static uint32_t crashes(bool damaged[ROWS + 1])
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++) {
        const struct event_collision *c = &fixture_event(&f, EVENT_COLLISION, n)->collision;
        bool alone = c->b.fixed || c->b.id == 0;
        if (!alone && c->b.id <= ROWS)
            damaged[c->b.id] = true;
        if (c->a.id > ROWS || damaged[c->a.id])
            continue;
        damaged[c->a.id] = true;
        count += alone;
        if (alone)
            print_message("aircraft %u strikes at (%.0f, %.0f)\n", c->a.id, c->point[0],
                          c->point[2]);
    }
    return count;
}

/* Jets on patrol choose the next place when they are near the last one: they turn over valleys and
 * towards slopes. */
static void test_agents_do_not_fly_into_mountains(void **state)
{
    uint64_t seed = fixture_seed(1);
    uint32_t struck = 0;
    (void)state;
    for (uint64_t n = 0; n < seeds(); n++) {
        open_mountains(seed + n, "vehicles = (\n"
                                 "  { kind = \"jet\"; count = 20;\n"
                                 "    area = [19000.0, 26000.0, 29000.0, 36000.0]; },\n"
                                 "  { kind = \"helicopter\"; count = 10;\n"
                                 "    area = [19000.0, 26000.0, 29000.0, 36000.0]; } );");
        bool damaged[ROWS + 1] = {false};
        for (uint32_t second = 0; second < SECONDS; second++) {
            fixture_continue(&f, HZ);
            struck += crashes(damaged);
        }
        fixture_close(&f);
    }
    assert_int_equal(struck, 0);
}

/* They begin at 70 m/s and 80 m, some of them before slopes of 40 degrees. */
static void test_jets_that_begin_low_live(void **state)
{
    uint64_t seed = fixture_seed(1);
    uint32_t struck = 0;
    (void)state;
    for (uint64_t n = 0; n < seeds(); n++) {
        open_mountains(seed + n, "vehicles = ( { kind = \"jet\"; count = 36; altitude_m = 80.0;\n"
                                 "  area = [17000.0, 17000.0, 33000.0, 33000.0]; } );");
        bool damaged[ROWS + 1] = {false};
        for (uint32_t second = 0; second < 20; second++) {
            fixture_continue(&f, HZ);
            struck += crashes(damaged);
        }
        fixture_close(&f);
    }
    assert_int_equal(struck, 0);
}

/* Some aircraft of a kind, each with a script from place to place in a square. */
struct scripted {
    const char *kind;
    uint32_t count;
    double side_m; /* around the middle */
    double low_mps, high_mps, low_m, high_m;
};

static void write_scripts(char *text, size_t size, const struct scripted *all, uint64_t *random)
{
    int at = snprintf(text, size, "scripts = (");
    double from = 25000.0 - 0.5 * all->side_m, to = from + all->side_m;
    for (uint32_t n = 0; n < all->count; n++) {
        double speed = fixture_uniform(random, all->low_mps, all->high_mps);
        double height = fixture_uniform(random, all->low_m, all->high_m);
        at += snprintf(text + at, size - (size_t)at, "%s{ name = \"s%u\"; repeat = true; steps = (",
                       n ? ", " : "", n);
        for (int point = 0; point < POINTS; point++)
            at += snprintf(text + at, size - (size_t)at,
                           "%s{ go = [%.1f, %.1f]; speed_mps = %.1f; altitude_m = %.1f; }",
                           point ? ", " : "", fixture_uniform(random, from, to),
                           fixture_uniform(random, from, to), speed, height);
        at += snprintf(text + at, size - (size_t)at, "); }");
    }
    at += snprintf(text + at, size - (size_t)at, ");\nvehicles = (");
    for (uint32_t n = 0; n < all->count; n++)
        at += snprintf(text + at, size - (size_t)at,
                       "%s{ kind = \"%s\"; script = \"s%u\"; altitude_m = 300.0; }", n ? ", " : "",
                       all->kind, n);
    (void)snprintf(text + at, size - (size_t)at, "); collision = { shape = \"model\"; };");
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* They follow the ground as a jet can: low where it is even, and over each ridge in time. */
static void test_scripted_jets_follow_the_ground(void **state)
{
    static double over[JETS * SECONDS];
    static char groups[12288];
    uint64_t seed = fixture_seed(1);
    uint32_t struck = 0;
    (void)state;
    for (uint64_t n = 0; n < seeds(); n++) {
        uint64_t random = seed + n;
        uint32_t count = 0;
        bool damaged[ROWS + 1] = {false};
        const struct scripted jets = {"jet", JETS, 44000.0, 200.0, 200.0, HEIGHT_M, HEIGHT_M};
        write_scripts(groups, sizeof groups, &jets, &random);
        open_mountains(seed + n, groups);
        for (uint32_t second = 0; second < SECONDS; second++) {
            fixture_continue(&f, HZ);
            struck += crashes(damaged);
            for (uint32_t row = 0; row < JETS; row++) {
                struct vec3 at = steps_position(&f, row);
                over[count] = at.y - steps_ground_at(&f, at.x, at.z);
                count += steps_rows(&f).row[row].state == ENTITY_ACTIVE;
            }
        }
        qsort(over, count, sizeof over[0], by_size);
        print_message("over the ground: 1 of 100 lower than %.0f m, half than %.0f m\n",
                      over[count / 100], over[count / 2]);
        /* Two whose ways cross may meet in the air. */
        assert_true(count > JETS * SECONDS * 9 / 10);
        assert_true(over[count / 100] > 0.3 * HEIGHT_M && over[count / 2] < 4.0 * HEIGHT_M);
        fixture_close(&f);
    }
    assert_int_equal(struck, 0);
}

/* Lets helicopters of scripts fly low over the ground of an open world. Returns how many struck
 * something. */
static uint32_t fly_low(uint64_t seed, void open(uint64_t seed, const char *groups))
{
    static double over[HOVERING * SECONDS];
    static char groups[16000];
    uint32_t struck = 0;
    for (uint64_t n = 0; n < seeds(); n++) {
        uint64_t random = seed + n;
        uint32_t count = 0;
        bool damaged[ROWS + 1] = {false};
        const struct scripted low = {"helicopter", HOVERING, 8000.0, 20.0, 75.0, 5.0, 20.0};
        write_scripts(groups, sizeof groups, &low, &random);
        open(seed + n, groups);
        for (uint32_t second = 0; second < SECONDS; second++) {
            fixture_continue(&f, HZ);
            struck += crashes(damaged);
            for (uint32_t row = 0; row < HOVERING && second >= 60; row++) {
                struct vec3 at = steps_position(&f, row);
                over[count] = at.y - steps_ground_at(&f, at.x, at.z);
                count += steps_rows(&f).row[row].state == ENTITY_ACTIVE;
            }
        }
        qsort(over, count, sizeof over[0], by_size);
        print_message("over the ground: 1 of 100 lower than %.0f m, half than %.0f m\n",
                      over[count / 100], over[count / 2]);
        assert_true(over[count / 2] < 50.0);
        fixture_close(&f);
    }
    return struck;
}

/* As low and as fast as they are told, where the ground lets them: they rise and slow down before
 * slopes of up to 45 degrees. */
static void test_scripted_helicopters_stay_off_slopes(void **state)
{
    (void)state;
    assert_int_equal(fly_low(fixture_seed(1), open_mountains), 0);
}

/* Woods of pines, roads with poles, and buildings. */
static void open_woods(uint64_t seed, const char *groups)
{
    static char text[16384];
    (void)snprintf(text, sizeof text,
                   "world = { seed = %u; capacity = 256; hz = %u.0; };\n"
                   "terrain = { source = \"generated\"; }; objects = { source = \"table1\"; };\n%s",
                   (unsigned)(seed & 0xffff), HZ, groups);
    fixture_open(&f, text);
}

static void test_scripted_helicopters_stay_off_trees(void **state)
{
    (void)state;
    assert_int_equal(fly_low(fixture_seed(1), open_woods), 0);
}

/* Waves of ground, of which a tenth is steeper than 60 degrees. */
static double steep(double x, double z, const void *context)
{
    (void)context;
    double broad = 400.0 * maths_sin(x / 900.0 + 1.3 * maths_sin(z / 700.0));
    double middle = 200.0 * maths_sin(z / 310.0 + 1.1 * maths_sin(x / 400.0));
    double narrow = 60.0 * maths_sin((x + z) / 110.0 + maths_sin(x / 170.0));
    return 1500.0 + 1.5 * (broad + middle + narrow + 20.0 * maths_sin((x - 0.7 * z) / 40.0));
}

static void test_agents_do_not_fly_into_steep_slopes(void **state)
{
    uint64_t seed = fixture_seed(1);
    uint32_t struck = 0;
    (void)state;
    for (uint64_t n = 0; n < seeds(); n++) {
        char text[400];
        bool damaged[ROWS + 1] = {false};
        (void)snprintf(text, sizeof text,
                       "world = { seed = %u; capacity = 64; hz = %u.0; };\n"
                       "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 31.25; };\n"
                       "collision = { shape = \"model\"; };\n"
                       "vehicles = ( { kind = \"helicopter\"; count = 36; altitude_m = 3000.0;\n"
                       "  area = [21000.0, 21000.0, 29000.0, 29000.0]; } );",
                       (unsigned)((seed + n) & 0xffff), HZ);
        fixture_open(&f, text);
        steps_ground(&f, steep, NULL);
        fixture_forget_copies(&f);
        for (uint32_t second = 0; second < SECONDS; second++) {
            fixture_continue(&f, HZ);
            struck += crashes(damaged);
        }
        fixture_close(&f);
    }
    assert_int_equal(struck, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agents_do_not_fly_into_mountains),
        cmocka_unit_test(test_jets_that_begin_low_live),
        cmocka_unit_test(test_scripted_jets_follow_the_ground),
        cmocka_unit_test(test_scripted_helicopters_stay_off_slopes),
        cmocka_unit_test(test_scripted_helicopters_stay_off_trees),
        cmocka_unit_test(test_agents_do_not_fly_into_steep_slopes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
