/* Events of the topics as text and as JSON. */
#include "ipc/topics/event_json.h"
#include "ipc/topics/event_lines.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const jolon_ContactEndEvent end = {
    .header = {.frame = 150, .index = 3, .time_s = 2.0},
    .a = {.id = 12, .kind = "tank"},
    .b = {.id = 7, .kind = "tree", .fixed = true},
    .lasted_s = 1.5,
    .impacts = 2,
    .impulse_ns = 2.5f,
    .because = jolon_CONTACT_END_GONE,
};

static void test_the_end_of_a_contact_as_text(void **state)
{
    char line[EVENT_MERGE_LINE_MAX];
    uint32_t ids[EVENT_LINES_IDS];
    (void)state;
    event_lines_event(line, TOPIC_CONTACT_END, &end);
    assert_string_equal(line, "00:00:02.0 tank 12 and tree 7 parted after 1.5 s");
    event_lines_ids(ids, TOPIC_CONTACT_END, &end);
    assert_int_equal(ids[0], 12);
    assert_int_equal(ids[1], 0); /* a fixed object is no entity */
}

static void test_the_end_of_a_contact_as_json(void **state)
{
    char line[EVENT_MERGE_LINE_MAX];
    (void)state;
    event_json(line, TOPIC_CONTACT_END, &end);
    assert_string_equal(line, "{\"frame\":150,\"index\":3,\"time_s\":2,\"type\":\"contact_end\","
                              "\"a\":{\"id\":12,\"kind\":\"tank\",\"fixed\":false},"
                              "\"b\":{\"id\":7,\"kind\":\"tree\",\"fixed\":true},\"lasted_s\":1.5,"
                              "\"impacts\":2,\"impulse_ns\":2.5,\"because\":\"gone\"}");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_end_of_a_contact_as_text),
        cmocka_unit_test(test_the_end_of_a_contact_as_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
