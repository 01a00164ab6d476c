/* Rasters of heights or of classes of cover, as GDAL reads them: opened and checked once, then read
 * in strips of rows of posts.
 *
 * A raster is sampled by the place of a post in it, which is computed at nodes a few hundred metres
 * apart and interpolated between them: within 5 mm of the exact place. A raster whose pixels are
 * much finer than the posts is read as one of coarser pixels, each the mean of its own. One thread
 * opens and reads; any number of threads sample between two reads. */
#ifndef JOLON_SUPERVISOR_GROUND_RASTER_H
#define JOLON_SUPERVISOR_GROUND_RASTER_H

#include "world/runtime/error_text.h"
#include "world/terrain/projection.h"

#include <stdbool.h>
#include <stdint.h>

/* Posts of a square; row and column 0 are the north-west post. */
struct post_grid {
    struct projection projection;
    double longitude_deg; /* of the middle */
    uint32_t side;        /* posts along one edge */
    double spacing_m;
};

struct raster;

enum raster_use { RASTER_OF_HEIGHTS, RASTER_OF_CLASSES };

/* Opens a raster for these posts. to_metres: what heights are multiplied by; 0: what the file says
 * of its unit. NULL with the reason: no such file, no raster, no or no known place on the earth,
 * more than one band (besides one of transparency), colours, fewer than 2 x 2 pixels. */
struct raster *raster_open(const char *path, enum raster_use use, const struct post_grid *grid,
                           double to_metres, struct error_text *error);
void raster_close(struct raster *raster);

const char *raster_path(const struct raster *raster);

/* A line about it for people: size, resolution, driver; of its licence what the file says. */
void raster_describe(const struct raster *raster, char *text, uint32_t bytes);
const char *raster_licence(const struct raster *raster); /* NULL: the file says none */

/* The area that it covers [deg]: south, west, north, east. */
void raster_extent(const struct raster *raster, double extent[4]);

/* Orders rasters: the finest first; of equally fine ones by their place, then by name. The order in
 * which they were named does not matter. */
int raster_order(const void *a, const void *b);

/* Finds for each raster those that continue its pixels beyond its edge. Call it once, when they are
 * in order. */
void raster_join(struct raster **rasters, uint32_t count);

/* Reads what rows first .. first + rows - 1 of the posts need. 0, or -1 with the reason. */
int raster_read(struct raster *raster, uint32_t first, uint32_t rows, struct error_text *error);

/* Returns the height [m] at a post of the rows that were read, bilinear between four pixels, or
 * NaN where one of them is void. */
double raster_height(const struct raster *raster, uint32_t column, uint32_t row);

/* Returns the class of the pixel in which a post lies, -1 if it is void. */
int raster_class(const struct raster *raster, uint32_t column, uint32_t row);

/* Returns why GDAL could not open a map of any kind: its last message, or, where it is silent, that
 * the file does not exist, is a folder, is empty or has another format. Valid until GDAL's next. */
const char *raster_open_reason(const char *path);

#endif
