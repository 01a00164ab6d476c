/* Flames and columns of smoke. */
#include "renderer/scene/particles/smoke.h"

#include "renderer/scene/particles/particles.h"
#include "world/world.h"

#include <math.h>

#define FIRE_LIFE_S      150.0 /* how long a wreck burns */
#define SMOKE_LIFE_S     420.0 /* how long a wreck smokes */
#define COLUMN_PARTICLES 64    /* of a column over its whole life, at full density */
#define COLUMN_RISE_S    26.0  /* life of a particle in the column */
#define OVERLAP          0.9   /* half length of a particle over the distance to the next */
#define FLAMES           9
#define THIN_SMOKE       0.25f /* opacity for a damaged vehicle */
#define THICK_SMOKE      0.50f /* ... and for a badly damaged one */

/* The path of the particles of a column. */
struct column {
    struct vec3 foot;
    double size_m, life_s, rise_m;
};

static struct vec3 column_at(const struct column *column, double t)
{
    double age = t * column->life_s, drift = age * (0.4 + t);
    /* They rise fast, and slow down as they cool and drift with the wind. */
    return (struct vec3){column->foot.x + WIND_X * drift,
                         column->foot.y + column->rise_m * (1.0 - (1.0 - t) * (1.0 - 0.45 * t)),
                         column->foot.z + WIND_Z * drift};
}

/* Returns the derivative of column_at() by t [m]. */
static struct vec3 column_motion(const struct column *column, double t)
{
    double drift = column->life_s * (0.4 + 2.0 * t);
    return (struct vec3){WIND_X * drift, column->rise_m * (1.45 - 0.9 * t), WIND_Z * drift};
}

static void column_particle(struct draw_list *list, const struct column *column, int64_t number,
                            double t, struct shade shade, uint32_t seed)
{
    uint32_t n = (uint32_t)number;
    /* Particles are shifted at random, because regular ones look like beads on a string. */
    double out_of_step = particle_sequence_reach(number) / COLUMN_PARTICLES *
                         ((double)particle_random(seed, n, 33) - 0.5);
    struct vec3 at = column_at(column, maths_max(0.0, t + 0.2 * out_of_step));
    struct vec3 motion = column_motion(column, t);
    double size = column->size_m * (0.85 + 3.4 * t), length = vec3_length(motion);
    double spacing = particles_spacing_m(list, size, particles_distance_m(list, at));
    float weight = particle_sequence_weight(number, length / (spacing * COLUMN_PARTICLES));
    if (weight <= 0.0f)
        return;
    double sway = (0.45 + 1.6 * t) * column->size_m;
    spacing = maths_max(spacing, length / COLUMN_PARTICLES);
    /* Each is tilted at random, because a row of equal balls looks artificial. */
    double stretch = maths_max(size, OVERLAP * spacing) / length;
    double tilt_x = size * ((double)particle_random(seed, n, 31) - 0.5);
    double tilt_z = size * ((double)particle_random(seed, n, 32) - 0.5);
    struct particle particle = {
        .at = {at.x + sway * ((double)particle_random(seed, n, 1) - 0.5), at.y,
               at.z + sway * ((double)particle_random(seed, n, 2) - 0.5)},
        .along = {motion.x * stretch + 1.6 * tilt_x, motion.y * stretch,
                  motion.z * stretch + 1.6 * tilt_z},
        .size_m = size * (0.85 + 0.3 * (double)particle_random(seed, n, 3)),
        .picture = smoke_picture(seed, n),
    };
    particle.shade =
        shade_mix(shade, (struct shade){0.42f, 0.40f, 0.38f, 0.0f}, t * (0.6 * t + 0.4));
    particle.shade.a *= weight * (float)maths_min(1.0, 8.0 * t);
    particles_add(list, &particle);
}

/* Draws a column of the smoke emitted between two times. Particles rise, spread, drift with the
 * wind and fade. Thin columns are low. */
static void smoke_column(struct draw_list *list, struct vec3 foot, double size_m, double from_s,
                         double to_s, struct shade shade, uint32_t seed)
{
    struct column column = {.foot = foot, .size_m = size_m};
    column.life_s = COLUMN_RISE_S * maths_clamp(0.25 + 0.4 * size_m, 0.35, 1.3);
    column.rise_m = (0.5 + 1.3 * size_m) * column.life_s;
    struct vec3 top = column_at(&column, 1.0);
    float middle[3], reach = (float)(0.5 * vec3_length(vec3_sub(top, foot)) + 6.0 * size_m);
    draw_list_relative(list, vec3_lerp(foot, top, 0.5), middle);
    if (!frustum_ball(&list->frustum, middle, reach))
        return;
    /* The foot is densest: particles are smallest and fastest there. */
    double spacing = particles_spacing_m(list, 0.85 * size_m, particles_distance_m(list, foot));
    double share = vec3_length(column_motion(&column, 0.0)) / (spacing * COLUMN_PARTICLES);
    struct particle_sequence sequence = particle_sequence_of(
        seed, COLUMN_PARTICLES / column.life_s, maths_max(from_s, list->time_s - column.life_s),
        maths_min(to_s, list->time_s), 1.4 * share);
    for (int64_t number = sequence.first; number <= sequence.last; number += sequence.step)
        column_particle(list, &column, number,
                        (list->time_s - particle_sequence_time_s(&sequence, number)) /
                            column.life_s,
                        shade, seed);
}

