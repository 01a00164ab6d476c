/* Cover of the ground. */
#include "supervisor/ground/cover_map.h"

#include "ipc/process/process.h"
#include "supervisor/ground/progress.h"
#include "world/maths/maths.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define STRIP_ROWS 256u

/* Steeper ground is rock, flatter ground below the tree line grass: rise over run. */
#define ROCK_SLOPE   0.75
#define GRASS_SLOPE  0.06
#define SLOPE_OVER_M 90.0

/* The tree line falls from the equator to the poles, and rock begins above the meadows over it. A
 * rule of thumb: 44 degrees north give 1,490 m, where the White Mountains have 1,400 m. */
#define TREE_LINE_M          4000.0
#define TREE_LINE_M_A_DEGREE 57.0
#define MEADOWS_M            250.0

static const struct {
    const char *word;
    uint8_t rule;
} words[] = {{"grass", COVER_GRASS}, {"chaparral", COVER_CHAPARRAL}, {"forest", COVER_FOREST},
             {"rock", COVER_ROCK},   {"sand", COVER_SAND},           {"lake", COVER_LAKE},
             {"sea", COVER_SEA},     {"water", COVER_MAP_WATER},     {"none", COVER_MAP_NONE}};

static int take_line(struct cover_map_table *table, const char *line, const char *path, int number,
                     struct error_text *error)
{
    char word[32], more[2];
    int class, fields = sscanf(line, " %d %31s %1s", &class, word, more);
    if (fields <= 0 && strspn(line, " \t\r\n") == strlen(line))
        return 0;
    if (fields != 2 || class < 0 || class >= COVER_MAP_CLASSES)
        return error_text_set(error,
                              "%s:%d: must be a class from 0 to %d and a word, as: 10 forest", path,
                              number, COVER_MAP_CLASSES - 1);
    if (table->rule[class] != COVER_MAP_UNKNOWN)
        return error_text_set(error, "%s:%d: class %d has a cover already, in a line before", path,
                              number, class);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(words[i].word, word) == 0) {
            table->rule[class] = words[i].rule;
            return 0;
        }
    }
    return error_text_set(
        error,
        "%s:%d: %s: no such cover; allowed: grass, chaparral, forest, rock, sand, "
        "lake, sea, water, none",
        path, number, word);
}

int cover_map_table(struct cover_map_table *table, const char *name, struct error_text *error)
{
    char folder[PATH_MAX], path[PATH_MAX + 64], line[256];
    int result = 0, number = 0;
    snprintf(path, sizeof path, "%s", name);
    if (!strchr(name, '/') && process_data_dir(folder, sizeof folder) == 0)
        snprintf(path, sizeof path, "%s/ground/%.40s.txt", folder, name);
    FILE *file = fopen(path, "re");
    if (!file && !strchr(name, '/')) { /* a file of this folder */
        snprintf(path, sizeof path, "%s", name);
        file = fopen(path, "re");
    }
    if (!file)
        return error_text_set(error,
                              "%s: no such table of classes: %s; right would be: a file, or "
                              "worldcover, nlcd or corine",
                              name, strerror(errno));
    memset(table->rule, COVER_MAP_UNKNOWN, sizeof table->rule);
    while (result == 0 && fgets(line, sizeof line, file)) {
        line[strcspn(line, "#")] = '\0';
        result = take_line(table, line, path, ++number, error);
    }
    fclose(file);
    return result;
}

/* Returns rise over run between posts at least SLOPE_OVER_M away on both sides, so that the grain
 * of a map of heights does not count. */
static double steepness(const float *posts, const struct post_grid *grid, uint32_t column,
                        uint32_t row)
{
    uint32_t last = grid->side - 1, step = (uint32_t)ceil(SLOPE_OVER_M / grid->spacing_m);
    uint32_t west = column > step ? column - step : 0, north = row > step ? row - step : 0;
    uint32_t east = column + step < last ? column + step : last;
    uint32_t south = row + step < last ? row + step : last;
    const float *line = posts + (size_t)row * grid->side;
    double dx = ((double)line[east] - (double)line[west]) / ((east - west) * grid->spacing_m);
    double dz = ((double)posts[(size_t)south * grid->side + column] -
                 (double)posts[(size_t)north * grid->side + column]) /
                ((south - north) * grid->spacing_m);
    return sqrt(dx * dx + dz * dz);
}

