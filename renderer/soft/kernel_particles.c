/* Particles: smoke, fire, tracers. They are blended into the picture, farthest first. */
#include "renderer/soft/atmosphere.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_particles.h"
#include "renderer/soft/triangle_raster.h"

#define LEAST_RADIUS  0.7f   /* [pixel] smaller particles are drawn with this radius, and fainter */
#define COARSE_PIXELS 100.0f /* [pixel] diameter above which one look-up serves 2 x 2 pixels, */
#define COARSE_COVER  0.6f   /* if the particle covers this much: the edges of fire are sharp */
#define STRIP_DEEP    0.15f  /* share of its distance by which a strip's ends may differ */

/* --- set-up ----------------------------------------------------------------------------------- */

/* Eight particles of the draw list. If there are fewer, the last is repeated. */
struct particles8 {
    v8f at[3], size, turn, glow, colour[3], alpha;
};

static struct particles8 load_particles(const struct draw_list_particle *from, uint32_t count)
{
    struct particles8 p;
    for (uint32_t i = 0; i < LANES; i++) {
        const struct draw_list_particle *particle = &from[i < count ? i : count - 1];
        for (uint32_t axis = 0; axis < 3; axis++) {
            p.at[axis][i] = particle->at[axis];
            p.colour[axis][i] = particle->colour[axis];
        }
        p.size[i] = particle->size;
        p.turn[i] = particle->turn_rad;
        p.glow[i] = particle->glow;
        p.alpha[i] = particle->colour[3];
    }
    return p;
}

/* Returns the sine of an angle in turns, to 0.001, which is enough to turn a picture of smoke. */
SIMD8 v8f sine(v8f turns)
{
    v8f t = turns - simd8_to_f(simd8_floor(turns + 0.5f));
    v8f s = t * (8.0f - 16.0f * simd8_abs(t));
    return s * (0.775f + 0.225f * simd8_abs(s));
}

/* The positions of eight round particles in the picture. */
struct round8 {
    v8f x, y, radius, depth, cosine, sine;
};

SIMD8 struct round8 place_round(const struct soft_frame *f, const struct particles8 *p, v8f ahead)
{
    v8f far = simd8_sqrt(simd8_dot3(p->at, p->at));
    /* A particle is a ball. Its depth is that of its near side, so that the ground does not cut it
     * along a line. */
    v8f near = ahead * (1.0f - simd8_min(p->size, 0.5f * far) / simd8_max(far, simd8_f(1e-3f)));
    v8f turns = p->turn * (1.0f / 6.28318531f);
    return (struct round8){
        .x = f->centre_x + simd8_dot3_f(f->across, p->at) / ahead,
        .y = f->centre_y + simd8_dot3_f(f->down, p->at) / ahead,
        .radius = p->size / (ahead * f->pixel_m),
        .depth = 1.0f / simd8_select(near > 0.5f, near, ahead),
        .cosine = sine(turns + 0.25f),
        .sine = sine(turns),
    };
}

/* Returns log2 of the side of the largest picture whose texels are no smaller than the particle's
 * pixels. */
static uint32_t level_of(float side)
{
    uint32_t level = 1;
    while (level < PARTICLE_LEVELS && side > (float)(1u << level))
        level++;
    return level;
}

static uint32_t picture_of(const struct draw_list_particle *from)
{
    uint32_t picture = (uint32_t)(from->picture + 0.5f);
    return picture < PARTICLE_PICTURE_COUNT ? picture : PARTICLE_SMOKE_A;
}

static bool find_rows(const struct soft_frame *f, struct band_rows *rows, float high, float low)
{
    rows->first = (int16_t)triangle_raster_ceil(high, (float)f->height);
    rows->end = (int16_t)triangle_raster_ceil(low, (float)f->height);
    return rows->first < rows->end;
}

/* A particle that is a parallelogram in the picture: its middle, and the vectors to its right and
 * its upper edge [pixel]. */
struct outline {
    float x, y;
    float right_x, right_y, up_x, up_y;
};

