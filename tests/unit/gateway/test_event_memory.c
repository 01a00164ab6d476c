/* When a number of an event is the same event: for a short time, and of the same munition, target,
 * firer and place. */
#include "gateway/event_memory.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define NOW_NS 1000000000000u
#define FIRER  ((uint64_t)7 << 32 | 1u << 16 | 5u) /* remote_id(7, 1, 5) */
#define BURST  ((uint64_t)7 << 32 | 1u << 16 | 77u)

static struct event_memory memory;

static struct told_event burst_of(struct remote_record record, uint64_t now_ns)
{
    struct told_event burst = event_memory_of(&record, now_ns);
    burst.placed = true;
    burst.place = (struct vec3){record.position[0], record.position[1], record.position[2]};
    return burst;
}

static const struct remote_record usual = {.remote = FIRER,
                                           .event = BURST,
                                           .type = REMOTE_STRUCK,
                                           .slot = SLOT_NONE,
                                           .kind = 3,
                                           .position = {25500.0, 100.0, 25000.0}};

/* Notes the usual event, and returns true if the other one is taken for it. */
static bool is_copy(struct remote_record other, double later_s)
{
    struct told_event first = burst_of(usual, NOW_NS);
    struct told_event again = burst_of(other, NOW_NS + (uint64_t)(later_s * 1e9));
    memset(&memory, 0, sizeof memory);
    event_memory_note(&memory, &first);
    return event_memory_has(&memory, &again);
}

static void test_copies(void **state)
{
    struct remote_record near = usual;
    (void)state;
    assert_true(is_copy(usual, 0.0));
    assert_true(is_copy(usual, 0.9 * EVENT_MEMORY_COPY_S));
    near.position[0] += 0.9 * EVENT_MEMORY_COPY_M;
    assert_true(is_copy(near, 1.0)); /* as a gateway that starts anew may have it */
}

static void test_others(void **state)
{
    struct remote_record next = usual, target = usual, munition = usual, firer = usual;
    struct remote_record number = usual, fire = usual;
    (void)state;
    next.position[0] += 5.0; /* the next round of a burst */
    target.entity = 1;
    munition.kind = 4;
    firer.remote++;
    number.event++;
    fire.type = REMOTE_FIRE;
    assert_false(is_copy(next, 0.0));
    assert_false(is_copy(target, 0.0));
    assert_false(is_copy(munition, 0.0));
    assert_false(is_copy(firer, 0.0));
    assert_false(is_copy(number, 0.0));
    assert_false(is_copy(fire, 0.0));
    assert_false(is_copy(usual, EVENT_MEMORY_COPY_S + 0.1)); /* so late there are no copies */
}

static void test_the_fire_of_a_round(void **state)
{
    struct remote_record record = usual;
    (void)state;
    record.type = REMOTE_FIRE;
    struct told_event fire = burst_of(record, NOW_NS);
    memset(&memory, 0, sizeof memory);
    event_memory_note(&memory, &fire);
    uint64_t later = NOW_NS + 20000000000u;
    const struct told_event *found = event_memory_fire(&memory, usual.event, usual.remote, later);
    assert_non_null(found);
    assert_true(found->place.x == usual.position[0]);
    assert_null(event_memory_fire(&memory, usual.event + 1, usual.remote, later));
    assert_null(event_memory_fire(&memory, usual.event, usual.remote + 1, later));
    assert_null(event_memory_fire(&memory, usual.event, usual.remote,
                                  NOW_NS + (uint64_t)((EVENT_MEMORY_FLIGHT_S + 1.0) * 1e9)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_copies),
        cmocka_unit_test(test_others),
        cmocka_unit_test(test_the_fire_of_a_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
