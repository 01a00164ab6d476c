/* Rows that move alike are moved by batches, in the lanes of vectors; the others one by one. */
#include "mover/row_block_move.h"

#include "mover/agent/agent.h"
#include "mover/agent/goal.h"
#include "mover/agent/think_schedule.h"
#include "mover/context/cruise_start.h"
#include "mover/motion/air/even_flight.h"
#include "mover/motion/aircraft.h"
#include "mover/motion/chassis.h"
#include "mover/motion/constant_course.h"
#include "mover/motion/ground/landing.h"
#include "mover/motion/ground/wreck.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/projectile.h"
#include "mover/motion/remote_motion.h"
#include "mover/motion/ship.h"
#include "mover/weapon/turret.h"
#include "world/entity/entity.h"
#include "world/world.h"

/* The rows of a block that wait for their batch to fill up. */
struct batches {
    const struct row_block *block;
    uint8_t *motion;                     /* [CHECKSUM_ROWS] how each row moves, or has moved */
    struct ground_vehicle land, stretch; /* moved by one frame, and by a stretch */
    struct aircraft air, air_stretch;
    struct constant_course course;
};

/* Returns true if the row's gun moves, is off its place, or has a target. */
static bool has_gun(const struct entities *m, uint32_t i)
{
    const struct entity *row = &m->row[i];
    return row->turret != 0.0f || row->gun != 0.0f || row->traverse != 0.0f ||
           row->elevate != 0.0f || row->target_id != 0;
}

/* After a vehicle has moved: its agent reacts to a blocked path, and its gun turns. */
static void after_motion(const struct step_context *context, struct batches *batches, uint32_t i,
                         bool blocked)
{
    uint8_t *motion = &batches->motion[i - batches->block->first];
    if (blocked) {
        goal_blocked(context, i);
        *motion = MOTION_AGENT;
    }
    if (*motion == MOTION_COURSE && !has_gun(context->m, i))
        return;
    struct turret_solution solution;
    turret_turn(context, i, &solution);
    turret_hold_fire(context, i, &solution);
}

/* Notes that a row has crossed the edge of the world. */
static void leaves_world(const struct step_context *context, struct batches *batches, uint32_t i)
{
    kinematics_tell(context, i, TRIGGER_LEFT_WORLD);
    batches->motion[i - batches->block->first] = MOTION_AGENT; /* more than its motion changes */
}

/* Moves a land vehicle that is on its springs. */
static void move_chassis(const struct step_context *context, struct batches *batches, uint32_t i,
                         const struct desired_motion *desired)
{
    bool blocked = chassis_move(context, i, desired);
    batches->motion[i - batches->block->first] = MOTION_AGENT; /* more than its motion changes */
    after_motion(context, batches, i, blocked);
}

static void move_land(const struct step_context *context, struct batches *batches)
{
    struct ground_vehicle *land = &batches->land;
    ground_vehicle_move(context, land);
    for (int l = 0; l < land->count; l++) {
        uint32_t i = land->row[l];
        if (land->refused.lane[l]) {
            const struct desired_motion desired = ground_vehicle_desired(land, l);
            chassis_disturb(context, i);
            move_chassis(context, batches, i, &desired);
            continue;
        }
        if (context->m->row[i].flags & ENTITY_FLAG_CHASSIS)
            batches->motion[i - batches->block->first] = MOTION_AGENT;
        after_motion(context, batches, i, land->blocked.lane[l] != 0);
    }
    land->count = 0;
}

/* Empties a batch whose rows have been moved by a stretch. Returns how many were refused, and
 * which; the others cruise. */
static uint32_t take_refused(struct batches *batches, const uint32_t row[LANE_COUNT],
                             const union lane_masks *refuses, int *lanes,
                             uint32_t refused[LANE_COUNT])
{
    uint32_t count = 0;
    for (int l = 0; l < *lanes; l++) {
        if (refuses->lane[l])
            refused[count++] = row[l];
        else
            batches->motion[row[l] - batches->block->first] = MOTION_CRUISE;
    }
    *lanes = 0;
    return count;
}

/* Moves rows by a stretch. Returns how many it refuses, and which. */
static uint32_t stretch_rows(const struct step_context *context, struct batches *batches,
                             uint32_t refused[LANE_COUNT])
{
    struct ground_vehicle *stretch = &batches->stretch;
    ground_vehicle_move(context, stretch);
    return take_refused(batches, stretch->row, &stretch->refused, &stretch->count, refused);
}

