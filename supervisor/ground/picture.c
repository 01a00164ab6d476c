/* The verb show: a ground file as a shaded picture. */
#include "supervisor/ground/picture.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "supervisor/ground/canvas.h"
#include "supervisor/ground/out_file.h"
#include "supervisor/ground/picture_features.h"
#include "world/maths/maths.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/location.h"
#include "world/terrain/terrain.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The light comes from the north-west, halfway up, as in gdaldem hillshade. */
#define LIGHT_UP      0.70710678118654752
#define LIGHT_EAST    (-0.5)
#define LIGHT_NORTH   0.5
#define SHADE_DARKEST 1.0

/* Rows of posts that are drawn at once. */
#define BAND_POSTS 1024.0

static struct {
    uint32_t size;
    const char *at;
    double metres; /* 0: the whole square */
    bool grey;
} given = {.size = 1000};

/* Colours of enum cover: red, green, blue. */
static const uint8_t colours[COVER_COUNT][3] = {
    [COVER_GRASS] = {190, 200, 130}, [COVER_CHAPARRAL] = {150, 160, 95},
    [COVER_FOREST] = {80, 120, 70},  [COVER_ROCK] = {175, 165, 155},
    [COVER_SAND] = {225, 210, 160},  [COVER_ROAD] = {182, 188, 130},
    [COVER_SEA] = {90, 130, 175},    [COVER_LAKE] = {110, 155, 195}};

/* A ground, and a window of its posts in memory: whole tiles. */
struct ground {
    struct ground_file file;
    uint32_t side;
    double spacing_m;
    int64_t column, row; /* the first post of the window */
    size_t columns, rows, room;
    float *posts; /* [room], of which [columns * rows] are used */
    uint8_t *cover;
};

static void open_ground(struct ground *ground, const char *path)
{
    struct error_text error;
    *ground = (struct ground){.column = 0};
    if (ground_file_open(&ground->file, path, &error) != 0)
        die_refused("%s", error.text);
    ground->side = ground->file.header.posts_side;
    ground->spacing_m = ground->file.header.spacing_m;
}

static void close_ground(struct ground *ground)
{
    free(ground->posts);
    free(ground->cover);
    ground_file_close(&ground->file);
}

/* Returns the tile of a row or a column, and of those beyond the ground the nearest. */
static uint32_t tile_at(const struct ground *ground, double post)
{
    return (uint32_t)maths_clamp(post, 0.0, ground->side - 1.0) / GROUND_TILE_POSTS;
}

/* Reads the tiles with the posts from low to high, columns first. */
static void read_window(struct ground *ground, const double low[2], const double high[2])
{
    struct error_text error;
    uint32_t across = ground_tiles_side(ground->side), last = ground->side;
    uint32_t west = tile_at(ground, low[0]), east = tile_at(ground, high[0]) + 1;
    uint32_t north = tile_at(ground, low[1]), south = tile_at(ground, high[1]) + 1;
    ground->column = (int64_t)west * GROUND_TILE_POSTS;
    ground->row = (int64_t)north * GROUND_TILE_POSTS;
    ground->columns = (east == across ? last : east * GROUND_TILE_POSTS) - (size_t)ground->column;
    ground->rows = (south == across ? last : south * GROUND_TILE_POSTS) - (size_t)ground->row;
    if (ground->columns * ground->rows > ground->room) {
        free(ground->posts);
        free(ground->cover);
        ground->room = ground->columns * ground->rows;
        ground->posts = malloc(ground->room * sizeof *ground->posts);
        ground->cover = malloc(ground->room);
        if (!ground->posts || !ground->cover)
            die_refused("%s: no memory for its posts", ground->file.path);
    }
    for (uint32_t row = north; row < south; row++)
        for (uint32_t column = west; column < east; column++) {
            size_t first = (size_t)(row - north) * GROUND_TILE_POSTS * ground->columns +
                           (size_t)(column - west) * GROUND_TILE_POSTS;
            if (ground_file_tile(&ground->file, row * across + column, ground->posts + first,
                                 ground->cover + first, ground->columns, &error) != 0)
                die_refused("%s", error.text);
        }
}

/* Returns where a post of the window is. */
static size_t index_of(const struct ground *ground, int64_t column, int64_t row)
{
    return (size_t)(row - ground->row) * ground->columns + (size_t)(column - ground->column);
}

