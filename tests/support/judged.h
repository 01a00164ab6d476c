/* Frames that the judge of physics looks at. Tests that use it have the library of the judge. */
#ifndef JOLON_TESTS_SUPPORT_JUDGED_H
#define JOLON_TESTS_SUPPORT_JUDGED_H

#include "supervisor/physics/physics_check.h"
#include "tests/support/fixture.h"
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

#endif
