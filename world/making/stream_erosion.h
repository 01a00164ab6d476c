/* Streams and the hills between them: a grid of heights becomes the steady state of the stream
 * power law, in which the slope towards the sea falls with the square root of the drainage area
 * (Whipple & Tucker 1999, theta = 0.5; solved along the flow tree as by Braun & Willett 2013).
 * Ridges and spurs remain between the streams. */
#ifndef JOLON_WORLD_MAKING_STREAM_EROSION_H
#define JOLON_WORLD_MAKING_STREAM_EROSION_H

#include <stdint.h>

struct stream_erosion {
    uint32_t side; /* nodes along one edge */
    double spacing_m;
    float *height;      /* [m] in: determines the flow; out: the steady state; [side * side] */
    float *steepness;   /* [m] slope where 1 m2 drains; the caller's */
    float *slope_max;   /* steepest hillside; the caller's */
    uint8_t *fixed;     /* 1: height stays, water leaves here (rivers, the sea); the caller's */
    uint32_t *receiver; /* the node that water flows to, itself where fixed */
    uint32_t *order;    /* every node after its receiver */
    float *area_m2;     /* draining through the node, its own included */
    float *base_m;      /* height of the fixed node to which its water flows */
    uint32_t *next;     /* the flood's queue: one list for each step of height */
    uint32_t *head, *tail;
    uint8_t *seen;
};

/* Allocates all arrays, set to zero. Returns 0, or -1 with errno ENOMEM. */
int stream_erosion_init(struct stream_erosion *erosion, uint32_t side, double spacing_m);
void stream_erosion_free(struct stream_erosion *erosion);

/* One round: finds receivers on the present heights, drainage areas, then the new heights. At least
 * one node must be fixed. The network converges within about ten rounds. */
void stream_erosion_round(struct stream_erosion *erosion, uint64_t seed);

#endif
