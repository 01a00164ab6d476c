/* Commands: one function for each type, and the loop over the rings. */
#include "mover/command_apply.h"

#include "mover/agent/driver_controls.h"
#include "mover/motion/kinematics.h"
#include "mover/query/remote_index.h"
#include "mover/remote_apply.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/spawn.h"
#include "mover/weapon/turret.h"
#include "world/entity/event.h"
#include "world/params.h"
#include "world/start_height.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/rest_pose.h"
#include "world/world.h"

#include <string.h>

#define COMMANDS_A_FRAME 256 /* of one ring; further commands wait for the next frame */
#define TIME_SCALE_MIN   0.01
#define TIME_SCALE_MAX   100.0
#define STEPS_MAX        1000000u

/* Applies a command. entity is the command's own, or becomes the id of the entity that it makes. */
typedef enum command_result apply(struct serial_context *context, const struct command *command,
                                  uint32_t *entity);

static bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

/* --- vehicles ----------------------------------------------------------------------------------*/

static uint32_t vehicle_row(const struct serial_context *context, uint32_t id)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = entities_find(m, context->moved->head->used, id);
    return row != SLOT_NONE && m->row[row].behaviour == BEHAVIOUR_FLIGHT ? SLOT_NONE : row;
}

static enum command_result set_behaviour(struct serial_context *context, uint32_t row,
                                         uint8_t behaviour)
{
    uint8_t from = context->moved->entities.row[row].behaviour;
    if (from == behaviour)
        return COMMAND_DONE;
    struct event *event = serial_context_intent(context, EVENT_AGENT);
    if (event) {
        event->agent = (struct event_agent){serial_context_party(context, row), from, behaviour,
                                            REASON_COMMAND};
        context->moved->head->tally.agent_changes++;
    }
    table_set_behaviour(&context->writer, row, behaviour);
    table_set_trigger(&context->writer, row, 0);
    return COMMAND_DONE;
}

/* Returns true if another source alone drives this vehicle. */
static bool taken(const struct serial_context *context, uint32_t row, const struct command *command)
{
    const struct entities *m = &context->moved->entities;
    return m->row[row].behaviour == BEHAVIOUR_DRIVEN && m->row[row].driver != 0 &&
           m->row[row].driver != command->source;
}

static enum command_result drive(struct serial_context *context, const struct command *command,
                                 uint32_t *entity)
{
    const struct entities *m = &context->moved->entities;
    const struct table_writer *writer = &context->writer;
    const double *v = command->value;
    uint32_t row = vehicle_row(context, *entity);
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (remote_is(m, row))
        return COMMAND_REMOTE;
    if (m->row[row].state != ENTITY_ACTIVE)
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
    serial_context_stop(context, row, context->step->tick - 1);
    if (m->row[row].behaviour != BEHAVIOUR_DRIVEN)
        table_set_dodge(writer, row, 0.0f); /* wheels straight, engine warm */
    table_set_throttle(writer, row, (float)v[0]);
    table_set_steer(writer, row, (float)v[1]);
    table_set_climb(writer, row, (float)v[2]);
    table_set_traverse(writer, row, (float)v[3]);
    table_set_elevate(writer, row, (float)v[4]);
    table_set_brake(writer, row, (float)v[5]);
    table_set_flags(writer, row,
                    (uint8_t)((m->row[row].flags & ~ENTITY_GEAR_MASK) | (unsigned)command->force
                                                                            << ENTITY_GEAR_SHIFT));
    table_set_driver(writer, row, command->amount > 0 ? command->source : 0);
    table_set_until_tick(writer, row, (uint32_t)(context->step->tick + command->amount));
    return set_behaviour(context, row, BEHAVIOUR_DRIVEN);
}

static enum command_result release(struct serial_context *context, const struct command *command,
                                   uint32_t *entity)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = vehicle_row(context, *entity);
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (remote_is(m, row))
        return COMMAND_REMOTE;
    if (m->row[row].behaviour != BEHAVIOUR_DRIVEN)
        return COMMAND_CANNOT;
    if (command->amount == 0 && taken(context, row, command))
        return COMMAND_TAKEN;
    table_note(&context->writer, row);
    driver_controls_release(m, row);
    /* The driver's lease is over. */
    table_set_until_tick(&context->writer, row, (uint32_t)context->step->tick);
    return set_behaviour(context, row, m->row[row].order);
}

static enum command_result drop_bomb(struct serial_context *context, const struct command *command)
{
    const struct world *world = context->step->world;
    if (command->kind >= world->counts.kinds ||
        world->kinds[command->kind].domain != DOMAIN_MUNITION)
        return COMMAND_NO_SUCH_KIND;
    if (!world_holds(context->step->world, command->value[0], command->value[1]))
        return COMMAND_OUT_OF_RANGE;
    return fire_drop_bomb(context, command->kind, command->value[0], command->value[1])
               ? COMMAND_DONE
               : COMMAND_TABLE_FULL;
}

