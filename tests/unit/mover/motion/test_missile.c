/* Missiles: motor and drag, the seeker's cone, failures and decoys, and how many hit. */
#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

/* Missiles that always work and follow no decoy. */
static void perfect(void)
{
    steps_kind(&f, "missile")->reliability = 1.0;
    steps_kind(&f, "missile")->decoyed = 0.0;
}

static uint32_t put_round(const char *kind, struct vec3 at, struct vec3 velocity)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind, .at = at, .velocity = velocity});
}

static uint32_t put_missile_of(const char *kind, uint32_t target, struct vec3 at,
                               struct vec3 velocity)
{
    uint32_t row = put_round(kind, at, velocity);
    struct entities e = steps_rows(&f);
    e.row[row].target_slot = target;
    e.row[row].target_id = target == SLOT_NONE ? 0 : e.row[target].id;
    return row;
}

static uint32_t put_missile(uint32_t target, struct vec3 at, struct vec3 velocity)
{
    return put_missile_of("missile", target, at, velocity);
}

static void test_a_missile_reaches_a_crossing_jet(void **state)
{
    static const double courses[][2] = {{230.0, 0.0}, {-230.0, 0.0}, {0.0, 150.0}, {160.0, -160.0}};
    (void)state;
    perfect();
    for (size_t n = 0; n < sizeof courses / sizeof courses[0]; n++) {
        uint32_t jet = fixture_put(
            &f, (struct fixture_entity){.kind = "jet",
                                        .at = {25000.0, 800.0, 23000.0},
                                        .velocity = {courses[n][0], 0.0, courses[n][1]}});
        uint32_t id = steps_rows(&f).row[jet].id;
        put_missile(jet, (struct vec3){25000.0, 150.0, 25000.0}, (struct vec3){0.0, 40.0, -100.0});
        fixture_run(&f, 60 * 19);
        const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
        assert_non_null(event);
        assert_int_equal(event->detonation.struck, STRUCK_VEHICLE);
        assert_int_equal(event->detonation.struck_party.id, id);
        fixture_close(&f);
        fixture_open(&f, "");
        perfect();
    }
}

static void test_what_leaves_the_seekers_cone_is_lost_for_good(void **state)
{
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 24000.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    double cone = steps_kind(&f, "missile")->seeker_rad;
    (void)state;
    perfect();
    for (int out = 0; out < 2; out++) { /* just within, and just outside */
        double off = cone + (out ? 0.05 : -0.05);
        uint32_t row =
            put_missile(jet, (struct vec3){25000.0, 900.0, 25000.0},
                        (struct vec3){100.0 * maths_sin(off), 0.0, -100.0 * maths_cos(off)});
        struct entities e = steps_rows(&f);
        double heading = e.row[row].heading;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_int_equal(e.row[row].target_id, out ? 0 : e.row[jet].id);
        assert_true((fabs(maths_wrap_half(e.row[row].heading - heading)) < 1e-9) == (out == 1));
        if (out == 1) { /* it comes into view again: too late */
            e.row[jet].x = e.row[row].x + 1000.0 * maths_sin(off);
            e.row[jet].z = e.row[row].z - 1000.0 * maths_cos(off);
            fixture_run(&f, 30);
            assert_true(fabs(maths_wrap_half(steps_rows(&f).row[row].heading - heading)) < 1e-9);
        }
    }
}

/* Returns where a missile heads after a frame that flies at a tank with these velocity and place,
 * or with a stretch of which they are the end. */
