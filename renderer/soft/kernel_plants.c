/* Sets up plants and their shadows, and fills a band with plants. */
#include "renderer/soft/atmosphere.h"
#include "renderer/soft/billboard.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_plants.h"
#include "renderer/soft/triangle_raster.h"

#define SHADOW_RANGE_M 2200.0f /* no plant farther away has a shadow */
#define SHADOW_FULL_M  1400.0f
#define SHADOW_LOW_M   60.0f /* the limit for plants that are lower than: */
#define SHADOW_HIGH_M  1.3f
#define SHADOW_LEAST_M 0.3f
#define SHADOW_STEEP   0.25f  /* a shadow is at most 1 / this times as long as the plant is high */
#define SHADOW_BIAS    0.002f /* of the distance, by which a shadow is nearer than the slope */
#define SHADOW_CUT     102u   /* alpha 0.4 */
#define MIX_TEXELS     1.5f   /* pixels a texel above which texels are interpolated, */
#define MIX_LEVEL      5u     /* and the level up to which they always are, to hide blocks */

/* --- set-up ----------------------------------------------------------------------------------- */

/* Eight plants of the draw list. If there are fewer, the last is repeated. */
struct plants8 {
    v8f at[3], width, height, lean, slope[2], tint[3];
    v8f far, level;       /* [m] distance, and horizontal distance */
    v8f ahead_x, ahead_z; /* unit vector from the eye, horizontal */
    struct atmosphere8 air;
};

/* A linear function over the picture for each of eight billboards. */
struct values8 {
    v8f v[3];
};

struct billboards8 {
    struct values8 depth, across, down; /* the last two in units of the picture, not texels */
    v8f left, right, high, low;         /* [pixel] within the picture */
    v8f size;                           /* [pixel] the smaller of width and height */
    v8i there;
};

static void load_plants(const struct soft_frame *f, struct plants8 *p,
                        const struct draw_list_plant *from, uint32_t count)
{
    for (uint32_t i = 0; i < LANES; i++) {
        const struct draw_list_plant *plant = &from[i < count ? i : count - 1];
        for (uint32_t axis = 0; axis < 3; axis++) {
            p->at[axis][i] = plant->at[axis];
            p->tint[axis][i] = plant->tint[axis];
        }
        p->width[i] = plant->width;
        p->height[i] = plant->height;
        p->lean[i] = plant->lean;
        p->slope[0][i] = plant->slope[0];
        p->slope[1][i] = plant->slope[1];
    }
    p->far = simd8_sqrt(simd8_dot3(p->at, p->at));
    p->level = simd8_sqrt(p->at[0] * p->at[0] + p->at[2] * p->at[2] + 1e-8f);
    p->ahead_x = p->at[0] / p->level;
    p->ahead_z = p->at[2] / p->level;
    p->air = atmosphere_at(f, p->at);
}

/* Returns the dot product of the pixels' rays with a vector, as a linear function over the
 * picture. */
SIMD8 struct values8 over_picture(const struct soft_frame *f, v8f x, v8f y, v8f z)
{
    struct values8 o;
    o.v[1] = f->ray_x[0] * x + f->ray_x[1] * y + f->ray_x[2] * z;
    o.v[2] = f->ray_y[0] * x + f->ray_y[1] * y + f->ray_y[2] * z;
    o.v[0] = f->ray[0] * x + f->ray[1] * y + f->ray[2] * z + 0.5f * (o.v[1] + o.v[2]);
    return o;
}

SIMD8 struct values8 sum(struct values8 a, v8f by, struct values8 b, v8f by_b)
{
    struct values8 o;
    for (uint32_t i = 0; i < 3; i++)
        o.v[i] = a.v[i] * by + b.v[i] * by_b;
    return o;
}

/* Extends the bounds of billboards by a corner. cut: those with a corner nearer than the near
 * plane. */
SIMD8 void take_corner(const struct soft_frame *f, struct billboards8 *b, const v8f place[3],
                       v8i *cut)
{
    v8f ahead = simd8_dot3_f(f->ahead, place);
    v8f across = simd8_dot3_f(f->across, place);
    v8f down = simd8_dot3_f(f->down, place);
    v8i behind = ahead < f->near_m;
    v8f over = 1.0f / simd8_select(behind, simd8_f(f->near_m), ahead);
    v8f x = f->centre_x + across * over, y = f->centre_y + down * over;
    *cut |= behind;
    b->there |= ~behind;
    b->left = simd8_min(b->left, x);
    b->right = simd8_max(b->right, x);
    b->high = simd8_min(b->high, y);
    b->low = simd8_max(b->low, y);
}

