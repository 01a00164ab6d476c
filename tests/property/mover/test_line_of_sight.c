/* Lines of sight against an oracle that follows them in small steps. Where a line grazes an
 * obstacle the oracle cannot decide, and the line is not compared. */
#include "mover/query/line_of_sight.h"
#include "tests/support/steps.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define STEP_M   0.05
#define CORNER_M 0.3  /* how long it must be hidden */
#define GRAZE_M  0.02 /* how much higher or lower the line must be for the oracle to be sure */

enum verdict { CLEAR, HIDDEN, GRAZES };

static struct fixture f;
static struct line_of_sight sight;
static uint8_t damage[64];

static void look_at(const char *text)
{
    fixture_open(&f, text);
    assert_int_equal(line_of_sight_init(&sight, &f.view.world, &f.stepper.mover.craters), 0);
    sight.fixed_damage = damage;
    memset(damage, 0, sizeof damage);
}

static int close_world(void **state)
{
    (void)state;
    line_of_sight_free(&sight);
    fixture_close(&f);
    return 0;
}

/* Height of the ground, or of what stands on it here; where an end of the line is in an object the
 * object does not count. */
static bool in_box(const struct fixed_object *object, double x, double z, double slack)
{
    const struct kind *kind = &f.view.world.kinds[object->kind];
    double scale = fixed_scale(object, kind), sine, cosine;
    maths_sincos(fixed_heading(object), &sine, &cosine);
    double dx = x - object->x, dz = z - object->z;
    return fabs(dx * sine - dz * cosine) < 0.5 * scale * kind->length_m + slack &&
           fabs(dx * cosine + dz * sine) < 0.5 * scale * kind->width_m + slack;
}

static double top_at(double x, double z, struct vec3 from, struct vec3 to, double slack)
{
    const struct world *world = &f.view.world;
    double top = steps_ground_at(&f, x, z);
    for (uint32_t n = 0; n < world->counts.fixed; n++) {
        const struct fixed_object *object = &world->fixed[n];
        const struct kind *kind = &world->kinds[object->kind];
        if (kind->object_class == OBJECT_POLE || !in_box(object, x, z, slack) ||
            in_box(object, from.x, from.z, 0.0) || in_box(object, to.x, to.z, 0.0))
            continue;
        top = maths_max(top, (double)object->y + kind->height_m * fixed_scale(object, kind) *
                                                     line_of_sight_kept((enum damage)damage[n]));
    }
    return top;
}

static enum verdict oracle(struct vec3 from, struct vec3 to)
{
    struct vec3 way = vec3_sub(to, from);
    uint32_t steps = (uint32_t)(sqrt(way.x * way.x + way.z * way.z) / STEP_M) + 1;
    uint32_t run = 0;
    bool grazes = false;
    for (uint32_t n = 0; n <= steps; n++) {
        struct vec3 at = vec3_lerp(from, to, (double)n / steps);
        run = top_at(at.x, at.z, from, to, -GRAZE_M) > at.y + GRAZE_M ? run + 1 : 0;
        if (run * STEP_M > CORNER_M)
            return HIDDEN;
        grazes |= top_at(at.x, at.z, from, to, GRAZE_M + STEP_M) > at.y - GRAZE_M;
    }
    return grazes ? GRAZES : CLEAR;
}

/* Of lines of sight between random points; each verdict must come at least that often. */
static void agree(uint64_t *random, double x, double z, double half_m, double high_m, int lines,
                  int least)
{
    int seen[3] = {0};
    for (int n = 0; n < lines; n++) {
        struct vec3 end[2];
        for (int e = 0; e < 2; e++) {
            end[e].x = fixture_uniform(random, x - half_m, x + half_m);
            end[e].z = fixture_uniform(random, z - half_m, z + half_m);
            end[e].y =
                steps_ground_at(&f, end[e].x, end[e].z) + fixture_uniform(random, 0.5, high_m);
        }
        enum verdict verdict = oracle(end[0], end[1]);
        seen[verdict]++;
        for (int e = 0; e < 2 && verdict != GRAZES; e++) {
            if (line_of_sight_clear(&sight, end[e], end[!e]) != (verdict == CLEAR))
                fail_msg("%s from (%.3f, %.3f, %.3f) to (%.3f, %.3f, %.3f)",
                         verdict == CLEAR ? "nothing is between"
                                          : "it sees through what is between",
                         end[e].x, end[e].y, end[e].z, end[!e].x, end[!e].y, end[!e].z);
        }
    }
    print_message("%d clear, %d hidden, %d graze\n", seen[CLEAR], seen[HIDDEN], seen[GRAZES]);
    assert_true(seen[CLEAR] >= least && seen[HIDDEN] >= least);
}

