/* The verb show: a ground file as a shaded picture. */
#include "supervisor/ground/picture.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "world/maths/maths.h"
#include "world/terrain/ground_file.h"
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

static struct {
    uint32_t size;
    bool grey;
} given = {.size = 1000};

/* Colours of enum cover: red, green, blue. */
static const uint8_t colours[COVER_COUNT][3] = {
    [COVER_GRASS] = {190, 200, 130}, [COVER_CHAPARRAL] = {150, 160, 95},
    [COVER_FOREST] = {80, 120, 70},  [COVER_ROCK] = {175, 165, 155},
    [COVER_SAND] = {225, 210, 160},  [COVER_ROAD] = {120, 115, 110},
    [COVER_SEA] = {90, 130, 175},    [COVER_LAKE] = {110, 155, 195}};

/* A ground in memory. */
struct ground {
    struct ground_file file;
    float *posts;
    uint8_t *cover;
    uint32_t side;
    double spacing_m;
};

static void open_ground(struct ground *ground, const char *path)
{
    struct error_text error;
    if (ground_file_open(&ground->file, path, &error) != 0)
        die_refused("%s", error.text);
    ground->side = ground->file.header.posts_side;
    ground->spacing_m = ground->file.header.spacing_m;
    size_t posts = (size_t)ground->side * ground->side;
    ground->posts = malloc(posts * sizeof *ground->posts);
    ground->cover = malloc(posts);
    if (!ground->posts || !ground->cover)
        die_refused("%s: no memory for its posts", path);
    if (ground_file_posts(&ground->file, ground->posts, ground->cover, &error) != 0)
        die_refused("%s", error.text);
}

static void close_ground(struct ground *ground)
{
    free(ground->posts);
    free(ground->cover);
    ground_file_close(&ground->file);
}

/* Returns a height `step` posts away from a post, within the ground. */
static double near(const struct ground *ground, int64_t column, int64_t row)
{
    int64_t last = (int64_t)ground->side - 1;
    column = column < 0 ? 0 : column > last ? last : column;
    row = row < 0 ? 0 : row > last ? last : row;
    return (double)ground->posts[row * ground->side + column];
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

static GDALDatasetH draw(const struct ground *ground)
{
    uint32_t size = given.size < ground->side ? given.size : ground->side;
    int bands = given.grey ? 1 : 3;
    uint8_t *line = malloc(3 * (size_t)size);
    GDALDatasetH picture =
        GDALCreate(GDALGetDriverByName("MEM"), "", (int)size, (int)size, bands, GDT_Byte, NULL);
    if (!line || !picture)
        die_refused("no memory for a picture of %u x %u", size, size);
    int64_t step = ground->side / size;
    for (uint32_t row = 0; row < size; row++) {
        for (uint32_t column = 0; column < size; column++) {
            double last = size > 1 ? (double)(ground->side - 1) / (size - 1) : 0.0;
            int64_t c = (int64_t)(column * last + 0.5), r = (int64_t)(row * last + 0.5);
            double bright = shade(ground, c, r, step > 0 ? step : 1);
            const uint8_t *colour = colours[ground->cover[r * ground->side + c]];
            for (int k = 0; k < bands; k++)
                line[(size_t)k * size + column] =
                    (uint8_t)(given.grey ? bright + 0.5
                                         : colour[k] * maths_min(0.15 + bright / 265.0, 1.0));
        }
        for (int k = 0; k < bands; k++) {
            if (GDALRasterIO(GDALGetRasterBand(picture, k + 1), GF_Write, 0, (int)row, (int)size, 1,
                             line + (size_t)k * size, (int)size, 1, GDT_Byte, 0, 0) != CE_None)
                die_refused("no memory for a picture of %u x %u", size, size);
        }
    }
    free(line);
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
        {"size", "PIXELS", "width and height (default 1000; at most one pixel a post)",
         .u32 = &given.size, .least = 16, .most = 20001},
        {"grey", NULL, "the light alone, without the colours of the cover", .flag = &given.grey},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-ground show",
        .usage = "[options] FILE PICTURE.png\n"
                 "Draws a ground file as a shaded picture with the light from the north-west.",
        .rows = rows,
        .plain = 2};
    struct ground ground;
    if (option_table_read(&table, argc, argv) != 2)
        die_usage("ground show: needs a ground file and the name of a picture, as in: jolon ground "
                  "show x.ground x.png");
    open_ground(&ground, argv[argc - 2]);
    GDALDatasetH picture = draw(&ground);
    picture_save(picture, "PNG", argv[argc - 1], NULL);
    GDALClose(picture);
    close_ground(&ground);
    return EXIT_OK;
}
