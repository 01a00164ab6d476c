/* Adding particles to the list, and how many of them are shown. */
#include "renderer/scene/particles/particles.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define FADES_PIXELS 0.8f /* a particle whose half side is smaller than this fades out */
#define MIN_ALPHA    0.01f
#define EYE_INSIDE   0.6f /* nearer than so many of its sizes it is gone ... */
#define EYE_OUTSIDE  1.5f /* ... and farther than so many it is whole */
#define FLAT_MIN     0.3f /* what lies is at least so high, over its width */
#define LIFT         0.7  /* of its size, over the ground that it lies on */
#define APART_SIZES  0.7  /* between two puffs of a row */
#define APART_PIXELS 8.0
#define WHOLE_PIXELS 70.0 /* from this size on a burst has all of its puffs */
#define MIN_SHARE    0.3

struct shade dust_of(enum cover cover)
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
    default: /* forest is damp, water wet */
        return (struct shade){0.60f, 0.52f, 0.38f, 0.0f};
    }
}

/* A stretched puff's axis as it is seen: across the view, and never shorter than least. */
static void stretch(const struct frustum *frustum, struct draw_list_particle *particle,
                    struct vec3 along, float least)
{
    float axis[3], squared = fmaxf(frustum_dot(particle->at, particle->at), 1e-6f);
    vec3_to_floats(axis, along);
    float towards = frustum_dot(axis, particle->at) / squared;
    for (uint32_t i = 0; i < 3; i++)
        axis[i] -= towards * particle->at[i];
    float length = sqrtf(frustum_dot(axis, axis));
    bool blunt = length < 1e-3f * particle->size;
    float longer = blunt ? least : fmaxf(1.0f, least / length);
    for (uint32_t i = 0; i < 3; i++)
        particle->axis[i] = longer * (blunt ? frustum->up[i] : axis[i]);
}

void particles_lay(const struct draw_list *list, struct spot *spot, double ground_m)
{
    spot->flat = true;
    spot->along.y = 0.0;
    spot->at.y = ground_m;
    struct vec3 along = spot->along, sight_line = vec3_sub(spot->at, list->camera.eye);
    /* The picture's width lies across both the puff and the view; the puff's own across the puff
     * and on the ground. */
    struct vec3 across = vec3_cross(along, sight_line), own = {-along.z, 0.0, along.x};
    double length = vec3_length(across) * vec3_length(own);
    double seen = length > 0.0 ? fabs(vec3_dot(across, own)) / length : 1.0;
    spot->size_m *= maths_max((double)FLAT_MIN, seen);
    spot->at.y += LIFT * spot->size_m; /* or the ground would cut its lower edge */
}

void particles_add(struct draw_list *list, const struct spot *spot)
{
    struct draw_list_particle particle = {.size = (float)spot->size_m};
    draw_list_relative(list, spot->at, particle.at);
    float distance = sqrtf(frustum_dot(particle.at, particle.at));
    float pixels = frustum_pixels(&list->frustum, particle.size, distance);
    float reach = (float)maths_max(spot->size_m, vec3_length(spot->along));
    if (pixels <= PARTICLES_MIN_PIXELS || !frustum_ball(&list->frustum, particle.at, 1.5f * reach))
        return;
    float near = (distance / particle.size - EYE_INSIDE) / (EYE_OUTSIDE - EYE_INSIDE);
    float far = (pixels - PARTICLES_MIN_PIXELS) / (FADES_PIXELS - PARTICLES_MIN_PIXELS);
    float alpha = spot->shade.a * fminf(1.0f, near) * fminf(1.0f, far);
    if (alpha < MIN_ALPHA)
        return;
    if (list->particle_count == DRAW_LIST_PARTICLES_MAX) {
        list->omitted++;
        return;
    }
    if (vec3_dot(spot->along, spot->along) > 0.0)
        stretch(&list->frustum, &particle, spot->along,
                (spot->flat ? FLAT_MIN : 1.0f) * particle.size);
    particle.turn_rad = spot->turn_rad;
    particle.picture = (float)spot->picture;
    particle.glow = spot->glow;
    particle.colour[0] = spot->shade.r;
    particle.colour[1] = spot->shade.g;
    particle.colour[2] = spot->shade.b;
    particle.colour[3] = alpha;
    list->particles[list->particle_count++] = particle;
}

/* --- rows and bursts -------------------------------------------------------------------------- */

struct row row_of(uint32_t seed, double rate_hz, double from_s, double to_s, double share)
{
    struct row row = {.rate_hz = rate_hz, .phase = (double)luck(seed, 0, 0), .step = 1};
    /* A number divisible by 2^k, but not by the next power, shows from a share of 2^-(k + 1) on. */
    while (row.step < 1024 && 2.0 * (double)row.step * share <= 1.0)
        row.step *= 2;
    double first = ceil((from_s * rate_hz + row.phase) / (double)row.step);
    double last = floor((to_s * rate_hz + row.phase) / (double)row.step);
    row.first = (int64_t)maths_max(first, 0.0) * row.step;
    row.last = (int64_t)last * row.step;
    return row;
}

double row_reach(int64_t number)
{
    int64_t whole = number & -number;
    return whole == 0 || whole > 8 ? 8.0 : (double)whole;
}

float row_weight(int64_t number, double share)
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