static bool set_flat(const struct soft_particles *particles, const struct soft_frame *f,
                     struct soft_particle *particle, struct band_rows *rows, uint32_t picture,
                     const struct outline *o)
{
    float x = o->x, y = o->y, turn = o->right_x * o->up_y - o->right_y * o->up_x;
    float reach = particles->reach[picture];
    float wide = reach * sqrtf(o->right_x * o->right_x + o->up_x * o->up_x);
    float high = reach * sqrtf(o->right_y * o->right_y + o->up_y * o->up_y);
    /* Comparisons with NaN are false. */
    if (!(x > -wide && x < (float)f->width + wide && wide < TRIANGLE_RASTER_FAR &&
          turn * turn > 0.0f) ||
        !find_rows(f, rows, y - high, y + high))
        return false;
    float right = o->right_x * o->right_x + o->right_y * o->right_y;
    float up = o->up_x * o->up_x + o->up_y * o->up_y;
    float side = 2.0f * sqrtf(right > up ? right : up);
    particle->coarse = side > COARSE_PIXELS && particle->cover > COARSE_COVER;
    uint32_t level = level_of(particle->coarse ? 0.5f * side : side);
    float half = 0.5f * (float)(1u << level), scale = half / turn;
    particle->texels = particles->first[picture][level];
    particle->level = level;
    particle->reach = half * reach;
    particle->across[1] = scale * o->up_y;
    particle->across[2] = -scale * o->up_x;
    particle->across[0] =
        half + particle->across[1] * (0.5f - x) + particle->across[2] * (0.5f - y);
    particle->down[1] = scale * o->right_y;
    particle->down[2] = -scale * o->right_x;
    particle->down[0] = half + particle->down[1] * (0.5f - x) + particle->down[2] * (0.5f - y);
    particle->streak = false;
    particle->clipped = reach > 1.0f;
    return true;
}

static bool set_round(const struct soft_particles *particles, const struct soft_frame *f,
                      struct soft_particle *particle, struct band_rows *rows,
                      const struct draw_list_particle *from, const struct round8 *r, uint32_t i)
{
    float radius = r->radius[i] > LEAST_RADIUS ? r->radius[i] : LEAST_RADIUS;
    float share = r->radius[i] / radius, c = radius * r->cosine[i], s = radius * r->sine[i];
    struct outline o = {r->x[i], r->y[i], c, -s, -s, -c};
    particle->depth[0] = r->depth[i];
    particle->opacity *= share * share;
    return set_flat(particles, f, particle, rows, picture_of(from), &o);
}

/* --- streaks: strips in space ------------------------------------------------------------------
 */

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Computes the dot product of the pixels' rays with a vector, as a linear function over the
 * picture. */
static void over_picture(const struct soft_frame *f, const float direction[3], float by,
                         float out[3])
{
    out[1] = by * dot(f->ray_x, direction);
    out[2] = by * dot(f->ray_y, direction);
    out[0] = by * dot(f->ray, direction) + 0.5f * (out[1] + out[2]);
}

/* Sets the texture coordinates of a streak. Divided by the distance, they are linear over the
 * picture. */
static bool set_strip(const struct soft_frame *f, struct soft_particle *particle,
                      const struct draw_list_particle *from, const float side[3], float nearer)
{
    float normal[3], direction[3], texels = (float)(1u << particle->level), depth[3];
    cross(side, from->axis, normal);
    float away = dot(from->at, normal);
    if (!(away * away > 1e-12f * dot(normal, normal) * dot(from->at, from->at)))
        return false;
    over_picture(f, normal, 1.0f / away, depth);
    for (uint32_t i = 0; i < 3; i++)
        particle->depth[i] = depth[i] * nearer;
    /* The coordinates go from -1 to 1 over the strip and are divided by the distance. */
    cross(from->axis, normal, direction);
    float scale = 1.0f / dot(side, direction), at = dot(from->at, direction) * scale;
    over_picture(f, direction, scale, particle->across);
    for (uint32_t i = 0; i < 3; i++)
        particle->across[i] =
            0.5f * texels * nearer * (particle->across[i] - at * depth[i] + depth[i]);
    cross(side, normal, direction);
    scale = 1.0f / dot(from->axis, direction);
    at = dot(from->at, direction) * scale;
    over_picture(f, direction, scale, particle->down);
    for (uint32_t i = 0; i < 3; i++)
        particle->down[i] = 0.5f * texels * nearer * (depth[i] - particle->down[i] + at * depth[i]);
    return true;
}

