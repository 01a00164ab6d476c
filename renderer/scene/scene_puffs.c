/* Fire, smoke, dust, wakes, trails and tracers. Everything is a function of the moment and of the
 * effects remembered: the same moment draws the same picture. */
#include "renderer/scene/scene.h"

#include "renderer/scene/grain.h"
#include "renderer/scene/pose.h"

#include <math.h>
#include <stdlib.h>

#define PUFF_LEAST_PIXELS 0.7
#define FIRE_LIFE_S       150.0 /* a wreck burns */
#define SMOKE_LIFE_S      420.0 /* and smokes */
#define SMOKE_PUFFS       60
#define SMOKE_RISE_S      26.0 /* a puff's life in the column */
#define DUST_LEAST_MPS    3.0
#define DUST_PUFFS        9
#define WIND_X            1.7 /* [m/s] */
#define WIND_Z            -1.1

struct shade {
    float r, g, b, a;
};

struct spot {
    struct vec3 at;
    double size_m;
    struct shade shade;
    enum puff_picture picture;
    float turn_rad, glow;
    double lift; /* of a trail: how far it rises, in puffs as they grow */
};

static struct scene_puff *add(struct scene *scene, const struct spot *spot)
{
    double distance = vec3_length(vec3_sub(spot->at, scene->camera.eye));
    if (spot->shade.a < 0.004f ||
        camera_pixels(&scene->camera, spot->size_m, distance) < PUFF_LEAST_PIXELS ||
        !camera_sees(&scene->camera, spot->at, 1.5 * spot->size_m))
        return NULL;
    if (scene->puff_count == SCENE_PUFFS_MAX) {
        scene->omitted++;
        return NULL;
    }
    struct scene_puff *puff = &scene->puffs[scene->puff_count++];
    *puff = (struct scene_puff){
        .size = (float)spot->size_m,
        .turn_rad = spot->turn_rad,
        .picture = (float)spot->picture,
        .glow = spot->glow,
        .colour = {spot->shade.r, spot->shade.g, spot->shade.b, spot->shade.a},
    };
    scene_place(scene, spot->at, puff->at);
    return puff;
}

/* Uniform numbers of one thing's n-th puff. */
static float luck(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return grain_unit((int32_t)seed, (int32_t)n, 300u + purpose);
}

static enum puff_picture smoke_picture(uint32_t seed, uint32_t n)
{
    return (enum puff_picture)(PUFF_SMOKE_A + grain_hash((int32_t)seed, (int32_t)n, 311) % 4);
}

static struct shade fade(struct shade from, struct shade to, double t)
{
    float u = (float)maths_clamp(t, 0.0, 1.0);
    return (struct shade){from.r + (to.r - from.r) * u, from.g + (to.g - from.g) * u,
                          from.b + (to.b - from.b) * u, from.a + (to.a - from.a) * u};
}

/* --- wrecks ----------------------------------------------------------------------------------- */

/* A column of puffs that rise, spread, drift with the wind and fade. Its height follows its
 * thickness, so that puffs overlap in thin columns as in thick ones. */
static void smoke_column(struct scene *scene, struct vec3 foot, double size_m, double burning_s,
                         struct shade shade, uint32_t seed)
{
    double life = SMOKE_RISE_S * maths_clamp(0.25 + 0.4 * size_m, 0.35, 1.3);
    for (uint32_t n = 0; n < SMOKE_PUFFS; n++) {
        double phase = scene->time_s / life + (double)n / SMOKE_PUFFS + (double)luck(seed, 0, 0);
        uint32_t round = (uint32_t)floor(phase) * SMOKE_PUFFS + n;
        double t = phase - floor(phase), age = t * life;
        if (age > burning_s)
            continue; /* it was not yet burning then */
        /* It starts fast and hot, and slows as it cools and the wind takes it. */
        double rise = (0.5 + 1.3 * size_m) * life * (1.0 - (1.0 - t) * (1.0 - 0.45 * t));
        double sway = 1.6 * size_m * t;
        struct spot puff = {
            .at = {foot.x + WIND_X * age * (0.4 + t) + sway * ((double)luck(seed, round, 1) - 0.5),
                   foot.y + rise,
                   foot.z + WIND_Z * age * (0.4 + t) + sway * ((double)luck(seed, round, 2) - 0.5)},
            .size_m = size_m * (0.85 + 3.4 * t) * (0.8 + 0.4 * (double)luck(seed, round, 3)),
            .picture = smoke_picture(seed, round),
            .turn_rad = 6.283f * luck(seed, round, 4) + (float)t,
        };
        puff.shade = fade(shade, (struct shade){0.42f, 0.40f, 0.38f, 0.0f}, t * t * 0.6 + t * 0.4);
        puff.shade.a *= (float)maths_min(1.0, 8.0 * t);
        add(scene, &puff);
    }
}

