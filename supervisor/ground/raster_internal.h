/* The parts of a raster, for raster.c and raster_sample.c. */
#ifndef JOLON_SUPERVISOR_GROUND_RASTER_INTERNAL_H
#define JOLON_SUPERVISOR_GROUND_RASTER_INTERNAL_H

#include "supervisor/ground/raster.h"

#include <gdal.h>
#include <ogr_srs_api.h>

#define DEGREE_M 111194.9 /* of latitude, on the mean sphere */

struct raster {
    const char *path;
    struct post_grid grid;
    GDALDatasetH dataset;
    GDALRasterBandH band;
    GDALRasterBandH mask; /* 0 where the file says that there is nothing; NULL: it has none */
    OGRCoordinateTransformationH from_earth, to_earth;
    double transform[6], inverse[6];
    double extent[4];    /* [deg] south, west, north, east */
    double resolution_m; /* of its own pixels, from north to south */
    double nodata, factor, offset;
    int has_nodata;
    bool geographic;
    int coarser;       /* it is read as pixels of so many of its own */
    int columns, rows; /* of the pixels that are read */
    int turn; /* columns around the earth, behind which the first follow again; 0: it goes not round
               */

    struct raster **neighbours;
    uint32_t neighbour_count;

    /* What was read for some rows of posts: pixels, and where the nodes lie in it [pixels from the
     * corner]. In a raster around the earth the window and nodes may go beyond its columns. */
    float *window;
    int west, north, across, down;
    double (*nodes)[2];
    uint32_t first_row, node_posts, nodes_across, nodes_down;
};

#endif
