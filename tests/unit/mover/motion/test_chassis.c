/* Land vehicles on their springs. The test prints a table: quantity, real value, ours, tolerance.
 * The real values are from Foss (Jane's), Hunnicutt, TM 9-2320-218 and TM 9-2320-209. */
#include "mover/motion/chassis.h"
#include "mover/motion/tyre.h"
#include "tests/support/steps.h"
#include "world/checksum.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define HZ 60u

static struct fixture f;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "");
    return 0;
}

static void reopen(const char *text)
{
    fixture_close(&f);
    fixture_open(&f, text);
}

static void row_of_table(const char *quantity, double real, double ours, const char *unit,
                         double low, double high)
{
    printf("| %-44s | %7.2f | %7.2f | %-4s | %6.2f .. %6.2f |%s\n", quantity, real, ours, unit, low,
           high, ours >= low && ours <= high ? "" : " OUT");
    assert_true(ours >= low && ours <= high);
}

static void share_of_table(const char *quantity, double real, double ours, const char *unit,
                           double share)
{
    row_of_table(quantity, real, ours, unit, real * (1.0 - share), real * (1.0 + share));
}

/* Puts a vehicle that heads east, driven, with its wheels on the ground there. */
static uint32_t put(const char *kind, double x, double speed_mps)
{
    return fixture_put(&f,
                       (struct fixture_entity){.kind = kind,
                                               .at = {x, steps_ground_at(&f, x, 25000.0), 25000.0},
                                               .velocity = {speed_mps, 0.0, 0.0},
                                               .heading_rad = HALF_PI,
                                               .behaviour = BEHAVIOUR_DRIVEN});
}

static double speed_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return sqrt(e.row[row].vx * e.row[row].vx + e.row[row].vy * e.row[row].vy +
                e.row[row].vz * e.row[row].vz);
}

/* --- power and brakes --------------------------------------------------------------------------*/

static double seconds_to(const char *kind, double mps)
{
    reopen("");
    uint32_t row = put(kind, 20000.0, 0.0);
    fixture_run(&f, 3 * HZ); /* it settles */
    for (uint32_t frame = 1; frame < 60 * HZ; frame++) {
        steps_drive(&f, row, 1.0, 0.0, 0.0);
        if (speed_of(row) >= mps)
            return (double)frame / HZ;
    }
    return 60.0;
}

static double climbs_at(const char *kind, double grade)
{
    reopen("");
    steps_plane(&f, grade, 0.0);
    uint32_t row = put(kind, 25000.0, 5.0);
    steps_rows(&f).row[row].pitch = maths_atan2(grade, 1.0);
    for (uint32_t frame = 0; frame < 20 * HZ; frame++)
        steps_drive(&f, row, 1.0, 0.0, 0.0);
    return speed_of(row);
}

static double stops_in(const char *kind, double mps)
{
    reopen("");
    uint32_t row = put(kind, 25000.0, mps);
    for (uint32_t frame = 0; frame < 10 * HZ; frame++)
        steps_pedals(&f, row, 0.0, 1.0, GEAR_AUTOMATIC);
    assert_true(speed_of(row) < 0.01);
    return steps_rows(&f).row[row].x - 25000.0;
}

static void test_power_and_brakes(void **state)
{
    (void)state;
    share_of_table("tank, 0 to 32 km/h on dirt", 6.0, seconds_to("tank", 32.0 / 3.6), "s", 0.25);
    share_of_table("carrier, 0 to 48 km/h on dirt", 20.0, seconds_to("carrier", 48.0 / 3.6), "s",
                   0.25);
    share_of_table("tank, up a grade of 10 %", 8.9, climbs_at("tank", 0.1), "m/s", 0.2);
    share_of_table("tank, up a grade of 60 %", 2.0, climbs_at("tank", 0.6), "m/s", 0.2);
    share_of_table("tank, stop from 48 km/h on dirt", 15.0, stops_in("tank", 48.0 / 3.6), "m", 0.2);
    share_of_table("jeep, stop from 48 km/h on dirt", 15.0, stops_in("jeep", 48.0 / 3.6), "m", 0.2);
}

/* --- turning -----------------------------------------------------------------------------------*/

static double way_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return maths_heading(e.row[row].vx, e.row[row].vz);
}

