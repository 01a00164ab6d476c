/* The console's small parts: the JSON writer, keys, rates, players, allowed host names, and answers
 * of a renderer. */
#include "clients/console/renderer_client.h"
#include "clients/console/players.h"
#include "clients/console/session_key.h"
#include "clients/console/json_writer.h"
#include "ipc/http/host_check.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define SECOND 1000000000ull

/* --- text --------------------------------------------------------------------------------------*/

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

/* --- keys --------------------------------------------------------------------------------------*/

static void test_keys_are_equal_or_not(void **state)
{
    (void)state;
    assert_true(session_key_equal("abcd", "abcd"));
    assert_false(session_key_equal("abcd", "abce"));
    assert_false(session_key_equal("abcd", "Abcd"));
    assert_false(session_key_equal("abcd", "abc"));
    assert_false(session_key_equal("abcd", "abcdabcd"));
    assert_false(session_key_equal("abcd", ""));
    assert_false(session_key_equal("", ""));
    assert_false(session_key_equal("", "x"));
}

static int write_file(const char *path, const char *text, mode_t mode)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    bool good =
        fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text) && fchmod(fd, mode) == 0;
    close(fd);
    return good ? 0 : -1;
}

static void test_a_token_file_is_made_kept_and_checked(void **state)
{
    char path[64], first[SESSION_KEY_MAX], token[SESSION_KEY_MAX];
    struct error_text error;
    struct stat status;
    (void)state;
    (void)snprintf(path, sizeof path, "/tmp/jolon-token-%d", (int)getpid());
    assert_int_equal(session_key_file(first, path, &error), 0);
    assert_int_equal(strlen(first), 32);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0600);
    assert_int_equal(session_key_file(token, path, &error), 0);
    assert_string_equal(token, first);
    assert_int_equal(chmod(path, 0644), 0);
    assert_int_equal(session_key_file(token, path, &error), -1);
    assert_non_null(strstr(error.text, "others may read it"));
    static const char *const wrong[] = {"", "short\n", "0123456789abcdef 0\n",
                                        "0123456789abcdef\n0123456789abcdef\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(write_file(path, wrong[i], 0600), 0);
        assert_int_equal(session_key_file(token, path, &error), -1);
    }
    assert_int_equal(write_file(path, "0123456789abcdef\r\n", 0600), 0);
    assert_int_equal(session_key_file(token, path, &error), 0);
    assert_string_equal(token, "0123456789abcdef");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(session_key_file(token, "/tmp", &error), -1);
}

/* --- rates -------------------------------------------------------------------------------------*/

static void test_a_rate_grants_a_burst_and_then_its_pace(void **state)
{
    struct rate rate = {0};
    uint64_t now_ns = 5 * SECOND;
    uint32_t granted = 0;
    (void)state;
    for (int i = 0; i < 100; i++)
        granted += rate_take(&rate, 10, 20, now_ns);
    assert_int_equal(granted, 20);
    for (uint64_t ms = 0; ms < 10000; ms++)
        granted += rate_take(&rate, 10, 20, now_ns + ms * (SECOND / 1000));
    assert_in_range(granted, 20 + 99, 20 + 101);
    granted = 0;
    for (int i = 0; i < 100; i++)
        granted += rate_take(&rate, 10, 20, now_ns + 3600 * SECOND);
    assert_int_equal(granted, 20);
}

/* --- players -----------------------------------------------------------------------------------*/

static void test_players_are_known_by_their_keys(void **state)
{
    static struct players players;
    uint8_t key[PLAYERS_KEY_BYTES] = {0};
    char first[PLAYERS_KEY_MAX];
    (void)state;
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        key[0] = (uint8_t)(i + 1);
        struct player *player = players_join(&players, "Ann", key, 100 + i, SECOND);
        assert_non_null(player);
        assert_int_equal(player->number, i + 1);
        if (i == 0)
            memcpy(first, player->key, sizeof first);
    }
    assert_null(players_join(&players, "Bob", key, 1, SECOND));
    assert_int_equal(players_find(&players, first)->source, 100);
    assert_null(players_find(&players, ""));
    assert_null(players_find(&players, "00000000000000000000000000000000"));
    struct player *player = players_find(&players, first);
    player->vehicle = 12;
    assert_ptr_equal(players_driver_of(&players, 12), player);
    assert_null(players_driver_of(&players, 0));
    assert_true(players_is_active(player, SECOND + PLAYERS_HOLD_NS - 1));
    assert_false(players_is_active(player, SECOND + PLAYERS_HOLD_NS));
    player->number = 0; /* left */
    assert_null(players_find(&players, first));
    assert_non_null(players_join(&players, "Bob", key, 1, SECOND));
}

