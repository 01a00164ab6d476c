/* Each measure of the physics check, violated by hand by a known amount. */
#include "supervisor/physics/physics_check.h"

#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"
#include "world/entity/hull.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/terrain/crater.h"
#include "world/terrain/fixed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define DT     (1.0 / 60.0)
#define MIDDLE 25000.0

static struct fixture f;
static struct physics_check check;
static struct state now; /* the frame that the test writes by hand */

static void *writable(const void *memory)
{
    return (void *)(uintptr_t)memory;
}

/* Gives a kind one hull: a box 6 m long, 3 m wide, and 2 m high on its position. */
static void make_box(const char *name)
{
    struct kind *kind = steps_kind(&f, name);
    struct hull *hull = writable(&f.view.world.hulls[kind->outer_hull]);
    struct vec3 *corner = writable(&f.view.world.hull_vertices[hull->first_vertex]);
    assert_true(hull->vertex_count >= 8);
    hull->vertex_count = 8;
    for (int i = 0; i < 8; i++)
        corner[i] = (struct vec3){i & 1 ? 3.0 : -3.0, i & 2 ? 2.0 : 0.0, i & 4 ? 1.5 : -1.5};
    hull->centre = (struct vec3){0.0, 1.0, 0.0};
    hull->radius_m = 3.5;
    kind->hull_count = 1;
    kind->first_hull = kind->outer_hull;
    kind->bound_m = kind->reach_m = 3.91;
    kind->part_count = 0;
}

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };\n"
                     "objects = ( { kind = \"building\"; at = [30000.0, 30000.0]; } );");
    make_box("tank");
    make_box("building");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static int empty_world(void **state)
{
    (void)state;
    steps_empty(&f);
    return 0;
}

static int end_check(void **state)
{
    (void)state;
    physics_check_free(&check);
    return 0;
}

/* --- frames by hand ----------------------------------------------------------------------------*/

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

/* The measure's worst value is this, and it is the only one beyond its bound, unless also says. */
static void is_bad(enum measure_kind kind, double value)
{
    judged_bad(&check, &now, kind, value);
}

static void no_other_is_bad(enum measure_kind kind)
{
    judged_no_other_bad(&check, kind);
}

static void is_good(void)
{
    judged_no_other_bad(&check, MEASURE_KINDS);
    assert_true(measures_good(&check.measures));
}

/* --- tests -------------------------------------------------------------------------------------*/

static void test_a_world_at_rest_is_good(void **state)
{
    (void)state;
    put("tank", MIDDLE, 100.0);
    put("tank", MIDDLE + 10.0, 100.0);
    begin();
    next();
    next();
    is_good();
    assert_int_equal(check.frames, 2);
    assert_int_equal(check.bodies, 4);
    assert_int_equal(check.most, 2);
    assert_true(check.measures.of[MEASURE_OF_HEIGHT].taken > 0);
}

static void test_a_moving_world_is_good(void **state)
{
    (void)state;
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .at = {MIDDLE, 100.0, MIDDLE},
                                            .velocity = {10.0, 0.0, 0.0}});
    begin();
    for (int i = 0; i < 60; i++) {
        now.entities.row[0].x += 10.0 * DT;
        next();
    }
    is_good();
    assert_true(check.measures.of[MEASURE_OF_ACCELERATION].taken == 60);
}

static void test_a_tank_in_the_air(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 102.0);
    (void)state;
    begin();
    is_bad(MEASURE_OF_HEIGHT, 2.0);
    no_other_is_bad(MEASURE_OF_HEIGHT);
    assert_int_equal(check.measures.of[MEASURE_OF_HEIGHT].body[0].id, tank + 1);
    assert_true(check.measures.of[MEASURE_OF_HEIGHT].body[0].at.y == 102.0);
    next();
    assert_int_equal(check.measures.of[MEASURE_OF_HEIGHT].beyond, 1); /* it has not moved */
}

/* --- wrecks ------------------------------------------------------------------------------------*/

/* Puts a wreck of a tank whose lowest corner is so high over the level ground, on its right side.
 */
