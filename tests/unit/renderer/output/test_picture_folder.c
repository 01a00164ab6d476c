/* The folder of pictures: files only their owner can read, and no symbolic link is followed. */
#include "renderer/output/picture_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define VICTIM "victim"
#define WORDS  "not to be touched"

static char folder[64], out[80];
static int top; /* the test's folder; pictures go to its "above/out" */
static struct picture_folder output;
static struct image image;
static struct error_text error;

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/jolon-output-XXXXXX");
    if (!mkdtemp(folder) || (top = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return -1;
    int fd = openat(top, VICTIM, O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    if (fd < 0 || write(fd, WORDS, strlen(WORDS)) < 0)
        return -1;
    close(fd);
    snprintf(out, sizeof out, "%s/above/out", folder);
    return image_init(&image, 64, 64) == 0 && picture_folder_open(&output, out, &error) == 0 ? 0
                                                                                             : -1;
}

static int tear_down(void **state)
{
    char command[96];
    (void)state;
    picture_folder_close(&output);
    image_free(&image);
    close(top);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static mode_t mode_of(const char *name)
{
    struct stat status;
    assert_int_equal(fstatat(output.folder, name, &status, AT_SYMLINK_NOFOLLOW), 0);
    return status.st_mode;
}

static void plant(const char *name)
{
    assert_int_equal(symlinkat("../../" VICTIM, output.folder, name), 0);
}

static void check_victim(void)
{
    char words[64] = "";
    int fd = openat(top, VICTIM, O_RDONLY | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_int_equal(read(fd, words, sizeof words - 1), strlen(WORDS));
    close(fd);
    assert_string_equal(words, WORDS);
}

static void draw(uint64_t frame)
{
    if (picture_folder_picture(&output, "chase", &image, frame, "words", &error) != 0)
        fail_msg("%s", error.text);
}

static void test_files_are_the_owners_alone(void **state)
{
    (void)state;
    draw(7);
    assert_int_equal(mode_of("."), S_IFDIR | 0700);
    assert_int_equal(mode_of(".."), S_IFDIR | 0700);
    assert_int_equal(mode_of("chase.png"), S_IFREG | 0600);
    assert_int_equal(mode_of("chase-000007.png"), S_IFREG | 0600);
}

static void test_planted_links_are_replaced_and_not_followed(void **state)
{
    char temporary[64];
    (void)state;
    snprintf(temporary, sizeof temporary, "chase-000007.png.%d.tmp", (int)getpid());
    plant(temporary);
    plant("chase-000007.png");
    plant("chase.png");
    plant("chase.png.tmp");
    draw(7);
    assert_int_equal(mode_of("chase.png"), S_IFREG | 0600);
    assert_int_equal(mode_of("chase-000007.png"), S_IFREG | 0600);
    check_victim();
    assert_int_equal(faccessat(output.folder, temporary, F_OK, AT_SYMLINK_NOFOLLOW), -1);
}

static void test_cache_is_a_folder_and_no_link(void **state)
{
    char path[128];
    (void)state;
    assert_int_equal(picture_folder_cache(&output, path, sizeof path), 0);
    assert_int_equal(picture_folder_cache(&output, path, sizeof path), 0);
    assert_int_equal(mode_of(strrchr(path, '/') + 1), S_IFDIR | 0700);
    assert_int_equal(unlinkat(output.folder, strrchr(path, '/') + 1, AT_REMOVEDIR), 0);
    assert_int_equal(symlinkat("../..", output.folder, strrchr(path, '/') + 1), 0);
    assert_int_equal(picture_folder_cache(&output, path, sizeof path), -1);
}

static void test_half_pictures_of_dead_renderers_are_swept(void **state)
{
    char alive[64];
    (void)state;
    snprintf(alive, sizeof alive, "map.png.%d.tmp", (int)getppid());
    static const char dead[] = "map.png.999999999.tmp"; /* beyond any pid */
    close(openat(output.folder, alive, O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
    close(openat(output.folder, dead, O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
    picture_folder_close(&output);
    assert_int_equal(picture_folder_open(&output, out, &error), 0);
    assert_int_equal(faccessat(output.folder, dead, F_OK, 0), -1);
    assert_int_equal(faccessat(output.folder, alive, F_OK, 0), 0);
}

/* More pictures than are kept, also by a second renderer in the same folder. */
static void test_old_pictures_are_removed(void **state)
{
    (void)state;
    for (uint64_t frame = 999900; frame < 999900 + PICTURE_FOLDER_KEPT + 10; frame++)
        draw(frame);
    assert_int_equal(faccessat(output.folder, "chase-999909.png", F_OK, 0), -1);
    assert_int_equal(faccessat(output.folder, "chase-999910.png", F_OK, 0), 0);
    picture_folder_close(&output);
    assert_int_equal(picture_folder_open(&output, out, &error), 0);
    draw(2000000);
    assert_int_equal(faccessat(output.folder, "chase-999910.png", F_OK, 0), -1);
    assert_int_equal(faccessat(output.folder, "chase-1000029.png", F_OK, 0), 0);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_files_are_the_owners_alone),
        TEST(test_planted_links_are_replaced_and_not_followed),
        TEST(test_cache_is_a_folder_and_no_link),
        TEST(test_half_pictures_of_dead_renderers_are_swept),
        TEST(test_old_pictures_are_removed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
