/* The world of the tests of maps. */
#include "tests/support/map_stage.h"

#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <stdlib.h>

void map_stage_open(struct map_stage *stage, uint64_t seed)
{
    static const char *const kinds[] = {"tank",      "jeep",       "truck", "carrier",
                                        "hamburger", "helicopter", "jet",   "ship"};
    fixture_open(&stage->fixture, "");
    double step_m = WORLD_SIDE_DEFAULT_M / MAP_STAGE_SIDE;
    for (uint32_t i = 0; i < MAP_STAGE_SIDE * MAP_STAGE_SIDE; i++) {
        double x = (i % MAP_STAGE_SIDE + fixture_uniform(&seed, 0.3, 0.7)) * step_m;
        double z = (i / MAP_STAGE_SIDE + fixture_uniform(&seed, 0.3, 0.7)) * step_m;
        fixture_put(&stage->fixture,
                    (struct fixture_entity){.kind = kinds[i % (sizeof kinds / sizeof kinds[0])],
                                            .at = {x, FIXTURE_GROUND_M, z},
                                            .heading_rad = fixture_uniform(&seed, 0.0, 6.28),
                                            .force = (enum force)(i % FORCE_COUNT)});
    }
    stage->state = fixture_state(&stage->fixture);
    assert_int_equal(crater_index_init(&stage->craters, &GRIDSQUARES_DEFAULT, stage->state.craters),
                     0);
    stage->frame_view = (struct frame_view){.world = &stage->fixture.view.world,
                                            .head = stage->state.head,
                                            .entities = &stage->state.entities,
                                            .fixed_damage = stage->state.fixed_damage,
                                            .craters = &stage->craters};
}

void map_stage_close(struct map_stage *stage)
{
    crater_index_free(&stage->craters);
    fixture_close(&stage->fixture);
}

struct map_stage *map_stage_new(uint64_t seed)
{
    struct map_stage *stage = calloc(1, sizeof *stage);
    assert_non_null(stage);
    map_stage_open(stage, seed);
    return stage;
}

int map_stage_teardown(void **context)
{
    map_stage_close(*context);
    free(*context);
    return 0;
}

bool map_stage_shows(const struct map_stage *stage, const struct image *image,
                     const struct map_view *view, uint32_t slot)
{
    const struct entities *e = &stage->state.entities;
    struct rgba colour = symbol_colour((enum force)e->row[slot].force);
    struct point at = map_point(view, e->row[slot].x, e->row[slot].z);
    /* The centre of a small symbol may lie between pixels, so the four pixels around it are tried.
     */
    for (int32_t i = 0; i < 4; i++) {
        int32_t x = (int32_t)(at.x - 0.5) + (i & 1), y = (int32_t)(at.y - 0.5) + (i >> 1);
        if (x < 0 || y < 0 || x >= (int32_t)image->width || y >= (int32_t)image->height)
            continue;
        const uint8_t *pixel = image->pixels + ((size_t)y * image->width + (size_t)x) * 4;
        if (abs(pixel[0] - colour.r) < 40 && abs(pixel[1] - colour.g) < 40 &&
            abs(pixel[2] - colour.b) < 40)
            return true;
    }
    return false;
}
