/* Answers of a renderer: what is read from them, and what is none. */
#include "clients/console/renderer_client.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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
        cmocka_unit_test(test_a_renderers_answer_is_read),
        cmocka_unit_test(test_what_is_no_answer_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
