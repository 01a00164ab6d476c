/* Bodies at rest on a slope: below the angle of friction they stay where they are, vehicles and
 * wrecks, and on a steeper one they slide. SEED=n turns them. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define ROWS     6u
#define SETTLE_S 10.0
#define MINUTE_S 60.0
#define STAYS_M  1e-3 /* in a minute, at most */
#define SLIDES_M 20.0 /* in a minute, at least */
#define HZ       60.0

static const char *const kinds[ROWS] = {"tank", "jeep", "truck", "tank", "jeep", "truck"};

static struct fixture f;

/* Puts three vehicles that stand, and three wrecks, on a plane that rises to the east. */
static void open_slope(double rise, uint64_t *random)
{
    fixture_open(&f, "collision = { shape = \"model\"; };");
    steps_plane(&f, rise, 0.0);
    for (uint32_t i = 0; i < ROWS; i++) {
        double z = 25000.0 + 40.0 * i;
        fixture_put(&f,
                    (struct fixture_entity){.kind = kinds[i],
                                            .at = {25000.0, steps_ground_at(&f, 25000.0, z), z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
        steps_rows(&f).row[i].behaviour = steps_rows(&f).row[i].order = BEHAVIOUR_IDLE;
    }
    fixture_run(&f, 2); /* they take the pose of the ground */
    for (uint32_t i = ROWS / 2; i < ROWS; i++)
        steps_rows(&f).row[i].state = ENTITY_WRECK;
    fixture_forget_copies(&f);
    fixture_continue(&f, (uint32_t)(SETTLE_S * HZ));
}

static struct vec3 position(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return entities_position(&e, row);
}

/* Returns how far each row goes in a minute. */
static void run_minute(double way[ROWS])
{
    struct vec3 from[ROWS];
    for (uint32_t i = 0; i < ROWS; i++)
        from[i] = position(i);
    fixture_continue(&f, (uint32_t)(MINUTE_S * HZ));
    for (uint32_t i = 0; i < ROWS; i++)
        way[i] = vec3_length(vec3_sub(position(i), from[i]));
}

static void test_bodies_stay_on_slopes_below_friction(void **state)
{
    uint64_t random = fixture_seed(7);
    double way[ROWS];
    (void)state;
    for (double rise = 0.1; rise < 0.51; rise += 0.1) {
        open_slope(rise, &random);
        run_minute(way);
        for (uint32_t i = 0; i < ROWS; i++) {
            print_message("slope %.1f, %s %s: %.4f mm in a minute\n", rise, kinds[i],
                          i < ROWS / 2 ? "that stands" : "wreck", 1e3 * way[i]);
            assert_true(way[i] <= STAYS_M);
        }
        fixture_close(&f);
    }
}

static void test_bodies_slide_on_slopes_above_friction(void **state)
{
    uint64_t random = fixture_seed(7);
    double way[ROWS];
    (void)state;
    open_slope(1.0, &random);
    run_minute(way);
    for (uint32_t i = 0; i < ROWS; i++) {
        print_message("slope 1.0, %s %s: %.1f m in a minute\n", kinds[i],
                      i < ROWS / 2 ? "that stands" : "wreck", way[i]);
        assert_true(way[i] >= SLIDES_M);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bodies_stay_on_slopes_below_friction),
        cmocka_unit_test(test_bodies_slide_on_slopes_above_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
