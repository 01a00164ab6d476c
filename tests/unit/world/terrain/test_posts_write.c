/* Posts files: they have the posts of their ground file, and what does not belong to it is refused
 * and made again. */
#include "world/terrain/posts_write.h"

#include "supervisor/ground/ground_write.h"
#include "tests/support/quick_config.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/ground_tile.h"
#include "world/terrain/posts_file.h"
#include "world/terrain/terrain.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define SIDE   601u /* three tiles along an edge, the last one of 89 posts */
#define SIDE_M 7500.0

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static char path[96], posts_path[128], aside[136];
static struct posts_file_ground ground = {.path = path, .side_m = SIDE_M, .posts_side = SIDE};
static struct error_text error;

/* Writes a ground whose every post has another height. */
static void put_ground(double rise_m)
{
    struct ground_header header = {.latitude_deg = 44.5,
                                   .longitude_deg = -71.25,
                                   .side_m = SIDE_M,
                                   .spacing_m = SIDE_M / (SIDE - 1),
                                   .posts_side = SIDE};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = ground_tile_round(rise_m * i / 64.0);
        cover[i] = (uint8_t)(i * 7 % COVER_COUNT);
    }
    snprintf(path, sizeof path, "%s/x.ground", quick_config.folder);
    snprintf(posts_path, sizeof posts_path, "%s.posts", path);
    snprintf(aside, sizeof aside, "%s.new", posts_path);
    const struct ground_content content = {.posts = posts, .cover = cover, .text = ""};
    assert_int_equal(ground_write(path, &header, &content, NULL, &error), 0);
    ground.hash = header.hash;
}

static void must_write(void)
{
    if (posts_write_for(path, ground.hash, &error) != 0)
        fail_msg("refused: %s", error.text);
}

static void is_ground(void)
{
    struct posts_file file;
    if (posts_file_open(&file, &ground, &error) != 0)
        fail_msg("refused: %s", error.text);
    assert_memory_equal(file.posts, posts, sizeof posts);
    assert_memory_equal(file.cover, cover, sizeof cover);
    assert_int_equal((uintptr_t)file.posts % POSTS_FILE_ALIGN % 4096, 0);
    assert_int_equal(posts_file_verify(&file, &error), 0);
    posts_file_close(&file);
    assert_null(file.mapped);
    assert_int_equal(access(aside, F_OK), -1);
}

static void refused(const char *because)
{
    struct posts_file file;
    assert_int_equal(posts_file_open(&file, &ground, &error), -1);
    assert_null(file.mapped);
    if (!strstr(error.text, because))
        fail_msg("\"%s\" does not say \"%s\"", error.text, because);
}

static void change_byte(const char *name, long at)
{
    FILE *file = fopen(name, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    int byte = fgetc(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    assert_true(fputc(byte ^ 1, file) != EOF);
    assert_int_equal(fclose(file), 0);
}

static void test_a_posts_file_has_the_posts_of_its_ground(void **state)
{
    struct stat first, second;
    (void)state;
    put_ground(1.0);
    refused("No such file or directory; jolon world create on ");
    must_write();
    is_ground();
    /* Made once. */
    assert_int_equal(stat(posts_path, &first), 0);
    must_write();
    assert_int_equal(stat(posts_path, &second), 0);
    assert_int_equal(first.st_ino, second.st_ino);
}

static void test_what_does_not_belong_to_the_ground_is_made_again(void **state)
{
    struct posts_file file;
    (void)state;
    put_ground(1.0);
    must_write();
    put_ground(0.5);
    refused("has the posts of another ground");
    must_write();
    is_ground();
    change_byte(posts_path, 9);
    refused("is no posts file, or a damaged one");
    must_write();
    assert_int_equal(truncate(posts_path, 4096), 0);
    refused("is cut off");
    must_write();
    assert_int_equal(truncate(posts_path, 0), 0);
    refused("is no posts file");
    must_write();
    is_ground();
    /* What a killed maker left is taken over. */
    unlink(posts_path);
    FILE *left = fopen(aside, "w");
    assert_non_null(left);
    fputs("half", left);
    fclose(left);
    must_write();
    is_ground();
    change_byte(posts_path, (long)posts_file_cover(SIDE) + 1000);
    assert_int_equal(posts_file_open(&file, &ground, &error), 0);
    assert_int_equal(posts_file_verify(&file, &error), -1);
    assert_non_null(strstr(error.text, "fails its hashes"));
    posts_file_close(&file);
    must_write(); /* no world runs on a damaged ground */
    is_ground();
}

static void test_another_ground_file_is_refused(void **state)
{
    (void)state;
    put_ground(1.0);
    uint64_t hash = ground.hash;
    put_ground(0.5);
    assert_int_equal(posts_write_for(path, hash, &error), -1);
    assert_non_null(strstr(error.text, "the world needs the ground"));
    unlink(path);
    assert_int_equal(posts_write_for(path, hash, &error), -1);
    assert_non_null(strstr(error.text, "x.ground: No such file"));
    unlink(posts_path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_posts_file_has_the_posts_of_its_ground),
        cmocka_unit_test(test_what_does_not_belong_to_the_ground_is_made_again),
        cmocka_unit_test(test_another_ground_file_is_refused),
    };
    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