static double heads_at(struct vec3 at, struct vec3 velocity, double turns_rps, uint32_t frames)
{
    uint32_t tank =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = at, .velocity = velocity});
    fixture_run(&f, 1); /* a body that is new goes by frames if spheres may be in each other */
    struct entities e = steps_rows(&f);
    entities_set_position(&e, tank, at);
    entities_set_velocity(&e, tank, velocity);
    e.row[tank].cruise_tick = frames > 0 ? (uint32_t)fixture_state(&f).head->tick + frames : 0;
    e.row[tank].cruise_rps = turns_rps;
    e.row[tank].heading = maths_heading(velocity.x, velocity.z);
    uint32_t row =
        put_missile(tank, (struct vec3){25010.0, 320.0, 24500.0}, (struct vec3){0.0, 0.0, -200.0});
    fixture_run(&f, 1);
    return steps_rows(&f).row[row].heading;
}

/* What it flies at moves as it does now, not as at the end of its stretch. */
static void test_it_leads_what_cruises_by_its_velocity_of_now(void **state)
{
    const uint32_t frames = 30;
    const struct vec3 end = {25000.0, 300.0, 24000.0}, velocity = {15.0, 0.0, 0.0};
    (void)state;
    perfect();
    double heads = heads_at(end, velocity, 1.0, frames);
    struct entities e = steps_rows(&f);
    const uint64_t tick = fixture_state(&f).head->tick - 1;
    const double dt_s = world_dt_s(&f.view.world);
    struct vec3 at = cruise_position(&e, 0, tick, dt_s), goes = cruise_velocity(&e, 0, tick, dt_s);
    fixture_close(&f);
    fixture_open(&f, "");
    perfect();
    assert_true(fabs(goes.z) > 5.0); /* another velocity than that of the end */
    assert_true(fabs(heads_at(at, goes, 0.0, 0) - heads) < 1e-12);
}

/* --- how many hit ------------------------------------------------------------------------------*/

/* A way to be shot at: a driven vehicle on a course. */
struct situation {
    const char *kind;
    double height_m, speed_mps; /* the target's */
    double near_m, far_m;       /* distance */
    double throttle;
    double turn;   /* to either side */
    double from_m; /* height of the launch */
    enum behaviour behaviour;
    const char *missile;
};

/* Fires one missile; true if it strikes the target. */
static bool hits(const struct situation *situation, uint64_t *random)
{
    steps_empty(&f);
    double bearing = fixture_uniform(random, 0.0, TWO_PI);
    double course = fixture_uniform(random, 0.0, TWO_PI);
    double distance = fixture_uniform(random, situation->near_m, situation->far_m);
    uint32_t target = fixture_put(
        &f, (struct fixture_entity){.kind = situation->kind,
                                    .at = {25000.0 + distance * maths_sin(bearing),
                                           FIXTURE_GROUND_M + situation->height_m,
                                           25000.0 - distance * maths_cos(bearing)},
                                    .velocity = {situation->speed_mps * maths_sin(course), 0.0,
                                                 -situation->speed_mps * maths_cos(course)},
                                    .behaviour = situation->behaviour});
    struct entities e = steps_rows(&f);
    e.row[target].until_tick = UINT32_MAX;
    e.row[target].steer = (float)(fixture_random(random) % 2 ? situation->turn : -situation->turn);
    e.row[target].throttle = (float)situation->throttle;
    struct vec3 at = {25000.0, FIXTURE_GROUND_M + situation->from_m, 25000.0};
    double full = steps_kind(&f, situation->missile)->max_speed_mps;
    struct vec3 way =
        vec3_sub(vec3_add(entities_position(&e, target),
                          vec3_scale(entities_velocity(&e, target), distance / (0.8 * full))),
                 at);
    uint32_t row = put_missile_of(situation->missile, target, at,
                                  vec3_scale(way, 0.4 * full / vec3_length(way)));
    uint32_t id = steps_rows(&f).row[row].id;
    /* Another missile of the same seed draws other numbers. */
    steps_params(&f)->seed = fixture_random(random);
    for (int frame = 0; frame < 60 * 21 && steps_find(&f, id) != SLOT_NONE; frame++)
        fixture_run(&f, 1);
    uint32_t ends = fixture_event_count(&f, EVENT_DETONATION);
    const struct event *end = fixture_event(&f, EVENT_DETONATION, ends - 1);
    return end != NULL && end->detonation.struck == STRUCK_VEHICLE;
}

