/* Wrecks that lie on others, lean on walls and are pushed (thesis rows 36, 39, 46): they come to
 * rest, are not in each other at a frame's end, gain no energy, and each contact begins and ends
 * once. SEED=n drops them elsewhere. */
#include "collider/motion/body_motion.h"
#include "tests/support/placed_hulls.h"
#include "tests/support/steps.h"
#include "world/body_points.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include <cmocka.h>

#define OVERLAP_M   1e-3 /* of two bodies, and of a body and a wall, at a frame's end */
#define ENERGY_JPKG 0.01 /* growth in a frame, of all together, beyond an engine's work */
#define STILL_M     1e-3 /* most motion of a wreck in the last second */
#define CREEPS_M    1e-2 /* the same in a heap, and on a vehicle without brakes */
#define HEAP_JPKG   0.05 /* growth where wrecks strike each other at up to 50 m/s */
#define JUMP_M      0.01 /* way of a frame beyond the velocity */
#define UNDER_M     0.1  /* of a wreck that others have struck into the ground */
#define SEARCHES    1000 /* of a plane between two hulls */
#define MOST        32
#define MANY        10 /* bodies, of which only each fourth frame is looked at for overlaps */

static struct fixture f;
static struct placed_hulls placed[MOST + 1];

/* What was seen in all frames of a run. */
struct seen {
    double overlap_m, energy_jpkg, late_m, under_m, longest_s, sum_s;
    uint32_t begins, ends, frames;
};

/* --- the oracle --------------------------------------------------------------------------------*/

static double reach(const struct convex *hull, struct vec3 direction, struct vec3 *most)
{
    double far = -INFINITY;
    *most = hull->vertex[0];
    for (uint32_t i = 0; i < hull->count; i++) {
        double along = vec3_dot(hull->vertex[i], direction);
        if (along > far)
            far = along, *most = hull->vertex[i];
    }
    return far;
}

static double apart_along(const struct convex *a, const struct convex *b, struct vec3 d)
{
    struct vec3 p;
    return -reach(b, vec3_scale(d, -1.0), &p) - reach(a, d, &p);
}

/* Turns the direction by random angles, smaller and smaller, where that separates the hulls more.
 */
static double climb(const struct convex *a, const struct convex *b, struct vec3 d, double best)
{
    uint64_t random = 7;
    double angle = 0.5;
    for (int n = 0; n < SEARCHES && best < -0.5 * OVERLAP_M; n++) {
        struct vec3 to = vec3_add(d, vec3_scale(fixture_direction(&random), angle));
        to = vec3_scale(to, 1.0 / vec3_length(to));
        double apart = apart_along(a, b, to);
        if (apart > best)
            best = apart, d = to, angle = maths_min(0.5, 1.5 * angle);
        else
            angle = maths_max(1e-5, 0.97 * angle);
    }
    return best;
}

/* Returns the greatest separation found along a direction, below 0 for an overlap. Where the
 * product claims a plane between the hulls, that is checked. */
static double separation(const struct convex *a, const struct convex *b)
{
    struct vec3 along = gjk_distance(a, b).normal;
    if (!(vec3_dot(along, along) > 0.0))
        along = (struct vec3){0.0, 1.0, 0.0};
    return climb(a, b, along, apart_along(a, b, along));
}

static double depth_of(const struct placed_hulls *a, const struct placed_hulls *b)
{
    double deepest = 0.0;
    for (uint32_t i = 0; i < a->hulls; i++) {
        for (uint32_t j = 0; j < b->hulls; j++) {
            deepest = maths_max(deepest, -separation(&a->hull[i], &b->hull[j]));
        }
    }
    return deepest;
}

static const struct vec3 middle = {25000.0, FIXTURE_GROUND_M, 25000.0};

/* Returns the deepest overlap of the first rows with each other and with the first object. */
static double deepest(uint32_t count)
{
    const struct body_motion *motion = &f.stepper.collider.motion;
    struct entities e = steps_rows(&f);
    uint32_t objects = f.view.world.counts.fixed;
    double deep = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct swept_body body = body_motion_standing(motion, &e, i);
        placed_hulls_put(&body, 0.0, middle, &placed[i]);
    }
    for (uint32_t i = 0; i < objects && i < 1; i++) {
        struct swept_body body = body_motion_fixed(&f.view.world, i);
        placed_hulls_put(&body, 0.0, middle, &placed[count++]);
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < i; j++)
            deep = maths_max(deep, depth_of(&placed[i], &placed[j]));
    }
    return deep;
}