static void flames(struct scene *scene, struct vec3 foot, double size_m, double strength,
                   uint32_t seed)
{
    for (uint32_t n = 0; n < 9; n++) {
        double phase = scene->time_s * 1.3 + (double)luck(seed, n, 5);
        uint32_t round = (uint32_t)floor(phase) * 9u + n;
        double t = phase - floor(phase);
        struct spot flame = {
            .at = {foot.x + size_m * 1.1 * ((double)luck(seed, round, 6) - 0.5),
                   foot.y + size_m * (0.2 + 0.9 * t),
                   foot.z + size_m * 1.1 * ((double)luck(seed, round, 7) - 0.5)},
            .size_m = size_m * (0.75 - 0.4 * t) * strength,
            .picture = n & 1 ? PUFF_FLAME_A : PUFF_FLAME_B,
            .turn_rad = 0.5f * (luck(seed, round, 8) - 0.5f),
            .glow = 0.85f,
            .shade = {1.0f, 0.72f - 0.32f * (float)t, 0.28f - 0.2f * (float)t,
                      (float)(0.75 * (1.0 - 0.6 * t) * strength)},
        };
        add(scene, &flame);
    }
    struct spot glow = {.at = {foot.x, foot.y + 0.6 * size_m, foot.z},
                        .size_m = 2.2 * size_m,
                        .picture = PUFF_GLOW,
                        .glow = 1.0f,
                        .shade = {1.0f, 0.45f, 0.12f, 0.32f * (float)strength}};
    add(scene, &glow);
}

static void wreck(struct scene *scene, const struct kind *kind, struct vec3 at, double age_s,
                  uint32_t seed)
{
    double size = maths_clamp(0.62 * kind->radius_m, 0.8, 12.0);
    double smoke = maths_clamp((SMOKE_LIFE_S - age_s) / 120.0, 0.0, 1.0);
    double fire = maths_clamp((FIRE_LIFE_S - age_s) / 60.0, 0.0, 1.0);
    struct vec3 foot = {at.x, at.y + 0.25 * kind->height_m, at.z};
    if (smoke > 0.0)
        smoke_column(scene, foot, size, age_s,
                     (struct shade){0.07f, 0.065f, 0.06f, 0.72f * (float)smoke}, seed);
    if (fire > 0.0)
        flames(scene, foot, size, 0.4 + 0.6 * fire, seed);
}

/* --- things that move ------------------------------------------------------------------------- */

/* Puffs left behind along the way it came. */
static void trail(struct scene *scene, struct vec3 at, struct vec3 velocity, const struct spot *as,
                  uint32_t puffs, double life_s, double growth, uint32_t seed)
{
    for (uint32_t n = 0; n < puffs; n++) {
        double age = life_s * ((double)n + 0.5 * (double)luck(seed, n, 9)) / puffs;
        double t = age / life_s;
        struct spot puff = *as;
        puff.at.x = at.x - velocity.x * age + WIND_X * age * 0.5;
        puff.at.y = at.y - velocity.y * age + as->lift * as->size_m * growth * t;
        puff.at.z = at.z - velocity.z * age + WIND_Z * age * 0.5;
        puff.size_m = as->size_m * (1.0 + growth * t) * (0.75 + 0.5 * (double)luck(seed, n, 10));
        puff.picture = smoke_picture(seed, n);
        puff.turn_rad = 6.283f * luck(seed, n, 11);
        puff.shade.a *= (float)((1.0 - t) * (1.0 - t));
        add(scene, &puff);
    }
}

