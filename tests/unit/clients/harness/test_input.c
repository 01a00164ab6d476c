/* Lines of standard input: in whatever pieces they come, none is lost or split, and a line that is
 * too long is reported and dropped. */
#include "clients/harness/input.c"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static struct input input;
static char line[INPUT_LINE_MAX + 1];

/* As much as there is room for, as a read would bring it. */
static size_t feed(const char *bytes, size_t size)
{
    size_t room = INPUT_LINE_MAX - input.used;
    size = size < room ? size : room;
    memcpy(input.bytes + input.used, bytes, size);
    input.used += size;
    return size;
}

static void test_pieces(void **state)
{
    size_t bytes;
    (void)state;
    memset(&input, 0, sizeof input);
    (void)feed("one\ntw", 6);
    assert_int_equal(input_next(&input, line, &bytes), INPUT_LINE);
    assert_string_equal(line, "one");
    assert_int_equal(input.line, 1);
    assert_int_equal(input_next(&input, line, &bytes), INPUT_NONE);
    (void)feed("o\n\nlast", 7);
    assert_int_equal(input_next(&input, line, &bytes), INPUT_LINE);
    assert_string_equal(line, "two");
    assert_int_equal(input_next(&input, line, &bytes), INPUT_LINE);
    assert_int_equal(bytes, 0);
    assert_int_equal(input_next(&input, line, &bytes), INPUT_NONE);
    input.ended = true;
    assert_int_equal(input_next(&input, line, &bytes), INPUT_LINE);
    assert_string_equal(line, "last");
    assert_int_equal(input.line, 4);
    assert_int_equal(input_next(&input, line, &bytes), INPUT_NONE);
}

/* Lines of random lengths, some too long, in random pieces: each comes once, by its number. */
static void test_any_pieces(void **state)
{
    enum { LINES = 300 };
    static char text[LINES * 2000 + 4 * INPUT_LINE_MAX];
    static size_t length[LINES + 1];
    size_t size = 0, fed = 0, bytes;
    unsigned seed = (unsigned)fixture_seed(11), seen = 0;
    (void)state;
    for (size_t i = 1; i <= LINES; i++) {
        length[i] = i % 100 == 0 ? INPUT_LINE_MAX + (size_t)(rand_r(&seed) % 3) - 1
                                 : (size_t)(rand_r(&seed) % 2000);
        memset(text + size, (int)('a' + i % 26), length[i]);
        size += length[i];
        text[size++] = '\n';
    }
    memset(&input, 0, sizeof input);
    while (fed < size || input.used) {
        size_t piece = (size_t)(rand_r(&seed) % 9000);
        fed += feed(text + fed, piece < size - fed ? piece : size - fed);
        input.ended = fed == size;
        enum input_result result;
        while ((result = input_next(&input, line, &bytes)) != INPUT_NONE) {
            assert_int_equal(input.line, ++seen);
            bool fits = length[seen] < INPUT_LINE_MAX;
            assert_int_equal(result, fits ? INPUT_LINE : INPUT_TOO_LONG);
            if (fits) {
                assert_int_equal(bytes, length[seen]);
                assert_true(!bytes || (line[0] == (char)('a' + seen % 26) &&
                                       line[bytes - 1] == line[0] && !line[bytes]));
            }
        }
    }
    assert_int_equal(seen, LINES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_any_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