static double energy_of(uint32_t count, double *mass_kg)
{
    struct entities e = steps_rows(&f);
    double sum = 0.0;
    *mass_kg = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct mass_properties mass = mass_properties_of(&f.view.world.kinds[e.row[i].kind]);
        struct mat3 turn =
            rotation_matrix(rotation_of(e.row[i].heading, e.row[i].pitch, e.row[i].roll));
        struct vec3 arm = rotation_apply(&turn, (struct vec3){0.0, mass.centre_m, 0.0});
        struct vec3 spin = {e.row[i].spin_x, e.row[i].spin_y, e.row[i].spin_z},
                    w = rotation_back(&turn, spin);
        struct vec3 v = vec3_add(entities_velocity(&e, i), vec3_cross(spin, arm));
        double high = e.row[i].y + arm.y - FIXTURE_GROUND_M;
        sum += mass.mass_kg * (0.5 * vec3_dot(v, v) + GRAVITY_MPS2 * high) +
               0.5 * (mass.moment.x * w.x * w.x + mass.moment.y * w.y * w.y +
                      mass.moment.z * w.z * w.z);
        *mass_kg += mass.mass_kg;
    }
    return sum;
}

/* Returns how deep the lowest point of a row is under the ground [m]. */
static double under_ground(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct body_points points;
    body_points_of(&f.view.world, e.row[row].kind, &points);
    return -body_points_clearance(
        &f.view.world, NULL, &points, entities_position(&e, row),
        rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
}

/* --- runs --------------------------------------------------------------------------------------*/

static uint32_t put_wreck(const char *kind, struct vec3 off, double heading, double pitch,
                          double roll)
{
    uint32_t row = fixture_put(
        &f,
        (struct fixture_entity){.kind = kind, .at = vec3_add(middle, off), .heading_rad = heading});
    struct entities e = steps_rows(&f);
    e.row[row].state = ENTITY_WRECK;
    e.row[row].damage = DAMAGE_HIGH;
    e.row[row].pitch = pitch, e.row[row].roll = roll;
    return row;
}

static void begins_and_ends(struct seen *seen)
{
    seen->begins = seen->ends = 0;
    for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++)
        seen->begins += fixture_event(&f, EVENT_COLLISION, n)->collision.begins;
    seen->ends = fixture_event_count(&f, EVENT_CONTACT_END);
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Returns where a row is. What lies on the first row goes with it, if that is a vehicle. */
static struct vec3 place_of(const struct entities *e, uint32_t row)
{
    struct vec3 at = entities_position(e, row);
    return e->row[0].state == ENTITY_ACTIVE ? vec3_sub(at, entities_position(e, 0)) : at;
}

/* Runs so many seconds and looks at all frames. push_jpkg: what an engine can do in a frame. */
static struct seen run(uint32_t count, double seconds, double push_jpkg)
{
    struct seen seen = {0};
    double hz = 1.0 / f.view.world.params->dt_s, mass, before = energy_of(count, &mass);
    struct vec3 late[MOST];
    for (uint32_t frame = 0; frame < (uint32_t)(seconds * hz); frame++) {
        double began = now_s(), after;
        if (frame == 0)
            fixture_run(&f, 1);
        else
            fixture_continue(&f, 1);
        double took = now_s() - began;
        seen.longest_s = maths_max(seen.longest_s, took);
        seen.sum_s += took;
        seen.frames++;
        if (count < MANY || frame % 4 == 0)
            seen.overlap_m = maths_max(seen.overlap_m, deepest(count));
        after = energy_of(count, &mass);
        seen.energy_jpkg = maths_max(seen.energy_jpkg, (after - before) / mass - push_jpkg);
        before = after;
        struct entities e = steps_rows(&f);
        for (uint32_t i = 0; i < count; i++) {
            struct vec3 at = place_of(&e, i);
            if (frame <= (uint32_t)((seconds - 1.0) * hz))
                late[i] = at;
            else
                seen.late_m = maths_max(seen.late_m, vec3_length(vec3_sub(at, late[i])));
            if (e.row[i].state == ENTITY_WRECK)
                seen.under_m = maths_max(seen.under_m, under_ground(i));
        }
    }
    begins_and_ends(&seen);
    return seen;
}

static void tell(const char *what, double hz, const struct seen *seen)
{
    print_message("%s at %g Hz: overlap %.3f mm, under ground %.1f mm, energy %.1e J/kg, last "
                  "second %.2f mm, begins %u, ends %u, frame %.2f ms, at most %.1f ms\n",
                  what, hz, 1e3 * seen->overlap_m, 1e3 * seen->under_m, seen->energy_jpkg,
                  1e3 * seen->late_m, seen->begins, seen->ends,
                  1e3 * seen->sum_s / maths_max(1.0, seen->frames), 1e3 * seen->longest_s);
}

static void check(const struct seen *seen, double energy_jpkg, double still_m)
{
    assert_true(seen->overlap_m <= OVERLAP_M);
    assert_true(seen->energy_jpkg <= energy_jpkg);
    assert_true(seen->late_m <= still_m);
}

static void open_world(double hz, const char *more)
{
    char text[512];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 256; };\n%s"
             "collision = { shape = \"model\"; };\n",
             hz, more);
    fixture_open(&f, text);
    steps_kind(&f, "tank")->resistance_j = steps_kind(&f, "jeep")->resistance_j = 1e12;
    steps_kind(&f, "truck")->resistance_j = 1e12;
}

