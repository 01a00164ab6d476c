/* What each record of another simulator does. Its values may come from a log that anybody has
 * written, so they are checked here whatever the gateway has checked. */
#include "mover/remote_apply.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/remote_motion.h"
#include "mover/query/remote_index.h"
#include "mover/remote_impact.h"
#include "mover/weapon/spawn.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/maths/dead_reckoning.h"
#include "world/maths/rotation.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_clamp.h"
#include "world/world.h"

#define HEIGHT_MOST_M          50000.0
#define SPEED_MOST_MPS         10000.0
#define ACCELERATION_MOST_MPS2 10000.0
#define RATE_MOST_RPS          100.0
#define ANGLE_MOST_RAD         7.0 /* a whole turn either way */

/* An error of place or attitude vanishes in this time [s], a larger one at once. */
#define SMOOTH_S 0.25
#define SNAP_M   50.0
#define SNAP_RAD 1.0

/* Smaller ones are left. */
#define SAME_M   1e-6
#define SAME_RAD 1e-6

#define TURN_UNIT_RAD (PI / 32768.0) /* of turret and gun */

#define FLOWN_MOST_M 200000.0 /* no munition flies further */

/* A munition of a struck target flies there at least this fast, as a slow one would fall short:
 * simulators also tell the speed of the target, or nothing that a munition can have [m/s]. */
#define STRIKE_LEAST_MPS 100.0

#define BODY_SHARE 0.4 /* of length and width, to both sides: a hull tapers to its ends */

/* A munition that strikes the ground is sent down from so high above it, and this steeply. */
#define DROP_M        2.0
#define STEEP_SINE    0.1
#define NEAR_GROUND_M REMOTE_CLAMP_M

/* --- values ------------------------------------------------------------------------------------*/

static bool within(double value, double most)
{
    return value >= -most && value <= most; /* false for NaN */
}

static bool all_within(const float value[3], double most)
{
    return within((double)value[0], most) && within((double)value[1], most) &&
           within((double)value[2], most);
}

static struct vec3 vec3_of(const float value[3])
{
    return (struct vec3){(double)value[0], (double)value[1], (double)value[2]};
}

static struct vec3 place_of(const struct remote_record *record)
{
    return (struct vec3){record->position[0], record->position[1], record->position[2]};
}

static bool in_world(const struct world *world, struct vec3 place)
{
    return world_holds(world, place.x, place.z) && within(place.y, HEIGHT_MOST_M);
}

static bool track_is_good(const struct world *world, const struct remote_record *record)
{
    return record->remote != 0 && in_world(world, place_of(record)) &&
           all_within(record->velocity, SPEED_MOST_MPS) &&
           all_within(record->acceleration, ACCELERATION_MOST_MPS2) &&
           all_within(record->rates, RATE_MOST_RPS) &&
           all_within(record->attitude, ANGLE_MOST_RAD) && record->force < FORCE_COUNT &&
           record->damage < DAMAGE_COUNT && record->model >= DEAD_RECKONING_STATIC &&
           record->model <= DEAD_RECKONING_FVB;
}

static const struct kind *kind_of(const struct serial_context *context, uint16_t kind)
{
    const struct world *world = context->step->world;
    return kind < world->counts.kinds ? &world->kinds[kind] : NULL;
}

/* --- rows --------------------------------------------------------------------------------------*/

/* Writes a field if it changes: a row that is written wakes, and most records of an entity at rest
 * say what is known. */
#define PUT(context, row, name, value)                                                             \
    do {                                                                                           \
        if ((context)->moved->entities.row[row].name != (value))                                   \
            table_set_##name(&(context)->writer, row, value);                                      \
    } while (0)

/* Returns the row of a remote entity, SLOT_NONE when there is none. The sender may have seen where
 * it is. */
static uint32_t find(const struct serial_context *context, uint64_t remote, uint32_t slot)
{
    const struct entities *m = &context->moved->entities;
    uint32_t used = context->moved->head->used;
    if (slot < used && remote_is(m, slot) && m->row[slot].driver == remote)
        return slot;
    return remote_index_find(context->remotes, m, used, remote);
}