/* Sets up a strip at a constant distance from the eye. */
static bool set_flat_strip(const struct soft_particles *particles, const struct soft_frame *f,
                           struct soft_particle *particle, struct band_rows *rows,
                           const struct draw_list_particle *from, const float side[3], float ahead)
{
    float over = 1.0f / ahead, x = over * dot(f->across, from->at);
    float y = over * dot(f->down, from->at), far = sqrtf(dot(from->at, from->at));
    float to_side = dot(f->ahead, side), to_axis = dot(f->ahead, from->axis);
    struct outline o = {.x = f->centre_x + x,
                        .y = f->centre_y + y,
                        .right_x = over * (dot(f->across, side) - x * to_side),
                        .right_y = over * (dot(f->down, side) - y * to_side),
                        .up_x = over * (dot(f->across, from->axis) - x * to_axis),
                        .up_y = over * (dot(f->down, from->axis) - y * to_axis)};
    float thin = sqrtf(o.right_x * o.right_x + o.right_y * o.right_y);
    if (thin < LEAST_RADIUS) {
        float wider = LEAST_RADIUS / (thin + 1e-6f);
        o.right_x *= wider;
        o.right_y *= wider;
        particle->opacity /= wider;
    }
    float towards = from->size < 0.5f * far ? from->size / far : 0.5f;
    particle->depth[0] = over / (1.0f - towards);
    return set_flat(particles, f, particle, rows, picture_of(from), &o);
}

static bool set_streak(const struct soft_particles *particles, const struct soft_frame *f,
                       struct soft_particle *particle, struct band_rows *rows,
                       const struct draw_list_particle *from)
{
    float side[3], end[2] = {-1.0f, 1.0f};
    cross(from->axis, from->at, side);
    float long_side = sqrtf(dot(side, side)), far = sqrtf(dot(from->at, from->at));
    float ahead = dot(f->ahead, from->at), grows = dot(f->ahead, from->axis);
    if (!(long_side > 1e-6f * far))
        return false; /* it points at the eye */
    for (uint32_t i = 0; i < 3; i++)
        side[i] *= from->size / long_side;
    float deep = dot(f->ahead, side);
    deep = (deep < 0.0f ? -deep : deep) + (grows < 0.0f ? -grows : grows);
    if (deep < STRIP_DEEP * ahead && ahead > f->near_m)
        return set_flat_strip(particles, f, particle, rows, from, side, ahead);
    /* The strip is cut at the near plane. */
    for (uint32_t i = 0; i < 2; i++)
        if (ahead + end[i] * grows < f->near_m) {
            if (ahead + end[1 - i] * grows < f->near_m)
                return false;
            end[i] = (f->near_m - ahead) / grows;
        }
    float left = TRIANGLE_RASTER_FAR, right = -TRIANGLE_RASTER_FAR, high = TRIANGLE_RASTER_FAR,
          low = -TRIANGLE_RASTER_FAR, wide = 0.0f;
    for (uint32_t i = 0; i < 2; i++) {
        float over = 1.0f / (ahead + end[i] * grows);
        float x =
            f->centre_x + over * (dot(f->across, from->at) + end[i] * dot(f->across, from->axis));
        float y = f->centre_y + over * (dot(f->down, from->at) + end[i] * dot(f->down, from->axis));
        float half = 1.5f + from->size * over / f->pixel_m;
        left = x - half < left ? x - half : left;
        right = x + half > right ? x + half : right;
        high = y - half < high ? y - half : high;
        low = y + half > low ? y + half : low;
        wide = half > wide ? half : wide;
    }
    if (!(right > 0.0f && left < (float)f->width && right - left < TRIANGLE_RASTER_FAR) ||
        !find_rows(f, rows, high, low))
        return false;
    uint32_t picture = picture_of(from);
    particle->x = 0.5f * (left + right);
    particle->reach = 0.5f * (right - left);
    particle->level = level_of(2.0f * wide);
    particle->texels = particles->first[picture][particle->level];
    particle->streak = particle->clipped = true;
    particle->coarse = false;
    float towards = from->size < 0.5f * far ? from->size / far : 0.5f;
    return set_strip(f, particle, from, side, 1.0f / (1.0f - towards));
}