static void land_dust(struct scene *scene, const struct moment *moment, uint32_t slot,
                      const struct kind *kind)
{
    const struct entities *e = moment->entities;
    struct vec3 velocity = entities_velocity(e, slot), at = entities_position(e, slot);
    double speed = vec3_length(velocity);
    enum cover cover = terrain_cover(&moment->world->terrain, at.x, at.z);
    if (speed < DUST_LEAST_MPS || cover_is_water(cover))
        return;
    struct pose pose = pose_of(e->heading[slot], e->pitch[slot], e->roll[slot]);
    double ground = terrain_height(&moment->world->terrain, moment->craters, at.x, at.z);
    double thick = maths_clamp(speed / 14.0, 0.2, 1.0) * (cover == COVER_FOREST ? 0.5 : 1.0);
    for (int32_t side = -1; side <= 1; side += 2) {
        struct vec3 wheel = vec3_add(at, vec3_scale(pose.forward, -0.45 * kind->length_m));
        wheel = vec3_add(wheel, vec3_scale(pose.right, 0.38 * kind->width_m * side));
        wheel.y = ground + 0.35;
        struct spot as = {.size_m = 0.24 * kind->width_m + 0.25,
                          .shade = {0.78f, 0.69f, 0.52f, (float)(0.34 * thick)},
                          .lift = 0.35};
        trail(scene, wheel, velocity, &as, DUST_PUFFS, 2.6, 3.4, e->id[slot] * 2u + (side > 0));
    }
}

static void wake(struct scene *scene, const struct entities *e, uint32_t slot,
                 const struct kind *kind)
{
    struct vec3 velocity = entities_velocity(e, slot), at = entities_position(e, slot);
    if (vec3_length(velocity) < 1.0)
        return;
    struct pose pose = pose_of(e->heading[slot], 0.0, 0.0);
    double speed = vec3_length(velocity);
    for (int32_t side = -1; side <= 1; side++) {
        /* The bow's two waves spread; the screws' foam stays behind. */
        double along = side == 0 ? -0.48 : 0.30, apart = 0.13 * speed * side;
        struct vec3 from = vec3_add(at, vec3_scale(pose.forward, along * kind->length_m));
        from = vec3_add(from, vec3_scale(pose.right, 0.42 * kind->width_m * side));
        from.y = 0.15;
        struct spot as = {.size_m = (side == 0 ? 0.20 : 0.10) * kind->width_m,
                          .shade = {0.86f, 0.91f, 0.94f, side == 0 ? 0.30f : 0.26f}};
        struct vec3 spread = vec3_sub(velocity, vec3_scale(pose.right, apart));
        trail(scene, from, spread, &as, 56, side == 0 ? 14.0 : 9.0, 2.2,
              e->id[slot] * 3u + (uint32_t)(side + 1));
    }
}

/* Missiles leave smoke; shells are a streak of light. */
static void munition(struct scene *scene, const struct entities *e, uint32_t slot,
                     const struct kind *kind)
{
    struct vec3 velocity = entities_velocity(e, slot), at = entities_position(e, slot);
    double speed = vec3_length(velocity);
    if (speed < 1.0)
        return;
    struct vec3 along = vec3_scale(velocity, 1.0 / speed);
    if (kind->guidance == GUIDANCE_HOMING) {
        struct spot as = {.size_m = 0.45, .shade = {0.93f, 0.92f, 0.90f, 0.62f}};
        trail(scene, at, velocity, &as, 40, 0.8, 3.0, e->id[slot]);
        struct spot burner = {.at = vec3_add(at, vec3_scale(along, -kind->radius_m)),
                              .size_m = 0.9,
                              .picture = PUFF_GLOW,
                              .glow = 1.0f,
                              .shade = {1.0f, 0.75f, 0.4f, 1.0f}};
        add(scene, &burner);
        return;
    }
    struct spot tracer = {.at = at,
                          .size_m = 0.16 + 0.5 * kind->radius_m,
                          .picture = PUFF_GLOW,
                          .glow = 1.0f,
                          .shade = {1.0f, 0.72f, 0.38f, 1.0f}};
    struct scene_puff *puff = add(scene, &tracer);
    if (puff == NULL)
        return;
    double half = maths_clamp(speed * 0.008, 1.0, 8.0);
    puff->axis[0] = (float)(along.x * half);
    puff->axis[1] = (float)(along.y * half);
    puff->axis[2] = (float)(along.z * half);
}

