/* Makes effects from events. */
#include "renderer/scene/frame/effects.h"

#include "renderer/scene/frame/decoys.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/world.h"

#define MUZZLE_SHARE     0.7 /* height of the gun over the shooter's (mover/weapon/fire.c) */
#define FLASH_M          0.9 /* flash of a shot of a megajoule */
#define FLASH_MIN_M      0.35
#define FLASH_MAX_M      4.0
#define CRASH_IMPULSE_NS 2.0e4 /* of a collision whose dust is as large as the body */
#define CRASH_HIGH_M     5.0   /* collisions higher above the ground raise no dust */
#define SPARKS_MIN_MPS   2.5   /* slower collisions make no sparks */
#define KICK_M           0.5   /* size of what a round without a charge throws up */
#define WRECK_MIN_KG     3.0   /* every vehicle burns like at least this much explosive */

double effects_life_s(enum effect_type type)
{
    static const double life[EFFECT_TYPE_COUNT] = {
        [EFFECT_FLASH] = 0.8, [EFFECT_EXPLOSION] = 10.0,
        [EFFECT_BURST] = 9.0, [EFFECT_SPLASH] = 5.0,
        [EFFECT_HIT] = 1.2,   [EFFECT_CRASH] = 3.5,
        [EFFECT_DECOY] = 6.0, [EFFECT_WRECK] = EFFECT_LIFE_S};
    return life[type];
}

static double end_of(const struct effect *effect)
{
    return effect->time_s + effects_life_s((enum effect_type)effect->type);
}

struct effect *effects_allocate(struct effects *effects)
{
    if (effects->count < EFFECTS_MAX)
        return &effects->effect[effects->count++];
    struct effect *first = effects->effect;
    for (uint32_t i = 1; i < EFFECTS_MAX; i++)
        if (end_of(&effects->effect[i]) < end_of(first))
            first = &effects->effect[i];
    return first;
}

static struct effect *add(struct effects *effects, const struct frame_view *frame_view,
                          const struct event *event, enum effect_type type, const double point[3],
                          double size_m)
{
    struct effect *effect = effects_allocate(effects);
    *effect = (struct effect){
        .point = {point[0], point[1], point[2]},
        .time_s = (double)event->tick * world_dt_s(frame_view->world),
        .size_m = (float)size_m,
        .type = (uint32_t)type,
        .seed = (uint32_t)event->frame * 64u + event->index,
    };
    return effect;
}

/* Returns the radius [m] of the fireball of a charge: cube-root scaling, fitted to films. */
static double fireball(double explosive_kg)
{
    return 1.8 + 1.9 * maths_cbrt(explosive_kg);
}

static const struct kind *kind_of(const struct frame_view *frame_view, uint16_t kind)
{
    return kind < frame_view->world->counts.kinds ? &frame_view->world->kinds[kind] : NULL;
}

/* Returns the direction of a shot: along the velocity of its round, else from the shooter to the
 * muzzle. */
static struct vec3 direction_of(const struct frame_view *frame_view, const struct event_fire *fire)
{
    const struct entities *e = frame_view->entities;
    struct vec3 direction = {0.0, 0.0, 0.0};
    uint32_t slot = entities_find(e, frame_view->head->used, fire->munition.id);
    if (slot != SLOT_NONE) {
        direction = entities_velocity(e, slot);
    } else if ((slot = entities_find(e, frame_view->head->used, fire->shooter.id)) != SLOT_NONE) {
        const struct kind *kind = kind_of(frame_view, e->row[slot].kind);
        direction = vec3_sub((struct vec3){fire->point[0], fire->point[1], fire->point[2]},
                             entities_position(e, slot));
        direction.y -=
            kind == NULL || kind->domain == DOMAIN_AIR ? 0.0 : MUZZLE_SHARE * kind->height_m;
    }
    double length = vec3_length(direction);
    return length > 0.0 ? vec3_scale(direction, 1.0 / length) : (struct vec3){0.0, 1.0, 0.0};
}

static void take_fire(struct effects *effects, const struct frame_view *frame_view,
                      const struct event *event)
{
    const struct event_fire *fire = &event->fire;
    const struct kind *round = kind_of(frame_view, fire->munition.kind);
    if (fire->shooter.id == 0 || round == NULL)
        return; /* a round from the sky has no muzzle */
    double joules = 0.5 * round->mass_kg * round->max_speed_mps * round->max_speed_mps;
    double size = FLASH_M * maths_cbrt(joules / 1.0e6);
    struct effect *flash = add(effects, frame_view, event, EFFECT_FLASH, fire->point,
                               maths_clamp(size, FLASH_MIN_M, FLASH_MAX_M));
    vec3_to_floats(flash->direction, direction_of(frame_view, fire));
}