/* Finds the bounds in the picture of billboards with this foot and these two sides. One that
 * crosses the near plane may be anywhere in the picture. */
SIMD8 void find_bounds(const struct soft_frame *f, struct billboards8 *b, const v8f foot[3],
                       const v8f side[3], const v8f up[3])
{
    v8i cut = simd8_i(0);
    b->there = simd8_i(0);
    b->left = b->high = simd8_f(TRIANGLE_RASTER_FAR);
    b->right = b->low = simd8_f(-TRIANGLE_RASTER_FAR);
    for (uint32_t corner = 0; corner < 4; corner++) {
        v8f place[3];
        for (uint32_t i = 0; i < 3; i++) {
            place[i] = foot[i] + ((corner & 1) != 0 ? 0.5f : -0.5f) * side[i];
            place[i] = (corner & 2) != 0 ? place[i] + up[i] : place[i];
        }
        take_corner(f, b, place, &cut);
    }
    float columns = (float)f->width, rows = (float)f->height;
    b->size = simd8_min(b->right - b->left, b->low - b->high);
    b->left = simd8_clamp(simd8_select(cut, simd8_f(0.0f), b->left), 0.0f, columns);
    b->right = simd8_clamp(simd8_select(cut, simd8_f(columns), b->right), 0.0f, columns);
    b->high = simd8_clamp(simd8_select(cut, simd8_f(0.0f), b->high), 0.0f, rows);
    b->low = simd8_clamp(simd8_select(cut, simd8_f(rows), b->low), 0.0f, rows);
    b->there &= (b->left < b->right) & (b->high < b->low);
}

/* Returns upright billboards that face the eye about the vertical. Seen steeply from above, their
 * tops lean away from the eye (struct draw_list_plant). */
SIMD8 struct billboards8 upright_billboards(const struct soft_frame *f, const struct plants8 *p)
{
    struct billboards8 b;
    v8f right_x = -p->ahead_z, right_z = p->ahead_x, zero = simd8_f(0.0f), one = simd8_f(1.0f);
    v8f side[3] = {right_x * p->width, zero, right_z * p->width};
    v8f leans = p->lean * p->height;
    /* These are the sine and cosine of the angle by which it leans back. */
    v8f back = simd8_max((-p->at[1] - p->level) * DRAW_LIST_PLANT_STEEP / p->far, zero);
    v8f rise =
        simd8_select(back > zero, (p->level - p->at[1]) * DRAW_LIST_PLANT_STEEP / p->far, one);
    v8f back_x = p->ahead_x * back, back_z = p->ahead_z * back;
    v8f up[3] = {right_x * leans + back_x * p->height, rise * p->height,
                 right_z * leans + back_z * p->height};
    find_bounds(f, &b, p->at, side, up);
    v8f off_plane =
        p->level * rise - p->at[1] * back; /* distance of the eye from the billboard's plane */
    b.depth = over_picture(f, p->ahead_x * rise / off_plane, -back / off_plane,
                           p->ahead_z * rise / off_plane);
    /* First the height in the picture, then the position across. */
    v8f foot = (p->level * back + p->at[1] * rise) / p->height;
    struct values8 high =
        sum(over_picture(f, back_x / p->height, rise / p->height, back_z / p->height), one, b.depth,
            -foot);
    struct values8 off = over_picture(f, right_x / p->width, zero, right_z / p->width);
    b.down = sum(b.depth, one, high, -one);
    b.across = sum(sum(off, one, high, -leans / p->width), one, b.depth, simd8_f(0.5f));
    return b;
}

