/* Debris that vehicles push: it takes their momentum, slides until friction stops it, and a full
 * list makes room. */
#include "collider/response/debris_push.h"

#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;
static uint32_t tank;

/* Object 0 is a tree. A tank heads north at 10 m/s and comes to (25000, 25000) with its middle. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 24900.0]; } );");
    tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                   .at = {25000.0, 100.0, 25000.0},
                                                   .velocity = {0.0, 0.0, -10.0}});
    steps_respond(&f, &context);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static struct debris *put(struct debris debris)
{
    struct state_head *head = context.next->head;
    head->debris[head->debris_count] = debris;
    return &head->debris[head->debris_count++];
}

static double grip(void)
{
    return 0.7 * GRAVITY_MPS2 * f.view.world.params->dt_s;
}

static void test_a_heap_takes_the_momentum_that_the_vehicle_loses(void **state)
{
    const struct entities *e = &context.next->entities;
    double mass = steps_kind(&f, "tank")->mass_kg;
    struct debris *heap =
        put((struct debris){.x = 25000.0, .z = 24996.0, .mass_kg = 4000.0f, .radius_m = 1.0f});
    (void)state;
    debris_push_step(&context);
    double gained = 4000.0 * (-(double)heap->vz + grip()), lost = mass * (10.0 + e->row[tank].vz);
    assert_true(lost > 0.0 && fabs(gained - lost) < 1e-4 * lost);
    for (int frame = 0; frame < 300 && -heap->vz < 8.5f; frame++) {
        heap->z = 24996.0; /* the vehicle stays behind it */
        debris_push_step(&context);
    }
    assert_true(e->row[tank].vz > -10.0 && -heap->vz >= 8.5f); /* it is pushed along */
    assert_true(e->row[tank].vx == 0.0 && heap->vx == 0.0f);
}

static void test_what_is_beside_behind_or_faster_takes_nothing(void **state)
{
    static const struct debris aside[] = {
        {.x = 25004.0, .z = 25000.0, .mass_kg = 4e3f, .radius_m = 1.0f},
        {.x = 25000.0, .z = 25003.0, .mass_kg = 4e3f, .radius_m = 1.0f},
        {.x = 25000.0, .z = 24996.0, .vz = -11.0f, .mass_kg = 4e3f, .radius_m = 1.0f}};
    (void)state;
    for (size_t n = 0; n < sizeof aside / sizeof aside[0]; n++) {
        put(aside[n]);
        debris_push_step(&context);
        assert_true(context.next->entities.row[tank].vz == -10.0);
        context.next->head->debris_count = 0;
    }
}

static void test_friction_stops_it(void **state)
{
    struct debris *heap = put((struct debris){
        .x = 26000.0, .z = 26000.0, .vx = 7.0f, .mass_kg = 10.0f, .radius_m = 0.5f});
    uint32_t frames = 0;
    (void)state;
    for (; heap->vx > 0.0f && frames < 1000; frames++)
        debris_push_step(&context);
    assert_true(fabs(heap->x - 26000.0 - 49.0 / (1.4 * GRAVITY_MPS2)) < 0.1);
    const struct debris before = *heap;
    debris_push_step(&context);
    assert_memory_equal(heap, &before, sizeof before);
}

static void test_a_trunk_turns_when_it_is_not_struck_in_its_middle(void **state)
{
    struct debris *trunk = put((struct debris){.x = 25003.0,
                                               .z = 24995.5,
                                               .heading_rad = (float)HALF_PI,
                                               .mass_kg = 400.0f,
                                               .half_length_m = 4.0f,
                                               .radius_m = 1.0f});
    (void)state;
    debris_push_step(&context);
    /* Its western half goes north: clockwise. */
    assert_true(trunk->spin_rps > 0.0f && trunk->vz < 0.0f);
    for (int frame = 0; frame < 200; frame++) {
        context.next->entities.row[tank].z = 25100.0; /* out of its way */
        debris_push_step(&context);
    }
    assert_true(trunk->spin_rps == 0.0f && (double)trunk->heading_rad > HALF_PI);
}

