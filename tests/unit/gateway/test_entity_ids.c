/* Identifiers: the ends of the applications, the way back, and what has none. */
#include "gateway/entity_ids.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct entity_ids ids = {.site = 1991, .application = 36, .applications = 16};

static void assert_id(uint32_t id, unsigned application, unsigned entity)
{
    struct pdu_id to;
    assert_true(entity_ids_of(&ids, id, &to));
    assert_int_equal(to.site, 1991);
    assert_int_equal(to.application, application);
    assert_int_equal(to.entity, entity);
    assert_int_equal(entity_ids_back(&ids, to), id);
}

static void test_the_division(void **state)
{
    (void)state;
    assert_id(1, 36, 1);
    assert_id(65533, 36, 65533);
    assert_id(65534, 37, 1);
    assert_id(16 * 65533, 51, 65533);
}

static void test_what_has_no_identifier(void **state)
{
    static const uint32_t none[] = {0, 16 * 65533 + 1, UINT32_MAX};
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        struct pdu_id to = {9, 9, 9};
        assert_false(entity_ids_of(&ids, none[i], &to));
        assert_true(to.site == 0 && to.application == 0 && to.entity == 0);
    }
    static const struct pdu_id strange[] = {{1990, 36, 1}, {1991, 35, 1},      {1991, 52, 1},
                                            {1991, 36, 0}, {1991, 36, 0xfffe}, {0, 0, 0}};
    for (unsigned i = 0; i < sizeof strange / sizeof strange[0]; i++)
        assert_int_equal(entity_ids_back(&ids, strange[i]), 0);
}

/* Different ids of ours have different identifiers, none of them reserved. */
static void test_random_ids(void **state)
{
    uint64_t random = fixture_seed(16);
    (void)state;
    for (int i = 0; i < 100000; i++) {
        uint32_t id = 1 + (uint32_t)(fixture_random(&random) % (16 * 65533));
        struct pdu_id to;
        assert_true(entity_ids_of(&ids, id, &to));
        assert_true(to.entity >= 1 && to.entity <= 0xfffd);
        assert_int_equal(entity_ids_back(&ids, to), id);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_division),
        cmocka_unit_test(test_what_has_no_identifier),
        cmocka_unit_test(test_random_ids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
