/* One body's motion: fast beginnings, what throws and spins it, and the edge of the world. */
#include "supervisor/physics/body_measures.h"

#include "supervisor/physics/physics_check.h"
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define MIDDLE 25000.0

static struct fixture f;
static struct physics_check check;
static struct state now; /* the frame that the test writes by hand */

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static int end_check(void **state)
{
    (void)state;
    physics_check_free(&check);
    steps_empty(&f);
    return 0;
}

/* A vehicle that faces east. */
static uint32_t put(const char *kind, double x, double y)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, MIDDLE}, .heading_rad = HALF_PI});
}

static void begin(void)
{
    judged_begin(&f, &check, &now);
}

static void next(void)
{
    judged_next(&f, &check, &now);
}

static struct event *add_event(enum event_type type)
{
    return judged_event(&f, &now, type);
}

static void is_bad(enum measure_kind kind, double value)
{
    judged_bad(&check, &now, kind, value);
}

static void is_good(void)
{
    judged_no_other_bad(&check, MEASURE_KINDS);
    assert_true(measures_good(&check.measures));
}

static void test_a_body_that_is_thrown(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    double top = steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    begin();
    struct event *event = add_event(EVENT_DETONATION);
    event->detonation.point[0] = MIDDLE;
    event->detonation.point[1] = 100.0;
    event->detonation.point[2] = MIDDLE;
    event->detonation.explosive_kg = 1.0f;
    now.entities.row[tank].vx = 3.0 * top;
    next();
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SPEED));
    now.entities.row[tank].vx = top;
    next();
    now.entities.row[tank].vx = 3.0 * top;
    next();
    is_bad(MEASURE_OF_SPEED, 3.0);
}

/* The edge of the world stops a vehicle in a frame, and nothing else does. */
static void test_the_edge_of_the_world_stops_a_vehicle(void **state)
{
    uint32_t tank = put("tank", 49996.0, 100.0);
    (void)state;
    steps_rows(&f).row[tank].vx = 5.0;
    begin();
    now.entities.row[tank].vx = 0.0;
    next();
    is_good();
    now.entities.row[tank].x = 49900.0;
    now.entities.row[tank].vx = 5.0;
    add_event(EVENT_COMMAND)->command.entity = tank + 1;
    next();
    is_good();
    now.entities.row[tank].vx = 0.0;
    next();
    is_bad(MEASURE_OF_ACCELERATION, 300.0 - 5.0 * steps_kind(&f, "tank")->turn_rate_rps);
}

static void test_a_body_that_begins_fast(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    steps_rows(&f).row[tank].vx = 3.0 * steps_kind(&f, "tank")->max_speed_mps;
    begin();
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SPEED));
}

/* Gives the first of two tanks this spin in a frame in which both collide. */
static void collide(uint32_t a, uint32_t b, double spin_rps)
{
    struct event *event = add_event(EVENT_COLLISION);
    event->collision.a.id = a + 1;
    event->collision.b.id = b + 1;
    now.entities.row[a].spin_y = spin_rps;
    next();
}

/* At 30 rad/s the points of a tank go about its centre at 30 times its radius of gyration. */
static void test_a_body_that_a_fast_one_spins_up(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("tank", MIDDLE + 10.0, 100.0);
    const struct kind *kind = steps_kind(&f, "tank");
    double square = kind->length_m * kind->length_m + kind->width_m * kind->width_m;
    double speed = 30.0 * sqrt(square / 12.0);
    (void)state;
    steps_rows(&f).row[b].vx = -1.01 * speed;
    begin();
    collide(a, b, 30.0);
    assert_true(measure_good(&check.measures, MEASURE_OF_SPIN));
    now.entities.row[a].spin_y = 19.0; /* it turns freely, and its axes differ */
    next();
    now.entities.row[a].spin_y = 21.0;
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SPIN));
    now.entities.row[a].spin_y = 9.0;
    next();
    now.entities.row[a].spin_y = 21.0;
    next();
    is_bad(MEASURE_OF_SPIN, 21.0);
}

static void test_a_slow_body_spins_nothing_up(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("tank", MIDDLE + 10.0, 100.0);
    (void)state;
    steps_rows(&f).row[b].vx = -20.0;
    begin();
    collide(a, b, 30.0);
    is_bad(MEASURE_OF_SPIN, 30.0);
}

#define TEST(name) cmocka_unit_test_teardown(name, end_check)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_body_that_is_thrown),
        TEST(test_a_body_that_begins_fast),
        TEST(test_the_edge_of_the_world_stops_a_vehicle),
        TEST(test_a_body_that_a_fast_one_spins_up),
        TEST(test_a_slow_body_spins_nothing_up),
    };
    return cmocka_run_group_tests(tests, open_world, close_world);
}
