/* Wrecks on the ground: random kinds, poses, speeds and ground, in frames of random length. They
 * gain no energy, do not sink in, do not snap, and come to rest. */
#include "tests/support/steps.h"
#include "world/body_points.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROUNDS   15
#define WRECKS   36u /* 6 by 6, so far apart that they do not meet */
#define APART_M  7000.0
#define CRATERS  400u
#define REST_S   60.0
#define SLOW_MPS 30.0

/* Bounds that docs/collisions.md states. */
#define DEPTH_SLOW_M 0.05
#define DEPTH_FAST_M 0.4
#define SLOP_M       0.002
#define SNAP_RAD     0.2
#define SLIDE_M      1000.0

static struct fixture f;

static const char *const kinds[] = {"tank",          "jeep",     "truck",      "carrier",
                                    "jet",           "wishbone", "helicopter", "helo-cow",
                                    "attack-tomato", "hamburger"};

struct rough {
    double height_m, per_m, east, south;
};

static double rough_height(double x, double z, const void *context)
{
    const struct rough *rough = context;
    return 200.0 + rough->east * (x - 25000.0) + rough->south * (z - 25000.0) +
           rough->height_m * maths_sin(x * rough->per_m) * maths_cos(z * rough->per_m * 1.3);
}

/* --- measures ----------------------------------------------------------------------------------*/

static struct quat pose_of(const struct entities *e, uint32_t i)
{
    return rotation_of(e->row[i].heading, e->row[i].pitch, e->row[i].roll);
}

static double energy_of(const struct entities *e, uint32_t i)
{
    const struct mass_properties mass = mass_properties_of(&f.view.world.kinds[e->row[i].kind]);
    struct mat3 turn = rotation_matrix(pose_of(e, i));
    struct vec3 spin = {e->row[i].spin_x, e->row[i].spin_y, e->row[i].spin_z};
    struct vec3 arm = rotation_apply(&turn, (struct vec3){0.0, mass.centre_m, 0.0});
    struct vec3 v = vec3_add(entities_velocity(e, i), vec3_cross(spin, arm));
    struct vec3 w = rotation_back(&turn, spin);
    return 0.5 * mass.mass_kg * vec3_dot(v, v) +
           0.5 *
               (mass.moment.x * w.x * w.x + mass.moment.y * w.y * w.y + mass.moment.z * w.z * w.z) +
           mass.mass_kg * GRAVITY_MPS2 * (e->row[i].y + arm.y);
}

static double clearance_of(const struct entities *e, uint32_t i)
{
    struct body_points points;
    body_points_of(&f.view.world, e->row[i].kind, &points);
    return body_points_clearance(&f.view.world, &f.stepper.mover.craters, &points,
                                 entities_position(e, i), pose_of(e, i));
}

static double depth_of(const struct entities *e, uint32_t i)
{
    return maths_max(0.0, -clearance_of(e, i));
}

static double spin_of(const struct entities *e, uint32_t i)
{
    return vec3_length((struct vec3){e->row[i].spin_x, e->row[i].spin_y, e->row[i].spin_z});
}

static bool still(const struct entities *e, uint32_t i)
{
    return vec3_length(entities_velocity(e, i)) == 0.0 && spin_of(e, i) == 0.0;
}

/* --- what a wreck was before the frame
 * -----------------------------------------------------------*/

struct before {
    struct vec3 at, start;
    struct quat pose;
    double energy, depth, spin, speed, fastest;
    bool touched; /* start is where it touched the ground first */
};

static struct before before[WRECKS];
static double worst_gain, worst_slow, worst_fast, worst_snap, worst_long, worst_slide, worst_time;

static void note_before(uint32_t i)
{
    struct entities e = steps_rows(&f);
    before[i].at = entities_position(&e, i);
    before[i].pose = pose_of(&e, i);
    before[i].energy = energy_of(&e, i);
    before[i].depth = depth_of(&e, i);
    before[i].spin = spin_of(&e, i);
    before[i].speed = vec3_length(entities_velocity(&e, i));
    if (!before[i].touched && clearance_of(&e, i) < 0.05) {
        before[i].touched = true;
        before[i].start = before[i].at;
    }
    before[i].fastest = maths_max(before[i].fastest, before[i].speed + 8.0 * before[i].spin);
}

