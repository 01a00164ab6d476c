/* Particles of shots, explosions, splashes, sparks and dust. Each effect is a function of its age.
 * Particles appear and vanish by their opacity. */
#include "renderer/scene/particles/bursts.h"

#include "renderer/scene/particles/decoy_particles.h"
#include "renderer/scene/particles/particles.h"
#include "world/world.h"

#include <math.h>

#define GRAVITY         9.81 /* [m/s^2] */
#define FLASH_S         0.12 /* duration of a muzzle flash; its gas lasts longer */
#define BLINK_S         0.14 /* duration of an explosion's flash */
#define FIRE_PARTICLES  12
#define SMOKE_PARTICLES 11
#define SPARKS          16
#define SOIL_JETS       11
#define JET_PARTICLES   3
#define SPRAY_JETS      8
#define RING_PARTICLES  12

/* Approximates 1 - exp(-x) without the C library's exp, which is not the same everywhere. */
static double saturate(double x)
{
    return 1.0 - 1.0 / (1.0 + x * (1.0 + 0.5 * x));
}

/* Returns a random direction upwards; steep 0: uniform in all directions, 1: straight up. */
static struct vec3 scatter(uint32_t seed, uint32_t n, double steep)
{
    double sine, cosine, up = steep + (1.0 - steep) * (double)particle_random(seed, n, 14);
    maths_sincos(TWO_PI * (double)particle_random(seed, n, 13), &sine, &cosine);
    double ring = sqrt(1.0 - up * up);
    return (struct vec3){cosine * ring, up, sine * ring};
}

static struct vec3 effect_direction(const struct effect *effect)
{
    return (struct vec3){(double)effect->direction[0], (double)effect->direction[1],
                         (double)effect->direction[2]};
}

/* --- shots ------------------------------------------------------------------------------------ */

/* Draws a muzzle flash as a star: a long flame ahead and shorter ones to the sides, as with a
 * muzzle brake. */
static void flash_star(struct draw_list *list, const struct effect *effect, double age)
{
    struct vec3 direction = effect_direction(effect), up = {0.0, 1.0, 0.0};
    struct vec3 side = vec3_cross(direction, up);
    double wide = vec3_length(side), size = (double)effect->size_m;
    side = wide > 0.01 ? vec3_scale(side, 1.0 / wide) : (struct vec3){1.0, 0.0, 0.0};
    up = vec3_cross(side, direction);
    float light = (float)(1.0 - age / FLASH_S);
    struct vec3 middle = vec3_add(effect->point, vec3_scale(direction, 0.5 * size));
    for (uint32_t n = 0; n < 5; n++) {
        double turn =
            (n & 1 ? 1.0 : -1.0) * (0.8 + 0.4 * (double)particle_random(effect->seed, n, 30));
        struct vec3 ray = n == 0  ? vec3_scale(direction, 1.5)
                          : n < 3 ? vec3_scale(side, turn)
                                  : vec3_scale(up, 0.7 * turn);
        ray = vec3_add(ray, vec3_scale(direction, n == 0 ? 0.0 : 0.25));
        struct particle flame = {
            .at = vec3_add(n == 0 ? middle : effect->point, vec3_scale(ray, 0.55 * size)),
            .along = vec3_scale(ray, size * (0.8 + 2.0 * age)),
            .size_m = size * (n == 0 ? 0.50 : 0.28),
            .picture = PARTICLE_GLOW,
            .glow = 1.0f,
            .shade = {1.0f, 0.82f, 0.48f, light}};
        particles_add(list, &flame);
    }
    struct particle glow = {.at = middle,
                            .size_m = 2.2 * size,
                            .picture = PARTICLE_GLOW,
                            .glow = 1.0f,
                            .shade = {1.0f, 0.70f, 0.32f, 0.75f * light}};
    particles_add(list, &glow);
}

static void flash(struct draw_list *list, const struct effect *effect, double age)
{
    double life = effects_life_s(EFFECT_FLASH), size = (double)effect->size_m;
    if (age < FLASH_S)
        flash_star(list, effect, age);
    struct vec3 direction = effect_direction(effect);
    for (uint32_t n = 0; n < 3; n++) {
        double out = size * ((0.5 + 0.8 * n) * saturate(6.0 * age) + 0.3 * n);
        struct particle gas = {.at = vec3_add(effect->point, vec3_scale(direction, out)),
                               .size_m = size * (0.35 + 0.9 * saturate(4.0 * age)),
                               .picture = smoke_picture(effect->seed, n),
                               .turn_rad = particle_random_angle(effect->seed, n, 12),
                               .shade = {0.78f, 0.76f, 0.71f, 0.5f}};
        gas.at.x += WIND_X * age;
        gas.at.y += 0.6 * age;
        gas.at.z += WIND_Z * age;
        gas.shade.a *= fade_in_out(age, 0.03, life, life);
        particles_add(list, &gas);
    }
}

