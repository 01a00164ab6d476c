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

enum how {
    HOW_HASHED = 1,  /* the hashes are corrected */
    HOW_CUT = 2,     /* the last change gives the number of missing bytes */
    HOW_CONTENT = 4, /* the changes apply to the unpacked tile */
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
    struct error_text error;
    char path[PATH_MAX];
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = ground_tile_round(100.0 + 3.7 * i);
        cover[i] = (uint8_t)(i % COVER_COUNT);
    }
    (void)support_data_dir();
    support_path(path, sizeof path, "models/k.obj");
    CHECK(ground_write(path, &header, posts, cover, "heights: a\n", roads, 4, NULL, &error) == 0);
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    ssize_t bytes = fd >= 0 ? read(fd, good, sizeof good) : -1;
    CHECK(bytes > 0 && bytes < (ssize_t)sizeof good);
    good_bytes = (size_t)bytes;
    close(fd);
}

/* Packs a changed tile behind the end, and points the directory to it. */
static size_t put_content(unsigned char *file, size_t bytes, const uint8_t *data, size_t size)
{
    unsigned char content[GROUND_TILE_BYTES_A_POST * SIDE * SIDE];
    struct ground_header *h = (struct ground_header *)(void *)file;
    struct ground_block *block = (struct ground_block *)(void *)(h + 1);
    size_t unpacked =
        ZSTD_decompress(content, sizeof content, file + block->offset, block->packed_bytes);
    CHECK(unpacked == sizeof content);
    for (size_t at = 1; at + 4 <= size; at += 4)
        content[((size_t)data[at] << 8 | data[at + 1]) % sizeof content] = data[at + 3];
    size_t packed = ZSTD_compress(file + bytes, FILE_MAX - bytes, content, sizeof content, 1);
    CHECK(!ZSTD_isError(packed));
    block->offset = bytes;
    block->packed_bytes = (uint32_t)packed;
    block->content_hash = XXH3_64bits(content, sizeof content);
    h->bytes = bytes + packed;
    return bytes + packed;
}

static void change(unsigned char *file, size_t bytes, const uint8_t change[4])
{
    size_t at = ((size_t)change[0] << 8 | change[1]) % bytes;
    /* Most changes are to the header and the directory. */
    if (change[2] & 1)
        at %= sizeof(struct ground_header) + 3 * sizeof(struct ground_block);
    file[at] = change[3];
}

static void seal(unsigned char *file)
{
    struct ground_header *h = (struct ground_header *)(void *)file;
    const struct ground_block *blocks = (const struct ground_block *)(const void *)(h + 1);
    if (h->block_count <= 3) {
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