static uint32_t put_wreck(double clearance)
{
    uint32_t tank = put("tank", MIDDLE, 101.5 + clearance);
    steps_rows(&f).row[tank].state = ENTITY_WRECK;
    steps_rows(&f).row[tank].roll = HALF_PI;
    return tank;
}

/* Tells that the wreck rests from this frame on. */
static void rest(uint32_t tank)
{
    now.entities.row[tank].until_tick = (uint32_t)now.head->tick + 1;
    next();
}

static void test_a_wreck_at_rest_on_its_side(void **state)
{
    uint32_t tank = put_wreck(-0.002);
    (void)state;
    begin();
    rest(tank);
    next();
    is_good();
    assert_int_equal(check.measures.of[MEASURE_OF_WRECK_HEIGHT].taken, 1);
    assert_true(fabs(check.measures.of[MEASURE_OF_WRECK_HEIGHT].worst - 0.002) < 1e-9);
}

static void test_a_wreck_at_rest_in_the_air(void **state)
{
    uint32_t tank = put_wreck(0.3);
    (void)state;
    begin();
    rest(tank);
    is_bad(MEASURE_OF_WRECK_HEIGHT, 0.3);
    no_other_is_bad(MEASURE_OF_WRECK_HEIGHT);
    next();
    assert_int_equal(check.measures.of[MEASURE_OF_WRECK_HEIGHT].beyond, 1); /* it has not moved */
}

/* It does not say that it rests, but it does not move. */
static void test_a_wreck_that_hangs_in_the_air(void **state)
{
    (void)state;
    put_wreck(20.0);
    begin();
    next();
    assert_true(check.measures.of[MEASURE_OF_WRECK_HEIGHT].worst > 20.0);
    assert_false(measure_good(&check.measures, MEASURE_OF_WRECK_HEIGHT));
}

/* A neighbour may hold it for a frame. */
static void test_a_wreck_that_is_lifted_out_of_the_ground_may_stand_for_a_frame(void **state)
{
    (void)state;
    put_wreck(-0.3);
    begin();
    next();
    assert_int_equal(check.measures.of[MEASURE_OF_WRECK_HEIGHT].taken, 0);
    next();
    is_bad(MEASURE_OF_WRECK_HEIGHT, 0.3);
}

static void test_a_wreck_that_moves_has_no_clearance(void **state)
{
    uint32_t tank = put_wreck(0.3);
    (void)state;
    steps_rows(&f).row[tank].vx = 6.0;
    begin();
    now.entities.row[tank].x += 6.0 * DT;
    rest(tank);
    now.entities.row[tank].until_tick = 0;
    now.entities.row[tank].x += 6.0 * DT;
    next();
    is_good();
    assert_int_equal(check.measures.of[MEASURE_OF_WRECK_HEIGHT].taken, 0);
}

static void test_a_wreck_under_the_ground(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 98.5);
    (void)state;
    steps_rows(&f).row[tank].state = ENTITY_WRECK;
    steps_rows(&f).row[tank].pitch = 0.1;
    begin();
    is_bad(MEASURE_OF_UNDERGROUND, 1.5 + 3.0 * maths_sin(0.1));
}

/* A vehicle takes the ground's slope in the first frame after it was placed. */
static void test_a_vehicle_is_placed_level(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    steps_rows(&f).row[tank].pitch = 0.7;
    begin();
    is_good();
    now.entities.row[tank].pitch = 0.71;
    next();
    is_bad(MEASURE_OF_UNDERGROUND, 3.0 * maths_sin(0.71));
    no_other_is_bad(MEASURE_OF_UNDERGROUND);
}

/* The depth that it had as a vehicle may stay and shrink, and not grow by half a metre. */
static void test_a_wreck_that_sinks(void **state)
{
    uint32_t tank = put_wreck(-0.7);
    (void)state;
    begin();
    now.entities.row[tank].y += 0.04;
    next();
    is_good();
    now.entities.row[tank].y -= 0.05;
    next();
    is_good();
    now.entities.row[tank].y -= 0.5;
    next();
    is_bad(MEASURE_OF_WRECK_UNDERGROUND, 0.55);
}

