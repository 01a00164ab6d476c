/* Wrecks that go back because of each other keep their common momentum (rows 43, 46). */
#include "collider/guard/tangled_wrecks.h"

#include "collider/guard/send_back.h"
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define FALL_M 0.5

enum { JET, HELICOPTER, TRUCK, LYING, FLYING, ROWS };

static struct fixture f;
static struct response_context context;
static struct tangled_wrecks tangled;
static uint8_t sent_back[64];

/* Three wrecks in the air, one on the ground, and a helicopter that flies. */
static int open_world(void **state)
{
    static const char *const kinds[ROWS] = {"jet", "helicopter", "truck", "jeep", "helicopter"};
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++) {
        double height_m = i == LYING ? FIXTURE_GROUND_M : 400.0;
        fixture_put(&f, (struct fixture_entity){.kind = kinds[i],
                                                .behaviour = BEHAVIOUR_HOLD,
                                                .at = {25000.0 + 40.0 * i, height_m, 25000.0},
                                                .velocity = {80.0 - 35.0 * i, -3.0 * i, 2.0}});
        steps_rows(&f).row[i].state = i == FLYING ? ENTITY_ACTIVE : ENTITY_WRECK;
    }
    steps_rows(&f).row[LYING].vy = 0.0;
    steps_rows(&f).row[TRUCK].spin_x = 2.0;
    steps_respond(&f, &context);
    memset(sent_back, SEND_BACK_MOST, sizeof sent_back);
    assert_int_equal(tangled_wrecks_init(&tangled, &f.view.world), 0);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    tangled_wrecks_free(&tangled);
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static struct entity *row(uint32_t i)
{
    return &context.next->entities.row[i];
}

static void note(uint32_t a, uint32_t b)
{
    tangled_wrecks_note(&tangled, &context,
                        contact_queue_pair(context.contacts, &(struct pair){a, b}));
}

/* As the guard does with a row that is back where it began the frame. */
static void stop(uint32_t i, double raised_m)
{
    row(i)->y += raised_m;
    row(i)->vx = row(i)->vy = row(i)->vz = 0.0;
    row(i)->spin_x = row(i)->spin_y = row(i)->spin_z = 0.0;
}

/* Returns the momentum of the centres of mass of rows 0 .. count - 1. */
static struct vec3 momentum(uint32_t count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; i++) {
        const struct mass_properties mass = mass_properties_of(&f.view.world.kinds[row(i)->kind]);
        struct mat3 axes =
            rotation_matrix(rotation_of(row(i)->heading, row(i)->pitch, row(i)->roll));
        struct vec3 arm = rotation_apply(&axes, (struct vec3){0.0, mass.centre_m, 0.0});
        struct vec3 spin = {row(i)->spin_x, row(i)->spin_y, row(i)->spin_z};
        struct vec3 velocity =
            vec3_add(entities_velocity(&context.next->entities, i), vec3_cross(spin, arm));
        sum = vec3_add(sum, vec3_scale(velocity, mass.mass_kg));
    }
    return sum;
}

static double speed_of(uint32_t i)
{
    return vec3_length(entities_velocity(&context.next->entities, i));
}

static void test_wrecks_in_the_air_go_on_together(void **state)
{
    struct vec3 before = momentum(3);
    (void)state;
    note(HELICOPTER, TRUCK);
    note(JET, TRUCK);
    for (uint32_t i = JET; i <= TRUCK; i++)
        stop(i, 0.0);
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    assert_true(vec3_length(vec3_sub(momentum(3), before)) < 1e-9 * vec3_length(before));
    for (uint32_t i = HELICOPTER; i <= TRUCK; i++)
        assert_true(row(i)->vx == row(JET)->vx && row(i)->vy == row(JET)->vy &&
                    row(i)->vz == row(JET)->vz && row(i)->spin_x == 0.0);
}

/* Going back raises what has fallen, so that their velocity is less than that of their momentum. */
static void test_they_gain_no_energy_by_going_back(void **state)
{
    (void)state;
    row(HELICOPTER)->vx = row(JET)->vx, row(HELICOPTER)->vy = row(JET)->vy,
    row(HELICOPTER)->vz = row(JET)->vz;
    double square = speed_of(JET) * speed_of(JET);
    note(JET, HELICOPTER);
    stop(JET, FALL_M);
    stop(HELICOPTER, FALL_M);
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    double now = speed_of(JET) * speed_of(JET) + 2.0 * GRAVITY_MPS2 * FALL_M;
    assert_true(fabs(now - square) < 1e-9 * square);
}

static void test_groups_that_touch_anything_else_stop(void **state)
{
    static const uint32_t others[] = {LYING, FLYING};
    (void)state;
    for (uint32_t n = 0; n < sizeof others / sizeof *others; n++) {
        note(JET, HELICOPTER);
        note(HELICOPTER, others[n]);
        stop(JET, 0.0);
        tangled_wrecks_go_on(&tangled, &context, sent_back);
        assert_true(speed_of(JET) == 0.0);
        row(JET)->vx = 80.0;
    }
}

static void test_slow_wrecks_come_to_rest(void **state)
{
    (void)state;
    row(JET)->vx = row(HELICOPTER)->vx = 1.0;
    row(JET)->vz = row(HELICOPTER)->vz = row(HELICOPTER)->vy = 0.0;
    note(JET, HELICOPTER);
    stop(JET, 0.0);
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    assert_true(speed_of(JET) == 0.0);
}

static void test_wrecks_that_keep_a_part_of_their_way_do_not_count(void **state)
{
    struct vec3 part = entities_velocity(&context.next->entities, TRUCK), before = momentum(2);
    (void)state;
    note(HELICOPTER, TRUCK);
    note(JET, TRUCK);
    stop(JET, 0.0);
    stop(HELICOPTER, 0.0);
    sent_back[TRUCK] = SEND_BACK_HALF;
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    assert_true(vec3_length(vec3_sub(momentum(2), before)) < 1e-9 * vec3_length(before));
    assert_true(row(TRUCK)->vx == part.x && row(TRUCK)->vy == part.y && row(TRUCK)->vz == part.z);
}

/* The groups of a frame are not those of the frame before. */
static void test_a_frame_is_forgotten(void **state)
{
    (void)state;
    note(JET, HELICOPTER);
    note(HELICOPTER, FLYING);
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    note(JET, HELICOPTER);
    stop(JET, 0.0);
    tangled_wrecks_go_on(&tangled, &context, sent_back);
    assert_true(speed_of(JET) > 0.0 && row(JET)->vx == row(HELICOPTER)->vx);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_world, close_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_wrecks_in_the_air_go_on_together),
        TEST(test_they_gain_no_energy_by_going_back),
        TEST(test_groups_that_touch_anything_else_stop),
        TEST(test_slow_wrecks_come_to_rest),
        TEST(test_wrecks_that_keep_a_part_of_their_way_do_not_count),
        TEST(test_a_frame_is_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
