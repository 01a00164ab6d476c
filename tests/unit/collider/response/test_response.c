/* Which impacts of a contact are told: those that begin it, those after the bodies have parted, and
 * those that make a body's damage worse. */
#include "collider/response/response.h"

#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define TICK 100u /* of the frame being made: at 60 Hz */

static struct fixture f;
static struct response_context context;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "");
    for (uint32_t i = 0; i < 2; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank", .at = {25000.0 + 10 * i, 100, 25000}});
    fixture_state(&f).head->tick = TICK - 1;
    return 0;
}

static void know(uint32_t pressed_tick)
{
    struct state now = fixture_state(&f);
    now.contacts[0] = (struct persistent_contact){
        .a_id = 1, .b_id = 2, .b_row = 1, .begin_tick = 7, .pressed_tick = pressed_tick};
    now.head->contact_count = 1;
}

static struct impact impact_at(double closing_mps)
{
    uint32_t pair = contact_queue_pair(context.contacts, &(struct pair){0, 1}) + 1;
    return (struct impact){.b = 1, .pair = pair, .closing_mps = closing_mps};
}

static enum impact_role role_at(double closing_mps)
{
    const struct impact impact = impact_at(closing_mps);
    return response_role(&context, &impact);
}

static void test_the_first_impact_begins_the_contact(void **state)
{
    (void)state;
    steps_respond(&f, &context);
    assert_int_equal(role_at(0.01), IMPACT_BEGINS);
    assert_int_equal(role_at(1.9), IMPACT_LEANS); /* it has touched in this frame */
    assert_int_equal(role_at(2.1), IMPACT_WITHIN);
    steps_respond_end(&context);
}

/* Without room for the contact an impact is told if it is fast. */
static void test_without_room_only_fast_impacts_are_told(void **state)
{
    (void)state;
    steps_params(&f)->contact_slots = 0;
    steps_respond(&f, &context);
    assert_int_equal(role_at(1.9), IMPACT_WITHIN);
    steps_respond_end(&context);
    steps_respond(&f, &context);
    assert_int_equal(role_at(2.1), IMPACT_RENEWS);
    steps_respond_end(&context);
}

static void test_bodies_that_have_just_touched_have_not_parted(void **state)
{
    (void)state;
    know(TICK - 6); /* five frames without a touch: 0.083 s */
    steps_respond(&f, &context);
    assert_int_equal(role_at(20.0), IMPACT_WITHIN);
    steps_respond_end(&context);
}

static void test_bodies_that_have_parted_strike_again(void **state)
{
    (void)state;
    know(TICK - 8); /* seven frames: 0.117 s */
    steps_respond(&f, &context);
    assert_int_equal(role_at(1.9), IMPACT_LEANS);
    steps_respond_end(&context);
    steps_respond(&f, &context);
    assert_int_equal(role_at(2.1), IMPACT_RENEWS);
    steps_respond_end(&context);
}

/* Reports an impact within a contact that damages one body up to this level. */
static uint32_t events_of(enum damage damage)
{
    const struct outcome outcome = {RESPONSE_BOUNCE, 3.0};
    know(TICK - 1);
    steps_respond(&f, &context);
    const struct impact impact = impact_at(5.0);
    const struct report report = response_report(&context, &impact, IMPACT_WITHIN);
    context.next->entities.row[1].damage = (uint8_t)damage;
    write_collision_event(&context, &report, &impact, &outcome);
    assert_int_equal(context.contacts->impacts[impact.pair - 1].count, 1);
    assert_true(context.contacts->impacts[impact.pair - 1].impulse_ns == 3.0f);
    assert_int_equal(context.next->head->tally.collisions, context.events.count);
    steps_respond_end(&context);
    return context.events.count;
}

static void test_within_a_contact_only_worse_damage_is_told(void **state)
{
    (void)state;
    assert_int_equal(events_of(DAMAGE_NONE), 0);
    assert_int_equal(events_of(DAMAGE_LOW), 1);
    const struct event *event = &f.view.events[context.events.first];
    assert_int_equal(event->collision.begins, 0);
    assert_int_equal(event->collision.b.damage, DAMAGE_LOW);
    assert_true(event->collision.impulse_ns == 3.0f);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_the_first_impact_begins_the_contact),
        TEST(test_without_room_only_fast_impacts_are_told),
        TEST(test_bodies_that_have_just_touched_have_not_parted),
        TEST(test_bodies_that_have_parted_strike_again),
        TEST(test_within_a_contact_only_worse_damage_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
