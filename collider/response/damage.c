/* Energy becomes damage (thesis rows 26, 27, 30). The damage of a body adds up until its kind's
 * resistance_j is reached. A fixed object is damaged by the hardest single impact, as in figure
 * 8. */
#include "collider/response/damage.h"

#include "collider/response/explosion.h"
#include "collider/response/ground_event.h"
#include "world/checksum.h"
#include "world/entity/kind.h"
#include "world/entity/overturned.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <string.h>

/* ENTITY_FLAG_CHASSIS in each of eight flags. */
#define CHASSIS_OF_EIGHT (ENTITY_FLAG_CHASSIS * UINT64_C(0x0101010101010101))

static enum damage level(double share)
{
    if (share >= 1.0)
        return DAMAGE_DESTROYED;
    if (share >= DAMAGE_SHARE_HIGH)
        return DAMAGE_HIGH;
    if (share >= DAMAGE_SHARE_MED)
        return DAMAGE_MED;
    return share >= DAMAGE_SHARE_LOW ? DAMAGE_LOW : DAMAGE_NONE;
}

static void set_damage(struct response_context *context, uint32_t row, enum damage damage)
{
    table_set_damage(&context->writer, row, (uint8_t)damage);
    table_set_changed_tick(&context->writer, row, (uint32_t)context->next->head->tick);
}

/* Returns true if the row was no wreck before. */
static bool wreck(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    if (e->row[row].state != ENTITY_ACTIVE || remote_is(e, row))
        return false;
    table_set_state(&context->writer, row, ENTITY_WRECK);
    table_set_flags(&context->writer, row,
                    e->row[row].flags & (uint8_t) ~(ENTITY_FLAG_CHASSIS | ENTITY_FLAG_DISARMED));
    table_set_throttle(&context->writer, row, 0.0f);
    table_set_behaviour(&context->writer, row, BEHAVIOUR_IDLE);
    table_set_order(&context->writer, row, BEHAVIOUR_IDLE);
    table_set_until_tick(&context->writer, row,
                         0); /* it is not at rest (mover/motion/ground/wreck.h) */
    table_set_harm_j(&context->writer, row, maths_max(e->row[row].harm_j, kind->resistance_j));
    set_damage(context, row, DAMAGE_DESTROYED);
    context->next->head->tally.destroyed++;
    return true;
}

void damage_destroy(struct response_context *context, uint32_t row, double time)
{
    const struct kind *kind = &context->world->kinds[context->next->entities.row[row].kind];
    if (!wreck(context, row) || !(kind->explosive_kg > 0.0))
        return;
    const struct charge charge = {.point = path_at(&context->path[row], time),
                                  .time = time,
                                  .explosive_kg = kind->explosive_kg,
                                  .row = row};
    explosion_charge(context, &charge);
}

void damage_overturn(struct response_context *context, uint32_t row)
{
    wreck(context, row);
}

/* Tells that a land vehicle took harm from the ground. It closed by the velocity that it has lost
 * in the frame. The mover tells of ships and aircraft when they touch the ground. */
static void tell_ground(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (context->world->kinds[e->row[row].kind].domain != DOMAIN_LAND)
        return;
    struct vec3 at = entities_position(e, row);
    struct vec3 before = entities_velocity(body_motion_committed(context->motion, row), row);
    ground_event_write(
        context, row,
        &(struct ground_strike){
            .at = at,
            .velocity = before,
            .normal =
                terrain_normal(&context->world->terrain, context->input.detect.craters, at.x, at.z),
            .closing_mps = vec3_length(vec3_sub(before, entities_velocity(e, row))),
            .time = 1.0,
            .response = e->row[row].state == ENTITY_WRECK ? RESPONSE_DESTROYED : RESPONSE_STOP,
        });
}

/* Returns true if the mover has told by an event what harmed the row: a body of another simulator
 * (mover/remote_impact.h). */
static bool told_by_mover(const struct response_context *context, uint32_t row)
{
    const struct event_writer *events = &context->events;
    uint32_t id = context->next->entities.row[row].id;
    for (uint64_t i = 0; i < events->count; i++) {
        const struct event *event = &events->slot[(events->first + i) & (events->slots - 1)];
        if (event->type == EVENT_COLLISION && event->collision.remote &&
            event->collision.a.id == id)
            return true;
    }
    return false;
}

