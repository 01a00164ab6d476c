/* A picture of the software back end's parts without the rest of it: a level camera at the origin
 * that looks north, a wall as ground, and every band in one array. What tests of renderer/soft
 * share. Whatever fails in here fails the cmocka test that called it. */
#ifndef JOLON_TESTS_SUPPORT_SOFT_STAGE_H
#define JOLON_TESTS_SUPPORT_SOFT_STAGE_H

#include "renderer/soft/kernel.h"

#define STAGE_WIDTH  212u /* no multiple of a vector, nor the height of a band */
#define STAGE_HEIGHT 120u
#define STAGE_FOCAL  200.0f /* [pixel] a metre at a metre */
#define STAGE_NEAR_M 1.0f

#define STAGE_GROUND 0x00000003u /* colour of what resolve would paint */

struct soft_stage {
    struct draw_list list;
    struct soft_frame frame;
    uint32_t *colour; /* [rows * stride] */
    float *depth;
    uint32_t stride;
};

/* No fog, hardly any haze, an empty scene of the given size; kernels: which build. */
void soft_stage_open(struct soft_stage *stage, const struct soft_kernels *kernels);
void soft_stage_close(struct soft_stage *stage);

/* Every pixel: this colour, so far [m] along the view; 0 m is the sky. */
void soft_stage_clear(struct soft_stage *stage, uint32_t colour, float far_m);

/* One band of the picture, for a kernel that fills. */
struct soft_target soft_stage_band(const struct soft_stage *stage, uint32_t band);

uint32_t soft_stage_colour(const struct soft_stage *stage, uint32_t x, uint32_t y);
float soft_stage_depth(const struct soft_stage *stage, uint32_t x, uint32_t y);

/* How many pixels have another colour than this. */
uint32_t soft_stage_painted(const struct soft_stage *stage, uint32_t ground);

/* Both builds' kernels where there are two, else the one twice. */
void soft_stage_builds(const struct soft_kernels *builds[2]);

/* The pictures are the same to the bit. */
void soft_stage_assert_same(const struct soft_stage *a, const struct soft_stage *b);

#endif
