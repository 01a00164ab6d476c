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
    assert_int_equal(ground_write(to, &header, posts, cover, text, NULL, 0, pool, &error), 0);
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

/* Writes a ground with roads to copy, and reads all of it. */
static int with_roads(const struct ground_road_point *roads, uint32_t count)
{
    struct ground_header header = header_of();
    assert_int_equal(ground_write(copy, &header, posts, cover, "", roads, count, NULL, &error), 0);
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

static unsigned char *bytes;
static size_t size;

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
    assert_non_null(strstr(error.text, "version 2"));
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
    assert_int_equal(ground_write(wrong, &header, posts, cover, "", NULL, 0, NULL, &error), -1);
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
