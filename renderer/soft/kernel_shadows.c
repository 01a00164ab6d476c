/* The shadows of bodies and plants on the ground of a band: marks by which the shading pass darkens
 * the ground. */
#include "renderer/soft/billboard.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/soft_plants.h"
#include "renderer/soft/triangle_raster.h"

/* Marks ground pixels with a shadow unless theirs is darker. Other pixels stay. */
SIMD8 void darken(uint32_t *colour, v8i seen, uint32_t dark)
{
    v8u there = simd8_load_u(colour), mark = simd8_u(dark << SOFT_SHADOW_BITS);
    v8u others = ~simd8_u(255u << SOFT_SHADOW_BITS);
    seen &= (v8i)((there & ~others) < mark) & (v8i)(there < 0x01000000u);
    simd8_store_u(colour, simd8_select_u(seen, (there & others) | mark, there));
}

struct shadow_pass {
    const struct soft_target *target;
    const struct soft_shadow_face *face;
};

SIMD8 void shadow_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    const struct shadow_pass *s = context;
    v8f depth = triangle_raster_value(&s->face->edges, &s->face->depth, x, y);
    v8f there = simd8_load_f(s->target->depth + at);
    v8i seen = inside & (depth >= there) & (there > 0.0f);
    if (simd8_bits(seen) != 0)
        darken(s->target->colour + at, seen, s->face->dark);
}

/* Fills the shadow of a plant, which has the outline of its picture. */
static void fill_plant_shadow(const struct soft_plants *plants, const struct soft_target *t,
                              uint32_t index)
{
    const struct soft_plant_shadow *c = &plants->shadows[index];
    const struct band_rows *rows = &plants->shadow_rows[index];
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
    struct shadow_pass s = {.target = target};
    const struct band_lists *lists = &bodies->shadow_faces.lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++) {
        s.face = (const struct soft_shadow_face *)bodies->shadow_faces.list + lists->item[i];
        triangle_raster_walk(&s.face->edges, target, shadow_pixels, &s);
    }
    lists = &plants->shadow_lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++)
        fill_plant_shadow(plants, target, lists->item[i]);
}