static void set_state(struct serial_context *context, uint32_t row,
                      const struct remote_record *record)
{
    const struct entities *m = &context->moved->entities;
    bool flies = m->row[row].behaviour == BEHAVIOUR_FLIGHT;
    bool destroyed = record->damage == DAMAGE_DESTROYED && !flies;
    if (record->damage > m->row[row].damage)
        PUT(context, row, changed_tick, (uint32_t)context->step->tick);
    PUT(context, row, damage, record->damage);
    PUT(context, row, state, destroyed ? ENTITY_WRECK : ENTITY_ACTIVE);
    PUT(context, row, kind, record->kind);
    PUT(context, row, force, record->force);
    PUT(context, row, turret, (float)(record->turret * TURN_UNIT_RAD));
    PUT(context, row, gun, (float)(record->gun * TURN_UNIT_RAD));
}

static void set_marking(struct serial_context *context, uint32_t row,
                        const struct remote_record *record)
{
    uint32_t part[3];
    memcpy(part, record->marking, sizeof part);
    PUT(context, row, leg, part[0]);
    PUT(context, row, jolt_tick, part[1]);
    PUT(context, row, target_slot, part[2]);
}

/* clamped: it moves on our ground. */
static void set_motion(struct serial_context *context, uint32_t row,
                       const struct remote_record *record, bool clamped)
{
    bool moves = record->model != DEAD_RECKONING_STATIC;
    const struct vec3 none = {0.0, 0.0, 0.0};
    uint32_t flags = clamped ? REMOTE_FLAG_CLAMPED << REMOTE_FLAGS_SHIFT : 0;
    PUT(context, row, order_arg, record->model | flags);
    PUT(context, row, seen_tick, (uint32_t)context->step->tick);
    const struct vec3 velocity = moves ? vec3_of(record->velocity) : none;
    const struct vec3 spin = moves ? vec3_of(record->rates) : none;
    PUT(context, row, vx, velocity.x);
    PUT(context, row, vy, velocity.y);
    PUT(context, row, vz, velocity.z);
    PUT(context, row, spin_x, spin.x);
    PUT(context, row, spin_y, spin.y);
    PUT(context, row, spin_z, spin.z);
    PUT(context, row, climb, moves ? record->acceleration[0] : 0.0f);
    PUT(context, row, traverse, moves ? record->acceleration[1] : 0.0f);
    PUT(context, row, elevate, moves ? record->acceleration[2] : 0.0f);
}

/* Sets the velocity and the rates by which errors vanish within so many seconds. */
static void set_errors(struct serial_context *context, uint32_t row, struct vec3 drift,
                       struct vec3 turn, double time_s)
{
    double share = 1.0 / time_s;
    PUT(context, row, goal_x, drift.x * share);
    PUT(context, row, ease, (float)(drift.y * share));
    PUT(context, row, goal_z, drift.z * share);
    PUT(context, row, steer, (float)(turn.x * share));
    PUT(context, row, brake, (float)(turn.y * share));
    PUT(context, row, dodge, (float)(turn.z * share));
}

/* Returns the rotation that leads from one attitude to another, as an axis times the angle [rad].
 */
static struct vec3 turn_between(struct quat from, struct quat to)
{
    struct quat q = rotation_product(to, rotation_inverse(from));
    double sign = q.w < 0.0 ? -1.0 : 1.0;
    struct vec3 axis = {sign * q.x, sign * q.y, sign * q.z};
    double sine = vec3_length(axis);
    double angle = 2.0 * maths_atan2(sine, sign * q.w);
    return sine > 1e-12 ? vec3_scale(axis, angle / sine) : (struct vec3){0.0, 0.0, 0.0};
}

static void set_attitude(struct serial_context *context, uint32_t row, struct quat attitude)
{
    double heading, pitch, roll;
    rotation_angles(attitude, &heading, &pitch, &roll);
    PUT(context, row, heading, heading);
    PUT(context, row, pitch, pitch);
    PUT(context, row, roll, roll);
}

