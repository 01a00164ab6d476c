/* Writes ground files. */
#ifndef JOLON_SUPERVISOR_GROUND_GROUND_WRITE_H
#define JOLON_SUPERVISOR_GROUND_GROUND_WRITE_H

#include "world/runtime/error_text.h"
#include "world/terrain/ground_format.h"

struct thread_pool;

/* What a ground has beside its header. Rows of a count of 0 may be NULL. */
struct ground_content {
    const float *posts;   /* [posts_side * posts_side], rounded by ground_tile_round() */
    const uint8_t *cover; /* the same number */
    const char *text;     /* sources and licences */
    const struct ground_road_point *roads;
    const struct ground_object *objects;
    const struct ground_building *buildings;
    const struct ground_corner *corners;
    uint32_t road_points, object_count, building_count, corner_count;
};

/* Writes a ground into the file at path. The header has flags, place, sides and undulation; the
 * rest is filled in.
 *
 * The file is written aside, brought to the disk and renamed: a process that is killed leaves the
 * old one. Files that killed writers left are removed. 0, or -1 with the reason. */
int ground_write(const char *path, struct ground_header *header,
                 const struct ground_content *content, struct thread_pool *pool,
                 struct error_text *error);

#endif
