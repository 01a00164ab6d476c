/* Posts files: the posts of a ground and their cover as a world reads them, row by row, for grounds
 * of more posts than a world's memory has room for (GROUND_WORLD_POSTS_MAX along an edge). A posts
 * file lies beside its ground file, follows from it alone, and is never changed. It is mapped
 * read-only, so that a world of 500 km holds the pages of the places where something happens.
 *
 * Little-endian: a header of POSTS_FILE_ALIGN bytes, heights [m], from the next multiple of
 * POSTS_FILE_ALIGN on one byte of cover for each post. */
#ifndef JOLON_WORLD_TERRAIN_POSTS_FILE_H
#define JOLON_WORLD_TERRAIN_POSTS_FILE_H

#include "world/runtime/error_text.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#define POSTS_FILE_MAGIC   "JOLONPST"
#define POSTS_FILE_VERSION 1u
#define POSTS_FILE_ALIGN   65536u /* a multiple of the pages of every kernel */
#define POSTS_FILE_SUFFIX  ".posts"

struct posts_file_header {
    char magic[8]; /* POSTS_FILE_MAGIC, written last */
    uint32_t version, posts_side;
    double side_m;
    uint64_t ground_hash;              /* of the ground file */
    uint64_t bytes;                    /* of the file */
    uint64_t heights_hash, cover_hash; /* XXH3 of all heights, and of all cover */
    uint64_t header_hash;              /* XXH3 of the members between magic and this one */
};

struct posts_file {
    void *mapped; /* NULL: none is open */
    size_t bytes;
    const float *posts;   /* [posts_side * posts_side, m] */
    const uint8_t *cover; /* [posts_side * posts_side] */
};

/* The ground that a posts file belongs to. */
struct posts_file_ground {
    const char *path; /* of the ground file */
    uint64_t hash;
    double side_m;
    uint32_t posts_side;
};

/* Where the heights and the cover begin, and the length of the file [byte]. */
size_t posts_file_heights(void);
size_t posts_file_cover(uint32_t posts_side);
size_t posts_file_bytes(uint32_t posts_side);

uint64_t posts_file_header_hash(const struct posts_file_header *header);

/* Writes the path of the posts file of a ground file. Returns 0, or -1 with the reason. */
int posts_file_path(char path[PATH_MAX], const char *ground, struct error_text *error);

/* Maps the posts file of a ground and checks its header and its length. 0, or -1 with the reason,
 * which says what is missing and what makes it. file is then closed. */
int posts_file_open(struct posts_file *file, const struct posts_file_ground *ground,
                    struct error_text *error);
void posts_file_close(struct posts_file *file);

/* Reads all of an open file and compares it with its hashes: 1.3 GB of a square of 500 km. 0, or -1
 * with the reason. */
int posts_file_verify(const struct posts_file *file, struct error_text *error);

#endif
