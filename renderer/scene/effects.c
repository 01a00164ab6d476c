/* Events turned into things to see. */
#include "renderer/scene/effects.h"

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

static void take_collision(struct effects *effects, const struct moment *moment,
                           const struct event *event)
{
    const struct event_collision *hit = &event->collision;
    const struct event_party *parties[2] = {&hit->a, &hit->b};
    double size = 0.5 + 2.0 * fmin(1.5, cbrt((double)hit->impulse_ns / CRASH_IMPULSE_NS));
    add(effects, moment, event, EFFECT_CRASH, hit->point, size);
    for (uint32_t i = 0; i < 2; i++) {
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