/* --- explosions ------------------------------------------------------------------------------- */

static void blink(struct draw_list *list, const struct effect *effect, double age, double size)
{
    float light = (float)maths_clamp(1.0 - age / BLINK_S, 0.0, 1.0);
    for (uint32_t core = 0; core < 2 && light > 0.0f; core++) {
        struct particle glow = {.at = effect->point,
                                .size_m = size * (core ? 1.1 : 3.4),
                                .picture = PARTICLE_GLOW,
                                .glow = 1.0f,
                                .shade = {1.0f, core ? 0.96f : 0.75f, core ? 0.85f : 0.42f,
                                          light * (core ? 1.0f : 0.8f)}};
        particles_add(list, &glow);
    }
}

static void fireball(struct draw_list *list, const struct effect *effect, double age)
{
    double size = (double)effect->size_m, life = 0.75 + 0.09 * size;
    blink(list, effect, age, size);
    if (age > life)
        return;
    double t = age / life, grown = 1.0 - (1.0 - t) * (1.0 - t);
    double share = particles_share(list, size, effect->point);
    for (uint32_t n = 0; n < particles_shown(FIRE_PARTICLES, share); n++) {
        struct vec3 direction = scatter(effect->seed, n, 0.0);
        double out =
            size * (0.2 + 0.6 * grown) * (0.3 + 0.7 * (double)particle_random(effect->seed, n, 15));
        /* some particles burn out sooner than others */
        double own = maths_min(1.0, t * (0.8 + 0.5 * (double)particle_random(effect->seed, n, 25)));
        struct particle ball = {
            .at = {effect->point.x + direction.x * out,
                   effect->point.y + direction.y * out + 0.9 * size * t,
                   effect->point.z + direction.z * out},
            .size_m = size * (0.42 + 0.34 * grown),
            .picture = n % 3 ? smoke_picture(effect->seed, n) : PARTICLE_FLAME_A,
            .turn_rad = particle_random_angle(effect->seed, n, 16) + 0.6f * (float)t,
            .glow = (float)(0.50 - 0.38 * own),
            .shade = shade_mix((struct shade){1.0f, 0.58f, 0.30f, 1.0f},
                               (struct shade){0.60f, 0.14f, 0.03f, 0.7f}, own * 1.1)};
        ball.shade.a *=
            particles_part(n, FIRE_PARTICLES, share) * fade_in_out(own, 0.03, 1.0, 0.45);
        particles_add(list, &ball);
    }
    struct particle glow = {.at = {effect->point.x, effect->point.y + 0.5 * size, effect->point.z},
                            .size_m = 2.4 * size,
                            .picture = PARTICLE_GLOW,
                            .glow = 1.0f,
                            .shade = {1.0f, 0.60f, 0.22f, (float)(0.4 * (1.0 - t) * (1.0 - t))}};
    particles_add(list, &glow);
}

/* Draws a cloud that grows quickly, then rises and drifts with the wind. tall: final height over
 * width; in_s: time to appear. */
static void cloud(struct draw_list *list, const struct effect *effect, double age,
                  struct shade shade, double life, double tall, double in_s)
{
    double size = (double)effect->size_m, t = age / life, grown = saturate(2.2 * age);
    if (t >= 1.0)
        return;
    double share = particles_share(list, size, effect->point);
    for (uint32_t n = 0; n < particles_shown(SMOKE_PARTICLES, share); n++) {
        struct vec3 direction = scatter(effect->seed ^ 0x55u, n, 0.0);
        double reach = (double)particle_random(effect->seed, n, 17), slow = 0.5 + 0.9 * reach;
        double out = size * (0.2 + 1.0 * grown * reach);
        double up = out * direction.y * (1.0 + (tall - 1.0) * grown) + 0.8 * tall * age * slow;
        struct particle particle = {
            .at = {effect->point.x + direction.x * out + WIND_X * age * slow,
                   effect->point.y + up + 0.2 * size,
                   effect->point.z + direction.z * out + WIND_Z * age * slow},
            .size_m = size * (0.30 + 0.38 * grown * (1.2 - reach) + 0.09 * age),
            .picture = smoke_picture(effect->seed, n),
            .turn_rad = particle_random_angle(effect->seed, n, 18) + 0.1f * (float)age,
            .shade = shade_mix(shade, (struct shade){0.40f, 0.38f, 0.35f, shade.a}, t)};
        particle.shade.a *= (float)((1.0 - t) * (1.0 - 0.5 * t)) *
                            particles_part(n, SMOKE_PARTICLES, share) *
                            fade_in_out(age, in_s, life, 0.2 * life);
        particles_add(list, &particle);
    }
}