/* Moves rows by a stretch, those that it refuses by half of it, and so on, and those that a short
 * one refuses by one frame. */
static void move_stretch(const struct step_context *context, struct batches *batches)
{
    const uint32_t frames = batches->stretch.frames;
    uint32_t refused[LANE_COUNT], count = stretch_rows(context, batches, refused);
    while (count > 0 && batches->stretch.frames / 2 >= CRUISE_START_LEAST) {
        uint32_t half = batches->stretch.frames / 2;
        bool skips =
            half < context->cruise_short && batches->stretch.frames > context->cruise_short;
        ground_vehicle_begin(&batches->stretch, skips ? context->cruise_short : half);
        for (uint32_t n = 0; n < count; n++)
            (void)ground_vehicle_take_held(context, &batches->stretch, refused[n]);
        count = stretch_rows(context, batches, refused);
    }
    for (uint32_t n = 0; n < count; n++) {
        if (ground_vehicle_take_held(context, &batches->land, refused[n]))
            move_land(context, batches);
    }
    if (batches->stretch.frames != frames)
        ground_vehicle_begin(&batches->stretch, frames);
}

/* Notes that a ship or an aircraft is or was on the ground: more than its motion changes. */
static void is_grounded(struct batches *batches, uint32_t i)
{
    batches->motion[i - batches->block->first] = MOTION_AGENT;
}

/* Sets an aircraft down that has touched the ground gently. Returns true if that is an event. */
static bool touches_down(const struct step_context *context, struct batches *batches, int l)
{
    const struct aircraft *air = &batches->air;
    uint32_t i = air->row[l];
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    const struct desired_motion desired = {.driven = air->driven.lane[l] != 0,
                                           .climb_mps = air->climb.lane[l],
                                           .altitude_m = air->altitude.lane[l]};
    double reach_m = maths_max(kind->bound_m, kind->radius_m);
    if (context->m->row[i].y - reach_m > air->ground.lane[l] ||
        !landing_touch(context, i, &desired))
        return false;
    is_grounded(batches, i);
    return context->m->row[i].trigger == TRIGGER_AGROUND;
}

static void move_air(const struct step_context *context, struct batches *batches)
{
    struct aircraft *air = &batches->air;
    aircraft_move(context, air);
    for (int l = 0; l < air->count; l++) {
        bool told = touches_down(context, batches, l);
        after_motion(context, batches, air->row[l], air->blocked.lane[l] != 0);
        if (told)
            kinematics_tell(context, air->row[l], TRIGGER_AGROUND);
        if (air->left.lane[l])
            leaves_world(context, batches, air->row[l]);
    }
    air->count = 0;
}

/* Moves aircraft by a stretch. Returns how many it refuses, and which. */
static uint32_t stretch_aircraft(const struct step_context *context, struct batches *batches,
                                 uint32_t refused[LANE_COUNT])
{
    struct aircraft *stretch = &batches->air_stretch;
    aircraft_move(context, stretch);
    return take_refused(batches, stretch->row, &stretch->refused, &stretch->count, refused);
}

/* Begins an even stretch of an aircraft. Returns false if that is refused. */
static bool flies_evenly(const struct step_context *context, uint32_t i,
                         const struct desired_motion *desired, uint32_t frames,
                         struct batches *batches)
{
    if (!even_flight_begin(context, i, desired, frames))
        return false;
    batches->motion[i - batches->block->first] = MOTION_CRUISE;
    return true;
}

/* Moves aircraft by a stretch, and those that it refuses by one frame; in a crowd by half of it,
 * and so on, first. Elsewhere who cannot fly evenly for half a second has to look out in each turn.
 */
static void move_air_stretch(const struct step_context *context, struct batches *batches)
{
    struct aircraft *stretch = &batches->air_stretch;
    const uint32_t frames = stretch->frames;
    uint32_t refused[LANE_COUNT], count = stretch_aircraft(context, batches, refused);
    struct desired_motion desired;
    while (count > 0 && cruise_start_crowd(context) && stretch->frames / 2 >= CRUISE_START_LEAST) {
        aircraft_begin(stretch, stretch->frames / 2);
        for (uint32_t n = 0; n < count; n++) {
            agent_controls_motion(context, refused[n], &desired);
            if (!flies_evenly(context, refused[n], &desired, stretch->frames, batches))
                (void)aircraft_take(context, stretch, refused[n], &desired);
        }
        count = stretch_aircraft(context, batches, refused);
    }
    for (uint32_t n = 0; n < count; n++) {
        agent_controls_motion(context, refused[n], &desired);
        if (aircraft_take(context, &batches->air, refused[n], &desired))
            move_air(context, batches);
    }
    if (stretch->frames != frames)
        aircraft_begin(stretch, frames);
}

