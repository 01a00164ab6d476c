/* Large pages: where mappings begin, what is moved into them, and that nothing is lost. */
#include "world/runtime/large_pages.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#define LARGE ((size_t)2 << 20)

/* Returns the bytes of the mapping around memory that a line of smaps counts. */
static size_t counted(const void *memory, const char *what)
{
    char line[512];
    unsigned long long first = 0, end = 0, kilobytes = 0;
    size_t found = 0;
    int within = 0;
    FILE *file = fopen("/proc/self/smaps", "re");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        if (sscanf(line, "%llx-%llx ", &first, &end) == 2)
            within = first <= (uintptr_t)memory && (uintptr_t)memory < end;
        else if (within && strncmp(line, what, strlen(what)) == 0 &&
                 sscanf(line + strlen(what), ": %llu", &kilobytes) == 1)
            found = (size_t)kilobytes << 10;
    }
    fclose(file);
    return found;
}

/* Linux before 6.1 has no such advice, and some have no large pages of shared memory. */
static int kernel_can(void)
{
    char *memory = large_pages_map(LARGE, PROT_READ | PROT_WRITE, -1);
    assert_true(memory != MAP_FAILED);
    memory[0] = 1;
    int can = madvise(memory, LARGE, 25) == 0;
    munmap(memory, LARGE);
    return can;
}

/* Returns new shared memory, or skips the test where the kernel cannot. */
static void *map_or_skip(size_t bytes)
{
    if (!kernel_can()) {
        print_message("this kernel has no large pages of shared memory\n");
        skip();
    }
    void *memory = large_pages_map(bytes, PROT_READ | PROT_WRITE, -1);
    assert_true(memory != MAP_FAILED);
    return memory;
}

static void test_a_mapping_begins_where_a_large_page_does(void **state)
{
    const size_t sizes[] = {1, 4096, 5000, LARGE, 3 * LARGE + 4096};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        char *memory = large_pages_map(sizes[i], PROT_READ | PROT_WRITE, -1);
        assert_true(memory != MAP_FAILED);
        assert_int_equal((uintptr_t)memory % LARGE, 0);
        memory[0] = memory[sizes[i] - 1] = 7;
        size_t end = (sizes[i] + 4095) / 4096 * 4096;
        assert_int_equal(msync(memory + end - 4096, 4096, MS_ASYNC), 0);
        assert_true(msync(memory + end, 4096, MS_ASYNC) != 0); /* nothing is left behind it */
        munmap(memory, sizes[i]);
    }
}

static void test_an_object_is_mapped_from_its_start(void **state)
{
    char byte = 0;
    int fd = memfd_create("object", MFD_CLOEXEC);
    (void)state;
    assert_true(fd >= 0);
    assert_int_equal(ftruncate(fd, 8192), 0);
    char *memory = large_pages_map(8192, PROT_READ | PROT_WRITE, fd);
    assert_true(memory != MAP_FAILED);
    memory[5000] = 9;
    assert_int_equal(pread(fd, &byte, 1, 5000), 1);
    assert_int_equal(byte, 9);
    munmap(memory, 8192);
    close(fd);
    errno = 0;
    assert_ptr_equal(large_pages_map(8192, PROT_READ, fd), MAP_FAILED);
    assert_int_equal(errno, EBADF);
}

static void test_shared_memory_moves_into_large_pages(void **state)
{
    const size_t bytes = 4 * LARGE;
    (void)state;
    uint32_t *memory = map_or_skip(bytes);
    for (size_t i = 0; i < bytes / sizeof *memory; i++)
        memory[i] = (uint32_t)i * 2654435761u;
    assert_int_equal(counted(memory, "ShmemPmdMapped"), 0);
    large_pages_collapse(memory, LARGE_PAGES_LEAST_BYTES - 1); /* too little to gain by them */
    assert_int_equal(counted(memory, "ShmemPmdMapped"), 0);
    large_pages_collapse((char *)memory + LARGE + 5, LARGE); /* it lies in two */
    assert_int_equal(counted(memory, "ShmemPmdMapped"), 2 * LARGE);
    for (size_t i = 0; i < bytes / sizeof *memory; i++)
        assert_int_equal(memory[i], (uint32_t)i * 2654435761u);
    munmap(memory, bytes);
}

/* The stages map the parts of a segment that they may write over the rest. */
static void test_other_parts_move_where_one_is_mapped_apart(void **state)
{
    const size_t bytes = 4 * LARGE;
    (void)state;
    char *memory = map_or_skip(bytes);
    memset(memory, 3, bytes);
    assert_int_equal(mprotect(memory, LARGE / 2, PROT_READ), 0);
    large_pages_collapse(memory, bytes);
    assert_int_equal(counted(memory + LARGE, "ShmemPmdMapped"), 3 * LARGE);
    for (size_t i = 0; i < bytes; i += 4096)
        assert_int_equal(memory[i], 3);
    munmap(memory, bytes);
}

static void test_what_the_kernel_refuses_does_no_harm(void **state)
{
    char *memory = large_pages_map(2 * LARGE, PROT_READ | PROT_WRITE, -1);
    (void)state;
    assert_true(memory != MAP_FAILED);
    memset(memory, 5, 2 * LARGE);
    munmap(memory + LARGE, LARGE / 2);
    large_pages_collapse(memory, 2 * LARGE);
    large_pages_advise(memory, 2 * LARGE);
    assert_int_equal(memory[LARGE - 1], 5);
    assert_int_equal(memory[2 * LARGE - 1], 5);
    munmap(memory, 2 * LARGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_mapping_begins_where_a_large_page_does),
        cmocka_unit_test(test_an_object_is_mapped_from_its_start),
        cmocka_unit_test(test_shared_memory_moves_into_large_pages),
        cmocka_unit_test(test_other_parts_move_where_one_is_mapped_apart),
        cmocka_unit_test(test_what_the_kernel_refuses_does_no_harm),
    };
    return cmocka_run_group_tests_name("large pages", tests, NULL, NULL);
}
