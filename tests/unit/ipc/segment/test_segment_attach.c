/* Attaching refuses a damaged object and names the field. Page tables separate the roles. */
#include "ipc/segment/segment.h"

#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_check.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"

#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xxhash.h>

#include <cmocka.h>

#define SCENARIO                                                                                   \
    "objects = ( { kind = \"tree\"; at = [1000.0, 1000.0]; } );"                                   \
    "vehicles = ( { kind = \"tank\"; name = \"T\"; area = [3000.0, 3000.0, 4000.0, 4000.0]; },"    \
    "{ kind = \"truck\"; route = ( [1000.0, 2000.0], [2000.0, 2000.0] ); } );"                     \
    "fires = ( { at_s = 1.0; munition = \"artillery\"; point = [5000.0, 5000.0]; } );"

static char name[SEGMENT_NAME_MAX];
static struct segment_paths paths;
static struct error_text error;
static struct segment_header header; /* as published */
static struct layout layout;

static int make_world(void **state)
{
    struct view view;
    (void)state;
    named_world_make(name, SCENARIO);
    named_world_paths(&paths, name);
    if (segment_attach(&view, name, ROLE_NONE, &error) != 0)
        return -1;
    header = *view.header;
    layout = view.layout;
    segment_detach(&view);
    return 0;
}

static int remove_world(void **state)
{
    (void)state;
    named_world_remove(name);
    return 0;
}

