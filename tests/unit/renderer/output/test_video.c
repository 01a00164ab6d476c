/* Which pictures come into a video, and what happens when it cannot be written. That players can
 * read it is tested by tests/system/test_video.sh. */
#include "renderer/output/video.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

static struct picture picture;
static struct video *video;
static struct error_text error;
static int fd;

static int set_up(void **state)
{
    (void)state;
    picture = (struct picture){.view = "chase"};
    fd = memfd_create("video", MFD_CLOEXEC);
    return fd >= 0 && image_init(&picture.image, 65, 47) == 0 ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    image_free(&picture.image);
    return close(fd);
}

static void begin(const char *path, double fps)
{
    video = video_open(path, fps, VIDEO_LIVE, &error);
    if (video == NULL)
        fail_msg("%s", error.text);
    video_write_to(video, fd);
}

static void put(double time_s)
{
    picture.time_s = time_s;
    memset(picture.image.pixels, (int)(time_s * 100.0) & 255, (size_t)65 * 47 * 4);
    if (video_put(video, &picture, &error) != 0)
        fail_msg("%s", error.text);
}

static void end(uint64_t pictures)
{
    assert_int_equal(video_pictures(video), pictures);
    assert_int_equal(video_close(video, &error), 0);
    assert_true(lseek(fd, 0, SEEK_END) > 500);
}

static void test_pictures_beyond_the_rate_are_left_out(void **state)
{
    (void)state;
    begin("a.mkv", 30.0);
    for (int frame = 0; frame < 60; frame++)
        put(17.0 + frame / 60.0);
    end(30);
}

static void test_every_picture_comes_in_at_the_very_rate(void **state)
{
    (void)state;
    begin("a.mp4", 60.0);
    for (int frame = 0; frame < 100; frame++)
        put(1e6 + frame * (1.0 / 60.0));
    end(100);
}

static void test_time_goes_on_or_the_picture_is_left_out(void **state)
{
    static const double times_s[] = {5.0, 5.0, 4.0, 5.5, 5.2, 5.5, 6.0};
    (void)state;
    begin("a.webm", 30.0);
    for (size_t i = 0; i < sizeof times_s / sizeof times_s[0]; i++)
        put(times_s[i]);
    end(3);
}

static void test_another_size_is_refused(void **state)
{
    (void)state;
    begin("a.mkv", 30.0);
    put(1.0);
    picture.image.height = 32;
    assert_int_equal(video_put(video, &picture, &error), -1);
    assert_string_equal(error.text, "video: a picture of 65x32 comes after those of 64x46");
    picture.image.height = 47;
    end(1);
}

static void test_a_full_disk_is_said(void **state)
{
    (void)state;
    int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    assert_true(full >= 0);
    begin("a.mkv", 30.0);
    video_write_to(video, full);
    int result = 0;
    for (int i = 0; i < 100 && result == 0; i++) {
        picture.time_s = i;
        result = video_put(video, &picture, &error);
    }
    assert_int_equal(result, -1);
    assert_non_null(strstr(error.text, "No space left on device"));
    assert_int_equal(video_close(video, &error), -1);
    assert_non_null(strstr(error.text, "No space left on device"));
    close(full);
}

static void test_nothing_put_is_nothing_written(void **state)
{
    (void)state;
    begin("a.mkv", 30.0);
    assert_int_equal(video_close(video, &error), 0);
    assert_int_equal(lseek(fd, 0, SEEK_END), 0);
}

static void test_what_the_file_is_follows_from_its_ending(void **state)
{
    static const char *const none[] = {"", "a", ".mkv", "a.avi", "a.mkv.old", "mkv", "a/.mp4x"};
    (void)state;
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        assert_null(video_open(none[i], 30.0, VIDEO_LIVE, &error));
        assert_non_null(strstr(error.text, "must end in .mkv, .mp4 or .webm"));
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_pictures_beyond_the_rate_are_left_out),
        TEST(test_every_picture_comes_in_at_the_very_rate),
        TEST(test_time_goes_on_or_the_picture_is_left_out),
        TEST(test_another_size_is_refused),
        TEST(test_a_full_disk_is_said),
        TEST(test_nothing_put_is_nothing_written),
        TEST(test_what_the_file_is_follows_from_its_ending),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