/* Leads the row to a place and an attitude: a new one at once, another by what the collider
 * corrects at the end of the next frames. In a paused world that is the frame in which it goes on,
 * so that the row does not drive the way of the pause in a quarter of a second. */
static void set_place(struct serial_context *context, uint32_t row,
                      const struct remote_record *record, struct vec3 to, bool is_new)
{
    const struct entities *m = &context->moved->entities;
    const struct vec3 none = {0.0, 0.0, 0.0};
    double dt_s = context->step->dt_s;
    struct quat attitude = rotation_of((double)record->attitude[0], (double)record->attitude[1],
                                       (double)record->attitude[2]);
    if (is_new) {
        table_set_position(&context->writer, row, to);
        set_attitude(context, row, attitude);
        return;
    }
    struct quat now = rotation_of(m->row[row].heading, m->row[row].pitch, m->row[row].roll);
    struct vec3 drift = vec3_sub(to, entities_position(m, row)), turn = turn_between(now, attitude);
    bool at_once =
        context->moved->head->paused || vec3_length(drift) > SNAP_M || vec3_length(turn) > SNAP_RAD;
    uint32_t frames = at_once ? 1 : (uint32_t)maths_max(1.0, SMOOTH_S / dt_s + 0.5);
    if (vec3_length(drift) < SAME_M)
        drift = none;
    if (vec3_length(turn) < SAME_RAD)
        turn = none;
    set_errors(context, row, drift, turn, frames * dt_s);
    if (vec3_dot(drift, drift) > 0.0 || vec3_dot(turn, turn) > 0.0)
        PUT(context, row, until_tick, (uint32_t)context->step->tick + frames - 1);
}

/* --- the records -------------------------------------------------------------------------------*/

static enum remote_refusal new_row(struct serial_context *context,
                                   const struct remote_record *record, uint32_t *row)
{
    if (context->remotes->count >= context->step->world->params->remotes_max)
        return REMOTE_TOO_MANY;
    *row = spawn_entity(context, record->kind, record->force);
    if (*row == SLOT_NONE)
        return REMOTE_NO_ROW;
    if (context->moved->entities.row[*row].behaviour != BEHAVIOUR_FLIGHT)
        table_set_behaviour(&context->writer, *row, BEHAVIOUR_REMOTE);
    table_set_order(&context->writer, *row, BEHAVIOUR_REMOTE);
    table_set_driver(&context->writer, *row, record->remote);
    remote_index_add(context->remotes, *row, record->remote);
    return REMOTE_TAKEN;
}

static enum remote_refusal track(struct serial_context *context, const struct remote_record *record)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kind = kind_of(context, record->kind);
    if (!track_is_good(context->step->world, record))
        return REMOTE_UNKNOWN;
    if (!kind || kind->domain > DOMAIN_MUNITION)
        return REMOTE_NO_KIND;
    uint32_t row = find(context, record->remote, record->slot);
    bool is_new = row == SLOT_NONE;
    if (!is_new && remote_is_munition(m, row) != (kind->domain == DOMAIN_MUNITION))
        return REMOTE_NO_KIND; /* no vehicle becomes a munition */
    if (is_new) {
        enum remote_refusal refusal = new_row(context, record, &row);
        if (refusal != REMOTE_TAKEN)
            return refusal;
    } else if (vec3_length(vec3_sub(place_of(record), entities_position(m, row))) > REMOTE_JUMP_M) {
        return REMOTE_JUMPS;
    }
    struct vec3 to = place_of(record);
    /* A place high above the ground, such as on a bridge, stays so until the next record. */
    bool clamped =
        record->flags & REMOTE_FLAG_CLAMPED && kind->domain == DOMAIN_LAND &&
        ground_clamp(&context->step->world->terrain, context->step->craters, REMOTE_CLAMP_M, &to);
    set_state(context, row, record);
    set_marking(context, row, record);
    set_motion(context, row, record, clamped);
    set_place(context, row, record, to, is_new);
    return REMOTE_TAKEN;
}

static enum remote_refusal lost(struct serial_context *context, const struct remote_record *record)
{
    uint32_t row = find(context, record->remote, record->slot);
    if (record->remote == 0 || row == SLOT_NONE)
        return REMOTE_NOBODY;
    remote_index_remove(context->remotes, row, record->remote);
    spawn_remove(context, row);
    return REMOTE_TAKEN;
}