static int hits_of(const struct situation *situation, int shots, uint64_t seed)
{
    uint64_t random = fixture_seed(seed);
    int count = 0;
    for (int n = 0; n < shots; n++)
        count += hits(situation, &random);
    return count;
}

static const struct situation alert_jet = {"jet", 800.0, 200.0, 1500.0,           4500.0,
                                           0.7,   0.7,   800.0, BEHAVIOUR_DRIVEN, "missile"};
static const struct situation alert_tank = {"tank", 0.0, 8.0,   1500.0,           4500.0,
                                            0.6,    0.1, 400.0, BEHAVIOUR_DRIVEN, "missile"};
static const struct situation still_tank = {"tank", 0.0, 0.0,   1500.0,         4500.0,
                                            0.0,    0.0, 400.0, BEHAVIOUR_HOLD, "missile"};
static const struct situation tank_for_light = {
    "tank", 0.0, 8.0, 1000.0, 3500.0, 0.6, 0.1, 60.0, BEHAVIOUR_DRIVEN, "anti-tank-missile"};
static const struct situation jet_for_light = {
    "jet", 800.0, 200.0, 1000.0, 3500.0, 0.7, 0.7, 800.0, BEHAVIOUR_DRIVEN, "anti-tank-missile"};

static void test_missiles_hit_as_often_as_real_ones(void **state)
{
    (void)state;
    steps_params(&f)->collision.response = MODEL_NONE;
    static const struct {
        const char *what;
        const struct situation *situation;
        int low, high;
    } row[] = {{"alert jet", &alert_jet, 35, 60},
               {"alert tank", &alert_tank, 60, 80},
               {"tank that does not know", &still_tank, 60, 85},
               {"tank, by a light missile", &tank_for_light, 60, 80},
               {"jet, by a light missile", &jet_for_light, 0, 20}};
    print_message("| 200 missiles at an | real | ours |\n");
    for (size_t n = 0; n < sizeof row / sizeof row[0]; n++) {
        int percent = hits_of(row[n].situation, 200, 7 + n) / 2;
        print_message("| %-24s | %d to %d %% | %d %% |\n", row[n].what, row[n].low, row[n].high,
                      percent);
        assert_true(percent >= row[n].low && percent <= row[n].high);
    }
}

/* The same 200 shots with and without flares. */
static void test_flares_save_every_fourth_jet_or_more(void **state)
{
    struct kind *missile = steps_kind(&f, "missile");
    (void)state;
    steps_params(&f)->collision.response = MODEL_NONE;
    int with = hits_of(&alert_jet, 200, 21);
    missile->decoyed = 0.0;
    int without = hits_of(&alert_jet, 200, 21);
    print_message("of 200 missiles %d strike an alert jet with flares, %d one without\n", with,
                  without);
    assert_true(4 * with < 3 * without && with >= 60 && without <= 180);
}

static void test_perfect_missiles_miss_little(void **state)
{
    (void)state;
    perfect();
    steps_params(&f)->collision.response = MODEL_NONE;
    int jets = hits_of(&alert_jet, 60, 5), tanks = hits_of(&alert_tank, 60, 6);
    print_message("of 60 perfect missiles %d strike a jet that turns hard, %d a tank\n", jets,
                  tanks);
    assert_true(jets >= 50 && tanks >= 55);
}

/* --- motor -------------------------------------------------------------------------------------*/

