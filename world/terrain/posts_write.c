/* Unpacks the tiles of a ground file, one row of tiles after the other. */
#include "world/terrain/posts_write.h"

#include "world/maths/hash.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/posts_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define ASIDE ".new"

struct writing {
    const struct ground_file *file;
    char path[PATH_MAX], aside[PATH_MAX + sizeof ASIDE];
    int fd;
    float *posts; /* [posts_side * GROUND_TILE_POSTS] of a row of tiles */
    uint8_t *cover;
    XXH3_state_t *heights_hash, *cover_hash;
    struct error_text *error;
};

static int failed(const struct writing *w)
{
    double mb = (double)posts_file_bytes(w->file->header.posts_side) / 1e6;
    return error_text_set(w->error,
                          "%s: cannot write %.0f MB of posts beside the ground file: %s; copy the "
                          "ground file to a folder that can be written and has room",
                          w->aside, mb, strerror(errno));
}

static int put(const struct writing *w, const void *bytes, size_t count, size_t at)
{
    const char *from = bytes;
    while (count > 0) {
        ssize_t done = pwrite(w->fd, from, count, (off_t)at);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return failed(w);
        from += done;
        at += (size_t)done;
        count -= (size_t)done;
    }
    return 0;
}

/* Writes a row of tiles. */
static int put_tiles(const struct writing *w, uint32_t row)
{
    uint32_t side = w->file->header.posts_side, tiles = ground_tiles_side(side), rows = 0;
    for (uint32_t i = 0; i < tiles; i++) {
        struct ground_tile tile = ground_tile_of(side, row * tiles + i);
        rows = tile.rows;
        if (ground_file_tile(w->file, row * tiles + i, w->posts + tile.column,
                             w->cover + tile.column, side, w->error) != 0)
            return -1;
    }
    size_t first = (size_t)row * GROUND_TILE_POSTS * side, count = (size_t)rows * side;
    XXH3_64bits_update(w->heights_hash, w->posts, count * sizeof *w->posts);
    XXH3_64bits_update(w->cover_hash, w->cover, count);
    return put(w, w->posts, count * sizeof *w->posts,
               posts_file_heights() + first * sizeof *w->posts) == 0
               ? put(w, w->cover, count, posts_file_cover(side) + first)
               : -1;
}

static int put_header(const struct writing *w)
{
    const struct ground_header *ground = &w->file->header;
    struct posts_file_header header = {.version = POSTS_FILE_VERSION,
                                       .posts_side = ground->posts_side,
                                       .side_m = ground->side_m,
                                       .ground_hash = ground->hash,
                                       .bytes = posts_file_bytes(ground->posts_side),
                                       .heights_hash = XXH3_64bits_digest(w->heights_hash),
                                       .cover_hash = XXH3_64bits_digest(w->cover_hash)};
    memcpy(header.magic, POSTS_FILE_MAGIC, sizeof header.magic);
    header.header_hash = posts_file_header_hash(&header);
    return put(w, &header, sizeof header, 0);
}

/* Fills the file aside and gives it its name. */
static int fill(struct writing *w)
{
    uint32_t side = w->file->header.posts_side;
    int code = posix_fallocate(w->fd, 0, (off_t)posts_file_bytes(side));
    if (code != 0) {
        errno = code;
        return failed(w);
    }
    XXH3_64bits_reset(w->heights_hash);
    XXH3_64bits_reset(w->cover_hash);
    for (uint32_t row = 0; row < ground_tiles_side(side); row++) {
        if (put_tiles(w, row) != 0)
            return -1;
    }
    if (put_header(w) != 0)
        return -1;
    return fsync(w->fd) == 0 && rename(w->aside, w->path) == 0 ? 0 : failed(w);
}

/* Reads all of the file: a world must not run on another ground than its hash says. */
static bool is_there(const struct writing *w)
{
    const struct ground_header *ground = &w->file->header;
    const struct posts_file_ground wanted = {w->file->path, ground->hash, ground->side_m,
                                             ground->posts_side};
    struct posts_file found;
    struct error_text reason;
    if (posts_file_open(&found, &wanted, &reason) != 0)
        return false;
    bool whole = posts_file_verify(&found, &reason) == 0;
    posts_file_close(&found);
    return whole;
}

/* Opens the file aside for this maker alone. One that another maker left is taken over. */
static int open_aside(struct writing *w)
{
    struct stat held, named;
    for (;;) {
        w->fd = open(w->aside, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
        if (w->fd < 0)
            return failed(w);
        if (flock(w->fd, LOCK_EX) != 0 || fstat(w->fd, &held) != 0 || !S_ISREG(held.st_mode))
            return failed(w);
        /* Whoever held the lock may have renamed the file. */
        if (stat(w->aside, &named) == 0 && named.st_ino == held.st_ino)
            return 0;
        close(w->fd);
    }
}

static int write_all(struct writing *w)
{
    size_t band = (size_t)w->file->header.posts_side * GROUND_TILE_POSTS;
    int result = -1;
    if (open_aside(w) != 0)
        goto done;
    if (is_there(w)) {
        unlink(w->aside);
        result = 0;
        goto done;
    }
    w->posts = malloc(band * sizeof *w->posts);
    w->cover = malloc(band);
    w->heights_hash = XXH3_createState();
    w->cover_hash = XXH3_createState();
    result = w->posts && w->cover && w->heights_hash && w->cover_hash ? fill(w)
                                                                      : error_text_memory(w->error);
    if (result != 0)
        unlink(w->aside);
    free(w->posts);
    free(w->cover);
    XXH3_freeState(w->heights_hash);
    XXH3_freeState(w->cover_hash);
done:
    if (w->fd >= 0)
        close(w->fd);
    return result;
}

int posts_write(const struct ground_file *file, struct error_text *error)
{
    struct writing w = {.file = file, .fd = -1, .error = error};
    if (is_there(&w))
        return 0;
    if (posts_file_path(w.path, file->path, error) != 0)
        return -1;
    snprintf(w.aside, sizeof w.aside, "%s" ASIDE, w.path);
    return write_all(&w);
}

int posts_write_for(const char *ground, uint64_t hash, struct error_text *error)
{
    struct ground_file file;
    int result = -1;
    if (ground_file_open(&file, ground, error) != 0)
        return -1;
    if (file.header.hash == hash)
        result = posts_write(&file, error);
    else
        error_text_set(error,
                       "%s: has the hash %016" PRIx64 "; the world needs the ground %016" PRIx64,
                       ground, file.header.hash, hash);
    ground_file_close(&file);
    return result;
}
