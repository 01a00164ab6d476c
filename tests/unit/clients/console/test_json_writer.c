/* The JSON writer: numbers, escapes, commas, and the bound of a text. */
#include "clients/console/json_writer.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void expect_number(double value, int decimals, const char *wanted)
{
    struct json_writer json = {0};
    json_writer_number(&json, value, decimals);
    assert_int_equal(json.used, strlen(wanted));
    assert_memory_equal(json.bytes, wanted, json.used);
    json_writer_free(&json);
}

static void test_numbers_are_short_and_right(void **state)
{
    (void)state;
    expect_number(0.0, 3, "0");
    expect_number(-0.0001, 3, "0");
    expect_number(1.25, 1, "1.3");
    expect_number(-12.05, 2, "-12.05");
    expect_number(3.1004, 3, "3.1");
    expect_number(0.007, 3, "0.007");
    expect_number(49999.96, 1, "50000");
    expect_number(NAN, 1, "null");
    expect_number(-INFINITY, 1, "null");
    expect_number(1e10, 1, "null");
}

static void test_words_are_escaped_and_commas_put(void **state)
{
    static const char wanted[] =
        "{\"a\":[1,\"\\\"\\\\\\u000a\\u007f\xc3\xbc\"],\"b\":{},\"c\":true}";
    struct json_writer json = {0};
    (void)state;
    json_writer_begin(&json, '{');
    json_writer_key(&json, "a");
    json_writer_begin(&json, '[');
    json_writer_whole(&json, 1);
    json_writer_word(&json, "\"\\\n\x7f\xc3\xbc");
    json_writer_end(&json, ']');
    json_writer_key(&json, "b");
    json_writer_begin(&json, '{');
    json_writer_end(&json, '}');
    json_writer_key_bool(&json, "c", true);
    json_writer_end(&json, '}');
    assert_int_equal(json.used, sizeof wanted - 1);
    assert_memory_equal(json.bytes, wanted, json.used);
    json_writer_free(&json);
}

static void test_text_has_a_bound(void **state)
{
    static char word[65536];
    struct json_writer json = {0};
    (void)state;
    memset(word, 'x', sizeof word - 1);
    for (int i = 0; i < 400; i++)
        json_writer_word(&json, word);
    assert_true(json.failed);
    assert_true(json.used <= JSON_WRITER_MAX);
    json_writer_free(&json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_are_short_and_right),
        cmocka_unit_test(test_words_are_escaped_and_commas_put),
        cmocka_unit_test(test_text_has_a_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
