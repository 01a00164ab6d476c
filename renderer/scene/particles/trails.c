/* Particles that moving entities leave behind: dust by cover, wakes, missile smoke, tracers, and
 * the wash of rotors. They lie along the entity's trail. */
#include "renderer/scene/particles/trails.h"

#include "renderer/scene/particles/particles.h"
#include "world/world.h"

#include <math.h>

#define MIN_PIXELS     0.3  /* smaller trails are left out */
#define BEHIND_M       60.0 /* largest offset of a trail's particles from the entity */
#define MORE           1.25 /* margin: an entity may be faster between two points */
#define OVERLAP        0.9  /* half length of a particle over the distance to the next */
#define DUST_MIN_MPS   2.5
#define DUST_LIFE_S    2.8
#define DUST_HZ        9.0
#define DUST_HIGH_M    1.5 /* wheels higher above the ground raise no dust */
#define WAKE_MIN_MPS   1.0
#define WAKE_LIFE_S    15.0
#define WAKE_HZ        6.0
#define BOW_LIFE_S     9.0
#define BOW_HZ         7.0
#define SMOKE_LIFE_S   3.6
#define SMOKE_HZ       30.0
#define TRACER_PIXELS  0.7f  /* tracers are never thinner, because light is visible from afar */
#define TRACER_S       0.013 /* half the time that the eye sees as one streak */
#define TRACER_REACH_M 30.0f
#define WASH_DISCS     1.6 /* a rotor has an effect within this many radii below it */
#define WASH_HZ        14.0
#define RAISED_M       3.0
#define WASH_LIFE_S    1.6

/* The trail of one entity. */
struct trail {
    const struct motion_trail *history;
    struct motion_trail_point now;
    double born_s; /* emission starts then */
    double rate_hz, life_s;
    double size_m, growth; /* radius at first; its relative growth over life_s */
    double settle_mps;     /* speed with the wind, as a share of the wind's */
    uint32_t seed;
};

/* A particle of a trail without its colour. */
struct trail_particle {
    struct particle particle;
    struct vec3 velocity; /* [m/s] of the emitter */
    double t;             /* age over life, 0..1 */
    double drift;         /* [s] time of drifting with the wind */
    uint32_t n;
    float weight;
};

static struct motion_trail_point point_of(const struct entities *e, uint32_t slot, double time_s)
{
    struct motion_trail_point point = {.time_s = time_s};
    vec3_to_floats(point.at, entities_position(e, slot));
    vec3_to_floats(point.velocity, entities_velocity(e, slot));
    return point;
}

/* Returns the numbers that may be visible; none if the entity was too slow. */
static struct particle_sequence trail_sequence(const struct draw_list *list,
                                               const struct trail *trail, double least_mps)
{
    const struct particle_sequence none = {.last = -1, .step = 1};
    struct vec3 at = {(double)trail->now.at[0], (double)trail->now.at[1], (double)trail->now.at[2]};
    double from_s = maths_max(trail->born_s, list->time_s - trail->life_s);
    double speed = motion_trail_fastest_mps(trail->history, &trail->now, from_s);
    if (speed < least_mps)
        return none;
    double length = speed * (list->time_s - from_s);
    /* The nearest end of the trail may be anywhere, so the share is that for the nearest possible
     * distance. The opacity thins out the rest. */
    double nearest = maths_max(0.0, particles_distance_m(list, at) - length);
    double largest = trail->size_m * (1.0 + trail->growth);
    float place[3], reach = (float)(1.2 * length + 2.0 * largest + BEHIND_M);
    draw_list_relative(list, at, place);
    if (camera_pixels(&list->camera, largest, nearest) < MIN_PIXELS ||
        !frustum_ball(&list->frustum, place, reach))
        return none;
    double spacing = particles_spacing_m(list, trail->size_m, nearest);
    return particle_sequence_of(trail->seed, trail->rate_hz, from_s,
                                maths_min(trail->now.time_s, list->time_s),
                                MORE * speed / (spacing * trail->rate_hz));
}

