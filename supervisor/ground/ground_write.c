/* Packs the tiles of a ground and writes them aside; the file gets its name at the end. */
#include "supervisor/ground/ground_write.h"

#include "ipc/process/stale_files.h"
#include "supervisor/ground/progress.h"
#include "world/maths/hash.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/ground_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

/* Of zstd: level 9 makes a ground of 1" heights an eighth smaller than 3, at a third of the speed,
 * and is still faster than GDAL reads them. */
#define PACK_LEVEL 9

/* A file that is being written. */
struct writing {
    char folder[PATH_MAX], aside[PATH_MAX + 64];
    const char *path;
    int fd;
    uint64_t bytes; /* so far */
    struct ground_header *header;
    struct ground_block *blocks;
    uint32_t used;
};

/* One row of tiles, which the threads share. */
struct tile_row {
    const struct ground_header *header;
    const float *posts;
    const uint8_t *cover;
    struct ground_block *blocks; /* of the whole file */
    uint32_t first;              /* tile */
    uint8_t *content[THREAD_POOL_MAX];
    uint8_t **packed; /* [tiles along an edge] */
    size_t room;
};

static void pack_tiles(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct tile_row *row = context;
    for (uint32_t i = first; i < end; i++) {
        struct ground_tile tile = ground_tile_of(row->header->posts_side, row->first + i);
        struct ground_block *block = &row->blocks[row->first + i];
        uint32_t bytes = ground_tile_bytes(&tile);
        ground_tile_pack(&tile, row->posts, row->cover, row->header->posts_side,
                         row->content[worker]);
        size_t packed =
            ZSTD_compress(row->packed[i], row->room, row->content[worker], bytes, PACK_LEVEL);
        *block = (struct ground_block){.kind = GROUND_BLOCK_TILE,
                                       .number = row->first + i,
                                       .packed_bytes = ZSTD_isError(packed) ? 0 : (uint32_t)packed,
                                       .content_bytes = bytes,
                                       .content_hash = XXH3_64bits(row->content[worker], bytes)};
    }
}

static int put(struct writing *w, const void *bytes, size_t count, struct error_text *error)
{
    const char *from = bytes;
    for (size_t done = 0; done < count;) {
        ssize_t written = pwrite(w->fd, from + done, count - done, (off_t)(w->bytes + done));
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return error_text_set(error, "%s: cannot be written: %s", w->path, strerror(errno));
        done += (size_t)written;
    }
    w->bytes += count;
    return 0;
}

static int put_row(struct writing *w, struct tile_row *row, uint32_t tiles,
                   struct thread_pool *pool, struct error_text *error)
{
    thread_pool_run(pool, pack_tiles, row, tiles, 1);
    for (uint32_t i = 0; i < tiles; i++) {
        struct ground_block *block = &w->blocks[row->first + i];
        if (block->packed_bytes == 0)
            return error_text_memory(error);
        block->offset = w->bytes;
        if (put(w, row->packed[i], block->packed_bytes, error) != 0)
            return -1;
    }
    w->used += tiles;
    return 0;
}

static int put_tiles(struct writing *w, const float *posts, const uint8_t *cover,
                     struct thread_pool *pool, struct error_text *error)
{
    uint32_t tiles = ground_tiles_side(w->header->posts_side);
    struct tile_row row = {.header = w->header,
                           .posts = posts,
                           .cover = cover,
                           .blocks = w->blocks,
                           .packed = calloc(tiles, sizeof *row.packed),
                           .room = ZSTD_compressBound(GROUND_TILE_BYTES_MAX)};
    int result = row.packed ? 0 : error_text_memory(error);
    for (uint32_t i = 0; i < THREAD_POOL_MAX && result == 0; i++) {
        row.content[i] = malloc(GROUND_TILE_BYTES_MAX);
        result = row.content[i] ? 0 : error_text_memory(error);
    }
    for (uint32_t i = 0; i < tiles && result == 0; i++) {
        row.packed[i] = malloc(row.room);
        result = row.packed[i] ? 0 : error_text_memory(error);
    }
    for (uint32_t i = 0; i < tiles && result == 0; i++, row.first += tiles) {
        result = put_row(w, &row, tiles, pool, error);
        progress_show("packing", i + 1, tiles);
    }
    for (uint32_t i = 0; i < tiles && row.packed; i++)
        free(row.packed[i]);
    for (uint32_t i = 0; i < THREAD_POOL_MAX; i++)
        free(row.content[i]);
    free(row.packed);
    return result;
}

/* Packs and writes a block that is no tile. */
static int put_block(struct writing *w, enum ground_block_kind kind, const void *content,
                     size_t bytes, struct error_text *error)
{
    size_t room = ZSTD_compressBound(bytes);
    void *packed = malloc(room);
    if (!packed)
        return error_text_memory(error);
    size_t count = ZSTD_compress(packed, room, content, bytes, PACK_LEVEL);
    struct ground_block block = {.kind = kind,
                                 .offset = w->bytes,
                                 .packed_bytes = (uint32_t)count,
                                 .content_bytes = (uint32_t)bytes,
                                 .content_hash = XXH3_64bits(content, bytes)};
    int result = ZSTD_isError(count) ? error_text_memory(error) : put(w, packed, count, error);
    w->blocks[w->used++] = block;
    free(packed);
    return result;
}