static void check_frame(uint32_t i, double dt_s)
{
    struct entities e = steps_rows(&f);
    const struct kind *kind = &f.view.world.kinds[e.row[i].kind];
    double lift = kind->mass_kg * GRAVITY_MPS2 * maths_max(0.0, before[i].depth - SLOP_M) * 1.5;
    double gain = energy_of(&e, i) - before[i].energy - lift;
    double depth = depth_of(&e, i);
    double spin = maths_max(before[i].spin, spin_of(&e, i));
    double snap = rotation_rate(before[i].pose, pose_of(&e, i)) - spin * dt_s;
    double *turned = dt_s < 0.02 ? &worst_snap : &worst_long;
    double *worst = before[i].fastest < SLOW_MPS ? &worst_slow : &worst_fast;
    *worst = maths_max(*worst, depth);
    worst_gain = maths_max(worst_gain, gain / kind->mass_kg);
    *turned = maths_max(*turned, snap);
    if (gain > 1e-7 * kind->mass_kg || depth > DEPTH_FAST_M ||
        (before[i].fastest < SLOW_MPS && depth > DEPTH_SLOW_M) || (dt_s < 0.02 && snap > SNAP_RAD))
        print_message("row %u %s: gain %g J/kg, depth %g m (%g before), snap %g rad, fastest %g, "
                      "dt %g, spin %g\n",
                      i, kind->name, gain / kind->mass_kg, depth, before[i].depth, snap,
                      before[i].fastest, dt_s, spin);
    assert_true(gain <= 1e-7 * kind->mass_kg);
    assert_true(depth <= DEPTH_FAST_M);
    assert_true(before[i].fastest >= SLOW_MPS || depth <= DEPTH_SLOW_M);
    assert_true(dt_s >= 0.02 || snap <= SNAP_RAD); /* spin may rise and fall in a long frame */
}

/* --- rounds
 * --------------------------------------------------------------------------------------*/

static void put_wreck(uint64_t *random, uint32_t i, double fastest)
{
    double x = 7500.0 + APART_M * (i % 6), z = 7500.0 + APART_M * (i / 6);
    double speed = fixture_uniform(random, 0.0, 1.0) * fixture_uniform(random, 0.0, fastest);
    double course = fixture_uniform(random, 0.0, TWO_PI), down = fixture_uniform(random, -0.3, 0.8);
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){
                .kind = kinds[fixture_random(random) % (sizeof kinds / sizeof kinds[0])],
                .at = {x, 0.0, z},
                .velocity = {speed * cos(course), -speed * down, speed * sin(course)}});
    struct entities e = steps_rows(&f);
    struct body_points points;
    assert_int_equal(row, i);
    e.row[i].state = ENTITY_WRECK;
    e.row[i].behaviour = e.row[i].order = BEHAVIOUR_IDLE;
    e.row[i].heading = fixture_uniform(random, 0.0, TWO_PI);
    e.row[i].pitch = fixture_uniform(random, -1.5, 1.5);
    e.row[i].roll = fixture_uniform(random, -3.1, 3.1);
    e.row[i].spin_x = fixture_uniform(random, -3.0, 3.0);
    e.row[i].spin_y = fixture_uniform(random, -3.0, 3.0);
    e.row[i].spin_z = fixture_uniform(random, -3.0, 3.0);
    body_points_of(&f.view.world, e.row[i].kind, &points);
    e.row[i].y = fixture_uniform(random, 0.0, 20.0) -
                 body_points_clearance(&f.view.world, &f.stepper.mover.craters, &points,
                                       entities_position(&e, i), pose_of(&e, i));
    before[i] = (struct before){.start = entities_position(&e, i)};
}

