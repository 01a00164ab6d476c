/* Draws decoys as functions of their age. */
#include "renderer/scene/particles/decoy_particles.h"

#include "world/world.h"

#include <math.h>

#define FLARE_S        3.5 /* a flare burns so long */
#define SLOWS_S        0.7 /* the air takes a flare's speed in about this time */
#define FALLS_MPS      18.0
#define THROWN_MPS     22.0 /* to either side, and for grenades forwards */
#define SMOKE_EVERY_S  0.12
#define SMOKE_S        2.4 /* how long the smoke behind a flare lasts */
#define GRENADES       4u
#define GRENADE_M      14.0 /* from the vehicle */
#define SCREEN_M       4.5  /* radius of a grenade's smoke when it has spread */
#define SCREEN_GROWS_S 2.0

/* --- flares ------------------------------------------------------------------------------------*/

/* Where a flare is at an age. It is thrown to one side, slows down and falls. */
static struct vec3 flare_at(const struct effect *effect, double age)
{
    struct vec3 velocity = {(double)effect->direction[0], (double)effect->direction[1],
                            (double)effect->direction[2]};
    double speed = sqrt(velocity.x * velocity.x + velocity.z * velocity.z);
    double side = effect->seed & 1u ? THROWN_MPS : -THROWN_MPS;
    double share = age / (SLOWS_S + age) * SLOWS_S; /* of a second at its first speed */
    if (speed > 1.0) {
        double vx = velocity.x, vz = velocity.z;
        velocity.x -= side * vz / speed;
        velocity.z += side * vx / speed;
    } else {
        velocity.x += side;
    }
    struct vec3 at = vec3_add(effect->point, vec3_scale(velocity, share));
    at.x += WIND_X * age;
    at.z += WIND_Z * age;
    at.y -= FALLS_MPS * age * age / (1.0 + age);
    return at;
}

static void flare_light(struct draw_list *list, const struct effect *effect, double age)
{
    float light = fade_in_out(age, 0.05, FLARE_S, 0.8f);
    light *= 0.85f + 0.15f * value_noise_value(age * 31.0, (double)(effect->seed % 4096u), 12);
    for (uint32_t core = 0; core < 2; core++) {
        struct particle particle = {.at = flare_at(effect, age),
                                    .size_m = core ? 0.7 : 4.0,
                                    .picture = PARTICLE_GLOW,
                                    .glow = 1.0f,
                                    .shade = {1.0f, core ? 0.97f : 0.72f, core ? 0.9f : 0.45f,
                                              core ? light : 0.7f * light}};
        particles_add(list, &particle);
    }
}

static void flare(struct draw_list *list, const struct effect *effect, double age)
{
    if (age < FLARE_S)
        flare_light(list, effect, age);
    uint32_t count = (uint32_t)(FLARE_S / SMOKE_EVERY_S);
    for (uint32_t n = 0; n < count; n++) {
        double since = age - SMOKE_EVERY_S * n, t = since / SMOKE_S;
        if (since <= 0.0 || t >= 1.0)
            continue;
        struct particle puff = {.at = flare_at(effect, SMOKE_EVERY_S * n),
                                .size_m = 0.5 + 1.6 * t,
                                .picture = smoke_picture(effect->seed, n),
                                .turn_rad = particle_random_angle(effect->seed, n, 40),
                                .shade = {0.9f, 0.9f, 0.9f, (float)(0.35 * (1.0 - t))}};
        puff.at.x += WIND_X * since;
        puff.at.z += WIND_Z * since;
        puff.shade.a *= fade_in_out(since, 0.1, SMOKE_S, 0.5);
        particles_add(list, &puff);
    }
}

/* --- smoke of grenades -------------------------------------------------------------------------*/

/* A screen of smoke on the ground around the front of a vehicle. */
static void screen(struct draw_list *list, const struct frame_view *frame_view,
                   const struct effect *effect, double age)
{
    double life = effects_life_s(EFFECT_DECOY);
    for (uint32_t n = 0; n < GRENADES; n++) {
        double turn = TWO_PI * (double)particle_random(effect->seed, n, 41), sine, cosine;
        double grown = age / (SCREEN_GROWS_S + age), size = 0.6 + SCREEN_M * grown;
        maths_sincos(turn, &sine, &cosine);
        double out = GRENADE_M * (0.7 + 0.6 * (double)particle_random(effect->seed, n, 42));
        struct particle puff = {.at = {effect->point.x + out * cosine + WIND_X * age,
                                       effect->point.y,
                                       effect->point.z + out * sine + WIND_Z * age},
                                .size_m = size,
                                .picture = smoke_picture(effect->seed, n),
                                .turn_rad = particle_random_angle(effect->seed, n, 43),
                                .shade = {0.88f, 0.88f, 0.86f, 0.75f}};
        puff.at.y =
            terrain_height(&frame_view->world->terrain, frame_view->craters, puff.at.x, puff.at.z) +
            0.7 * size;
        puff.shade.a *= fade_in_out(age, 0.4, life, 0.6 * life);
        particles_add(list, &puff);
    }
}

void decoy_particles_add(struct draw_list *list, const struct frame_view *frame_view,
                         const struct effect *effect, double age)
{
    if (frame_view->world->kinds[effect->kind].domain == DOMAIN_LAND)
        screen(list, frame_view, effect, age);
    else
        flare(list, effect, age);
}
