/* Ground files written and read again; files that lie, are damaged or cut off. */
#include "supervisor/ground/ground_write.h"

#include "tests/support/fixture.h"
#include "world/maths/hash.h"
#include "world/maths/random.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/terrain.h"

#include <fcntl.h>
#include <math.h>
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

/* Two tiles and a narrow third along each edge. */
#define SIDE  515u
#define POSTS ((size_t)SIDE * SIDE)

static char folder[] = "/tmp/jolon-ground-XXXXXX";
static char path[64], copy[64];
static float posts[POSTS];
static uint8_t cover[POSTS];
static struct error_text error;

static struct ground_header header_of(void)
{
    return (struct ground_header){.latitude_deg = 44.5,
                                  .longitude_deg = -71.5,
                                  .side_m = (SIDE - 1) * 125.0,
                                  .spacing_m = 125.0,
                                  .posts_side = SIDE};
}

static void roughen(uint64_t seed)
{
    for (size_t i = 0; i < POSTS; i++) {
        posts[i] = ground_tile_round(9500.0 * random_unit(seed, i, 0, RANDOM_NOISE) - 900.0);
        posts[i] = posts[i] > (float)GROUND_HIGHEST_M ? (float)GROUND_HIGHEST_M : posts[i];
        cover[i] = (uint8_t)(random_u64(seed, i, 1, RANDOM_NOISE) % COVER_COUNT);
    }
}

static uint64_t write_ground(const char *to, const char *text, uint32_t threads)
{
    struct ground_header header = header_of();
    struct thread_pool *pool = thread_pool_create(threads);
    assert_non_null(pool);
    const struct ground_content content = {.posts = posts, .cover = cover, .text = text};
    assert_int_equal(ground_write(to, &header, &content, pool, &error), 0);
    thread_pool_destroy(pool);
    return header.hash;
}

static void test_what_is_read_is_what_was_written(void **state)
{
    static float back[POSTS];
    static uint8_t cover_back[POSTS];
    struct ground_file file;
    char text[64];
    (void)state;
    roughen(fixture_seed(1));
    posts[0] = (float)GROUND_LOWEST_M;
    posts[POSTS - 1] = (float)GROUND_HIGHEST_M;
    uint64_t hash = write_ground(path, "heights: a\nlicence: \x1b[31mb\n", 2);
    assert_int_equal(ground_file_open(&file, path, &error), 0);
    assert_int_equal(ground_file_posts(&file, back, cover_back, &error), 0);
    assert_memory_equal(back, posts, sizeof posts);
    assert_memory_equal(cover_back, cover, sizeof cover);
    assert_true(file.header.hash == hash);
    assert_true(file.header.lowest_m == posts[0] && file.header.highest_m == posts[POSTS - 1]);
    assert_int_equal(ground_file_text(&file, text, &error), 0);
    assert_string_equal(text, "heights: a\nlicence:  [31mb\n");
    ground_file_close(&file);
}

static int read_copy(void);
static void take_file(void);
static void put_file(const void *from, size_t count);
static void seal(void);
static unsigned char *bytes;
static size_t size;

/* Writes a ground with roads to copy, and reads all of it. */
static int with_roads(const struct ground_road_point *roads, uint32_t count)
{
    struct ground_header header = header_of();
    const struct ground_content content = {
        .posts = posts, .cover = cover, .text = "", .roads = roads, .road_points = count};
    assert_int_equal(ground_write(copy, &header, &content, NULL, &error), 0);
    return read_copy();
}