static void dig_craters(uint64_t *random, uint32_t count)
{
    struct state now = fixture_state(&f);
    for (uint32_t n = 0; n < count; n++) {
        uint32_t i = n % WRECKS;
        double radius = fixture_uniform(random, 1.5, 10.0);
        now.craters[n] =
            (struct crater){7500.0 + APART_M * (i % 6) + fixture_uniform(random, -150.0, 150.0),
                            7500.0 + APART_M * (i / 6) + fixture_uniform(random, -150.0, 150.0),
                            (float)radius, (float)(0.4 * radius), 0};
    }
    now.head->crater_count = count;
    crater_index_update(&f.stepper.mover.craters, count);
}

/* Returns how many wrecks move. */
static uint32_t run_frame(double dt_s)
{
    uint32_t moving = 0;
    for (uint32_t i = 0; i < WRECKS; i++)
        note_before(i);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    uint64_t tick = fixture_state(&f).head->tick;
    for (uint32_t i = 0; i < WRECKS; i++) {
        check_frame(i, dt_s);
        moving += !still(&e, i) || e.row[i].until_tick == 0 || e.row[i].until_tick > tick;
    }
    return moving;
}

static void check_rest(void)
{
    struct entities e = steps_rows(&f);
    for (uint32_t i = 0; i < WRECKS; i++) {
        note_before(i);
        struct vec3 way = vec3_sub(before[i].at, before[i].start);
        double slide = sqrt(way.x * way.x + way.z * way.z);
        worst_slide = maths_max(worst_slide, slide);
        assert_true(slide <= SLIDE_M);
    }
    fixture_run(&f, 100);
    e = steps_rows(&f);
    for (uint32_t i = 0; i < WRECKS; i++) {
        struct quat pose = pose_of(&e, i);
        assert_true(still(&e, i) && e.row[i].x == before[i].at.x && e.row[i].y == before[i].at.y &&
                    e.row[i].z == before[i].at.z);
        assert_true(pose.w == before[i].pose.w && pose.x == before[i].pose.x &&
                    pose.y == before[i].pose.y && pose.z == before[i].pose.z);
    }
}

static void one_round(uint64_t *random, int round)
{
    static const double rates[] = {10.0, 20.0, 60.0, 144.0, 240.0};
    double dt_s = 1.0 / rates[round % 5];
    bool is_rough = round % 3 > 0, has_craters = round % 3 > 1;
    struct rough rough = {is_rough ? fixture_uniform(random, 0.0, 15.0) : 0.0, 0.01,
                          fixture_uniform(random, -0.1, 0.1), fixture_uniform(random, -0.1, 0.1)};
    double fastest = round % 2 ? 28.0 : 250.0;
    uint32_t moving = WRECKS;
    steps_empty(&f);
    steps_params(&f)->dt_s = dt_s;
    steps_ground(&f, rough_height, &rough);
    dig_craters(random, has_craters ? CRATERS : 0);
    for (uint32_t i = 0; i < WRECKS; i++)
        put_wreck(random, i, fastest);
    double time = 0.0;
    for (; moving > 0; time += dt_s) {
        moving = run_frame(dt_s);
        if (time > REST_S)
            print_message("%u wrecks still move\n", moving);
        assert_true(time <= REST_S);
    }
    worst_time = maths_max(worst_time, time);
    check_rest();
}

static void test_wrecks_gain_no_energy_and_come_to_rest(void **state)
{
    uint64_t random = fixture_seed(31);
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; };\n"
                     "collision = { shape = \"model\"; };\n");
    for (int round = 0; round < ROUNDS; round++)
        one_round(&random, round);
    print_message("worst: gain %g J/kg, depth %g m below 30 m/s, %g m above, snap %g rad (%g at 10 "
                  "and 20 Hz), "
                  "slide %g m, rest after %g s\n",
                  worst_gain, worst_slow, worst_fast, worst_snap, worst_long, worst_slide,
                  worst_time);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrecks_gain_no_energy_and_come_to_rest),
    };
    return cmocka_run_group_tests_name("wrecks", tests, NULL, NULL);
}
