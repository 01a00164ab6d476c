/* Bodies that another simulator moves: the physics check does not judge them, and they explain what
 * happens to ours. */
#include "supervisor/physics/physics_check.h"

#include "tests/support/steps.h"
#include "world/entity/event.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define MIDDLE  25000.0
#define GROUND  100.0
#define FAR_M   500.0 /* from ours, before it comes */
#define ASIDE_M 0.3   /* by which a body is moved out of another in a frame */

static struct fixture f;
static struct physics_check check;
static struct state now; /* the frame that the test writes by hand */
static uint32_t ours, theirs;

static int begin(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    ours = fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {MIDDLE, GROUND, MIDDLE}});
    theirs = fixture_put(
        &f, (struct fixture_entity){.kind = "tank", .at = {MIDDLE + FAR_M, GROUND, MIDDLE}});
    now = fixture_state(&f);
    now.entities.row[theirs].behaviour = BEHAVIOUR_REMOTE;
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    return 0;
}

static int end(void **state)
{
    (void)state;
    physics_check_free(&check);
    fixture_close(&f);
    return 0;
}

static void next(void)
{
    const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
    now.head->frame++;
    now.head->tick++;
    assert_int_equal(physics_check_frame(&check, &now, &events), 0);
}

static bool is_good(enum measure_kind kind)
{
    return measure_good(&check.measures, kind);
}

static void all_is_good(void)
{
    for (int i = 0; i < MEASURE_KINDS; i++) {
        if (!is_good((enum measure_kind)i))
            fail_msg("%s: %g", measure_word((enum measure_kind)i), check.measures.of[i].worst);
    }
}

static void test_they_are_not_judged(void **state)
{
    struct entities *e = &now.entities;
    (void)state;
    for (int i = 0; i < 10; i++) {
        e->row[theirs].x += i % 2 ? 8000.0 : -8000.0;
        e->row[theirs].y += 3.0 * (i - 5);
        e->row[theirs].vx = 1e4 * i;
        e->row[theirs].spin_y = 100.0 * i;
        e->row[theirs].roll = 0.3 * i;
        next();
    }
    e->row[theirs].x = (double)NAN;
    next();
    all_is_good();
    assert_int_equal(check.bodies, 11); /* ours, in each frame */
    assert_int_equal(check.most, 1);
    now.entities.row[ours].x += 1.0;
    next();
    assert_false(is_good(MEASURE_OF_JUMP)); /* nothing explains that */
}

/* Its owner puts a body into ours, which is moved out of it. */
static void test_they_overlap_ours(void **state)
{
    struct entities *e = &now.entities;
    (void)state;
    next();
    e->row[theirs].x = MIDDLE + 1.0;
    next();
    for (int i = 0; i < 6; i++) {
        e->row[ours].x -= ASIDE_M;
        next();
    }
    all_is_good();
    assert_true(check.measures.of[MEASURE_OF_OVERLAP].taken == 0);
    e->row[theirs].x += FAR_M;
    next();
    next();
    e->row[ours].x -= ASIDE_M;
    next();
    assert_false(is_good(MEASURE_OF_JUMP));
}

/* Ours has the energy of a body that is corrected away at the end of the frame. */
static void test_they_push_ours(void **state)
{
    struct event *event =
        &f.view.events[now.head->event_end & (f.view.world.params->event_slots - 1)];
    (void)state;
    next();
    *event = (struct event){.sequence = now.head->event_end++, .type = EVENT_COLLISION};
    event->collision.a.id = now.entities.row[ours].id;
    event->collision.b.id = now.entities.row[theirs].id;
    now.entities.row[ours].vx = 5.0;
    next();
    all_is_good();
    now.head->contact_count = 1; /* the same by a contact that is not told */
    now.contacts[0] = (struct persistent_contact){.a_id = now.entities.row[ours].id,
                                                  .b_id = now.entities.row[theirs].id,
                                                  .a_row = ours,
                                                  .b_row = theirs,
                                                  .pressed_tick = (uint32_t)now.head->tick + 1};
    now.entities.row[ours].vx = 9.0;
    now.entities.row[ours].x += 9.0 / 60.0;
    next();
    all_is_good();
    now.head->contact_count = 0;
    next();
    now.entities.row[ours].vx = 14.0;
    next();
    assert_false(is_good(MEASURE_OF_ENERGY));
}

int main(void)
{
#define TEST(test) cmocka_unit_test_setup_teardown(test, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_they_are_not_judged),
        TEST(test_they_overlap_ours),
        TEST(test_they_push_ours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