static const double rates_hz[] = {60.0, 30.0, 10.0, 240.0};
#define RATES (sizeof rates_hz / sizeof *rates_hz)

static void test_a_wreck_falls_on_a_tank(void **state)
{
    uint64_t random = fixture_seed(41);
    (void)state;
    for (uint32_t n = 0; n < RATES; n++) {
        open_world(rates_hz[n], "");
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = middle});
        put_wreck("jeep", (struct vec3){0.2, 4.5, 0.3}, fixture_uniform(&random, 0.0, TWO_PI), 0.1,
                  0.1);
        struct seen seen = run(2, 12.0, 0.0);
        tell("jeep on tank", rates_hz[n], &seen);
        fixture_close(&f);
        check(&seen, ENERGY_JPKG, CREEPS_M);
    }
}

static void test_a_tank_drives_off_under_a_wreck(void **state)
{
    uint64_t random = fixture_seed(45);
    (void)state;
    for (uint32_t n = 0; n < RATES; n++) {
        open_world(rates_hz[n], "");
        uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = middle});
        put_wreck("jeep", (struct vec3){0.2, 4.5, 0.3}, fixture_uniform(&random, 0.0, TWO_PI), 0.1,
                  0.1);
        struct seen seen = run(2, 4.0, 0.0);
        assert_true(seen.overlap_m <= OVERLAP_M);
        steps_drive(&f, tank, 0.6, 1.0, 0.0);
        seen = run(2, 12.0, 1e3);
        tell("tank drives off under a jeep", rates_hz[n], &seen);
        fixture_close(&f);
        assert_true(seen.overlap_m <= OVERLAP_M);
    }
}