/* Returns true where the ground is level at exactly 0 m, as the sea is in maps of heights. */
static bool level_at_zero(const float *posts, const struct post_grid *grid, uint32_t column,
                          uint32_t row)
{
    uint32_t last = grid->side - 1;
    for (uint32_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r <= last; r++)
        for (uint32_t c = column > 0 ? column - 1 : 0; c <= column + 1 && c <= last; c++)
            if (posts[(size_t)r * grid->side + c] != 0.0f)
                return false;
    return true;
}

/* Returns the height of the tree line on the middle of a row [m]. */
static double tree_line(const struct post_grid *grid, uint32_t row)
{
    double latitude, longitude;
    projection_place(&grid->projection, grid->projection.middle_m, row * grid->spacing_m, &latitude,
                     &longitude);
    return maths_max(TREE_LINE_M - TREE_LINE_M_A_DEGREE * fabs(latitude), 0.0);
}

static enum cover guess(const float *posts, const struct post_grid *grid, uint32_t column,
                        uint32_t row, double line_m)
{
    double height = (double)posts[(size_t)row * grid->side + column];
    if (height == 0.0 && level_at_zero(posts, grid, column, row))
        return COVER_SEA;
    double slope = steepness(posts, grid, column, row);
    if (slope > ROCK_SLOPE || height > line_m + MEADOWS_M)
        return COVER_ROCK;
    return slope < GRASS_SLOPE || height > line_m ? COVER_GRASS : COVER_FOREST;
}

/* A class of which the table says nothing. */
struct unknown_class {
    const struct raster *raster;
    int class;
};

/* Returns the cover that the rasters give, or enum cover_map_rule. */
static uint8_t classed(struct raster **rasters, uint32_t count, const struct cover_map_table *table,
                       uint32_t column, uint32_t row, struct unknown_class *unknown)
{
    for (uint32_t i = 0; i < count; i++) {
        int class = raster_class(rasters[i], column, row);
        uint8_t rule = class < 0 ? COVER_MAP_NONE : table->rule[class];
        if (rule == COVER_MAP_UNKNOWN)
            *unknown = (struct unknown_class){rasters[i], class};
        if (rule != COVER_MAP_NONE)
            return rule;
    }
    return COVER_MAP_NONE;
}

static int refuse_class(const struct post_grid *grid, const struct unknown_class *unknown,
                        uint32_t column, uint32_t row, struct error_text *error)
{
    double latitude, longitude;
    projection_place(&grid->projection, column * grid->spacing_m, row * grid->spacing_m, &latitude,
                     &longitude);
    return error_text_set(
        error,
        "%s: has class %d at latitude %.5f, longitude %.5f, of which the table of "
        "classes says nothing; right would be a line \"%d grass\" or another "
        "cover, or --classes with the table of this map",
        raster_path(unknown->raster), unknown->class, latitude, longitude, unknown->class);
}

int cover_map_fill(uint8_t *cover, float *posts, const struct post_grid *grid,
                   struct raster **rasters, uint32_t count, const struct cover_map_table *table,
                   uint64_t *guessed, struct error_text *error)
{
    *guessed = 0;
    for (uint32_t row = 0; row < grid->side; row++) {
        uint32_t left = grid->side - row;
        double line_m = tree_line(grid, row);
        for (uint32_t i = 0; i < count && row % STRIP_ROWS == 0; i++) {
            if (raster_read(rasters[i], row, left < STRIP_ROWS ? left : STRIP_ROWS, error) != 0)
                return -1;
        }
        for (uint32_t column = 0; column < grid->side; column++) {
            size_t at = (size_t)row * grid->side + column;
            struct unknown_class unknown = {0};
            uint8_t rule = classed(rasters, count, table, column, row, &unknown);
            if (rule == COVER_MAP_UNKNOWN)
                return refuse_class(grid, &unknown, column, row, error);
            *guessed += rule == COVER_MAP_NONE;
            if (rule == COVER_MAP_NONE)
                rule = (uint8_t)guess(posts, grid, column, row, line_m);
            if (rule == COVER_MAP_WATER)
                rule = fabsf(posts[at]) <= (float)COVER_MAP_SEA_M ? COVER_SEA : COVER_LAKE;
            cover[at] = rule;
        }
        progress_show("cover", row + 1, grid->side);
    }
    for (size_t i = 0; i < (size_t)grid->side * grid->side; i++)
        posts[i] = cover[i] == COVER_SEA ? 0.0f : posts[i];
    return 0;
}
