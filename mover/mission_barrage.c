/* A barrage is a row of volleys. Each volley is a fire mission of its own, at a random point of the
 * phase's area, so that howitzers lay their guns, heat their barrels and err as in any other fire
 * mission. */
#include "mover/mission_barrage.h"

#include "mover/mission_conditions.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/fire_mission.h"
#include "world/entity/kind.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define VOLLEY        FIRE_MISSION_AFAR_GUNS /* rounds of a volley */
#define VOLLEYS_A_SEC 8u                     /* at most, also of bombs */
#define AFAR_LEFT_S   6.0 /* so long before its impact a shell from off the map appears */

static struct fire_mission_order volley_at(const struct serial_context *context,
                                           const struct battle_phase *phase, uint32_t id)
{
    const struct area *area = &context->step->world->areas[phase->area];
    uint64_t seed = context->step->world->params->seed, tick = context->step->tick;
    return (struct fire_mission_order){
        .x = area->x0 + (area->x1 - area->x0) * random_unit(seed, tick, id, RANDOM_GOAL_X),
        .z = area->z0 + (area->z1 - area->z0) * random_unit(seed, tick, id, RANDOM_GOAL_Z),
        .bearing_rad = phase->bearing_rad,
        .left_s = AFAR_LEFT_S,
        .gun = SLOT_NONE,
        .rounds = VOLLEY,
        .munition = (uint16_t)phase->munition,
        .fuze = FUZE_COUNT,
        .adjusted = phase->adjusted != 0};
}

/* Returns how many volleys come due in the second that ends now. The first one is due at once. */
static uint32_t volleys_due(const struct serial_context *context, uint32_t since_tick,
                            const struct battle_phase *phase, uint32_t second_ticks,
                            uint32_t rounds)
{
    uint32_t ticks = (uint32_t)context->step->tick - since_tick;
    double rate = phase->rounds_a_minute / 60.0 / (double)rounds * context->step->dt_s;
    double before = ticks > second_ticks ? floor(rate * (double)(ticks - second_ticks)) + 1.0 : 0.0;
    uint32_t due = (uint32_t)(floor(rate * (double)ticks) + 1.0 - before);
    return due < VOLLEYS_A_SEC ? due : VOLLEYS_A_SEC;
}

/* Other munitions than shells fall one by one. */
static void fire_from_sky(struct serial_context *context, const struct fire_mission_order *volley,
                          bool shells, uint32_t force)
{
    struct fire_mission_order order = *volley;
    order.force = (uint8_t)force;
    if (shells)
        fire_mission_begin(context, &order);
    else
        fire_drop_bomb(context, order.munition, order.x, order.z);
}

/* A howitzer of the mission that is free begins, and its battery fires with it. */
static void fire_with_howitzers(struct serial_context *context, const struct mission *mission,
                                const struct fire_mission_order *volley)
{
    const uint32_t *member = context->step->world->mission_members + mission->first_member;
    struct fire_mission_order order = *volley;
    for (uint32_t n = 0; n < mission->member_count; n++) {
        if (!mission_conditions_active(context, member[n]) ||
            !fire_mission_can(context, member[n], order.x, order.z))
            continue;
        order.gun = member[n];
        fire_mission_begin(context, &order);
        return;
    }
}

/* A gun that is no howitzer fires at what it reaches, as fast as it loads. */
static void fire_directly(struct serial_context *context, const struct battle_phase *phase,
                          uint32_t row)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds, *kind = &kinds[m->row[row].kind];
    if (m->row[row].behaviour != BEHAVIOUR_IDLE || kind->munition == KIND_NONE ||
        kinds[kind->munition].delivery == DELIVERY_ARC || m->row[row].rounds == 0 ||
        context->step->tick < m->row[row].reload_tick)
        return;
    const struct fire_mission_order at = volley_at(context, phase, m->row[row].id);
    double dx = at.x - m->row[row].x, dz = at.z - m->row[row].z;
    if (dx * dx + dz * dz <= kind->range_m * kind->range_m)
        fire_shoot_at(context, row, at.x, at.z, KIND_NONE);
}

void mission_barrage(struct serial_context *context, uint32_t index,
                     const struct battle_phase *phase, uint32_t second_ticks)
{
    const struct world *world = context->step->world;
    const struct mission *mission = &world->missions[index];
    const uint32_t *member = world->mission_members + mission->first_member;
    bool sky = mission->member_count == 0;
    bool shells =
        phase->munition == KIND_NONE || world->kinds[phase->munition].delivery == DELIVERY_ARC;
    uint32_t due = volleys_due(context, context->moved->head->battle.mission[index].since_tick,
                               phase, second_ticks, shells ? VOLLEY : 1);
    for (uint32_t n = 0; n < due; n++) {
        const struct fire_mission_order volley =
            volley_at(context, phase, UINT32_MAX - index * VOLLEYS_A_SEC - n);
        if (sky || !shells)
            fire_from_sky(context, &volley, shells, mission->force);
        else
            fire_with_howitzers(context, mission, &volley);
    }
    for (uint32_t n = 0; n < mission->member_count && phase->munition == KIND_NONE; n++) {
        if (mission_conditions_active(context, member[n]))
            fire_directly(context, phase, member[n]);
    }
}
