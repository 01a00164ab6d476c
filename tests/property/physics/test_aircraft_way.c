/* Aircraft that begin in each other and meet others while they part. Who makes way for one that an
 * impact or the guard at the frame's end then stops has not gone for nothing, and what one of them
 * meets, all meet: the judge finds no leap, no deeper overlap and no speed (thesis row 46). */
#include "tests/support/judged.h"
#include "tests/support/steps.h"

#include <stdint.h>
#include <stdio.h>

#define BEGINNING                                                                                  \
    "collision = { shape = \"model\"; }; objects = { source = \"none\"; };"                        \
    "terrain = { source = \"flat\"; height_m = 50.0; }; vehicles = ("
#define TEXT_MAX 4096

struct placed {
    const char *kind;
    double x, z, altitude_m, heading_deg, speed_mps; /* from the crowd's middle */
};

static struct fixture f;
static struct physics_check check;

/* Lets a crowd part for so many frames, and asks the judge. */
static void part(const struct placed *placed, uint32_t count, const char *behaviour,
                 uint32_t frames)
{
    char text[TEXT_MAX] = BEGINNING;
    size_t end = sizeof BEGINNING - 1;
    for (uint32_t i = 0; i < count; i++) {
        const struct placed *one = &placed[i];
        end += (size_t)snprintf(text + end, sizeof text - end,
                                "%s{ kind = \"%s\"; at = [%.2f, %.2f]; altitude_m = %.1f; "
                                "heading_deg = %.1f; speed_mps = %.1f; behaviour = \"%s\"; }",
                                i == 0 ? "" : ",\n", one->kind, 25000.0 + one->x, 25000.0 + one->z,
                                one->altitude_m, one->heading_deg, one->speed_mps, behaviour);
    }
    snprintf(text + end, sizeof text - end, ");");
    fixture_open(&f, text);
    judged_continue(&f, &check, frames);
    assert_true(check.measures.of[MEASURE_OF_OVERLAPPING].worst > 0.0);
    judged_no_other_bad(&check, MEASURE_KINDS);
    physics_check_free(&check);
    fixture_close(&f);
}

static void test_row_46_nobody_makes_way_for_one_that_is_stopped(void **state)
{
    static const struct placed cows[] = {
        {"helo-cow", 4.58, 1.85, 300.6, 252.0, 20.0},
        {"helo-cow", -0.05, -0.46, 300.4, 353.0, 20.0},
        {"helo-cow", 4.08, -0.18, 299.6, 203.8, 20.0},
        {"helo-cow", -2.94, -3.01, 301.5, 297.7, 20.0},
        {"helo-cow", 4.78, -3.93, 300.3, 222.4, 20.0},
        {"helo-cow", 4.41, -2.64, 300.2, 358.9, 20.0},
    };
    (void)state;
    part(cows, sizeof cows / sizeof *cows, "hold", 20);
}

/* One of a crowd that parts is struck by one beside it: all share the impact, or the next one is
 * deeper in it. */
static void test_row_46_those_that_part_share_an_impact(void **state)
{
    static const struct placed crowd[] = {
        {"helicopter", -0.83, -4.96, 299.7, 127.8, 20.0},
        {"wishbone", -0.49, 5.98, 300.5, 219.8, 20.0},
        {"helicopter", -4.80, -3.94, 298.5, 29.8, 20.0},
        {"helo-cow", -2.26, -3.40, 299.4, 43.1, 20.0},
        {"helo-cow", -6.37, -2.87, 301.0, 181.8, 20.0},
        {"helicopter", 1.78, 4.33, 298.6, 291.4, 20.0},
        {"helicopter", 1.24, -2.96, 299.1, 250.3, 20.0},
        {"wishbone", 4.40, 1.05, 299.8, 147.5, 20.0},
        {"wishbone", -2.39, 5.28, 299.8, 122.3, 20.0},
    };
    (void)state;
    part(crowd, sizeof crowd / sizeof *crowd, "patrol", 20);
}

/* The guard sends one back that has become a wreck in the crowd: it goes on with the others. */
static void test_row_46_a_wreck_in_a_crowd_keeps_its_velocity(void **state)
{
    static const struct placed crowd[] = {
        {"jet", 1.32, 4.74, 300.5, 4.3, 150.0},
        {"jet", -5.80, 2.43, 300.5, 4.7, 150.0},
        {"helo-cow", 0.82, 5.17, 299.0, 240.0, 0.0},
        {"helicopter", 4.22, 3.88, 298.6, 331.3, 0.0},
        {"wishbone", -1.79, -4.43, 299.4, 357.8, 0.0},
        {"helicopter", -6.45, -3.88, 300.5, 3.6, 0.0},
        {"jet", 6.49, 5.02, 299.1, 2.2, 150.0},
        {"wishbone", -5.52, 4.52, 301.8, 91.4, 0.0},
        {"helicopter", 1.73, 6.15, 299.2, 332.2, 0.0},
    };
    (void)state;
    part(crowd, sizeof crowd / sizeof *crowd, "idle", 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_nobody_makes_way_for_one_that_is_stopped),
        cmocka_unit_test(test_row_46_those_that_part_share_an_impact),
        cmocka_unit_test(test_row_46_a_wreck_in_a_crowd_keeps_its_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
