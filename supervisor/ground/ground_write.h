/* Writes ground files. */
#ifndef JOLON_SUPERVISOR_GROUND_GROUND_WRITE_H
#define JOLON_SUPERVISOR_GROUND_GROUND_WRITE_H

#include "world/runtime/error_text.h"
#include "world/terrain/ground_format.h"

struct thread_pool;

/* Writes a ground into the file at path. The header has flags, place, sides and undulation; the
 * rest is filled in. posts, cover: [posts_side * posts_side], heights rounded by
 * ground_tile_round(). text: sources and licences.
 * roads: of the square, NULL with a count of 0.
 *
 * The file is written aside, brought to the disk and renamed: a process that is killed leaves the
 * old one. Files that killed writers left are removed. 0, or -1 with the reason. */
int ground_write(const char *path, struct ground_header *header, const float *posts,
                 const uint8_t *cover, const char *text, const struct ground_road_point *roads,
                 uint32_t road_points, struct thread_pool *pool, struct error_text *error);

#endif
