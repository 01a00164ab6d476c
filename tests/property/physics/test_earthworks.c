/* Land vehicles drive at random speeds into random works: walls up to 2.5 m, trenches up to 3 m
 * deep, ramps with a lip, and craters; or they hold their course over them. The judge looks at
 * every frame: no corner of a shell is in the ground by more than 2 cm, springs give back no more
 * than they took, what holds its course has no corner in the ground, and wrecks are not shoved into
 * it. Prints its seed. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/maths/random.h"
#include "world/params.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define LANES  24u
#define FRAMES (12 * 60)
#define RUNS   4u

#define COURSE_DEEP_M 1e-6 /* rounding */

static struct fixture f;
static struct physics_check check;
static char text[1 << 14];

static double random_of(uint64_t seed, uint32_t lane, int what, double low, double high)
{
    return random_between(seed, lane, (uint32_t)what, RANDOM_STUCK, low, high);
}

/* Writes a work 30 m before the start of a lane. The lanes lie 40 m apart and lead north. */
static size_t write_work(uint64_t seed, uint32_t lane, size_t at)
{
    static const char *const shapes[] = {"table", "trench", "ramp"};
    int shape = (int)random_of(seed, lane, 0, 0.0, 2.999);
    double size = random_of(seed, lane, 1, 0.1, shape == 1 ? 3.0 : 2.5);
    double length = random_of(seed, lane, 2, 1.0, 12.0) + 2.0 * size;
    double edge = maths_max(random_of(seed, lane, 3, 0.13, 1.0) * size, 0.032);
    double turn = random_of(seed, lane, 4, -25.0, 25.0);
    return at + (size_t)snprintf(
                    text + at, sizeof text - at,
                    "{ shape = \"%s\"; at = [%.1f, %.2f]; heading_deg = %.1f; length_m = %.2f;"
                    " width_m = 20.0; %s = %.3f; edge_m = %.3f; }%s\n",
                    shapes[shape], 24000.0 + 40.0 * lane, 24970.0 - 0.5 * length, turn, length,
                    shape == 1 ? "depth_m" : "height_m", size, edge, lane + 1 < LANES ? "," : "");
}

static void dig(uint64_t seed)
{
    struct state now = fixture_state(&f);
    for (uint32_t lane = 0; lane < LANES; lane += 2) {
        float depth = (float)random_of(seed, lane, 5, 0.3, 1.5);
        for (int buffer = 0; buffer < 2; buffer++) {
            struct state_head *head = f.view.w[buffer].head;
            now.craters[head->crater_count] = (struct crater){
                24000.0 + 40.0 * lane + random_of(seed, lane, 6, -3.0, 3.0), 24940.0,
                depth * (float)random_of(seed, lane, 7, 2.5, 5.0), depth, 1};
            head->crater_count++;
        }
    }
}

/* Who holds a course needs a speed for it: 70 m in the time of a run. */
static double courses_mps(enum behaviour behaviour)
{
    return behaviour == BEHAVIOUR_HOLD ? 6.0 : 0.0;
}

static void run(uint64_t seed, enum behaviour behaviour)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck", "hamburger", "flak"};
    size_t at = (size_t)snprintf(text, sizeof text, "earthworks = (\n");
    for (uint32_t lane = 0; lane < LANES; lane++)
        at = write_work(seed, lane, at);
    snprintf(text + at, sizeof text - at, ");\ncollision = { shape = \"model\"; };\n");
    fixture_open(&f, text);
    dig(seed);
    for (uint32_t lane = 0; lane < LANES; lane++)
        fixture_put(&f, (struct fixture_entity){.kind = kinds[lane % 6],
                                                .at = {24000.0 + 40.0 * lane, 100.0, 25000.0},
                                                .velocity = {0.0, 0.0, -courses_mps(behaviour)},
                                                .behaviour = behaviour});
    struct state now = fixture_state(&f);
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    for (int frame = 0; frame < FRAMES; frame++) {
        const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
        for (uint32_t row = 0; frame % 60 == 0 && row < LANES; row++) {
            if (behaviour == BEHAVIOUR_DRIVEN && steps_rows(&f).row[row].state == ENTITY_ACTIVE)
                steps_pedals(&f, row, random_of(seed, row, 8, 0.2, 1.0), 0.0, GEAR_AUTOMATIC);
        }
        fixture_run(&f, 1);
        now = fixture_state(&f);
        assert_int_equal(physics_check_frame(&check, &now, &events), 0);
    }
}