/* Drives in a full turn to the right. Returns the radius of its path; most: the
 * greatest lateral acceleration [g]. */
static double turns(const char *kind, double mps, double seconds, double *most_g, uint32_t *driven)
{
    uint32_t row = put(kind, 25000.0, mps), frames = (uint32_t)(seconds * HZ);
    double share = mps / steps_kind(&f, kind)->max_speed_mps, rate = 0.0, before;
    *most_g = 0.0;
    *driven = row;
    for (uint32_t frame = 0; frame < frames; frame++) {
        before = way_of(row);
        steps_drive(&f, row, share, 1.0, 0.0);
        rate = maths_wrap_half(way_of(row) - before) * HZ;
        *most_g = maths_max(*most_g, fabs(rate) * speed_of(row) / GRAVITY_MPS2);
    }
    return speed_of(row) / rate;
}

static void test_turning(void **state)
{
    double most_g;
    uint32_t row;
    (void)state;
    share_of_table("jeep, radius at crawl", 5.6, turns("jeep", 2.0, 10.0, &most_g, &row), "m",
                   0.15);
    reopen("");
    share_of_table("truck, radius at crawl", 11.0, turns("truck", 2.0, 10.0, &most_g, &row), "m",
                   0.15);
    reopen("");
    turns("jeep", 20.0, 6.0, &most_g, &row);
    row_of_table("jeep, lateral acceleration on dirt", 0.75, most_g, "g", 0.3, 0.75);
    reopen("");
    turns("truck", 15.0, 6.0, &most_g, &row);
    row_of_table("truck, lateral acceleration on dirt", 0.65, most_g, "g", 0.3, 0.65);
    reopen("");
    turns("tank", 15.0, 6.0, &most_g, &row);
    row_of_table("tank, lateral acceleration on dirt", 0.65, most_g, "g", 0.2, 0.7);
}

/* A hard turn with full throttle slides, and ends when the wheel is straight: nothing spins out. */
static void test_wheels_catch_a_slide(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "hamburger"};
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        reopen("");
        uint32_t row = put(kinds[k], 25000.0, 0.0);
        for (uint32_t frame = 0; frame < 3 * HZ; frame++)
            steps_drive(&f, row, 1.0, 0.6, 0.0);
        for (uint32_t frame = 0; frame < HZ; frame++)
            steps_drive(&f, row, 1.0, 0.0, 0.0);
        double heading = steps_rows(&f).row[row].heading, speed = speed_of(row);
        for (uint32_t frame = 0; frame < HZ; frame++)
            steps_drive(&f, row, 1.0, 0.0, 0.0);
        double turned = fabs(maths_wrap_half(steps_rows(&f).row[row].heading - heading));
        printf("%s: turned by %.2f degrees in the second after, %.1f m/s\n", kinds[k],
               turned * 180.0 / PI, speed_of(row));
        assert_true(turned < 0.05 && speed_of(row) > speed);
    }
}

/* Tracks that slide aside hold with their whole friction, though they turn as in a wide circle. */
static void test_a_tank_that_slides_aside_is_held(void **state)
{
    (void)state;
    reopen("");
    uint32_t row = put("tank", 25000.0, 6.0);
    struct entities e = steps_rows(&f);
    e.row[row].vz = 20.0;
    e.row[row].spin_y = 0.2;
    steps_drive(&f, row, 0.3, 0.2, 0.0);
    fixture_run(&f, 2 * HZ);
    e = steps_rows(&f);
    row_of_table("tank, slides aside on dirt, slowing", 0.6 * GRAVITY_MPS2,
                 0.5 * (20.0 - e.row[row].vz), "m/s2", 5.0, 6.4);
}

static void test_a_tank_turns_on_the_spot(void **state)
{
    (void)state;
    uint32_t row = put("tank", 25000.0, 0.0);
    double turned = 0.0;
    for (uint32_t frame = 0; frame < 5 * HZ; frame++) {
        double before = steps_rows(&f).row[row].heading;
        steps_drive(&f, row, 0.0, 1.0, 0.0);
        turned += maths_wrap_half(steps_rows(&f).row[row].heading - before);
    }
    row_of_table("tank, pivot in 5 s", 90.0, turned * DEG_PER_RAD, "deg", 45.0, 210.0);
    assert_true(hypot(steps_rows(&f).row[row].x - 25000.0, steps_rows(&f).row[row].z - 25000.0) <
                1.0);
}

