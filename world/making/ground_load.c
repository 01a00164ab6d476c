/* Ground from a file. */
#include "world/making/ground_load.h"

#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/runtime/error_text.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_file.h"

#include <inttypes.h>
#include <stdlib.h>

static int load_roads(struct world_build *built, const struct ground_file *file,
                      struct error_text *error)
{
    uint32_t count = file->road_points;
    struct ground_road_point *points = calloc(count + 1, sizeof *points);
    built->roads = calloc(count + 1, sizeof *built->roads);
    if (!points || !built->roads) {
        free(points);
        return error_text_memory(error);
    }
    int result = ground_file_roads(file, points, error);
    for (uint32_t i = 0; i < count; i++)
        built->roads[i] = (struct road_point){.x = (float)(points[i].x_mm / 1000.0),
                                              .z = (float)(points[i].z_mm / 1000.0),
                                              .road = points[i].road};
    built->counts.road_points = count;
    free(points);
    return result;
}

static int load(struct world_build *built, const struct ground_file *file, struct error_text *error)
{
    const struct scenario_settings *settings = built->scenario->settings;
    uint32_t side = file->header.posts_side;
    size_t posts = (size_t)side * side;
    if (file->header.hash != settings->ground_hash)
        return error_text_set(
            error,
            "%s: has changed since the scenario was read: its hash was %016" PRIx64
            " and is %016" PRIx64,
            file->path, settings->ground_hash, file->header.hash);
    if (file->header.side_m != WORLD_SIDE_M || side > GROUND_WORLD_POSTS_MAX)
        return error_text_set(error, "%s: has a side or a number of posts that no world has",
                              file->path);
    built->counts.posts_side = side;
    built->posts = malloc(posts * sizeof *built->posts);
    built->cover = malloc(posts);
    if (!built->posts || !built->cover)
        return error_text_memory(error);
    return ground_file_posts(file, built->posts, built->cover, error) == 0
               ? load_roads(built, file, error)
               : -1;
}

int ground_load(struct world_build *built, struct error_text *error)
{
    struct ground_file file;
    if (ground_file_open(&file, built->scenario->settings->ground_file, error) != 0)
        return -1;
    int result = load(built, &file, error);
    ground_file_close(&file);
    return result;
}
