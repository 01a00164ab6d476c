/* The land's sketch: smooth fields between the real rivers, ridges and the coast, on every fourth
 * node of the land's grid (500 m). What is finer than that comes from running water and noise. */
#ifndef JOLON_WORLD_SKETCH_H
#define JOLON_WORLD_SKETCH_H

#include "world/geography.h"
#include "world/land.h"

#include <stdint.h>

#define SKETCH_STEP  4
#define SKETCH_SIDE  ((LAND_SIDE - 1) / SKETCH_STEP + 1)
#define SKETCH_COUNT ((uint32_t)(SKETCH_SIDE * SKETCH_SIDE))

/* A place of the tables in the world frame. */
struct anchor {
    double x, z; /* [m] */
    double height_m;
    int peak; /* 1: the highest ground of its ridge */
};

/* All [SKETCH_COUNT]. */
struct sketch {
    float *envelope;        /* [m] height that the hills should reach */
    float *relief;          /* [m] of the ridges around over the rivers around */
    float *inland;          /* [m] from the coast, negative in the sea */
    float *beyond;          /* [m] from the nearest valley floor, negative on it */
    float *warp_x, *warp_z; /* [m] from a point to where the tables are read for it */
    uint8_t *river;         /* which one is nearest */
};

/* 0, or -1 with errno ENOMEM. */
int sketch_build(struct sketch *sketch, const struct anchor anchors[GEOGRAPHY_PLACE_COUNT],
                 uint64_t seed);
void sketch_free(struct sketch *sketch);

/* One of the fields at a node of the land's grid. */
float sketch_at(const float *field, uint32_t column, uint32_t row);

/* Box blur of a field in both directions, edges repeated; spare is [SKETCH_COUNT]. */
void sketch_blur(float *field, float *spare, int32_t radius);

#endif