/* --- tilt --------------------------------------------------------------------------------------*/

/* A vehicle on ground with a friction that no cover has: on a tilt table, and on dry asphalt. */
struct table_test {
    struct step_context step;
    struct serial_context serial;
    struct rigid_body body;
    struct suspension suspension;
    struct drivetrain drivetrain;
};

static void table_begin(struct table_test *test, const char *kind, double roll_rad, double mps)
{
    uint32_t row = put(kind, 25000.0, mps);
    steps_rows(&f).row[row].roll = roll_rad;
    steps_serial_context(&f, &test->step, &test->serial);
    test->body = rigid_body_take(&test->step, row);
    test->drivetrain = (struct drivetrain){.kind = steps_kind(&f, kind), .wanted_mps = mps};
    suspension_of(test->drivetrain.kind, true, &test->suspension);
}

/* Moves it for a time while the table tilts; returns the cosine of its lean on the table. */
static double table_run(struct table_test *test, double friction, double seconds, double *tilt_rad,
                        double tilt_rps)
{
    const double dt_s = 1.0 / 240.0;
    struct rigid_body *body = &test->body;
    double up = 1.0, least = tilt_rps > 0.0 ? 0.8 : 0.1;
    for (int n = 0; n < (int)(seconds / dt_s) && up > least; n++) {
        struct mat3 turn = rotation_matrix(body->turn);
        struct mat3 inverse = mass_properties_inverse_world(&body->inertia, &turn);
        double load = suspension_load(&test->suspension, &test->step, body, &turn, false);
        for (uint32_t i = 0; i < test->suspension.count; i++)
            test->suspension.wheel[i].friction = friction;
        for (uint32_t i = 0; i < test->suspension.count; i++) {
            const struct wheel *wheel = &test->suspension.wheel[i];
            struct vec3 push = vec3_scale(wheel->normal, wheel->load_n * dt_s);
            body->velocity =
                vec3_add(body->velocity, vec3_scale(push, 1.0 / body->inertia.mass_kg));
            body->spin =
                vec3_add(body->spin, rotation_apply(&inverse, vec3_cross(wheel->arm, push)));
        }
        *tilt_rad += tilt_rps * dt_s;
        body->velocity.y -= GRAVITY_MPS2 * maths_cos(*tilt_rad) * dt_s;
        body->velocity.z += GRAVITY_MPS2 * maths_sin(*tilt_rad) * dt_s;
        const struct tyre_demand demand = {
            .drivetrain = &test->drivetrain,
            .force = {0.0, test->drivetrain.wanted_mps == 0.0 ? friction * load : 0.0},
            .side = 1.0,
            .grip_n = friction * load,
            .dt_s = dt_s};
        if (load > 0.0)
            tyre_solve(&test->suspension, body, &turn, &inverse, &demand);
        body->centre = vec3_add(body->centre, vec3_scale(body->velocity, dt_s));
        rigid_body_turn(body, (struct vec3){0.0, 0.0, 0.0}, dt_s);
        up = rotation_matrix(body->turn).m[1][1];
    }
    return up;
}

/* Returns the angle of the table at which the vehicle goes over [deg]. */
static double tips_at(const char *kind)
{
    struct table_test test;
    double tilt = 0.0;
    steps_empty(&f);
    table_begin(&test, kind, 0.0, 0.0);
    table_run(&test, 5.0, 60.0, &tilt, 2.0 * RAD_PER_DEG);
    return tilt * DEG_PER_RAD;
}

static void test_static_tilt(void **state)
{
    (void)state;
    static const struct {
        const char *kind, *quantity;
        double degrees;
    } rows[] = {{"jeep", "jeep, static tilt", 46.0},
                {"truck", "truck, static tilt", 37.0},
                {"tank", "tank, static tilt", 55.0}};
    for (size_t n = 0; n < sizeof rows / sizeof rows[0]; n++)
        row_of_table(rows[n].quantity, rows[n].degrees, tips_at(rows[n].kind), "deg",
                     rows[n].degrees - 4.0, rows[n].degrees + 4.0);
}