static void move_course(const struct step_context *context, struct batches *batches)
{
    struct constant_course *course = &batches->course;
    constant_course_set_down(context, course);
    for (int l = 0; l < course->count; l++) {
        uint32_t i = course->row[l];
        if (context->m->row[i].flags & ENTITY_FLAG_CHASSIS)
            batches->motion[i - batches->block->first] = MOTION_AGENT;
        if (has_gun(context->m, i))
            turret_turn(context, i, &(struct turret_solution){0});
    }
    course->count = 0;
}

static void move_ship(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired, struct batches *batches)
{
    struct ship_moved moved = ship_move(context, i, desired);
    bool tells = context->m->row[i].trigger == TRIGGER_AGROUND;
    if (moved.touched)
        is_grounded(batches, i);
    after_motion(context, batches, i, moved.blocked);
    if (tells)
        kinematics_tell(context, i, TRIGGER_AGROUND);
}

/* Moves an aircraft that is on the ground. */
static void move_landed(const struct step_context *context, uint32_t i,
                        const struct desired_motion *desired, struct batches *batches)
{
    landing_move(context, i, desired);
    is_grounded(batches, i);
    after_motion(context, batches, i, false);
}

static void move_as_desired(const struct step_context *context, uint32_t i,
                            const struct desired_motion *desired, struct batches *batches)
{
    switch ((enum domain)context->world->kinds[context->m->row[i].kind].domain) {
    case DOMAIN_SEA:
        move_ship(context, i, desired, batches);
        break;
    case DOMAIN_AIR:
        if (landing_is_down(context, i))
            move_landed(context, i, desired, batches);
        else if (aircraft_take(context, &batches->air, i, desired))
            move_air(context, batches);
        break;
    default:
        if (chassis_takes(context, i, desired->driven))
            move_chassis(context, batches, i, desired);
        else if (ground_vehicle_take(context, &batches->land, i, desired))
            move_land(context, batches);
        break;
    }
}

/* Returns true if a land vehicle with an agent moves as a body on its springs. */
static bool is_sprung(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return (entities_spins(m, i) || m->row[i].flags & ENTITY_FLAG_CHASSIS) &&
           chassis_takes(context, i, false);
}

/* Moves a land vehicle by a stretch of so many frames with those that wait for the same. */
static void begin_land_stretch(const struct step_context *context, uint32_t i, uint32_t frames,
                               struct batches *batches)
{
    if (batches->stretch.frames != frames) {
        if (batches->stretch.count > 0)
            move_stretch(context, batches);
        ground_vehicle_begin(&batches->stretch, frames);
    }
    if (ground_vehicle_take_held(context, &batches->stretch, i))
        move_stretch(context, batches);
}

/* Moves an aircraft by a stretch, or by one frame if that is refused. In a crowd an even stretch
 * may be longer than one by the motion of a frame. */
static void begin_air_stretch(const struct step_context *context, uint32_t i,
                              const struct desired_motion *desired, uint32_t frames,
                              struct batches *batches)
{
    const uint32_t most = context->cruise_short;
    if (cruise_start_crowd(context)) {
        frames = even_flight_frames(context, i, frames);
        if (flies_evenly(context, i, desired, frames, batches))
            return;
        while (frames > most) {
            frames = frames / 2 > most ? frames / 2 : most;
            if (flies_evenly(context, i, desired, frames, batches))
                return;
        }
    }
    if (batches->air_stretch.frames != frames) {
        if (batches->air_stretch.count > 0)
            move_air_stretch(context, batches);
        aircraft_begin(&batches->air_stretch, frames);
    }
    if (aircraft_take(context, &batches->air_stretch, i, desired))
        move_air_stretch(context, batches);
}

/* Moves a ship or an aircraft by a stretch, or by one frame if that is refused. */
static void begin_stretch(const struct step_context *context, uint32_t i, uint32_t frames,
                          struct batches *batches)
{
    struct desired_motion desired;
    agent_controls_motion(context, i, &desired);
    if (context->world->kinds[context->m->row[i].kind].domain == DOMAIN_AIR) {
        begin_air_stretch(context, i, &desired, frames, batches);
    } else if (ship_stretch(context, i, &desired, frames)) {
        batches->motion[i - batches->block->first] = MOTION_CRUISE;
    } else {
        move_as_desired(context, i, &desired, batches);
    }
}