/* Places a particle. Returns false if it is not visible. */
static bool place_particle(const struct draw_list *list, const struct trail *trail,
                           const struct particle_sequence *sequence, int64_t number,
                           struct trail_particle *placed)
{
    double time_s = particle_sequence_time_s(sequence, number), age = list->time_s - time_s;
    struct motion_trail_point was = motion_trail_at(trail->history, &trail->now, time_s);
    struct vec3 velocity = {(double)was.velocity[0], (double)was.velocity[1],
                            (double)was.velocity[2]};
    double speed = vec3_length(velocity), drift = age * trail->settle_mps;
    *placed = (struct trail_particle){
        .t = age / trail->life_s, .drift = drift, .n = (uint32_t)number, .velocity = velocity};
    if (speed <= 0.0 || placed->t < 0.0 || placed->t > 1.0)
        return false;
    double size = trail->size_m * (1.0 + trail->growth * placed->t);
    struct vec3 at = {(double)was.at[0] + WIND_X * drift, (double)was.at[1],
                      (double)was.at[2] + WIND_Z * drift};
    double spacing = particles_spacing_m(list, size, particles_distance_m(list, at));
    placed->weight = particle_sequence_weight(number, speed / (spacing * trail->rate_hz));
    spacing = maths_max(spacing, speed / trail->rate_hz);
    /* Each is tilted at random, because equal particles look artificial. */
    double tilt = 1.6 * size * ((double)particle_random(trail->seed, placed->n, 31) - 0.5);
    struct vec3 along = vec3_scale(velocity, maths_max(size, OVERLAP * spacing) / speed);
    along.y += tilt;
    placed->particle = (struct particle){
        .at = at,
        .along = along,
        .size_m = size * (0.85 + 0.3 * (double)particle_random(trail->seed, placed->n, 10)),
        .picture = smoke_picture(trail->seed, placed->n),
    };
    return placed->weight > 0.0f;
}

/* --- on land ---------------------------------------------------------------------------------- */

static void dust(struct draw_list *list, const struct frame_view *frame_view,
                 const struct motion_trail *history, uint32_t slot, const struct kind *kind)
{
    const struct entities *e = frame_view->entities;
    const struct terrain *terrain = &frame_view->world->terrain;
    struct trail trail = {.history = history,
                          .now = point_of(e, slot, list->time_s),
                          .born_s = (double)e->row[slot].born_tick * world_dt_s(frame_view->world),
                          .rate_hz = DUST_HZ,
                          .life_s = DUST_LIFE_S,
                          .size_m = 0.20 * kind->width_m + 0.25,
                          .growth = 2.4,
                          .settle_mps = 0.6,
                          .seed = e->row[slot].id};
    struct particle_sequence sequence = trail_sequence(list, &trail, DUST_MIN_MPS);
    struct trail_particle placed;
    for (int64_t number = sequence.first; number <= sequence.last; number += sequence.step) {
        if (!place_particle(list, &trail, &sequence, number, &placed))
            continue;
        double speed = vec3_length(placed.velocity), wheels = placed.particle.at.y;
        struct particle *particle = &placed.particle;
        /* Particles come from the left or the right track at random. */
        double side = 0.36 * kind->width_m *
                      ((double)particle_random(trail.seed, placed.n, 9) < 0.5 ? -1.0 : 1.0);
        particle->at.x +=
            (-placed.velocity.z * side - 0.42 * kind->length_m * placed.velocity.x) / speed;
        particle->at.z +=
            (placed.velocity.x * side - 0.42 * kind->length_m * placed.velocity.z) / speed;
        double ground =
            terrain_height(terrain, frame_view->craters, particle->at.x, particle->at.z);
        particle->shade = dust_shade(terrain_cover(terrain, particle->at.x - placed.drift * WIND_X,
                                                   particle->at.z - placed.drift * WIND_Z));
        particle->at.y = ground + (0.6 + 0.2 * placed.t) * particle->size_m;
        double thick = maths_clamp((speed - DUST_MIN_MPS) / 10.0, 0.0, 1.0) *
                       maths_clamp(DUST_HIGH_M + ground - wheels, 0.0, 1.0);
        particle->shade.a *= 0.65f * placed.weight *
                             (float)(thick * (1.0 - placed.t) * (1.0 - placed.t)) *
                             fade_in_out(placed.t, 0.05, 2.0, 1.0);
        particles_add(list, particle);
    }
}