static void test_a_laden_truck_rolls_in_a_hard_turn_and_a_jeep_does_not(void **state)
{
    struct table_test test;
    double level = 0.0;
    (void)state;
    table_begin(&test, "truck", 0.0, 20.0);
    test.drivetrain.curve = 1.5 * GRAVITY_MPS2 / 400.0;
    double truck = table_run(&test, 0.9, 5.0, &level, 0.0);
    row_of_table("truck, hard turn at 20 m/s, friction 0.9, tilt", 90.0,
                 maths_atan2(sqrt(1.0 - truck * truck), truck) * DEG_PER_RAD, "deg", 80.0, 180.0);
    steps_empty(&f);
    table_begin(&test, "jeep", 0.0, 20.0);
    test.drivetrain.curve = 1.5 * GRAVITY_MPS2 / 400.0;
    assert_true(table_run(&test, 0.65, 5.0, &level, 0.0) > 0.9);
}

/* --- jumps and drops ---------------------------------------------------------------------------*/

/* A ramp of 10 degrees up to x = 25000, where the ground falls back to its level: posts are 125 m
 * apart, so the ground falls steeply behind the edge. */
static double ramp(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 500.0 + (x <= 25000.0 ? (x - 25000.0) * 0.17632698 : -200.0);
}

static void test_a_jeep_jumps_off_a_ramp(void **state)
{
    (void)state;
    steps_ground(&f, ramp, NULL);
    uint32_t row = put("jeep", 24950.0, 13.4);
    steps_rows(&f).row[row].pitch = 10.0 * RAD_PER_DEG;
    double left = 0.0;
    struct vec3 at = {0.0, 0.0, 0.0};
    for (uint32_t frame = 0; frame < 8 * HZ; frame++) {
        steps_drive(&f, row, 13.4 / 29.0, 0.0, 0.0);
        struct entities e = steps_rows(&f);
        if (left == 0.0 && e.row[row].x > 25000.0) {
            left = frame;
            at = entities_position(&e, row);
        }
        if (left > 0.0 && e.row[row].y < at.y && e.row[row].vy < 0.0 && frame > left + 3) {
            share_of_table("jeep, 10 degree ramp at 13.4 m/s, air time", 0.47, (frame - left) / HZ,
                           "s", 0.2);
            share_of_table("jeep, the same, way in the air", 6.2, e.row[row].x - at.x, "m", 0.2);
            return;
        }
    }
    assert_true(false);
}

static struct fixture_entity hung(const char *kind, double height)
{
    return (struct fixture_entity){.kind = kind,
                                   .at = {25000.0, 100.0 + height, 25000.0},
                                   .heading_rad = HALF_PI,
                                   .behaviour = BEHAVIOUR_DRIVEN};
}

#define LOOKS 80 /* in the 8 s of a drop, ten a second */

/* Drops a vehicle; returns how deep its position goes below the ground, and its height at rest.
 * height_m: over the ground, ten times a second. */
static double jounce(const char *kind, const char *world, uint32_t hz, double height,
                     double *rest_m, double height_m[LOOKS])
{
    double lowest = 1e9;
    reopen(world);
    uint32_t row = fixture_put(&f, hung(kind, height));
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_CHASSIS;
    for (uint32_t frame = 0; frame < 8 * hz; frame++) {
        fixture_run(&f, 1);
        lowest = maths_min(lowest, steps_rows(&f).row[row].y - 100.0);
        if ((frame + 1) % (hz / 10) == 0)
            height_m[frame / (hz / 10)] = steps_rows(&f).row[row].y - 100.0;
    }
    assert_true(speed_of(row) == 0.0); /* it stands */
    *rest_m = steps_rows(&f).row[row].y - 100.0;
    return -lowest;
}

static void test_ride_height_and_jounce_at_10_and_60_hz(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck", "hamburger"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double slow_m, fast_m, slow_at[LOOKS], fast_at[LOOKS], apart = 0.0;
        double fast = jounce(kinds[n], "", 60, 0.3, &fast_m, fast_at);
        double slow = jounce(kinds[n], "world = { hz = 10; };", 10, 0.3, &slow_m, slow_at);
        for (int look = 0; look < LOOKS; look++)
            apart = maths_max(apart, fabs(slow_at[look] - fast_at[look]));
        char what[64];
        printf("%s: jounce %.3f at 60 Hz, %.3f at 10 Hz; rest %.4f, %.4f m\n", kinds[n], fast, slow,
               fast_m, slow_m);
        snprintf(what, sizeof what, "%s, ride height, 10 less 60 Hz", kinds[n]);
        row_of_table(what, 0.0, 1000.0 * (slow_m - fast_m), "mm", -10.0, 10.0);
        /* A frame of 1/10 s may pass over the lowest point. */
        snprintf(what, sizeof what, "%s, heights after a drop differ, 10, 60 Hz", kinds[n]);
        row_of_table(what, 0.0, 100.0 * apart / fast, "%", 0.0, 10.0);
        assert_true(fabs(fast_m) < 0.01);
    }
}

