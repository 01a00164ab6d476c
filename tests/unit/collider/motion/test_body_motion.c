/* Paths and rotations of a frame's rows. */
#include "collider/motion/body_motion.h"

#include "collider/motion/pair_filter.h"

#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/entity/mass_properties.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS 600 /* more turnings than the first room for them, and the second */

static struct fixture f;
static struct state *next;
static struct body_motion *motion;

static int open_with(const char *text)
{
    fixture_open(&f, text);
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(
            &f, (struct fixture_entity){.kind = "jet", .at = {1000.0 + 20.0 * i, 900.0, 5000.0}});
    motion = &f.stepper.collider.motion;
    return 0;
}

static int open_world(void **state)
{
    (void)state;
    return open_with("world = { seed = 1; capacity = 1024; };");
}

static int open_models(void **state)
{
    (void)state;
    return open_with("world = { seed = 1; capacity = 1024; }; collision = { shape = \"model\"; };");
}

/* The next frame: row 0 has moved 6 m east and turned a tenth to the right, and the last row has a
 * new entity. */
static void begin(void)
{
    struct response_context context;
    next = &f.view.w[1];
    steps_respond(&f, &context);
    steps_respond_end(&context);
    next->entities.row[0].x += 6.0;
    next->entities.row[0].heading += 0.1;
    next->entities.row[ROWS - 1].x += 100.0;
    next->entities.row[ROWS - 1].id++;
    body_motion_begin(motion, &f.view.w[0], next, NULL);
    for (uint32_t i = 0; i < ROWS; i++)
        body_motion_compute(motion, i);
}

static double heading_of(struct quat turned)
{
    double heading, pitch, roll;
    rotation_angles(turned, &heading, &pitch, &roll);
    return heading;
}

static void test_a_row_goes_from_the_committed_pose_to_the_moved_one(void **state)
{
    (void)state;
    begin();
    assert_true(body_motion_old(motion, 0));
    assert_true(fabs(path_at(&motion->path[0], 0.5).x - 1003.0) < 1e-9);
    assert_true(motion->path[0].since == 0.0);
    assert_true(fabs(heading_of(body_motion_orientation(motion, 0, 0.0))) < 1e-12);
    assert_true(fabs(heading_of(body_motion_orientation(motion, 0, 0.5)) - 0.05) < 1e-9);
    assert_true(fabs(heading_of(body_motion_orientation(motion, 0, 1.0)) - 0.1) < 1e-12);
}

static void test_who_is_new_has_not_moved(void **state)
{
    (void)state;
    begin();
    assert_false(body_motion_old(motion, ROWS - 1));
    assert_true(pair_filter_rests(&motion->path[ROWS - 1]));
    assert_true(motion->path[ROWS - 1].at.x == next->entities.row[ROWS - 1].x);
}

static bool same_turn(struct quat p, struct quat q)
{
    return p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z;
}

/* What is kept is right only for the angles of which it was computed. */
static void test_a_pose_that_is_kept_follows_its_angles(void **state)
{
    (void)state;
    begin();
    struct rotation_path unknown = body_motion_rotation(motion, 0);
    body_motion_note_poses(motion, 0);
    struct rotation_path known = body_motion_rotation(motion, 0);
    assert_true(same_turn(known.from, unknown.from) && same_turn(known.to, unknown.to));
    next->entities.row[0].heading += 0.2;
    next->entities.row[0].roll -= 0.1;
    struct quat turned = rotation_of(next->entities.row[0].heading, next->entities.row[0].pitch,
                                     next->entities.row[0].roll);
    assert_true(same_turn(body_motion_rotation(motion, 0).to, turned));
    assert_true(same_turn(body_motion_standing(motion, &next->entities, 0).to, turned));
    assert_true(same_turn(body_motion_rotation(motion, 0).from, unknown.from));
}