/* --- all -------------------------------------------------------------------------------------- */

static void set_colour(struct soft_particle *particle, const struct particles8 *p,
                       const struct atmosphere8 *air, uint32_t i)
{
    const v8f *ahead[3] = {&air->colour.r, &air->colour.g, &air->colour.b};
    float glow = p->glow[i], clear = 1.0f - air->opacity[i];
    for (uint32_t c = 0; c < 3; c++) {
        particle->colour[c] = 255.0f * clear * p->colour[c][i];
        particle->air[c] = 255.0f * air->opacity[i] * (1.0f - glow) * (*ahead[c])[i];
    }
    particle->dark = 0.35f + (0.63f - 0.35f) * glow;
    particle->bright = (1.3f + (0.84f - 1.3f) * glow) / 255.0f;
    particle->hot = 255.0f * 0.06f * glow * clear / (255.0f * 255.0f);
    particle->cover = 1.0f - glow;
    particle->opacity = p->alpha[i] / 255.0f;
}

void KERNEL(soft_particles_set_up)(struct soft_particles *particles, const struct soft_frame *frame)
{
    const struct draw_list *list = frame->list;
    particles->count = 0;
    for (uint32_t first = 0; first < list->particle_count; first += LANES) {
        uint32_t count =
            list->particle_count - first < LANES ? list->particle_count - first : LANES;
        const struct draw_list_particle *from = &list->particles[first];
        struct particles8 p = load_particles(from, count);
        v8f ahead = simd8_dot3_f(frame->ahead, p.at);
        struct round8 round = place_round(frame, &p, ahead);
        struct atmosphere8 air = atmosphere_at(frame, p.at);
        for (uint32_t i = 0; i < count; i++) {
            struct soft_particle *particle = &particles->particles[particles->count];
            struct band_rows *rows = &particles->rows[particles->count];
            bool seen;
            set_colour(particle, &p, &air, i);
            if (dot(from[i].axis, from[i].axis) > 0.0f)
                seen = set_streak(particles, frame, particle, rows, &from[i]);
            else
                seen = ahead[i] > frame->near_m &&
                       set_round(particles, frame, particle, rows, &from[i], &round, i);
            particles->count += seen;
        }
    }
}

/* --- bands ------------------------------------------------------------------------------------ */

/* Eight pixels of a particle: what it adds to the background, 0 .. 255 plus a half for rounding,
 * and the share of the background that it keeps. */
struct smoke8 {
    struct colour8 adds;
    v8f keep;
    v8i seen; /* pixels that have a texel */
};

SIMD8 struct smoke8 smoke_at(const struct soft_particle *p, const uint16_t *texels, v8f column,
                             v8f row, bool clipped)
{
    struct smoke8 smoke = {.seen = simd8_i(-1)};
    int32_t last = (1 << p->level) - 1;
    v8i s = simd8_to_i(column), t = simd8_to_i(row);
    v8i at = ((t & last) << (int32_t)p->level) + (s & last);
    v8i texel = (v8i)(simd8_gather_bytes(texels, at * 2) & 0xffffu);
    if (clipped)
        smoke.seen = (s >= 0) & (t >= 0) & (s <= last) & (t <= last);
    v8f full = simd8_to_f(texel & 255), opacity = full * p->opacity;
    v8f lit = opacity * (p->dark + p->bright * simd8_to_f(texel >> 8));
    v8f hot = p->hot * full * full * opacity + 0.5f;
    smoke.adds.r = lit * p->colour[0] + opacity * p->air[0] + hot;
    smoke.adds.g = lit * p->colour[1] + opacity * p->air[1] + hot;
    smoke.adds.b = lit * p->colour[2] + opacity * p->air[2] + hot;
    smoke.keep = 1.0f - opacity * p->cover;
    return smoke;
}

