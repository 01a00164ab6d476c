/* The reader of ground files. */
#include "world/terrain/ground_file.h"

#include "world/maths/hash.h"
#include "world/terrain/projection.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

/* What the hash of a ground covers of its header. */
struct hashed {
    double latitude_deg, longitude_deg, side_m, spacing_m, undulation_m;
    uint64_t flags;
};

uint64_t ground_file_hash(const struct ground_header *header, const struct ground_block *blocks)
{
    const struct hashed place = {header->latitude_deg, header->longitude_deg, header->side_m,
                                 header->spacing_m,    header->undulation_m,  header->flags};
    uint64_t hash = XXH3_64bits(&place, sizeof place);
    for (uint32_t i = 0; i < header->block_count; i++) {
        if (blocks[i].kind != GROUND_BLOCK_TEXT)
            hash =
                XXH3_64bits_withSeed(&blocks[i].content_hash, sizeof blocks[i].content_hash, hash);
    }
    return hash;
}

static int refuse(const struct ground_file *file, struct error_text *error, const char *what)
{
    return error_text_set(error, "%s: %s; make it again by: jolon ground make", file->path, what);
}

/* Returns true if the sides fit each other. NaN fits nothing. */
static bool sides_fit(const struct ground_header *h)
{
    return h->side_m >= GROUND_SIDE_MIN_M && h->side_m <= GROUND_SIDE_MAX_M &&
           fmod(h->side_m, GROUND_SIDE_OF_M) == 0.0 && h->posts_side >= GROUND_POSTS_SIDE_MIN &&
           h->posts_side <= GROUND_POSTS_SIDE_MAX &&
           h->spacing_m == h->side_m / (h->posts_side - 1);
}

static int check_header(const struct ground_file *file, uint64_t bytes, struct error_text *error)
{
    const struct ground_header *h = &file->header;
    uint64_t tiles = ground_tiles_side(h->posts_side);
    if (h->header_hash != XXH3_64bits(h, offsetof(struct ground_header, header_hash)))
        return refuse(file, error, "its header is damaged");
    if (h->bytes != bytes)
        return error_text_set(error,
                              "%s: has %" PRIu64 " bytes, and its header says %" PRIu64
                              ": it is cut off or has something behind its end",
                              file->path, bytes, h->bytes);
    if (!sides_fit(h))
        return refuse(file, error, "its header has a side or a number of posts that cannot be");
    if (!(fabs(h->latitude_deg) <= PROJECTION_LATITUDE_MAX_DEG) ||
        !(fabs(h->longitude_deg) <= 180.0) || !(fabs(h->undulation_m) <= 200.0))
        return refuse(file, error, "its header has a place that cannot be");
    if (h->block_count < tiles * tiles || h->block_count > tiles * tiles + 2)
        return refuse(file, error, "its header has a number of blocks that cannot be");
    if (bytes < sizeof *h + h->block_count * sizeof(struct ground_block))
        return refuse(file, error, "its directory is cut off");
    return 0;
}

static bool block_fits(const struct ground_file *file, const struct ground_block *block,
                       uint32_t number)
{
    uint64_t end = file->header.bytes;
    struct ground_tile tile;
    if (block->offset > end || block->packed_bytes > end - block->offset)
        return false;
    if (number == file->tiles + 1)
        return block->kind == GROUND_BLOCK_ROADS && block->number == 0 &&
               block->content_bytes % sizeof(struct ground_road_point) == 0 &&
               block->content_bytes <= GROUND_ROAD_POINTS_MAX * sizeof(struct ground_road_point);
    if (number == file->tiles)
        return block->kind == GROUND_BLOCK_TEXT && block->number == 0 &&
               block->content_bytes <= GROUND_TEXT_BYTES_MAX;
    tile = ground_tile_of(file->header.posts_side, number);
    return block->kind == GROUND_BLOCK_TILE && block->number == number &&
           block->content_bytes == ground_tile_bytes(&tile);
}

static int check_directory(struct ground_file *file, struct error_text *error)
{
    const struct ground_header *h = &file->header;
    uint32_t tiles = ground_tiles_side(h->posts_side);
    file->blocks = (const struct ground_block *)(const void *)(file->mapped + sizeof *h);
    file->tiles = tiles * tiles;
    if (h->directory_hash != XXH3_64bits(file->blocks, h->block_count * sizeof *file->blocks))
        return refuse(file, error, "its directory is damaged");
    for (uint32_t i = 0; i < h->block_count; i++) {
        if (!block_fits(file, &file->blocks[i], i))
            return error_text_set(error, "%s: block %u of its directory cannot be", file->path, i);
    }
    if (h->block_count > file->tiles)
        file->text_bytes = file->blocks[file->tiles].content_bytes;
    if (h->block_count > file->tiles + 1)
        file->road_points = file->blocks[file->tiles + 1].content_bytes /
                            (uint32_t)sizeof(struct ground_road_point);
    if (h->hash != ground_file_hash(h, file->blocks))
        return refuse(file, error, "its hash is not that of its ground");
    return 0;
}

