/* What all emitters of particles share. Private to particle_emitters.c, smoke.c, trails.c, bursts.c
 * and rotors.c.
 *
 * Particles appear and vanish only by their opacity. The particles of a sequence are numbered. As
 * they spread, or are seen from farther away, the odd numbers fade out, then every second of the
 * rest, and so on, while the others grow until they overlap again. So a column of smoke has thirty
 * particles near the camera and eight at the horizon. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_PARTICLES_H
#define JOLON_RENDERER_SCENE_PARTICLES_PARTICLES_H

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/draw_list/draw_list.h"

#define PARTICLES_MIN_PIXELS 0.25f /* particles with a smaller half side are left out */

#define WIND_X 1.7 /* [m/s] */
#define WIND_Z -1.1

struct shade {
    float r, g, b, a;
};

struct particle {
    struct vec3 at;
    struct vec3 along; /* [m] stretch to both sides; 0: round */
    double size_m;
    struct shade shade;
    enum particle_picture picture;
    float turn_rad, glow;
    bool flat; /* lies on the ground, so that it looks flat from the side */
};

/* Lays a stretched particle on the ground at this height. Its visible width depends on the
 * direction of view. */
void particles_lay(const struct draw_list *list, struct particle *particle, double ground_m);

/* Adds the particle if it is visible. It fades out before the eye is inside it. */
void particles_add(struct draw_list *list, const struct particle *particle);

/* Particles emitted one after another along a line. */
struct particle_sequence {
    double rate_hz; /* numbers a second, at full density */
    double phase;   /* fraction of a number at time 0 */
    int64_t first, last, step;
};

/* Returns the particles emitted between two times, thinned out to about this share: the numbers
 * first .. last in steps. */
struct particle_sequence particle_sequence_of(uint32_t seed, double rate_hz, double from_s,
                                              double to_s, double share);

static inline double particle_sequence_time_s(const struct particle_sequence *sequence,
                                              int64_t number)
{
    return ((double)number - sequence->phase) / sequence->rate_hz;
}

/* Returns the opacity 0..1 of the particle with this number if this share is shown. */
float particle_sequence_weight(int64_t number, double share);

static inline double particles_distance_m(const struct draw_list *list, struct vec3 at)
{
    return vec3_length(vec3_sub(at, list->camera.eye));
}

/* Returns how many numbers the particle may be shifted without meeting the next one that is shown
 * whenever it is, 1..8. */
double particle_sequence_reach(int64_t number);

/* Returns the distance between particles of a size [m]: less where they are seen from near. */
double particles_spacing_m(const struct draw_list *list, double size_m, double distance_m);

/* Returns the share of a burst's particles to show for this size. The others must cover for those
 * left out. */
double particles_share(const struct draw_list *list, double size_m, struct vec3 at);

/* Returns the opacity 0..1 of the n-th of count particles if a share of them is shown. */
static inline float particles_part(uint32_t n, uint32_t count, double share)
{
    return (float)maths_clamp(share * (double)count - (double)n, 0.0, 1.0);
}

/* Returns the number of particles that are not fully transparent. */
static inline uint32_t particles_shown(uint32_t count, double share)
{
    uint32_t shown = (uint32_t)(share * (double)count) + 1u;
    return shown < count ? shown : count;
}

/* Returns a random number in [0, 1) for a purpose of the n-th particle. */
static inline float particle_random(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return value_noise_unit((int32_t)seed, (int32_t)n, 300u + purpose);
}

static inline float particle_random_angle(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return (float)TWO_PI * particle_random(seed, n, purpose);
}

static inline enum particle_picture smoke_picture(uint32_t seed, uint32_t n)
{
    return (enum particle_picture)(PARTICLE_SMOKE_A +
                                   value_noise_hash((int32_t)seed, (int32_t)n, 311) % 4);
}

/* Fades in over in_s from age 0, and out over out_s before life_s. */
static inline float fade_in_out(double age, double in_s, double life_s, double out_s)
{
    return (float)maths_clamp(maths_min(age / in_s, (life_s - age) / out_s), 0.0, 1.0);
}

static inline struct shade shade_mix(struct shade from, struct shade to, double t)
{
    float u = (float)maths_clamp(t, 0.0, 1.0);
    return (struct shade){from.r + (to.r - from.r) * u, from.g + (to.g - from.g) * u,
                          from.b + (to.b - from.b) * u, from.a + (to.a - from.a) * u};
}

/* Returns the colour of dust from a cover; alpha: the amount, 0..1. */
struct shade dust_shade(enum cover cover);

#endif
