/* Land vehicles of agents on patrol over steep ground, before the judge: they go to their springs
 * where their tyres do not hold them, and come back. SEED=n SEEDS=m looks at other patrols. */
#include "supervisor/physics/physics_check.h"
#include "tests/support/scenario_text.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define SECONDS  90
#define VEHICLES 27
#define WORLDS   1u
#define FIRST    1u

static struct fixture f;
static struct physics_check check;
static struct scenario_text text;

/* Writes a scenario of patrols on the sides of the Presidential Range. */
static const char *patrols(uint64_t seed, double hz)
{
    static const char *const kinds[] = {"howitzer",        "flak", "hamburger", "truck",
                                        "missile-carrier", "jeep", "carrier",   "tank",
                                        "attack-tomato"};
    text.used = 0;
    scenario_text_add(&text,
                      "world = { seed = %llu; capacity = 256; hz = %.1f; };\n"
                      "terrain = { source = \"file\"; file = \"%s/grounds/white-mountains.ground\";"
                      " };\nobjects = { source = \"none\"; };\ncollision = { shape = \"model\"; };"
                      "\nvehicles = (",
                      (unsigned long long)seed, hz, fixture_shipped_dir());
    for (int n = 0; n < VEHICLES / 3; n++)
        scenario_text_add(&text,
                          "%s\n{ kind = \"%s\"; count = 3; behaviour = \"patrol\";"
                          " area = [19000.0, 19000.0, 26000.0, 26000.0]; }",
                          n ? "," : "", kinds[n]);
    scenario_text_add(&text, " );\n");
    return text.at;
}

/* Fails if a measure of the judge is beyond its bound. */
static void assert_good(uint64_t seed, double hz)
{
    for (int kind = 0; kind < MEASURE_KINDS; kind++) {
        const struct measure *measure = &check.measures.of[kind];
        if (!measure_good(&check.measures, (enum measure_kind)kind))
            fail_msg("seed %llu at %.0f Hz: %s is %.4g of %.4g %s: vehicle %u in frame %llu",
                     (unsigned long long)seed, hz, measure_word((enum measure_kind)kind),
                     measure->worst, measure_bound(&check.measures, (enum measure_kind)kind),
                     measure_unit((enum measure_kind)kind), measure->body[0].id,
                     (unsigned long long)measure->frame);
    }
}

/* Looks at the frames of patrols. Returns the share of them that their vehicles are on springs. */
static double judge(uint64_t seed, double hz)
{
    uint64_t sprung = 0;
    const uint32_t frames = (uint32_t)(SECONDS * hz);
    fixture_open(&f, patrols(seed, hz));
    struct state now = fixture_state(&f);
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    for (uint32_t frame = 0; frame < frames; frame++) {
        const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
        fixture_run(&f, 1);
        now = fixture_state(&f);
        assert_int_equal(physics_check_frame(&check, &now, &events), 0);
        for (uint32_t i = 0; i < VEHICLES; i++)
            sprung += (now.entities.row[i].flags & ENTITY_FLAG_CHASSIS) != 0;
    }
    print_message("seed %llu at %.0f Hz: on springs for %.3f, %.2f J/kg at most\n",
                  (unsigned long long)seed, hz, (double)sprung / VEHICLES / frames,
                  check.measures.of[MEASURE_OF_SPRUNG_ENERGY].worst);
    assert_good(seed, hz);
    physics_check_free(&check);
    fixture_close(&f);
    return (double)sprung / VEHICLES / frames;
}

static void test_patrols_go_to_their_springs_and_back_without_a_jump(void **unused)
{
    const char *more = getenv("SEEDS");
    const uint64_t first = fixture_seed(FIRST);
    const uint64_t seeds = more ? strtoull(more, NULL, 10) : WORLDS;
    (void)unused;
    for (uint64_t seed = first; seed < first + seeds; seed++) {
        for (double hz = 10.0; hz <= 60.0; hz += 50.0) {
            double share = judge(seed, hz);
            assert_true(share > 0.01 && share < 0.3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patrols_go_to_their_springs_and_back_without_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