/* It has no speed while the ground pushes it out to the side. */
static void test_a_wreck_that_comes_out_slantwise(void **state)
{
    uint32_t tank = put_wreck(-0.7);
    (void)state;
    begin();
    now.entities.row[tank].x += 0.009;
    now.entities.row[tank].y -= 0.001;
    next();
    is_good();
    now.entities.row[tank].x += 0.009;
    now.entities.row[tank].y -= 0.503;
    next();
    is_bad(MEASURE_OF_WRECK_UNDERGROUND, 0.504);
}

/* A blow of the ground explains any change of speed, but no gain of energy. */
static void test_a_wreck_that_bounces(void **state)
{
    uint32_t tank = put_wreck(0.01);
    (void)state;
    steps_rows(&f).row[tank].vy = -4.0;
    begin();
    now.entities.row[tank].vy = 3.9;
    next();
    is_good();
    assert_int_equal(check.measures.of[MEASURE_OF_ACCELERATION].taken, 0);
    now.entities.row[tank].vy = 4.0;
    next();
    is_bad(MEASURE_OF_ENERGY, 0.5 * (4.0 * 4.0 - 3.9 * 3.9) - 1e-9 * 0.5 * (16.0 + 3.9 * 3.9));
    no_other_is_bad(MEASURE_OF_ENERGY);
}

/* Kinetic and potential energy of the centre of mass together, up and down. The centre comes down
 * when the wreck falls on its side, although its position rises. */
static void test_the_energy_of_a_wreck_that_rolls(void **state)
{
    double high = steps_kind(&f, "tank")->centre_height_m, rolled = 0.2;
    uint32_t tank = put("tank", MIDDLE, 130.0);
    double fall = high * (1.0 - maths_cos(rolled)) - 0.01;
    (void)state;
    steps_rows(&f).row[tank].state = ENTITY_WRECK;
    begin();
    now.entities.row[tank].y += 0.01;
    now.entities.row[tank].roll = rolled;
    now.entities.row[tank].vx = sqrt(2.0 * 9.80665 * fall);
    next();
    assert_true(check.measures.of[MEASURE_OF_ENERGY].worst < 1e-9);
    now.entities.row[tank].y += 0.01;
    next();
    assert_true(fabs(check.measures.of[MEASURE_OF_ENERGY].worst - 0.0980665) < 1e-6);
}

/* What lifts a wreck that began in the ground is no gain, as far as it was in the ground. */
static void test_a_wreck_that_is_pushed_out(void **state)
{
    uint32_t tank = put_wreck(-0.04);
    (void)state;
    begin();
    now.entities.row[tank].y += 0.03;
    next();
    is_good();
    now.entities.row[tank].y += 0.015;
    next();
    is_bad(MEASURE_OF_ENERGY, 9.80665 * 0.005);
    no_other_is_bad(MEASURE_OF_ENERGY);
}

/* The engine worked until the impact, which may come at the end of the frame. */
static void test_an_aircraft_that_becomes_a_wreck(void **state)
{
    uint32_t plane = put("wishbone", MIDDLE, 600.0);
    (void)state;
    double faster = 20.0 + 0.9 * steps_kind(&f, "wishbone")->acceleration_mps2 * DT;
    now.entities.row[plane].vx = 20.0;
    begin();
    now.entities.row[plane].x += 20.0 * DT;
    now.entities.row[plane].vx = faster;
    steps_rows(&f).row[plane].state = ENTITY_WRECK;
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_ENERGY));
    now.entities.row[plane].x += faster * DT;
    now.entities.row[plane].vx = faster + 0.1;
    next();
    assert_false(measure_good(&check.measures, MEASURE_OF_ENERGY));
}

static void hit(uint32_t row)
{
    struct event *event = add_event(EVENT_DETONATION);
    event->detonation.struck_party.id = row + 1;
    event->detonation.explosive_kg = 1.0f;
}

