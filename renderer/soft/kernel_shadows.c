/* Shadows of bodies and plants on the ground of a band: marks that resolve darkens by. */
#include "renderer/soft/billboard.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/soft_plants.h"
#include "renderer/soft/triangle_raster.h"

/* Darkens ground, where it is not darker, and nothing else. */
SIMD8 void darken(uint32_t *colour, v8i seen, uint32_t dark)
{
    v8u there = simd8_load_u(colour), mark = simd8_u(dark << SOFT_SHADOW_BITS);
    v8u others = ~simd8_u(255u << SOFT_SHADOW_BITS);
    seen &= (v8i)((there & ~others) < mark) & (v8i)(there < 0x01000000u);
    simd8_store_u(colour, simd8_select_u(seen, (there & others) | mark, there));
}

struct shading {
    const struct soft_target *target;
    const struct soft_shadow *shade;
};

SIMD8 void shade_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    const struct shading *s = context;
    v8f depth = triangle_raster_value(&s->shade->edges, &s->shade->depth, x, y);
    v8f there = simd8_load_f(s->target->depth + at);
    v8i seen = inside & (depth >= there) & (there > 0.0f);
    if (simd8_bits(seen) != 0)
        darken(s->target->colour + at, seen, s->shade->dark);
}

/* A plant's shadow has the plant's outline. */
static void fill_cast(const struct soft_plants *plants, const struct soft_target *t, uint32_t index)
{
    const struct soft_cast *c = &plants->casts[index];
    const struct band_rows *rows = &plants->cast_rows[index];
    const struct soft_leaf *leaves = &plants->leaves[c->board.leaves];
    int32_t y = rows->first > t->first ? rows->first : t->first;
    int32_t last = rows->end < t->end ? rows->end : t->end;
    for (; y < last; y++) {
        int32_t first, end;
        billboard_range(&c->board, y, &first, &end);
        for (int32_t x = first & -LANES; x < end; x += LANES) {
            size_t at = (size_t)(y - t->first) * t->stride + (size_t)x;
            struct billboard8 b =
                billboard_pixels(&c->board, t->depth + at, x, y, simd8_within(x, first, end));
            b.seen &= simd8_load_f(t->depth + at) > 0.0f;
            if (simd8_bits(b.seen) == 0)
                continue;
            v8u leaf = simd8_gather_bytes(leaves, billboard_texel(&c->board, b.column, b.row) * 8);
            darken(t->colour + at, b.seen & ((v8i)(leaf >> 24) >= (int32_t)c->board.cut), c->dark);
        }
    }
}

void KERNEL(soft_shadows_fill)(const struct soft_bodies *bodies, const struct soft_plants *plants,
                               const struct soft_frame *frame, const struct soft_target *target)
{
    (void)frame;
    struct shading s = {.target = target};
    const struct band_lists *lists = &bodies->shades.lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++) {
        s.shade = (const struct soft_shadow *)bodies->shades.list + lists->item[i];
        triangle_raster_walk(&s.shade->edges, target, shade_pixels, &s);
    }
    lists = &plants->cast_lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++)
        fill_cast(plants, target, lists->item[i]);
}