static void test_it_lands_from_a_metre_on_its_wheels(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck", "attack-tomato"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double rest_m, height_m[LOOKS];
        jounce(kinds[n], "", 60, 1.0, &rest_m, height_m);
        assert_true(fabs(rest_m) < 0.01);
    }
}

static void test_it_stands_on_a_side_slope_without_creeping(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        reopen("");
        steps_plane(&f, 0.1, 0.25);
        uint32_t row = put(kinds[n], 25000.0, 0.0);
        fixture_run(&f, 5 * HZ);
        struct entities e = steps_rows(&f);
        const struct vec3 at = entities_position(&e, row);
        fixture_run(&f, 10 * HZ);
        e = steps_rows(&f);
        double crept = vec3_length(vec3_sub(entities_position(&e, row), at));
        printf("%s crept %.6f m in 10 s on a slope of 27 %%\n", kinds[n], crept);
        assert_true(crept < 1e-3 / 6.0);
    }
}

/* --- modes -------------------------------------------------------------------------------------*/

/* Returns how much the row's place and speed differ from those that its speed before gave, at most
 * over the frames in which it goes back to the ground. */
static void go_back(uint32_t row, double *jump_m, double *speed_mps)
{
    *jump_m = *speed_mps = 0.0;
    for (uint32_t frame = 0; frame < 30 * HZ; frame++) {
        struct entities e = steps_rows(&f);
        const struct vec3 at = entities_position(&e, row), v = entities_velocity(&e, row);
        bool back = !(e.row[row].flags & ENTITY_FLAG_CHASSIS);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        struct vec3 way = vec3_sub(entities_position(&e, row), at);
        struct vec3 off = vec3_sub(way, vec3_scale(v, 1.0 / HZ));
        struct vec3 faster = vec3_sub(entities_velocity(&e, row), v);
        double calm = (double)(fixture_state(&f).head->tick - e.row[row].jolt_tick) / HZ;
        if (back)
            return;
        if (calm < CHASSIS_CALM_S - 0.1) /* not yet */
            continue;
        *jump_m = maths_max(*jump_m, vec3_length(off));
        *speed_mps = maths_max(*speed_mps, vec3_length(faster));
    }
    assert_true(false); /* it never went back */
}

static uint32_t put_agent(const char *kind, double height_m, double mps)
{
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){
                .kind = kind,
                .at = {25000.0, steps_ground_at(&f, 25000.0, 25000.0) + height_m, 25000.0},
                .velocity = {mps, 0.0, 0.0},
                .heading_rad = HALF_PI,
                .behaviour = BEHAVIOUR_IDLE});
    steps_rows(&f).row[row].behaviour = steps_rows(&f).row[row].order = BEHAVIOUR_IDLE;
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_CHASSIS;
    return row;
}

/* A body that a contact keeps off its springs is not moved, until its driver wants it to go. */
static void test_a_pinned_body_stands_until_it_is_driven(void **state)
{
    (void)state;
    uint32_t row = put("tank", 25000.0, 0.0);
    fixture_run(&f, HZ);
    struct entities e = steps_rows(&f);
    double pitch = e.row[row].pitch -= 0.02;
    e.row[row].flags |= ENTITY_FLAG_CHASSIS;
    e.row[row].jolt_tick = ENTITY_PINNED;
    const struct vec3 at = entities_position(&e, row);
    fixture_run(&f, 5 * HZ);
    e = steps_rows(&f);
    assert_true(e.row[row].pitch == pitch && e.row[row].x == at.x && e.row[row].y == at.y &&
                e.row[row].z == at.z);
    assert_true(entities_still(&e, row) && e.row[row].jolt_tick == ENTITY_PINNED);
    e.row[row].throttle = 1.0f;
    fixture_run(&f, HZ);
    e = steps_rows(&f);
    assert_true(e.row[row].x > at.x && fabs(e.row[row].pitch - pitch) > 1e-3);
    assert_true(e.row[row].jolt_tick != ENTITY_PINNED);
}

