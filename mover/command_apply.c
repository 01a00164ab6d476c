/* Players' and programs' commands: applied once, in the order of the rings, each with its answer.
 */
#include "mover/command_apply.h"

#include "mover/motion/driver_controls.h"
#include "mover/motion/kinematics.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/spawn.h"
#include "mover/weapon/turret.h"
#include "world/terrain/gridsquare.h"

#include <stddef.h>
#include <string.h>

#define COMMAND_APPLY_A_FRAME 256 /* of one ring; the rest waits for the next frame */
#define TIME_SCALE_MIN        0.01
#define TIME_SCALE_MAX        100.0

/* What driving and letting go change. */
#define DRIVEN_COLUMNS                                                                             \
    (COLUMN_BIT(throttle) | COLUMN_BIT(steer) | COLUMN_BIT(climb) | COLUMN_BIT(brake) |            \
     COLUMN_BIT(traverse) | COLUMN_BIT(elevate) | COLUMN_BIT(flags) | COLUMN_BIT(driver) |         \
     COLUMN_BIT(until_tick))

static bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static uint32_t vehicle_row(const struct serial_context *context, uint32_t id)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = entities_find(m, context->moved->head->used, id);
    return row != SLOT_NONE && m->behaviour[row] == BEHAVIOUR_FLIGHT ? SLOT_NONE : row;
}

static enum command_result set_behaviour(struct serial_context *context, uint32_t row,
                                         uint8_t behaviour)
{
    struct entities *m = &context->moved->entities;
    uint8_t from = m->behaviour[row];
    if (from == behaviour)
        return COMMAND_DONE;
    struct event *event = serial_context_intent(context, EVENT_AGENT);
    if (event) {
        event->agent = (struct event_agent){serial_context_party(context, row), from, behaviour,
                                            REASON_COMMAND};
        context->moved->head->tally.agent_changes++;
    }
    serial_context_changes(context, row, COLUMN_BIT(behaviour) | COLUMN_BIT(trigger));
    m->behaviour[row] = behaviour;
    m->trigger[row] = 0;
    return COMMAND_DONE;
}

/* Has another source this vehicle for itself? */
static bool taken(const struct serial_context *context, uint32_t row, const struct command *command)
{
    const struct entities *m = &context->moved->entities;
    return m->behaviour[row] == BEHAVIOUR_DRIVEN && m->driver[row] != 0 &&
           m->driver[row] != command->source;
}

static enum command_result drive(struct serial_context *context, const struct command *command)
{
    struct entities *m = &context->moved->entities;
    const double *v = command->value;
    uint32_t row = vehicle_row(context, command->entity);
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (m->state[row] != ENTITY_ACTIVE)
        return COMMAND_CANNOT;
    if (taken(context, row, command))
        return COMMAND_TAKEN;
    for (int i = 0; i < 5; i++) {
        if (!within(v[i], -1.0, 1.0))
            return COMMAND_OUT_OF_RANGE;
    }
    if (!within(v[5], 0.0, 1.0) || command->force >= GEAR_COUNT ||
        command->amount > COMMAND_LEASE_MAX)
        return COMMAND_OUT_OF_RANGE;
    serial_context_changes(context, row, DRIVEN_COLUMNS);
    m->throttle[row] = (float)v[0];
    m->steer[row] = (float)v[1];
    m->climb[row] = (float)v[2];
    m->traverse[row] = (float)v[3];
    m->elevate[row] = (float)v[4];
    m->brake[row] = (float)v[5];
    m->flags[row] = (uint8_t)((m->flags[row] & ~ENTITY_GEAR_MASK) | (unsigned)command->force
                                                                        << ENTITY_GEAR_SHIFT);
    m->driver[row] = command->amount > 0 ? command->source : 0;
    m->until_tick[row] = (uint32_t)(context->step->tick + command->amount);
    return set_behaviour(context, row, BEHAVIOUR_DRIVEN);
}

static enum command_result release(struct serial_context *context, const struct command *command)
{
    struct entities *m = &context->moved->entities;
    uint32_t row = vehicle_row(context, command->entity);
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (m->behaviour[row] != BEHAVIOUR_DRIVEN)
        return COMMAND_CANNOT;
    if (command->amount == 0 && taken(context, row, command))
        return COMMAND_TAKEN;
    serial_context_changes(context, row, DRIVEN_COLUMNS);
    driver_controls_release(m, row);
    m->until_tick[row] = (uint32_t)context->step->tick; /* no longer its driver's */
    return set_behaviour(context, row, m->order[row]);
}

