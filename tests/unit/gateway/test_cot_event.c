/* Events of Cursor on Target: the exact text, names that XML does not allow, dates, and no room. */
#include "gateway/cot_event.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static char xml[COT_EVENT_BYTES];

static struct cot_event event_of(const char *callsign)
{
    struct cot_event event = {.uid = "jolon.1.1991.1.7",
                              .type = "a-f-G-E-V-A-T",
                              .time_ms = 1795838582007,
                              .stale_ms = 1795838594007,
                              .latitude_deg = 35.95,
                              .longitude_deg = -121.25,
                              .height_m = 276.304,
                              .error_m = 1.0,
                              .course_deg = 57.0,
                              .speed_mps = 12.346};
    snprintf(event.callsign, sizeof event.callsign, "%s", callsign);
    return event;
}

#define HEAD(type)                                                                                 \
    "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n"                              \
    "<event version=\"2.0\" uid=\"jolon.1.1991.1.7\" type=\"" type                                 \
    "\" time=\"2026-11-28T04:03:02.007Z\" start=\"2026-11-28T04:03:02.007Z\" "                     \
    "stale=\"2026-11-28T04:03:14.007Z\" how=\"m-g\" opex=\"s\">"                                   \
    "<point lat=\"35.9500000\" lon=\"-121.2500000\" hae=\"276.30\" ce=\"1.0\" le=\"1.0\"/>"

static void test_the_text(void **state)
{
    static const char place[] = HEAD("a-f-G-E-V-A-T") "<detail><contact callsign=\"tank 7\"/>"
                                                      "<track course=\"57.00\" speed=\"12.35\"/>"
                                                      "</detail></event>\n";
    static const char gone[] = HEAD("t-x-d-d") "<detail><link uid=\"jolon.1.1991.1.7\" "
                                               "relation=\"none\" type=\"a-f-G-E-V-A-T\"/>"
                                               "<__forcedelete/></detail></event>\n";
    struct cot_event event = event_of("tank 7");
    (void)state;
    assert_int_equal(cot_event_write(&event, xml, sizeof xml), sizeof place - 1);
    assert_string_equal(xml, place);
    assert_int_equal(cot_event_write_deletion(&event, xml, sizeof xml), sizeof gone - 1);
    assert_string_equal(xml, gone);
}

static void test_names_are_escaped(void **state)
{
    struct cot_event event = event_of("<\"R&D\">'\x01\n\xc3\xa9");
    (void)state;
    assert_true(cot_event_write(&event, xml, sizeof xml) > 0);
    assert_non_null(strstr(xml, "callsign=\"&lt;&quot;R&amp;D&quot;&gt;&apos;????\"/>"));
}

/* The longest texts, all of them escaped, fit; a text without room is none. */
static void test_room(void **state)
{
    struct cot_event event = event_of("");
    (void)state;
    memset(event.callsign, '"', sizeof event.callsign - 1);
    memset(event.uid, '"', sizeof event.uid - 1);
    memset(event.type, '"', sizeof event.type - 1);
    size_t length = cot_event_write(&event, xml, sizeof xml);
    assert_true(length > 0);
    assert_true(cot_event_write_deletion(&event, xml, sizeof xml) > 0);
    for (size_t size = 1; size <= length; size++)
        assert_int_equal(cot_event_write(&event, xml, size), 0);
    assert_int_equal(cot_event_write(&event, xml, length + 1), length);
}

/* The dates of a day in each of 400 years are those of the C library. */
static void test_dates(void **state)
{
    struct cot_event event = event_of("");
    char right[64];
    (void)state;
    for (int64_t s = 0; s < (int64_t)400 * 366 * 86400; s += 86400 * 23 + 3599) {
        time_t time_s = (time_t)s;
        struct tm tm;
        event.time_ms = s * 1000;
        assert_true(cot_event_write(&event, xml, sizeof xml) > 0);
        strftime(right, sizeof right, " time=\"%Y-%m-%dT%H:%M:%S.000Z\"", gmtime_r(&time_s, &tm));
        if (!strstr(xml, right))
            fail_msg("%s has not%s", xml, right);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_text),
        cmocka_unit_test(test_names_are_escaped),
        cmocka_unit_test(test_room),
        cmocka_unit_test(test_dates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
