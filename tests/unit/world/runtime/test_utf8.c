/* Text in UTF-8: what is a character, what of it can be seen, and what is cut from a line. */
#include "world/runtime/utf8.h"

#include "ipc/segment/segment.h"
#include "world/runtime/error_text.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void test_every_character_is_read_and_nothing_else(void **state)
{
    (void)state;
    for (uint32_t code = 0; code <= 0x10ffff; code++) {
        char text[5] = {0};
        uint32_t read = UINT32_MAX;
        size_t bytes = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
        text[0] = (char)(bytes == 1 ? code : (0xf0u << (4 - bytes)) | code >> 6 * (bytes - 1));
        for (size_t i = 1; i < bytes; i++)
            text[i] = (char)(0x80 | (code >> 6 * (bytes - 1 - i) & 0x3f));
        bool surrogate = code >= 0xd800 && code <= 0xdfff;
        assert_int_equal(utf8_read(text, &read), surrogate ? 0 : bytes);
        assert_true(surrogate || read == code);
    }
}

static void test_what_is_no_character_is_not_read(void **state)
{
    static const char *const none[] = {"\x80",
                                       "\xc3",
                                       "\xc0\xaf",
                                       "\xe0\x80\xaf",
                                       "\xed\xa0\x80",
                                       "\xe2\x80",
                                       "\xf0\x80\x80\xaf",
                                       "\xf4\x90\x80\x80",
                                       "\xf8\x88",
                                       "\xff",
                                       "\xc3(",
                                       "\xe2\x80("};
    uint32_t code;
    (void)state;
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        assert_int_equal(utf8_read(none[i], &code), 0);
}

static void test_what_cannot_be_seen_is_told(void **state)
{
    static const uint32_t hidden[] = {0,      '\n',   0x7f,   0x85,    0xa0,    0xad,
                                      0x61c,  0x200b, 0x200f, 0x2028,  0x202e,  0x2066,
                                      0x3000, 0x3164, 0xe000, 0xfe0f,  0xfeff,  0xffff,
                                      0x2800, 0x1160, 0x180e, 0xe0041, 0x10ffff};
    static const uint32_t seen[] = {' ',   'A',   '~',    0xe9,   0x3a9,  0x439,
                                    0x5d0, 0x628, 0x4e2d, 0xac00, 0x1f600};
    (void)state;
    for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++)
        assert_false(utf8_visible(hidden[i]));
    for (size_t i = 0; i < sizeof seen / sizeof seen[0]; i++)
        assert_true(utf8_visible(seen[i]));
}

static void mends(const char *from, const char *to)
{
    char text[64];
    snprintf(text, sizeof text, "%s", from);
    assert_int_equal(utf8_mend(text), strlen(to));
    assert_string_equal(text, to);
}

static void test_a_text_is_mended(void **state)
{
    (void)state;
    mends("", "");
    mends("J\xc3\xbcrgen", "J\xc3\xbcrgen");
    mends("J\xc3", "J");                     /* cut at the end */
    mends("\"J\xc3\": none", "\"J\": none"); /* and within */
    mends("\xf0\x9f\x98", "");
    mends("a\xff\x80z", "a??z");
    mends("\xc0\xaf", "??");
}

__attribute__((format(printf, 3, 4))) static void format_into(char *text, size_t bytes,
                                                              const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)utf8_format(text, bytes, format, arguments);
    va_end(arguments);
}

/* Every place that cuts a line: none leaves half a character, whatever the room. */
static void test_errors_are_cut_between_characters(void **state)
{
    static struct error_text error;
    static char cries[sizeof error.text + 8];
    uint32_t code;
    (void)state;
    memset(cries, 0, sizeof cries);
    for (size_t i = 0; i + 2 < sizeof cries; i += 2)
        memcpy(cries + i, "\xc3\xa9", 2);
    for (int odd = 0; odd < 2; odd++) {
        error_text_set(&error, "%s%s", odd ? "x" : "", cries);
        size_t length = strlen(error.text);
        assert_true(length >= sizeof error.text - 3);
        assert_int_equal(utf8_read(error.text + length - 2, &code), 2);
    }
    for (size_t room = 1; room < 12; room++) {
        char text[12];
        format_into(text, room, "%s", cries);
        assert_int_equal(strlen(text), (room - 1) / 2 * 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_character_is_read_and_nothing_else),
        cmocka_unit_test(test_what_is_no_character_is_not_read),
        cmocka_unit_test(test_what_cannot_be_seen_is_told),
        cmocka_unit_test(test_a_text_is_mended),
        cmocka_unit_test(test_errors_are_cut_between_characters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