static void test_a_vehicle_that_stands_stops_it_and_is_not_moved(void **state)
{
    struct entities *e = &context.next->entities;
    (void)state;
    e->row[tank].vz = 0.0;
    struct debris *heap = put((struct debris){
        .x = 25000.0, .z = 24995.6, .vz = 0.5f, .mass_kg = 4000.0f, .radius_m = 1.0f});
    debris_push_step(&context);
    assert_true(heap->vz < 0.5f - (float)grip());
    for (int frame = 0; frame < 20; frame++)
        debris_push_step(&context);
    assert_true(heap->vz == 0.0f && e->row[tank].vz == 0.0 && e->row[tank].z == 25000.0);
}

/* --- what falls --------------------------------------------------------------------------------*/

static struct debris_fall fall_east(void)
{
    return (struct debris_fall){
        .object = 0, .x = 25000.0, .z = 24900.0, .away_x = 1.0, .speed_mps = 5.0, .moving_kg = 800};
}

static void test_a_tree_falls_away_from_its_striker(void **state)
{
    const struct debris_fall fall = fall_east();
    const struct kind *tree = steps_kind(&f, "tree");
    const struct debris *trunk = context.next->head->debris;
    (void)state;
    debris_push_add(&context, &fall);
    uint8_t stored = context.next->fixed_damage[0];
    assert_int_equal(fallen_damage(stored), DAMAGE_HIGH);
    assert_true(fabs(fallen_heading(stored) - HALF_PI) < 1e-9);
    assert_int_equal(context.next->head->debris_count, 1);
    double high = (double)f.view.world.fixed[0].height_m;
    assert_true(fabs(trunk->x - 25000.0 - 0.5 * high) < 1e-9 && fabs(trunk->z - 24900.0) < 1e-9);
    assert_true(fabs((double)trunk->mass_kg - 0.15 * tree->mass_kg) < 0.01);
    assert_true(trunk->vx == 5.0f && trunk->vz == 0.0f);
}

static void test_what_lies_firm_leaves_nothing_to_push(void **state)
{
    const struct debris_fall fall = fall_east();
    (void)state;
    steps_kind(&f, "tree")->debris_keep = 1.0;
    debris_push_add(&context, &fall);
    assert_int_equal(context.next->head->debris_count, 0);
    assert_true(context.next->fixed_damage[0] >= FALLEN_FIRST); /* it fell all the same */
}

static void test_a_full_list_gives_up_the_first_that_rests(void **state)
{
    struct state_head *head = context.next->head;
    const struct debris_fall fall = fall_east();
    (void)state;
    for (uint32_t i = 0; i < DEBRIS_MAX; i++)
        put((struct debris){.x = 30000.0 + i, .vx = i == 7 ? 0.0f : 1.0f, .mass_kg = 1.0f});
    debris_push_add(&context, &fall);
    assert_int_equal(head->debris_count, DEBRIS_MAX);
    assert_true(head->debris[6].x == 30006.0 && head->debris[7].x == 30008.0);
    assert_true(head->debris[DEBRIS_MAX - 1].vx == 5.0f);
    debris_push_add(&context, &fall); /* all move: no room */
    assert_int_equal(head->debris_count, DEBRIS_MAX);
    assert_true(head->debris[7].x == 30008.0);
}

static void test_a_trunk_that_makes_room_is_scattered(void **state)
{
    struct state_head *head = context.next->head;
    (void)state;
    for (uint32_t i = 0; i < DEBRIS_MAX; i++)
        put((struct debris){.mass_kg = 1.0f, .half_length_m = 1.0f});
    uint64_t damaged = head->tally.fixed_damaged;
    const struct debris_fall fall = fall_east();
    debris_push_add(&context, &fall);
    assert_int_equal(head->debris_count, DEBRIS_MAX);
    assert_int_equal(head->tally.fixed_damaged, damaged + 1);
    assert_int_equal(context.next->fixed_damage[0], DAMAGE_DESTROYED);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_world, close_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_heap_takes_the_momentum_that_the_vehicle_loses),
        TEST(test_what_is_beside_behind_or_faster_takes_nothing),
        TEST(test_friction_stops_it),
        TEST(test_a_trunk_turns_when_it_is_not_struck_in_its_middle),
        TEST(test_a_vehicle_that_stands_stops_it_and_is_not_moved),
        TEST(test_a_tree_falls_away_from_its_striker),
        TEST(test_what_lies_firm_leaves_nothing_to_push),
        TEST(test_a_full_list_gives_up_the_first_that_rests),
        TEST(test_a_trunk_that_makes_room_is_scattered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