static void test_it_goes_back_to_the_ground_without_a_jump(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double jump, faster;
        reopen("");
        steps_plane(&f, 0.15, 0.1);
        uint32_t row = put_agent(kinds[n], 0.2, n & 1 ? 0.0 : 6.0);
        steps_rows(&f).row[row].pitch = maths_atan2(0.15, 1.0);
        go_back(row, &jump, &faster);
        printf("%s: back with a jump of %.4f m and %.4f m/s a frame\n", kinds[n], jump, faster);
        assert_true(jump <= 0.01 && faster <= 0.05);
        struct entities e = steps_rows(&f);
        assert_true(fabs(e.row[row].y - steps_ground_at(&f, e.row[row].x, e.row[row].z)) < 1e-6);
    }
}

/* A driver takes a vehicle that follows the ground. */
static void test_it_goes_to_its_springs_without_a_jump(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double jump = 0.0, faster = 0.0, turned = 0.0;
        reopen("");
        steps_plane(&f, 0.12, 0.15);
        uint32_t row = put_agent(kinds[n], 0.0, 6.0);
        steps_rows(&f).row[row].flags = 0;
        fixture_run(&f, 2);
        steps_rows(&f).row[row].vx = 6.0;
        for (uint32_t frame = 0; frame < 2 * HZ; frame++) {
            struct entities e = steps_rows(&f);
            const struct vec3 at = entities_position(&e, row), v = entities_velocity(&e, row);
            double pitch = e.row[row].pitch, roll = e.row[row].roll;
            steps_drive(&f, row, 6.0 / steps_kind(&f, kinds[n])->max_speed_mps, 0.0, 0.0);
            e = steps_rows(&f);
            struct vec3 way = vec3_sub(entities_position(&e, row), at);
            jump = maths_max(jump, vec3_length(vec3_sub(way, vec3_scale(v, 1.0 / HZ))));
            faster = maths_max(faster, vec3_length(vec3_sub(entities_velocity(&e, row), v)));
            turned =
                maths_max(turned, fabs(e.row[row].pitch - pitch) + fabs(e.row[row].roll - roll));
        }
        printf("%s: driven with a jump of %.4f m, %.3f m/s and %.4f rad a frame\n", kinds[n], jump,
               faster, turned);
        assert_true(steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS);
        assert_true(jump <= 0.01 && faster <= 0.1 && turned <= 0.01);
    }
}

static void test_an_undisturbed_agent_follows_the_ground(void **state)
{
    (void)state;
    uint32_t row = put_agent("jeep", 0.0, 0.0);
    steps_rows(&f).row[row].flags = 0;
    fixture_run(&f, 3 * HZ);
    assert_false(steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS);
    steps_rows(&f).row[row].spin_y = 1.0; /* something has pushed it */
    fixture_run(&f, 1);
    assert_true(steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS);
}

/* A heap sleeps only if nothing in it moves by the last bit. */
static void test_it_keeps_every_bit_of_its_pose_at_rest(void **state)
{
    enum { TANKS = 40 };
    const uint64_t pose = FIELD_BIT(x) | FIELD_BIT(z) | FIELD_BIT(heading) | FIELD_BIT(pitch);
    struct entity stood[TANKS];
    struct entities e;
    (void)state;
    steps_plane(&f, 0.05, 0.03);
    for (uint32_t i = 0; i < TANKS; i++) {
        put("tank", 24000.0 + 50.0 * i, 0.0);
        steps_rows(&f).row[i].heading = 0.01 + 0.15 * i;
    }
    fixture_run(&f, 10 * HZ);
    e = steps_rows(&f);
    memcpy(stood, e.row, sizeof stood);
    for (uint32_t frame = 0; frame < 3; frame++) {
        fixture_run(&f, 1);
        e = steps_rows(&f);
        for (uint32_t i = 0; i < TANKS; i++)
            assert_true((entity_differing(&stood[i], &e.row[i]) & pose) == 0);
    }
}

/* --- rough ground ------------------------------------------------------------------------------*/