static enum command_result fire(struct serial_context *context, const struct command *command,
                                uint32_t *entity)
{
    const struct step_context *step = context->step;
    const struct entities *m = &context->moved->entities;
    if (*entity == 0)
        return drop_bomb(context, command);
    uint32_t row = vehicle_row(context, *entity), target = SLOT_NONE;
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (remote_is(m, row))
        return COMMAND_REMOTE;
    if (command->target != 0) {
        target = vehicle_row(context, command->target);
        if (target == SLOT_NONE)
            return COMMAND_NO_SUCH_ENTITY;
        if (target == row)
            return COMMAND_OUT_OF_RANGE;
    }
    if (taken(context, row, command))
        return COMMAND_TAKEN;
    if (m->row[row].state != ENTITY_ACTIVE || step->tick < m->row[row].reload_tick ||
        m->row[row].rounds == 0 || step->world->kinds[m->row[row].kind].munition == KIND_NONE)
        return COMMAND_CANNOT;
    serial_context_stop(context, row, context->step->tick - 1);
    if (target != SLOT_NONE) { /* the gun turns to the target even if it cannot fire yet */
        table_set_target(&context->writer, row, target, m->row[target].id);
        if (target >= step->committed->head->used || !turret_bears(step, m, row, target))
            return COMMAND_CANNOT;
    }
    return fire_shoot(context, row, target, KIND_NONE) ? COMMAND_DONE : COMMAND_TABLE_FULL;
}

/* Returns true if there are COMMAND_SPOT_VEHICLES vehicles within COMMAND_SPOT_M of this place. The
 * collider's time for bodies that are spawned into one another grows with the square of their
 * number. */
static bool crowded(const struct serial_context *context, struct vec3 place)
{
    const struct entities *m = &context->moved->entities;
    uint32_t count = 0;
    for (uint32_t row = 0; row < context->moved->head->used && count < COMMAND_SPOT_VEHICLES;
         row++) {
        if (m->row[row].state == ENTITY_FREE || m->row[row].behaviour == BEHAVIOUR_FLIGHT)
            continue;
        struct vec3 away = vec3_sub(entities_position(m, row), place);
        count += vec3_dot(away, away) < COMMAND_SPOT_M * COMMAND_SPOT_M;
    }
    return count == COMMAND_SPOT_VEHICLES;
}

/* A land vehicle stands on the ground as it will in the frames to come. */
static void set_on_ground(const struct serial_context *context, uint32_t row)
{
    const struct step_context *step = context->step;
    const struct entities *m = &context->moved->entities;
    struct rest_pose pose =
        rest_pose_of(&step->world->terrain, step->craters, &step->world->kinds[m->row[row].kind],
                     m->row[row].x, m->row[row].z, m->row[row].heading);
    table_set_position(&context->writer, row,
                       (struct vec3){m->row[row].x, pose.y_m, m->row[row].z});
    table_set_pitch(&context->writer, row, pose.pitch_rad);
    table_set_roll(&context->writer, row, pose.roll_rad);
}

/* Returns the height over the ground at which an aircraft is spawned. */
static double height_of(const struct world *world, const struct kind *kind,
                        const struct command *command)
{
    const double *v = command->value;
    double altitude = v[2] > 0.0 ? v[2] : kind->cruise_altitude_m;
    const struct start_flight flight = {v[0], v[1], v[3], v[4], altitude};
    bool holds = command->amount == BEHAVIOUR_HOLD;
    return kind_hovers(kind) || holds ? altitude : start_height(&world->terrain, kind, &flight);
}

static enum command_result spawn(struct serial_context *context, const struct command *command,
                                 uint32_t *entity)
{
    const struct world *world = context->step->world;
    const struct table_writer *writer = &context->writer;
    const double *v = command->value;
    if (command->kind >= world->counts.kinds || world->kinds[command->kind].domain > DOMAIN_AIR)
        return COMMAND_NO_SUCH_KIND;
    const struct kind *kind = &world->kinds[command->kind];
    if (!world_holds(context->step->world, v[0], v[1]) || !within(v[2], 0.0, 20000.0) ||
        !within(v[3], -TWO_PI, TWO_PI) || !within(v[4], 0.0, 10000.0) ||
        command->force >= FORCE_COUNT || command->amount > BEHAVIOUR_PATROL)
        return COMMAND_OUT_OF_RANGE;
    bool water = cover_is_water(terrain_cover(&world->terrain, v[0], v[1]));
    if (kind->domain != DOMAIN_AIR && (kind->domain == DOMAIN_SEA) != water)
        return COMMAND_OUT_OF_RANGE;
    struct vec3 position = {v[0], kinematics_ground(context->step, v[0], v[1]), v[1]};
    if (kind->domain == DOMAIN_AIR)
        position.y += height_of(world, kind, command);
    if (crowded(context, position))
        return COMMAND_CANNOT;
    uint32_t row = spawn_entity(context, command->kind, (uint8_t)command->force);
    if (row == SLOT_NONE)
        return COMMAND_TABLE_FULL;
    double sine, cosine;
    maths_sincos(v[3], &sine, &cosine);
    table_set_position(writer, row, position);
    table_set_velocity(writer, row, (struct vec3){v[4] * sine, 0.0, -v[4] * cosine});
    table_set_heading(writer, row, maths_wrap_turn(v[3]));
    if (kind->domain == DOMAIN_LAND)
        set_on_ground(context, row);
    table_set_behaviour(writer, row, (uint8_t)command->amount);
    table_set_order(writer, row, (uint8_t)command->amount);
    table_set_goal_x(writer, row, v[0]);
    table_set_goal_z(writer, row, v[1]);
    *entity = context->moved->entities.row[row].id;
    return COMMAND_DONE;
}

