/* Fires shots. */
#include "mover/weapon/fire.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/missile.h"
#include "mover/weapon/spawn.h"
#include "mover/weapon/turret.h"
#include "world/entity/event.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <stddef.h>

#define DROP_HEIGHT_M 300.0 /* height above the point from which bombs fall */
#define MOVING_SHARE  0.5   /* of its top speed, at which a shooter aims as badly as it can */

/* A random number with standard deviation 1: the sum of four uniforms is nearly normal. */
static double spread(const struct serial_context *context, uint32_t row,
                     enum random_purpose purpose)
{
    uint64_t bits = random_u64(context->step->world->params->seed, context->step->tick,
                               context->moved->entities.id[row], purpose);
    double sum = 0.0;
    for (int i = 0; i < 4; i++)
        sum += (double)(bits >> (16 * i) & 0xffff) * (1.0 / 65536.0);
    return (sum - 2.0) * 1.7320508075688772;
}

static struct vec3 dispersed(const struct serial_context *context, uint32_t row,
                             struct vec3 direction, double error_rad)
{
    double level = sqrt(direction.x * direction.x + direction.z * direction.z);
    double heading = maths_heading(direction.x, direction.z) +
                     error_rad * spread(context, row, RANDOM_DISPERSION_AZIMUTH);
    double pitch = maths_atan2(direction.y, level) +
                   error_rad * spread(context, row, RANDOM_DISPERSION_ELEVATION);
    double sine, cosine, sine_pitch, cosine_pitch;
    maths_sincos(heading, &sine, &cosine);
    maths_sincos(pitch, &sine_pitch, &cosine_pitch);
    return (struct vec3){sine * cosine_pitch, sine_pitch, -cosine * cosine_pitch};
}

/* Returns the standard error of a shooter's aim [rad]: it grows with its speed. */
static double standard_error(const struct kind *round, const struct kind *shooter,
                             struct vec3 velocity)
{
    double extra = maths_max(0.0, round->dispersion_moving_rad - round->dispersion_rad);
    double share = vec3_length(velocity) / maths_max(MOVING_SHARE * shooter->max_speed_mps, 1e-9);
    return round->dispersion_rad + extra * maths_min(share, 1.0);
}

/* A row for a munition. SLOT_NONE: the frame has no room for the row or its event. */
static uint32_t new_munition(struct serial_context *context, uint16_t kind, uint8_t force)
{
    if (context->moved->head->intent_count >= context->step->world->params->intents_per_frame)
        return SLOT_NONE;
    return spawn_entity(context, kind, force);
}

/* Sends the munition on its path, and returns the event, to which the caller adds the parties. */
static struct event_fire *send_munition(struct serial_context *context, uint32_t row,
                                        struct vec3 position, struct vec3 velocity)
{
    const struct table_writer *writer = &context->writer;
    double level = sqrt(velocity.x * velocity.x + velocity.z * velocity.z);
    table_set_position(writer, row, position);
    table_set_velocity(writer, row, velocity);
    table_set_heading(writer, row, maths_heading(velocity.x, velocity.z));
    table_set_pitch(writer, row, maths_atan2(velocity.y, level));
    struct event_fire *event = &serial_context_intent(context, EVENT_FIRE)->fire;
    event->munition = serial_context_party(context, row);
    event->point[0] = position.x;
    event->point[1] = position.y;
    event->point[2] = position.z;
    context->moved->head->tally.fires++;
    return event;
}

/* Makes the munition and the event, takes a round from the shooter, and alarms the row target
 * unless it is SLOT_NONE. point: where to aim instead of at a target; NULL: none. */
static bool launch(struct serial_context *context, uint32_t shooter, uint32_t target,
                   const struct vec3 *point, uint16_t munition)
{
    const struct entities *m = &context->moved->entities;
    const struct table_writer *writer = &context->writer;
    const struct world *world = context->step->world;
    const struct kind *kind = &world->kinds[m->kind[shooter]];
    if (munition == KIND_NONE)
        munition = kind->munition;
    if (munition == KIND_NONE || m->rounds[shooter] == 0)
        return false;
    uint32_t row = new_munition(context, munition, m->force[shooter]);
    if (row == SLOT_NONE)
        return false;
    const struct kind *round = &world->kinds[munition];
    struct vec3 position = turret_muzzle(context->step, m, shooter);
    struct vec3 direction = point ? turret_lead_point(context->step, position, munition, *point)
                            : target != SLOT_NONE
                                ? turret_lead(context->step, position, munition, m, target)
                                : turret_barrel(m, shooter);
    direction = dispersed(context, row, direction,
                          standard_error(round, kind, entities_velocity(m, shooter)));
    double clear = kind->radius_m + round->radius_m + 0.5;
    struct vec3 muzzle = vec3_add(position, vec3_scale(direction, clear));
    double speed = round->max_speed_mps;
    if (round->guidance == GUIDANCE_HOMING) { /* its motor starts now */
        double carried = maths_max(0.0, vec3_dot(direction, entities_velocity(m, shooter)));
        speed = maths_min(speed, MISSILE_LAUNCH_SHARE * speed + carried);
    }
    struct event_fire *event = send_munition(context, row, muzzle, vec3_scale(direction, speed));
    event->shooter = serial_context_party(context, shooter);
    table_set_owner_slot(writer, row, shooter);
    table_set_owner_id(writer, row, m->id[shooter]);
    table_set_rounds(writer, shooter, m->rounds[shooter] - 1);
    table_set_reload_tick(
        writer, shooter,
        (uint32_t)(context->step->tick + (uint64_t)(kind->reload_s / context->step->dt_s)));
    if (target != SLOT_NONE) {
        event->target = serial_context_party(context, target);
        table_set_target(writer, row, target, m->id[target]);
        table_set_threat(writer, target, shooter, m->id[shooter]);
    }
    return true;
}

bool fire_shoot(struct serial_context *context, uint32_t shooter, uint32_t target,
                uint16_t munition)
{
    return launch(context, shooter, target, NULL, munition);
}

bool fire_shoot_at(struct serial_context *context, uint32_t shooter, double x, double z,
                   uint16_t munition)
{
    const struct vec3 point = {x, kinematics_ground(context->step, x, z), z};
    return launch(context, shooter, SLOT_NONE, &point, munition);
}

bool fire_drop_bomb(struct serial_context *context, uint16_t munition, double x, double z)
{
    uint32_t row = new_munition(context, munition, FORCE_NEUTRAL);
    if (row == SLOT_NONE)
        return false;
    struct vec3 position = {x, kinematics_ground(context->step, x, z) + DROP_HEIGHT_M, z};
    double speed = context->step->world->kinds[munition].max_speed_mps;
    send_munition(context, row, position, (struct vec3){0.0, -speed, 0.0});
    return true;
}