static void entity_puffs(struct scene *scene, const struct moment *moment, uint32_t slot)
{
    const struct entities *e = moment->entities;
    if (e->state[slot] == ENTITY_FREE || e->kind[slot] >= moment->world->counts.kinds)
        return;
    const struct kind *kind = &moment->world->kinds[e->kind[slot]];
    struct vec3 at = entities_position(e, slot);
    double size = 2.0 * kind->radius_m;
    /* Columns of smoke reach far out of the body's ball. */
    double distance = vec3_length(vec3_sub(at, scene->camera.eye));
    if (camera_pixels(&scene->camera, size, distance) < PUFF_LEAST_PIXELS ||
        !camera_sees(&scene->camera, at, 140.0 + size))
        return;
    if (e->state[slot] == ENTITY_WRECK) {
        uint64_t since = moment->head->tick - e->changed_tick[slot];
        wreck(scene, kind, at, (double)since * moment->world->params->dt_s, e->id[slot]);
        return;
    }
    if (e->damage[slot] >= DAMAGE_MED && kind->domain != DOMAIN_MUNITION) {
        float thick = e->damage[slot] >= DAMAGE_HIGH ? 0.40f : 0.16f;
        uint64_t since = moment->head->tick - e->changed_tick[slot];
        smoke_column(scene, at, 0.3 * kind->radius_m, (double)since * moment->world->params->dt_s,
                     (struct shade){0.25f, 0.24f, 0.23f, thick}, e->id[slot]);
    }
    switch (kind->domain) {
    case DOMAIN_LAND:
        land_dust(scene, moment, slot, kind);
        break;
    case DOMAIN_SEA:
        wake(scene, e, slot, kind);
        break;
    case DOMAIN_MUNITION:
        munition(scene, e, slot, kind);
        break;
    default:
        break;
    }
}

/* --- what just happened ----------------------------------------------------------------------- */

static void flash(struct scene *scene, const struct effect *effect, double age)
{
    if (age > 0.35)
        return;
    float left = (float)(1.0 - age / 0.35);
    struct spot light = {.at = effect->point,
                         .size_m = (double)effect->size_m * (1.0 + 2.0 * age),
                         .picture = PUFF_GLOW,
                         .glow = 1.0f,
                         .shade = {1.0f, 0.80f, 0.45f, left}};
    add(scene, &light);
    struct spot gas = {.at = effect->point,
                       .size_m = (double)effect->size_m * (0.7 + 4.0 * age),
                       .picture = smoke_picture(effect->seed, 1),
                       .turn_rad = 6.283f * luck(effect->seed, 1, 12),
                       .shade = {0.75f, 0.72f, 0.66f, 0.5f * left}};
    add(scene, &gas);
}

static struct vec3 scatter(uint32_t seed, uint32_t n)
{
    double turn = TWO_PI * (double)luck(seed, n, 13), up = (double)luck(seed, n, 14);
    double ring = sqrt(1.0 - up * up);
    return (struct vec3){maths_cos(turn) * ring, up, maths_sin(turn) * ring};
}

static void fireball(struct scene *scene, const struct effect *effect, double age)
{
    double size = (double)effect->size_m, life = 0.7 + 0.09 * size;
    if (age > life)
        return;
    double t = age / life, grown = 1.0 - (1.0 - t) * (1.0 - t);
    for (uint32_t n = 0; n < 18; n++) {
        struct vec3 way = scatter(effect->seed, n);
        double out = size * (0.25 + 0.65 * grown) * (0.4 + 0.6 * (double)luck(effect->seed, n, 15));
        struct spot ball = {
            .at = {effect->point.x + way.x * out, effect->point.y + way.y * out + 0.8 * size * t,
                   effect->point.z + way.z * out},
            .size_m = size * (0.45 + 0.35 * grown),
            .picture = n % 3 ? smoke_picture(effect->seed, n) : PUFF_FLAME_A,
            .turn_rad = 6.283f * luck(effect->seed, n, 16),
            .glow = (float)(0.45 - 0.4 * t),
            .shade = fade((struct shade){1.0f, 0.80f, 0.42f, 0.85f},
                          (struct shade){0.70f, 0.20f, 0.05f, 0.25f}, t * 1.1),
        };
        add(scene, &ball);
    }
    struct spot glow = {.at = {effect->point.x, effect->point.y + 0.5 * size, effect->point.z},
                        .size_m = 2.6 * size,
                        .picture = PUFF_GLOW,
                        .glow = 1.0f,
                        .shade = {1.0f, 0.62f, 0.25f, (float)(0.4 * (1.0 - t))}};
    add(scene, &glow);
}

