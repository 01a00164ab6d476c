/* Vehicles that do not get on: they give up, back off and go around. */
#include "mover/agent/driving/progress.h"

#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/state.h"
#include "world/terrain/crater.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ       20
#define PUSH_S   10 /* nobody pushes for longer */
#define TRUCKS   4u
#define FAR_EAST "[25400.0, 25000.0], [25600.0, 25000.0]"
#define FAR_WEST "[24600.0, 25000.0], [24400.0, 25000.0]"
#define MODELS   "collision = { shape = \"model\"; };"
#define WORLD    "world = { seed = 1; capacity = 64; hz = 20.0; cruise = false; };"
#define TRUCK(at)                                                                                  \
    "{ kind = \"truck\"; at = [" at ", 25000.0]; heading_deg = 90.0; route = (" FAR_EAST "); }"

static struct fixture f;

/* Runs the world, without word of impacts: a contact that lasts has none. Returns the longest time
 * for which one of the first rows drove at less than 0.3 m/s with its throttle open [s]. */
static double longest_push(uint32_t rows, int seconds)
{
    uint32_t stuck[TRUCKS] = {0}, longest = 0;
    for (int frame = 0; frame < seconds * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t i = 0; i < rows; i++) {
            bool pushes = fabs((double)e.row[i].throttle) > 0.15 && steps_speed(&f, i) < 0.3;
            e.row[i].bumped = 0;
            stuck[i] = pushes && e.row[i].state == ENTITY_ACTIVE ? stuck[i] + 1 : 0;
            longest = stuck[i] > longest ? stuck[i] : longest;
        }
    }
    return (double)longest / HZ;
}

static void test_two_trucks_nose_to_nose_give_up_and_pass(void **state)
{
    (void)state;
    fixture_open(&f, WORLD MODELS
                 "vehicles = (" TRUCK("24996.0") ", { kind = \"truck\"; at = [25003.0, 25000.0];"
                                                 "heading_deg = 270.0; route = (" FAR_WEST
                                                 "); } );");
    double push_s = longest_push(2, 120);
    struct entities e = steps_rows(&f);
    if (push_s > PUSH_S)
        fail_msg("pushed for %g s", push_s);
    assert_true(e.row[0].x > 25100.0 && e.row[1].x < 24900.0);
}

static void test_a_truck_gives_up_against_a_house(void **state)
{
    (void)state;
    fixture_open(&f, WORLD MODELS "objects = ( { kind = \"building\"; at = [25010.0, 25000.0]; } );"
                                  "vehicles = (" TRUCK("24998.0") ");");
    double push_s = longest_push(1, 120);
    if (push_s > PUSH_S)
        fail_msg("pushed for %g s", push_s);
    assert_true(steps_rows(&f).row[0].x > 25100.0);
}

static void test_a_column_behind_a_blocked_truck_does_not_push(void **state)
{
    (void)state;
    fixture_open(
        &f,
        WORLD MODELS "vehicles = (" TRUCK("25000.0") "," TRUCK("24992.0") "," TRUCK(
            "24984.0") ", { kind = \"truck\"; behaviour = \"hold\"; at = [25008.0, 25000.0]; });");
    double push_s = longest_push(3, 120);
    struct entities e = steps_rows(&f);
    if (push_s > PUSH_S)
        fail_msg("pushed for %g s", push_s);
    assert_true(e.row[0].x > 25100.0 && e.row[1].x > 25100.0 && e.row[2].x > 25100.0);
}

/* Something that no look shows, such as a stump in the grass, holds the truck while it drives east.
 */
static void test_a_truck_gives_up_against_what_it_does_not_see(void **state)
{
    uint32_t stuck = 0, longest = 0;
    (void)state;
    fixture_open(&f, WORLD "vehicles = (" TRUCK("25000.0") ");");
    for (int frame = 0; frame < 120 * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        bool held = e.row[0].throttle > 0.15f && e.row[0].vx > 0.0 && e.row[0].x > 25000.0;
        if (held)
            e.row[0].x -= e.row[0].vx / HZ, e.row[0].vx = e.row[0].vz = 0.0;
        stuck = held ? stuck + 1 : 0;
        longest = stuck > longest ? stuck : longest;
    }
    const struct event *event = fixture_event(&f, EVENT_AGENT, 0);
    assert_non_null(event);
    assert_int_equal(event->agent.because, REASON_STUCK);
    assert_int_equal(event->agent.to, BEHAVIOUR_BACK_OFF);
    if (longest > PUSH_S * HZ)
        fail_msg("pushed for %g s", (double)longest / HZ);
}

