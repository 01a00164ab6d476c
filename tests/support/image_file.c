/* Image files for tests. */
#include "tests/support/image_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[64];
static pid_t owner;

static int remove_one(const char *path, const struct stat *status, int type, struct FTW *where)
{
    (void)status, (void)type, (void)where;
    return remove(path);
}

static void remove_folder(void)
{
    if (getpid() == owner)
        nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

const char *image_file_path(char path[PATH_MAX], const char *name)
{
    if (folder[0] == '\0') {
        snprintf(folder, sizeof folder, "/tmp/jolon-image-XXXXXX");
        assert_non_null(mkdtemp(folder));
        owner = getpid();
        atexit(remove_folder);
    }
    snprintf(path, PATH_MAX, "%s/%s", folder, name);
    return path;
}

int image_file_count(void)
{
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

void image_file_save(struct view *view, const char *path, bool inputs)
{
    struct image_place place;
    struct capture capture;
    struct error_text error;
    assert_int_equal(capture_init(&capture, view), 0);
    assert_int_equal(capture_take(&capture, view, inputs), 0);
    if (image_place_open(&place, path, &error) != 0 ||
        image_write(&place, view, &capture, NULL, &error) != 0)
        fail_msg("%s", error.text);
    image_place_close(&place);
    capture_free(&capture);
}

void image_file_load(struct view *view, const char *path)
{
    struct image image;
    struct error_text error;
    if (image_open(&image, path, &error) != 0)
        fail_msg("%s", error.text);
    struct segment_header header = image_segment(&image);
    if (segment_private(view, &header, &error) != 0 || image_load(view, &image, &error) != 0)
        fail_msg("%s", error.text);
    image_close(&image);
}

unsigned char *image_file_bytes(const char *path, size_t *bytes)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_int_equal(fstat(fd, &status), 0);
    *bytes = (size_t)status.st_size;
    unsigned char *memory = malloc(*bytes);
    assert_non_null(memory);
    assert_int_equal(read(fd, memory, *bytes), *bytes);
    close(fd);
    return memory;
}

void image_file_put(const char *path, const void *bytes, size_t count)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    assert_true(fd >= 0);
    assert_int_equal(ftruncate(fd, (off_t)count),
                     0); /* truncated afterwards, because freeing the blocks each time is slow */
    assert_int_equal(write(fd, bytes, count), count);
    close(fd);
}

void image_file_run(struct view *view, uint64_t frame)
{
    struct frame_stepper stepper;
    assert_int_equal(frame_stepper_init(&stepper, view, 1), 0);
    while (frame_stepper_frame(&stepper) < frame)
        frame_stepper_step(&stepper, NULL);
    frame_stepper_free(&stepper);
}

uint64_t image_file_digest(const struct view *view)
{
    const struct state *state = &view->w[atomic_load(&view->commit->commit) & 1];
    return state_digest(&view->world, state);
}
