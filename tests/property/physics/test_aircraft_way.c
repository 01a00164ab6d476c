/* What aircraft that part do to others. Who makes way for one that an impact or the guard at the
 * frame's end then stops has not gone for nothing: the judge finds no leap (thesis row 46). */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_nobody_makes_way_for_one_that_is_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