/* Between two explosions a body may be faster than before and after them. */
static void test_two_explosions_explain_a_way(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    begin();
    hit(tank);
    hit(tank);
    now.entities.row[tank].z += 0.03;
    next();
    is_good();
    hit(tank);
    now.entities.row[tank].z += 0.03;
    next();
    is_bad(MEASURE_OF_JUMP, 0.03);
}

/* So between two collisions. */
static void test_two_collisions_explain_a_way(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    begin();
    add_event(EVENT_COLLISION)->collision.a.id = tank + 1;
    add_event(EVENT_COLLISION)->collision.b.id = tank + 1;
    now.entities.row[tank].z += 0.03;
    next();
    is_good();
    add_event(EVENT_COLLISION)->collision.a.id = tank + 1;
    now.entities.row[tank].z += 0.03;
    next();
    is_bad(MEASURE_OF_JUMP, 0.03);
}

/* So between two impacts of lasting contacts, which no event tells: one of a contact that lasts,
 * and one of a contact that has begun. */
static void test_two_impacts_of_contacts_explain_a_way(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    struct persistent_contact row = {.a_id = tank + 1, .b_id = PERSISTENT_CONTACT_FIXED | 3u};
    (void)state;
    row.b_row = SLOT_NONE;
    begin();
    now.contacts[0] = row;
    now.head->contact_count = 1;
    next();
    now.contacts[0].impacts = 1;
    now.contacts[1] = row;
    now.contacts[1].b_id++;
    now.contacts[1].impacts = 1;
    now.head->contact_count = 2;
    now.entities.row[tank].z += 0.03;
    next();
    is_good();
    now.contacts[1].impacts = 2;
    now.entities.row[tank].z += 0.03;
    next();
    is_bad(MEASURE_OF_JUMP, 0.03);
}

static void test_a_corner_in_a_crater(void **state)
{
    (void)state;
    put("tank", MIDDLE, 100.0);
    begin();
    is_good();
    now.craters[0] = (struct crater){MIDDLE + 13.0, MIDDLE + 1.5, 10.0f, 10.0f, 1};
    now.head->crater_count = 1;
    next();
    /* The rim of 2 m stands on the front corner, 10 m from the middle of the crater. */
    is_bad(MEASURE_OF_UNDERGROUND, 2.0);
}

static void test_two_boxes_overlap(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("tank", MIDDLE + 6.001, 100.0);
    (void)state;
    begin();
    is_good();
    now.entities.row[b].x -= 0.301;
    now.entities.row[b].vx = -0.301 / DT;
    next();
    is_bad(MEASURE_OF_OVERLAP, 0.3);
    is_bad(MEASURE_OF_OVERLAP_GROWTH, 0.3);
    assert_true(check.measures.of[MEASURE_OF_OVERLAPPING].worst == 1.0);
    assert_int_equal(check.measures.of[MEASURE_OF_OVERLAP].body[0].id, a + 1);
    assert_int_equal(check.measures.of[MEASURE_OF_OVERLAP].body[1].id, b + 1);
    now.entities.row[b].x -= 0.05;
    next();
    is_bad(MEASURE_OF_OVERLAP, 0.35);
    assert_true(fabs(check.measures.of[MEASURE_OF_OVERLAP_GROWTH].worst - 0.3) < 1e-9);
}

static void test_an_overlap_at_the_start_may_stay_but_not_grow(void **state)
{
    uint32_t b;
    (void)state;
    put("tank", MIDDLE, 100.0);
    b = put("tank", MIDDLE + 5.5, 100.0);
    begin();
    assert_true(fabs(check.measures.of[MEASURE_OF_START_OVERLAP].worst - 0.5) < 1e-9);
    next();
    is_good();
    now.entities.row[b].x -= 0.001;
    next();
    is_bad(MEASURE_OF_OVERLAP_GROWTH, 0.001);
    no_other_is_bad(MEASURE_OF_OVERLAP_GROWTH);
}