/* Returns the height of the lowest corner of the shell over the ground [m]. */
static double lowest_corner(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct kind *kind = &f.view.world.kinds[e.row[row].kind];
    struct mat3 turn =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    double lowest = INFINITY;
    for (unsigned n = 0; n < 8; n++) {
        double under = kind->tracked ? 0.0 : 0.75 * kind->step_m;
        double half = (kind->tracked ? 0.22 : 0.15) * kind->length_m;
        struct vec3 own = {n & 1 ? half : -half,
                           n & 2 ? kind->height_m : maths_max(kind->travel_m, under),
                           (n & 4 ? 0.5 : -0.5) * kind->width_m};
        struct vec3 at = vec3_add(entities_position(&e, row), rotation_apply(&turn, own));
        lowest = maths_min(lowest, at.y - steps_ground_at(&f, at.x, at.z));
    }
    return lowest;
}

static void dig(double x, double z, float radius_m, float depth_m)
{
    struct state now = fixture_state(&f);
    for (int buffer = 0; buffer < 2; buffer++) {
        struct state_head *head = f.view.w[buffer].head;
        now.craters[head->crater_count] = (struct crater){x, z, radius_m, depth_m, 1};
        head->crater_count++;
    }
}

static void test_it_crosses_a_crater_on_its_springs(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double deepest = 0.0, lean = 0.0;
        reopen("");
        dig(25030.0, 25001.0, 4.0f, 0.6f);
        uint32_t row = put(kinds[n], 25000.0, 6.0);
        for (uint32_t frame = 0; frame < 15 * HZ; frame++) {
            steps_drive(&f, row, 6.0 / steps_kind(&f, kinds[n])->max_speed_mps, 0.0, 0.0);
            deepest = maths_min(deepest, lowest_corner(row));
            lean = maths_max(lean, fabs(steps_rows(&f).row[row].roll));
        }
        printf("%s: %.0f m on, lowest corner %.3f m, leant %.1f degrees\n", kinds[n],
               steps_rows(&f).row[row].x - 25000.0, deepest, lean * DEG_PER_RAD);
        assert_true(steps_rows(&f).row[row].x > 25045.0); /* across */
        assert_true(deepest > -0.02 && lean > 0.02);
    }
}

static double waves(double x, double z, const void *context)
{
    (void)z;
    return 100.0 + *(const double *)context * maths_sin(x * TWO_PI / 500.0);
}

static void test_it_keeps_its_shell_over_the_ground_on_waves(void **state)
{
    double high = 25.0;
    (void)state;
    steps_ground(&f, waves, &high);
    steps_kind(&f, "jeep")->resistance_j = 1e12; /* its landings would wreck it */
    uint32_t row = put("jeep", 25000.0, 25.0);
    double deepest = 0.0, fastest = 0.0;
    for (uint32_t frame = 0; frame < 60 * HZ; frame++) {
        steps_drive(&f, row, 1.0, 0.0, 0.0);
        deepest = maths_min(deepest, lowest_corner(row));
        fastest = maths_max(fastest, fabs(steps_rows(&f).row[row].vy));
    }
    printf("jeep on waves: lowest corner %.3f m, vertical speed %.1f m/s\n", deepest, fastest);
    assert_true(deepest > -0.02 && steps_rows(&f).row[row].x > 25900.0);
}

/* --- frames and threads ------------------------------------------------------------------------*/

/* Drives into a hard turn and returns true if the vehicle overturns. */
static bool overturns(const char *world, uint32_t hz, const char *kind, double mps)
{
    reopen(world);
    steps_cover(&f, COVER_ROAD, 0.0, 0.0, 50000.0, 50000.0);
    uint32_t row = put(kind, 25000.0, mps);
    double share = maths_min(1.0, mps / steps_kind(&f, kind)->max_speed_mps);
    steps_kind(&f, kind)->centre_height_m *= 1.3; /* a high load */
    for (uint32_t frame = 0; frame < 6 * hz; frame++) {
        if (steps_rows(&f).row[row].state == ENTITY_WRECK)
            return true;
        steps_drive(&f, row, share, 1.0, 0.0);
    }
    return steps_rows(&f).row[row].state == ENTITY_WRECK;
}

