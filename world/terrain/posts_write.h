/* Writes the posts file of a ground file. Called at creation only. */
#ifndef JOLON_WORLD_TERRAIN_POSTS_WRITE_H
#define JOLON_WORLD_TERRAIN_POSTS_WRITE_H

#include <stdint.h>

struct error_text;
struct ground_file;

/* Makes the posts file beside a ground file, tile by tile, unless it is there and belongs to this
 * ground. It is written aside, brought to the disk and renamed: a kill leaves the old one. Of two
 * makers at once the second waits for the first. 0, or -1 with the reason: no room on the disk, or
 * no right to write there. */
int posts_write(const struct ground_file *file, struct error_text *error);

/* The same by path and hash: refuses a ground file that is missing or has another hash. */
int posts_write_for(const char *ground, uint64_t hash, struct error_text *error);

#endif
