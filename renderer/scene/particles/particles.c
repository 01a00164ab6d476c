/* Adds particles to the draw list and computes how many are shown. */
#include "renderer/scene/particles/particles.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define FADES_PIXELS 0.8f /* a particle whose half side is smaller than this fades out */
#define MIN_ALPHA    0.01f
#define EYE_INSIDE   0.6f /* nearer than this many of its sizes a particle is invisible ... */
#define EYE_OUTSIDE  1.5f /* ... and farther than this many it is fully visible */
#define FLAT_MIN     0.3f /* lowest height over width of a flat particle */
#define LIFT         0.7  /* height above the ground, over its size */
#define APART_SIZES  0.7  /* distance between two particles of a sequence */
#define APART_PIXELS 8.0
#define WHOLE_PIXELS 70.0 /* from this size on a burst has all its particles */
#define MIN_SHARE    0.3

struct shade dust_shade(enum cover cover)
{
    switch (cover) {
    case COVER_SAND:
        return (struct shade){0.84f, 0.76f, 0.60f, 1.0f};
    case COVER_ROAD:
        return (struct shade){0.78f, 0.69f, 0.52f, 1.0f};
    case COVER_CHAPARRAL:
        return (struct shade){0.70f, 0.60f, 0.44f, 0.60f};
    case COVER_GRASS:
        return (struct shade){0.74f, 0.65f, 0.46f, 0.45f};
    case COVER_ROCK:
        return (struct shade){0.70f, 0.67f, 0.62f, 0.30f};
    default: /* forest is damp */
        return (struct shade){0.60f, 0.52f, 0.38f, 0.0f};
    }
}

/* Sets the axis of a stretched particle: across the view, and at least `least` long. */
static void stretch(const struct frustum *frustum, struct draw_list_particle *drawn,
                    struct vec3 along, float least)
{
    float axis[3], squared = fmaxf(frustum_dot(drawn->at, drawn->at), 1e-6f);
    vec3_to_floats(axis, along);
    float towards = frustum_dot(axis, drawn->at) / squared;
    for (uint32_t i = 0; i < 3; i++)
        axis[i] -= towards * drawn->at[i];
    float length = sqrtf(frustum_dot(axis, axis));
    bool blunt = length < 1e-3f * drawn->size;
    float longer = blunt ? least : fmaxf(1.0f, least / length);
    for (uint32_t i = 0; i < 3; i++)
        drawn->axis[i] = longer * (blunt ? frustum->up[i] : axis[i]);
}

void particles_lay(const struct draw_list *list, struct particle *particle, double ground_m)
{
    particle->flat = true;
    particle->along.y = 0.0;
    particle->at.y = ground_m;
    struct vec3 along = particle->along, sight_line = vec3_sub(particle->at, list->camera.eye);
    /* The width of the picture lies across the particle and the line of sight; that of the particle
     * lies on the ground. */
    struct vec3 across = vec3_cross(along, sight_line), own = {-along.z, 0.0, along.x};
    double length = vec3_length(across) * vec3_length(own);
    double seen = length > 0.0 ? fabs(vec3_dot(across, own)) / length : 1.0;
    particle->size_m *= maths_max((double)FLAT_MIN, seen);
    particle->at.y += LIFT * particle->size_m; /* otherwise the ground would cut its lower edge */
}

void particles_add(struct draw_list *list, const struct particle *particle)
{
    struct draw_list_particle drawn = {.size = (float)particle->size_m};
    draw_list_relative(list, particle->at, drawn.at);
    float distance = sqrtf(frustum_dot(drawn.at, drawn.at));
    float pixels = frustum_pixels(&list->frustum, drawn.size, distance);
    float reach = (float)maths_max(particle->size_m, vec3_length(particle->along));
    if (pixels <= PARTICLES_MIN_PIXELS || !frustum_ball(&list->frustum, drawn.at, 1.5f * reach))
        return;
    float near = (distance / drawn.size - EYE_INSIDE) / (EYE_OUTSIDE - EYE_INSIDE);
    float far = (pixels - PARTICLES_MIN_PIXELS) / (FADES_PIXELS - PARTICLES_MIN_PIXELS);
    float alpha = particle->shade.a * fminf(1.0f, near) * fminf(1.0f, far);
    if (alpha < MIN_ALPHA)
        return;
    if (list->particle_count == DRAW_LIST_PARTICLES_MAX) {
        list->omitted++;
        return;
    }
    if (vec3_dot(particle->along, particle->along) > 0.0)
        stretch(&list->frustum, &drawn, particle->along,
                (particle->flat ? FLAT_MIN : 1.0f) * drawn.size);
    drawn.turn_rad = particle->turn_rad;
    drawn.picture = (float)particle->picture;
    drawn.glow = particle->glow;
    drawn.colour[0] = particle->shade.r;
    drawn.colour[1] = particle->shade.g;
    drawn.colour[2] = particle->shade.b;
    drawn.colour[3] = alpha;
    list->particles[list->particle_count++] = drawn;
}

/* --- rows and bursts -------------------------------------------------------------------------- */

struct particle_sequence particle_sequence_of(uint32_t seed, double rate_hz, double from_s,
                                              double to_s, double share)
{
    struct particle_sequence sequence = {
        .rate_hz = rate_hz, .phase = (double)particle_random(seed, 0, 0), .step = 1};
    /* A number that 2^k divides, but not 2^(k + 1), is shown from a share of 2^-(k + 1) on. */
    while (sequence.step < 1024 && 2.0 * (double)sequence.step * share <= 1.0)
        sequence.step *= 2;
    double first = ceil((from_s * rate_hz + sequence.phase) / (double)sequence.step);
    double last = floor((to_s * rate_hz + sequence.phase) / (double)sequence.step);
    sequence.first = (int64_t)maths_max(first, 0.0) * sequence.step;
    sequence.last = (int64_t)last * sequence.step;
    return sequence;
}

double particle_sequence_reach(int64_t number)
{
    int64_t whole = number & -number;
    return whole == 0 || whole > 8 ? 8.0 : (double)whole;
}

float particle_sequence_weight(int64_t number, double share)
{
    double whole = number == 0 ? 1024.0 : (double)(number & -number);
    return (float)maths_clamp(2.0 * whole * share - 1.0, 0.0, 1.0);
}

double particles_spacing_m(const struct draw_list *list, double size_m, double distance_m)
{
    double pixel_m = maths_max(distance_m, list->camera.near_m) / list->camera.focal_pixels;
    return maths_max(APART_SIZES * size_m, APART_PIXELS * pixel_m) / (double)list->detail;
}

double particles_share(const struct draw_list *list, double size_m, struct vec3 at)
{
    double pixels = camera_pixels(&list->camera, size_m, particles_distance_m(list, at));
    return maths_clamp(pixels / WHOLE_PIXELS, MIN_SHARE, 1.0) * (double)list->detail;
}
