/* Fills a band with bodies: those of small bodies with one colour a face, others with textures. */
#include "renderer/soft/atmosphere.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/triangle_raster.h"
#include "renderer/soft/texel.h"

/* The data for the pixels of a face. */
struct face_pass {
    const struct soft_target *target;
    const struct soft_flat_face *flat;
    const struct soft_textured_face *side;
    const struct soft_material *material;
    const struct soft_detail *detail;
    bool texture;
};

/* --- flat ------------------------------------------------------------------------------------- */

SIMD8 void flat_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    const struct face_pass *p = context;
    v8f depth = triangle_raster_value(&p->flat->edges, &p->flat->depth, x, y);
    v8f there = simd8_load_f(p->target->depth + at);
    v8i seen = inside & (depth > there);
    simd8_store_f(p->target->depth + at, simd8_select(seen, depth, there));
    simd8_store_u(p->target->colour + at, simd8_select_u(seen, simd8_u(p->flat->colour),
                                                         simd8_load_u(p->target->colour + at)));
}

/* --- with detail ------------------------------------------------------------------------------ */

/* Looks up a mip of the detail texture; x, y [period]. */
SIMD8 struct pair8 look_up_detail(const struct face_pass *p, uint32_t mip, v8f x, v8f y)
{
    int32_t power = SOFT_DETAIL_POWER - (int32_t)mip;
    float size = (float)(256 << power);
    struct pair8 pair =
        texel_pair(p->detail->mip[mip], power, x * size - 128.0f, y * size - 128.0f);
    return (struct pair8){pair.red * TEXEL_OVER, pair.green * TEXEL_OVER};
}