/* Moves a row by the controls that its agent set. */
static void move_held(const struct step_context *context, uint32_t i, struct batches *batches)
{
    struct desired_motion desired;
    bool lands = context->world->kinds[context->m->row[i].kind].domain == DOMAIN_LAND;
    uint32_t frames = context->cruise_frames > 1 ? cruise_start_frames(context, i) : 0;
    if (!lands && frames > 0) {
        begin_stretch(context, i, frames, batches);
    } else if (!lands || is_sprung(context, i)) {
        agent_controls_motion(context, i, &desired);
        move_as_desired(context, i, &desired, batches);
    } else if (frames > 0) {
        begin_land_stretch(context, i, frames, batches);
    } else if (ground_vehicle_take_held(context, &batches->land, i)) {
        move_land(context, batches);
    }
}

/* Moves a row that holds its course, but came from its springs and is not calm yet: it goes on as a
 * body with the speed that it has. Returns false if it follows the ground. */
static bool settle_first(const struct step_context *context, uint32_t i, struct batches *batches)
{
    const struct entities *m = context->m;
    double sine, cosine;
    if (context->world->kinds[m->row[i].kind].domain != DOMAIN_LAND ||
        !(m->row[i].flags & ENTITY_FLAG_CHASSIS) || !chassis_takes(context, i, false))
        return false;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    const struct desired_motion desired = {
        .heading_rad = m->row[i].heading, .speed_mps = m->row[i].vx * sine - m->row[i].vz * cosine};
    chassis_move(context, i, &desired);
    batches->motion[i - batches->block->first] = MOTION_AGENT;
    turret_turn(context, i, &(struct turret_solution){0});
    return true;
}

/* Moves a row that holds its course. */
static void move_on(const struct step_context *context, uint32_t i, struct batches *batches)
{
    if (context->world->kinds[context->m->row[i].kind].domain == DOMAIN_AIR &&
        landing_is_down(context, i)) {
        move_landed(context, i, NULL, batches);
        return;
    }
    switch (constant_course_row(context, i)) {
    case COURSE_GROUND:
        if (constant_course_take(context, &batches->course, i))
            move_course(context, batches);
        break;
    case COURSE_DONE:
        turret_turn(context, i, &(struct turret_solution){0});
        break;
    case COURSE_AGROUND:
        is_grounded(batches, i);
        turret_turn(context, i, &(struct turret_solution){0});
        break;
    case COURSE_LEFT_WORLD:
        leaves_world(context, batches, i);
        break;
    }
}

static void move_row(const struct step_context *context, uint32_t i, struct batches *batches)
{
    struct desired_motion desired;
    switch ((enum motion)batches->motion[i - batches->block->first]) {
    case MOTION_NONE:
    case MOTION_CRUISE:
        break;
    case MOTION_WRECK:
        wreck_row(context, i);
        break;
    case MOTION_FLIGHT:
        projectile_move(context, i);
        break;
    case MOTION_HOLD:
        if (settle_first(context, i, batches))
            break;
        move_on(context, i, batches);
        break;
    case MOTION_ALONE:
        agent_direct(context, i, &desired);
        move_as_desired(context, i, &desired, batches);
        break;
    case MOTION_COURSE:
    case MOTION_AGENT:
        move_held(context, i, batches);
        break;
    case MOTION_REMOTE:
        if (!remote_motion_move(context, i))
            leaves_world(context, batches, i);
        break;
    }
}

static void move_rest(const struct step_context *context, struct batches *batches)
{
    if (batches->stretch.count > 0)
        move_stretch(context, batches);
    if (batches->land.count > 0)
        move_land(context, batches);
    if (batches->air_stretch.count > 0)
        move_air_stretch(context, batches);
    if (batches->air.count > 0)
        move_air(context, batches);
    if (batches->course.count > 0)
        move_course(context, batches);
}

void row_block_move(const struct step_context *context, const struct row_block *block,
                    uint8_t motion[CHECKSUM_ROWS])
{
    struct batches batches;
    batches.block = block;
    batches.motion = motion;
    think_schedule_run(context, block, motion);
    ground_vehicle_begin(&batches.land, 1);
    ground_vehicle_begin(&batches.stretch, context->cruise_frames);
    aircraft_begin(&batches.air, 1);
    aircraft_begin(&batches.air_stretch, context->cruise_frames);
    constant_course_begin(&batches.course);
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1))
        move_row(context, i, &batches);
    move_rest(context, &batches);
}