static void blast_smoke(struct scene *scene, const struct effect *effect, double age,
                        struct shade shade, double life)
{
    double size = (double)effect->size_m;
    if (age > life)
        return;
    double t = age / life, grown = 1.0 - exp(-2.5 * age);
    for (uint32_t n = 0; n < 22; n++) {
        struct vec3 way = scatter(effect->seed ^ 0x55u, n);
        double reach = (double)luck(effect->seed, n, 17), slow = 0.5 + 0.9 * reach;
        double out = size * (0.25 + 1.1 * grown * reach);
        struct spot puff = {
            .at = {effect->point.x + way.x * out + WIND_X * age * slow,
                   effect->point.y + way.y * out * 1.9 + 2.4 * age * slow * (1.0 - 0.5 * t),
                   effect->point.z + way.z * out + WIND_Z * age * slow},
            .size_m = size * (0.32 + 0.35 * grown * (1.2 - reach) + 0.10 * age),
            .picture = smoke_picture(effect->seed, n),
            .turn_rad = 6.283f * luck(effect->seed, n, 18) + 0.1f * (float)age,
            .shade = fade(shade, (struct shade){0.36f, 0.34f, 0.32f, shade.a}, t),
        };
        puff.shade.a *= (float)((1.0 - t) * (1.0 - 0.6 * t) * maths_min(1.0, 0.25 + 3.0 * age));
        add(scene, &puff);
    }
}

/* Clods and splinters on their arcs. */
static void debris(struct scene *scene, const struct effect *effect, double age)
{
    if (age > 2.2)
        return;
    for (uint32_t n = 0; n < 26; n++) {
        struct vec3 way = scatter(effect->seed ^ 0xaau, n);
        double speed = 4.0 + 3.2 * sqrt((double)effect->size_m) * (double)luck(effect->seed, n, 19);
        struct vec3 at = vec3_add(effect->point, vec3_scale(way, speed * age));
        at.y += speed * age * 0.6 - 0.5 * 9.81 * age * age;
        if (at.y < effect->point.y - 0.5)
            continue;
        bool hot = n % 3 == 0;
        struct spot clod = {.at = at,
                            .size_m = 0.06 + 0.03 * (double)effect->size_m,
                            .picture = hot ? PUFF_GLOW : PUFF_SMOKE_A,
                            .glow = hot ? 1.0f : 0.0f,
                            .shade = hot ? (struct shade){1.0f, 0.6f, 0.2f, 1.0f}
                                         : (struct shade){0.16f, 0.13f, 0.10f, 1.0f}};
        add(scene, &clod);
    }
}

static void effect_puffs(struct scene *scene, const struct effect *effect)
{
    double age = scene->time_s - effect->time_s;
    if (age < 0.0 || age > EFFECT_LIFE_S)
        return;
    switch ((enum effect_type)effect->type) {
    case EFFECT_FLASH:
        flash(scene, effect, age);
        break;
    case EFFECT_EXPLOSION:
        blast_smoke(scene, effect, age, (struct shade){0.17f, 0.15f, 0.13f, 0.55f}, 11.0);
        fireball(scene, effect, age);
        debris(scene, effect, age);
        break;
    case EFFECT_SPLASH:
        blast_smoke(scene, effect, age, (struct shade){0.90f, 0.94f, 0.96f, 0.7f}, 3.0);
        break;
    case EFFECT_CRASH:
        blast_smoke(scene, effect, age, (struct shade){0.74f, 0.66f, 0.50f, 0.4f}, 3.5);
        break;
    }
}

static int farther(const void *a, const void *b)
{
    const struct scene_puff *x = a, *y = b;
    float dx = x->at[0] * x->at[0] + x->at[1] * x->at[1] + x->at[2] * x->at[2];
    float dy = y->at[0] * y->at[0] + y->at[1] * y->at[1] + y->at[2] * y->at[2];
    return (dx < dy) - (dx > dy);
}

void scene_puffs(struct scene *scene, const struct moment *moment, const struct effects *effects)
{
    for (uint32_t slot = 0; slot < moment->head->used; slot++)
        entity_puffs(scene, moment, slot);
    for (uint32_t i = 0; i < effects_count(effects); i++)
        effect_puffs(scene, &effects->ring[i]);
    qsort(scene->puffs, scene->puff_count, sizeof *scene->puffs, farther);
}