static enum command_result fire(struct serial_context *context, const struct command *command)
{
    const struct world *world = context->step->world;
    struct entities *m = &context->moved->entities;
    if (command->entity == 0) {
        if (command->kind >= world->counts.kinds ||
            world->kinds[command->kind].domain != DOMAIN_MUNITION)
            return COMMAND_NO_SUCH_KIND;
        if (!within(command->value[0], 0.0, WORLD_SIDE_M) ||
            !within(command->value[1], 0.0, WORLD_SIDE_M))
            return COMMAND_OUT_OF_RANGE;
        return fire_drop_bomb(context, command->kind, command->value[0], command->value[1])
                   ? COMMAND_DONE
                   : COMMAND_TABLE_FULL;
    }
    uint32_t row = vehicle_row(context, command->entity);
    uint32_t target = SLOT_NONE;
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (command->target != 0) {
        target = vehicle_row(context, command->target);
        if (target == SLOT_NONE)
            return COMMAND_NO_SUCH_ENTITY;
        if (target == row)
            return COMMAND_OUT_OF_RANGE;
    }
    if (taken(context, row, command))
        return COMMAND_TAKEN;
    if (m->state[row] != ENTITY_ACTIVE || context->step->tick < m->reload_tick[row] ||
        m->rounds[row] == 0 || world->kinds[m->kind[row]].munition == KIND_NONE)
        return COMMAND_CANNOT;
    if (target != SLOT_NONE) { /* the gunner lays his gun on it, if it is not yet */
        m->target_slot[row] = target;
        m->target_id[row] = m->id[target];
        serial_context_changes(context, row, COLUMN_BIT(target_slot) | COLUMN_BIT(target_id));
        if (target >= context->step->committed->head->used ||
            !turret_bears(context->step, m, row, target))
            return COMMAND_CANNOT;
    }
    return fire_shoot(context, row, target, KIND_NONE) ? COMMAND_DONE : COMMAND_TABLE_FULL;
}

/* Do as many vehicles as may stand within COMMAND_SPOT_M of this place already? Bodies that are
 * spawned into one another cost the collider the square of their number. */
static bool crowded(const struct serial_context *context, struct vec3 place)
{
    const struct entities *m = &context->moved->entities;
    uint32_t near = 0;
    for (uint32_t row = 0; row < context->moved->head->used && near < COMMAND_SPOT_VEHICLES;
         row++) {
        if (m->state[row] == ENTITY_FREE || m->behaviour[row] == BEHAVIOUR_FLIGHT)
            continue;
        struct vec3 away = vec3_sub(entities_position(m, row), place);
        near += vec3_dot(away, away) < COMMAND_SPOT_M * COMMAND_SPOT_M;
    }
    return near == COMMAND_SPOT_VEHICLES;
}

static enum command_result spawn(struct serial_context *context, const struct command *command,
                                 uint32_t *made)
{
    const struct world *world = context->step->world;
    struct entities *m = &context->moved->entities;
    const double *v = command->value;
    if (command->kind >= world->counts.kinds || world->kinds[command->kind].domain > DOMAIN_AIR)
        return COMMAND_NO_SUCH_KIND;
    const struct kind *kind = &world->kinds[command->kind];
    if (!within(v[0], 0.0, WORLD_SIDE_M) || !within(v[1], 0.0, WORLD_SIDE_M) ||
        !within(v[2], 0.0, 20000.0) || !within(v[3], -TWO_PI, TWO_PI) ||
        !within(v[4], 0.0, 10000.0) || command->force >= FORCE_COUNT ||
        command->amount > BEHAVIOUR_PATROL)
        return COMMAND_OUT_OF_RANGE;
    bool water = cover_is_water(terrain_cover(&world->terrain, v[0], v[1]));
    if (kind->domain != DOMAIN_AIR && (kind->domain == DOMAIN_SEA) != water)
        return COMMAND_OUT_OF_RANGE;
    struct vec3 position = {v[0], kinematics_ground(context->step, v[0], v[1]), v[1]};
    if (kind->domain == DOMAIN_AIR)
        position.y += v[2] > 0.0 ? v[2] : kind->cruise_altitude_m;
    if (crowded(context, position))
        return COMMAND_CANNOT;
    uint32_t row = spawn_entity(context, command->kind, (uint8_t)command->force);
    if (row == SLOT_NONE)
        return COMMAND_TABLE_FULL;
    double sine, cosine;
    maths_sincos(v[3], &sine, &cosine);
    entities_set_position(m, row, position);
    entities_set_velocity(m, row, (struct vec3){v[4] * sine, 0.0, -v[4] * cosine});
    m->heading[row] = maths_wrap_turn(v[3]);
    m->behaviour[row] = m->order[row] = (uint8_t)command->amount;
    m->goal_x[row] = v[0];
    m->goal_z[row] = v[1];
    *made = m->id[row];
    return COMMAND_DONE;
}