static void find_range(struct ground_header *header, const float *posts)
{
    header->lowest_m = header->highest_m = posts[0];
    for (size_t i = 1; i < (size_t)header->posts_side * header->posts_side; i++) {
        header->lowest_m = posts[i] < header->lowest_m ? posts[i] : header->lowest_m;
        header->highest_m = posts[i] > header->highest_m ? posts[i] : header->highest_m;
    }
}

/* The header and the directory come last, at the beginning of the file. */
static int put_beginning(struct writing *w, struct error_text *error)
{
    struct ground_header *h = w->header;
    size_t bytes = w->used * sizeof *w->blocks;
    memcpy(h->magic, GROUND_MAGIC, sizeof h->magic);
    h->version = GROUND_VERSION;
    h->block_count = w->used;
    h->bytes = w->bytes;
    h->directory_hash = XXH3_64bits(w->blocks, bytes);
    h->hash = ground_file_hash(h, w->blocks);
    h->header_hash = XXH3_64bits(h, offsetof(struct ground_header, header_hash));
    w->bytes = 0;
    if (put(w, h, sizeof *h, error) != 0 || put(w, w->blocks, bytes, error) != 0)
        return -1;
    return fsync(w->fd) == 0 ? 0
                             : error_text_set(error, "%s: cannot be brought to the disk: %s",
                                              w->path, strerror(errno));
}

static int open_aside(struct writing *w, struct error_text *error)
{
    char prefix[NAME_MAX + 4];
    const char *slash = strrchr(w->path, '/'), *name = slash ? slash + 1 : w->path;
    snprintf(w->folder, sizeof w->folder, "%.*s", slash ? (int)(slash - w->path + 1) : 2,
             slash ? w->path : "./");
    if (*name == '\0' || strlen(name) > NAME_MAX - 20)
        return error_text_set(error, "%s: is no name for a file", w->path);
    snprintf(prefix, sizeof prefix, ".%.230s.", name);
    stale_files_sweep(w->folder, prefix);
    snprintf(w->aside, sizeof w->aside, "%.3800s%s%d", w->folder, prefix, getpid());
    w->fd = open(w->aside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    return w->fd >= 0
               ? 0
               : error_text_set(error, "%s: cannot be written: %s", w->path, strerror(errno));
}

/* Puts what is not in tiles: the text, and of the rest what there is. */
static int put_lists(struct writing *w, const struct ground_content *c, struct error_text *error)
{
    const struct {
        enum ground_block_kind kind;
        const void *rows;
        size_t bytes;
    } lists[] = {
        {GROUND_BLOCK_TEXT, c->text, strlen(c->text)},
        {GROUND_BLOCK_ROADS, c->roads, c->road_points * sizeof *c->roads},
        {GROUND_BLOCK_OBJECTS, c->objects, c->object_count * sizeof *c->objects},
        {GROUND_BLOCK_BUILDINGS, c->buildings, c->building_count * sizeof *c->buildings},
        {GROUND_BLOCK_CORNERS, c->corners, c->corner_count * sizeof *c->corners},
    };
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        if ((i == 0 || lists[i].bytes > 0) &&
            put_block(w, lists[i].kind, lists[i].rows, lists[i].bytes, error) != 0)
            return -1;
    }
    return 0;
}

int ground_write(const char *path, struct ground_header *header,
                 const struct ground_content *content, struct thread_pool *pool,
                 struct error_text *error)
{
    uint32_t tiles = ground_tiles_side(header->posts_side);
    size_t blocks = (size_t)tiles * tiles + 1 + (content->road_points > 0) +
                    (content->object_count > 0) + (content->building_count > 0) +
                    (content->corner_count > 0);
    struct writing w = {.path = path, .header = header};
    w.blocks = calloc(blocks, sizeof *w.blocks);
    if (!w.blocks)
        return error_text_memory(error);
    int result = open_aside(&w, error);
    if (result == 0) {
        w.bytes = sizeof *header + blocks * sizeof *w.blocks;
        find_range(header, content->posts);
        if (put_tiles(&w, content->posts, content->cover, pool, error) != 0 ||
            put_lists(&w, content, error) != 0 || put_beginning(&w, error) != 0)
            result = -1;
        if (close(w.fd) != 0 && result == 0)
            result = error_text_set(error, "%s: cannot be written: %s", path, strerror(errno));
        if (result == 0 && rename(w.aside, path) != 0)
            result = error_text_set(error, "%s: cannot be renamed: %s", path, strerror(errno));
        if (result != 0)
            unlink(w.aside);
    }
    free(w.blocks);
    return result;
}
