/* The file of an image: what it may replace, and that it is whole at any time. */
#include "recorder/archive/image_write.h"

#include "recorder/archive/image_read.h"
#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/image_file.h"

#include <errno.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static struct view view;
static char path[PATH_MAX];

/* Fills rows with values that pack badly, so that the file is some kilobytes larger than the
 * header. */
static void make_frame(void)
{
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    struct state *next = bare_view_begin(&collider);
    next->head->used = 64;
    for (uint32_t i = 0; i < 64; i++) {
        next->entities.row[i].x = 1.0 / (double)(next->head->frame * 64 + i);
        next->entities.row[i].y = next->entities.row[i].x * 1.7;
        next->entities.row[i].z = next->entities.row[i].x * 3.1;
    }
    bare_view_end(&collider);
}

static int make_view(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 64, .event_slots = 64, .events_per_frame = 8, .command_slots = 4};
    (void)state;
    bare_view_make(&view, &sizes);
    make_frame();
    image_file_path(path, "world.image");
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    remove(path);
    segment_abandon(&view);
    return 0;
}

static uint64_t frame_at_path(void)
{
    struct image_header header;
    struct error_text error;
    if (image_peek(&header, path, &error) != 0)
        fail_msg("%s", error.text);
    return header.frame;
}

static void assert_place_refused(const char *where, const char *says)
{
    struct image_place place;
    struct error_text error;
    assert_int_equal(image_place_open(&place, where, &error), -1);
    if (!strstr(error.text, says))
        fail_msg("\"%s\" does not say \"%s\"", error.text, says);
}

static void test_file_is_private(void **state)
{
    struct stat status;
    (void)state;
    image_file_save(&view, path, false);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0600);
    assert_int_equal(image_file_count(), 1);
}

static void test_only_plain_files_are_replaced(void **state)
{
    char other[PATH_MAX], target[PATH_MAX];
    struct error_text error;
    struct image image;
    (void)state;
    image_file_path(target, "target");
    image_file_path(other, "link");
    assert_int_equal(symlink(target, other), 0);
    assert_place_refused(other, "a symbolic link");
    assert_int_equal(image_open(&image, other, &error), -1);
    assert_non_null(strstr(error.text, "a symbolic link"));
    unlink(other);
    image_file_path(other, "pipe");
    assert_int_equal(mkfifo(other, 0600), 0);
    assert_place_refused(other, "a device or pipe");
    assert_int_equal(image_open(&image, other, &error), -1); /* and the open does not block */
    unlink(other);
    image_file_path(other, "folder");
    assert_int_equal(mkdir(other, 0700), 0);
    assert_place_refused(other, "a folder");
    assert_int_equal(image_open(&image, other, &error), -1);
    rmdir(other);
    assert_place_refused("/dev/null", "a device");
    assert_place_refused("/no/such/folder/image", "folder");
    assert_place_refused("/tmp/", "name");
    assert_int_equal(image_file_count(), 0);
}

static void test_later_link_is_not_followed(void **state)
{
    char target[PATH_MAX];
    struct image_place place;
    struct capture capture;
    struct error_text error;
    (void)state;
    image_file_path(target, "target");
    assert_int_equal(image_place_open(&place, path, &error), 0);
    assert_int_equal(symlink(target, path), 0);
    assert_int_equal(capture_init(&capture, &view), 0);
    assert_int_equal(capture_take(&capture, &view, false), 0);
    assert_int_equal(image_write(&place, &view, &capture, NULL, &error), -1);
    assert_non_null(strstr(error.text, "a symbolic link"));
    assert_int_not_equal(access(target, F_OK), 0);
    capture_free(&capture);
    image_place_close(&place);
}

static void test_files_of_dead_writers_are_removed(void **state)
{
    char dead[PATH_MAX + 16], alive[PATH_MAX + 16], other[PATH_MAX + 16];
    pid_t gone = fork();
    (void)state;
    if (gone == 0)
        _exit(0);
    assert_int_equal(waitpid(gone, NULL, 0), gone);
    snprintf(dead, sizeof dead, "%s.new-%d", path, (int)gone);
    snprintf(alive, sizeof alive, "%s.new-%d", path, (int)getppid());
    snprintf(other, sizeof other, "%s.new-plan", path);
    image_file_put(dead, "x", 1);
    image_file_put(alive, "x", 1);
    image_file_put(other, "x", 1);
    image_file_save(&view, path, false);
    assert_int_not_equal(access(dead, F_OK), 0);
    assert_int_equal(unlink(alive), 0);
    assert_int_equal(unlink(other), 0);
}

/* --- no room, and killed -----------------------------------------------------------------------*/

struct attempt {
    rlim_t room; /* limit of the file size [byte] */
    bool killed; /* true: SIGXFSZ kills the writer at the limit; false: the write fails */
};

/* Writes the file under a size limit. Returns 0: written, 1: refused, 2: a wrong refusal. */
static int write_with_little_room(void *context)
{
    const struct attempt *attempt = context;
    const struct rlimit limit = {attempt->room, attempt->room};
    struct image_place place;
    struct capture capture;
    struct error_text error;
    signal(SIGXFSZ, attempt->killed ? SIG_DFL : SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    if (image_place_open(&place, path, &error) != 0 || capture_init(&capture, &view) != 0 ||
        capture_take(&capture, &view, false) != 0)
        return 3;
    if (image_write(&place, &view, &capture, NULL, &error) == 0)
        return 0;
    return strstr(error.text, "no room") && strstr(error.text, "as it was") ? 1 : 2;
}

static void test_without_room_the_old_file_stays(void **state)
{
    size_t bytes;
    (void)state;
    image_file_save(&view, path, false);
    free(image_file_bytes(path, &bytes));
    make_frame();
    for (size_t room = 0; room < bytes; room += 1 + bytes / 40) {
        struct attempt attempt = {room, false};
        assert_int_equal(child_run(write_with_little_room, &attempt), 1);
        assert_int_equal(frame_at_path(), 1);
        assert_int_equal(image_file_count(), 1); /* and no temporary file is left */
    }
    struct attempt enough = {bytes + 4096, false};
    assert_int_equal(child_run(write_with_little_room, &enough), 0);
    assert_int_equal(frame_at_path(), 2);
}

static void test_killed_while_writing_leaves_the_old_file(void **state)
{
    size_t bytes;
    (void)state;
    image_file_save(&view, path, false);
    free(image_file_bytes(path, &bytes));
    make_frame();
    for (size_t room = 0; room < bytes; room += 1 + bytes / 40) {
        struct attempt attempt = {room, true};
        assert_int_equal(child_run(write_with_little_room, &attempt), -SIGXFSZ);
        assert_int_equal(frame_at_path(), 1);
        assert_int_equal(image_file_count(), 2); /* the next writer removes the temporary file */
    }
    image_file_save(&view, path, false);
    assert_int_equal(frame_at_path(), 2);
    assert_int_equal(image_file_count(), 1);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_file_is_private),
        TEST(test_only_plain_files_are_replaced),
        TEST(test_later_link_is_not_followed),
        TEST(test_files_of_dead_writers_are_removed),
        TEST(test_without_room_the_old_file_stays),
        TEST(test_killed_while_writing_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
