/* Ground files: a good file with some changed bytes, opened and read. The first byte of the input
 * says whether the hashes are corrected afterwards, so that the code behind them is reached, and
 * whether the file is cut. Then come changes of 4 bytes: where (two bytes), how, and the value. */
#include "tests/fuzz/support.h"

#include "supervisor/ground/ground_write.h"
#include "world/maths/hash.h"
#include "world/runtime/check.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/terrain.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

#define SIDE     9u
#define FILE_MAX 4096u
#define BLOCKS   6u /* of the good file */

enum how {
    HOW_HASHED = 1,  /* the hashes are corrected */
    HOW_CUT = 2,     /* the last change gives the number of missing bytes */
    HOW_CONTENT = 4, /* the changes apply to an unpacked block ... */
    HOW_BLOCK = 8,   /* ... which the higher bits number */
};

static unsigned char good[FILE_MAX];
static size_t good_bytes;

static void make_good(void)
{
    static float posts[SIDE * SIDE];
    static uint8_t cover[SIDE * SIDE];
    struct ground_header header = {.latitude_deg = 44.5,
                                   .longitude_deg = -71.5,
                                   .side_m = 1000.0,
                                   .spacing_m = 125.0,
                                   .posts_side = SIDE};
    const struct ground_road_point roads[] = {{5, 6, 0}, {70, 80, 0}, {9, 10, 1}, {11, 12, 1}};
    const struct ground_object objects[] = {{5, 6, GROUND_TREE, 90, 3},
                                            {7, 8, GROUND_POLE, 250, 4}};
    const struct ground_building buildings[] = {{500000, 500000, -500, 5000, 7000, 9, 1},
                                                {600000, 500000, -500, 5000, 5000, 9, 2}};
    const struct ground_corner corners[] = {
        {-5000, -4000, 0}, {5000, -4000, 0}, {5000, 4000, 0}, {-5000, 4000, 0}, {-5000, -5000, 1},
        {5000, -5000, 1},  {5000, 0, 1},     {-5000, 0, 2},   {0, 0, 2},        {0, 5000, 2}};
    struct error_text error;
    char path[PATH_MAX];
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = ground_tile_round(100.0 + 3.7 * i);
        cover[i] = (uint8_t)(i % COVER_COUNT);
    }
    (void)support_data_dir();
    support_path(path, sizeof path, "models/k.obj");
    const struct ground_content content = {.posts = posts,
                                           .cover = cover,
                                           .text = "heights: a\n",
                                           .roads = roads,
                                           .road_points = 4,
                                           .objects = objects,
                                           .object_count = 2,
                                           .buildings = buildings,
                                           .building_count = 2,
                                           .corners = corners,
                                           .corner_count = 10};
    CHECK(ground_write(path, &header, &content, NULL, &error) == 0);
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    ssize_t bytes = fd >= 0 ? read(fd, good, sizeof good) : -1;
    CHECK(bytes > 0 && bytes < (ssize_t)sizeof good);
    good_bytes = (size_t)bytes;
    close(fd);
}

/* Packs a changed block behind the end, and points the directory to it. */
static size_t put_content(unsigned char *file, size_t bytes, const uint8_t *data, size_t size)
{
    unsigned char content[GROUND_TILE_BYTES_A_POST * SIDE * SIDE];
    struct ground_header *h = (struct ground_header *)(void *)file;
    struct ground_block *block =
        (struct ground_block *)(void *)(h + 1) + (data[0] / HOW_BLOCK) % h->block_count;
    size_t unpacked =
        ZSTD_decompress(content, sizeof content, file + block->offset, block->packed_bytes);
    CHECK(unpacked == block->content_bytes);
    for (size_t at = 1; at + 4 <= size; at += 4)
        content[((size_t)data[at] << 8 | data[at + 1]) % unpacked] = data[at + 3];
    size_t packed = ZSTD_compress(file + bytes, FILE_MAX - bytes, content, unpacked, 1);
    CHECK(!ZSTD_isError(packed));
    block->offset = bytes;
    block->packed_bytes = (uint32_t)packed;
    block->content_hash = XXH3_64bits(content, unpacked);
    h->bytes = bytes + packed;
    return bytes + packed;
}