/* A truck crawls north at a walk, though it wants to go at three quarters of its speed. touches: a
 * tank scrapes at it meanwhile. Returns when it backs off [s], or INFINITY. */
static double crawls_until(bool touches)
{
    fixture_open(&f, WORLD
                 "vehicles = ( { kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 0.0;"
                 " route = ([25000.0, 24000.0], [25000.0, 23000.0]); },"
                 "{ kind = \"tank\"; at = [25000.0, 26000.0]; behaviour = \"hold\"; } );");
    for (int frame = 0; frame < 20 * HZ; frame++) {
        struct entities e = steps_rows(&f);
        struct state now = fixture_state(&f);
        struct state_head *head = (struct state_head *)(uintptr_t)now.head;
        if (e.row[0].behaviour == BEHAVIOUR_BACK_OFF)
            return (double)frame / HZ;
        e.row[0].vx = 0.0;
        e.row[0].vz = -1.5;
        e.row[0].flags |= ENTITY_FLAG_CHASSIS;
        e.row[0].jolt_tick = (uint32_t)head->tick;
        head->contact_count = touches;
        now.contacts[0] = (struct persistent_contact){.a_id = e.row[0].id,
                                                      .b_id = e.row[1].id,
                                                      .a_row = 0,
                                                      .b_row = 1,
                                                      .pressed_tick = (uint32_t)head->tick};
        fixture_run(&f, 1);
    }
    return INFINITY;
}

/* A jeep scraped at a dead tank for a minute. Who crawls up a slope goes on. */
static void test_who_scrapes_along_something_gives_up(void **state)
{
    (void)state;
    double gives_up_s = crawls_until(true);
    fixture_close(&f);
    double alone_s = crawls_until(false);
    print_message("beside a tank it gives up after %.2f s\n", gives_up_s);
    assert_true(gives_up_s > 4.0 && gives_up_s < 8.0);
    assert_true(alone_s == INFINITY);
}

/* --- craters -----------------------------------------------------------------------------------*/

/* A shell has burst under a jeep, this far south of which the middle of its crater is. Returns
 * after how long it is out of the crater [s]; INFINITY: it has given up. */
static double out_of_crater(double south_m, double heading_deg)
{
    char text[400];
    (void)snprintf(text, sizeof text,
                   WORLD MODELS
                   "vehicles = ( { kind = \"jeep\"; at = [25000.0, 25000.0]; heading_deg "
                   "= %.1f; route = ([25000.0, 24000.0], [25000.0, 23000.0]); } );",
                   heading_deg);
    fixture_open(&f, text);
    struct state now = fixture_state(&f);
    struct state_head *head = (struct state_head *)(uintptr_t)now.head;
    now.craters[0] = (struct crater){25000.0, 25000.0 + south_m, 2.1f, 0.84f, 1};
    head->crater_count = 1;
    double out_s = -1.0;
    for (int frame = 0; frame < 300 * HZ && out_s < 0.0; frame++) {
        fixture_run(&f, 1);
        const struct entities e = steps_rows(&f);
        const double dx = e.row[0].x - 25000.0, dz = e.row[0].z - 25000.0 - south_m;
        if (dx * dx + dz * dz > 5.0 * 5.0)
            out_s = (double)frame / HZ;
        else if (e.row[0].behaviour == BEHAVIOUR_IDLE)
            out_s = INFINITY;
    }
    assert_int_equal(steps_rows(&f).row[0].state, ENTITY_ACTIVE);
    fixture_close(&f);
    return out_s;
}

static void test_a_jeep_drives_out_of_a_crater_or_gives_up(void **state)
{
    enum { PLACES = 10 };
    int out = 0;
    (void)state;
    for (int n = 0; n < PLACES; n++) {
        double out_s = out_of_crater(0.4 * (n / 2), n % 2 ? 0.0 : 45.0);
        assert_true(out_s >= 0.0);
        out += out_s < INFINITY;
    }
    fixture_open(&f, WORLD); /* the teardown closes it */
    print_message("# figures: out of %d of %d places in a crater as long as the jeep\n", out,
                  PLACES);
    assert_true(out >= PLACES / 2);
}

/* --- trenches ----------------------------------------------------------------------------------*/

#define TRENCH                                                                                     \
    "earthworks = ( { shape = \"trench\"; at = [25000.0, 24998.0]; length_m = 3.2;"                \
    " width_m = 60.0; depth_m = 1.2; edge_m = 0.2; } );"

/* A vehicle in a trench that is wider than it can cross is told to go north. Returns how far north
 * of the trench it is after half a minute [m]. */