static void take_detonation(struct effects *effects, const struct frame_view *frame_view,
                            const struct event *event)
{
    static const enum effect_type charged[STRUCK_COUNT] = {
        [STRUCK_VEHICLE] = EFFECT_EXPLOSION, [STRUCK_FIXED] = EFFECT_EXPLOSION,
        [STRUCK_GROUND] = EFFECT_BURST,      [STRUCK_WATER] = EFFECT_SPLASH,
        [STRUCK_AIR] = EFFECT_EXPLOSION,
    };
    const struct event_detonation *blast = &event->detonation;
    motion_trails_end(&effects->trails, blast->munition.id, blast->point,
                      (double)event->tick * world_dt_s(frame_view->world));
    if (blast->struck >= STRUCK_COUNT)
        return;
    if (blast->explosive_kg > 0.0f)
        add(effects, frame_view, event, charged[blast->struck], blast->point,
            fireball((double)blast->explosive_kg));
    else if (blast->struck == STRUCK_GROUND)
        add(effects, frame_view, event, EFFECT_CRASH, blast->point, KICK_M);
    else if (blast->struck == STRUCK_WATER)
        add(effects, frame_view, event, EFFECT_SPLASH, blast->point, KICK_M);
    else if (blast->struck != STRUCK_AIR)
        add(effects, frame_view, event, EFFECT_HIT, blast->point, KICK_M);
}

/* Returns true if the object is made of metal or stone. */
static bool is_hard(const struct frame_view *frame_view, const struct event_party *party)
{
    const struct kind *kind = kind_of(frame_view, party->kind);
    return kind != NULL && (kind->domain != DOMAIN_FIXED || (kind->object_class != OBJECT_TREE &&
                                                             kind->object_class != OBJECT_BUSH));
}

static void take_collision(struct effects *effects, const struct frame_view *frame_view,
                           const struct event *event)
{
    const struct event_collision *hit = &event->collision;
    const double *at = hit->point;
    double size =
        0.5 + 2.0 * maths_min(1.5, maths_cbrt((double)hit->impulse_ns / CRASH_IMPULSE_NS));
    bool wet = cover_is_water(terrain_cover(&frame_view->world->terrain, at[0], at[2]));
    double above =
        at[1] - terrain_height(&frame_view->world->terrain, frame_view->craters, at[0], at[2]);
    if (above < CRASH_HIGH_M)
        add(effects, frame_view, event, wet ? EFFECT_SPLASH : EFFECT_CRASH, at,
            wet ? 0.5 * size : size);
    if (is_hard(frame_view, &hit->a) && is_hard(frame_view, &hit->b) &&
        (double)hit->closing_mps > SPARKS_MIN_MPS)
        add(effects, frame_view, event, EFFECT_HIT, at, 0.6 * size);
}

/* Adds the vehicles that were destroyed, and the wrecks that broke up, since the last call. */
static void take_wrecks(struct effects *effects, const struct frame_view *frame_view)
{
    const struct entities *e = frame_view->entities;
    double now_s = frame_view_time_s(frame_view);
    uint32_t used =
        frame_view->head->used < MOTION_TRAILS_SLOTS ? frame_view->head->used : MOTION_TRAILS_SLOTS;
    for (uint32_t slot = 0; slot < used; slot++) {
        struct motion_trail *trail = &effects->trails.trail[slot];
        const struct kind *kind = kind_of(frame_view, e->row[slot].kind);
        bool broken = e->row[slot].flags & ENTITY_FLAG_BROKEN;
        if (e->row[slot].state != ENTITY_WRECK || kind == NULL ||
            (trail->wrecked && trail->broken == broken))
            continue;
        double time_s = (double)e->row[slot].changed_tick * world_dt_s(frame_view->world);
        trail->wrecked = true;
        trail->broken = broken;
        if (now_s - time_s > effects_life_s(EFFECT_WRECK))
            continue;
        struct effect *wreck = effects_allocate(effects);
        *wreck = (struct effect){
            .point = entities_position(e, slot),
            .time_s = time_s,
            .size_m = (float)fireball(maths_max(kind->explosive_kg, WRECK_MIN_KG)),
            .type = EFFECT_WRECK,
            .seed = e->row[slot].id,
            .kind = e->row[slot].kind,
        };
        vec3_to_floats(wreck->direction, entities_velocity(e, slot));
    }
}

void effects_take(struct effects *effects, const struct frame_view *frame_view,
                  const struct event *events, uint32_t count)
{
    motion_trails_note(&effects->trails, frame_view);
    take_wrecks(effects, frame_view);
    decoys_take(effects, frame_view);
    for (uint32_t i = 0; i < count; i++) {
        const struct event *event = &events[i];
        switch (event->type) {
        case EVENT_FIRE:
            take_fire(effects, frame_view, event);
            break;
        case EVENT_DETONATION:
            take_detonation(effects, frame_view, event);
            break;
        case EVENT_COLLISION:
            take_collision(effects, frame_view, event);
            break;
        default:
            break;
        }
    }
}