static double rough(double x, double z, const void *context)
{
    uint64_t random =
        *(const uint64_t *)context + (uint64_t)(x * 3.0) * 50021u + (uint64_t)(z * 7.0);
    return 100.0 + fixture_uniform(&random, 0.0, 12.0);
}

static void test_over_rough_ground(void **state)
{
    static const char *const spacing[] = {"125", "62.5", "31.25"};
    uint64_t random = fixture_seed(17), ground = random;
    (void)state;
    for (int n = 0; n < 3; n++) {
        char text[200];
        snprintf(text, sizeof text,
                 "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = %s; };", spacing[n]);
        if (n > 0)
            close_world(NULL);
        look_at(text);
        steps_ground(&f, rough, &ground);
        line_of_sight_free(&sight);
        assert_int_equal(line_of_sight_init(&sight, &f.view.world, &f.stepper.mover.craters), 0);
        sight.fixed_damage = damage;
        agree(&random, 25000.0, 25000.0, 400.0, 12.0, 150, 8);
        agree(&random, 49800.0, 200.0, 199.0, 12.0, 60, 0);
    }
}

static void test_over_earthworks(void **state)
{
    uint64_t random = fixture_seed(20);
    (void)state;
    look_at("earthworks = ("
            "{ shape = \"ramp\"; at = [25000.0, 24950.0]; length_m = 12.0; width_m = 8.0;"
            "  height_m = 2.5; },"
            "{ shape = \"table\"; at = [25040.0, 25010.0]; heading_deg = 40.0; length_m = 60.0;"
            "  width_m = 30.0; height_m = 5.0; edge_m = 6.0; grade_percent = 40.0; },"
            "{ shape = \"trench\"; at = [24960.0, 25020.0]; length_m = 6.0; width_m = 60.0;"
            "  depth_m = 2.0; } );");
    agree(&random, 25000.0, 25000.0, 80.0, 4.0, 3000, 100);
}

static void test_over_the_lips_of_craters(void **state)
{
    uint64_t random = fixture_seed(23);
    (void)state;
    look_at("");
    struct crater *craters = f.view.w[0].craters;
    for (uint32_t n = 0; n < 12; n++)
        craters[n] = (struct crater){.x = 24930.0 + 46.0 * (n % 4), /* apart: rims are no cliffs */
                                     .z = 24950.0 + 46.0 * (double)(n / 4),
                                     .radius_m = (float)fixture_uniform(&random, 2.0, 15.0),
                                     .depth_m = (float)fixture_uniform(&random, 1.0, 5.0)};
    crater_index_update(&f.stepper.mover.craters, 12);
    f.view.w[0].head->crater_count = 12; /* for steps_ground_at */
    agree(&random, 25000.0, 25000.0, 60.0, 0.9, 300, 5);
}

static const char wood[] =
    "objects = (\n"
    "  { kind = \"tree\"; at = [25000.0, 25000.0]; heading_deg = 20.0; },\n"
    "  { kind = \"tree\"; at = [25001.0, 25020.0]; heading_deg = 70.0; },\n"
    "  { kind = \"pine\"; at = [24980.0, 25010.0]; },\n"
    "  { kind = \"bush\"; at = [25020.0, 25030.0]; heading_deg = 45.0; },\n"
    "  { kind = \"pole\"; at = [25030.0, 25000.0]; },\n"
    "  { kind = \"building\"; at = [24990.0, 24970.0]; heading_deg = 33.0; },\n"
    "  { kind = \"building\"; at = [25040.0, 24970.0]; heading_deg = 100.0; },\n"
    "  { kind = \"watertower\"; at = [24960.0, 25040.0]; } );\n";

static void test_past_trees_and_buildings_whole_and_broken(void **state)
{
    uint64_t random = fixture_seed(31);
    (void)state;
    look_at(wood);
    for (int n = 0; n < 6; n++) {
        for (uint32_t o = 0; o < f.view.world.counts.fixed; o++)
            damage[o] = (uint8_t)(n == 0 ? DAMAGE_NONE : fixture_random(&random) % DAMAGE_COUNT);
        agree(&random, 25000.0, 25000.0, 70.0, 5.0, 60, 2);
    }
}

int main(void)
{
#define TEST(function) cmocka_unit_test_teardown(function, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_over_rough_ground),
        TEST(test_over_earthworks),
        TEST(test_over_the_lips_of_craters),
        TEST(test_past_trees_and_buildings_whole_and_broken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