static double out_of_trench(const char *kind, const char *how, double *push_s)
{
    char text[700];
    (void)snprintf(text, sizeof text,
                   WORLD TRENCH
                   "scripts = ( { name = \"north\"; steps = ( { go = [25000.0, 24850.0]; } );"
                   " } ); vehicles = ( { kind = \"%s\"; at = [25000.0, 24998.0];"
                   " heading_deg = 0.0; %s } );",
                   kind, how);
    fixture_open(&f, text);
    *push_s = longest_push(1, 30);
    double north = 24996.4 - steps_rows(&f).row[0].z;
    fixture_close(&f);
    return north;
}

/* Its tail is in the trench when its middle is out of it: the trench is no obstacle then. A jeep is
 * too short to reach the edge, and does not push for ever. */
static void test_a_vehicle_drives_out_of_a_trench_or_gives_up(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "truck", "jeep"};
    static const char *const how[] = {"script = \"north\";",
                                      "route = ( [25000.0, 24998.0], [25000.0, 24700.0] );"};
    (void)state;
    for (int n = 0; n < 8; n++) {
        double push_s, north = out_of_trench(kinds[n / 2], how[n % 2], &push_s);
        print_message("%s, %s: %.0f m out of the trench, pushed for %.1f s\n", kinds[n / 2],
                      n % 2 ? "route" : "script", north, push_s);
        assert_true(push_s <= PUSH_S && (n >= 6 || north > 40.0));
    }
    fixture_open(&f, WORLD);
}

/* --- the count itself --------------------------------------------------------------------------*/

static uint32_t decisions_until_stalled(float throttle, double speed)
{
    struct step_context step;
    struct serial_context context;
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                           .at = {25000.0, 100.0, 25000.0},
                                                           .velocity = {speed, 0.0, 0.0}});
    steps_serial_context(&f, &step, &context);
    step.m->row[row].throttle = throttle;
    for (uint32_t n = 1; n <= 100; n++) {
        if (progress_stalled(&step, row))
            return n;
    }
    return 0;
}

static void test_it_is_stuck_when_it_drives_for_three_seconds_in_vain(void **state)
{
    (void)state;
    fixture_open(&f, WORLD);
    assert_int_equal(decisions_until_stalled(1.0f, 0.0), 30);
    assert_int_equal(decisions_until_stalled(-0.5f, 0.1), 30);
    assert_int_equal(decisions_until_stalled(1.0f, 3.0), 0); /* it gets on */
    assert_int_equal(decisions_until_stalled(0.0f, 0.0), 0); /* it stands */
}

/* No way before it is free, so that its agent does not even open the throttle. */
static void test_it_is_stuck_when_it_waits_for_six_seconds(void **state)
{
    struct step_context step;
    struct serial_context context;
    uint32_t decisions = 1;
    (void)state;
    fixture_open(&f, WORLD);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {25000.0, 100.0, 25000.0}});
    steps_serial_context(&f, &step, &context);
    step.m->row[row].ease = 1.0f;
    while (decisions < 1000 && !progress_stalled(&step, row)) {
        step.tick += step.think_frames;
        decisions++;
    }
    double seconds = decisions * step.think_frames * step.dt_s;
    assert_true(seconds > 5.0 && seconds < 7.0);
    step.m->row[row].ease = 0.4f; /* it only slows down */
    for (decisions = 0; decisions < 1000; decisions++, step.tick += step.think_frames)
        assert_false(progress_stalled(&step, row));
}

/* Two trucks of a crowd stand so before each other that neither has a way. */
static void test_two_trucks_that_bar_each_other_wait_for_some_seconds(void **state)
{
    (void)state;
    fixture_open(&f,
                 WORLD MODELS "vehicles = ("
                              "{ kind = \"truck\"; at = [25007.0, 25004.2]; heading_deg = 268.5;"
                              " route = ( [24900.0, 25000.0], [24880.0, 25000.0] ); },"
                              "{ kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 159.6;"
                              " route = ( [25000.0, 25100.0], [25000.0, 25120.0] ); } );");
    uint32_t stood = 0, longest = 0;
    for (int frame = 0; frame < 40 * HZ; frame++) {
        fixture_run(&f, 1);
        stood = steps_speed(&f, 0) < 0.3 && steps_speed(&f, 1) < 0.3 ? stood + 1 : 0;
        longest = stood > longest ? stood : longest;
    }
    print_message("they stand for %.1f s\n", (double)longest / HZ);
    assert_true(longest > 3 * HZ && longest < 8 * HZ);
    assert_true(steps_position(&f, 0).x < 24950.0 && steps_position(&f, 1).z > 25050.0);
}

