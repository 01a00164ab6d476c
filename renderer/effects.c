/* Events turned into things to see. */
#include "renderer/effects.h"

#include "renderer/grain.h"
#include "renderer/pose.h"

#include <math.h>

#define FLASH_SIZE_M     1.6
#define CRASH_IMPULSE_NS 2.0e4 /* of a collision whose dust is as large as the body */

/* Simulated time of an event: as many steps before the moment as frames. */
static double event_time(const struct moment *moment, const struct event *event)
{
    double since = (double)(moment->head->frame - event->frame) * moment->world->params->dt_s;
    return world_time_s(moment->world, moment->head) - since;
}

static void add(struct effects *effects, const struct moment *moment, const struct event *event,
                enum effect_type type, const double point[3], double size_m)
{
    effects->ring[effects->taken % EFFECTS_MAX] = (struct effect){
        .point = {point[0], point[1], point[2]},
        .time_s = event_time(moment, event),
        .size_m = (float)size_m,
        .type = (uint32_t)type,
        .seed = (uint32_t)event->frame * 64u + event->index,
    };
    effects->taken++;
}

/* Fireball radius [m] of a charge: cube-root scaling, as large as such things look on film. */
static double fireball(double explosive_kg)
{
    return 1.8 + 1.9 * cbrt(maths_max(explosive_kg, 0.0));
}

static struct dented *dented_of(struct effects *effects, uint32_t id)
{
    for (uint32_t i = 0; i < DENTED_MAX; i++)
        if (effects->bodies[i].id == id)
            return &effects->bodies[i];
    struct dented *oldest = &effects->bodies[effects->dented++ % DENTED_MAX];
    *oldest = (struct dented){.id = id};
    return oldest;
}

static float within(double value, double half)
{
    return (float)maths_clamp(value, -half, half);
}

/* Remembers where a body was struck. The body has moved on since; its box bounds the error. */
static void add_dent(struct effects *effects, const struct moment *moment,
                     const struct event *event, const struct event_party *party)
{
    const struct entities *e = moment->entities;
    if (party->fixed || party->damage == DAMAGE_NONE || party->kind >= moment->world->counts.kinds)
        return;
    uint32_t slot = entities_find(e, moment->head->used, party->id);
    if (slot == SLOT_NONE)
        return;
    const double *point = event->collision.point;
    double ago = world_time_s(moment->world, moment->head) - event_time(moment, event);
    struct vec3 then =
        vec3_sub(entities_position(e, slot), vec3_scale(entities_velocity(e, slot), ago));
    struct pose pose = pose_of(e->heading[slot], e->pitch[slot], e->roll[slot]);
    struct vec3 off = vec3_sub((struct vec3){point[0], point[1], point[2]}, then);
    const struct kind *kind = &moment->world->kinds[party->kind];
    struct dented *body = dented_of(effects, party->id);
    struct bruise *dent = &body->dents[body->count++ % DENTS_PER_BODY];
    dent->x = within(vec3_dot(off, pose.forward), 0.5 * kind->length_m);
    dent->y = within(vec3_dot(off, pose.up), 0.5 * kind->height_m);
    dent->z = within(vec3_dot(off, pose.right), 0.5 * kind->width_m);
    dent->depth_m = 0.05f * (float)kind->radius_m * (float)party->damage;
}

static void take_collision(struct effects *effects, const struct moment *moment,
                           const struct event *event)
{
    const struct event_collision *hit = &event->collision;
    const struct event_party *parties[2] = {&hit->a, &hit->b};
    double size = 0.5 + 2.0 * fmin(1.5, cbrt((double)hit->impulse_ns / CRASH_IMPULSE_NS));
    add(effects, moment, event, EFFECT_CRASH, hit->point, size);
    for (uint32_t i = 0; i < 2; i++) {
        add_dent(effects, moment, event, parties[i]);
        if (parties[i]->fixed || parties[i]->damage != DAMAGE_DESTROYED ||
            parties[i]->kind >= moment->world->counts.kinds)
            continue;
        double charge = moment->world->kinds[parties[i]->kind].explosive_kg;
        add(effects, moment, event, EFFECT_EXPLOSION, hit->point, fireball(charge));
    }
}

void effects_take(struct effects *effects, const struct moment *moment, const struct event *events,
                  uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct event *event = &events[i];
        switch (event->type) {
        case EVENT_FIRE:
            add(effects, moment, event, EFFECT_FLASH, event->fire.point, FLASH_SIZE_M);
            break;
        case EVENT_DETONATION: {
            const struct event_detonation *blast = &event->detonation;
            bool wet = blast->struck == STRUCK_WATER;
            add(effects, moment, event, wet ? EFFECT_SPLASH : EFFECT_EXPLOSION, blast->point,
                fireball((double)blast->explosive_kg));
            break;
        }
        case EVENT_COLLISION:
            take_collision(effects, moment, event);
            break;
        default:
            break;
        }
    }
}

uint32_t effects_count(const struct effects *effects)
{
    return effects->taken < EFFECTS_MAX ? (uint32_t)effects->taken : EFFECTS_MAX;
}

uint32_t effects_dents(const struct effects *effects, const struct kind *kind, uint32_t id,
                       enum damage damage, struct bruise dents[DENTS_PER_BODY])
{
    if (damage == DAMAGE_NONE)
        return 0;
    for (uint32_t i = 0; i < DENTED_MAX; i++) {
        const struct dented *body = &effects->bodies[i];
        if (body->id != id)
            continue;
        uint32_t count = body->count < DENTS_PER_BODY ? body->count : DENTS_PER_BODY;
        for (uint32_t j = 0; j < count; j++)
            dents[j] = body->dents[j];
        return count;
    }
    for (uint32_t i = 0; i < (uint32_t)damage && i < DENTS_PER_BODY; i++) {
        float along = grain_unit((int32_t)id, (int32_t)i, 1) - 0.5f;
        float side = grain_unit((int32_t)id, (int32_t)i, 2) < 0.5f ? -0.5f : 0.5f;
        dents[i] = (struct bruise){along * (float)kind->length_m, 0.1f * (float)kind->height_m,
                                 side * (float)kind->width_m,
                                 0.05f * (float)kind->radius_m * (float)damage};
    }
    return (uint32_t)damage < DENTS_PER_BODY ? (uint32_t)damage : DENTS_PER_BODY;
}
