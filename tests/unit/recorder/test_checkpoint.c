/* Checkpoints: written when due, not lost by a kill, and never blocking the run. */
#include "recorder/checkpoint.h"

#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/image_file.h"

#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

static struct view view;
static char path[PATH_MAX];

static int make_view(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 8, .event_slots = 64, .events_per_frame = 8, .command_slots = 4};
    (void)state;
    bare_view_make(&view, &sizes);
    image_file_path(path, "checkpoint");
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    unlink(path);
    segment_abandon(&view);
    return 0;
}

static void make_frames(unsigned count)
{
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    while (count-- > 0) {
        bare_view_begin(&collider);
        bare_view_end(&collider);
    }
}

static struct view recorder(void)
{
    return bare_view_as(&view, ROLE_RECORDER);
}

static void open_checkpoint(struct checkpoint *checkpoint, uint64_t every)
{
    struct error_text error;
    if (checkpoint_open(checkpoint, &view, path, every, &error) != 0)
        fail_msg("%s", error.text);
}

/* The frame of the checkpoint in the file; 0: there is none. */
static uint64_t frame_of_file(void)
{
    struct image_header header;
    struct error_text error;
    return image_peek(&header, path, &error) == 0 ? header.frame : 0;
}

static void test_checkpoint_is_written_every_n_frames(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    open_checkpoint(&checkpoint, 10);
    for (unsigned frame = 0; frame <= 35; frame++) {
        checkpoint_write_if_due(&checkpoint, &view_of_role);
        checkpoint_write_if_due(&checkpoint, &view_of_role); /* a second call writes nothing */
        assert_int_equal(checkpoint.written, frame / 10);
        assert_int_equal(frame_of_file(), frame / 10 * 10);
        make_frames(1);
    }
    checkpoint_close(&checkpoint);
}

static void test_late_call_writes_one_and_continues_at_next_multiple(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    open_checkpoint(&checkpoint, 10);
    make_frames(47);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.written, 1);
    assert_int_equal(frame_of_file(), 47);
    make_frames(2);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.written, 1);
    make_frames(1);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(frame_of_file(), 50);
    checkpoint_close(&checkpoint);
}

/* The role was killed and restarted after a multiple had passed: the checkpoint is written at
 * once. */
static void test_restart_does_not_skip_one(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    make_frames(13);
    open_checkpoint(&checkpoint, 10); /* no file: no checkpoint was missed */
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.written, 0);
    make_frames(8);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(frame_of_file(), 21);
    checkpoint_close(&checkpoint);
    make_frames(12);
    open_checkpoint(&checkpoint, 10);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(frame_of_file(), 33);
    checkpoint_close(&checkpoint);
}

static void test_file_of_another_world_is_not_continued(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    make_frames(3);
    image_file_save(&view, path, false);
    drop_view(NULL);
    make_view(NULL);
    make_frames(15);
    open_checkpoint(&checkpoint, 10);
    view_of_role = recorder();
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.written, 0);
    checkpoint_close(&checkpoint);
}

static void test_role_beats_while_writing(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    open_checkpoint(&checkpoint, 1);
    make_frames(1);
    atomic_store(&view.slot[ROLE_RECORDER]->beat_ns, 0);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.written, 1);
    assert_true(atomic_load(&view.slot[ROLE_RECORDER]->beat_ns) > 0);
    checkpoint_close(&checkpoint);
}

/* Writes at frame 10 with room, at 20 without, at 30 with room again. */
static int fill_the_disk(void *context)
{
    const struct rlimit none = {100, RLIM_INFINITY}, all = {RLIM_INFINITY, RLIM_INFINITY};
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    struct error_text error;
    (void)context;
    dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
    signal(SIGXFSZ, SIG_IGN);
    if (checkpoint_open(&checkpoint, &view, path, 10, &error) != 0)
        return 10;
    make_frames(10);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    if (checkpoint.written != 1 || frame_of_file() != 10)
        return 11;
    setrlimit(RLIMIT_FSIZE, &none);
    make_frames(10);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    if (checkpoint.written != 1 || checkpoint.failed != 1 || frame_of_file() != 10)
        return 12;
    setrlimit(RLIMIT_FSIZE, &all);
    make_frames(9);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    if (checkpoint.written != 1)
        return 13; /* not before the next multiple */
    make_frames(1);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    return checkpoint.written == 2 && frame_of_file() == 30 ? 0 : 14;
}

static void test_full_disk_keeps_the_old_file_and_is_tried_again(void **state)
{
    (void)state;
    assert_int_equal(child_run(fill_the_disk, NULL), 0);
    assert_int_equal(frame_of_file(), 30);
    assert_int_equal(image_file_count(), 1);
}

static void test_damaged_world_replaces_no_image(void **state)
{
    struct checkpoint checkpoint;
    struct view view_of_role = recorder();
    (void)state;
    open_checkpoint(&checkpoint, 10);
    make_frames(10);
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    make_frames(10);
    view.w[0].head->event_digest ^= 1;
    checkpoint_write_if_due(&checkpoint, &view_of_role);
    assert_int_equal(checkpoint.failed, 1);
    assert_int_equal(frame_of_file(), 10);
    checkpoint_close(&checkpoint);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_checkpoint_is_written_every_n_frames),
        TEST(test_late_call_writes_one_and_continues_at_next_multiple),
        TEST(test_restart_does_not_skip_one),
        TEST(test_file_of_another_world_is_not_continued),
        TEST(test_role_beats_while_writing),
        TEST(test_full_disk_keeps_the_old_file_and_is_tried_again),
        TEST(test_damaged_world_replaces_no_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
