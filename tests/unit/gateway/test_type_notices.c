/* Types that are not in the table: each is told once, however many come. */
#include "gateway/type_notices.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct type_notices notices;
static const struct kind kinds[2] = {{.name = "tank"}, {.name = "jeep"}};
static char text[900];

static int set_up(void **state)
{
    (void)state;
    memset(&notices, 0, sizeof notices);
    return 0;
}

static struct pdu_entity_type type_of(unsigned number)
{
    return (struct pdu_entity_type){1, 1, (uint16_t)number, 1, 2, 3, (uint8_t)(number >> 16)};
}

static void test_what_is_told(void **state)
{
    (void)state;
    assert_int_equal(type_notices_text(&notices, kinds, text, sizeof text), 0);
    for (int i = 0; i < 3; i++) {
        type_notices_note(&notices, type_of(225), 1);
        type_notices_note(&notices, type_of(71), KIND_NONE);
    }
    assert_int_equal(type_notices_text(&notices, kinds, text, sizeof text), 2);
    assert_string_equal(text, "type 1.1.225.1.2.3.0 is not in the table of types: shown as jeep; "
                              "1.1.71.1.2.3.0: left out");
    assert_int_equal(type_notices_text(&notices, kinds, text, sizeof text), 0);
}

static void test_each_once(void **state)
{
    static bool told[5000];
    unsigned lines = 0, types;
    (void)state;
    for (unsigned i = 0; i < 300; i++)
        type_notices_note(&notices, type_of(i), (uint16_t)(i % 2));
    while ((types = type_notices_text(&notices, kinds, text, sizeof text)) > 0) {
        char *at = text;
        for (unsigned i = 0; i < types; i++) {
            unsigned number;
            at = strstr(at, " 1.1.");
            assert_non_null(at);
            assert_int_equal(sscanf(at, " 1.1.%u", &number), 1);
            assert_false(told[number]);
            told[number] = true;
            at++;
        }
        lines++;
    }
    for (unsigned i = 0; i < 300; i++)
        assert_true(told[i]);
    assert_in_range(lines, 5, 30);
}

static void test_more_than_are_remembered(void **state)
{
    unsigned types, sum = 0;
    (void)state;
    for (unsigned i = 0; i < TYPE_NOTICES_MAX + 100; i++)
        type_notices_note(&notices, type_of(i), 0);
    type_notices_note(&notices, type_of(TYPE_NOTICES_MAX + 7), 0);
    while (notices.told < notices.count &&
           (types = type_notices_text(&notices, kinds, text, sizeof text)) > 0)
        sum += types;
    assert_int_equal(sum, TYPE_NOTICES_MAX);
    assert_int_equal(type_notices_text(&notices, kinds, text, sizeof text), 1);
    assert_ptr_equal(strstr(text, "101 more PDUs have types"), text);
    assert_int_equal(type_notices_text(&notices, kinds, text, sizeof text), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_what_is_told, set_up),
        cmocka_unit_test_setup(test_each_once, set_up),
        cmocka_unit_test_setup(test_more_than_are_remembered, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