/* Returns the plants' shadows: billboards on the slope, away from the sun. */
SIMD8 struct billboards8 shadow_billboards(const struct soft_frame *f, const struct plants8 *p,
                                           v8f *reach)
{
    struct billboards8 b;
    float level = sqrtf(f->sun[0] * f->sun[0] + f->sun[2] * f->sun[2]);
    float away_x = -f->sun[0] / level, away_z = -f->sun[2] / level;
    float aside_x = -away_z, aside_z = away_x;
    v8f one = simd8_f(1.0f), leans = p->lean * p->height;
    /* The shadow ends where the sun's ray through the top meets the slope. */
    v8f fall = p->slope[0] * away_x + p->slope[1] * away_z;
    v8f bank = p->slope[0] * aside_x + p->slope[1] * aside_z;
    *reach = p->height / simd8_max(f->sun[1] / level + fall, simd8_f(SHADOW_STEEP));
    v8f foot[3] = {p->at[0], p->at[1] + 0.10f + 0.02f * p->height, p->at[2]};
    v8f side[3] = {aside_x * p->width, bank * p->width, aside_z * p->width};
    v8f up[3] = {away_x * *reach + aside_x * leans, fall * *reach + bank * leans,
                 away_z * *reach + aside_z * leans};
    find_bounds(f, &b, foot, side, up);
    v8f under = foot[1] - p->slope[0] * foot[0] - p->slope[1] * foot[2];
    b.there &= under < -1e-3f;
    v8f over = 1.0f / simd8_min(under, simd8_f(-1e-3f));
    b.depth = over_picture(f, -p->slope[0] * over, over, -p->slope[1] * over);
    v8f at_away = foot[0] * away_x + foot[2] * away_z;
    v8f at_aside = foot[0] * aside_x + foot[2] * aside_z;
    struct values8 high = sum(over_picture(f, away_x / *reach, simd8_f(0.0f), away_z / *reach), one,
                              b.depth, -at_away / *reach);
    struct values8 off = over_picture(f, aside_x / p->width, simd8_f(0.0f), aside_z / p->width);
    b.down = sum(b.depth, one, high, -one);
    b.across =
        sum(sum(off, one, high, -leans / p->width), one, b.depth, 0.5f - at_aside / p->width);
    return b;
}

/* Returns log2 of the side of the picture whose texels are about as large as pixels. */
static uint32_t level_of(float side)
{
    uint32_t level = 1;
    while (level < PLANT_LEVELS && side > 1.41421356f * (float)(1u << level))
        level++;
    return level;
}

static bool set_board(const struct soft_plants *plants, struct soft_billboard *board,
                      struct band_rows *rows, const struct billboards8 *b, float picture,
                      uint32_t lane)
{
    uint32_t which = (uint32_t)(picture + 0.5f);
    which = which < PLANT_IMPOSTORS_COUNT ? which : 0;
    board->level = (uint16_t)level_of(b->size[lane]);
    board->leaves = plants->first[which][board->level];
    float side = (float)(1u << board->level);
    for (uint32_t i = 0; i < 3; i++) {
        board->depth[i] = b->depth.v[i][lane];
        board->across[i] = side * b->across.v[i][lane];
        board->down[i] = side * b->down.v[i][lane];
    }
    board->left = (int16_t)triangle_raster_ceil(b->left[lane], (float)SOFT_SIDE_MAX);
    board->right = (int16_t)triangle_raster_ceil(b->right[lane], (float)SOFT_SIDE_MAX);
    rows->first = (int16_t)triangle_raster_ceil(b->high[lane], (float)SOFT_SIDE_MAX);
    rows->end = (int16_t)triangle_raster_ceil(b->low[lane], (float)SOFT_SIDE_MAX);
    return board->left < board->right && rows->first < rows->end;
}

static void set_light(const struct soft_frame *f, struct soft_plant *plant, const struct plants8 *p,
                      uint32_t lane)
{
    static const float sky[3] = {SKY_LIGHT_RED, SKY_LIGHT_GREEN, SKY_LIGHT_BLUE};
    static const float sun[3] = {SUN_LIGHT_RED, SUN_LIGHT_GREEN, SUN_LIGHT_BLUE};
    const v8f air[3] = {p->air.colour.r, p->air.colour.g, p->air.colour.b};
    float opacity = p->air.opacity[lane], x = p->ahead_x[lane], z = p->ahead_z[lane];
    for (uint32_t i = 0; i < 3; i++) {
        float tint = f->texture ? p->tint[i][lane] : 1.0f;
        plant->sky[i] = PLANT_OPEN * (1.0f - opacity) * tint * sky[i];
        plant->sun[i] = PLANT_OPEN * (1.0f - opacity) * tint * sun[i];
        plant->air[i] = 255.0f * opacity * air[i][lane];
    }
    plant->to_sun[0] = x * f->sun[2] - z * f->sun[0];
    plant->to_sun[1] = f->sun[1];
    plant->to_sun[2] = -x * f->sun[0] - z * f->sun[2];
}