/* A body between two others that it overlaps is pushed into one by the other. */
static void test_bodies_that_part_push_each_other(void **state)
{
    uint32_t b;
    (void)state;
    put("tank", MIDDLE, 100.0);
    b = put("tank", MIDDLE + 5.5, 100.0);
    put("tank", MIDDLE + 10.9, 100.0);
    begin();
    next();
    now.entities.row[b].x -= 0.05;
    next();
    is_good();
}

static void test_spheres_overlap(void **state)
{
    double radius = steps_kind(&f, "tank")->radius_m;
    uint32_t b;
    (void)state;
    steps_params(&f)->collision.shape = SHAPE_SPHERE;
    put("tank", MIDDLE, 100.0);
    b = put("tank", MIDDLE + 2.0 * radius + 0.01, 100.0);
    begin();
    now.entities.row[b].x -= 0.11;
    next();
    steps_params(&f)->collision.shape = SHAPE_MODEL;
    is_bad(MEASURE_OF_OVERLAP, 0.1);
}

static void test_no_bound_where_the_response_promises_none(void **state)
{
    uint32_t b;
    (void)state;
    steps_params(&f)->collision.response = MODEL_NONE;
    put("tank", MIDDLE, 100.0);
    b = put("tank", MIDDLE + 6.005, 100.0);
    begin();
    now.entities.row[b].x -= 0.009;
    next();
    steps_params(&f)->collision.response = MODEL_IMPULSE;
    assert_true(fabs(check.measures.of[MEASURE_OF_OVERLAP].worst - 0.004) < 1e-9);
    is_good();
}

/* Puts a tank in front of the building, with the same heading and a gap between the boxes. */
static uint32_t put_before_wall(double gap, double *sine, double *cosine)
{
    const struct fixed_object *wall = &f.view.world.fixed[0];
    double scale = (double)wall->radius_m / steps_kind(&f, "building")->radius_m;
    double far = 3.0 * scale + 3.0 + gap;
    maths_sincos(fixed_heading(wall), sine, cosine);
    uint32_t tank =
        fixture_put(&f, (struct fixture_entity){
                            .kind = "tank",
                            .at = {wall->x + far * *sine, (double)wall->y, wall->z - far * *cosine},
                            .heading_rad = fixed_heading(wall)});
    return tank;
}

static void test_a_wall(void **state)
{
    double sine, cosine;
    uint32_t tank = put_before_wall(0.005, &sine, &cosine);
    (void)state;
    begin();
    is_good();
    now.entities.row[tank].x -= 0.01 * sine;
    now.entities.row[tank].z += 0.01 * cosine;
    next();
    is_bad(MEASURE_OF_WALL_OVERLAP, 0.005);
    assert_true(check.measures.of[MEASURE_OF_WALL_OVERLAP].body[1].fixed);
    now.fixed_damage[0] = DAMAGE_HIGH; /* it has fallen and is no obstacle */
    now.entities.row[tank].x -= 0.01 * sine;
    now.entities.row[tank].z += 0.01 * cosine;
    next();
    assert_true(fabs(check.measures.of[MEASURE_OF_WALL_OVERLAP].worst - 0.005) < 1e-9);
}

/* What is known of a wall stays while the body rests. */
static void test_a_wall_overlapped_from_the_start(void **state)
{
    double sine, cosine;
    uint32_t tank = put_before_wall(-0.5, &sine, &cosine);
    (void)state;
    begin();
    assert_true(fabs(check.measures.of[MEASURE_OF_START_OVERLAP].worst - 0.5) < 1e-9);
    next();
    next();
    assert_true(check.measures.of[MEASURE_OF_OVERLAPPING].worst == 1.0);
    now.entities.row[tank].x -= 0.001 * sine;
    now.entities.row[tank].z += 0.001 * cosine;
    next();
    is_bad(MEASURE_OF_OVERLAP_GROWTH, 0.001);
    no_other_is_bad(MEASURE_OF_OVERLAP_GROWTH);
}

