/* PNG output at one fast setting, since pictures are many and disks are large. libdeflate
 * compresses in half of zlib's time and to fewer bytes. */
#include "renderer/image/png.h"

#include <libdeflate.h>

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PATH_BYTES   4096
#define LEVEL        1  /* of 12; level 2 takes half as long again for 3 % fewer bytes */
#define FILTER_SUB   1  /* subtracts from each byte that of the pixel to its left */
#define PIXEL_BYTES  3  /* red, green, blue */
#define CHUNK_BYTES  12 /* length, type and checksum of a chunk without content */
#define HEADER_BYTES 13 /* content of IHDR */

static const uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
static const char key[] = "Description"; /* tEXt includes its NUL */

/* A file that is being built. */
struct bytes {
    uint8_t *at;
    size_t used;
};

static void put_u32(uint8_t *to, size_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Completes the chunk whose content is already at file->used + 8. */
static void close_chunk(struct bytes *file, const char *type, size_t length)
{
    uint8_t *chunk = file->at + file->used;
    put_u32(chunk, length);
    memcpy(chunk + 4, type, 4);
    put_u32(chunk + 8 + length, libdeflate_crc32(0, chunk + 4, length + 4));
    file->used += CHUNK_BYTES + length;
}

static uint8_t *content(const struct bytes *file)
{
    return file->at + file->used + 8;
}

static void put_header(struct bytes *file, const struct image *image)
{
    uint8_t *header = content(file);
    put_u32(header, image->width);
    put_u32(header + 4, image->height);
    /* 8 bits each of red, green, blue; the only compression and filter methods; not interlaced. */
    memcpy(header + 8, (const uint8_t[]){8, 2, 0, 0, 0}, 5);
    close_chunk(file, "IHDR", HEADER_BYTES);
}

static void put_text(struct bytes *file, const char *comment)
{
    size_t length = strlen(comment);
    memcpy(content(file), key, sizeof key);
    memcpy(content(file) + sizeof key, comment, length + 1); /* its NUL is overwritten later */
    close_chunk(file, "tEXt", sizeof key + length);
}

static void filter_row(uint8_t *restrict to, const uint8_t *restrict from, uint32_t width)
{
    *to++ = FILTER_SUB;
    memcpy(to, from, PIXEL_BYTES);
    for (uint32_t x = 1; x < width; x++) {
        to[3 * x] = (uint8_t)(from[4 * x] - from[4 * x - 4]);
        to[3 * x + 1] = (uint8_t)(from[4 * x + 1] - from[4 * x - 3]);
        to[3 * x + 2] = (uint8_t)(from[4 * x + 2] - from[4 * x - 2]);
    }
}

static int put_pixels(struct bytes *file, const struct image *image, uint8_t *rows, size_t length,
                      size_t capacity)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    if (compressor == NULL)
        return -1;
    size_t row = 1 + (size_t)image->width * PIXEL_BYTES;
    for (uint32_t y = 0; y < image->height; y++)
        filter_row(rows + y * row, image->pixels + (size_t)y * image->width * 4, image->width);
    size_t packed = libdeflate_zlib_compress(compressor, rows, length, content(file), capacity);
    libdeflate_free_compressor(compressor);
    close_chunk(file, "IDAT", packed);
    return 0;
}

int png_encode(const struct image *image, const char *comment, uint8_t **bytes, size_t *count)
{
    size_t length = image->height * (1 + (size_t)image->width * PIXEL_BYTES);
    size_t capacity = libdeflate_zlib_compress_bound(NULL, length);
    uint8_t *rows = malloc(length);
    struct bytes file = {.at = malloc(sizeof signature + HEADER_BYTES + sizeof key +
                                      strlen(comment) + capacity + (size_t)4 * CHUNK_BYTES)};
    int result = -1;
    if (rows != NULL && file.at != NULL) {
        memcpy(file.at, signature, sizeof signature);
        file.used = sizeof signature;
        put_header(&file, image);
        put_text(&file, comment);
        result = put_pixels(&file, image, rows, length, capacity);
    }
    free(rows);
    if (result != 0) {
        free(file.at);
        errno = ENOMEM;
        return -1;
    }
    close_chunk(&file, "IEND", 0);
    *bytes = file.at;
    *count = file.used;
    return 0;
}

/* Removes the file that an earlier process with the same id left there when it was killed. */
static int create_file(int folder, const char *path)
{
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    int fd = openat(folder, path, flags, 0600);
    if (fd < 0 && errno == EEXIST && unlinkat(folder, path, 0) == 0)
        fd = openat(folder, path, flags, 0600);
    return fd;
}

static int write_all(int fd, const uint8_t *bytes, size_t count)
{
    while (count > 0) {
        ssize_t written = write(fd, bytes, count);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return -1;
        bytes += written;
        count -= (size_t)written;
    }
    return 0;
}

/* Creates a file and writes all of it. */
static int create_and_write(int folder, const char *path, const uint8_t *bytes, size_t count)
{
    int fd = create_file(folder, path);
    if (fd < 0)
        return -1;
    int result = write_all(fd, bytes, count);
    int cause = errno;
    /* A full disk may be reported only here. */
    if (close(fd) != 0 && result == 0) {
        result = -1;
        cause = errno;
    }
    errno = cause;
    return result;
}

int png_write_file(int folder, const char *path, const struct image *image, const char *comment)
{
    char temporary[PATH_BYTES];
    uint8_t *bytes;
    size_t count;
    int length = snprintf(temporary, sizeof temporary, "%s.%ld.tmp", path, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof temporary) {
        errno = ENAMETOOLONG;
        return -1;
    }
    if (png_encode(image, comment, &bytes, &count) != 0)
        return -1;
    int result = create_and_write(folder, temporary, bytes, count);
    if (result == 0)
        result = renameat(folder, temporary, folder, path);
    int cause = errno;
    free(bytes);
    if (result != 0)
        unlinkat(folder, temporary, 0);
    errno = cause;
    return result;
}