static void test_changed_rotations_are_kept_for_the_frame_only(void **state)
{
    (void)state;
    begin();
    for (uint32_t i = 0; i < ROWS; i++) {
        struct path path = {.at = {i, 0.0, 0.0}, .along = {8.0, 0.0, 0.0}, .since = 0.5};
        struct rotation_path rotation = {.from = rotation_of(0.0, 0.0, 0.0),
                                         .to = rotation_of(1e-3 * i, 0.0, 0.0)};
        body_motion_change(motion, i, &path, &rotation);
        body_motion_change(motion, i, &path, &rotation); /* takes no more room */
    }
    assert_int_equal(motion->changes, ROWS);
    for (uint32_t i = 0; i < ROWS; i++) {
        assert_true(fabs(heading_of(body_motion_orientation(motion, i, 0.75)) - 5e-4 * i) < 1e-9);
        assert_true(path_at(&motion->path[i], 1.0).x == i + 4.0);
    }
    begin();
    assert_int_equal(motion->changes, 0);
    assert_true(fabs(heading_of(body_motion_rotation(motion, 0).to) - 0.1) < 1e-12);
    assert_true(fabs(maths_wrap_half(heading_of(body_motion_rotation(motion, 7).to))) < 1e-12);
}

/* At the frame's very end there is no time left to turn in. */
static void test_a_path_that_begins_at_the_end_has_its_last_rotation(void **state)
{
    (void)state;
    begin();
    struct path path = {.since = 1.0};
    struct rotation_path rotation = {.from = rotation_of(0.3, 0.0, 0.0),
                                     .to = rotation_of(0.4, 0.0, 0.0)};
    body_motion_change(motion, 3, &path, &rotation);
    assert_true(fabs(heading_of(body_motion_orientation(motion, 3, 1.0)) - 0.4) < 1e-12);
}

static void set_spin(uint32_t row, struct vec3 spin)
{
    struct entities *w = &f.view.w[0].entities;
    w->row[row].spin_x = spin.x;
    w->row[row].spin_y = spin.y;
    w->row[row].spin_z = spin.z;
}

static void set_pose(const struct entities *e, uint32_t row, struct quat turned)
{
    rotation_angles(turned, &e->row[row].heading, &e->row[row].pitch, &e->row[row].roll);
}

/* An aircraft that the mover turned by its spin takes its real path, however often it turns. */
static void test_who_spins_freely_takes_its_real_path(void **state)
{
    (void)state;
    const struct vec3 spins[] = {{3.0, -2.0, 4.0}, {300.0, 200.0, -400.0}};
    double dt_s = world_dt_s(&f.view.world);
    struct vec3 moment = mass_properties_of(steps_kind(&f, "jet")).moment;
    for (int n = 0; n < 2; n++) {
        begin();
        struct quat from = rotation_of(next->entities.row[5].heading, 0.0, 0.0), to = from;
        struct vec3 spin = spins[n];
        set_spin(5, spins[n]);
        free_rotation_turn(moment, &to, &spin, dt_s);
        set_pose(&next->entities, 5, to);
        struct free_rotation freely = free_rotation_of(moment, from, spins[n], dt_s);
        for (double time = 0.0; time <= 1.0; time += 0.125) {
            struct mat3 there = rotation_matrix(free_rotation_at(&freely, time));
            struct mat3 path = rotation_matrix(body_motion_orientation(motion, 5, time));
            for (int i = 0; i < 9; i++)
                assert_true(fabs(there.m[i / 3][i % 3] - path.m[i / 3][i % 3]) < 1e-12);
        }
        struct rotation_path rest = body_motion_rotation_from(motion, 5, 0.25);
        assert_true(rest.turn.rotation.steps > 0);
        assert_true(fabs(rest.turn.rotation.duration_s - 0.75 * dt_s) < 1e-15);
        set_spin(5, (struct vec3){0.0, 0.0, 0.0});
    }
}