/* Returns the row of our own vehicle of this id, SLOT_NONE when there is none. */
static uint32_t own_row(const struct serial_context *context, uint32_t id)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = id == 0 ? SLOT_NONE : entities_find(m, context->moved->head->used, id);
    return row == SLOT_NONE || m->row[row].behaviour == BEHAVIOUR_FLIGHT || remote_is(m, row)
               ? SLOT_NONE
               : row;
}

/* Returns the row of the entity that fired, SLOT_NONE when nobody here is known to have. */
static uint32_t firer_row(const struct serial_context *context, const struct remote_record *record)
{
    return record->remote == 0 ? SLOT_NONE : find(context, record->remote, record->slot);
}

static bool shot_is_good(const struct serial_context *context, const struct remote_record *record)
{
    const struct kind *kind = kind_of(context, record->kind);
    return kind && kind->domain == DOMAIN_MUNITION;
}

/* A shot is seen and alarms its target. Where its round comes down is its owner's to say. */
static enum remote_refusal tell_fire(struct serial_context *context,
                                     const struct remote_record *record)
{
    const struct entities *m = &context->moved->entities;
    if (!in_world(context->step->world, place_of(record)))
        return REMOTE_UNKNOWN;
    if (!shot_is_good(context, record))
        return REMOTE_NO_KIND;
    uint32_t firer = firer_row(context, record), target = own_row(context, record->entity);
    struct event *event = serial_context_intent(context, EVENT_FIRE);
    if (event) {
        event->fire.munition = (struct event_party){.kind = record->kind};
        event->fire.shooter = (struct event_party){.kind = KIND_NONE};
        event->fire.target = (struct event_party){.kind = KIND_NONE};
        if (firer != SLOT_NONE)
            event->fire.shooter = serial_context_party(context, firer);
        if (target != SLOT_NONE)
            event->fire.target = serial_context_party(context, target);
        for (int i = 0; i < 3; i++)
            event->fire.point[i] = record->position[i];
    }
    context->moved->head->tally.fires++;
    if (firer != SLOT_NONE && target != SLOT_NONE)
        table_set_threat(&context->writer, target, firer, m->row[firer].id);
    return REMOTE_TAKEN;
}

/* How a munition gets from where it appears to what it strikes. */
struct approach {
    struct vec3 from, velocity;
    bool in_air; /* it bursts at once, where it is */
};

static struct vec3 direction_of(struct vec3 velocity, struct vec3 fallback)
{
    double speed = vec3_length(velocity);
    return speed > 1.0 ? vec3_scale(velocity, 1.0 / speed) : fallback;
}

/* Returns how fast a munition comes of which this velocity is told: at rest means unknown. */
static double strike_speed(const struct kind *round, struct vec3 velocity)
{
    double told = vec3_length(velocity);
    return maths_max(told > 1.0 ? told : round->max_speed_mps, STRIKE_LEAST_MPS);
}

/* Returns the place of the body's box that is nearest to a point: the sender's vehicle may be
 * larger than ours, and what flies past the hull would strike the ground behind it. Body axes:
 * ahead, up, right. */
static struct vec3 within_body(const struct kind *vehicle, struct vec3 point)
{
    double ahead = BODY_SHARE * vehicle->length_m, right = BODY_SHARE * vehicle->width_m;
    return (struct vec3){maths_clamp(point.x, -ahead, ahead),
                         maths_clamp(point.y, 0.2 * vehicle->height_m, 0.8 * vehicle->height_m),
                         maths_clamp(point.z, -right, right)};
}

