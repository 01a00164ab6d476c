/* A picture for testing single parts of the software back end: a level camera at the origin looks
 * north at a wall of ground, and one array holds every band. The tests of renderer/soft share it. A
 * failure in here fails the calling cmocka test. */
#ifndef JOLON_TESTS_SUPPORT_SOFT_STAGE_H
#define JOLON_TESTS_SUPPORT_SOFT_STAGE_H

#include "renderer/soft/kernel.h"

#define STAGE_WIDTH  212u /* a multiple of neither a vector nor a band */
#define STAGE_HEIGHT 120u
#define STAGE_FOCAL  200.0f /* [pixel] width of 1 m at a distance of 1 m */
#define STAGE_NEAR_M 1.0f

#define STAGE_GROUND 0x00000003u /* a ground code, before shading */

struct soft_stage {
    struct draw_list list;
    struct soft_frame frame;
    uint32_t *colour; /* [rows * stride] */
    float *depth;
    uint32_t stride;
};

/* Opens an empty scene without fog and with hardly any haze; kernels: the build to test. */
void soft_stage_open(struct soft_stage *stage, const struct soft_kernels *kernels);
void soft_stage_close(struct soft_stage *stage);

/* Gives every pixel this colour and this distance along the view [m]; 0 m is the sky. */
void soft_stage_clear(struct soft_stage *stage, uint32_t colour, float far_m);

/* Returns one band of the picture. */
struct soft_target soft_stage_band(const struct soft_stage *stage, uint32_t band);

uint32_t soft_stage_colour(const struct soft_stage *stage, uint32_t x, uint32_t y);
float soft_stage_depth(const struct soft_stage *stage, uint32_t x, uint32_t y);

/* Returns how many pixels have another colour than this. */
uint32_t soft_stage_painted(const struct soft_stage *stage, uint32_t ground);

/* Sets both builds of the kernels; they are the same where the processor has only one. */
void soft_stage_builds(const struct soft_kernels *builds[2]);

/* Asserts that both pictures are the same to the bit. */
void soft_stage_assert_same(const struct soft_stage *a, const struct soft_stage *b);

#endif
