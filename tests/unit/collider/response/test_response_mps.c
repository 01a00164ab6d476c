/* The response of MPS II and III: row 42. */
#include "collider/response/response.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

/* At any angle, speeds and masses both are destroyed where they met. */
static void test_row_42_platforms_that_meet_are_both_destroyed(void **state)
{
    static const double speeds[] = {0.0, 0.1, 30.0}, angles_deg[] = {0.0, 45.0, 180.0};
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (int n = 0; n < 9; n++) {
        struct response_context context;
        struct outcome outcome = {RESPONSE_NONE, 0.0};
        steps_empty(&f);
        uint32_t ship = fixture_put(&f, (struct fixture_entity){.kind = "ship",
                                                                .at = {20000.0, 100.0, 20000.0},
                                                                .velocity = {speeds[n / 3], 0, 0}});
        uint32_t jeep = fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                                .at = {20050.0, 100.0, 20000.0},
                                                                .velocity = {-1.0, 0.0, 0.0}});
        steps_respond(&f, &context);
        const struct impact impact = {.a = ship,
                                      .b = jeep,
                                      .time = 1.0,
                                      .normal = {1.0, 0.0, 0.0},
                                      .closing_mps = speeds[n / 3] + 1.0,
                                      .angle_rad = angles_deg[n % 3] * RAD_PER_DEG};
        response_mps.moving(&context, &impact, &outcome);
        const struct entities *e = &context.next->entities;
        assert_int_equal(outcome.response, RESPONSE_DESTROYED);
        assert_int_equal(e->row[ship].state, ENTITY_WRECK);
        assert_int_equal(e->row[jeep].state, ENTITY_WRECK);
        assert_true(vec3_length(entities_velocity(e, ship)) == 0.0);
        assert_true(vec3_length(entities_velocity(e, jeep)) == 0.0);
        assert_true(e->row[ship].x == 20000.0 && e->row[jeep].x == 20050.0);
        assert_int_equal(context.next->head->tally.destroyed, 2);
        steps_respond_end(&context);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_42_platforms_that_meet_are_both_destroyed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