/* --- on water --------------------------------------------------------------------------------- */

/* Draws foam. side: -1, 1 for the bow waves, which spread; 0 for the wake of the screws. */
static void foam(struct draw_list *list, const struct frame_view *frame_view,
                 const struct motion_trail *history, uint32_t slot, const struct kind *kind,
                 int32_t side)
{
    const struct entities *e = frame_view->entities;
    struct trail trail = {.history = history,
                          .now = point_of(e, slot, list->time_s),
                          .born_s = (double)e->row[slot].born_tick * world_dt_s(frame_view->world),
                          .rate_hz = side == 0 ? WAKE_HZ : BOW_HZ,
                          .life_s = side == 0 ? WAKE_LIFE_S : BOW_LIFE_S,
                          .size_m = (side == 0 ? 0.26 : 0.12) * kind->width_m,
                          .growth = side == 0 ? 1.8 : 3.2,
                          .seed = e->row[slot].id * 3u + (uint32_t)(side + 1)};
    struct particle_sequence sequence = trail_sequence(list, &trail, WAKE_MIN_MPS);
    struct trail_particle placed;
    for (int64_t number = sequence.first; number <= sequence.last; number += sequence.step) {
        if (!place_particle(list, &trail, &sequence, number, &placed))
            continue;
        double speed = vec3_length(placed.velocity), age = placed.t * trail.life_s;
        double along = (side == 0 ? -0.46 : 0.34) * kind->length_m;
        double apart = side * (0.34 * kind->width_m + 0.16 * speed * age);
        struct particle *particle = &placed.particle;
        particle->at.x += (along * placed.velocity.x - apart * placed.velocity.z) / speed;
        particle->at.z += (along * placed.velocity.z + apart * placed.velocity.x) / speed;
        particles_lay(
            list, particle,
            terrain_base_height(&frame_view->world->terrain, particle->at.x, particle->at.z));
        particle->shade = (struct shade){0.88f, 0.93f, 0.95f, side == 0 ? 0.55f : 0.50f};
        particle->shade.a *= placed.weight * (float)((1.0 - placed.t) * (1.0 - placed.t)) *
                             (float)maths_clamp((speed - WAKE_MIN_MPS) / 4.0, 0.0, 1.0) *
                             fade_in_out(placed.t, 0.06, 2.0, 1.0);
        particles_add(list, particle);
    }
}

/* --- in the air ------------------------------------------------------------------------------- */

static void missile_smoke(struct draw_list *list, const struct trail *trail)
{
    struct particle_sequence sequence = trail_sequence(list, trail, WAKE_MIN_MPS);
    struct trail_particle placed;
    for (int64_t number = sequence.first; number <= sequence.last; number += sequence.step) {
        if (!place_particle(list, trail, &sequence, number, &placed))
            continue;
        double curl = 0.8 * placed.particle.size_m * placed.t;
        placed.particle.at.x += curl * ((double)particle_random(trail->seed, placed.n, 20) - 0.5);
        placed.particle.at.y += curl * ((double)particle_random(trail->seed, placed.n, 21) - 0.5);
        placed.particle.at.z += curl * ((double)particle_random(trail->seed, placed.n, 22) - 0.5);
        placed.particle.shade = (struct shade){0.93f, 0.92f, 0.90f, 0.75f * placed.weight};
        placed.particle.shade.a *= (float)((1.0 - placed.t) * (1.0 - 0.5 * placed.t));
        particles_add(list, &placed.particle);
    }
}

