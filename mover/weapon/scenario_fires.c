/* Carries out the shots that the scenario orders. */
#include "mover/weapon/scenario_fires.h"

#include "mover/motion/kinematics.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/fire_mission.h"
#include "world/state.h"
#include "world/world.h"

/* A shot without a shooter. */
static void fire_from_nowhere(struct serial_context *context, const struct fire_order *order)
{
    const struct kind *round = &context->step->world->kinds[order->kind];
    const struct fire_afar afar = {
        .point = {order->x, kinematics_ground(context->step, order->x, order->z), order->z},
        .bearing_rad = order->bearing_rad,
        .left_s = order->flight_s,
        .high = order->high != 0,
        .munition = order->kind,
        .fuze = order->fuze == FUZE_COUNT ? round->fuze : order->fuze};
    struct fire_error error;
    if (round->delivery != DELIVERY_ARC || !fire_from_afar(context, &afar, &error))
        fire_drop_bomb(context, order->kind, order->x, order->z);
}

static void begin_mission(struct serial_context *context, const struct fire_order *order)
{
    const struct fire_mission_order mission = {.x = order->x,
                                               .z = order->z,
                                               .bearing_rad = order->bearing_rad,
                                               .left_s = order->flight_s,
                                               .gun = order->shooter_slot,
                                               .rounds = order->rounds,
                                               .munition = order->kind,
                                               .fuze = order->fuze,
                                               .adjusted = order->adjusted != 0,
                                               .high = order->high != 0};
    fire_mission_begin(context, &mission);
}

/* A single shot of a vehicle. */
static void fire_as_ordered(struct serial_context *context, const struct fire_order *order)
{
    const struct kind *kinds = context->step->world->kinds;
    uint32_t shooter = order->shooter_slot;
    uint16_t own = kinds[context->moved->entities.row[shooter].kind].munition;
    uint16_t munition = order->kind == KIND_NONE ? own : order->kind;
    if (order->target_slot != SLOT_NONE) {
        fire_shoot(context, shooter, order->target_slot, order->kind);
    } else if (munition != KIND_NONE && kinds[munition].delivery == DELIVERY_ARC) {
        const struct vec3 point = {order->x, kinematics_ground(context->step, order->x, order->z),
                                   order->z};
        fire_shell_at(context, shooter, point, munition, order->high != 0,
                      order->fuze == FUZE_COUNT ? kinds[munition].fuze : order->fuze);
    } else {
        fire_shoot_at(context, shooter, order->x, order->z, order->kind);
    }
}

void scenario_fires_run(struct serial_context *context)
{
    const struct world *world = context->step->world;
    struct state_head *head = context->moved->head;
    const struct entities *m = &context->moved->entities;
    while (head->fire_cursor < world->counts.fires &&
           world->fires[head->fire_cursor].tick <= head->tick) {
        const struct fire_order *order = &world->fires[head->fire_cursor++];
        uint32_t shooter = order->shooter_slot, target = order->target_slot;
        /* An initial slot still holds its first entity if the id is slot + 1. */
        if (shooter != SLOT_NONE &&
            (!entities_alive(m, shooter, shooter + 1) || m->row[shooter].state != ENTITY_ACTIVE))
            continue;
        if (target != SLOT_NONE && !entities_alive(m, target, target + 1))
            continue;
        if (shooter != SLOT_NONE)
            serial_context_stop(context, shooter, context->step->tick);
        if (order->rounds > 0)
            begin_mission(context, order);
        else if (shooter == SLOT_NONE)
            fire_from_nowhere(context, order);
        else
            fire_as_ordered(context, order);
    }
}
