/* Pages taken before they are needed: they are there, and hold what they held. */
#include "world/runtime/prefault.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#define PAGES 16u

static size_t page;
static unsigned char *memory;

static int map_pages(void **state)
{
    (void)state;
    page = (size_t)sysconf(_SC_PAGESIZE);
    memory = mmap(NULL, PAGES * page, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(memory != MAP_FAILED);
    return 0;
}

static int unmap_pages(void **state)
{
    (void)state;
    munmap(memory, PAGES * page);
    return 0;
}

static bool is_there(uint32_t n)
{
    unsigned char resident = 0;
    assert_int_equal(mincore(memory + n * page, page, &resident), 0);
    return resident & 1;
}

/* Linux before 5.14 does not know the advice. */
static bool kernel_can(void)
{
    return madvise(memory, page, 23) == 0;
}

static void test_pages_are_there_before_they_are_used(void **state)
{
    (void)state;
    memory[10 * page + 7] = 77;
    if (!kernel_can())
        skip();
    assert_false(is_there(3) || is_there(5));
    prefault_shared(memory + 3 * page + 100, 2 * page); /* it lies in three pages */
    assert_true(is_there(3) && is_there(4) && is_there(5));
    assert_false(is_there(2) || is_there(6));
    prefault_own(memory + 8 * page, 4 * page);
    assert_true(is_there(8) && is_there(9) && is_there(10) && is_there(11));
    prefault_readable(memory + 14 * page, 1);
    assert_true(is_there(14));
    for (size_t i = 0; i < PAGES * page; i++)
        assert_int_equal(memory[i], i == 10 * page + 7 ? 77 : 0);
}

static void test_what_the_kernel_refuses_does_no_harm(void **state)
{
    (void)state;
    memory[0] = 5;
    prefault_own(memory, 0);
    assert_int_equal(mprotect(memory, PAGES * page, PROT_READ), 0);
    prefault_shared(memory, PAGES * page);
    assert_int_equal(memory[0], 5);
    munmap(memory + page, page);
    prefault_readable(memory, PAGES * page);
    prefault_own(memory, (size_t)8 << 20);
    assert_int_equal(memory[0], 5);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, map_pages, unmap_pages)
    const struct CMUnitTest tests[] = {
        TEST(test_pages_are_there_before_they_are_used),
        TEST(test_what_the_kernel_refuses_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