static void flames(struct draw_list *list, struct vec3 foot, double size_m, double strength,
                   uint32_t seed)
{
    double share = particles_share(list, size_m, foot);
    for (uint32_t i = 0; i < particles_shown(FLAMES, share); i++) {
        double phase = list->time_s * 1.3 + (double)particle_random(seed, i, 5),
               t = phase - floor(phase);
        uint32_t n = (uint32_t)floor(phase) * FLAMES + i;
        double tall = size_m * (0.95 - 0.3 * t) * strength;
        struct particle flame = {
            .at = {foot.x + size_m * 1.1 * ((double)particle_random(seed, n, 6) - 0.5) +
                       0.2 * WIND_X * t,
                   foot.y + size_m * (0.45 + 0.9 * t),
                   foot.z + size_m * 1.1 * ((double)particle_random(seed, n, 7) - 0.5) +
                       0.2 * WIND_Z * t},
            .along = {0.25 * WIND_X * t, tall, 0.25 * WIND_Z * t},
            .size_m = size_m * (0.68 - 0.36 * t) * strength,
            .picture = n & 1 ? PARTICLE_FLAME_A : PARTICLE_FLAME_B,
            .glow = 0.85f,
            .shade = {1.0f, 0.72f - 0.32f * (float)t, 0.28f - 0.2f * (float)t,
                      (float)(0.8 * strength) * particles_part(i, FLAMES, share) *
                          fade_in_out(t, 0.12, 1.0, 0.6)},
        };
        particles_add(list, &flame);
    }
    float flicker =
        0.85f + 0.15f * value_noise_value(list->time_s * 7.0, (double)(seed % 4096u), 8);
    struct particle glow = {.at = {foot.x, foot.y + 0.6 * size_m, foot.z},
                            .size_m = 2.2 * size_m,
                            .picture = PARTICLE_GLOW,
                            .glow = 1.0f,
                            .shade = {1.0f, 0.45f, 0.12f, 0.32f * (float)strength * flicker}};
    particles_add(list, &glow);
}

static void wreck(struct draw_list *list, const struct kind *kind, struct vec3 at, double since_s,
                  uint32_t seed)
{
    double size = maths_clamp(0.62 * kind->radius_m, 0.8, 12.0), age_s = list->time_s - since_s;
    double smoke = maths_clamp((SMOKE_LIFE_S - age_s) / 120.0, 0.0, 1.0);
    double fire = maths_clamp((FIRE_LIFE_S - age_s) / 60.0, 0.0, 1.0);
    struct vec3 foot = {at.x, at.y + 0.25 * kind->height_m, at.z};
    if (smoke > 0.0)
        smoke_column(list, foot, size, since_s, list->time_s,
                     (struct shade){0.07f, 0.065f, 0.06f, 0.85f * (float)smoke}, seed);
    foot.y += 0.2 * kind->height_m;
    if (fire > 0.0)
        flames(list, foot, size, (0.4 + 0.6 * fire) * maths_min(1.0, 0.3 + 0.5 * age_s), seed);
}

void smoke_entity(struct draw_list *list, const struct frame_view *frame_view,
                  const struct motion_trail *trail, uint32_t slot, const struct kind *kind)
{
    const struct entities *e = frame_view->entities;
    bool dead = e->row[slot].state == ENTITY_WRECK;
    if (kind->domain == DOMAIN_MUNITION || (!dead && e->row[slot].damage < DAMAGE_MED))
        return;
    struct vec3 at = entities_position(e, slot);
    double changed_s = (double)e->row[slot].changed_tick * world_dt_s(frame_view->world);
    double began_s = trail != NULL ? maths_min(trail->smokes_s, changed_s) : changed_s;
    struct shade thin = {0.25f, 0.24f, 0.23f, THIN_SMOKE},
                 thick = {0.20f, 0.19f, 0.18f, THICK_SMOKE};
    struct vec3 top = {at.x, at.y + 0.5 * kind->height_m, at.z};
    double size = 0.3 * kind->radius_m;
    /* Smoke from before the damage grew is still in the air, and thinner. */
    smoke_column(list, top, size, began_s, changed_s, thin, e->row[slot].id);
    if (dead)
        wreck(list, kind, at, changed_s, e->row[slot].id);
    else
        smoke_column(list, top, size, changed_s, list->time_s,
                     e->row[slot].damage >= DAMAGE_HIGH ? thick : thin, e->row[slot].id);
}
