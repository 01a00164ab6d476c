/* The registry of roles. */
#include "ipc/segment/role.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_every_role_is_found_by_its_name(void **state)
{
    (void)state;
    for (int i = 0; i < ROLE_COUNT; i++) {
        assert_int_equal(role_find(role_name((enum role)i)), i);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(role_name((enum role)i), role_name((enum role)j));
    }
    assert_string_equal(role_name(ROLE_MOVER), "mover");
    assert_string_equal(role_name(ROLE_RENDERER_2), "renderer-2");
}

static void test_unknown_names_are_role_none(void **state)
{
    (void)state;
    assert_int_equal(role_find("nobody"), ROLE_NONE);
    assert_int_equal(role_find(""), ROLE_NONE);
    assert_int_equal(role_find("renderer-5"), ROLE_NONE);
    assert_string_equal(role_name(ROLE_NONE), "?");
    assert_string_equal(role_name((enum role)1000), "?");
    assert_string_equal(role_state_name(ROLE_STATE_COUNT), "?");
    assert_string_equal(role_state_name(ROLE_READY), "ready");
}

/* What the keeper does with a role follows from the registry alone. */
static void test_the_keeper_starts_the_mover_last_and_stops_it_first(void **state)
{
    enum role start[ROLE_COUNT], stop[ROLE_COUNT];
    int count = role_order(start, false);
    unsigned started = 0, stopped = 0;
    (void)state;
    assert_int_equal(role_order(stop, true), count);
    assert_int_equal(start[count - 1], ROLE_MOVER);
    assert_int_equal(stop[0], ROLE_MOVER);
    for (int i = 0; i < count; i++) {
        started |= 1u << start[i];
        stopped |= 1u << stop[i];
    }
    assert_int_equal(started, stopped); /* and each of them once: count is their number */
    assert_int_equal(__builtin_popcount(started), count);
    assert_true(started & 1u << ROLE_CONSOLE);
    assert_false(started & 1u << ROLE_RENDERER_2);
}

static void test_a_reader_has_no_trait(void **state)
{
    (void)state;
    for (unsigned trait = 1; trait <= ROLE_NEEDED; trait <<= 1)
        assert_false(role_has(ROLE_NONE, (enum role_trait)trait));
    assert_true(role_has(ROLE_MOVER, ROLE_MAKES_FRAMES) && !role_has(ROLE_MOVER, ROLE_OPTIONAL));
    assert_true(role_has(ROLE_RENDERER_4, ROLE_DRAWS));
}

static void test_names_are_listed_by_trait(void **state)
{
    char text[ROLE_NAMES_BYTES];
    (void)state;
    assert_string_equal(role_names(ROLE_OPTIONAL, text, sizeof text),
                        "reporter, recorder, renderer");
    assert_string_equal(role_names(ROLE_NEEDED, text, sizeof text), "mover, collider, intake");
    assert_string_equal(role_names(ROLE_NEEDED, text, 12), "mover, coll");
    role_names((enum role_trait)0, text, sizeof text);
    assert_true(strlen(text) + 1 < sizeof text);
    for (int i = 0; i < ROLE_COUNT; i++)
        assert_non_null(strstr(text, role_name((enum role)i)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_role_is_found_by_its_name),
        cmocka_unit_test(test_unknown_names_are_role_none),
        cmocka_unit_test(test_the_keeper_starts_the_mover_last_and_stops_it_first),
        cmocka_unit_test(test_a_reader_has_no_trait),
        cmocka_unit_test(test_names_are_listed_by_trait),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