static enum command_result remove_vehicle(struct serial_context *context,
                                          const struct command *command, uint32_t *entity)
{
    (void)command;
    uint32_t row = vehicle_row(context, *entity);
    if (row == SLOT_NONE)
        return COMMAND_NO_SUCH_ENTITY;
    if (remote_is(&context->moved->entities, row))
        return COMMAND_REMOTE;
    spawn_remove(context, row);
    return COMMAND_DONE;
}

/* --- the run -----------------------------------------------------------------------------------*/

static enum command_result pause(struct serial_context *context, const struct command *command,
                                 uint32_t *entity)
{
    (void)entity;
    context->moved->head->paused = command->type == COMMAND_PAUSE;
    context->moved->head->steps_left = 0;
    return COMMAND_DONE;
}

static enum command_result step(struct serial_context *context, const struct command *command,
                                uint32_t *entity)
{
    struct state_head *head = context->moved->head;
    (void)entity;
    if (!head->paused)
        return COMMAND_CANNOT;
    if (command->amount < 1 || command->amount > STEPS_MAX)
        return COMMAND_OUT_OF_RANGE;
    head->steps_left = command->amount < UINT32_MAX - head->steps_left
                           ? head->steps_left + command->amount
                           : UINT32_MAX;
    return COMMAND_DONE;
}

static enum command_result scale(struct serial_context *context, const struct command *command,
                                 uint32_t *entity)
{
    (void)entity;
    double *time_scale = &context->moved->head->time_scale;
    if (!within(command->value[0], TIME_SCALE_MIN, TIME_SCALE_MAX))
        return COMMAND_OUT_OF_RANGE;
    if (context->step->world->params->remotes_max > 0 && *time_scale > 0.0)
        remote_apply_scale(context, *time_scale / command->value[0]);
    *time_scale = command->value[0];
    return COMMAND_DONE;
}

static enum command_result quit(struct serial_context *context, const struct command *command,
                                uint32_t *entity)
{
    (void)command;
    (void)entity;
    context->moved->head->quit = 1;
    return COMMAND_DONE;
}

/* --- all of them -------------------------------------------------------------------------------*/

static const struct {
    enum command_type type;
    apply *apply;
} registry[] = {
    {COMMAND_PAUSE, pause}, {COMMAND_RESUME, pause}, {COMMAND_STEP, step},
    {COMMAND_SCALE, scale}, {COMMAND_DRIVE, drive},  {COMMAND_RELEASE, release},
    {COMMAND_FIRE, fire},   {COMMAND_SPAWN, spawn},  {COMMAND_REMOVE, remove_vehicle},
    {COMMAND_QUIT, quit},
};
#define ROWS (sizeof registry / sizeof *registry)
_Static_assert(ROWS == COMMAND_TYPE_COUNT - 1, "a row for each type but COMMAND_NONE");

static enum command_result apply_one(struct serial_context *context, const struct command *command,
                                     uint32_t *entity)
{
    for (size_t row = 0; row < ROWS; row++) {
        if (registry[row].type == command->type)
            return registry[row].apply(context, command, entity);
    }
    return COMMAND_UNKNOWN;
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
    struct remote_inputs inputs = {.most = most, .ring = (uint8_t)ring};
    remote_index_forget(context->remotes);
    for (int n = 0; n < COMMANDS_A_FRAME && *cursor < source->end;) {
        /* A copy, because the ring's writer could change the slot between a check and its use. */
        const struct command command = source->slot[*cursor & (source->slots - 1)];
        if (ring == RING_GATEWAY && remote_is_record(command.type)) {
            if (!remote_apply(context, &inputs, &command))
                return;
            ++*cursor;
            continue;
        }
        remote_index_forget(context->remotes); /* a command may remove a row */
        inputs.event = NULL; /* the records after it have an event of their own, in their order */
        n++;
        /* The answer needs room in the frame, and so does the command's own event. Without room the
         * command stays in its ring, so that every command taken is answered. */
        if (head->intent_count + 2 > most)
            return;
        uint32_t entity = command.entity;
        enum command_result result = apply_one(context, &command, &entity);
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