static struct trail missile_trail(const struct motion_trail *history, struct motion_trail_point now,
                                  uint32_t id)
{
    return (struct trail){.history = history,
                          .now = now,
                          .rate_hz = SMOKE_HZ,
                          .life_s = SMOKE_LIFE_S,
                          .size_m = 0.45,
                          .growth = 3.6,
                          .settle_mps = 0.7,
                          .seed = id};
}

static void missile(struct draw_list *list, const struct frame_view *frame_view,
                    const struct motion_trail *history, uint32_t slot, const struct kind *kind)
{
    const struct entities *e = frame_view->entities;
    struct trail trail = missile_trail(history, point_of(e, slot, list->time_s), e->row[slot].id);
    trail.born_s = (double)e->row[slot].born_tick * world_dt_s(frame_view->world);
    missile_smoke(list, &trail);
    struct vec3 velocity = entities_velocity(e, slot);
    double speed = maths_max(vec3_length(velocity), 1.0), half = 0.5 * kind->length_m;
    float flicker =
        0.85f + 0.15f * value_noise_value(list->time_s * 23.0, (double)(trail.seed % 4096u), 8);
    for (uint32_t core = 0; core < 2; core++) {
        struct particle burner = {
            .at = vec3_add(entities_position(e, slot), vec3_scale(velocity, -1.3 * half / speed)),
            .along = vec3_scale(velocity, (core ? 0.5 : 1.0) * half / speed),
            .size_m = core ? 0.35 : 1.1,
            .picture = PARTICLE_GLOW,
            .glow = 1.0f,
            .shade = {1.0f, core ? 0.9f : 0.62f, core ? 0.75f : 0.28f,
                      core ? 1.0f : 0.7f * flicker}};
        particles_add(list, &burner);
    }
}

/* Draws a streak of light with a white core and a halo. */
static void tracer(struct draw_list *list, const struct entities *e, uint32_t slot,
                   const struct kind *kind)
{
    struct vec3 velocity = entities_velocity(e, slot), at = entities_position(e, slot);
    double speed = vec3_length(velocity);
    float place[3];
    draw_list_relative(list, at, place);
    if (speed < 1.0 || !frustum_ball(&list->frustum, place, TRACER_REACH_M))
        return;
    double distance = vec3_length(vec3_sub(at, list->camera.eye));
    double pixel_m = distance / list->camera.focal_pixels, width = 0.14 + 0.6 * kind->radius_m;
    double half = maths_clamp(speed * TRACER_S, 1.0, 20.0);
    for (uint32_t core = 0; core < 2; core++) {
        double size = maths_max(width * (core ? 0.45 : 1.6),
                                (double)TRACER_PIXELS * (core ? 1.0 : 2.0) * pixel_m);
        struct particle streak = {
            .at = at,
            .along = vec3_scale(velocity, half * (core ? 0.8 : 1.0) / speed),
            .size_m = size,
            .picture = PARTICLE_GLOW,
            .glow = 1.0f,
            .shade = {1.0f, core ? 0.92f : 0.55f, core ? 0.75f : 0.20f, core ? 1.0f : 0.65f}};
        particles_add(list, &streak);
    }
}

/* Returns the colour of dust, or spray on water, around a place, as a mean of four points. */
static struct shade raised_at(const struct terrain *terrain, double x, double z)
{
    struct shade sum = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < 4; i++) {
        enum cover cover = terrain_cover(terrain, x + (i & 1 ? RAISED_M : -RAISED_M),
                                         z + (i & 2 ? RAISED_M : -RAISED_M));
        struct shade one =
            cover_is_water(cover) ? (struct shade){0.90f, 0.94f, 0.96f, 0.8f} : dust_shade(cover);
        sum.r += 0.25f * one.r;
        sum.g += 0.25f * one.g;
        sum.b += 0.25f * one.b;
        sum.a += 0.25f * one.a;
    }
    return sum;
}

