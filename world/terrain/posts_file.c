/* The reader of posts files. */
#include "world/terrain/posts_file.h"

#include "world/maths/hash.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define PIECE_BYTES (64u << 20) /* read at once; a multiple of the pages of every kernel */

_Static_assert(sizeof(struct posts_file_header) <= POSTS_FILE_ALIGN, "the header has its pages");

static size_t aligned(size_t bytes)
{
    return (bytes + POSTS_FILE_ALIGN - 1) / POSTS_FILE_ALIGN * POSTS_FILE_ALIGN;
}

size_t posts_file_heights(void)
{
    return POSTS_FILE_ALIGN;
}

size_t posts_file_cover(uint32_t posts_side)
{
    return aligned(posts_file_heights() + (size_t)posts_side * posts_side * sizeof(float));
}

size_t posts_file_bytes(uint32_t posts_side)
{
    return posts_file_cover(posts_side) + (size_t)posts_side * posts_side;
}

uint64_t posts_file_header_hash(const struct posts_file_header *header)
{
    const size_t first = offsetof(struct posts_file_header, version);
    return XXH3_64bits((const char *)header + first,
                       offsetof(struct posts_file_header, header_hash) - first);
}

int posts_file_path(char path[PATH_MAX], const char *ground, struct error_text *error)
{
    if ((size_t)snprintf(path, PATH_MAX, "%s" POSTS_FILE_SUFFIX, ground) >= PATH_MAX)
        return error_text_set(error, "%.60s...: is too long for a path", ground);
    return 0;
}

static int check(const struct posts_file_header *header, const char *path, uint64_t bytes,
                 const struct posts_file_ground *ground, struct error_text *error)
{
    const char *wrong = NULL;
    if (memcmp(header->magic, POSTS_FILE_MAGIC, sizeof header->magic) != 0 ||
        header->version != POSTS_FILE_VERSION ||
        header->header_hash != posts_file_header_hash(header))
        wrong = "is no posts file, or a damaged one";
    else if (header->ground_hash != ground->hash || header->posts_side != ground->posts_side ||
             header->side_m < ground->side_m || header->side_m > ground->side_m)
        wrong = "has the posts of another ground";
    else if (header->bytes != bytes || bytes != posts_file_bytes(ground->posts_side))
        wrong = "is cut off";
    return wrong ? error_text_set(error, "%s: %s; jolon world create on %s makes it again", path,
                                  wrong, ground->path)
                 : 0;
}

static int map(struct posts_file *file, int fd, const char *path,
               const struct posts_file_ground *ground, struct error_text *error)
{
    struct posts_file_header header;
    struct stat status;
    if (fstat(fd, &status) != 0)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode) || pread(fd, &header, sizeof header, 0) != (ssize_t)sizeof header)
        memset(&header, 0, sizeof header);
    if (check(&header, path, (uint64_t)status.st_size, ground, error) != 0)
        return -1;
    file->bytes = (size_t)status.st_size;
    void *mapped = mmap(NULL, file->bytes, PROT_READ, MAP_SHARED, fd, 0);
    if (mapped == MAP_FAILED)
        return error_text_set(error, "%s: cannot map %zu bytes: %s", path, file->bytes,
                              strerror(errno));
    /* Reading ahead would bring in ground where nothing happens. It is only advice. */
    (void)madvise(mapped, file->bytes, MADV_RANDOM);
    file->mapped = mapped;
    file->posts = (const float *)(const void *)((const char *)mapped + posts_file_heights());
    file->cover = (const uint8_t *)mapped + posts_file_cover(ground->posts_side);
    return 0;
}

int posts_file_open(struct posts_file *file, const struct posts_file_ground *ground,
                    struct error_text *error)
{
    char path[PATH_MAX];
    *file = (struct posts_file){.mapped = NULL};
    if (posts_file_path(path, ground->path, error) != 0)
        return -1;
    /* Without waiting, because the path may be that of a pipe. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return error_text_set(error, "%s: %s; jolon world create on %s makes it", path,
                              strerror(errno), ground->path);
    int result = map(file, fd, path, ground, error);
    close(fd);
    return result;
}

void posts_file_close(struct posts_file *file)
{
    if (file->mapped)
        munmap(file->mapped, file->bytes);
    *file = (struct posts_file){.mapped = NULL};
}

/* Hashes a part of the file piece by piece, and gives the memory of each piece back: a square of
 * 500 km has 1.3 GB. */
static uint64_t hash_part(XXH3_state_t *hash, const void *part, size_t bytes)
{
    const char *from = part;
    XXH3_64bits_reset(hash);
    while (bytes > 0) {
        size_t piece = bytes < PIECE_BYTES ? bytes : PIECE_BYTES;
        (void)madvise((void *)(uintptr_t)from, piece, MADV_WILLNEED);
        XXH3_64bits_update(hash, from, piece);
        (void)madvise((void *)(uintptr_t)from, piece, MADV_DONTNEED);
        from += piece;
        bytes -= piece;
    }
    return XXH3_64bits_digest(hash);
}

int posts_file_verify(const struct posts_file *file, struct error_text *error)
{
    const struct posts_file_header *header = file->mapped;
    size_t posts = (size_t)header->posts_side * header->posts_side;
    XXH3_state_t *hash = XXH3_createState();
    if (!hash)
        return error_text_memory(error);
    bool whole =
        hash_part(hash, file->posts, posts * sizeof *file->posts) == header->heights_hash &&
        hash_part(hash, file->cover, posts) == header->cover_hash;
    XXH3_freeState(hash);
    if (whole)
        return 0;
    return error_text_set(error,
                          "the posts file of its ground is damaged: it fails its hashes; jolon "
                          "world create makes it again");
}