static int read_header(struct ground_file *file, int fd, uint64_t *bytes, struct error_text *error)
{
    struct ground_header *h = &file->header;
    struct stat status;
    if (fstat(fd, &status) != 0)
        return error_text_set(error, "%s: %s", file->path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_text_set(error, "%s: is no regular file", file->path);
    *bytes = (uint64_t)status.st_size;
    if (pread(fd, h, sizeof *h, 0) != (ssize_t)sizeof *h ||
        memcmp(h->magic, GROUND_MAGIC, sizeof h->magic) != 0)
        return error_text_set(error, "%s: is no ground file; jolon ground make makes one",
                              file->path);
    if (h->version != GROUND_VERSION)
        return error_text_set(error, "%s: has version %u of ground files; this build reads %u",
                              file->path, h->version, GROUND_VERSION);
    return check_header(file, *bytes, error);
}

int ground_file_open(struct ground_file *file, const char *path, struct error_text *error)
{
    uint64_t bytes = 0;
    memset(file, 0, sizeof *file);
    if ((size_t)snprintf(file->path, sizeof file->path, "%s", path) >= sizeof file->path)
        return error_text_set(error, "%.60s...: is too long for a path", path);
    /* Without waiting, because the path may be that of a pipe. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    int result = read_header(file, fd, &bytes, error);
    if (result == 0) {
        void *mapped = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, fd, 0);
        file->mapped = mapped != MAP_FAILED ? mapped : NULL;
        result = file->mapped ? check_directory(file, error)
                              : error_text_set(error, "%s: %s", path, strerror(errno));
    }
    close(fd);
    if (result != 0)
        ground_file_close(file);
    return result;
}

void ground_file_close(struct ground_file *file)
{
    if (file->mapped)
        munmap((void *)(uintptr_t)file->mapped, file->header.bytes);
    file->mapped = NULL;
}

/* Unpacks a block into content [content_bytes] and checks its hash. */
static int unpack(const struct ground_file *file, uint32_t index, void *content,
                  struct error_text *error)
{
    const struct ground_block *block = &file->blocks[index];
    size_t bytes = ZSTD_decompress(content, block->content_bytes, file->mapped + block->offset,
                                   block->packed_bytes);
    if (ZSTD_isError(bytes) || bytes != block->content_bytes ||
        XXH3_64bits(content, bytes) != block->content_hash)
        return error_text_set(error, "%s: block %u is damaged; make it again by: jolon ground make",
                              file->path, index);
    return 0;
}

int ground_file_tile(const struct ground_file *file, uint32_t number, float *posts, uint8_t *cover,
                     size_t stride, struct error_text *error)
{
    struct ground_tile tile = ground_tile_of(file->header.posts_side, number);
    uint8_t *content = malloc(ground_tile_bytes(&tile));
    if (!content)
        return error_text_memory(error);
    int result = unpack(file, number, content, error);
    if (result == 0 && !ground_tile_unpack(&tile, content, posts, cover, stride))
        result = error_text_set(error, "%s: tile %u has a height or a cover that cannot be",
                                file->path, number);
    free(content);
    return result;
}

int ground_file_posts(const struct ground_file *file, float *posts, uint8_t *cover,
                      struct error_text *error)
{
    uint32_t side = file->header.posts_side;
    for (uint32_t i = 0; i < file->tiles; i++) {
        struct ground_tile tile = ground_tile_of(side, i);
        size_t first = (size_t)tile.row * side + tile.column;
        if (ground_file_tile(file, i, posts + first, cover + first, side, error) != 0)
            return -1;
    }
    return 0;
}

/* Returns true if the points lie within the square and are the roads 0, 1, 2 ... of two points or
 * more. */
static bool roads_fit(const struct ground_road_point *points, uint32_t count, double side_m)
{
    double side_mm = side_m * 1000.0;
    for (uint32_t i = 0; i < count; i++) {
        const struct ground_road_point *p = &points[i];
        bool begins = i == 0 || p->road != p[-1].road,
             ends = i + 1 == count || p->road != p[1].road;
        uint32_t expected = i == 0 ? 0 : p[-1].road + begins;
        if (p->road != expected || (begins && ends) || p->x_mm < 0 || p->z_mm < 0 ||
            p->x_mm > side_mm || p->z_mm > side_mm)
            return false;
    }
    return true;
}

int ground_file_roads(const struct ground_file *file, struct ground_road_point *points,
                      struct error_text *error)
{
    if (file->road_points == 0)
        return 0;
    if (unpack(file, file->tiles + 1, points, error) != 0)
        return -1;
    return roads_fit(points, file->road_points, file->header.side_m)
               ? 0
               : error_text_set(error, "%s: has roads that cannot be", file->path);
}

int ground_file_text(const struct ground_file *file, char *text, struct error_text *error)
{
    if (file->text_bytes > 0 && unpack(file, file->tiles, text, error) != 0)
        return -1;
    for (uint32_t i = 0; i < file->text_bytes; i++) {
        unsigned char c = (unsigned char)text[i];
        if ((c < 0x20 && c != '\n') || c == 0x7f)
            text[i] = ' ';
    }
    text[file->text_bytes] = '\0';
    return 0;
}
