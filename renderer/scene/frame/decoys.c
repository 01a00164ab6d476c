/* Makes effects from the missiles of a frame. */
#include "renderer/scene/frame/decoys.h"

#include "world/entity/decoy.h"
#include "world/entity/kind.h"
#include "world/entity/smoke.h"
#include "world/world.h"

#define MISSILES_MAX 64u /* of a frame; the decoys against others are not shown */

/* Returns true if this vehicle released a decoy within this time. */
static bool released_just_now(const struct effects *effects, uint32_t id, double now_s,
                              double interval_s)
{
    for (uint32_t n = 0; n < effects->count; n++) {
        const struct effect *effect = &effects->effect[n];
        if (effect->type == EFFECT_DECOY && effect->seed >> 8 == (id & 0xffffffu) &&
            now_s - effect->time_s < interval_s)
            return true;
    }
    return false;
}

static void release(struct effects *effects, const struct frame_view *frame_view, uint32_t target,
                    double interval_s)
{
    const struct entities *e = frame_view->entities;
    double now_s = frame_view_time_s(frame_view);
    if (released_just_now(effects, e->row[target].id, now_s, interval_s))
        return;
    struct effect *effect = effects_allocate(effects);
    uint32_t number = (uint32_t)(now_s / DECOYS_INTERVAL_S) & 0xffu;
    *effect = (struct effect){
        .point = entities_position(e, target),
        .time_s = now_s,
        .size_m = (float)frame_view->world->kinds[e->row[target].kind].radius_m,
        .type = EFFECT_DECOY,
        .seed = e->row[target].id << 8 | number,
        .kind = e->row[target].kind,
    };
    vec3_to_floats(effect->direction, entities_velocity(e, target));
}

static bool homes(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    const struct world *world = frame_view->world;
    return e->row[slot].state == ENTITY_ACTIVE && e->row[slot].behaviour == BEHAVIOUR_FLIGHT &&
           e->row[slot].kind < world->counts.kinds &&
           world->kinds[e->row[slot].kind].guidance == GUIDANCE_HOMING &&
           e->row[slot].target_id != 0 && e->row[slot].target_slot < frame_view->head->used &&
           entities_alive(e, e->row[slot].target_slot, e->row[slot].target_id);
}

/* Returns true if the vehicle's smoke grenades burn. */
static bool screens(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    const struct world *world = frame_view->world;
    return e->row[slot].state == ENTITY_ACTIVE && e->row[slot].kind < world->counts.kinds &&
           smoke_age_s(e, &world->kinds[e->row[slot].kind], slot, frame_view->head->tick,
                       world_dt_s(world)) < SMOKE_S;
}

void decoys_take(struct effects *effects, const struct frame_view *frame_view)
{
    const struct entities *e = frame_view->entities;
    uint32_t missiles = 0;
    for (uint32_t slot = 0; slot < frame_view->head->used && missiles < MISSILES_MAX; slot++) {
        if (screens(frame_view, slot))
            release(effects, frame_view, slot, DECOYS_SCREEN_S);
        if (!homes(frame_view, slot))
            continue;
        uint32_t target = e->row[slot].target_slot;
        struct vec3 to = vec3_sub(entities_position(e, target), entities_position(e, slot));
        struct vec3 closing = vec3_sub(entities_velocity(e, target), entities_velocity(e, slot));
        missiles++;
        if (decoy_due(e, target, to, closing, DECOY_RELEASED_S))
            release(effects, frame_view, target, DECOYS_INTERVAL_S);
    }
}