static void test_roads_are_read_and_checked(void **state)
{
    const struct ground_road_point good[] = {
        {0, 0, 0}, {64250000, 64250000, 0}, {5, 6, 1}, {7, 8, 1}, {9, 10, 1}};
    const struct ground_road_point wrong[][5] = {
        {{0, 0, 1}, {1, 1, 1}, {5, 6, 2}, {7, 8, 2}, {9, 10, 2}},
        {{0, 0, 0}, {1, 1, 0}, {5, 6, 2}, {7, 8, 2}, {9, 10, 2}},
        {{0, 0, 0}, {1, 1, 0}, {5, 6, 1}, {7, 8, 1}, {9, 10, 0}},
        {{0, 0, 0}, {1, 1, 0}, {5, 6, 0}, {7, 8, 0}, {9, 10, 1}},
        {{0, 0, 0}, {-1, 1, 0}, {5, 6, 1}, {7, 8, 1}, {9, 10, 1}},
        {{0, 0, 0}, {1, 64250001, 0}, {5, 6, 1}, {7, 8, 1}, {9, 10, 1}},
    };
    struct ground_road_point back[5];
    struct ground_file file;
    (void)state;
    roughen(fixture_seed(5));
    assert_int_equal(with_roads(good, 5), 0);
    assert_int_equal(ground_file_open(&file, copy, &error), 0);
    assert_int_equal(file.road_points, 5);
    assert_int_equal(ground_file_roads(&file, back, &error), 0);
    assert_memory_equal(back, good, sizeof good);
    uint64_t hash = file.header.hash;
    ground_file_close(&file);
    assert_true(write_ground(path, "", 1) != hash);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        if (with_roads(wrong[i], 5) == 0)
            fail_msg("roads %zu were believed", i);
        assert_non_null(strstr(error.text, "has roads that cannot be"));
    }
}

#define MIDDLE 30000000

/* A house with a ridge, and an angled building of two parts. */
static const struct ground_building good_buildings[] = {
    {MIDDLE, MIDDLE, -500, 5000, 7000, 16384, 1}, {MIDDLE, MIDDLE + 90000, -700, 5000, 5000, 0, 2}};
static const struct ground_corner good_corners[] = {
    {-5000, -4000, 0}, {5000, -4000, 0}, {5000, 4000, 0}, {-5000, 4000, 0},
    {-5000, -5000, 1}, {5000, -5000, 1}, {5000, 0, 1},    {-5000, 0, 1},
    {-5000, 0, 2},     {0, 0, 2},        {0, 5000, 2}};
#define CORNERS 11u
static const struct ground_object good_objects[] = {{0, 0, GROUND_TREE, 80, 7},
                                                    {0, 1, GROUND_POLE, 250, 65535},
                                                    {64250000, 0, GROUND_WATERTOWER, 100, 0}};

/* Writes a ground with these objects to copy, and reads all of it. */
static int with_objects(const struct ground_object *objects,
                        const struct ground_building *buildings,
                        const struct ground_corner *corners, uint32_t corner_count)
{
    struct ground_header header = header_of();
    const struct ground_content content = {.posts = posts,
                                           .cover = cover,
                                           .text = "",
                                           .objects = objects,
                                           .object_count = 3,
                                           .buildings = buildings,
                                           .building_count = 2,
                                           .corners = corners,
                                           .corner_count = corner_count};
    assert_int_equal(ground_write(copy, &header, &content, NULL, &error), 0);
    return read_copy();
}

static void test_objects_and_buildings_are_read(void **state)
{
    struct ground_object objects[3];
    struct ground_building buildings[2];
    struct ground_corner corners[CORNERS];
    struct ground_file file;
    (void)state;
    roughen(fixture_seed(6));
    assert_int_equal(with_objects(good_objects, good_buildings, good_corners, CORNERS), 0);
    assert_int_equal(ground_file_open(&file, copy, &error), 0);
    assert_int_equal(file.objects, 3);
    assert_int_equal(file.buildings, 2);
    assert_int_equal(file.corners, CORNERS);
    assert_int_equal(file.road_points, 0);
    assert_int_equal(ground_file_objects(&file, objects, &error), 0);
    assert_int_equal(ground_file_buildings(&file, buildings, corners, &error), 0);
    assert_memory_equal(objects, good_objects, sizeof objects);
    assert_memory_equal(buildings, good_buildings, sizeof buildings);
    assert_memory_equal(corners, good_corners, sizeof corners);
    uint64_t hash = file.header.hash;
    ground_file_close(&file);
    objects[1].size_percent = 249;
    assert_int_equal(with_objects(objects, good_buildings, good_corners, CORNERS), 0);
    assert_int_equal(ground_file_open(&file, copy, &error), 0);
    assert_true(file.header.hash != hash);
    ground_file_close(&file);
}

