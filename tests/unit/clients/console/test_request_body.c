/* Bodies of requests: every wrong value of every member is refused with a text. */
#include "clients/console/request_body.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct command_text order;
static uint32_t cancel;

/* The status of reading a body; what was said must be JSON of an error, and only then. */
static enum http_answer_status status_of(const char *body)
{
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    bool good = request_body_order(&order, &cancel, body, strlen(body), &answer);
    assert_int_equal(good, answer.status == HTTP_ANSWER_OK);
    if (!good)
        assert_memory_equal(answer.json.bytes, "{\"error\":\"", 10);
    json_writer_free(&answer.json);
    return answer.status;
}

static void good(const char *body)
{
    if (status_of(body) != HTTP_ANSWER_OK)
        fail_msg("refused: %s", body);
}

static void bad(const char *body)
{
    if (status_of(body) != HTTP_ANSWER_BAD)
        fail_msg("taken: %s", body);
}

static void test_orders_are_read(void **state)
{
    (void)state;
    good("{\"do\":\"drive\",\"vehicle\":7,\"throttle\":-0.5,\"brake\":1,\"gear\":\"low\"}");
    assert_int_equal(order.command.type, jolon_COMMAND_DRIVE);
    assert_int_equal(order.command.entity, 7);
    assert_float_equal(order.command.throttle, -0.5f, 0.0f);
    assert_float_equal(order.command.steer, 0.0f, 0.0f);
    assert_int_equal(order.command.gear, jolon_GEAR_LOW);
    good("{\"do\":\"spawn\",\"kind\":\"tank\",\"force\":\"red\",\"x\":1,\"z\":2,\"heading_deg\":90}"
         "\n");
    assert_string_equal(order.command.kind, "tank");
    assert_int_equal(order.command.force, jolon_FORCE_RED);
    assert_true(order.command.altitude_m < 0.0);
    good("{\"do\":\"mission\",\"munition\":\"artillery\",\"x\":0,\"z\":50000,\"rounds\":12,"
         "\"every_s\":0.5,\"radius_m\":200,\"seed\":9}");
    assert_int_equal(order.rounds, 12);
    assert_int_equal(order.seed, 9);
    assert_true(order.given & 1u << COMMAND_TEXT_SEED);
    good("{\"do\":\"step\"}");
    assert_int_equal(order.command.frames, 1);
    good("{\"do\":\"release\",\"vehicle\":4294967295,\"anyway\":true}");
    assert_true(order.command.anyway);
    assert_int_equal(order.command.entity, UINT32_MAX);
}

static void test_numbers_are_held_to_their_ranges(void **state)
{
    static const char *const outside[] = {
        "\"throttle\":1.001", "\"throttle\":-1.001", "\"steer\":2",     "\"climb\":-9",
        "\"traverse\":1e300", "\"elevate\":1e999",   "\"brake\":-0.1",  "\"brake\":1.1",
        "\"throttle\":\"1\"", "\"throttle\":null",   "\"steer\":true",  "\"steer\":[]",
        "\"vehicle\":0",      "\"vehicle\":-1",      "\"vehicle\":1.5", "\"vehicle\":4294967296",
        "\"gear\":\"fast\"",  "\"gear\":1",          "\"gear\":null"};
    char body[128];
    (void)state;
    for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        (void)snprintf(body, sizeof body, "{\"do\":\"drive\",%s}", outside[i]);
        bad(body);
    }
    bad("{\"do\":\"scale\",\"scale\":0}");
    bad("{\"do\":\"scale\",\"scale\":101}");
    bad("{\"do\":\"step\",\"frames\":0}");
    bad("{\"do\":\"step\",\"frames\":1000001}");
    bad("{\"do\":\"spawn\",\"kind\":\"tank\",\"x\":-1,\"z\":1}");
    bad("{\"do\":\"spawn\",\"kind\":\"tank\",\"x\":1,\"z\":500001}");
    bad("{\"do\":\"mission\",\"munition\":\"bomb\",\"x\":1,\"z\":1,\"rounds\":1001}");
    bad("{\"do\":\"mission\",\"munition\":\"bomb\",\"x\":1,\"z\":1,\"every_s\":-0.001}");
    bad("{\"do\":\"mission\",\"munition\":\"bomb\",\"x\":1,\"z\":1,\"radius_m\":-1}");
}

static void test_words_are_held_to_theirs(void **state)
{
    (void)state;
    bad("{\"do\":\"spawn\",\"kind\":\"\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"spawn\",\"kind\":\"a-name-that-is-far-too-long-for-a-kind\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"spawn\",\"kind\":5,\"x\":1,\"z\":1}");
    bad("{\"do\":\"spawn\",\"kind\":\"tank\",\"force\":\"green\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"spawn\",\"kind\":\"tank\",\"behaviour\":\"attack\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"release\",\"vehicle\":1,\"anyway\":1}");
}

static void test_members_belong_to_their_order(void **state)
{
    (void)state;
    bad("{\"do\":\"pause\",\"vehicle\":1}");
    bad("{\"do\":\"drive\",\"colour\":\"red\"}");
    bad("{\"do\":\"drive\",\"steer\":0,\"steer\":1}");
    bad("{\"do\":\"remove\"}");
    bad("{\"do\":\"spawn\",\"kind\":\"tank\",\"x\":1}");
    bad("{\"do\":\"spawn\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"mission\",\"x\":1,\"z\":1}");
    bad("{\"do\":\"cancel\"}");
    bad("{\"do\":\"cancel\",\"mission\":0}");
    bad("{\"do\":\"cancel\",\"mission\":1.5}");
    bad("{\"do\":\"cancel\",\"mission\":1,\"vehicle\":1}");
    bad("{\"do\":\"drive\",\"vehicle\":1,\"lease_s\":1}");
}