/* Draws a ring of dust or spray that a rotor near the ground drives outwards. */
static void rotor_wash(struct draw_list *list, const struct frame_view *frame_view, uint32_t slot,
                       const struct kind *kind)
{
    const struct entities *e = frame_view->entities;
    const struct terrain *terrain = &frame_view->world->terrain;
    struct vec3 at = entities_position(e, slot);
    double radius = 0.55 * kind->length_m;
    float place[3];
    draw_list_relative(list, at, place);
    if (kind->min_speed_mps > 0.0 || !frustum_ball(&list->frustum, place, (float)(4.0 * radius)))
        return; /* fixed wings, or out of view */
    double above = at.y - terrain_height(terrain, frame_view->craters, at.x, at.z);
    double strength = maths_clamp(1.0 - above / (WASH_DISCS * radius), 0.0, 1.0);
    if (strength <= 0.0)
        return;
    struct particle_sequence sequence =
        particle_sequence_of(e->row[slot].id, WASH_HZ, list->time_s - WASH_LIFE_S, list->time_s,
                             particles_share(list, radius, at));
    for (int64_t number = sequence.first; number <= sequence.last; number += sequence.step) {
        uint32_t n = (uint32_t)number, seed = e->row[slot].id;
        double t = (list->time_s - particle_sequence_time_s(&sequence, number)) / WASH_LIFE_S;
        double turn = TWO_PI * (double)particle_random(seed, n, 23), sine, cosine;
        maths_sincos(turn, &sine, &cosine);
        double out = radius * (0.35 + 1.7 * t * (1.4 - 0.4 * t));
        struct particle particle = {.at = {at.x + out * cosine, 0.0, at.z + out * sine},
                                    .size_m = radius * (0.16 + 0.34 * t),
                                    .picture = smoke_picture(seed, n),
                                    .turn_rad = particle_random_angle(seed, n, 24)};
        particle.shade = raised_at(terrain, particle.at.x, particle.at.z);
        particle.at.y = terrain_height(terrain, frame_view->craters, particle.at.x, particle.at.z) +
                        (0.6 + 0.3 * t) * particle.size_m;
        particle.shade.a *= 0.8f * (float)(strength * (1.0 - t)) * fade_in_out(t, 0.15, 2.0, 1.0) *
                            particle_sequence_weight(number, particles_share(list, radius, at));
        particles_add(list, &particle);
    }
}

void trails_entity(struct draw_list *list, const struct frame_view *frame_view,
                   const struct motion_trail *history, uint32_t slot, const struct kind *kind)
{
    switch (kind->domain) {
    case DOMAIN_LAND:
        dust(list, frame_view, history, slot, kind);
        break;
    case DOMAIN_SEA:
        for (int32_t side = -1; side <= 1; side++)
            foam(list, frame_view, history, slot, kind, side);
        break;
    case DOMAIN_AIR:
        rotor_wash(list, frame_view, slot, kind);
        break;
    case DOMAIN_MUNITION:
        if (kind->guidance == GUIDANCE_HOMING)
            missile(list, frame_view, history, slot, kind);
        else
            tracer(list, frame_view->entities, slot, kind);
        break;
    default:
        break;
    }
}

void trails_ended(struct draw_list *list, const struct frame_view *frame_view,
                  const struct motion_trails *histories)
{
    const struct entities *e = frame_view->entities;
    for (uint32_t slot = 0; slot < MOTION_TRAILS_SLOTS && slot < frame_view->head->used; slot++) {
        const struct motion_trail *history = &histories->trail[slot];
        if (history->count == 0 ||
            (e->row[slot].state != ENTITY_FREE && e->row[slot].id == history->id) ||
            frame_view->world->kinds[history->kind].domain != DOMAIN_MUNITION)
            continue;
        const struct motion_trail_point *end =
            &history->point[(history->count - 1) % MOTION_TRAIL_POINTS];
        if (end->time_s > list->time_s || end->time_s < list->time_s - SMOKE_LIFE_S)
            continue;
        struct trail trail = missile_trail(history, *end, history->id);
        const struct motion_trail_point *first =
            &history->point[history->count < MOTION_TRAIL_POINTS
                                ? 0
                                : history->count % MOTION_TRAIL_POINTS];
        trail.born_s = first->time_s;
        missile_smoke(list, &trail);
    }
}