static void put_plants(struct soft_plants *plants, const struct soft_frame *f,
                       const struct plants8 *p, const struct draw_list_plant *from, uint32_t lanes)
{
    struct billboards8 b = upright_billboards(f, p);
    /* Texels of small pictures are averages of leaves and gaps: a lower threshold keeps the plant's
     * size. */
    v8f cut = 255.0f * (0.5f - 0.28f * simd8_smoothstep(150.0f, 1800.0f, p->far));
    for (lanes &= simd8_bits(b.there); lanes != 0; lanes &= lanes - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        struct soft_plant *plant = &plants->plants[plants->count];
        if (!set_board(plants, &plant->board, &plants->rows[plants->count], &b, from[lane].picture,
                       lane))
            continue;
        plant->board.cut = (uint16_t)(cut[lane] + 0.5f);
        plant->mixed = plant->board.level <= MIX_LEVEL ||
                       b.size[lane] > MIX_TEXELS * (float)(1u << plant->board.level);
        set_light(f, plant, p, lane);
        plants->count++;
    }
}

static void put_shadows(struct soft_plants *plants, const struct soft_frame *f,
                        const struct plants8 *p, const struct draw_list_plant *from, uint32_t lanes)
{
    v8f reach, far = p->far;
    v8i none = (far > SHADOW_RANGE_M) | (p->height < SHADOW_LEAST_M) |
               ((p->height < SHADOW_HIGH_M) & (far > SHADOW_LOW_M));
    lanes &= simd8_bits(~none);
    if (lanes == 0)
        return;
    struct billboards8 b = shadow_billboards(f, p, &reach);
    v8f strong = 1.0f - simd8_smoothstep(SHADOW_FULL_M, SHADOW_RANGE_M, far);
    v8f dark = (float)SOFT_SHADOW_FULL * (1.0f - p->air.opacity) * strong;
    for (lanes &= simd8_bits(b.there); lanes != 0; lanes &= lanes - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        struct soft_plant_shadow *shadow = &plants->shadows[plants->shadow_count];
        shadow->dark = (uint32_t)(dark[lane] + 0.5f);
        shadow->board.cut = SHADOW_CUT;
        if (shadow->dark > 0 &&
            set_board(plants, &shadow->board, &plants->shadow_rows[plants->shadow_count], &b,
                      from[lane].picture, lane)) {
            for (uint32_t i = 0; i < 3; i++) {
                shadow->board.depth[i] *= 1.0f + SHADOW_BIAS;
                shadow->board.across[i] *= 1.0f + SHADOW_BIAS;
                shadow->board.down[i] *= 1.0f + SHADOW_BIAS;
            }
            plants->shadow_count++;
        }
    }
}

void KERNEL(soft_plants_set_up)(struct soft_plants *plants, const struct soft_frame *frame)
{
    const struct draw_list *list = frame->list;
    plants->count = plants->shadow_count = 0;
    for (uint32_t first = 0; first < list->plant_count; first += LANES) {
        uint32_t count = list->plant_count - first < LANES ? list->plant_count - first : LANES;
        const struct draw_list_plant *from = &list->plants[first];
        struct plants8 p;
        load_plants(frame, &p, from, count);
        put_plants(plants, frame, &p, from, (1u << count) - 1u);
        put_shadows(plants, frame, &p, from, (1u << count) - 1u);
    }
}

/* --- bands ------------------------------------------------------------------------------------ */

/* Eight texels: colour 0 .. 255, and normal. */
struct leaves8 {
    struct colour8 colour;
    v8f alpha, facing[3];
};

SIMD8 struct leaves8 unpack(v8u colour, v8u facing, bool texture)
{
    struct leaves8 l = {
        .colour = {simd8_byte(colour, 0), simd8_byte(colour, 8), simd8_byte(colour, 16)},
        .alpha = simd8_byte(colour, 24),
        .facing = {simd8_byte(facing, 0) * (1.0f / 127.5f) - 1.0f,
                   simd8_byte(facing, 8) * (1.0f / 127.5f) - 1.0f,
                   simd8_byte(facing, 16) * (1.0f / 127.5f) - 1.0f},
    };
    if (!texture)
        l.colour = colour_scale(colour_of(0.25f, 0.32f, 0.15f), simd8_byte(facing, 24));
    return l;
}

SIMD8 struct leaves8 mix_leaves(const struct leaves8 *a, const struct leaves8 *b, v8f t)
{
    struct leaves8 l = {.colour = colour_mix(a->colour, b->colour, t),
                        .alpha = simd8_mix(a->alpha, b->alpha, t)};
    for (uint32_t i = 0; i < 3; i++)
        l.facing[i] = simd8_mix(a->facing[i], b->facing[i], t);
    return l;
}