/* Blends over the background. */
SIMD8 void blend(const struct smoke8 *smoke, v8i seen, uint32_t *colour)
{
    v8u behind = simd8_load_u(colour);
    v8f most = simd8_f(255.0f);
    v8i r = simd8_to_i(simd8_min(simd8_byte(behind, 0) * smoke->keep + smoke->adds.r, most));
    v8i g = simd8_to_i(simd8_min(simd8_byte(behind, 8) * smoke->keep + smoke->adds.g, most));
    v8i b = simd8_to_i(simd8_min(simd8_byte(behind, 16) * smoke->keep + smoke->adds.b, most));
    v8u sum = (v8u)(r | g << 8 | b << 16) | (behind & 0xff000000u);
    simd8_store_u(colour, simd8_select_u(seen & smoke->seen, sum, behind));
}

/* Finds the columns first .. end - 1 of a row whose middle is y that the particle's circle covers.
 * Returns false if there are none. The circle is an ellipse in the picture. */
SIMD8 bool find_columns(const struct soft_particle *p, const struct soft_target *t, float y,
                        int32_t *first, int32_t *end)
{
    float half = 0.5f * (float)(1u << p->level), columns = (float)t->width;
    float off_x = p->across[0] + y * p->across[2] - half;
    float off_y = p->down[0] + y * p->down[2] - half;
    float a = p->across[1] * p->across[1] + p->down[1] * p->down[1];
    float b = off_x * p->across[1] + off_y * p->down[1];
    float square = b * b - a * (off_x * off_x + off_y * off_y - p->reach * p->reach);
    if (!(square > 0.0f))
        return false;
    float root = sqrtf(square) / a, middle = 0.5f - b / a;
    *first = triangle_raster_ceil(middle - root, columns);
    *end = triangle_raster_ceil(middle + root, columns);
    return *first < *end;
}

SIMD8 v8i seen_pixels(const struct soft_particle *p, const float *depth, int32_t x, int32_t first,
                      int32_t end)
{
    return simd8_within(x, first, end) & (p->depth[0] > simd8_load_f(depth));
}

SIMD8 void fill_flat(const struct soft_particle *p, const uint16_t *texels,
                     const struct soft_target *t, int32_t y, bool clipped)
{
    int32_t first, end;
    size_t row = (size_t)(y - t->first) * t->stride;
    float across = p->across[0] + (float)y * p->across[2];
    float down = p->down[0] + (float)y * p->down[2];
    if (!find_columns(p, t, (float)y, &first, &end))
        return;
    for (int32_t x = first & -LANES; x < end; x += LANES) {
        v8i seen = seen_pixels(p, t->depth + row + (size_t)x, x, first, end);
        if (simd8_bits(seen) == 0)
            continue;
        v8f at = simd8_to_f(simd8_count() + x);
        struct smoke8 smoke =
            smoke_at(p, texels, across + at * p->across[1], down + at * p->down[1], clipped);
        blend(&smoke, seen, t->colour + row + (size_t)x);
    }
}

SIMD8 v8f twice_low(v8f v)
{
    return __builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3);
}

SIMD8 v8f twice_high(v8f v)
{
    return __builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7);
}