static void test_speed_from_nowhere(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    double engine = steps_kind(&f, "tank")->acceleration_mps2;
    (void)state;
    begin();
    now.entities.row[tank].vx = 5.0;
    next();
    is_bad(MEASURE_OF_ACCELERATION, 300.0);
    assert_true(fabs(check.measures.of[MEASURE_OF_ENERGY].worst -
                     (12.5 - 0.5 * engine * engine * DT * DT)) < 1e-6);
    assert_false(measure_good(&check.measures, MEASURE_OF_ENERGY));
}

/* The centre of mass of a wreck that turns over falls freely, and its position flies around it. */
static void test_a_wreck_that_turns_over_in_the_air(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 200.0);
    double arm = steps_kind(&f, "tank")->centre_height_m, rate = 12.0;
    double drift = 1.9 * steps_kind(&f, "tank")->max_speed_mps; /* to the south */
    (void)state;
    for (uint32_t frame = 0; frame < 60; frame++) {
        double angle = rate * DT * frame, speed = -GRAVITY_MPS2 * DT * frame;
        const struct entities rows = frame == 0 ? steps_rows(&f) : now.entities, *e = &rows;
        e->row[tank].state = ENTITY_WRECK;
        e->row[tank].roll = angle;
        e->row[tank].spin_x = rate; /* it faces east, so that its right side goes down */
        e->row[tank].y = 200.0 + 0.5 * speed * DT * frame - arm * cos(angle);
        e->row[tank].z = MIDDLE + drift * DT * frame - arm * sin(angle);
        e->row[tank].vy = speed + arm * rate * sin(angle);
        e->row[tank].vz = drift - arm * rate * cos(angle);
        if (frame == 0)
            begin();
        else
            next();
    }
    assert_true(arm * rate * rate > 2.0 * measure_bound(&check.measures, MEASURE_OF_ACCELERATION));
    assert_true(measure_good(&check.measures, MEASURE_OF_ACCELERATION));
    assert_true(measure_good(&check.measures, MEASURE_OF_SPEED));
}

static void test_a_command_an_explosion_and_a_collision_explain_it(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("tank", MIDDLE + 20.0, 100.0);
    (void)state;
    begin();
    now.entities.row[a].vx = 5.0;
    add_event(EVENT_COMMAND)->command.entity = a + 1;
    next();
    is_good();
    struct event *event = add_event(EVENT_DETONATION);
    event->detonation.point[0] = MIDDLE + 30.0;
    event->detonation.point[1] = 100.0;
    event->detonation.point[2] = MIDDLE;
    event->detonation.explosive_kg = 1.0f;
    now.entities.row[b].vx = -5.0;
    next();
    is_good();
    /* One gives energy to the other: that of both together stays. */
    event = add_event(EVENT_COLLISION);
    event->collision.a.id = a + 1;
    event->collision.b.id = b + 1;
    now.entities.row[a].vx = -sqrt(50.0 - 9.0);
    now.entities.row[b].vx = 3.0;
    next();
    is_good();
    event = add_event(EVENT_COLLISION);
    event->collision.a.id = a + 1;
    event->collision.b.id = b + 1;
    now.entities.row[b].vx = 5.0;
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_ACCELERATION));
    assert_false(measure_good(&check.measures, MEASURE_OF_ENERGY));
}

/* One tank gives its speed to another and is sent back since, so that they are apart. */
static void test_bodies_that_pressed_share_their_energy(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("tank", MIDDLE + 20.0, 100.0);
    (void)state;
    begin();
    add_event(EVENT_COMMAND)->command.entity = a + 1;
    now.entities.row[a].vx = 5.0;
    next();
    now.contacts[0] = (struct persistent_contact){.a_id = a + 1,
                                                  .b_id = b + 1,
                                                  .a_row = a,
                                                  .b_row = b,
                                                  .pressed_tick = (uint32_t)now.head->tick + 1};
    now.head->contact_count = 1;
    now.entities.row[a].vx = 2.0;
    now.entities.row[b].vx = 4.5;
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_ENERGY));
    now.entities.row[a].vx = 4.5;
    next();
    assert_false(measure_good(&check.measures, MEASURE_OF_ENERGY));
}