static void test_shells_stay_out_of_the_ground_and_springs_give_what_they_took(void **state)
{
    static const enum measure_kind kinds[] = {MEASURE_OF_SHELL_UNDERGROUND,
                                              MEASURE_OF_SPRUNG_ENERGY, MEASURE_OF_FLOATING};
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        run(seed, BEHAVIOUR_DRIVEN);
        for (int n = 0; n < 3; n++) {
            const struct measure *measure = &check.measures.of[kinds[n]];
            printf("seed %llu: %-18s %.4g of %.4g %s, %llu looks: vehicle %u at %.2f s\n",
                   (unsigned long long)seed, measure_word(kinds[n]), measure->worst,
                   measure_bound(&check.measures, kinds[n]), measure_unit(kinds[n]),
                   (unsigned long long)measure->taken, measure->body[0].id, measure->time_s);
            assert_true(measure_good(&check.measures, kinds[n]));
        }
        physics_check_free(&check);
        fixture_close(&f);
    }
}

/* They have no springs: the ground lifts them. */
static void test_vehicles_on_their_course_stay_out_of_works_and_craters(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        run(seed, BEHAVIOUR_HOLD);
        const struct measure *deep = &check.measures.of[MEASURE_OF_UNDERGROUND];
        printf("seed %llu: corners at most %.3g m under the ground: vehicle %u at %.2f s\n",
               (unsigned long long)seed, deep->worst, deep->body[0].id, deep->time_s);
        assert_int_equal(deep->taken, (uint64_t)LANES * FRAMES);
        assert_true(deep->worst < COURSE_DEEP_M);
        assert_true(measure_good(&check.measures, MEASURE_OF_HEIGHT));
        physics_check_free(&check);
        fixture_close(&f);
    }
}

/* Tanks that hold their course shove trucks' wrecks along trenches into the walls at the ends. At
 * 10 Hz a wreck goes 2.5 m in a frame. */
static void test_wrecks_are_not_shoved_into_walls(void **state)
{
    (void)state;
    size_t at = (size_t)snprintf(text, sizeof text,
                                 "world = { hz = 10.0; };\ncollision = { shape = \"model\"; };\n"
                                 "earthworks = (\n");
    for (uint32_t lane = 0; lane < LANES; lane++)
        at += (size_t)snprintf(
            text + at, sizeof text - at,
            "{ shape = \"trench\"; at = [%.1f, 25000.0]; heading_deg = 0.0;"
            " length_m = 48.0; width_m = 26.0; depth_m = %.2f; edge_m = 2.0; }%s\n",
            24000.0 + 40.0 * lane, random_of(1, lane, 0, 1.5, 3.0), lane + 1 < LANES ? "," : "");
    snprintf(text + at, sizeof text - at, ");\n");
    fixture_open(&f, text);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const double x = 24000.0 + 40.0 * lane, y = steps_ground_at(&f, x, 25000.0);
        const double aside = random_of(1, lane, 1, -1.5, 1.5);
        uint32_t wreck = fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                                 .at = {x + aside, y, 24995.0},
                                                                 .velocity = {0.0, 0.0, -20.0}});
        steps_rows(&f).row[wreck].state = ENTITY_WRECK;
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {x, y, 25006.0},
                                                .velocity = {0.0, 0.0, -26.0},
                                                .behaviour = BEHAVIOUR_HOLD});
    }
    judged_continue(&f, &check, 60);
    const struct measure *deep = &check.measures.of[MEASURE_OF_WRECK_UNDERGROUND];
    printf("wrecks at most %.3g m deeper under the ground: vehicle %u at %.2f s\n", deep->worst,
           deep->body[0].id, deep->time_s);
    assert_true(deep->taken > LANES);
    assert_true(measure_good(&check.measures, MEASURE_OF_WRECK_UNDERGROUND));
    physics_check_free(&check);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vehicles_on_their_course_stay_out_of_works_and_craters),
        cmocka_unit_test(test_wrecks_are_not_shoved_into_walls),
        cmocka_unit_test(test_shells_stay_out_of_the_ground_and_springs_give_what_they_took),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
