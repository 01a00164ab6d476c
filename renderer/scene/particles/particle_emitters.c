/* Calls the emitters and sorts the particles. Everything depends on the frame and the effects only:
 * the same input gives the same picture. */
#include "renderer/scene/particles/particle_emitters.h"

#include "renderer/scene/particles/bursts.h"
#include "renderer/scene/particles/particles.h"
#include "renderer/scene/particles/smoke.h"
#include "renderer/scene/particles/trails.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define KEY_BITS      11u
#define BURST_REACH_M 12.0f /* reach of a burst, with the wind ... */
#define BURST_REACH   12.0f /* ... plus this for each metre of its size */

static void entity_particles(struct draw_list *list, const struct frame_view *frame_view,
                             const struct motion_trails *trails, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    if (e->row[slot].state == ENTITY_FREE || e->row[slot].kind >= frame_view->world->counts.kinds)
        return;
    const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
    const struct motion_trail *trail = motion_trails_of(trails, slot, e->row[slot].id);
    smoke_entity(list, frame_view, trail, slot, kind);
    if (e->row[slot].state == ENTITY_ACTIVE)
        trails_entity(list, frame_view, trail, slot, kind);
}

static void effect_particles(struct draw_list *list, const struct frame_view *frame_view,
                             const struct effect *effect)
{
    double age = list->time_s - effect->time_s;
    float at[3];
    draw_list_relative(list, effect->point, at);
    float pixels = frustum_pixels(&list->frustum, effect->size_m, sqrtf(frustum_dot(at, at)));
    if (age >= 0.0 && age < effects_life_s((enum effect_type)effect->type) &&
        pixels > PARTICLES_MIN_PIXELS &&
        frustum_ball(&list->frustum, at, BURST_REACH_M + BURST_REACH * effect->size_m))
        bursts_effect(list, frame_view, effect, age);
}

/* Sorts by distance, the farthest first; stable. It is a radix sort of the squared distances, whose
 * bits as a number are in the same order. */
static void sort_particles(struct draw_list *list)
{
    const uint32_t digits = 1u << KEY_BITS, count = list->particle_count;
    struct particle_key *from = list->particle_keys, *to = from + DRAW_LIST_PARTICLES_MAX;
    uint32_t start[1u << KEY_BITS];
    for (uint32_t i = 0; i < count; i++) {
        float squared = frustum_dot(list->particles[i].at, list->particles[i].at);
        memcpy(&from[i].key, &squared, sizeof squared);
        from[i].key = ~from[i].key;
        from[i].index = i;
    }
    for (uint32_t shift = 0; shift < 32; shift += KEY_BITS) {
        memset(start, 0, sizeof start);
        for (uint32_t i = 0; i < count; i++)
            start[from[i].key >> shift & (digits - 1)]++;
        for (uint32_t digit = 0, next = 0; digit < digits; digit++) {
            uint32_t here = start[digit];
            start[digit] = next;
            next += here;
        }
        for (uint32_t i = 0; i < count; i++)
            to[start[from[i].key >> shift & (digits - 1)]++] = from[i];
        struct particle_key *swap = from;
        from = to;
        to = swap;
    }
    for (uint32_t i = 0; i < count; i++)
        list->particles_sorted[i] = list->particles[from[i].index];
    struct draw_list_particle *sorted = list->particles_sorted;
    list->particles_sorted = list->particles;
    list->particles = sorted;
}

void particle_emitters_add(struct draw_list *list, const struct frame_view *frame_view,
                           const struct effects *effects)
{
    for (uint32_t slot = 0; slot < frame_view->head->used; slot++)
        entity_particles(list, frame_view, &effects->trails, slot);
    trails_ended(list, frame_view, &effects->trails);
    for (uint32_t i = 0; i < effects->count; i++)
        effect_particles(list, frame_view, &effects->effect[i]);
    sort_particles(list);
}
