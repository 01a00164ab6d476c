/* Ground from a file. */
#include "world/making/ground_load.h"

#include "world/terrain/posts_write.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/runtime/error_text.h"
#include "world/maths/maths.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/terrain.h"

#include <inttypes.h>
#include <stdlib.h>

/* Beyond the edge of a small square the heights of its edge become their mean over so many metres.
 */
#define LEVELLED_M 3000.0

/* So far the cover of the edge goes on [m]. */
#define FRINGE_M 150.0

static int load_roads(struct world_build *built, const struct ground_file *file, double offset_m,
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
        built->roads[i] = (struct road_point){.x = points[i].x_mm / 1000.0 + offset_m,
                                              .z = points[i].z_mm / 1000.0 + offset_m,
                                              .road = points[i].road};
    built->counts.road_points = count;
    free(points);
    return result;
}

/* A square of posts in the middle of the world's. */
struct inset {
    uint32_t side, first, world_side; /* posts; first: the row and column of its north-west post */
    double spacing_m;
    double mean_m; /* of the posts at its edge */
    uint8_t cover; /* the commonest of them, water and roads apart */
};

static void look_at_edge(struct inset *inset, const float *posts, const uint8_t *cover)
{
    double sum = 0.0;
    uint32_t last = inset->side - 1, count[COVER_ROAD] = {0};
    for (uint32_t i = 0; i < inset->side; i++) {
        const size_t at[4] = {i, (size_t)last * inset->side + i, (size_t)i * inset->side,
                              (size_t)i * inset->side + last};
        for (int k = 0; k < 4; k++) {
            sum += (double)posts[at[k]];
            if (cover[at[k]] < COVER_ROAD)
                count[cover[at[k]]]++;
        }
    }
    inset->mean_m = sum / (4.0 * inset->side);
    for (int i = 1; i < COVER_ROAD; i++)
        inset->cover = count[i] > count[inset->cover] ? (uint8_t)i : inset->cover;
}

/* Returns the nearest row or column of the square, and by how many posts it is off. */
static uint32_t nearest(const struct inset *inset, uint32_t at, double *off)
{
    uint32_t near = at < inset->first ? 0 : at - inset->first;
    near = near < inset->side ? near : inset->side - 1;
    *off = (double)at - (double)inset->first - (double)near;
    return near;
}

/* Sets a row of the world's posts from those of the square. Beyond its edge the sea goes on; other
 * ground becomes level, and has the commonest cover of the edge. */
static void fill_row(const struct inset *inset, uint32_t row, const float *posts,
                     const uint8_t *cover, float *to, uint8_t *cover_to)
{
    double row_off, column_off;
    uint32_t near_row = nearest(inset, row, &row_off);
    for (uint32_t column = 0; column < inset->world_side; column++) {
        size_t from = (size_t)near_row * inset->side + nearest(inset, column, &column_off);
        double off_m = inset->spacing_m * sqrt(row_off * row_off + column_off * column_off);
        double share = maths_min(off_m / LEVELLED_M, 1.0), edge_m = (double)posts[from];
        share *= share * (3.0 - 2.0 * share);
        to[column] = posts[from];
        cover_to[column] = cover[from];
        if (off_m == 0.0 || cover[from] == COVER_SEA)
            continue;
        to[column] = (float)(edge_m + (inset->mean_m - edge_m) * share);
        if (cover[from] >= COVER_ROAD || off_m > FRINGE_M)
            cover_to[column] = inset->cover;
    }
}

/* Reads a square that is smaller than the world. */
static int load_inset(struct world_build *built, const struct ground_file *file, double offset_m,
                      struct error_text *error)
{
    uint32_t side = file->header.posts_side, world_side = built->counts.posts_side;
    struct inset inset = {.side = side,
                          .first = (uint32_t)(offset_m / file->header.spacing_m),
                          .world_side = world_side,
                          .spacing_m = file->header.spacing_m};
    size_t count = (size_t)side * side;
    float *posts = malloc(count * sizeof *posts);
    uint8_t *cover = malloc(count);
    if (!posts || !cover) {
        free(posts);
        free(cover);
        return error_text_memory(error);
    }
    int result = ground_file_posts(file, posts, cover, error);
    if (result == 0)
        look_at_edge(&inset, posts, cover);
    for (uint32_t row = 0; row < world_side && result == 0; row++)
        fill_row(&inset, row, posts, cover, built->posts + (size_t)row * world_side,
                 built->cover + (size_t)row * world_side);
    free(posts);
    free(cover);
    return result;
}

/* Maps the posts of a ground that has more than a world's memory, and makes their file first if it
 * is not there. */
static int map_posts(struct world_build *built, const struct ground_file *file,
                     struct error_text *error)
{
    const struct posts_file_ground ground = {file->path, file->header.hash, file->header.side_m,
                                             file->header.posts_side};
    built->counts.posts_in_file = 1;
    return posts_write(file, error) == 0 ? posts_file_open(&built->posts_file, &ground, error) : -1;
}

static int load(struct world_build *built, const struct ground_file *file, struct error_text *error)
{
    const struct scenario_settings *settings = built->scenario->settings;
    uint32_t side = 0;
    double offset_m = 0.0;
    if (file->header.hash != settings->ground_hash)
        return error_text_set(
            error,
            "%s: has changed since the scenario was read: its hash was %016" PRIx64
            " and is %016" PRIx64,
            file->path, settings->ground_hash, file->header.hash);
    if (!ground_file_fits_world(&file->header, settings->side_m, &offset_m, &side))
        return error_text_set(error, "%s: has a side or a number of posts that no world has",
                              file->path);
    size_t posts = (size_t)side * side;
    built->counts.posts_side = side;
    if (side > GROUND_WORLD_POSTS_MAX)
        return map_posts(built, file, error) == 0 ? load_roads(built, file, offset_m, error) : -1;
    built->posts = malloc(posts * sizeof *built->posts);
    built->cover = malloc(posts);
    if (!built->posts || !built->cover)
        return error_text_memory(error);
    int result = offset_m > 0.0 ? load_inset(built, file, offset_m, error)
                                : ground_file_posts(file, built->posts, built->cover, error);
    return result == 0 ? load_roads(built, file, offset_m, error) : -1;
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
