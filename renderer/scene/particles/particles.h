/* How puffs are made: what all that smokes, burns and splashes shares. Private to the files
 * particle_emitters.c, smoke.c, trails.c, bursts.c and rotors.c.
 *
 * Nothing comes or goes but by its opacity: puffs of a row have numbers since time began, and as
 * they spread, or are seen from farther off, those with odd numbers fade out, then every second of
 * what is left, and so on, while the others grow until they overlap again. So a column of smoke is
 * thirty puffs before the camera and eight on the horizon. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_PARTICLES_H
#define JOLON_RENDERER_SCENE_PARTICLES_PARTICLES_H

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/draw_list/draw_list.h"

#define PARTICLES_MIN_PIXELS 0.25f /* a particle whose half side is smaller is left out */

#define WIND_X 1.7 /* [m/s] */
#define WIND_Z -1.1

struct shade {
    float r, g, b, a;
};

struct spot {
    struct vec3 at;
    struct vec3 along; /* [m] stretched so far to both sides, at least to a ball; 0: round */
    double size_m;
    struct shade shade;
    enum particle_picture picture;
    float turn_rad, glow;
    bool flat; /* it lies on the ground: seen along the ground it is no ball */
};

/* Lays a stretched puff on the ground, this high: how wide it shows goes by from where it is seen.
 */
void particles_lay(const struct draw_list *list, struct spot *spot, double ground_m);

/* Unless it cannot be seen. A puff that the eye comes near to fades out before the eye is in it. */
void particles_add(struct draw_list *list, const struct spot *spot);

/* Puffs given off one after the other, along a line that they drift away on. */
struct row {
    double rate_hz; /* at the densest */
    double phase;   /* of the numbers: 0..1 */
    int64_t first, last, step;
};

/* Its puffs alive between two times, of those that a share of the densest needs: numbers first ..
 * last by steps. */
struct row row_of(uint32_t seed, double rate_hz, double from_s, double to_s, double share);

static inline double row_time_s(const struct row *row, int64_t number)
{
    return ((double)number - row->phase) / row->rate_hz;
}

/* How opaque the puff with this number is where the row wants this share of its puffs, 0..1. */
float row_weight(int64_t number, double share);

static inline double particles_distance_m(const struct draw_list *list, struct vec3 at)
{
    return vec3_length(vec3_sub(at, list->camera.eye));
}

/* How many numbers the puff may stray from its own and still not meet the next that shows whenever
 * it does, 1..8. */
double row_reach(int64_t number);

/* How far apart puffs of a size should be [m]: as near as they need, as far as nobody sees it. */
double particles_spacing_m(const struct draw_list *list, double size_m, double distance_m);

/* Share of a burst's puffs to show for one of a size; so much more must each of them cover. */
double particles_share(const struct draw_list *list, double size_m, struct vec3 at);

/* Of count puffs the n-th when a share of them is shown: opaque 0..1. */
static inline float particles_part(uint32_t n, uint32_t count, double share)
{
    return (float)maths_clamp(share * (double)count - (double)n, 0.0, 1.0);
}

/* How many of them are opaque at all. */
static inline uint32_t particles_shown(uint32_t count, double share)
{
    uint32_t shown = (uint32_t)(share * (double)count) + 1u;
    return shown < count ? shown : count;
}

/* Uniform numbers of one thing's n-th puff. */
static inline float luck(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return value_noise_unit((int32_t)seed, (int32_t)n, 300u + purpose);
}

static inline float luck_turn(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return (float)TWO_PI * luck(seed, n, purpose);
}

static inline enum particle_picture smoke_picture(uint32_t seed, uint32_t n)
{
    return (enum particle_picture)(PARTICLE_SMOKE_A +
                                   value_noise_hash((int32_t)seed, (int32_t)n, 311) % 4);
}

/* From nothing to all over a time, and to nothing again at the end. */
static inline float come_and_go(double age, double in_s, double life_s, double out_s)
{
    return (float)maths_clamp(maths_min(age / in_s, (life_s - age) / out_s), 0.0, 1.0);
}

static inline struct shade shade_mix(struct shade from, struct shade to, double t)
{
    float u = (float)maths_clamp(t, 0.0, 1.0);
    return (struct shade){from.r + (to.r - from.r) * u, from.g + (to.g - from.g) * u,
                          from.b + (to.b - from.b) * u, from.a + (to.a - from.a) * u};
}

/* Dust that can be raised from ground of a cover: its colour, and how much of it, 0..1. */
struct shade dust_of(enum cover cover);

#endif