static void test_objects_that_cannot_be_are_refused(void **state)
{
    const struct ground_object wrong[][3] = {
        {{0, 0, 0, 80, 0}, {0, 0, 0, 80, 0}, {9, 9, 0, 80, 0}},
        {{1, 0, 0, 80, 0}, {0, 0, 0, 80, 0}, {9, 9, 0, 80, 0}},
        {{-1, 0, 0, 80, 0}, {0, 0, 0, 80, 0}, {9, 9, 0, 80, 0}},
        {{0, 0, 0, 80, 0}, {1, 0, 0, 80, 0}, {9, 64250001, 0, 80, 0}},
        {{0, 0, GROUND_OBJECT_TYPES, 80, 0}, {1, 0, 0, 80, 0}, {9, 9, 0, 80, 0}},
        {{0, 0, 0, GROUND_SIZE_MIN - 1, 0}, {1, 0, 0, 80, 0}, {9, 9, 0, 80, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        if (with_objects(wrong[i], good_buildings, good_corners, CORNERS) == 0)
            fail_msg("objects %zu were believed", i);
        assert_non_null(strstr(error.text, "has objects that cannot be"));
    }
}

static void building_refused(const char *what, const struct ground_building *buildings,
                             const struct ground_corner *corners, uint32_t count)
{
    if (with_objects(good_objects, buildings, corners, count) == 0)
        fail_msg("%s was believed", what);
    assert_non_null(strstr(error.text, "has buildings that cannot be"));
}

static void test_buildings_that_cannot_be_are_refused(void **state)
{
    struct ground_building b[2];
    struct ground_corner c[CORNERS + 1];
    (void)state;
#define WRONG_BUILDING(what, member, value)                                                        \
    memcpy(b, good_buildings, sizeof b);                                                           \
    b[1].member = (value);                                                                         \
    building_refused(what, b, good_corners, CORNERS)
    WRONG_BUILDING("a middle beyond the square", x_mm, 64250001);
    WRONG_BUILDING("a foot in the air", foot_mm, 1);
    WRONG_BUILDING("a deep foot", foot_mm, GROUND_BUILDING_FOOT_MM - 1);
    WRONG_BUILDING("eaves in the ground", eaves_mm, 0);
    WRONG_BUILDING("a roof below its eaves", top_mm, 4999);
    WRONG_BUILDING("a ridge over two parts", top_mm, 5001);
    WRONG_BUILDING("a tower of a kilometre", top_mm, 1000000);
    WRONG_BUILDING("no parts", parts, 0);
    WRONG_BUILDING("more parts than there are", parts, 3);
    WRONG_BUILDING("fewer parts than there are", parts, 1);
#define WRONG_CORNER(what, at, ...)                                                                \
    memcpy(c, good_corners, sizeof good_corners);                                                  \
    c[at] = (struct ground_corner)__VA_ARGS__;                                                     \
    building_refused(what, good_buildings, c, CORNERS)
    WRONG_CORNER("a corner on a straight line", 1, {0, 0, 0});
    WRONG_CORNER("a hollow corner", 1, {-4000, 0, 0});
    WRONG_CORNER("a corner of another part", 1, {5000, -4000, 1});
    WRONG_CORNER("a corner far away", 1, {GROUND_BUILDING_REACH_MM + 1, -4000, 0});
    WRONG_CORNER("a part of a hair's width", 10, {0, 5, 2});
    WRONG_CORNER("a turn the other way", 10, {0, -5000, 2});
    building_refused("a missing corner", good_buildings, good_corners, CORNERS - 1);
    memcpy(c, good_corners, sizeof good_corners);
    c[CORNERS] = (struct ground_corner){0, 0, 3};
    building_refused("a corner too many", good_buildings, c, CORNERS + 1);
}

static void test_a_star_that_turns_one_way_is_no_part(void **state)
{
    /* All of its turns are to one side, and it goes around twice. */
    const struct ground_corner star[] = {
        {0, -10000, 0}, {5878, 8090, 0}, {-9511, -3090, 0}, {9511, -3090, 0}, {-5878, 8090, 0}};
    (void)state;
    assert_false(ground_file_part_fits(star, 5));
    assert_true(ground_file_part_fits(good_corners, 4));
}

static void test_files_of_the_first_version_are_read(void **state)
{
    (void)state;
    write_ground(path, "sources", 1);
    take_file();
    ((struct ground_header *)(void *)bytes)->version = GROUND_VERSION_OLDEST;
    seal();
    put_file(bytes, size);
    assert_int_equal(read_copy(), 0);
    free(bytes);
}

static void test_hash_is_of_the_ground_alone(void **state)
{
    (void)state;
    roughen(fixture_seed(2));
    uint64_t one = write_ground(path, "from a", 1), four = write_ground(copy, "from b", 4);
    assert_true(one == four);
    cover[77] ^= 1;
    assert_true(write_ground(copy, "from a", 1) != one);
    cover[77] ^= 1;
    posts[POSTS / 2] += (float)GROUND_STEP_M;
    assert_true(write_ground(copy, "from a", 1) != one);
}

static void test_heights_are_rounded_to_the_nearest_step(void **state)
{
    (void)state;
    assert_true(ground_tile_round(100.0) == 100.0f);
    assert_true(ground_tile_round(100.009) == 100.015625f);
    assert_true(ground_tile_round(-430.005) == -430.0f);
    assert_true(ground_tile_round(-430.009) == -430.015625f);
}

/* --- files that are wrong ----------------------------------------------------------------------*/

static void take_file(void)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    assert_true(fd >= 0 && fstat(fd, &status) == 0);
    size = (size_t)status.st_size;
    bytes = malloc(size);
    assert_non_null(bytes);
    assert_true(read(fd, bytes, size) == (ssize_t)size);
    close(fd);
}

static void put_file(const void *from, size_t count)
{
    int fd = open(copy, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    assert_true(fd >= 0 && write(fd, from, count) == (ssize_t)count);
    close(fd);
}

/* Opens the copy and reads all of it. Returns 0, or -1 with a line of text. */
static int read_copy(void)
{
    static float back[POSTS];
    static uint8_t cover_back[POSTS];
    struct ground_file file;
    error.text[0] = '\0';
    int result = ground_file_open(&file, copy, &error);
    if (result == 0) {
        result = ground_file_posts(&file, back, cover_back, &error);
        if (result == 0 && file.text_bytes < 1000) {
            char text[1001];
            result = ground_file_text(&file, text, &error);
        }
        if (result == 0 && file.road_points < 100) {
            struct ground_road_point roads[100];
            result = ground_file_roads(&file, roads, &error);
        }
        if (result == 0 && file.objects < 100 && file.buildings < 100 && file.corners < 100) {
            struct ground_object objects[100];
            struct ground_building buildings[100];
            struct ground_corner corners[100];
            result = ground_file_objects(&file, objects, &error);
            if (result == 0)
                result = ground_file_buildings(&file, buildings, corners, &error);
        }
        ground_file_close(&file);
    }
    assert_true((result == 0) == (error.text[0] == '\0'));
    assert_null(strchr(error.text, '\n'));
    return result;
}

static void test_every_changed_byte_is_noticed(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    roughen(random);
    write_ground(path, "sources", 1);
    take_file();
    size_t directory = sizeof(struct ground_header) + 10 * sizeof(struct ground_block);
    for (size_t i = 0; i < directory + 60; i++) {
        size_t at = i < directory ? i : random_u64(random, i, 0, RANDOM_NOISE) % size;
        bytes[at] ^= (unsigned char)(1u << i % 8);
        put_file(bytes, size);
        if (read_copy() == 0)
            fail_msg("byte %zu was changed and nothing said so", at);
        bytes[at] ^= (unsigned char)(1u << i % 8);
    }
    put_file(bytes, size);
    assert_int_equal(read_copy(), 0);
    free(bytes);
}

static void test_files_of_other_lengths_are_refused(void **state)
{
    (void)state;
    write_ground(path, "sources", 1);
    take_file();
    for (size_t length = 0; length < size; length = length < 600 ? length + 7 : length * 2) {
        put_file(bytes, length);
        assert_int_equal(read_copy(), -1);
    }
    put_file(bytes, size - 1);
    assert_int_equal(read_copy(), -1);
    bytes = realloc(bytes, size + 1);
    assert_non_null(bytes);
    bytes[size] = 0;
    put_file(bytes, size + 1);
    assert_int_equal(read_copy(), -1);
    free(bytes);
}

/* Corrects all hashes of a file that lies. */
static void seal(void)
{
    struct ground_header *h = (struct ground_header *)(void *)bytes;
    const struct ground_block *blocks = (const struct ground_block *)(const void *)(h + 1);
    if (h->block_count <= 10) {
        h->directory_hash = XXH3_64bits(blocks, h->block_count * sizeof *blocks);
        h->hash = ground_file_hash(h, blocks);
    }
    h->header_hash = XXH3_64bits(h, offsetof(struct ground_header, header_hash));
}

static void lie(const char *what, void *at, const void *value, size_t count)
{
    unsigned char before[16];
    memcpy(before, at, count);
    memcpy(at, value, count);
    seal();
    put_file(bytes, size);
    if (read_copy() == 0)
        fail_msg("%s was believed", what);
    memcpy(at, before, count);
    seal();
}

#define LIE(what, of, type, ...) lie(what, &(of), &(type){__VA_ARGS__}, sizeof(type))

static void test_lying_headers_are_refused(void **state)
{
    (void)state;
    write_ground(path, "sources", 1);
    take_file();
    struct ground_header *h = (struct ground_header *)(void *)bytes;
    struct ground_block *blocks = (struct ground_block *)(void *)(h + 1);
    LIE("a version", h->version, uint32_t, GROUND_VERSION + 1);
    assert_non_null(strstr(error.text, "version 3"));
    LIE("version 0", h->version, uint32_t, 0);
    LIE("a latitude", h->latitude_deg, double, NAN);
    LIE("a latitude", h->latitude_deg, double, 89.0);
    LIE("a longitude", h->longitude_deg, double, -180.5);
    LIE("a side", h->side_m, double, 1e9);
    LIE("a side", h->side_m, double, NAN);
    LIE("a spacing", h->spacing_m, double, 124.0);
    LIE("an undulation", h->undulation_m, double, INFINITY);
    LIE("a number of posts", h->posts_side, uint32_t, UINT32_MAX);
    LIE("a number of posts", h->posts_side, uint32_t, 0);
    LIE("a number of blocks", h->block_count, uint32_t, UINT32_MAX);
    LIE("a number of blocks", h->block_count, uint32_t, 8);
    LIE("a length", h->bytes, uint64_t, UINT64_MAX);
    LIE("a place beyond the end", blocks[3].offset, uint64_t, UINT64_MAX - 3);
    LIE("a length beyond the end", blocks[3].packed_bytes, uint32_t, UINT32_MAX);
    LIE("an unpacked length", blocks[3].content_bytes, uint32_t, UINT32_MAX);
    LIE("a tile's number", blocks[3].number, uint32_t, 4);
    LIE("a kind", blocks[3].kind, uint32_t, GROUND_BLOCK_TEXT);
    LIE("a second tile instead of the text", blocks[9].kind, uint32_t, GROUND_BLOCK_TILE);
    LIE("a long text", blocks[9].content_bytes, uint32_t, UINT32_MAX);
    LIE("another tile's content", blocks[3].offset, uint64_t, blocks[4].offset);
    seal();
    put_file(bytes, size);
    assert_int_equal(read_copy(), 0);
    free(bytes);
}

static void test_heights_and_covers_that_cannot_be_are_refused(void **state)
{
    (void)state;
    roughen(fixture_seed(4));
    float good = posts[1000];
    posts[1000] = (float)GROUND_HIGHEST_M + 1.0f;
    write_ground(copy, "", 1);
    assert_int_equal(read_copy(), -1);
    posts[1000] = (float)GROUND_LOWEST_M - 1.0f;
    write_ground(copy, "", 1);
    assert_int_equal(read_copy(), -1);
    posts[1000] = good;
    cover[1000] = COVER_COUNT;
    write_ground(copy, "", 1);
    assert_int_equal(read_copy(), -1);
    assert_non_null(strstr(error.text, "a height or a cover that cannot be"));
}

static void test_what_is_no_ground_file_is_refused(void **state)
{
    struct ground_file file;
    (void)state;
    assert_int_equal(ground_file_open(&file, folder, &error), -1);
    assert_int_equal(ground_file_open(&file, "/dev/zero", &error), -1);
    assert_int_equal(ground_file_open(&file, "/no/such/file", &error), -1);
    unlink(copy);
    assert_int_equal(mkfifo(copy, 0600), 0);
    assert_int_equal(ground_file_open(&file, copy, &error), -1);
    unlink(copy);
    put_file("JOLON", 5);
    assert_int_equal(ground_file_open(&file, copy, &error), -1);
    assert_non_null(strstr(error.text, "is no ground file"));
}

/* --- writing -----------------------------------------------------------------------------------*/

static void test_a_file_that_cannot_be_written_leaves_the_old_one(void **state)
{
    struct ground_header header = header_of();
    char wrong[128], stale[128];
    (void)state;
    snprintf(wrong, sizeof wrong, "%s/no/x.ground", folder);
    const struct ground_content content = {.posts = posts, .cover = cover, .text = ""};
    assert_int_equal(ground_write(wrong, &header, &content, NULL, &error), -1);
    /* What a killed writer left aside is removed by the next. */
    snprintf(stale, sizeof stale, "%s/.a.ground.99999999", folder);
    int fd = open(stale, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    assert_true(fd >= 0);
    close(fd);
    cover[1000] = COVER_GRASS;
    write_ground(path, "", 1);
    assert_int_equal(access(stale, F_OK), -1);
}

static int begin(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/a.ground", folder);
    snprintf(copy, sizeof copy, "%s/b.ground", folder);
    return 0;
}

static int end(void **state)
{
    (void)state;
    unlink(path);
    unlink(copy);
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_read_is_what_was_written),
        cmocka_unit_test(test_roads_are_read_and_checked),
        cmocka_unit_test(test_objects_and_buildings_are_read),
        cmocka_unit_test(test_objects_that_cannot_be_are_refused),
        cmocka_unit_test(test_buildings_that_cannot_be_are_refused),
        cmocka_unit_test(test_a_star_that_turns_one_way_is_no_part),
        cmocka_unit_test(test_files_of_the_first_version_are_read),
        cmocka_unit_test(test_hash_is_of_the_ground_alone),
        cmocka_unit_test(test_heights_are_rounded_to_the_nearest_step),
        cmocka_unit_test(test_every_changed_byte_is_noticed),
        cmocka_unit_test(test_files_of_other_lengths_are_refused),
        cmocka_unit_test(test_lying_headers_are_refused),
        cmocka_unit_test(test_heights_and_covers_that_cannot_be_are_refused),
        cmocka_unit_test(test_what_is_no_ground_file_is_refused),
        cmocka_unit_test(test_a_file_that_cannot_be_written_leaves_the_old_one),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