/* A body on the ground that its spin turns by more than a quarter turn. */
static void test_a_yaw_of_one_and_a_half_turns_is_swept(void **state)
{
    (void)state;
    double dt_s = world_dt_s(&f.view.world);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000, 100, 9000}});
    begin();
    double heading = next->entities.row[row].heading;
    set_spin(row, (struct vec3){0.0, -1.5 * TWO_PI / dt_s, 0.0});
    next->entities.row[row].heading = maths_wrap_turn(heading + 0.01 + 1.5 * TWO_PI);
    double seen = heading_of(body_motion_orientation(motion, row, 1.0 / 3.0));
    assert_true(fabs(maths_wrap_half(seen - heading - PI)) < 0.01);
    seen = heading_of(body_motion_orientation(motion, row, 1.0));
    assert_true(fabs(maths_wrap_half(seen - next->entities.row[row].heading)) < 1e-9);
    set_spin(row, (struct vec3){0.0, 0.0, 0.0});
}

static void test_bodies_have_their_kinds_hulls_at_their_size(void **state)
{
    (void)state;
    begin();
    const struct kind *kind = steps_kind(&f, "jet");
    struct free_turn turn;
    struct swept_body body = body_motion_body(motion, 0, &turn);
    assert_null(body.turn);
    assert_int_equal(body.hull_count, kind->hull_count);
    assert_ptr_equal(body.hull, f.view.world.hulls + kind->first_hull);
    assert_true(body.scale == 1.0 && body.bound_m == kind->bound_m);
    assert_true(body.path.along.x == 6.0);
    fixture_close(&f);
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 25100.0]; } );");
    struct fixed_object tree = f.view.world.fixed[0];
    kind = &f.view.world.kinds[tree.kind];
    body = body_motion_fixed(&f.view.world, 0);
    assert_true(fabs(body.scale - (double)tree.radius_m / kind->radius_m) < 1e-12);
    assert_true(fabs(body.bound_m - body.scale * kind->bound_m) < 1e-12);
    assert_true(body.path.at.x == 25000.0 && body.path.at.z == 25100.0);
    assert_true(fabs(maths_wrap_half(heading_of(body.to) - fixed_heading(&tree))) < 1e-9);
}

/* What turns where it stands sweeps what is beside it: it does not rest. */
static void test_a_stretch_in_place_rests_only_if_it_does_not_turn(void **state)
{
    (void)state;
    begin();
    motion->models = true; /* a sphere that turns stays where it is */
    for (uint32_t row = 1; row < 3; row++) {
        next->entities.row[row].cruise_tick = (uint32_t)next->head->tick + 20;
        next->entities.row[row].cruise_rps = row == 1 ? 0.1 : 0.0;
        next->entities.row[row].heading += row == 1 ? 0.03 : 0.0;
        entities_set_velocity(&next->entities, row, (struct vec3){0.0, 0.0, 0.0});
    }
    struct path turns = body_motion_stretch(motion, 1), stands = body_motion_stretch(motion, 2);
    assert_false(pair_filter_rests(&turns));
    assert_true(pair_filter_rests(&stands));
}

static void random_stretch(uint64_t *seed, uint32_t row, double turn_rad, double gain_mps)
{
    struct entities *e = &next->entities;
    double heading = fixture_uniform(seed, 0.0, TWO_PI), sine, cosine;
    double rest_mps =
        fixture_uniform(seed, 0.0, 1.0) < 0.3 ? 0.0 : fixture_uniform(seed, 0.0, 60.0);
    double gain = fixture_uniform(seed, -gain_mps, gain_mps);
    double mps = maths_max(rest_mps + maths_max(gain, 0.0), 0.0);
    maths_sincos(heading, &sine, &cosine);
    e->row[row].heading = heading;
    e->row[row].cruise_rps = fixture_uniform(seed, -turn_rad, turn_rad) / 0.5;
    e->row[row].cruise_mps2 = gain / 0.5;
    e->row[row].cruise_climb_mps2 = (float)fixture_uniform(seed, -6.0, 6.0);
    entities_set_velocity(
        e, row, (struct vec3){mps * sine, fixture_uniform(seed, -5.0, 5.0), -mps * cosine});
}

static bool holds(const struct path *outer, const struct path *inner)
{
    struct vec3 low = inner->at, high = path_at(inner, 1.0), end = path_at(outer, 1.0);
    const double slack = 1e-9;
    return outer->at.x <= low.x + slack && outer->at.y <= low.y + slack &&
           outer->at.z <= low.z + slack && high.x <= end.x + slack && high.y <= end.y + slack &&
           high.z <= end.z + slack;
}