static void test_a_page_need_not_say_what_its_player_drives(void **state)
{
    static const char *const own[] = {"{\"do\":\"drive\",\"steer\":1}", "{\"do\":\"release\"}",
                                      "{\"do\":\"fire\",\"target\":7}"};
    (void)state;
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        good(own[i]);
        assert_true(order.given & 1u << COMMAND_TEXT_VEHICLE);
        assert_int_equal(order.command.entity, 0);
        assert_int_equal(cancel, 0);
    }
    good("{\"do\":\"fire\",\"munition\":\"bomb\",\"x\":1,\"z\":2}");
    assert_false(order.given & 1u << COMMAND_TEXT_VEHICLE);
    assert_float_equal(order.every_s, 1.0, 0.0);
    good("{\"do\":\"drive\",\"vehicle\":\"Sentry\"}");
    assert_string_equal(order.vehicle, "Sentry");
    good("{\"do\":\"cancel\",\"mission\":3}");
    assert_int_equal(cancel, 3);
}

static void test_what_is_no_order_is_refused(void **state)
{
    static const char *const bodies[] = {"",
                                         " ",
                                         "null",
                                         "[]",
                                         "7",
                                         "{",
                                         "{}",
                                         "{\"do\":1}",
                                         "{\"do\":\"quit\"}",
                                         "{\"do\":\"pause\"}x",
                                         "{\"do\":\"pause\"}{\"do\":\"pause\"}",
                                         "{\"do\":\"pause\",}",
                                         "\xff\xfe{\"do\":\"pause\"}",
                                         "{\"do\":\"drive\",\"throttle\":NaN}"};
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    (void)state;
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; i++)
        bad(bodies[i]);
    assert_false(request_body_order(&order, &cancel, "{\"do\":\"pause\"}\0\0", 16, &answer));
    json_writer_free(&answer.json);
    char deep[4000];
    memset(deep, '[', sizeof deep - 1);
    deep[sizeof deep - 1] = '\0';
    bad(deep);
}

static bool joins(const char *body)
{
    char name[PLAYERS_NAME_MAX];
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    bool joined = request_body_join(name, body, strlen(body), &answer);
    json_writer_free(&answer.json);
    return joined;
}

static void test_names_are_text_to_be_shown(void **state)
{
    (void)state;
    assert_true(joins("{\"name\":\"Ann\"}"));
    assert_true(joins("{\"name\":\"J\xc3\xbcrgen <b>\"}"));
    assert_true(joins("{\"name\":\"12345678901234567890123456789012\"}"));
    assert_false(joins("{\"name\":\"123456789012345678901234567890123\"}"));
    char accents[64] = "{\"name\":\"";
    for (int i = 0; i < 20; i++)
        strcat(accents, "\xc3\xa9");
    assert_true(joins(strcat(accents, "\"}")));
    assert_false(joins("{\"name\":\"\xc2\xa0\"}"));
    assert_false(joins("{\"name\":\"Ann\xd8\x9c\"}"));
    assert_false(joins("{\"name\":\"Ann\xe2\x80\x8b\"}"));
    assert_false(joins("{\"name\":\"\"}"));
    assert_false(joins("{\"name\":\"  \"}"));
    assert_false(joins("{\"name\":7}"));
    assert_false(joins("{}"));
    assert_false(joins("{\"name\":\"a\\nb\"}"));
    assert_false(joins("{\"name\":\"a\x7f\"}"));
    assert_false(joins("{\"name\":\"\xc3\"}"));
    assert_false(joins("{\"name\":\"\xc0\xaf\"}"));
    assert_false(joins("{\"name\":\"\xed\xa0\x80\"}"));
    assert_false(joins("{\"name\":\"Ann\xe2\x80\xae\"}"));
}

static void test_processes_are_named(void **state)
{
    char role[REQUEST_BODY_ROLE_MAX];
    bool restart;
    struct http_answer answer = {.status = HTTP_ANSWER_OK};
    static const char good_body[] = "{\"do\":\"restart\",\"role\":\"renderer\"}";
    static const char *const bodies[] = {"{\"do\":\"stop\",\"role\":\"mover\"}", "{}",
                                         "{\"do\":\"kill\",\"role\":\"0123456789abcdef\"}"};
    (void)state;
    assert_true(request_body_process(&restart, role, good_body, sizeof good_body - 1, &answer));
    assert_true(restart);
    assert_string_equal(role, "renderer");
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; i++)
        assert_false(request_body_process(&restart, role, bodies[i], strlen(bodies[i]), &answer));
    json_writer_free(&answer.json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orders_are_read),
        cmocka_unit_test(test_numbers_are_held_to_their_ranges),
        cmocka_unit_test(test_words_are_held_to_theirs),
        cmocka_unit_test(test_members_belong_to_their_order),
        cmocka_unit_test(test_a_page_need_not_say_what_its_player_drives),
        cmocka_unit_test(test_what_is_no_order_is_refused),
        cmocka_unit_test(test_names_are_text_to_be_shown),
        cmocka_unit_test(test_processes_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