/* It flies at the vehicle through the point of its body that was struck. */
static struct approach approach_vehicle(const struct serial_context *context,
                                        const struct remote_record *record, uint32_t target)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *vehicle = &context->step->world->kinds[m->row[target].kind];
    const struct kind *round = &context->step->world->kinds[record->kind];
    struct mat3 turn = rotation_matrix(
        rotation_of(m->row[target].heading, m->row[target].pitch, m->row[target].roll));
    double reach = maths_max(vehicle->bound_m, vehicle->radius_m);
    struct vec3 at = entities_position(m, target);
    struct vec3 point = vec3_add(at, rotation_apply(&turn, within_body(vehicle, place_of(record))));
    struct vec3 velocity = vec3_of(record->velocity);
    struct vec3 along = direction_of(velocity, (struct vec3){0.0, -1.0, 0.0});
    struct vec3 from = vec3_sub(point, vec3_scale(along, 2.0 * reach + round->radius_m + DROP_M));
    double ground = kinematics_ground(context->step, from.x, from.z);
    if (from.y < ground + round->radius_m + DROP_M) {
        from.y = ground + round->radius_m + DROP_M;
        struct vec3 way = vec3_sub(point, from);
        along = vec3_scale(way, 1.0 / maths_max(vec3_length(way), 1e-3));
    }
    return (struct approach){.from = from,
                             .velocity = vec3_scale(along, strike_speed(round, velocity))};
}

/* It comes down on the ground there, or bursts above it. */
static struct approach approach_place(const struct serial_context *context,
                                      const struct remote_record *record)
{
    const struct kind *round = &context->step->world->kinds[record->kind];
    struct vec3 point = place_of(record), velocity = vec3_of(record->velocity);
    double ground = kinematics_ground(context->step, point.x, point.z);
    bool in_air = record->model == REMOTE_BURST_IN_AIR && point.y > ground + round->radius_m;
    if (in_air || point.y > ground + NEAR_GROUND_M)
        return (struct approach){.from = point, .in_air = true};
    const struct vec3 down = {0.0, -1.0, 0.0};
    struct vec3 along = direction_of(velocity, down);
    if (along.y > -STEEP_SINE)
        along = down;
    point.y = ground;
    return (struct approach){
        .from = vec3_sub(point, vec3_scale(along, (DROP_M + round->radius_m) / -along.y)),
        .velocity = vec3_scale(along, strike_speed(round, velocity))};
}

/* Returns when a munition was born that has flown this far at the mean of its speeds at the muzzle
 * and now: what it still penetrates goes by that (collider/response/explosion.c). */
static uint32_t born_of(const struct step_context *step, const struct kind *round, double speed_mps,
                        double flown_m)
{
    double mean = 0.5 * (round->max_speed_mps + speed_mps);
    double frames = mean > 1.0 ? maths_max(flown_m, 0.0) / (mean * step->dt_s) : 0.0;
    return (uint32_t)step->tick - (uint32_t)(maths_min(frames, 1e6) + 0.5);
}

/* A munition of another simulator detonates: one of ours appears in front of what it strikes, and
 * does there what our rules say. */
static enum remote_refusal detonates(struct serial_context *context,
                                     const struct remote_record *record)
{
    const struct entities *m = &context->moved->entities;
    const struct table_writer *writer = &context->writer;
    uint32_t target = own_row(context, record->entity);
    struct vec3 place = place_of(record);
    const double side_m = context->step->world->terrain.squares.world_m;
    if (!all_within(record->velocity, SPEED_MOST_MPS) ||
        !within((double)record->flown_m, FLOWN_MOST_M) || !within(place.x, 2.0 * side_m) ||
        !within(place.y, HEIGHT_MOST_M) || !within(place.z, 2.0 * side_m) ||
        (record->entity == 0 && !in_world(context->step->world, place)))
        return REMOTE_UNKNOWN;
    if (!shot_is_good(context, record))
        return REMOTE_NO_KIND;
    if (record->entity != 0 && target == SLOT_NONE)
        return REMOTE_NOBODY;
    struct approach approach = target != SLOT_NONE ? approach_vehicle(context, record, target)
                                                   : approach_place(context, record);
    uint32_t row = spawn_entity(context, record->kind, FORCE_NEUTRAL);
    if (row == SLOT_NONE)
        return REMOTE_NO_ROW;
    table_set_position(writer, row, approach.from);
    table_set_velocity(writer, row, approach.velocity);
    table_set_heading(writer, row, maths_heading(approach.velocity.x, approach.velocity.z));
    table_set_order(writer, row, BEHAVIOUR_REMOTE); /* its detonation is told as another's */
    table_set_born_tick(writer, row,
                        born_of(context->step, &context->step->world->kinds[record->kind],
                                vec3_length(approach.velocity), (double)record->flown_m));
    if (approach.in_air)
        table_set_until_tick(writer, row, (uint32_t)context->step->tick);
    uint32_t firer = firer_row(context, record);
    if (firer != SLOT_NONE) {
        table_set_owner_slot(writer, row, firer);
        table_set_owner_id(writer, row, m->row[firer].id);
    }
    return REMOTE_TAKEN;
}