static void test_a_wreck_falls_on_a_wreck(void **state)
{
    uint64_t random = fixture_seed(42);
    (void)state;
    for (uint32_t n = 0; n < RATES; n++) {
        open_world(rates_hz[n], "");
        put_wreck("tank", (struct vec3){0.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
        put_wreck("tank", (struct vec3){1.0, 4.0, 0.5}, fixture_uniform(&random, 0.0, TWO_PI), 0.2,
                  0.3);
        struct seen seen = run(2, 12.0, 0.0);
        tell("tank on tank's wreck", rates_hz[n], &seen);
        fixture_close(&f);
        check(&seen, ENERGY_JPKG, STILL_M);
    }
}

static void test_a_wreck_falls_on_a_house(void **state)
{
    uint64_t random = fixture_seed(43);
    (void)state;
    for (uint32_t n = 0; n < RATES; n++) {
        open_world(rates_hz[n], "objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; } );");
        steps_kind(&f, "building")->resistance_j = 1e12;
        put_wreck("jeep", (struct vec3){fixture_uniform(&random, -6.0, 6.0), 14.0, 3.0},
                  fixture_uniform(&random, 0.0, TWO_PI), 0.2, 0.3);
        struct seen seen = run(1, 15.0, 0.0);
        tell("jeep on house", rates_hz[n], &seen);
        fixture_close(&f);
        check(&seen, ENERGY_JPKG, STILL_M);
    }
}

static void test_a_tank_pushes_a_wreck(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < RATES; n++) {
        open_world(rates_hz[n], "");
        uint32_t tank = fixture_put(
            &f, (struct fixture_entity){.kind = "tank", .at = middle, .heading_rad = 0.0});
        uint32_t row = put_wreck("truck", (struct vec3){0.5, 0.0, -9.0}, 1.2, 0.0, 0.0);
        fixture_run(&f, 1);
        steps_drive(&f, tank, 0.5, 0.0, 0.0);
        double from = steps_rows(&f).row[row].z;
        struct seen seen = run(2, 10.0, 10.0 / rates_hz[n] * 10.0);
        tell("tank pushes truck's wreck", rates_hz[n], &seen);
        print_message("pushed by %.1f m\n", from - steps_rows(&f).row[row].z);
        assert_true(from - steps_rows(&f).row[row].z > 5.0);
        fixture_close(&f);
        assert_true(seen.overlap_m <= OVERLAP_M);
    }
}

/* The ground slows a wreck in the course of a frame, and a tank pushes it on: its way is not longer
 * than by the greater of its velocities before and after. */
static void test_a_pushed_wreck_goes_no_farther_than_its_velocity(void **state)
{
    static const double slow_hz[] = {5.0, 10.0, 60.0};
    (void)state;
    for (uint32_t n = 0; n < 3; n++) {
        double worst = 0.0, dt_s = 1.0 / slow_hz[n];
        open_world(slow_hz[n], "");
        uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                                .behaviour = BEHAVIOUR_HOLD,
                                                                .at = middle,
                                                                .velocity = {0.0, 0.0, -3.0}});
        uint32_t row = put_wreck("truck", (struct vec3){0.5, 0.0, -9.0}, 1.2, 0.0, 0.0);
        for (uint32_t frame = 0; frame < (uint32_t)(3.0 * slow_hz[n]); frame++) {
            struct entities e = steps_rows(&f);
            struct vec3 was = entities_position(&e, row), before = entities_velocity(&e, row);
            uint32_t told = fixture_event_count(&f, EVENT_COLLISION);
            e.row[tank].vz = -3.0;
            fixture_run(&f, 1);
            e = steps_rows(&f);
            struct vec3 after = entities_velocity(&e, row);
            double speed = maths_max(vec3_length(before), vec3_length(after));
            double way = vec3_length(vec3_sub(entities_position(&e, row), was));
            if (fixture_event_count(&f, EVENT_COLLISION) == told)
                worst = maths_max(worst, way - speed * dt_s);
        }
        print_message("# figures: %g Hz: a pushed wreck went %.2f mm beyond its velocity\n",
                      slow_hz[n], 1e3 * worst);
        assert_true(steps_rows(&f).row[row].z < middle.z - 10.0);
        fixture_close(&f);
        assert_true(worst <= JUMP_M);
    }
}

/* A jeep on its springs that lies on its side against a tank's wreck, with its lower wheels in the
 * ground as its springs let them: the ground does not lift it by its hulls. */