static void patch(const void *bytes, size_t count, size_t offset)
{
    int fd = open(paths.object, O_RDWR | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_int_equal(pwrite(fd, bytes, count, (off_t)offset), count);
    close(fd);
}

static void put_header(const struct segment_header *h)
{
    patch(h, sizeof *h, 0);
}

/* A consistent header of another build, or a forged one. */
static void put_hashed(struct segment_header h)
{
    struct segment_header copy = h;
    copy.magic = 0;
    copy.head_hash = 0;
    h.head_hash = XXH3_64bits(&copy, sizeof copy);
    put_header(&h);
}

static void check_refused(const char *word)
{
    for (int i = 0; i < 2; i++) { /* as a reader and in a role */
        struct view view;
        if (segment_attach(&view, name, i == 0 ? ROLE_NONE : ROLE_MOVER, &error) == 0)
            fail_msg("attached; should be refused for its %s", word);
        if (!strstr(error.text, word))
            fail_msg("\"%s\" is not in: %s", word, error.text);
        assert_null(view.base);
        assert_int_equal(view.lock_fd, -1);
    }
}

static void check_attaches(void)
{
    struct view view;
    if (segment_attach(&view, name, ROLE_MOVER, &error) != 0)
        fail_msg("%s", error.text);
    segment_detach(&view);
}

/* --- the header --------------------------------------------------------------------------------*/

static void test_wrong_magic(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.magic = 0; /* never finished */
    put_header(&h);
    check_refused("magic");
}

static void test_wrong_version(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.version = SEGMENT_VERSION + 1;
    put_hashed(h);
    check_refused("version");
    assert_false(error.damaged);
}

static void test_other_layout(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.layout_hash ^= 1;
    put_hashed(h);
    check_refused("layout");
    h = header;
    h.header_bytes += 8;
    put_hashed(h);
    check_refused("layout");
}

static void test_counts_out_of_range(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.capacity = CAPACITY_MAX + 1;
    put_hashed(h);
    check_refused("counts");
    h = header;
    h.counts.posts_side = 0;
    put_hashed(h);
    check_refused("counts");
    h = header;
    h.event_slots = 3;
    put_hashed(h);
    check_refused("counts");
}

/* Kernels have pages of 4, 16 or 64 KiB, and a mapping begins at a page. */
static void test_regions_begin_where_any_kernel_can_map(void **state)
{
    static const size_t largest_page = 65536;
    (void)state;
    for (int region = 0; region < REGION_COUNT; region++) {
        if (layout.offset[region] % largest_page != 0)
            fail_msg("%s begins at byte %zu", region_name((enum region)region),
                     layout.offset[region]);
    }
    assert_int_equal(layout.total % largest_page, 0);
}

static void test_counts_that_do_not_fit_the_size(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.capacity *= 64;
    put_hashed(h);
    check_refused("size");
    h = header;
    h.total_bytes += 4096;
    put_hashed(h);
    check_refused("size");
}

static void test_header_damaged_in_many_bits(void **state)
{
    struct segment_header h = header;
    (void)state;
    h.static_hash[REGION_POSTS] = ~h.static_hash[REGION_POSTS];
    put_header(&h);
    check_refused("header is damaged");
    assert_true(error.damaged);
    put_header(&header);
    check_attaches();
}

/* --- the object --------------------------------------------------------------------------------*/

static void test_wrong_sizes(void **state)
{
    const size_t sizes[] = {0,
                            1,
                            sizeof(struct segment_header) - 1,
                            sizeof(struct segment_header),
                            4096,
                            layout.total - 4096,
                            layout.total - 1,
                            layout.total + 1,
                            layout.total + 4096};
    (void)state;
    for (size_t i = sizeof sizes / sizeof sizes[0];
         i-- > 0;) { /* smaller than the header comes last */
        assert_int_equal(truncate(paths.object, (off_t)sizes[i]), 0);
        check_refused("size");
        assert_true(error.damaged);
    }
}

static void test_wrong_mode(void **state)
{
    (void)state;
    assert_int_equal(chmod(paths.object, 0644), 0);
    check_refused("mode 644");
    assert_int_equal(chmod(paths.object, 0660), 0);
    check_refused("mode 660");
    assert_false(error.damaged); /* the world itself may be good */
    assert_int_equal(chmod(paths.object, 0600), 0);
    check_attaches();
}

static void test_wrong_owner(void **state)
{
    (void)state;
    if (geteuid() != 0)
        skip(); /* only root can change a file's owner */
    assert_int_equal(chown(paths.object, 12345, (gid_t)-1), 0);
    check_refused("belongs to user 12345");
    assert_int_equal(chown(paths.object, 0, (gid_t)-1), 0);
    check_attaches();
}

static void test_symbolic_link(void **state)
{
    char elsewhere[SEGMENT_PATH_MAX + 8];
    (void)state;
    snprintf(elsewhere, sizeof elsewhere, "%s.moved", paths.object);
    assert_int_equal(rename(paths.object, elsewhere), 0);
    assert_int_equal(symlink(elsewhere, paths.object), 0);
    check_refused("cannot open");
    assert_int_equal(unlink(paths.object), 0);
    assert_int_equal(rename(elsewhere, paths.object), 0);
    check_attaches();
}

static void test_symbolic_link_for_the_lock(void **state)
{
    char elsewhere[SEGMENT_PATH_MAX + 8];
    struct view view;
    (void)state;
    snprintf(elsewhere, sizeof elsewhere, "%s.moved", paths.lock);
    assert_int_equal(rename(paths.lock, elsewhere), 0);
    assert_int_equal(symlink(elsewhere, paths.lock), 0);
    assert_int_equal(segment_attach(&view, name, ROLE_MOVER, &error), -1);
    assert_non_null(strstr(error.text, "cannot open"));
    assert_int_equal(unlink(paths.lock), 0);
    assert_int_equal(rename(elsewhere, paths.lock), 0);
    check_attaches();
}

static void test_no_regular_file(void **state)
{
    (void)state;
    assert_int_equal(unlink(paths.object), 0);
    assert_int_equal(mkdir(paths.object, 0700), 0);
    struct view view;
    assert_int_equal(segment_attach(&view, name, ROLE_NONE, &error), -1);
    assert_non_null(strstr(error.text, "no shared-memory object"));
    assert_int_equal(rmdir(paths.object), 0);
}

static int attach_reader(void *context)
{
    struct view view;
    (void)context;
    return segment_attach(&view, name, ROLE_NONE, &error) == 0;
}

/* A pipe of that name has no writer, and opening it would block. */
static void test_pipe_does_not_block(void **state)
{
    int status = 0;
    (void)state;
    assert_int_equal(unlink(paths.object), 0);
    assert_int_equal(mkfifo(paths.object, 0600), 0);
    pid_t child = child_start(attach_reader, NULL);
    usleep(300000);
    int blocked = waitpid(child, &status, WNOHANG) == 0;
    if (blocked)
        child_kill(child);
    assert_int_equal(unlink(paths.object), 0);
    assert_false(blocked);
    assert_int_equal(status, 0);
}

static void test_damaged_static_regions_are_found_by_verify(void **state)
{
    (void)state;
    for (int region = REGION_KINDS; region < REGION_COMMIT; region++) {
        size_t bytes = layout.bytes[region], at = layout.offset[region] + bytes / 2;
        unsigned char byte;
        struct view view;
        if (bytes == 0)
            continue;
        int fd = open(paths.object, O_RDWR | O_CLOEXEC);
        assert_int_equal(pread(fd, &byte, 1, (off_t)at), 1);
        close(fd);
        byte ^= 4;
        patch(&byte, 1, at);
        assert_int_equal(segment_attach(&view, name, ROLE_NONE, &error), 0);
        if (segment_verify(&view, &error) == 0)
            fail_msg("%s", region_name((enum region)region));
        if (!strstr(error.text, region_name((enum region)region)))
            fail_msg("%s is not in: %s", region_name((enum region)region), error.text);
        byte ^= 4;
        patch(&byte, 1, at);
        assert_int_equal(segment_verify(&view, &error), 0);
        segment_detach(&view);
    }
}

/* --- page tables -------------------------------------------------------------------------------*/

struct probe {
    enum role role;
    size_t offset;
};

/* Reads a byte and writes it back, which changes nothing if writing is allowed. */
static int probe_write(void *context)
{
    const struct probe *probe = context;
    struct view view;
    if (segment_attach(&view, name, probe->role, &error) != 0)
        return 1;
    volatile unsigned char *at = (volatile unsigned char *)view.base + probe->offset;
    *at = *at;
    return 0;
}

static void check_probe(enum role role, enum region region, size_t offset)
{
    struct probe probe = {role, offset};
    int wanted = layout_writable(role, region) ? 0 : -SIGSEGV;
    int result = child_run(probe_write, &probe);
    if (result != wanted)
        fail_msg("%s at %s: %d, not %d", role_name(role), region_name(region), result, wanted);
}

static void test_writing_where_a_role_may_not_faults(void **state)
{
    (void)state;
    for (int role = 0; role <= ROLE_NONE; role++) {
        for (int region = 0; region < REGION_COUNT; region++) {
            size_t bytes = layout.bytes[region];
            if (bytes == 0)
                continue;
            check_probe((enum role)role, (enum region)region, layout.offset[region]);
            if (role == ROLE_MOVER || role == ROLE_COLLIDER) /* and at the region's other end */
                check_probe((enum role)role, (enum region)region,
                            layout.offset[region] + bytes - 1);
        }
    }
}

/* A read-only mapping cannot be made writable by mprotect() either. */
static int make_writable(void *context)
{
    const struct probe *probe = context;
    struct view view;
    if (segment_attach(&view, name, probe->role, &error) != 0)
        return 2;
    return mprotect((unsigned char *)view.base + probe->offset, 1, PROT_READ | PROT_WRITE) == 0;
}

static void test_read_only_regions_stay_read_only(void **state)
{
    (void)state;
    for (int role = 0; role <= ROLE_NONE; role++) {
        for (int region = 0; region < REGION_COUNT; region++) {
            struct probe probe = {(enum role)role, layout.offset[region]};
            if (layout.bytes[region] == 0)
                continue;
            int wanted = layout_writable((enum role)role, (enum region)region);
            int result = child_run(make_writable, &probe);
            if (result != wanted)
                fail_msg("%s at %s: %d, not %d", role_name((enum role)role),
                         region_name((enum region)region), result, wanted);
        }
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_world, remove_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_wrong_magic),
        TEST(test_wrong_version),
        TEST(test_other_layout),
        TEST(test_regions_begin_where_any_kernel_can_map),
        TEST(test_counts_out_of_range),
        TEST(test_counts_that_do_not_fit_the_size),
        TEST(test_header_damaged_in_many_bits),
        TEST(test_wrong_sizes),
        TEST(test_wrong_mode),
        TEST(test_wrong_owner),
        TEST(test_symbolic_link),
        TEST(test_symbolic_link_for_the_lock),
        TEST(test_no_regular_file),
        TEST(test_pipe_does_not_block),
        TEST(test_damaged_static_regions_are_found_by_verify),
        TEST(test_writing_where_a_role_may_not_faults),
        TEST(test_read_only_regions_stay_read_only),
    };
    return cmocka_run_group_tests(tests, NULL, named_world_check_left);
}