/* Returns texels by bilinear interpolation. */
SIMD8 struct leaves8 bilinear_leaves(const struct soft_billboard *b, const struct soft_leaf *leaves,
                                     v8f column, v8f row, bool texture)
{
    float last = (float)(1u << b->level) - 1.0f;
    v8f left = simd8_clamp(column - 0.5f, 0.0f, last), high = simd8_clamp(row - 0.5f, 0.0f, last);
    v8i x = simd8_to_i(left), y = simd8_to_i(high);
    v8i right = simd8_select_i(simd8_to_f(x) < last, simd8_i(8), simd8_i(0));
    v8i below = simd8_select_i(simd8_to_f(y) < last, simd8_i(8 << b->level), simd8_i(0));
    v8i at = ((y << b->level) + x) * 8;
    struct leaves8 four[4];
    for (uint32_t i = 0; i < 4; i++) {
        v8i texel = at + ((i & 1) != 0 ? right : simd8_i(0)) + ((i & 2) != 0 ? below : simd8_i(0));
        struct simd8_pairs pair = simd8_gather_pairs(leaves, texel);
        four[i] = unpack(pair.low, pair.high, texture);
    }
    struct leaves8 top = mix_leaves(&four[0], &four[1], left - simd8_to_f(x));
    struct leaves8 low = mix_leaves(&four[2], &four[3], left - simd8_to_f(x));
    return mix_leaves(&top, &low, high - simd8_to_f(y));
}

/* Returns the colour of lit leaves; a part of the sunlight shines through from behind. */
SIMD8 v8u lit(const struct soft_plant *p, const struct leaves8 *l)
{
    v8f sun = simd8_dot3_f(p->to_sun, l->facing);
    v8f zero = simd8_f(0.0f), most = simd8_f(255.0f);
    v8f straight = simd8_max(0.85f * sun + 0.15f, zero) + simd8_max(-0.16f * sun, zero);
    v8f around = 0.80f + 0.35f * l->facing[1];
    v8f r = l->colour.r * (around * p->sky[0] + straight * p->sun[0]) + p->air[0] + 0.5f;
    v8f g = l->colour.g * (around * p->sky[1] + straight * p->sun[1]) + p->air[1] + 0.5f;
    v8f b = l->colour.b * (around * p->sky[2] + straight * p->sun[2]) + p->air[2] + 0.5f;
    return (v8u)(simd8_to_i(simd8_min(r, most)) | simd8_to_i(simd8_min(g, most)) << 8 |
                 simd8_to_i(simd8_min(b, most)) << 16) |
           0xff000000u;
}

SIMD8 void plant_pixels(const struct soft_plant *p, const struct soft_leaf *leaves,
                        const struct soft_target *t, int32_t x, int32_t y, v8i inside, bool texture)
{
    size_t at = (size_t)(y - t->first) * t->stride + (size_t)x;
    struct billboard8 b = billboard_pixels(&p->board, t->depth + at, x, y, inside);
    struct leaves8 l;
    if (simd8_bits(b.seen) == 0)
        return;
    if (p->mixed) {
        l = bilinear_leaves(&p->board, leaves, b.column, b.row, texture);
        b.seen &= l.alpha >= (float)p->board.cut;
    } else {
        v8i texel = billboard_texel(&p->board, b.column, b.row);
        struct simd8_pairs pair = simd8_gather_pairs(leaves, texel * 8);
        b.seen &= (v8i)(pair.low >> 24) >= (int32_t)p->board.cut;
        if (simd8_bits(b.seen) == 0)
            return;
        l = unpack(pair.low, pair.high, texture);
    }
    simd8_store_f(t->depth + at, simd8_select(b.seen, b.depth, simd8_load_f(t->depth + at)));
    simd8_store_u(t->colour + at, simd8_select_u(b.seen, lit(p, &l), simd8_load_u(t->colour + at)));
}

void KERNEL(soft_plants_fill)(const struct soft_plants *plants, const struct soft_frame *frame,
                              const struct soft_target *target)
{
    const struct band_lists *lists = &plants->lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++) {
        const struct soft_plant *p = &plants->plants[lists->item[i]];
        const struct band_rows *rows = &plants->rows[lists->item[i]];
        const struct soft_leaf *leaves = &plants->leaves[p->board.leaves];
        int32_t y = rows->first > target->first ? rows->first : target->first;
        int32_t last = rows->end < target->end ? rows->end : target->end;
        for (; y < last; y++)
            for (int32_t x = p->board.left & -LANES; x < p->board.right; x += LANES)
                plant_pixels(p, leaves, target, x, y,
                             simd8_within(x, p->board.left, p->board.right), frame->texture);
    }
}