SIMD8 v8f smoothstep_01(v8f t)
{
    t = simd8_clamp(t, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Returns the colour of a track, whose links alternate between light and dark. */
SIMD8 struct colour8 link_colour(const struct face_pass *p, struct colour8 c, v8f along)
{
    v8f half = 0.5f * along, off = simd8_abs(half - simd8_to_f(simd8_floor(half)) - 0.5f);
    v8f link = 0.5f + (simd8_smoothstep(0.1f, 0.3f, off) - 0.5f) * p->side->links;
    return colour_scale(c, 0.55f + 0.9f * link);
}

/* Returns the colour of a dented surface: bare metal where the dents have removed the paint. */
SIMD8 struct colour8 bare_colour(const struct face_pass *p, struct colour8 c, const v8f at[3],
                                 v8f bare)
{
    v8f scrape = look_up_detail(p, p->side->fine, at[0] * 0.9f + at[2], at[1] * 0.9f + at[2]).green;
    struct colour8 metal = colour_scale(colour_of(0.30f, 0.285f, 0.27f), 0.5f + scrape);
    v8f share = 0.85f * smoothstep_01((scrape - 0.85f + bare) * 4.0f);
    return colour_mix(c, metal, simd8_select(bare > 0.0f, share, simd8_f(0.0f)));
}

/* Returns the colour of a collapsed body: its own colour, dust, and dark gaps. */
SIMD8 struct colour8 rubble_colour(const struct face_pass *p, struct colour8 c, const v8f at[3],
                                   v8f fell)
{
    v8f x = at[0] + 0.7f * at[1], y = at[2] + 0.7f * at[1];
    v8f lump = look_up_detail(p, p->side->fine, x * 0.21f, y * 0.21f).green;
    v8f gap = look_up_detail(p, p->side->fine, x * 0.43f, y * 0.43f).red;
    struct colour8 dust = colour_scale(colour_of(0.60f, 0.53f, 0.43f), 0.7f + 0.5f * gap);
    struct colour8 rubble = colour_mix(c, dust, simd8_smoothstep(0.36f, 0.52f, lump));
    rubble = colour_scale(rubble, 0.35f + 0.65f * simd8_smoothstep(0.34f, 0.50f, gap));
    /* Earth lies between the standing and the collapsed part. */
    v8f torn = simd8_smoothstep(0.01f, 0.15f, fell) * (1.0f - simd8_smoothstep(0.85f, 1.0f, fell));
    struct colour8 earth = colour_scale(colour_of(0.42f, 0.35f, 0.27f), 0.55f + 0.9f * lump * gap);
    return colour_mix(colour_mix(c, rubble, simd8_smoothstep(0.5f, 1.0f, fell)), earth,
                      0.92f * torn);
}

/* Returns the colour of worn paint: blots of camouflage, fine pattern, soot and rust. */
SIMD8 struct colour8 worn_colour(const struct face_pass *p, struct colour8 c, const v8f at[3])
{
    const struct soft_material *material = p->material;
    v8f x = at[0] + 0.45f * at[1], y = at[2] + 0.8f * at[1];
    struct pair8 blot =
        look_up_detail(p, p->side->broad, x * PATTERN_BROAD_PER_M, y * PATTERN_BROAD_PER_M);
    struct pair8 fine =
        look_up_detail(p, p->side->fine, x * PATTERN_FINE_PER_M, y * PATTERN_FINE_PER_M);
    v8f dark = simd8_smoothstep(0.46f, 0.54f, blot.red) * p->side->worn;
    c = colour_scale(c, (1.0f - 0.30f * dark) * (0.86f + 0.28f * fine.red));
    v8f soot =
        smoothstep_01((fine.green + 0.3f * blot.green - material->soot_low) * material->soot_over);
    v8f rust =
        simd8_smoothstep(0.60f, 0.80f, fine.green + 0.4f * (blot.green - 0.5f)) * material->rust;
    struct colour8 burnt =
        colour_mix(colour_of(0.055f, 0.05f, 0.047f), colour_of(0.20f, 0.115f, 0.07f), rust);
    return colour_mix(c, burnt, simd8_max(soot * material->soot_most, simd8_f(material->burnt)));
}

SIMD8 void side_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    const struct face_pass *p = context;
    const struct soft_textured_face *side = p->side;
    const struct soft_material *material = p->material;
    v8f depth = triangle_raster_value(&side->edges, &side->depth, x, y);
    v8f there = simd8_load_f(p->target->depth + at), value[VALUE_COUNT];
    v8i seen = inside & (depth > there);
    if (simd8_bits(seen) == 0)
        return;
    v8f far = 1.0f / simd8_select(seen, depth, simd8_f(1.0f));
    for (uint32_t i = 0; i < VALUE_COLLAPSED; i++)
        value[i] = triangle_raster_value(&side->edges, &side->value[i], x, y) * far;
    struct colour8 c = colour_of(side->colour[0], side->colour[1], side->colour[2]);
    if (side->track)
        c = link_colour(p, c,
                        triangle_raster_value(&side->edges, &side->value[VALUE_ALONG], x, y) * far);
    if (material->deformed) {
        v8f bare = triangle_raster_value(&side->edges, &side->value[VALUE_BARE], x, y) * far;
        v8f fell = triangle_raster_value(&side->edges, &side->value[VALUE_COLLAPSED], x, y) * far;
        if (simd8_bits(seen & (bare > 0.0f)) != 0)
            c = bare_colour(p, c, value + VALUE_X, bare);
        if (simd8_bits(seen & (fell > 0.0f)) != 0)
            c = rubble_colour(p, c, value + VALUE_X, fell);
    }
    if (p->texture)
        c = worn_colour(p, c, value + VALUE_X);
    else
        c = colour_mix(c, colour_of(0.07f, 0.07f, 0.07f), simd8_f(material->plain));
    v8u colour = simd8_pack(c.r * value[VALUE_RED] * material->clear + material->air[0],
                            c.g * value[VALUE_GREEN] * material->clear + material->air[1],
                            c.b * value[VALUE_BLUE] * material->clear + material->air[2]);
    simd8_store_f(p->target->depth + at, simd8_select(seen, depth, there));
    simd8_store_u(p->target->colour + at,
                  simd8_select_u(seen, colour, simd8_load_u(p->target->colour + at)));
}

void KERNEL(soft_bodies_fill)(const struct soft_bodies *bodies, const struct soft_frame *frame,
                              const struct soft_target *target)
{
    struct face_pass p = {.target = target, .detail = bodies->detail, .texture = frame->texture};
    const struct band_lists *lists = &bodies->flat_faces.lists;
    uint32_t band = target->band;
    for (uint32_t i = lists->start[band]; i < lists->start[band + 1]; i++) {
        p.flat = (const struct soft_flat_face *)bodies->flat_faces.list + lists->item[i];
        triangle_raster_walk(&p.flat->edges, target, flat_pixels, &p);
    }
    lists = &bodies->textured_faces.lists;
    for (uint32_t i = lists->start[band]; i < lists->start[band + 1]; i++) {
        p.side = (const struct soft_textured_face *)bodies->textured_faces.list + lists->item[i];
        p.material = &bodies->materials[p.side->material];
        triangle_raster_walk(&p.side->edges, target, side_pixels, &p);
    }
}