static void change(unsigned char *file, size_t bytes, const uint8_t change[4])
{
    size_t at = ((size_t)change[0] << 8 | change[1]) % bytes;
    /* Most changes are to the header and the directory. */
    if (change[2] & 1)
        at %= sizeof(struct ground_header) + BLOCKS * sizeof(struct ground_block);
    file[at] = change[3];
}

static void seal(unsigned char *file)
{
    struct ground_header *h = (struct ground_header *)(void *)file;
    const struct ground_block *blocks = (const struct ground_block *)(const void *)(h + 1);
    if (h->block_count <= BLOCKS) {
        h->directory_hash = XXH3_64bits(blocks, h->block_count * sizeof *blocks);
        h->hash = ground_file_hash(h, blocks);
    }
    h->header_hash = XXH3_64bits(h, offsetof(struct ground_header, header_hash));
}

static void read_all(const char *path)
{
    struct ground_file file;
    struct error_text error = {.text = ""};
    if (ground_file_open(&file, path, &error) != 0) {
        support_check_line(&error);
        return;
    }
    /* A file of this length has few posts only if it is honest about them. */
    size_t posts = (size_t)file.header.posts_side * file.header.posts_side;
    CHECK(file.tiles <= FILE_MAX / sizeof(struct ground_block));
    float *heights = malloc(posts * sizeof *heights);
    uint8_t *cover = malloc(posts);
    char *text = malloc(file.text_bytes + 1);
    CHECK(heights && cover && text);
    if (ground_file_posts(&file, heights, cover, &error) == 0) {
        for (size_t i = 0; i < posts; i++)
            CHECK(heights[i] >= (float)GROUND_LOWEST_M && heights[i] <= (float)GROUND_HIGHEST_M &&
                  cover[i] < COVER_COUNT);
    } else {
        support_check_line(&error);
    }
    struct ground_road_point *roads = malloc((file.road_points + 1) * sizeof *roads);
    CHECK(roads);
    if (ground_file_roads(&file, roads, &error) == 0)
        CHECK(file.road_points == 0 || roads[0].road == 0);
    free(roads);
    struct ground_object *objects = malloc((file.objects + 1) * sizeof *objects);
    struct ground_building *buildings = malloc((file.buildings + 1) * sizeof *buildings);
    struct ground_corner *corners = malloc((file.corners + 1) * sizeof *corners);
    CHECK(objects && buildings && corners);
    if (ground_file_objects(&file, objects, &error) == 0)
        CHECK(file.objects == 0 || objects[0].type < GROUND_OBJECT_TYPES);
    else
        support_check_line(&error);
    if (ground_file_buildings(&file, buildings, corners, &error) == 0) {
        uint32_t parts = 0;
        for (uint32_t i = 0; i < file.buildings; i++)
            parts += buildings[i].parts;
        CHECK(parts == (file.corners > 0 ? corners[file.corners - 1].part + 1 : 0));
    } else {
        support_check_line(&error);
    }
    free(objects);
    free(buildings);
    free(corners);
    if (ground_file_text(&file, text, &error) == 0)
        CHECK(strlen(text) <= file.text_bytes);
    free(heights);
    free(cover);
    free(text);
    ground_file_close(&file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned char file[FILE_MAX];
    char path[PATH_MAX];
    if (good_bytes == 0)
        make_good();
    if (size < 1)
        return 0;
    memcpy(file, good, good_bytes);
    size_t bytes = good_bytes;
    if (data[0] & HOW_CONTENT) {
        bytes = put_content(file, bytes, data, size);
    } else {
        for (size_t at = 1; at + 4 <= size; at += 4)
            change(file, bytes, data + at);
    }
    if (data[0] & HOW_HASHED)
        seal(file);
    if (data[0] & HOW_CUT)
        bytes -= data[size - 1] < bytes ? data[size - 1] : bytes;
    support_put("models/k.obj", file, bytes);
    support_path(path, sizeof path, "models/k.obj");
    read_all(path);
    return 0;
}