static void test_10_and_60_hz_agree_on_what_turns_over(void **state)
{
    static const char *const kinds[] = {"truck", "jeep", "tank", "carrier"};
    int over = 0;
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        for (double mps = 8.0; mps <= 20.0; mps += 6.0) {
            bool fast = overturns("", 60, kinds[n], mps);
            bool slow = overturns("world = { hz = 10; };", 10, kinds[n], mps);
            printf("%s at %2.0f m/s on asphalt: %s at 60 Hz, %s at 10 Hz\n", kinds[n], mps,
                   fast ? "over" : "upright", slow ? "over" : "upright");
            assert_int_equal(fast, slow);
            over += fast;
        }
    }
    assert_true(over > 0);
}

static uint64_t digest_after(uint32_t threads)
{
    reopen("");
    for (int n = 0; n < 24; n++) {
        static const char *const kinds[] = {"tank", "jeep", "truck", "carrier"};
        double x = 25000.0 + 30.0 * (n % 6), z = 25000.0 + 30.0 * floor(n / 6.0);
        uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kinds[n % 4],
                                                               .at = {x, 100.0 + 0.1 * n, z},
                                                               .velocity = {n - 10.0, 0.0, 5.0},
                                                               .behaviour = BEHAVIOUR_DRIVEN});
        steps_rows(&f).row[row].throttle = 0.5f;
        steps_rows(&f).row[row].steer = (float)(n - 12) / 12.0f;
    }
    fixture_threads(&f, threads);
    fixture_run(&f, 4 * HZ);
    return fixture_digest(&f);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    uint64_t one = digest_after(1);
    assert_true(digest_after(2) == one && digest_after(4) == one);
}

/* A truck that stands beside a bank of 0.3 m, with one side of its hull over it. Its wheels stand
 * on the level ground, so it stays there, however it came. */
static void test_an_edge_under_a_corner_does_not_lift_it(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++) {
        reopen("terrain = { source = \"flat\"; height_m = 100.0; };"
               "earthworks = ( { shape = \"table\"; at = [24993.85, 24998.0]; length_m = 20.0;"
               "    width_m = 10.0; height_m = 0.3; edge_m = 0.05; } );");
        uint32_t row = fixture_put(
            &f, (struct fixture_entity){.kind = "truck", .at = {25000.0, 100.0, 24998.0}});
        steps_rows(&f).row[row].behaviour = BEHAVIOUR_IDLE;
        double high = -INFINITY, low = INFINITY;
        if (b == 1)
            steps_rows(&f).row[row].flags |= ENTITY_FLAG_CHASSIS;
        for (uint32_t frame = 0; frame < 20 * HZ; frame++) {
            fixture_run(&f, 1);
            if (frame < 3 * HZ)
                continue;
            high = maths_max(high, steps_rows(&f).row[row].y - 100.0);
            low = maths_min(low, steps_rows(&f).row[row].y - 100.0);
        }
        printf("truck beside a bank, %s: %.6f to %.6f m over the ground\n",
               b == 0 ? "from the ground" : "from its springs", low, high);
        assert_true(high < 0.02 && high - low < 1e-9);
    }
}

int main(void)
{
#define T(name) cmocka_unit_test_setup_teardown(name, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        T(test_power_and_brakes),
        T(test_turning),
        T(test_wheels_catch_a_slide),
        T(test_a_tank_that_slides_aside_is_held),
        T(test_a_tank_turns_on_the_spot),
        T(test_a_laden_truck_rolls_in_a_hard_turn_and_a_jeep_does_not),
        T(test_static_tilt),
        T(test_a_jeep_jumps_off_a_ramp),
        T(test_ride_height_and_jounce_at_10_and_60_hz),
        T(test_it_lands_from_a_metre_on_its_wheels),
        T(test_it_stands_on_a_side_slope_without_creeping),
        T(test_a_pinned_body_stands_until_it_is_driven),
        T(test_it_goes_back_to_the_ground_without_a_jump),
        T(test_it_goes_to_its_springs_without_a_jump),
        T(test_an_undisturbed_agent_follows_the_ground),
        T(test_it_keeps_every_bit_of_its_pose_at_rest),
        T(test_it_crosses_a_crater_on_its_springs),
        T(test_it_keeps_its_shell_over_the_ground_on_waves),
        T(test_an_edge_under_a_corner_does_not_lift_it),
        T(test_10_and_60_hz_agree_on_what_turns_over),
        T(test_threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