static void test_the_ground_lifts_no_sprung_vehicle_by_its_hulls(void **state)
{
    uint32_t touched = 0;
    double worst = 0.0;
    (void)state;
    for (uint32_t n = 0; n < 24; n++) {
        double lean = 0.8 + 0.04 * (n % 4), away = 2.4 + 0.2 * (n / 4);
        open_world(60.0, "");
        put_wreck("tank", (struct vec3){0.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
        uint32_t jeep = fixture_put(
            &f, (struct fixture_entity){.kind = "jeep",
                                        .behaviour = BEHAVIOUR_IDLE,
                                        .at = vec3_add(middle, (struct vec3){away, 0.0, 0.0})});
        struct entities e = steps_rows(&f);
        e.row[jeep].flags |= ENTITY_FLAG_CHASSIS;
        e.row[jeep].roll = -lean;
        e.row[jeep].y += 0.8 * maths_sin(lean) - 0.15;
        e.row[jeep].vx = -0.5;
        for (uint32_t frame = 0; frame < 20; frame++) {
            e = steps_rows(&f);
            struct vec3 was = entities_position(&e, jeep), before = entities_velocity(&e, jeep);
            uint32_t told = fixture_event_count(&f, EVENT_COLLISION);
            fixture_continue(&f, 1);
            e = steps_rows(&f);
            struct vec3 after = entities_velocity(&e, jeep);
            double speed = maths_max(vec3_length(before), vec3_length(after));
            double way = vec3_length(vec3_sub(entities_position(&e, jeep), was));
            touched += fixture_state(&f).head->contact_count > 0;
            if (fixture_event_count(&f, EVENT_COLLISION) == told)
                worst = maths_max(worst, way - speed / 60.0);
        }
        fixture_close(&f);
    }
    print_message(
        "# figures: a leaning jeep went %.2f mm beyond its velocity, %u frames in contact\n",
        1e3 * worst, touched);
    assert_true(touched > 200);
    assert_true(worst <= JUMP_M);
}

static struct vec3 centre_velocity(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct mass_properties mass = mass_properties_of(&f.view.world.kinds[e.row[row].kind]);
    struct mat3 axes =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    struct vec3 arm = rotation_apply(&axes, (struct vec3){0.0, mass.centre_m, 0.0});
    struct vec3 spin = {e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z};
    return vec3_add(entities_velocity(&e, row), vec3_cross(spin, arm));
}

/* A vehicle in the air falls with its whole weight beside a wreck that it does not touch, also if
 * it turns over. It lost half of its weight, because the path of its fall has the mean speed of the
 * frame; and one that turned was pushed towards its roof, because the path of its position is bent.
 */
static void test_a_vehicle_falls_freely_beside_a_wreck(void **state)
{
    (void)state;
    for (double rate_rps = 0.0; rate_rps < 5.0; rate_rps += 4.0) {
        double worst = 0.0;
        uint32_t looks = 0;
        open_world(60.0, "");
        put_wreck("tank", (struct vec3){0.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
        uint32_t jeep = fixture_put(
            &f, (struct fixture_entity){.kind = "jeep",
                                        .behaviour = BEHAVIOUR_IDLE,
                                        .at = vec3_add(middle, (struct vec3){0.0, 0.0, 0.0})});
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        e.row[jeep].flags |= ENTITY_FLAG_CHASSIS;
        e.row[jeep].y += 1.2;
        for (double away = 0.0; steps_gap(&f, &e, 0, jeep) < 0.005; away += 0.002)
            e.row[jeep].x = middle.x + away; /* as near as contacts are */
        e.row[jeep].spin_x = rate_rps;       /* its nose goes along the side of the wreck */
        for (uint32_t frame = 0; frame < 14; frame++) {
            struct vec3 before = centre_velocity(jeep);
            fixture_run(&f, 1);
            struct vec3 push = vec3_scale(vec3_sub(centre_velocity(jeep), before), 60.0);
            push.y += GRAVITY_MPS2;
            worst = maths_max(worst, vec3_length(push));
            looks++;
        }
        print_message("# figures: beside a wreck a vehicle in the air that turned by %.0f rad/s "
                      "fell %.3f m/s2 off its weight\n",
                      rate_rps, worst);
        assert_true(looks == 14 && worst < 0.5);
        fixture_close(&f);
    }
}

static void test_a_heap_of_wrecks(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    for (uint32_t n = 0; n < 1; n++) {
        open_world(rates_hz[n], "");
        for (uint32_t i = 0; i < 20; i++)
            put_wreck(i % 3 == 0 ? "tank" : "jeep",
                      (struct vec3){fixture_uniform(&random, -3.0, 3.0), 5.0 + 7.0 * i,
                                    fixture_uniform(&random, -3.0, 3.0)},
                      fixture_uniform(&random, 0.0, TWO_PI), fixture_uniform(&random, -1.0, 1.0),
                      fixture_uniform(&random, -3.0, 3.0));
        struct seen seen = run(20, 40.0, 0.0);
        tell("20 wrecks in a heap", rates_hz[n], &seen);
        fixture_close(&f);
        check(&seen, HEAP_JPKG, CREEPS_M);
        assert_true(seen.under_m <= UNDER_M);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_wreck_falls_on_a_tank),
        cmocka_unit_test(test_a_tank_drives_off_under_a_wreck),
        cmocka_unit_test(test_a_wreck_falls_on_a_wreck),
        cmocka_unit_test(test_a_wreck_falls_on_a_house),
        cmocka_unit_test(test_a_tank_pushes_a_wreck),
        cmocka_unit_test(test_a_pushed_wreck_goes_no_farther_than_its_velocity),
        cmocka_unit_test(test_the_ground_lifts_no_sprung_vehicle_by_its_hulls),
        cmocka_unit_test(test_a_vehicle_falls_freely_beside_a_wreck),
        cmocka_unit_test(test_a_heap_of_wrecks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
