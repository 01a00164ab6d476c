/* Rockets that a hovering helicopter's crew fires by salvos at a halted tank, with the hulls of the
 * shipped models. It prints how many hit. */
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define RUNS 6
#define HZ   60

static struct fixture f;

/* What a crew does in a minute. */
struct salvos {
    uint32_t fired, hits;
};

static uint32_t put_pair(double distance_m, double bearing, uint32_t *tank)
{
    double sine = maths_sin(bearing), cosine = maths_cos(bearing);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                .at = {25000.0, FIXTURE_GROUND_M + 45.0, 25000.0},
                                                .heading_rad = bearing,
                                                .force = FORCE_BLUE});
    *tank = fixture_put(
        &f, (struct fixture_entity){.kind = "tank",
                                    .at = {25000.0 + distance_m * sine, FIXTURE_GROUND_M,
                                           25000.0 - distance_m * cosine},
                                    .heading_rad = 2.0 * bearing,
                                    .force = FORCE_RED});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
    e.row[row].flags = ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND;
    steps_kind(&f, "tank")->resistance_j = 1e13; /* it stands as a target */
    return row;
}

static void fight(double distance_m, uint32_t run, struct salvos *salvos)
{
    char text[96];
    uint32_t tank;
    (void)snprintf(text, sizeof text,
                   "world = { seed = %u; capacity = 64; }; collision = { shape = \"model\"; };",
                   run + 1);
    fixture_open(&f, text);
    put_pair(distance_m, 0.7 * run, &tank);
    for (int frame = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        uint32_t count = fixture_event_count(&f, EVENT_DETONATION);
        const struct event *end = count > 0 ? fixture_event(&f, EVENT_DETONATION, count - 1) : NULL;
        if (end == NULL || end->frame != fixture_state(&f).head->frame)
            continue;
        salvos->fired++;
        salvos->hits += end->detonation.struck == STRUCK_VEHICLE &&
                        end->detonation.struck_party.id == steps_rows(&f).row[tank].id;
    }
    fixture_close(&f);
}

static void test_salvos_hit_a_halted_tank(void **state)
{
    static const double distance_m[] = {1000.0, 2000.0}, least[] = {0.12, 0.02};
    (void)state;
    for (int n = 0; n < 2; n++) {
        struct salvos salvos = {0, 0};
        for (uint32_t run = 0; run < RUNS; run++)
            fight(distance_m[n], run, &salvos);
        print_message("%.0f m: %.1f rockets a minute, %.0f %% hit\n", distance_m[n],
                      (double)salvos.fired / RUNS, 100.0 * salvos.hits / salvos.fired);
        assert_true(salvos.fired >= 7 * RUNS);
        assert_true(salvos.hits >= least[n] * salvos.fired && salvos.hits < 0.5 * salvos.fired);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_salvos_hit_a_halted_tank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