/* Whoever begins to look at a stretch on its way sees no more around it than who has seen it begin:
 * what is around the rest of it holds all its places, and is within what was around it before. */
static void test_what_is_around_a_stretch_only_shrinks(void **state)
{
    uint64_t seed = fixture_seed(1991);
    (void)state;
    begin();
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){.kind = "helicopter", .at = {25000.0, 500.0, 26000.0}});
    begin();
    const uint32_t frames = (uint32_t)(CRUISE_S / world_dt_s(&f.view.world) + 0.5);
    for (int n = 0; n < 2000; n++) {
        struct path before = {0};
        random_stretch(&seed, row, n % 2 ? 0.6 : 0.3, n % 2 ? 1.5 : 3.0);
        for (uint32_t left = frames; left > 0; left--) {
            next->entities.row[row].cruise_tick = (uint32_t)next->head->tick - 1 + left;
            struct path around = body_motion_stretch(motion, row);
            struct body_line line = body_motion_line(motion, row);
            struct path at = {.at = line.from};
            assert_true(holds(&around, &at));
            if (left < frames) {
                assert_true(holds(&before, &around));
            }
            before = around;
        }
    }
}

/* Returns the distance on the map from a point to a line. */
static double distance_from(struct vec3 point, const struct body_line *line)
{
    double dx = line->to.x - line->from.x, dz = line->to.z - line->from.z;
    double x = point.x - line->from.x, z = point.z - line->from.z;
    double share = maths_nearest_share(x, z, dx, dz);
    return hypot(x - share * dx, z - share * dz);
}

/* Returns how far the corner of a row's body that is furthest off a line is off it. */
static double corner_off(uint32_t row, struct vec3 at, struct quat turn,
                         const struct body_line *line)
{
    const struct world *world = &f.view.world;
    const struct hull *hull = &world->hulls[world->kinds[next->entities.row[row].kind].outer_hull];
    const struct mat3 matrix = rotation_matrix(turn);
    double off_m = 0.0;
    for (uint32_t v = 0; v < hull->vertex_count; v++) {
        struct vec3 corner = rotation_apply(&matrix, world->hull_vertices[hull->first_vertex + v]);
        off_m = maths_max(off_m, distance_from(vec3_add(at, corner), line));
    }
    return off_m;
}

static double reach_of(uint32_t row)
{
    return f.view.world.kinds[next->entities.row[row].kind].reach_m + 0.01;
}

static void check_shrinks(uint32_t row, uint64_t *seed, uint32_t frames)
{
    struct body_line before = {0};
    const double dt_s = world_dt_s(&f.view.world), reach_m = reach_of(row);
    for (uint32_t left = frames; left > 0; left--) {
        next->entities.row[row].cruise_tick = (uint32_t)next->head->tick - 1 + left;
        uint64_t end = next->entities.row[row].cruise_tick;
        struct body_line line = body_motion_line_around(motion, row, end, reach_m);
        struct body_line half = body_motion_line_around(motion, row, end - left / 2, reach_m);
        struct vec3 at = cruise_position(&next->entities, row, end - left, dt_s);
        double heading = cruise_heading(&next->entities, row, end - left, dt_s);
        double lean = fixture_uniform(seed, -1.0, 1.0);
        if (left % 10 == 0) {
            assert_true(corner_off(row, at, rotation_of(heading, lean, -lean), &half) <=
                        half.around_m);
        }
        if (left < frames) {
            assert_true(distance_from(line.from, &before) + line.around_m <=
                        before.around_m + 0.01);
            assert_true(distance_from(line.to, &before) + line.around_m <= before.around_m + 0.01);
        }
        before = line;
    }
}

/* The corners of a vehicle are near its line, wherever it is on it and however it leans, also if it
 * goes backwards. What is around the rest of the line is within what was around it before, to the
 * centimetre by which lines are wider. */
