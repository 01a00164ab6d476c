/* The coarse shape of the terrain: smooth fields between the real rivers, ridges and the coast, on
 * every fourth node of the elevation grid (500 m). Finer detail comes from erosion and noise. */
#ifndef JOLON_WORLD_MAKING_ELEVATION_FIELDS_H
#define JOLON_WORLD_MAKING_ELEVATION_FIELDS_H

#include "world/making/geography.h"
#include "world/making/elevation_grid.h"

#include <stdint.h>

#define ELEVATION_FIELDS_STEP  4
#define ELEVATION_FIELDS_SIDE  ((ELEVATION_GRID_SIDE - 1) / ELEVATION_FIELDS_STEP + 1)
#define ELEVATION_FIELDS_COUNT ((uint32_t)(ELEVATION_FIELDS_SIDE * ELEVATION_FIELDS_SIDE))

/* A place of the tables in world coordinates. */
struct anchor {
    double x, z; /* [m] */
    double height_m;
    int peak; /* 1: the highest ground of its ridge */
};

/* All arrays are [ELEVATION_FIELDS_COUNT]. */
struct elevation_fields {
    float *envelope;        /* [m] height that the hills should reach */
    float *relief;          /* [m] of the surrounding ridges over the surrounding rivers */
    float *inland;          /* [m] from the coast, negative in the sea */
    float *beyond;          /* [m] from the nearest valley floor, negative on it */
    float *warp_x, *warp_z; /* [m] from a point to where the tables are read for it */
    uint8_t *river;         /* the nearest one */
};

/* 0, or -1 with errno ENOMEM. */
int elevation_fields_build(struct elevation_fields *fields,
                           const struct anchor anchors[GEOGRAPHY_PLACE_COUNT], uint64_t seed);
void elevation_fields_free(struct elevation_fields *fields);

/* One of the fields at a node of the elevation grid. */
float elevation_fields_at(const float *field, uint32_t column, uint32_t row);

/* Box blur of a field in both directions, edges repeated; spare is [ELEVATION_FIELDS_COUNT]. */
void elevation_fields_blur(float *field, float *spare, int32_t radius);

#endif
