/* Frames that the judge of physics looks at. Tests that use it have the library of the judge. */
#ifndef JOLON_TESTS_SUPPORT_JUDGED_H
#define JOLON_TESTS_SUPPORT_JUDGED_H

#include "supervisor/physics/physics_check.h"
#include "tests/support/fixture.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Computes so many frames as fixture_continue() does and lets the judge look at each. The caller
 * reads the measures and calls physics_check_free(). */
static inline void judged_continue(struct fixture *f, struct physics_check *check, uint32_t frames)
{
    struct state now = fixture_state(f);
    assert_int_equal(physics_check_begin(check, &f->view.world, &now), 0);
    for (uint32_t frame = 0; frame < frames; frame++) {
        const struct physics_events events = {f->view.events, f->view.world.params->event_slots};
        fixture_continue(f, 1);
        now = fixture_state(f);
        assert_int_equal(physics_check_frame(check, &now, &events), 0);
    }
}

/* --- frames that a test writes by hand into now ------------------------------------------------*/

/* Begins with the committed frame. */
static inline void judged_begin(struct fixture *f, struct physics_check *check, struct state *now)
{
    *now = fixture_state(f);
    assert_int_equal(physics_check_begin(check, &f->view.world, now), 0);
}

/* Lets the judge look at the next frame, as it stands in now. */
static inline void judged_next(const struct fixture *f, struct physics_check *check,
                               const struct state *now)
{
    const struct physics_events events = {f->view.events, f->view.world.params->event_slots};
    now->head->frame++;
    now->head->tick++;
    assert_int_equal(physics_check_frame(check, now, &events), 0);
}

/* Adds an event of the next frame, whose other members the test sets. */
static inline struct event *judged_event(const struct fixture *f, const struct state *now,
                                         enum event_type type)
{
    uint64_t sequence = now->head->event_end++;
    struct event *event = &f->view.events[sequence & (f->view.world.params->event_slots - 1)];
    *event = (struct event){.sequence = sequence, .type = type};
    return event;
}

/* Fails unless the present frame has passed the bound of this measure, by this value. */
static inline void judged_bad(const struct physics_check *check, const struct state *now,
                              enum measure_kind kind, double value)
{
    const struct measure *measure = &check->measures.of[kind];
    if (fabs(measure->worst - value) > 1e-9 * maths_max(1.0, fabs(value)))
        fail_msg("%s: %.15g instead of %.15g", measure_word(kind), measure->worst, value);
    assert_false(measure_good(&check->measures, kind));
    assert_int_equal(measure->frame, now->head->frame);
    assert_false(measures_good(&check->measures));
}

/* Fails if another measure has passed its bound. kind MEASURE_KINDS: any. */
static inline void judged_no_other_bad(const struct physics_check *check, enum measure_kind kind)
{
    for (int i = 0; i < MEASURE_KINDS; i++) {
        if (i != (int)kind && !measure_good(&check->measures, (enum measure_kind)i))
            fail_msg("%s is bad, too: %g", measure_word((enum measure_kind)i),
                     check->measures.of[i].worst);
    }
}

#endif