/* Returns a height `step` posts away from a post, within the ground. */
static double near(const struct ground *ground, int64_t column, int64_t row)
{
    int64_t last = (int64_t)ground->side - 1;
    column = column < 0 ? 0 : column > last ? last : column;
    row = row < 0 ? 0 : row > last ? last : row;
    return (double)ground->posts[index_of(ground, column, row)];
}

/* Returns the brightness of a post, 1..255, by the slope of Horn (1981) over `step` posts, as
 * gdaldem hillshade computes it. */
static double shade(const struct ground *ground, int64_t column, int64_t row, int64_t step)
{
    double weight[3] = {1.0, 2.0, 1.0}, east = 0.0, north = 0.0;
    for (int i = -1; i <= 1; i++) {
        east += weight[i + 1] * (near(ground, column + step, row + i * step) -
                                 near(ground, column - step, row + i * step));
        north += weight[i + 1] * (near(ground, column + i * step, row - step) -
                                  near(ground, column + i * step, row + step));
    }
    double across = 8.0 * (double)step * ground->spacing_m;
    east /= across;
    north /= across;
    double light = (LIGHT_UP - LIGHT_EAST * east - LIGHT_NORTH * north) /
                   sqrt(1.0 + east * east + north * north);
    return light > 0.0 ? SHADE_DARKEST + 254.0 * light : SHADE_DARKEST;
}

/* Returns the brightness of a place between posts: bilinear. column, row: in posts. */
static double shade_between(const struct ground *ground, double column, double row)
{
    int64_t c = (int64_t)floor(column), r = (int64_t)floor(row);
    double east = column - (double)c, south = row - (double)r;
    double upper = (1.0 - east) * shade(ground, c, r, 1) + east * shade(ground, c + 1, r, 1);
    double lower =
        (1.0 - east) * shade(ground, c, r + 1, 1) + east * shade(ground, c + 1, r + 1, 1);
    return (1.0 - south) * upper + south * lower;
}

/* Returns the middle of the picture in the square of the file [m]. Places count as in a scenario: a
 * small square lies in the middle of a larger world. */
static void choose_middle(double middle[2], const struct ground_header *header)
{
    double world_side = ground_file_world_side(header);
    double offset = 0.5 * (world_side - header->side_m);
    struct location place;
    struct location_frame frame;
    struct error_text error;
    location_frame_make(&frame, header->latitude_deg, header->longitude_deg, world_side);
    if (location_read(&place, given.at, &error) != 0 ||
        location_world(&place, &frame, &middle[0], &middle[1], &error) != 0)
        die_usage("ground show: --at: %s", error.text);
    for (int k = 0; k < 2; k++) {
        middle[k] -= offset;
        if (middle[k] < 0.0 || middle[k] > header->side_m)
            die_usage("ground show: --at %s: lies beyond the square of the file, which goes from "
                      "%g,%g to %g,%g in a world of %g km",
                      given.at, offset, offset, offset + header->side_m, offset + header->side_m,
                      world_side / 1000.0);
    }
}

/* The square of the ground that is drawn. */
static void choose_square(struct canvas *canvas, const struct ground *ground)
{
    const struct ground_header *header = &ground->file.header;
    double metres =
        given.metres > 0.0 && given.metres < header->side_m ? given.metres : header->side_m;
    double middle[2] = {0.5 * header->side_m, 0.5 * header->side_m};
    if (given.at)
        choose_middle(middle, header);
    canvas->x0 = maths_clamp(middle[0] - 0.5 * metres, 0.0, header->side_m - metres);
    canvas->z0 = maths_clamp(middle[1] - 0.5 * metres, 0.0, header->side_m - metres);
    canvas->size = given.size < ground->side || given.metres > 0.0 ? given.size : ground->side;
    canvas->step_m = metres / (canvas->size - 1);
}

/* Draws a row of the picture, whose posts are in the window. */
static void draw_row(const struct canvas *canvas, const struct ground *ground, uint32_t row,
                     const double first[2], double posts, int64_t step)
{
    int64_t last = ground->side - 1;
    for (uint32_t column = 0; column < canvas->size; column++) {
        double at[2] = {first[0] + column * posts, first[1] + row * posts};
        int64_t c = (int64_t)(at[0] + 0.5), r = (int64_t)(at[1] + 0.5);
        c = c < last ? c : last;
        r = r < last ? r : last;
        double bright =
            posts < 1.0 ? shade_between(ground, at[0], at[1]) : shade(ground, c, r, step);
        const uint8_t *colour = colours[ground->cover[index_of(ground, c, r)]];
        uint8_t *pixel = canvas->pixels + 3 * ((size_t)row * canvas->size + column);
        for (int k = 0; k < 3; k++)
            pixel[k] = (uint8_t)(given.grey ? bright + 0.5
                                            : colour[k] * maths_min(0.15 + bright / 265.0, 1.0));
    }
}