/* Fills rows y and y + 1, if they are in rows, sixteen columns at a time. */
SIMD8 void fill_coarse(const struct soft_particle *p, const uint16_t *texels,
                       const struct soft_target *t, int32_t y, const struct band_rows *rows)
{
    int32_t first, end;
    float middle = (float)y + 0.5f, across = p->across[0] + middle * p->across[2];
    float down = p->down[0] + middle * p->down[2];
    if (!find_columns(p, t, middle, &first, &end))
        return;
    for (int32_t x = first & (-2 * LANES); x < end; x += 2 * LANES) {
        v8f at = simd8_to_f(simd8_count() * 2 + x) + 0.5f;
        struct smoke8 s =
            smoke_at(p, texels, across + at * p->across[1], down + at * p->down[1], true);
        const struct smoke8 halves[2] = {
            {{twice_low(s.adds.r), twice_low(s.adds.g), twice_low(s.adds.b)},
             twice_low(s.keep),
             (v8i)twice_low((v8f)s.seen)},
            {{twice_high(s.adds.r), twice_high(s.adds.g), twice_high(s.adds.b)},
             twice_high(s.keep),
             (v8i)twice_high((v8f)s.seen)}};
        for (int32_t i = 0; i < 4; i++) {
            int32_t line = y + (i >> 1), column = x + (i & 1) * LANES;
            if (line < rows->first || line >= rows->end || line < t->first || line >= t->end)
                continue;
            size_t place = (size_t)(line - t->first) * t->stride + (size_t)column;
            v8i seen = seen_pixels(p, t->depth + place, column, first, end);
            if (simd8_bits(seen) != 0)
                blend(&halves[i & 1], seen, t->colour + place);
        }
    }
}

SIMD8 void fill_streak(const struct soft_particle *p, const uint16_t *texels,
                       const struct soft_target *t, int32_t y, int32_t first, int32_t end)
{
    size_t row = (size_t)(y - t->first) * t->stride;
    float down = (float)y;
    for (int32_t x = first & -LANES; x < end; x += LANES) {
        v8f at = simd8_to_f(simd8_count() + x),
            depth = p->depth[0] + down * p->depth[2] + at * p->depth[1];
        v8i seen = simd8_within(x, first, end) & (depth > 0.0f) &
                   (depth > simd8_load_f(t->depth + row + (size_t)x));
        v8f over = 1.0f / simd8_select(seen, depth, simd8_f(1.0f));
        v8f s = (p->across[0] + down * p->across[2] + at * p->across[1]) * over;
        v8f r = (p->down[0] + down * p->down[2] + at * p->down[1]) * over;
        /* Coordinates far outside would not fit a texel's number. */
        float side = (float)(1u << p->level);
        seen &= (s > -1.0f) & (r > -1.0f) & (s < side) & (r < side);
        if (simd8_bits(seen) == 0)
            continue;
        struct smoke8 smoke = smoke_at(p, texels, simd8_select(seen, s, simd8_f(0.0f)),
                                       simd8_select(seen, r, simd8_f(0.0f)), true);
        blend(&smoke, seen, t->colour + row + (size_t)x);
    }
}

static void fill_particle(const struct soft_particles *particles, const struct soft_target *t,
                          uint32_t index)
{
    const struct soft_particle *p = &particles->particles[index];
    const struct band_rows *rows = &particles->rows[index];
    const uint16_t *texels = particles->texels + p->texels;
    int32_t y = rows->first > t->first ? rows->first : t->first;
    int32_t last = rows->end < t->end ? rows->end : t->end;
    float columns = (float)t->width;
    if (p->streak) {
        int32_t first = triangle_raster_ceil(p->x - p->reach, columns);
        int32_t end = triangle_raster_ceil(p->x + p->reach, columns);
        for (; y < last; y++)
            fill_streak(p, texels, t, y, first, end);
    } else if (p->coarse) {
        /* Both rows of a pair are in one band. */
        for (y &= -2; y < last; y += 2)
            fill_coarse(p, texels, t, y, rows);
    } else if (p->clipped) {
        for (; y < last; y++)
            fill_flat(p, texels, t, y, true);
    } else {
        for (; y < last; y++)
            fill_flat(p, texels, t, y, false);
    }
}

void KERNEL(soft_particles_fill)(const struct soft_particles *particles,
                                 const struct soft_frame *frame, const struct soft_target *target)
{
    (void)frame;
    const struct band_lists *lists = &particles->lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++)
        fill_particle(particles, target, lists->item[i]);
}