static void test_speed_and_spin(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    begin();
    add_event(EVENT_COMMAND)->command.entity = tank + 1;
    now.entities.row[tank].vx = 3.0 * steps_kind(&f, "tank")->max_speed_mps;
    now.entities.row[tank].spin_y = -30.0;
    next();
    is_bad(MEASURE_OF_SPEED, 3.0);
    is_bad(MEASURE_OF_SPIN, 30.0);
}

static void test_a_jump(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    begin();
    now.entities.row[tank].z += 0.25;
    next();
    is_bad(MEASURE_OF_JUMP, 0.25);
    no_other_is_bad(MEASURE_OF_JUMP);
}

static void test_a_wreck_that_snaps(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    steps_rows(&f).row[tank].state = ENTITY_WRECK;
    steps_rows(&f).row[tank].spin_y = -6.0;
    begin();
    now.entities.row[tank].heading += 0.6;
    next();
    is_bad(MEASURE_OF_SNAP, 0.5);
    no_other_is_bad(MEASURE_OF_SNAP);
}

static void test_no_numbers_and_no_world(void **state)
{
    uint32_t a = put("tank", MIDDLE, 100.0), b = put("jeep", 49999.0, 100.0);
    (void)state;
    begin();
    now.entities.row[a].vy = NAN;
    now.entities.row[a].pitch = HUGE_VAL;
    next();
    is_bad(MEASURE_OF_NOT_FINITE, 2.0);
    no_other_is_bad(MEASURE_OF_NOT_FINITE);
    now.entities.row[b].x = 50000.5;
    next();
    is_bad(MEASURE_OF_OUTSIDE, 0.5);
}

static void test_another_body_in_the_row_does_not_jump(void **state)
{
    uint32_t tank = put("tank", MIDDLE, 100.0);
    (void)state;
    begin();
    now.entities.row[tank].x += 500.0;
    now.entities.row[tank].id = 77;
    next();
    is_good();
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, empty_world, end_check)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_world_at_rest_is_good),
        TEST(test_a_moving_world_is_good),
        TEST(test_a_tank_in_the_air),
        TEST(test_a_wreck_at_rest_on_its_side),
        TEST(test_a_wreck_at_rest_in_the_air),
        TEST(test_a_wreck_that_hangs_in_the_air),
        TEST(test_a_wreck_that_is_lifted_out_of_the_ground_may_stand_for_a_frame),
        TEST(test_a_wreck_that_moves_has_no_clearance),
        TEST(test_a_wreck_under_the_ground),
        TEST(test_a_vehicle_is_placed_level),
        TEST(test_a_wreck_that_sinks),
        TEST(test_a_wreck_that_comes_out_slantwise),
        TEST(test_a_wreck_that_bounces),
        TEST(test_the_energy_of_a_wreck_that_rolls),
        TEST(test_a_wreck_that_is_pushed_out),
        TEST(test_an_aircraft_that_becomes_a_wreck),
        TEST(test_two_explosions_explain_a_way),
        TEST(test_two_collisions_explain_a_way),
        TEST(test_two_impacts_of_contacts_explain_a_way),
        TEST(test_a_corner_in_a_crater),
        TEST(test_two_boxes_overlap),
        TEST(test_an_overlap_at_the_start_may_stay_but_not_grow),
        TEST(test_bodies_that_part_push_each_other),
        TEST(test_spheres_overlap),
        TEST(test_no_bound_where_the_response_promises_none),
        TEST(test_a_wall),
        TEST(test_a_wall_overlapped_from_the_start),
        TEST(test_speed_from_nowhere),
        TEST(test_a_wreck_that_turns_over_in_the_air),
        TEST(test_a_command_an_explosion_and_a_collision_explain_it),
        TEST(test_bodies_that_pressed_share_their_energy),
        TEST(test_speed_and_spin),
        TEST(test_a_jump),
        TEST(test_a_wreck_that_snaps),
        TEST(test_no_numbers_and_no_world),
        TEST(test_another_body_in_the_row_does_not_jump),
    };
    return cmocka_run_group_tests(tests, open_world, close_world);
}