static void test_the_motor_burns_and_then_drag_slows_it(void **state)
{
    const struct kind *kind = steps_kind(&f, "missile");
    uint32_t row = put_missile(SLOT_NONE, (struct vec3){20000.0, 3000.0, 25000.0},
                               (struct vec3){0.3 * kind->max_speed_mps, 0.0, 0.0});
    (void)state;
    perfect();
    fixture_run(&f, (uint32_t)(60.0 * kind->burn_s) + 1);
    double full = steps_rows(&f).row[row].vx;
    assert_true(fabs(full - kind->max_speed_mps) < 0.01 * kind->max_speed_mps);
    fixture_run(&f, 60 * 10);
    /* 1 / v grows by the drag times the time. */
    double after = 1.0 / (1.0 / full + 1e-4 * 10.0);
    assert_true(fabs(steps_rows(&f).row[row].vx - after) < 2.0);
}

static void turn_hard(const char *name)
{
    const struct kind *kind = steps_kind(&f, name);
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25900.0, 900.0, 24100.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    uint32_t row = put_missile_of(name, jet, (struct vec3){25000.0, 500.0, 25000.0},
                                  (struct vec3){60.0, 0.0, -140.0});
    double hardest = 0.0;
    steps_kind(&f, name)->reliability = 1.0;
    steps_kind(&f, name)->decoyed = 0.0;
    for (int frame = 0; frame < 900; frame++) {
        struct entities e = steps_rows(&f);
        struct vec3 before = entities_velocity(&e, row);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        if (e.row[row].state == ENTITY_FREE)
            break;
        struct vec3 after = entities_velocity(&e, row);
        double speed = vec3_length(after);
        double cosine = vec3_dot(before, after) / (vec3_length(before) * speed);
        double rate = acos(maths_clamp(cosine, -1.0, 1.0)) * 60.0;
        assert_true(rate <= kind->turn_rate_rps + 1e-5);
        hardest = maths_max(hardest, rate * vec3_length(before) / GRAVITY_MPS2);
    }
    print_message("hardest turn of a %s: %.1f g of %.0f\n", name, hardest, kind->max_load);
    assert_true(hardest <= kind->max_load + 0.01 && hardest > 3.0);
}

static void test_its_turns_stay_within_its_load(void **state)
{
    (void)state;
    turn_hard("missile");
    steps_empty(&f);
    turn_hard("anti-tank-missile");
    assert_true(steps_kind(&f, "missile")->max_load >= 20.0);
    assert_true(steps_kind(&f, "anti-tank-missile")->max_load == 10.0);
}

static void test_a_missile_without_a_target_flies_straight(void **state)
{
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 23000.0},
                                                           .velocity = {200.0, 0.0, 0.0}});
    uint32_t lost =
        put_missile(jet, (struct vec3){20000.0, 800.0, 25000.0}, (struct vec3){0.0, 0.0, -100.0});
    uint32_t never = put_missile(SLOT_NONE, (struct vec3){22000.0, 800.0, 25000.0},
                                 (struct vec3){60.0, 80.0, 0.0});
    (void)state;
    perfect();
    steps_rows(&f).row[lost].target_id = 999; /* an id that no row has */
    fixture_run(&f, 120);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.row[lost].x - 20000.0) < 1e-9 && fabs(e.row[lost].y - 800.0) < 1e-9);
    assert_true(e.row[lost].z < 24600.0);
    /* On the line through its start, direction (3, 4, 0). */
    assert_true(fabs((e.row[never].x - 22000.0) * 4.0 - (e.row[never].y - 800.0) * 3.0) < 1e-6);
    assert_true(e.row[never].y > 1000.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_missile_reaches_a_crossing_jet),
        TEST(test_what_leaves_the_seekers_cone_is_lost_for_good),
        TEST(test_it_leads_what_cruises_by_its_velocity_of_now),
        TEST(test_missiles_hit_as_often_as_real_ones),
        TEST(test_flares_save_every_fourth_jet_or_more),
        TEST(test_perfect_missiles_miss_little),
        TEST(test_the_motor_burns_and_then_drag_slows_it),
        TEST(test_its_turns_stay_within_its_load),
        TEST(test_a_missile_without_a_target_flies_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
