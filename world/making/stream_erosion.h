/* Streams and the hills they leave: a grid of heights becomes the steady state of the stream power
 * law, in which the slope towards the sea falls with the square root of the area that drains
 * through (Whipple & Tucker 1999, theta = 0.5; solved along the flow tree as by Braun & Willett
 * 2013). What stands between the streams are ridges and spurs as running water cuts them. */
#ifndef JOLON_WORLD_MAKING_STREAM_EROSION_H
#define JOLON_WORLD_MAKING_STREAM_EROSION_H

#include <stdint.h>

struct stream_erosion {
    uint32_t side; /* nodes along one edge */
    double spacing_m;
    float *height;      /* [side * side, m] in: where water finds its way; out: the steady state */
    float *steepness;   /* [m] slope where 1 m2 drains; the caller's */
    float *slope_max;   /* steepest hillside; the caller's */
    uint8_t *fixed;     /* 1: height stays, water leaves here (rivers, the sea); the caller's */
    uint32_t *receiver; /* the node that water flows to, itself where fixed */
    uint32_t *order;    /* every node after its receiver */
    float *area_m2;     /* draining through the node, its own included */
    float *base_m;      /* height of the fixed node that its water leaves at */
    uint32_t *next;     /* the flood's queue, one list a step of height */
    uint32_t *head, *tail;
    uint8_t *seen;
};

/* All arrays allocated and zero; 0, or -1 with errno ENOMEM. */
int stream_erosion_init(struct stream_erosion *erosion, uint32_t side, double spacing_m);
void stream_erosion_free(struct stream_erosion *erosion);

/* One round: finds receivers on the present heights, areas, then the heights they lead to. At
 * least one node must be fixed. The network settles within some ten rounds. */
void stream_erosion_round(struct stream_erosion *erosion, uint64_t seed);

#endif