/* --- names of this server ----------------------------------------------------------------------*/

static void test_only_names_of_this_machine_are_ours(void **state)
{
    static const char *const ours[] = {"localhost", "localhost:8080", "127.0.0.1:1",
                                       "[::1]:80",  "LocalHost",      "127.0.0.2"};
    static const char *const others[] = {"evil.example",
                                         "localhost.evil.example",
                                         "",
                                         "127.0.0.1.evil.example",
                                         "127.evil.example",
                                         "[::1",
                                         "10.0.0.1"};
    (void)state;
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; i++)
        assert_true(http_host_local(ours[i]));
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        assert_false(http_host_local(others[i]));
    assert_true(http_host_numeric("10.0.0.1:8080"));
    assert_true(http_host_numeric("[fe80::1]:8080"));
    assert_false(http_host_numeric("evil.example"));
    assert_false(http_host_numeric("[evil.example]"));
    assert_true(http_origin_is("http://localhost:8080", "localhost:8080"));
    assert_false(http_origin_is("http://localhost:8081", "localhost:8080"));
    assert_false(http_origin_is("https://localhost:8080", "localhost:8080"));
    assert_false(http_origin_is("null", "localhost:8080"));
}

/* --- answers of a renderer ---------------------------------------------------------------------*/

static struct picture_copy *copy_of(const char *text)
{
    struct picture_copy *copy = calloc(1, sizeof *copy);
    assert_non_null(copy);
    copy->holders = 1;
    copy->bytes = strdup(text);
    copy->count = copy->room = strlen(text);
    return copy;
}

static void test_a_renderers_answer_is_read(void **state)
{
    struct picture_copy *copy =
        copy_of("HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\ncontent-length: 5\r\n"
                "X-Picture: 17\r\nX-Frame: 12\r\nX-Time: 0.2\r\n\r\nbytes");
    (void)state;
    assert_true(renderer_client_read(copy));
    assert_int_equal(copy->status, 200);
    assert_int_equal(copy->number, 17);
    assert_string_equal(copy->frame, "12");
    assert_int_equal(copy->body_bytes, 5);
    assert_memory_equal(copy->body, "bytes", 5);
    picture_proxy_release(copy);
}

static void test_what_is_no_answer_is_none(void **state)
{
    static const char *const wrong[] = {"",
                                        "HTTP/1.1 200 OK\r\n",
                                        "HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\nbytes",
                                        "HTTP/1.1 200 OK\r\n\r\nbytes",
                                        "HTTP/2 200 OK\r\nContent-Length: 0\r\n\r\n",
                                        "HTTP/1.1 999 OK\r\nContent-Length: 0\r\n\r\n",
                                        "\r\n\r\n"};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct picture_copy *copy = copy_of(wrong[i]);
        assert_false(renderer_client_read(copy));
        picture_proxy_release(copy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_are_short_and_right),
        cmocka_unit_test(test_words_are_escaped_and_commas_put),
        cmocka_unit_test(test_text_has_a_bound),
        cmocka_unit_test(test_keys_are_equal_or_not),
        cmocka_unit_test(test_a_token_file_is_made_kept_and_checked),
        cmocka_unit_test(test_a_rate_grants_a_burst_and_then_its_pace),
        cmocka_unit_test(test_players_are_known_by_their_keys),
        cmocka_unit_test(test_only_names_of_this_machine_are_ours),
        cmocka_unit_test(test_a_renderers_answer_is_read),
        cmocka_unit_test(test_what_is_no_answer_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