static void test_what_is_around_a_vehicle_only_shrinks(void **state)
{
    const char *const kinds[] = {"tank", "truck", "ship", "jet"};
    uint64_t seed = fixture_seed(1992);
    (void)state;
    begin();
    for (uint32_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        uint32_t row = fixture_put(
            &f, (struct fixture_entity){.kind = kinds[k], .at = {25000.0, 100.0, 26000.0}});
        begin();
        const struct body_axis *axis = &motion->axis[next->entities.row[row].kind];
        assert_true(axis->beside_m < reach_of(row));
        assert_true(maths_max(axis->ahead_m, axis->behind_m) + axis->beside_m <
                    1.6 * reach_of(row));
        for (int n = 0; n < 600; n++) {
            const double long_s = n % 2 ? CRUISE_S : CRUISE_LONG_S, sign = n % 3 ? 1.0 : -1.0;
            random_stretch(&seed, row, 0.6, 1.5);
            next->entities.row[row].cruise_rps *= CRUISE_S / long_s;
            next->entities.row[row].cruise_mps2 *= sign * CRUISE_S / long_s;
            next->entities.row[row].vx *= sign;
            next->entities.row[row].vz *= sign;
            check_shrinks(row, &seed, (uint32_t)(long_s / world_dt_s(&f.view.world) + 0.5));
        }
    }
}

struct stance {
    struct vec3 at;
    double heading, pitch, roll;
};

static void put_stance(const struct entities *e, uint32_t row, struct stance stance)
{
    entities_set_position(e, row, stance.at);
    e->row[row].heading = stance.heading;
    e->row[row].pitch = stance.pitch;
    e->row[row].roll = stance.roll;
}

/* Returns a pose that a vehicle may have a frame later: it drives ahead or backwards, slides, turns
 * and leans. */
static struct stance later_stance(uint64_t *seed, struct stance stance)
{
    double ahead_m = fixture_uniform(seed, -1.0, 2.0), aside_m = fixture_uniform(seed, -0.8, 0.8);
    double sine = sin(stance.heading), cosine = cos(stance.heading);
    stance.at.x += ahead_m * sine + aside_m * cosine;
    stance.at.z += aside_m * sine - ahead_m * cosine;
    stance.heading += fixture_uniform(seed, -0.2, 0.2);
    stance.pitch += fixture_uniform(seed, -0.1, 0.1);
    stance.roll += fixture_uniform(seed, -0.1, 0.1);
    return stance;
}

/* The line of a vehicle that moves by one frame, and that of one that stands where it comes to, are
 * near to all of its corners, and narrow. */
static void test_a_vehicle_is_near_the_line_of_its_frame(void **state)
{
    uint64_t seed = fixture_seed(1993);
    uint32_t narrow = 0;
    (void)state;
    begin();
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 26000.0}});
    begin();
    const double reach_m = reach_of(row);
    for (int n = 0; n < 2000; n++) {
        const struct stance from = {{25000.0, 100.0, 26000.0},
                                    fixture_uniform(&seed, 0.0, TWO_PI),
                                    fixture_uniform(&seed, -0.5, 0.5),
                                    fixture_uniform(&seed, -2.5, 2.5)};
        const struct stance to = later_stance(&seed, from);
        put_stance(&f.view.w[0].entities, row, from);
        put_stance(&next->entities, row, to);
        const struct body_line line = body_motion_frame_line(motion, row, reach_m);
        const struct body_line stands = body_motion_standing_line(motion, row, reach_m);
        const struct quat first = rotation_of(from.heading, from.pitch, from.roll);
        const struct quat last = rotation_of(to.heading, to.pitch, to.roll);
        for (double t = 0.0; t <= 1.0; t += 0.125) {
            const struct vec3 at = vec3_add(from.at, vec3_scale(vec3_sub(to.at, from.at), t));
            assert_true(corner_off(row, at, rotation_between(first, last, t), &line) <=
                        line.around_m);
        }
        assert_true(corner_off(row, to.at, last, &stands) <= stands.around_m);
        assert_true(stands.around_m < 0.6 * reach_m);
        narrow += line.around_m < 0.7 * reach_m;
    }
    assert_in_range(narrow, 1000, 2000);
}