static enum remote_refusal struck(struct serial_context *context,
                                  const struct remote_record *record)
{
    uint32_t target = own_row(context, record->entity);
    if (record->kind != KIND_NONE)
        return detonates(context, record);
    return target == SLOT_NONE ? REMOTE_NOBODY
                               : remote_impact(context, record, target, firer_row(context, record));
}

static enum remote_refusal apply_one(struct serial_context *context,
                                     const struct remote_record *record)
{
    switch ((enum remote_type)record->type) {
    case REMOTE_TRACK:
        return track(context, record);
    case REMOTE_LOST:
        return lost(context, record);
    case REMOTE_STRUCK:
        return struck(context, record);
    case REMOTE_FIRE:
        return tell_fire(context, record);
    case REMOTE_OWNER:
        return REMOTE_TAKEN; /* the gateway reads it from the ring */
    case REMOTE_TYPE_END:
        break;
    }
    return REMOTE_UNKNOWN;
}

/* --- their event -------------------------------------------------------------------------------*/

/* Begins the event of the records that follow one another. */
static void begin(struct serial_context *context, struct remote_inputs *inputs)
{
    inputs->event = serial_context_intent(context, EVENT_INPUT);
    if (inputs->event) {
        inputs->event->input.first = context->moved->head->command_cursor[inputs->ring];
        inputs->event->input.ring = inputs->ring;
    }
}

bool remote_apply(struct serial_context *context, struct remote_inputs *inputs,
                  const struct command *slot)
{
    struct remote_record record = remote_record_of(slot);
    /* The records' own event needs room, and so does what the record may tell. */
    if (context->moved->head->intent_count + 2 > inputs->most || inputs->taken >= REMOTE_APPLY_MOST)
        return false;
    if (!inputs->event)
        begin(context, inputs);
    struct event_input *told = &inputs->event->input;
    enum remote_refusal refusal = apply_one(context, &record);
    inputs->taken++;
    told->hash = remote_record_hash(slot, told->hash);
    told->count++;
    if (refusal != REMOTE_TAKEN && told->refused++ == 0) {
        told->remote = record.remote;
        told->because = (uint32_t)refusal;
    }
    return true;
}

/* --- the time scale ----------------------------------------------------------------------------*/

static void scale_row(struct serial_context *context, uint32_t row, double ratio)
{
    const struct entities *m = &context->moved->entities;
    struct vec3 acceleration = vec3_limited(vec3_scale(remote_acceleration(m, row), ratio * ratio),
                                            ACCELERATION_MOST_MPS2);
    struct vec3 spin = {m->row[row].spin_x, m->row[row].spin_y, m->row[row].spin_z};
    table_set_velocity(&context->writer, row,
                       vec3_limited(vec3_scale(entities_velocity(m, row), ratio), SPEED_MOST_MPS));
    table_set_spin(&context->writer, row, vec3_limited(vec3_scale(spin, ratio), RATE_MOST_RPS));
    table_set_climb(&context->writer, row, (float)acceleration.x);
    table_set_traverse(&context->writer, row, (float)acceleration.y);
    table_set_elevate(&context->writer, row, (float)acceleration.z);
}

void remote_apply_scale(struct serial_context *context, double ratio)
{
    const struct entities *m = &context->moved->entities;
    for (uint32_t row = 0; row < context->moved->head->used; row++) {
        if (remote_is(m, row) && !remote_motion_stands(m, row))
            scale_row(context, row, ratio);
    }
}
