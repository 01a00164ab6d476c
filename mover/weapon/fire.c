/* Fires shots. */
#include "mover/weapon/fire.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/missile.h"
#include "mover/weapon/firing_table.h"
#include "mover/weapon/spawn.h"
#include "mover/weapon/turret.h"
#include "world/entity/disabled.h"
#include "world/entity/event.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <stddef.h>

#define DROP_HEIGHT_M  300.0 /* height above the point from which bombs fall */
#define LEAST_BY_SPEED 0.5   /* growth of the range by that of the speed; real shells have more */
#define MOVING_SHARE   0.5   /* of its top speed, at which a shooter aims as badly as it can */

/* The sum of four uniforms is nearly normal. */
double fire_normal(const struct serial_context *context, uint32_t entity,
                   enum random_purpose purpose)
{
    uint64_t bits =
        random_u64(context->step->world->params->seed, context->step->tick, entity, purpose);
    double sum = 0.0;
    for (int i = 0; i < 4; i++)
        sum += (double)(bits >> (16 * i) & 0xffff) * (1.0 / 65536.0);
    return (sum - 2.0) * 1.7320508075688772;
}

static double spread(const struct serial_context *context, uint32_t row,
                     enum random_purpose purpose)
{
    return fire_normal(context, context->moved->entities.row[row].id, purpose);
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

static bool can_fire(const struct entities *m, const struct kind *kind, uint32_t shooter)
{
    return m->row[shooter].rounds > 0 && !disabled_gun(kind, m, shooter);
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

/* Takes a round from the shooter, and alarms the row target unless it is SLOT_NONE. */
static void tell_shot(struct serial_context *context, struct event_fire *event, uint32_t row,
                      uint32_t shooter, uint32_t target)
{
    const struct entities *m = &context->moved->entities;
    const struct table_writer *writer = &context->writer;
    const struct kind *kind = &context->step->world->kinds[m->row[shooter].kind];
    event->shooter = serial_context_party(context, shooter);
    table_set_owner_slot(writer, row, shooter);
    table_set_owner_id(writer, row, m->row[shooter].id);
    table_set_rounds(writer, shooter, m->row[shooter].rounds - 1);
    table_set_reload_tick(
        writer, shooter,
        (uint32_t)(context->step->tick + (uint64_t)(kind->reload_s / context->step->dt_s)));
    if (target != SLOT_NONE) {
        event->target = serial_context_party(context, target);
        table_set_target(writer, row, target, m->row[target].id);
        table_set_threat(writer, target, shooter, m->row[shooter].id);
    }
}

/* --- along arcs --------------------------------------------------------------------------------*/

bool fire_solve(const struct step_context *step, struct vec3 muzzle, uint16_t munition,
                struct vec3 point, bool high, struct firing_arc_solution *solution)
{
    const struct firing_arc_aim aim = {
        .muzzle = muzzle, .point = point, .wind = step->wind, .high = high};
    return firing_arc_solve(&step->firing_tables[munition].arc, &aim, solution);
}

/* A howitzer's error along the range is that of the muzzle's speed. Across it is that of its aim.
 */
static struct fire_error round_error(const struct serial_context *context, uint32_t row,
                                     double azimuth_rad)
{
    return (struct fire_error){FIRE_RANGE_ERROR * spread(context, row, RANDOM_ROUND_RANGE),
                               azimuth_rad * spread(context, row, RANDOM_ROUND_AZIMUTH)};
}

/* The velocity at the muzzle for a solution, with these errors. */
static struct vec3 departure(const struct kind *round, const struct firing_arc_solution *solution,
                             struct fire_error error)
{
    double share = error.range / maths_max(solution->by_speed, LEAST_BY_SPEED);
    struct vec3 direction =
        firing_arc_unit(solution->azimuth_rad + error.azimuth_rad, solution->elevation_rad);
    return vec3_scale(direction, round->max_speed_mps * (1.0 + share));
}

/* Sets the fuze of a round that strikes after left_s at this velocity. */
static void set_fuze(struct serial_context *context, uint32_t row, enum fuze fuze, double left_s,
                     struct vec3 fall)
{
    table_set_flags(&context->writer, row, (uint8_t)fuze);
    if (fuze != FUZE_AIR)
        return;
    double burst_s = left_s - FIRING_ARC_BURST_M / maths_max(-fall.y, 1.0);
    table_set_until_tick(&context->writer, row,
                         (uint32_t)(context->step->tick +
                                    (uint64_t)(maths_max(burst_s, 0.0) / context->step->dt_s)));
}

bool fire_shell(struct serial_context *context, uint32_t shooter, const struct fire_shell *shell,
                struct fire_error *error)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds;
    const struct kind *kind = &kinds[m->row[shooter].kind], *round = &kinds[shell->munition];
    uint32_t row = can_fire(m, kind, shooter)
                       ? new_munition(context, shell->munition, m->row[shooter].force)
                       : SLOT_NONE;
    if (row == SLOT_NONE)
        return false;
    double across = standard_error(round, kind, entities_velocity(m, shooter));
    *error = round_error(context, row, across);
    error->range += shell->mean.range;
    error->azimuth_rad += shell->mean.azimuth_rad;
    struct vec3 velocity = departure(round, shell->solution, *error);
    double clear = (kind->radius_m + round->radius_m + 0.5) / vec3_length(velocity);
    struct vec3 position =
        vec3_add(turret_muzzle(context->step, m, shooter), vec3_scale(velocity, clear));
    struct event_fire *event = send_munition(context, row, position, velocity);
    tell_shot(context, event, row, shooter, SLOT_NONE);
    set_fuze(context, row, (enum fuze)shell->fuze, shell->solution->flight_s,
             shell->solution->fall);
    return true;
}

bool fire_from_afar(struct serial_context *context, const struct fire_afar *afar,
                    struct fire_error *error)
{
    const struct step_context *step = context->step;
    const struct kind *round = &step->world->kinds[afar->munition];
    struct vec3 away = vec3_scale(firing_arc_unit(afar->bearing_rad, 0.0), FIRE_AFAR_M);
    struct vec3 at = vec3_add(afar->point, away);
    struct firing_arc_solution solution;
    if (!fire_solve(step, at, afar->munition, afar->point, afar->high, &solution))
        return false;
    uint32_t row = new_munition(context, afar->munition, afar->force);
    if (row == SLOT_NONE)
        return false;
    *error = (struct fire_error){0.0, 0.0};
    if (afar->errs) {
        *error = round_error(context, row, round->dispersion_rad);
        error->range += afar->mean.range;
        error->azimuth_rad += afar->mean.azimuth_rad;
    }
    struct vec3 velocity = departure(round, &solution, *error);
    double flown = maths_max(solution.flight_s - afar->left_s, 0.0) / step->dt_s;
    firing_arc_follow(round, step->wind, (unsigned)(flown + 0.5), step->dt_s, &at, &velocity);
    send_munition(context, row, at, velocity);
    set_fuze(context, row, (enum fuze)afar->fuze, maths_min(afar->left_s, solution.flight_s),
             solution.fall);
    return true;
}

bool fire_shell_at(struct serial_context *context, uint32_t shooter, struct vec3 point,
                   uint16_t munition, bool high, uint8_t fuze)
{
    const struct step_context *step = context->step;
    struct firing_arc_solution solution;
    struct fire_error error;
    struct vec3 muzzle = turret_muzzle(step, &context->moved->entities, shooter);
    const struct fire_shell shell = {.solution = &solution, .munition = munition, .fuze = fuze};
    return fire_solve(step, muzzle, munition, point, high, &solution) &&
           fire_shell(context, shooter, &shell, &error);
}

/* --- along the barrel --------------------------------------------------------------------------*/

/* Makes the munition and the event. point: where to aim instead of at a target; NULL: none. */
static bool launch(struct serial_context *context, uint32_t shooter, uint32_t target,
                   const struct vec3 *point, uint16_t munition)
{
    const struct entities *m = &context->moved->entities;
    const struct world *world = context->step->world;
    const struct kind *kind = &world->kinds[m->row[shooter].kind];
    if (munition == KIND_NONE)
        munition = target != SLOT_NONE ? kind_munition_at(kind, &world->kinds[m->row[target].kind])
                                       : kind->munition;
    if (munition == KIND_NONE || !can_fire(m, kind, shooter))
        return false;
    const struct kind *round = &world->kinds[munition];
    if (round->delivery == DELIVERY_ARC && (point || target != SLOT_NONE))
        return fire_shell_at(context, shooter,
                             point ? *point : step_context_position(context->step, m, target),
                             munition, false, round->fuze);
    uint32_t row = new_munition(context, munition, m->row[shooter].force);
    if (row == SLOT_NONE)
        return false;
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
    tell_shot(context, event, row, shooter, target);
    table_set_flags(&context->writer, row, round->fuze);
    return true;
}

static uint16_t munition_of(const struct serial_context *context, uint32_t shooter,
                            uint16_t munition)
{
    const struct kind *kinds = context->step->world->kinds;
    return munition == KIND_NONE ? kinds[context->moved->entities.row[shooter].kind].munition
                                 : munition;
}

/* An aircraft releases a bomb with its own velocity. */
static bool release(struct serial_context *context, uint32_t shooter, uint32_t target,
                    uint16_t munition)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds;
    const struct kind *kind = &kinds[m->row[shooter].kind], *round = &kinds[munition];
    uint32_t row = m->row[shooter].rounds > 0
                       ? new_munition(context, munition, m->row[shooter].force)
                       : SLOT_NONE;
    if (row == SLOT_NONE)
        return false;
    struct vec3 at = entities_position(m, shooter);
    at.y -= kind->radius_m + round->radius_m + 0.5;
    struct event_fire *event = send_munition(context, row, at, entities_velocity(m, shooter));
    tell_shot(context, event, row, shooter, target);
    table_set_flags(&context->writer, row, round->fuze);
    return true;
}

/* Returns true if the shooter releases the munition instead of firing it. */
static bool releases(const struct serial_context *context, uint32_t shooter, uint16_t munition)
{
    const struct kind *kinds = context->step->world->kinds;
    munition = munition_of(context, shooter, munition);
    return munition != KIND_NONE && kinds[munition].delivery == DELIVERY_DROP &&
           kinds[context->moved->entities.row[shooter].kind].domain == DOMAIN_AIR;
}

bool fire_shoot(struct serial_context *context, uint32_t shooter, uint32_t target,
                uint16_t munition)
{
    if (releases(context, shooter, munition))
        return release(context, shooter, target, munition_of(context, shooter, munition));
    return launch(context, shooter, target, NULL, munition);
}

bool fire_shoot_at(struct serial_context *context, uint32_t shooter, double x, double z,
                   uint16_t munition)
{
    const struct vec3 point = {x, kinematics_ground(context->step, x, z), z};
    if (releases(context, shooter, munition))
        return release(context, shooter, SLOT_NONE, munition_of(context, shooter, munition));
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