/* Draws sparks as streaks of light on ballistic paths with air drag. */
static void sparks(struct draw_list *list, const struct effect *effect, double age, double speed,
                   double life)
{
    double share = particles_share(list, (double)effect->size_m, effect->point);
    for (uint32_t n = 0; n < particles_shown(SPARKS, share); n++) {
        double own = life * (0.45 + 0.55 * (double)particle_random(effect->seed, n, 26)),
               t = age / own;
        float alpha = particles_part(n, SPARKS, share);
        if (t >= 1.0 || alpha <= 0.0f)
            continue;
        struct vec3 direction = scatter(effect->seed ^ 0xaau, n, 0.05);
        double fast = speed * (0.35 + 0.65 * (double)particle_random(effect->seed, n, 19));
        double gone = fast * own * 0.6 * saturate(t / 0.6), now = fast * (1.0 - 0.75 * t);
        struct particle spark = {.at = vec3_add(effect->point, vec3_scale(direction, gone)),
                                 .size_m = 0.045 + 0.012 * (double)effect->size_m,
                                 .picture = PARTICLE_GLOW,
                                 .glow = 1.0f,
                                 .shade =
                                     shade_mix((struct shade){1.0f, 0.90f, 0.60f, 1.0f},
                                               (struct shade){1.0f, 0.35f, 0.08f, 0.0f}, t * t)};
        spark.at.y -= 0.5 * GRAVITY * age * age;
        spark.along =
            (struct vec3){0.02 * direction.x * now, 0.02 * (direction.y * now - GRAVITY * age),
                          0.02 * direction.z * now};
        spark.shade.a *= alpha;
        particles_add(list, &spark);
    }
}

/* --- the ground and the sea ------------------------------------------------------------------- */

/* Jets of soil or water that rise and fall back. */
struct fountain {
    uint32_t jets;
    double speed, gravity; /* [m/s], [m/s^2] */
    double steep, width_m, life_s;
    struct shade shade;
    enum particle_picture picture;
};

/* Draws each jet as a few stretched particles, the first the fastest. A particle vanishes when it
 * falls below the ground. */
static void jets(struct draw_list *list, const struct effect *effect, double age,
                 const struct fountain *fountain)
{
    double share = particles_share(list, (double)effect->size_m, effect->point);
    for (uint32_t n = 0; n < particles_shown(fountain->jets * JET_PARTICLES, share); n++) {
        uint32_t jet = n / JET_PARTICLES, back = n % JET_PARTICLES;
        struct vec3 direction = scatter(effect->seed ^ 0x33u, jet, fountain->steep);
        double speed = fountain->speed *
                       (0.55 + 0.45 * (double)particle_random(effect->seed, jet, 27)) *
                       (1.0 - 0.26 * back);
        double up = direction.y * speed * age - 0.5 * fountain->gravity * age * age;
        double rise = direction.y * speed - fountain->gravity * age, grown = 0.7 + 0.7 * age;
        double size =
            fountain->width_m * grown * (0.8 + 0.4 * (double)particle_random(effect->seed, n, 28));
        double left = up / size + 0.8; /* the particle sinks into the ground */
        if (left <= 0.0)
            continue;
        double length =
            size + speed * (0.03 + 0.16 * age / (1.0 + age)); /* stretched by its speed */
        struct particle particle = {.at = {effect->point.x + direction.x * speed * age,
                                           effect->point.y + up,
                                           effect->point.z + direction.z * speed * age},
                                    .size_m = size,
                                    .picture = fountain->picture,
                                    .shade = fountain->shade};
        double fast =
            maths_max(1.0, sqrt(speed * speed * (1.0 - direction.y * direction.y) + rise * rise));
        particle.along = (struct vec3){direction.x * speed * length / fast, rise * length / fast,
                                       direction.z * speed * length / fast};
        float here = fade_in_out(age, 0.04, fountain->life_s, fountain->life_s);
        particle.shade.a *= (float)maths_clamp(left, 0.0, 1.0) * here * here *
                            particles_part(n, fountain->jets * JET_PARTICLES, share);
        particles_add(list, &particle);
    }
}