/* Draws band after band, so that few posts of a large ground are in memory. */
static void draw_ground(const struct canvas *canvas, struct ground *ground)
{
    double posts = canvas->step_m / ground->spacing_m; /* a pixel */
    double first[2] = {canvas->x0 / ground->spacing_m, canvas->z0 / ground->spacing_m};
    int64_t step = posts >= 2.0 ? ground->side / canvas->size : 1;
    step = step > 0 ? step : 1;
    double reach = (double)step + 2.0;
    uint32_t band = (uint32_t)maths_clamp(BAND_POSTS / posts, 1.0, canvas->size);
    for (uint32_t row = 0; row < canvas->size; row++) {
        if (row % band == 0) {
            const double low[2] = {first[0] - reach, first[1] + row * posts - reach};
            const double high[2] = {first[0] + canvas->size * posts + reach,
                                    first[1] + (row + band) * posts + reach};
            read_window(ground, low, high);
        }
        draw_row(canvas, ground, row, first, posts, step);
    }
}

static GDALDatasetH draw(struct ground *ground)
{
    struct canvas canvas;
    choose_square(&canvas, ground);
    int size = (int)canvas.size, bands = given.grey ? 1 : 3;
    canvas.pixels = malloc(3 * (size_t)canvas.size * canvas.size);
    GDALDatasetH picture =
        GDALCreate(GDALGetDriverByName("MEM"), "", size, size, bands, GDT_Byte, NULL);
    if (!canvas.pixels || !picture)
        die_refused("no memory for a picture of %d x %d", size, size);
    draw_ground(&canvas, ground);
    if (!given.grey)
        picture_features_draw(&canvas, &ground->file);
    for (int k = 0; k < bands; k++) {
        if (GDALRasterIO(GDALGetRasterBand(picture, k + 1), GF_Write, 0, 0, size, size,
                         canvas.pixels + k, size, size, GDT_Byte, 3, 3 * size) != CE_None)
            die_refused("no memory for a picture of %d x %d", size, size);
    }
    free(canvas.pixels);
    return picture;
}

void picture_save(GDALDatasetH dataset, const char *driver, const char *path, char **options)
{
    char aside[4200];
    snprintf(aside, sizeof aside, "%.4000s.%d~", path, getpid());
    CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");
    GDALDatasetH copy =
        GDALCreateCopy(GDALGetDriverByName(driver), aside, dataset, 0, options, NULL, NULL);
    if (copy)
        GDALClose(copy);
    if (!copy || CPLGetLastErrorType() >= CE_Failure || rename(aside, path) != 0) {
        unlink(aside);
        die_refused("%s: cannot be written: %s", path, CPLGetLastErrorMsg());
    }
}

int picture_show(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"size", "PIXELS",
         "width and height (default 1000; of a whole square at most one pixel a post)",
         .u32 = &given.size, .least = 16, .most = 20001},
        {"at", "PLACE",
         "the middle of the picture, with --metres: X,Z in metres as in a scenario, degrees as "
         "44.2705N,71.3033W, or MGRS",
         .text = &given.at},
        {"metres", "M", "width and height of the ground in the picture (default: all of it)",
         .real = &given.metres, .low = 10.0, .high = 500000.0},
        {"grey", NULL, "the light alone, without the colours of the cover", .flag = &given.grey},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-ground show",
        .usage = "[options] FILE PICTURE.png\n"
                 "Draws a ground file as a shaded picture with the light from the north-west, with "
                 "its roads, buildings, woods and water.",
        .rows = rows,
        .plain = 2};
    struct ground ground;
    struct error_text error;
    if (option_table_read(&table, argc, argv) != 2)
        die_usage("ground show: needs a ground file and the name of a picture, as in: jolon ground "
                  "show x.ground x.png");
    if (given.at && given.metres <= 0.0)
        die_usage("ground show: --at goes with --metres, as in: --at 25000,25000 --metres 2000");
    if (out_file_check(argv[argc - 1], argv + argc - 2, 1, &error) != 0)
        die_refused("%s", error.text);
    open_ground(&ground, argv[argc - 2]);
    GDALDatasetH picture = draw(&ground);
    picture_save(picture, "PNG", argv[argc - 1], NULL);
    GDALClose(picture);
    close_ground(&ground);
    return EXIT_OK;
}