/* A truck that nothing frees, such as one that hangs on a wreck, stands for more than half of the
 * time. In the end it gives up its order. */
static void test_who_is_stuck_again_rests_and_gives_up(void **state)
{
    int drives = 0, rests = 0, seconds = 0;
    (void)state;
    fixture_open(&f, WORLD "vehicles = (" TRUCK("25000.0") ");");
    for (; seconds < 600 && steps_rows(&f).row[0].behaviour != BEHAVIOUR_IDLE; seconds++) {
        for (int frame = 0; frame < HZ; frame++) {
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            e.row[0].x = e.row[0].z = 25000.0;
            e.row[0].vx = e.row[0].vz = 0.0;
            drives += fabs((double)e.row[0].throttle) > 0.15;
            rests += fabs((double)e.row[0].throttle) < 0.01;
        }
    }
    const struct event *last =
        fixture_event(&f, EVENT_AGENT, fixture_event_count(&f, EVENT_AGENT) - 1);
    print_message("gives up after %d s\n", seconds);
    assert_int_equal(last->agent.to, BEHAVIOUR_IDLE);
    assert_int_equal(last->agent.because, REASON_STUCK);
    assert_true(seconds > 30 && seconds < 600);
    assert_true(rests > drives && drives > 10 * HZ);
}

static void test_the_way_out_is_to_the_back(void **state)
{
    struct step_context step;
    struct serial_context context;
    (void)state;
    fixture_open(&f, WORLD);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {25000.0, 100.0, 25000.0}});
    steps_serial_context(&f, &step, &context);
    step.m->row[row].throttle = 1.0f;
    for (step.tick = 1; step.tick < 100; step.tick++) {
        double off =
            maths_wrap_half(progress_way_out(&step, row, false) - step.m->row[row].heading);
        assert_true(fabs(off) > HALF_PI);
    }
}

/* Fire interrupted the rest of a crew that was stuck, so that it pushed for 12 s. */
static void test_nobody_pushes_for_long_under_fire(void **state)
{
    uint32_t pushed = 0, longest = 0, tried = 0;
    (void)state;
    fixture_open(&f, WORLD);
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                           .at = {25000.0, 100.0, 25000.0},
                                                           .force = FORCE_BLUE,
                                                           .behaviour = BEHAVIOUR_PATROL});
    uint32_t tank =
        fixture_put(&f, (struct fixture_entity){
                            .kind = "tank", .at = {25600.0, 100.0, 25000.0}, .force = FORCE_RED});
    for (int frame = 0; frame < 180 * HZ; frame++) {
        struct entities e = steps_rows(&f);
        e.row[row].order = BEHAVIOUR_PATROL;
        e.row[row].x = e.row[row].z = 25000.0; /* a pit holds it */
        e.row[row].vx = e.row[row].vz = 0.0;
        if (frame % 7 == 0) {
            e.row[row].threat_slot = tank;
            e.row[row].threat_id = tank + 1;
        }
        fixture_run(&f, 1);
        bool pushes = fabs((double)steps_rows(&f).row[row].throttle) >= 0.15;
        pushed = pushes ? pushed + 1 : 0;
        tried += pushes && frame > 60 * HZ;
        longest = pushed > longest ? pushed : longest;
    }
    print_message("pushes for %.1f s at most, and for %.0f s of two minutes\n",
                  (double)longest / HZ, (double)tried / HZ);
    assert_true(longest <= 10 * HZ && tried > 10 * HZ);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, NULL, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_two_trucks_nose_to_nose_give_up_and_pass),
        TEST(test_a_truck_gives_up_against_a_house),
        TEST(test_a_column_behind_a_blocked_truck_does_not_push),
        TEST(test_a_truck_gives_up_against_what_it_does_not_see),
        TEST(test_who_scrapes_along_something_gives_up),
        TEST(test_a_jeep_drives_out_of_a_crater_or_gives_up),
        TEST(test_a_vehicle_drives_out_of_a_trench_or_gives_up),
        TEST(test_it_is_stuck_when_it_drives_for_three_seconds_in_vain),
        TEST(test_it_is_stuck_when_it_waits_for_six_seconds),
        TEST(test_two_trucks_that_bar_each_other_wait_for_some_seconds),
        TEST(test_who_is_stuck_again_rests_and_gives_up),
        TEST(test_the_way_out_is_to_the_back),
        TEST(test_nobody_pushes_for_long_under_fire),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