/* The mover has added the harm of a hard landing to harm_j (mover/motion/chassis.h): it becomes
 * damage. */
static void fall(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    enum damage damage = level(e->row[row].harm_j / kind->resistance_j);
    if (e->row[row].state != ENTITY_ACTIVE || damage <= e->row[row].damage)
        return;
    if (damage == DAMAGE_DESTROYED)
        wreck(context, row);
    else
        set_damage(context, row, damage);
    if (!told_by_mover(context, row))
        tell_ground(context, row);
}

static void overturn_or_fall(struct response_context *context, uint32_t row)
{
    const struct entity *e = &context->next->entities.row[row];
    if (!(e->flags & ENTITY_FLAG_CHASSIS))
        return;
    if (e->state != ENTITY_ACTIVE || !overturned(e->pitch, e->roll)) {
        fall(context, row);
        return;
    }
    damage_overturn(context, row);
    tell_ground(context, row);
}

void damage_overturned(struct response_context *context)
{
    const uint64_t *responses = context->writer.written;
    for (uint32_t w = 0; w * 64 < context->next->head->used; w++) {
        for (uint64_t left = context->sprung[w] | responses[w]; left != 0; left &= left - 1)
            overturn_or_fall(context, w * 64 + (uint32_t)__builtin_ctzll(left));
    }
}

void damage_row(struct response_context *context, uint32_t row, double joules, double time)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    if (e->row[row].state != ENTITY_ACTIVE || !(joules > 0.0) || remote_is(e, row))
        return; /* the owner of a remote entity decides what a hit does to it */
    table_set_harm_j(&context->writer, row, e->row[row].harm_j + joules);
    enum damage damage = level(e->row[row].harm_j / kind->resistance_j);
    if (damage == DAMAGE_DESTROYED)
        damage_destroy(context, row, time);
    else if (damage > e->row[row].damage)
        set_damage(context, row, damage);
}

static enum damage damage_fixed(struct response_context *context, uint32_t object,
                                enum damage damage)
{
    uint8_t *now = &context->next->fixed_damage[object];
    if (damage > *now) {
        *now = (uint8_t)damage;
        context->next->head->tally.fixed_damaged++;
    }
    return fallen_damage(*now);
}

/* Returns a kind's own constant if it has one, or the scenario's. */
static double own_or(double own, double scenario)
{
    return own > 0.0 ? own : scenario;
}

double damage_high_share(const struct response_context *context, const struct kind *kind)
{
    return own_or(kind->damage_high, context->world->params->collision.damage_high);
}

enum damage damage_fixed_object(struct response_context *context, uint32_t object, double joules)
{
    const struct world *world = context->world;
    const struct collision_params *limits = &world->params->collision;
    const struct kind *kind = &world->kinds[world->fixed[object].kind];
    double share = joules / kind->resistance_j;
    enum damage damage = DAMAGE_NONE;
    if (share >= damage_high_share(context, kind))
        damage = DAMAGE_HIGH;
    else if (share >= own_or(kind->damage_med, limits->damage_med))
        damage = DAMAGE_MED;
    else if (share >= own_or(kind->damage_low, limits->damage_low))
        damage = DAMAGE_LOW;
    return damage_fixed(context, object, damage);
}

void damage_fell_object(struct response_context *context, uint32_t object, double joules,
                        struct vec3 away)
{
    const struct world *world = context->world;
    uint8_t *stored = &context->next->fixed_damage[object];
    bool stood = *stored < DAMAGE_HIGH;
    if (damage_fixed_object(context, object, joules) == DAMAGE_HIGH && stood)
        *stored = fallen_towards(&world->kinds[world->fixed[object].kind], away.x, away.z);
}

enum damage damage_fixed_mass(struct response_context *context, uint32_t object, double mass_kg)
{
    const struct collision_params *limits = &context->world->params->collision;
    enum damage damage = DAMAGE_NONE;
    if (mass_kg >= limits->mass_c1_kg)
        damage = DAMAGE_HIGH;
    else if (mass_kg >= limits->mass_c2_kg)
        damage = DAMAGE_MED;
    else if (mass_kg >= limits->mass_c3_kg)
        damage = DAMAGE_LOW;
    return damage_fixed(context, object, damage);
}