static enum command_result control(struct serial_context *context, const struct command *command)
{
    struct state_head *head = context->moved->head;
    switch ((enum command_type)command->type) {
    case COMMAND_PAUSE:
        head->paused = 1;
        head->steps_left = 0;
        return COMMAND_DONE;
    case COMMAND_RESUME:
        head->paused = 0;
        head->steps_left = 0;
        return COMMAND_DONE;
    case COMMAND_STEP:
        if (!head->paused)
            return COMMAND_CANNOT;
        if (command->amount < 1 || command->amount > 1000000)
            return COMMAND_OUT_OF_RANGE;
        head->steps_left = command->amount < UINT32_MAX - head->steps_left
                               ? head->steps_left + command->amount
                               : UINT32_MAX;
        return COMMAND_DONE;
    case COMMAND_SCALE:
        if (!within(command->value[0], TIME_SCALE_MIN, TIME_SCALE_MAX))
            return COMMAND_OUT_OF_RANGE;
        head->time_scale = command->value[0];
        return COMMAND_DONE;
    case COMMAND_QUIT:
        head->quit = 1;
        return COMMAND_DONE;
    default:
        return COMMAND_UNKNOWN;
    }
}

static enum command_result apply(struct serial_context *context, const struct command *command,
                                 uint32_t *entity)
{
    uint32_t row;
    *entity = command->entity;
    switch ((enum command_type)command->type) {
    case COMMAND_DRIVE:
        return drive(context, command);
    case COMMAND_RELEASE:
        return release(context, command);
    case COMMAND_FIRE:
        return fire(context, command);
    case COMMAND_SPAWN:
        return spawn(context, command, entity);
    case COMMAND_REMOVE:
        row = vehicle_row(context, command->entity);
        if (row == SLOT_NONE)
            return COMMAND_NO_SUCH_ENTITY;
        spawn_remove(context, row);
        return COMMAND_DONE;
    default:
        return control(context, command);
    }
}

static void put_answer(struct event *event, const struct command *command,
                       const struct state_head *head)
{
    event->command = (struct event_command){
        .source = command->source,
        .sequence = command->source_sequence,
        .type = command->type,
        .given = command->entity,
        .target = command->target,
        .amount = command->amount,
        .kind = command->kind,
        .force = command->force,
        .number = (uint32_t)head->tally.commands,
    };
    memcpy(event->command.value, command->value, sizeof command->value);
}

static void apply_ring(struct serial_context *context, const struct command_source *source,
                       uint32_t ring)
{
    const struct params *params = context->step->world->params;
    struct state_head *head = context->moved->head;
    uint32_t most = params->intents_per_frame < params->events_per_frame ? params->intents_per_frame
                                                                         : params->events_per_frame;
    uint64_t *cursor = &head->command_cursor[ring];
    for (int n = 0; n < COMMAND_APPLY_A_FRAME && *cursor < source->end; n++) {
        /* A copy: the ring's writer must not change it between a check and its use. */
        const struct command command = source->slot[*cursor & (source->slots - 1)];
        /* An answer must have room in the frame, with one more for what the command itself says:
         * one that is taken is always told of, or else it stays in its ring. */
        if (head->intent_count + 2 > most)
            return;
        uint32_t entity = 0;
        enum command_result result = apply(context, &command, &entity);
        struct event *event = serial_context_intent(context, EVENT_COMMAND);
        put_answer(event, &command, head);
        event->command.result = (uint8_t)result;
        event->command.ring = (uint8_t)ring;
        event->command.entity = entity;
        head->tally.commands++;
        ++*cursor;
    }
}

void command_apply_all(struct serial_context *context, const struct command_source *sources)
{
    for (uint32_t ring = 0; ring < COMMAND_RING_COUNT; ring++)
        apply_ring(context, &sources[ring], ring);
}