static void burst(struct draw_list *list, const struct frame_view *frame_view,
                  const struct effect *effect, double age)
{
    double size = (double)effect->size_m;
    enum cover cover = terrain_cover(&frame_view->world->terrain, effect->point.x, effect->point.z);
    struct shade dust = dust_shade(cover);
    struct fountain soil = {.jets = SOIL_JETS,
                            .speed = 7.5 * sqrt(size),
                            .gravity = GRAVITY,
                            .steep = 0.62,
                            .width_m = 0.26 * size,
                            .life_s = 3.0,
                            .shade = {0.30f * dust.r, 0.27f * dust.g, 0.24f * dust.b, 0.95f},
                            .picture = PARTICLE_SPRAY};
    blink(list, effect, age, 0.8 * size);
    jets(list, effect, age, &soil);
    if (age < 0.5)
        sparks(list, effect, age, 7.0 * sqrt(size), 0.5);
    struct shade smoke = {0.42f * dust.r, 0.40f * dust.g, 0.38f * dust.b, 0.55f};
    cloud(list, effect, age, smoke, effects_life_s(EFFECT_BURST), 1.5, 0.15);
}

/* Draws foam that runs outwards on the water. */
static void ring(struct draw_list *list, const struct effect *effect, double age, double life)
{
    double size = (double)effect->size_m, t = age / life,
           out = size * (0.5 + 2.6 * saturate(1.2 * age));
    double share = particles_share(list, size, effect->point);
    for (uint32_t n = 0; n < RING_PARTICLES; n++) {
        double sine, cosine, turn = (double)n + 0.6 * (double)particle_random(effect->seed, n, 29);
        maths_sincos(TWO_PI * turn / RING_PARTICLES, &sine, &cosine);
        double wide = size * (0.22 + 0.20 * saturate(age));
        struct particle foam = {
            .at = {effect->point.x + out * cosine, 0.0, effect->point.z + out * sine},
            .along = {-sine * 2.2 * wide, 0.0, cosine * 2.2 * wide},
            .size_m = wide,
            .picture = smoke_picture(effect->seed, n),
            .shade = {0.90f, 0.95f, 0.97f, 0.6f}};
        particles_lay(list, &foam, effect->point.y);
        foam.shade.a *= (float)((1.0 - t) * (1.0 - t)) *
                        particles_part(n % 3, 3, maths_max(share, 0.4)) *
                        fade_in_out(age, 0.2, life, 0.5);
        particles_add(list, &foam);
    }
}

static void splash(struct draw_list *list, const struct effect *effect, double age)
{
    double size = (double)effect->size_m, life = effects_life_s(EFFECT_SPLASH);
    struct fountain column = {.jets = SPRAY_JETS,
                              .speed = 11.0 * sqrt(size),
                              .gravity = 1.25 * GRAVITY,
                              .steep = 0.98,
                              .width_m = 0.30 * size,
                              .life_s = 4.0,
                              .shade = {0.92f, 0.96f, 0.98f, 0.95f},
                              .picture = PARTICLE_SPRAY};
    struct fountain crown = column;
    jets(list, effect, age, &column);
    crown.speed = 6.0 * sqrt(size);
    crown.steep = 0.60;
    crown.width_m = 0.20 * size;
    crown.life_s = 2.0;
    jets(list, effect, age, &crown);
    cloud(list, effect, age, (struct shade){0.92f, 0.95f, 0.97f, 0.35f}, 0.6 * life, 1.2, 0.3);
    ring(list, effect, age, life);
}

void bursts_effect(struct draw_list *list, const struct frame_view *frame_view,
                   const struct effect *effect, double age)
{
    double size = (double)effect->size_m, life = effects_life_s((enum effect_type)effect->type);
    struct shade dust =
        dust_shade(terrain_cover(&frame_view->world->terrain, effect->point.x, effect->point.z));
    switch ((enum effect_type)effect->type) {
    case EFFECT_FLASH:
        flash(list, effect, age);
        break;
    case EFFECT_EXPLOSION:
    case EFFECT_WRECK:
        cloud(list, effect, age, (struct shade){0.17f, 0.15f, 0.13f, 0.6f},
              effects_life_s(EFFECT_EXPLOSION), 1.9, 0.9);
        fireball(list, effect, age);
        sparks(list, effect, age, 10.0 * sqrt(size), 1.6);
        break;
    case EFFECT_BURST:
        burst(list, frame_view, effect, age);
        break;
    case EFFECT_SPLASH:
        splash(list, effect, age);
        break;
    case EFFECT_HIT:
        sparks(list, effect, age, 6.0 + 3.0 * size, life);
        blink(list, effect, age, 0.3 * size);
        break;
    case EFFECT_CRASH:
        dust.a = 0.15f + 0.40f * dust.a;
        cloud(list, effect, age, dust, life, 1.0, 0.12);
        break;
    case EFFECT_DECOY:
        decoy_particles_add(list, frame_view, effect, age);
        break;
    case EFFECT_TYPE_COUNT:
        break;
    }
}