/* What may point anywhere is within all of its reach of its way. */
static void test_what_turns_has_a_wide_line(void **state)
{
    const struct stance level = {{25000.0, 100.0, 26000.0}, 0.3, 0.0, 0.0};
    struct stance turned = level, steep = level;
    (void)state;
    begin();
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 26000.0}});
    begin();
    const struct entities *before = &f.view.w[0].entities;
    const double reach_m = reach_of(row);
    turned.heading += 0.6;
    steep.pitch = 0.8;
    put_stance(before, row, level);
    put_stance(&next->entities, row, level);
    assert_true(body_motion_frame_line(motion, row, reach_m).around_m < reach_m);
    put_stance(&next->entities, row, turned);
    assert_true(body_motion_frame_line(motion, row, reach_m).around_m == reach_m);
    put_stance(before, row, steep);
    put_stance(&next->entities, row, steep);
    assert_true(body_motion_frame_line(motion, row, reach_m).around_m == reach_m);
    put_stance(before, row, level);
    put_stance(&next->entities, row, level);
    before->row[row].spin_y = 40.0;
    assert_true(body_motion_frame_line(motion, row, reach_m).around_m == reach_m);
    before->row[row].spin_y = 0.0;
    next->entities.row[row].turret = 0.1f;
    assert_true(body_motion_frame_line(motion, row, reach_m).around_m == reach_m);
    assert_true(body_motion_standing_line(motion, row, reach_m).around_m == reach_m);
}

/* A vehicle that stands for what is left of its stretch is as wide as one that creeps. */
static void test_a_line_without_length_is_no_wider(void **state)
{
    const double heading = 0.3;
    (void)state;
    begin();
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 26000.0}});
    begin();
    const uint64_t end = next->head->tick + 20;
    const double reach_m = f.view.world.kinds[next->entities.row[row].kind].reach_m + 0.01;
    next->entities.row[row].heading = heading;
    next->entities.row[row].cruise_tick = (uint32_t)end;
    struct body_line stands = body_motion_line_around(motion, row, end, reach_m);
    entities_set_velocity(&next->entities, row,
                          (struct vec3){1e-3 * sin(heading), 0.0, -1e-3 * cos(heading)});
    struct body_line creeps = body_motion_line_around(motion, row, end, reach_m);
    assert_true(stands.around_m <= creeps.around_m && stands.around_m < reach_m);
    assert_true(vec3_length(vec3_sub(stands.to, creeps.to)) < 1e-3);
    assert_true(vec3_length(vec3_sub(stands.from, creeps.from)) < 1e-3);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_row_goes_from_the_committed_pose_to_the_moved_one),
        TEST(test_who_is_new_has_not_moved),
        TEST(test_a_pose_that_is_kept_follows_its_angles),
        TEST(test_changed_rotations_are_kept_for_the_frame_only),
        TEST(test_a_path_that_begins_at_the_end_has_its_last_rotation),
        TEST(test_who_spins_freely_takes_its_real_path),
        TEST(test_a_yaw_of_one_and_a_half_turns_is_swept),
        TEST(test_a_stretch_in_place_rests_only_if_it_does_not_turn),
        TEST(test_what_is_around_a_stretch_only_shrinks),
        cmocka_unit_test_prestate_setup_teardown(test_what_is_around_a_vehicle_only_shrinks,
                                                 open_models, fixture_teardown, &f),
        cmocka_unit_test_prestate_setup_teardown(test_a_vehicle_is_near_the_line_of_its_frame,
                                                 open_models, fixture_teardown, &f),
        cmocka_unit_test_prestate_setup_teardown(test_what_turns_has_a_wide_line, open_models,
                                                 fixture_teardown, &f),
        cmocka_unit_test_prestate_setup_teardown(test_a_line_without_length_is_no_wider,
                                                 open_models, fixture_teardown, &f),
        TEST(test_bodies_have_their_kinds_hulls_at_their_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
