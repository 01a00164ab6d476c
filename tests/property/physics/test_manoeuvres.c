/* The scenario manoeuvres, frame by frame before the judge: no corner is under the ground by more
 * than 2 cm, and what is in the air falls. What each vehicle does is printed and checked. */
#include "supervisor/physics/physics_check.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define FRAMES   1200
#define VEHICLES 17u
/* On the lanes no corner of a shell is deeper in the ground [m]. */
#define LANES_SHELL_M 0.02

static struct fixture f;
static struct physics_check check;

/* What a vehicle did. */
struct deeds {
    double high_m, low_m; /* over the level ground */
    double air_s, pitch_rad, roll_rad, turned_rad;
    double z0, z;
    enum damage damage;
    bool wreck;
};

static struct deeds deeds[VEHICLES];

static void open_scenario(void)
{
    static char text[1 << 15];
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/scenarios/manoeuvres.cfg", fixture_shipped_dir());
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    size_t length = fread(text, 1, sizeof text - 64, in);
    fclose(in);
    snprintf(text + length, sizeof text - length, "\ncollision = { shape = \"model\"; };\n");
    fixture_open(&f, text);
}

static void look(uint32_t row, double *heading)
{
    struct entities e = steps_rows(&f);
    struct deeds *d = &deeds[row];
    bool in_air = e.row[row].y > steps_ground_at(&f, e.row[row].x, e.row[row].z) + 0.2;
    d->high_m = maths_max(d->high_m, e.row[row].y - 100.0);
    d->low_m = maths_min(d->low_m, e.row[row].y - 100.0);
    d->air_s += in_air && e.row[row].state == ENTITY_ACTIVE ? 1.0 / 60.0 : 0.0;
    d->pitch_rad = maths_max(d->pitch_rad, fabs(e.row[row].pitch));
    d->roll_rad = maths_max(d->roll_rad, fabs(e.row[row].roll));
    d->turned_rad += maths_wrap_half(e.row[row].heading - heading[row]);
    heading[row] = e.row[row].heading;
    d->z = e.row[row].z;
    d->damage = (enum damage)e.row[row].damage;
    d->wreck |= e.row[row].state == ENTITY_WRECK;
}

static void run(void)
{
    double heading[VEHICLES];
    struct state now = fixture_state(&f);
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    for (uint32_t row = 0; row < VEHICLES; row++) {
        heading[row] = now.entities.row[row].heading;
        deeds[row].z0 = now.entities.row[row].z;
    }
    for (int frame = 0; frame < FRAMES; frame++) {
        const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
        fixture_run(&f, 1);
        now = fixture_state(&f);
        assert_int_equal(physics_check_frame(&check, &now, &events), 0);
        for (uint32_t row = 0; row < VEHICLES; row++)
            look(row, heading);
    }
}

static const struct deeds *of(const char *name)
{
    for (uint32_t row = 0; row < VEHICLES; row++) {
        if (strcmp(f.view.world.names[row].text, name) == 0)
            return &deeds[row];
    }
    fail_msg("no vehicle is called %s", name);
    return NULL;
}

static double way(const char *name)
{
    return of(name)->z0 - of(name)->z;
}

static void print_deeds(void)
{
    for (uint32_t row = 0; row < VEHICLES; row++) {
        const struct deeds *d = &deeds[row];
        printf("%-10s %6.1f m north, %5.2f m up, %5.2f m down, %.2f s off the ground, pitch %4.1f,"
               " roll %4.1f, turned %6.1f, damage %d%s\n",
               f.view.world.names[row].text, d->z0 - d->z, d->high_m, d->low_m, d->air_s,
               d->pitch_rad * DEG_PER_RAD, d->roll_rad * DEG_PER_RAD, d->turned_rad * DEG_PER_RAD,
               d->damage, d->wreck ? ", over" : "");
    }
}

static void test_the_judge_is_content(void **state)
{
    (void)state;
    for (int kind = 0; kind < MEASURE_KINDS; kind++) {
        const struct measure *measure = &check.measures.of[kind];
        if (measure->taken > 0)
            printf("%-18s %.4g of %.4g %s: vehicle %u at %.2f s\n",
                   measure_word((enum measure_kind)kind), measure->worst,
                   measure_bound(&check.measures, (enum measure_kind)kind),
                   measure_unit((enum measure_kind)kind), measure->body[0].id, measure->time_s);
        assert_true(measure_good(&check.measures, (enum measure_kind)kind));
    }
    assert_true(check.measures.of[MEASURE_OF_SHELL_UNDERGROUND].taken > 6000);
    assert_true(check.measures.of[MEASURE_OF_SHELL_UNDERGROUND].worst < LANES_SHELL_M);
    assert_true(check.measures.of[MEASURE_OF_FLOATING].taken > 30);
}

static void test_each_vehicle_does_what_its_lane_is_for(void **state)
{
    (void)state;
    print_deeds();
    assert_true(of("drop")->high_m > 0.9 && way("drop") > 45.0 && !of("drop")->wreck);
    assert_true(of("jump")->air_s > 0.4 && of("jump")->pitch_rad > 0.1 && way("jump") > 120.0);
    assert_true(fabs(of("j-turn")->turned_rad) > 2.4 && !of("j-turn")->wreck);
    assert_true(of("side-jeep")->roll_rad > 0.3 && !of("side-jeep")->wreck);
    assert_true(of("side-tank")->roll_rad > 0.3 && !of("side-tank")->wreck);
    assert_true(of("side-truck")->roll_rad > 0.15 && !of("side-truck")->wreck);
    assert_true(way("wash-jeep") > 110.0 && way("wash-tank") > 75.0);
    assert_true(of("crater")->low_m < -0.03 && way("crater") > 75.0);
    assert_true(of("ditch-jeep")->low_m < -0.4 && way("ditch-jeep") > 70.0);
    assert_true(of("ditch-tank")->pitch_rad > 0.05 && way("ditch-tank") > 70.0);
    assert_true(way("step-tank") > 45.0 && way("step-jeep") > 65.0);
    assert_true(way("trench") > 70.0);
    assert_true(of("ford")->low_m < -0.4 && way("ford") > 45.0);
    assert_true(of("rollover")->wreck && fabs(of("tail")->turned_rad) > 1.6);
    for (uint32_t row = 0; row < VEHICLES; row++)
        assert_true(deeds[row].wreck == (&deeds[row] == of("rollover")));
}

static int open_run(void **state)
{
    (void)state;
    open_scenario();
    run();
    return 0;
}

static int close_run(void **state)
{
    (void)state;
    physics_check_free(&check);
    fixture_close(&f);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_judge_is_content),
        cmocka_unit_test(test_each_vehicle_does_what_its_lane_is_for),
    };
    return cmocka_run_group_tests(tests, open_run, close_run);
}
