/* Sorting in place: world/maths/sort.h. */
#include "world/maths/sort.h"

#include "world/maths/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MOST 20000u

struct words {
    uint32_t first, second;
};

static int compare(const void *p, const void *q)
{
    const struct words *a = p, *b = q;
    if (a->first != b->first)
        return a->first < b->first ? -1 : 1;
    return (a->second > b->second) - (a->second < b->second);
}

static uint64_t drawn;

static uint32_t draw(void)
{
    return (uint32_t)(random_mix(++drawn) >> 32);
}

enum shape { ANY, FEW_VALUES, ONE_BYTE, ASCENDING, DESCENDING, EQUAL, SHAPES };

static struct words draw_words(enum shape shape, uint32_t i, uint32_t count)
{
    switch (shape) {
    case FEW_VALUES:
        return (struct words){draw() % 3, draw() % 5};
    case ONE_BYTE:
        return (struct words){0, (draw() & 0xffu) << 24 | 7u};
    case ASCENDING:
        return (struct words){i, i};
    case DESCENDING:
        return (struct words){count - i, UINT32_MAX - i};
    case EQUAL:
        return (struct words){UINT32_MAX, UINT32_MAX};
    default:
        return (struct words){draw(), draw()};
    }
}

static void check(enum shape shape, uint32_t count)
{
    static struct words sorted[MOST], wanted[MOST];
    for (uint32_t i = 0; i < count; i++)
        sorted[i] = wanted[i] = draw_words(shape, i, count);
    sort_words(sorted, count);
    qsort(wanted, count, sizeof wanted[0], compare);
    if (count > 0 && memcmp(sorted, wanted, count * sizeof wanted[0]) != 0)
        fail_msg("shape %d, %u records are not in order", (int)shape, count);
}

static void test_records_come_as_the_c_library_sorts_them(void **state)
{
    (void)state;
    for (int shape = 0; shape < SHAPES; shape++) {
        for (uint32_t count = 0; count < 200; count++)
            check((enum shape)shape, count);
        for (uint32_t count = 256; count <= MOST; count = count * 3 + 1)
            check((enum shape)shape, count);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_records_come_as_the_c_library_sorts_them),
    };
    return cmocka_run_group_tests_name("sort", tests, NULL, NULL);
}
