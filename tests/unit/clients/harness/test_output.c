/* A slow reader: states are dropped first, then events, which are counted, and answers never. */
#include "clients/harness/output.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct output output;

static size_t lines_of(char first)
{
    size_t count = 0;
    for (size_t i = 0; i < output.used; i++) {
        const char *at = output.bytes + output.begin + i;
        count += *at == first && (i == 0 || at[-1] == '\n');
    }
    return count;
}

static void add(enum output_kind kind, char first, size_t count)
{
    char line[1000];
    memset(line, '.', sizeof line);
    line[0] = first;
    line[sizeof line - 1] = '\0';
    for (size_t i = 0; i < count; i++)
        output_line(&output, kind, line);
}

static void test_what_is_left_out(void **state)
{
    (void)state;
    add(OUTPUT_STATE, 's', 3000);
    size_t states = lines_of('s');
    assert_true(states >= OUTPUT_STATES_MAX / 1000 && states <= OUTPUT_STATES_MAX / 1000 + 1);
    assert_false(output_takes_states(&output));
    add(OUTPUT_EVENT, 'e', 3000);
    size_t events = lines_of('e');
    assert_true(output.used >= OUTPUT_EVENTS_MAX && output.used < OUTPUT_EVENTS_MAX + 1000);
    assert_int_equal(output.missed, 3000 - events);
    add(OUTPUT_ANSWER, 'a', 100);
    assert_int_equal(lines_of('a'), 100);
    assert_int_equal(lines_of('s'), states);
    output_close(&output);
}

static void test_missed_events_are_reported_before_the_next(void **state)
{
    (void)state;
    output_missed(&output, 7);
    add(OUTPUT_ANSWER, 'a', 1);
    assert_int_equal(lines_of('{'), 0);
    add(OUTPUT_EVENT, 'e', 1);
    assert_int_equal(lines_of('{'), 1);
    assert_non_null(strstr(output.bytes, "{\"missed\":7}\ne"));
    assert_int_equal(output.missed, 0);
    output_close(&output);
}

static void test_no_memory_ends_it(void **state)
{
    (void)state;
    output_object(&output, OUTPUT_ANSWER, NULL);
    assert_true(output.closed);
    output_close(&output);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_left_out),
        cmocka_unit_test(test_missed_events_are_reported_before_the_next),
        cmocka_unit_test(test_no_memory_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
