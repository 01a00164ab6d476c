#include "tests/support/soft_stage.h"

#include "renderer/scene/frame/light.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

void soft_stage_open(struct soft_stage *stage, const struct soft_kernels *kernels)
{
    float wide = 1.0f / STAGE_FOCAL, half_x = 0.5f * STAGE_WIDTH, half_y = 0.5f * STAGE_HEIGHT;
    *stage = (struct soft_stage){.stride = (STAGE_WIDTH + 15u) & ~15u};
    assert_int_equal(scene_init(&stage->list), 0);
    stage->list.plant_count = stage->list.body_count = stage->list.particle_count = 0;
    stage->frame = (struct soft_frame){
        .list = &stage->list,
        .kernels = kernels,
        .width = STAGE_WIDTH,
        .height = STAGE_HEIGHT,
        .bands = (STAGE_HEIGHT + SOFT_BAND_ROWS - 1) / SOFT_BAND_ROWS,
        .across = {STAGE_FOCAL, 0.0f, 0.0f},
        .down = {0.0f, -STAGE_FOCAL, 0.0f},
        .ahead = {0.0f, 0.0f, -1.0f},
        .centre_x = half_x,
        .centre_y = half_y,
        .near_m = STAGE_NEAR_M,
        .ray = {-half_x * wide, half_y * wide, -1.0f},
        .ray_x = {wide, 0.0f, 0.0f},
        .ray_y = {0.0f, -wide, 0.0f},
        .right = {1.0f, 0.0f, 0.0f},
        .up = {0.0f, 1.0f, 0.0f},
        .forward = {0.0f, 0.0f, -1.0f},
        .pixel_m = wide,
        .sun = {(float)SUN_X, (float)SUN_Y, (float)SUN_Z},
        .haze = (float)CLEAR_PER_M,
        .fog_fall = 1.0f / 120.0f,
        .texture = true,
    };
    size_t pixels = (size_t)stage->stride * stage->frame.bands * SOFT_BAND_ROWS;
    stage->colour = aligned_alloc(SOFT_ALIGN, pixels * sizeof *stage->colour);
    stage->depth = aligned_alloc(SOFT_ALIGN, pixels * sizeof *stage->depth);
    assert_non_null(stage->colour);
    assert_non_null(stage->depth);
    soft_stage_clear(stage, STAGE_GROUND, 0.0f);
}

void soft_stage_close(struct soft_stage *stage)
{
    scene_free(&stage->list);
    free(stage->colour);
    free(stage->depth);
}

void soft_stage_clear(struct soft_stage *stage, uint32_t colour, float far_m)
{
    for (size_t i = 0; i < (size_t)stage->stride * stage->frame.bands * SOFT_BAND_ROWS; i++) {
        stage->colour[i] = colour;
        stage->depth[i] = far_m > 0.0f ? 1.0f / far_m : 0.0f;
    }
}

struct soft_target soft_stage_band(const struct soft_stage *stage, uint32_t band)
{
    int32_t first = (int32_t)band * SOFT_BAND_ROWS, end = first + SOFT_BAND_ROWS;
    size_t at = (size_t)first * stage->stride;
    return (struct soft_target){
        .colour = stage->colour + at,
        .depth = stage->depth + at,
        .width = STAGE_WIDTH,
        .stride = stage->stride,
        .band = band,
        .first = first,
        .end = end < (int32_t)STAGE_HEIGHT ? end : (int32_t)STAGE_HEIGHT,
    };
}

uint32_t soft_stage_colour(const struct soft_stage *stage, uint32_t x, uint32_t y)
{
    return stage->colour[(size_t)y * stage->stride + x];
}

float soft_stage_depth(const struct soft_stage *stage, uint32_t x, uint32_t y)
{
    return stage->depth[(size_t)y * stage->stride + x];
}

uint32_t soft_stage_painted(const struct soft_stage *stage, uint32_t ground)
{
    uint32_t count = 0;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++)
            count += soft_stage_colour(stage, x, y) != ground;
    return count;
}

void soft_stage_builds(const struct soft_kernels *builds[2])
{
    builds[0] = builds[1] = &soft_kernels_plain;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        builds[1] = &soft_kernels_avx2;
#endif
}

void soft_stage_assert_same(const struct soft_stage *a, const struct soft_stage *b)
{
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++) {
        size_t row = (size_t)y * a->stride;
        assert_memory_equal(a->colour + row, b->colour + row, STAGE_WIDTH * sizeof *a->colour);
        assert_memory_equal(a->depth + row, b->depth + row, STAGE_WIDTH * sizeof *a->depth);
    }
}
