/* The step: take the committed table, apply commands, move every row in parallel, then do serially
 * what changes other rows. */
#include "mover/step.h"

#include "mover/agent/agent.h"
#include "mover/agent/attack.h"
#include "mover/agent/goal.h"
#include "mover/agent/perception.h"
#include "mover/agent/think_schedule.h"
#include "mover/mission.h"
#include "mover/motion/aircraft.h"
#include "mover/motion/chassis.h"
#include "mover/motion/constant_course.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/motion/ground/landing.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/projectile.h"
#include "mover/motion/remote_motion.h"
#include "mover/motion/ship.h"
#include "mover/context/cruise_start.h"
#include "mover/motion/ground/wreck.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/fire_mission.h"
#include "mover/weapon/scenario_fires.h"
#include "mover/weapon/spawn.h"
#include "mover/weapon/turret.h"
#include "world/entity/event.h"
#include "world/entity/table_write.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <string.h>

#define BLOCKS_A_WORKER 2u
#define ROWS_A_WORKER   (BLOCKS_A_WORKER * CHECKSUM_ROWS)
#define FEW_AWAKE       128u /* rows of a block whose changed columns are found by comparing */

struct rows {
    const struct step_context *context;
    struct mover *mover; /* its caches */
    struct table committed, moved;
    const struct state_head *head; /* of moved */
    uint64_t *changed;             /* [CHECKSUM_BLOCKS] columns to hash again */
    const struct block_hashes *blank;
    bool known; /* is_own() */
};

/* The rows of a block that wait for their batch to fill up. */
struct batches {
    const struct row_block *block;
    uint8_t motion[CHECKSUM_ROWS];
    bool harmed;                         /* a hard landing has harmed a row */
    struct ground_vehicle land, stretch; /* moved by one frame, and by a stretch */
    struct aircraft air, air_stretch;
    struct constant_course course;
};

/* After a vehicle has moved: its agent reacts to a blocked path, and its gun turns. */
static void after_motion(const struct step_context *context, struct batches *batches, uint32_t i,
                         bool blocked)
{
    uint8_t *motion = &batches->motion[i - batches->block->first];
    if (blocked) {
        goal_blocked(context, i);
        *motion = MOTION_AGENT;
    }
    if (*motion == MOTION_COURSE && row_block_lacks(batches->block, GUN_COLUMNS))
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
    double harm_j = context->m->harm_j[i];
    bool blocked = chassis_move(context, i, desired);
    batches->harmed |= context->m->harm_j[i] != harm_j;
    batches->motion[i - batches->block->first] = MOTION_AGENT; /* more than its motion changes */
    after_motion(context, batches, i, blocked);
}

static void move_land(const struct step_context *context, struct batches *batches)
{
    struct ground_vehicle *land = &batches->land;
    ground_vehicle_move(context, land);
    for (int l = 0; l < land->count; l++) {
        uint32_t i = land->row[l];
        if (context->m->flags[i] & ENTITY_FLAG_CHASSIS)
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
    batches->harmed = true;
}

/* Sets an aircraft down that has touched the ground gently. Returns true if that is an event. */
static bool touches_down(const struct step_context *context, struct batches *batches, int l)
{
    const struct aircraft *air = &batches->air;
    uint32_t i = air->row[l];
    const struct kind *kind = &context->world->kinds[context->m->kind[i]];
    const struct desired_motion desired = {.driven = air->driven.lane[l] != 0,
                                           .climb_mps = air->climb.lane[l],
                                           .altitude_m = air->altitude.lane[l]};
    double reach_m = maths_max(kind->bound_m, kind->radius_m);
    if (context->m->y[i] - reach_m > air->ground.lane[l] || !landing_touch(context, i, &desired))
        return false;
    is_grounded(batches, i);
    return context->m->trigger[i] == TRIGGER_AGROUND;
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
    const bool guns = !row_block_lacks(batches->block, GUN_COLUMNS);
    constant_course_set_down(context, course);
    for (int l = 0; l < course->count; l++) {
        uint32_t i = course->row[l];
        if (context->m->flags[i] & ENTITY_FLAG_CHASSIS)
            batches->motion[i - batches->block->first] = MOTION_AGENT;
        if (guns)
            turret_turn(context, i, &(struct turret_solution){0});
    }
    course->count = 0;
}

static void move_ship(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired, struct batches *batches)
{
    struct ship_moved moved = ship_move(context, i, desired);
    bool tells = context->m->trigger[i] == TRIGGER_AGROUND;
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
    switch ((enum domain)context->world->kinds[context->m->kind[i]].domain) {
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
static bool is_sprung(const struct step_context *context, uint32_t i, const struct batches *batches)
{
    const struct entities *m = context->m;
    bool spins = !row_block_lacks(batches->block, SPIN_COLUMNS) &&
                 (m->spin_x[i] != 0.0 || m->spin_y[i] != 0.0 || m->spin_z[i] != 0.0);
    return (spins || m->flags[i] & ENTITY_FLAG_CHASSIS) && chassis_takes(context, i, false);
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

static void begin_air_stretch(const struct step_context *context, uint32_t i,
                              const struct desired_motion *desired, uint32_t frames,
                              struct batches *batches)
{
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
    if (context->world->kinds[context->m->kind[i]].domain == DOMAIN_AIR) {
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
    bool lands = context->world->kinds[context->m->kind[i]].domain == DOMAIN_LAND;
    uint32_t frames = context->cruise_frames > 1 ? cruise_start_frames(context, i) : 0;
    if (!lands && frames > 0) {
        begin_stretch(context, i, frames, batches);
    } else if (!lands || is_sprung(context, i, batches)) {
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
    if (context->world->kinds[m->kind[i]].domain != DOMAIN_LAND ||
        !(m->flags[i] & ENTITY_FLAG_CHASSIS) || !chassis_takes(context, i, false))
        return false;
    maths_sincos(m->heading[i], &sine, &cosine);
    const struct desired_motion desired = {.heading_rad = m->heading[i],
                                           .speed_mps = m->vx[i] * sine - m->vz[i] * cosine};
    double harm_j = m->harm_j[i];
    chassis_move(context, i, &desired);
    batches->harmed |= m->harm_j[i] != harm_j;
    batches->motion[i - batches->block->first] = MOTION_AGENT;
    turret_turn(context, i, &(struct turret_solution){0});
    return true;
}

/* Moves a row that holds its course. */
static void move_on(const struct step_context *context, uint32_t i, struct batches *batches)
{
    if (context->world->kinds[context->m->kind[i]].domain == DOMAIN_AIR &&
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

/* Columns that only commands, shots, collisions and hard landings change. */
#define STILL_COLUMNS                                                                              \
    (COLUMN_BIT(harm_j) | COLUMN_BIT(bump_heading) | COLUMN_BIT(id) | COLUMN_BIT(owner_id) |       \
     COLUMN_BIT(born_tick) | COLUMN_BIT(changed_tick) | COLUMN_BIT(kind) | COLUMN_BIT(state) |     \
     COLUMN_BIT(force) | COLUMN_BIT(damage))

/* Columns that motion changes, and those that laying a gun changes. */
#define MOTION_COLUMNS                                                                             \
    (COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z) | COLUMN_BIT(vx) | COLUMN_BIT(vy) |             \
     COLUMN_BIT(vz) | COLUMN_BIT(heading) | COLUMN_BIT(pitch) | COLUMN_BIT(roll) |                 \
     COLUMN_BIT(fuel_l) | COLUMN_BIT(cruise_rps) | COLUMN_BIT(cruise_mps2) |                       \
     COLUMN_BIT(cruise_tick))
#define LAID_COLUMNS (GUN_COLUMNS | COLUMN_BIT(trigger))

/* Returns the columns of the block that were zero in every row and still are. Only rows that did
 * more than move can have written to them. */
static uint64_t still_blank(const struct rows *rows, const struct batches *batches)
{
    const struct row_block *block = batches->block;
    uint64_t columns = block->blank & ~STILL_COLUMNS & ~MOTION_COLUMNS;
    uint32_t row[CHECKSUM_ROWS], count = 0;
    /* Of the rows that only move no row begins to spin in a step. A row that spins may change its
     * axis. */
    if (!row_block_lacks(block, SPIN_COLUMNS))
        columns &= ~SPIN_COLUMNS;
    if (!row_block_lacks(block, GUN_COLUMNS))
        columns &= ~LAID_COLUMNS;
    for (uint32_t i = block->first; i < block->end; i++) {
        enum motion how = (enum motion)batches->motion[i - block->first];
        if (how != MOTION_NONE && how != MOTION_HOLD && how != MOTION_COURSE)
            row[count++] = i;
    }
    return table_zero(rows->moved, columns, row, count);
}

/* Moves the rows of the block that are awake, and finds out which rest from now on. Returns the
 * columns that have not changed (few: none). *harmed: set if harm_j has changed. */
static uint64_t move_block(const struct rows *rows, const struct row_block *block, bool few,
                           bool *harmed)
{
    const struct step_context *context = rows->context;
    struct batches batches;
    batches.block = block;
    batches.harmed = false;
    think_schedule_run(context, block, batches.motion);
    ground_vehicle_begin(&batches.land, 1);
    ground_vehicle_begin(&batches.stretch, context->cruise_frames);
    aircraft_begin(&batches.air, 1);
    aircraft_begin(&batches.air_stretch, context->cruise_frames);
    constant_course_begin(&batches.course);
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1))
        move_row(context, i, &batches);
    move_rest(context, &batches);
    *harmed = batches.harmed;
    resting_rows_settle(&rows->mover->resting, context, block, batches.motion,
                        &rows->mover->neighbours, &rows->mover->neighbour_lists);
    return few ? 0 : still_blank(rows, &batches);
}

/* Returns those of the columns of this set that are different from those of the committed block: of
 * a few rows. */
static uint64_t differing(const struct rows *rows, const struct row_block *block, uint64_t columns)
{
    uint32_t row[FEW_AWAKE], count = 0;
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1))
        row[count++] = i;
    return table_changed(rows->moved, rows->committed, columns, row, count);
}

/* Moves the rows of a block that are awake, and hashes it while it is in the processor's cache. */
static void move_awake(const struct rows *rows, struct row_block *block, uint32_t awake)
{
    uint32_t number = block->first / CHECKSUM_ROWS, used = rows->context->committed->head->used;
    uint64_t *changed = &rows->changed[number];
    bool harmed;
    block->changed = *changed;
    block->blank = ~*changed & table_blank(rows->committed, number, used, rows->blank);
    bool few = awake <= FEW_AWAKE && rows->known;
    uint64_t same = move_block(rows, block, few, &harmed);
    if (few)
        *changed |= differing(rows, block, COLUMNS_ALL & ~*changed);
    else
        *changed |= COLUMNS_ALL & ~STILL_COLUMNS & ~same;
    if (harmed)
        *changed |= COLUMN_BIT(harm_j);
    table_hash_block(rows->moved, number, rows->head->used, *changed);
    *changed = 0;
}

/* Moves the committed rows; a row that a command has spawned moves from the next frame on. A block
 * in which all rows rest is not touched. */
static void move_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    (void)worker;
    for (; first < end; first += CHECKSUM_ROWS) {
        struct row_block block = {.first = first,
                                  .end = end - first < CHECKSUM_ROWS ? end : first + CHECKSUM_ROWS};
        uint32_t awake = resting_rows_awake(&rows->mover->resting, rows->context, &block);
        if (awake == 0)
            continue;
        atomic_fetch_add_explicit(&rows->mover->moved_rows, awake, memory_order_relaxed);
        move_awake(rows, &block, awake);
    }
}

/* Copies the committed rows, and wakes those that differ from what this process left. The hashes of
 * a table whose content is unknown must all be computed. */
static void take_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    struct resting_rows *resting = &rows->mover->resting;
    uint32_t used = rows->context->committed->head->used;
    (void)worker;
    for (uint32_t block = first; block < end; block++) {
        if (rows->known)
            resting_rows_wake_differing(resting, rows->moved, rows->committed, block, used);
        else
            resting_rows_wake_block(resting, block);
        table_take(rows->moved, rows->committed, block, used, rows->known);
        rows->changed[block] = rows->known ? 0 : COLUMNS_ALL;
    }
}

static void tell_change(struct serial_context *context, uint32_t i, enum agent_reason because)
{
    const struct entities *w = &context->step->committed->entities;
    const struct entities *m = &context->moved->entities;
    struct event *event = serial_context_intent(context, EVENT_AGENT);
    if (event)
        event->agent = (struct event_agent){serial_context_party(context, i), w->behaviour[i],
                                            m->behaviour[i], (uint32_t)because};
    context->moved->head->tally.agent_changes++;
}

/* Removes a row that has crossed the edge of the world. */
static void leave_world(struct serial_context *context, uint32_t i)
{
    tell_change(context, i, REASON_LEFT_WORLD);
    spawn_remove(context, i);
}

static void tell_grounded(struct serial_context *context, uint32_t i)
{
    if (context->step->world->kinds[context->moved->entities.kind[i]].domain == DOMAIN_SEA)
        ship_tell_aground(context, i);
    else
        landing_tell_hard(context, i);
}

static void pull_trigger(struct serial_context *context, uint32_t i)
{
    const struct entities *m = &context->moved->entities;
    uint8_t trigger = m->trigger[i];
    table_set_trigger(&context->writer, i, 0);
    if (trigger == TRIGGER_BROKEN) {
        wreck_tell_broken(context, i);
        return;
    }
    if (trigger == TRIGGER_AGROUND) {
        tell_grounded(context, i);
        return;
    }
    if (trigger == TRIGGER_LEFT_WORLD) {
        leave_world(context, i);
        return;
    }
    if (trigger >> TRIGGER_REASON_SHIFT)
        tell_change(context, i, (enum agent_reason)((trigger >> TRIGGER_REASON_SHIFT) - 1));
    if ((trigger & TRIGGER_FIRE) && entities_alive(m, m->target_slot[i], m->target_id[i]))
        fire_shoot(context, i, m->target_slot[i], KIND_NONE);
    if (trigger & TRIGGER_FIRE_AT)
        fire_shoot_at(context, i, m->goal_x[i], m->goal_z[i], KIND_NONE);
}

/* Few rows have a trigger; rows without one are skipped eight at a time. */
static void pull_triggers_of(struct serial_context *context, uint32_t first, uint32_t end)
{
    const uint8_t *trigger = context->moved->entities.trigger;
    for (; first < end; first += 8) {
        uint32_t past = end - first < 8 ? end : first + 8;
        uint64_t eight = 0;
        memcpy(&eight, trigger + first, past - first);
        for (uint32_t i = first; i < past && eight != 0; i++) {
            if (trigger[i] != 0)
                pull_trigger(context, i);
        }
    }
}

/* A block whose column of triggers has the hash of zeros is passed over, unless the serial part has
 * written to it. */
static void pull_triggers(struct serial_context *context, const struct rows *rows)
{
    uint32_t used = context->step->committed->head->used;
    for (uint32_t first = 0; first < used; first += CHECKSUM_ROWS) {
        uint32_t block = first / CHECKSUM_ROWS;
        bool blank =
            used - first >= CHECKSUM_ROWS &&
            rows->moved.hashes[block].column[COLUMN_trigger] == rows->blank->column[COLUMN_trigger];
        if (!blank || rows->changed[block] & COLUMN_BIT(trigger))
            pull_triggers_of(context, first,
                             used - first < CHECKSUM_ROWS ? used : first + CHECKSUM_ROWS);
    }
}

static void begin_head(struct moved *moved, const struct state_head *committed)
{
    *moved->head = *committed;
    moved->head->frame = committed->frame + 1;
    moved->head->intent_count = 0;
    moved->head->advanced = 0;
    moved->head->checksum = 0;
}

/* Returns true if the moved table is the one that this process left for the frame that is now
 * committed. Then it differs from that frame only where collisions changed rows. */
static bool is_own(const struct mover *mover, const struct state *committed,
                   const struct moved *moved)
{
    return mover->left != 0 && moved->head->checksum == mover->left &&
           moved->head->frame == committed->head->frame &&
           moved->head->used == committed->head->used;
}

/* Hashes the columns that the serial part changed, and returns the checksum of the table. */
static uint64_t checksum(struct mover *mover, const struct moved *moved)
{
    uint32_t used = moved->head->used;
    table_hash(moved_table(moved), used, mover->changed, mover->workers);
    memset(mover->changed, 0, sizeof mover->changed);
    return moved_checksum_of(moved, rows_hash(moved->hashes, used));
}

struct step_context mover_context(const struct mover *mover, const struct state *committed,
                                  struct moved *moved)
{
    const struct params *params = mover->world->params;
    uint32_t used = committed->head->used;
    uint64_t tick = committed->head->tick + 1;
    bool cruises = params->cruise && params->collision.method == METHOD_SWEPT;
    uint32_t stretch = cruises ? cruise_frames(params->dt_s) : 1;
    uint32_t thinks = perception_think_frames(params, used);
    thinks = thinks > mover->decides_every ? thinks : mover->decides_every;
    uint32_t longest = cruises ? cruise_start_longest(params->dt_s, thinks) : 1;
    return (struct step_context){
        .world = mover->world,
        .committed = committed,
        .m = &moved->entities,
        .craters = &mover->craters,
        .neighbours = &mover->neighbours,
        .neighbour_lists = &mover->neighbour_lists,
        .line_of_sight = &mover->line_of_sight,
        .ground_marks = &mover->ground_marks,
        .slopes = &mover->slopes,
        .avoidance = &mover->avoidance,
        .firing_tables = mover->firing_tables,
        .terrain_entries = mover->terrain_entries,
        .terrain_entries_ahead = mover->terrain_entries_ahead,
        .tick = tick,
        .think_frames = thinks,
        .look_frames = perception_look_frames(params, used),
        .aim_frames = attack_aim_frames(params),
        .cruise_frames = longest,
        .cruise_short = stretch,
        .cruise_phase = (uint32_t)(tick % longest),
        .cruise_group_bits = cruise_start_group_bits(params->capacity),
        .dt_s = params->dt_s,
        .wind = projectile_wind(params),
    };
}

static void index_neighbours(struct mover *mover, const struct step_context *context)
{
    const struct state *committed = context->committed;
    const struct neighbour_index_frame frame = {.committed = &committed->entities,
                                                .side_m = mover->world->terrain.squares.world_m,
                                                .used = committed->head->used,
                                                .tick = (uint32_t)context->tick,
                                                .think_frames = context->think_frames,
                                                .resting = mover->resting.resting,
                                                .fresh = mover->resting.fresh};
    neighbour_index_update(&mover->neighbours, &frame, mover->workers);
    neighbour_lists_gather(&mover->neighbour_lists, &mover->neighbours, mover->world,
                           &mover->avoidance, avoidance_ahead(context), mover->workers);
}

void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT])
{
    struct state_head *head = moved->head;
    const struct step_context context = mover_context(mover, committed, moved);
    struct serial_context serial_context = {
        .step = &context,
        .moved = moved,
        .writer = {&moved->entities, mover->changed, mover->resting.resting},
        .remotes = &mover->remotes};
    struct rows rows = {.context = &context,
                        .mover = mover,
                        .committed = state_table(committed),
                        .moved = moved_table(moved),
                        .head = head,
                        .changed = mover->changed,
                        .blank = &mover->blank,
                        .known = is_own(mover, committed, moved)};
    uint32_t used = committed->head->used;
    mover->moved_rows = 0;
    crater_index_update(&mover->craters, committed->head->crater_count);
    begin_head(moved, committed->head);
    if (!rows.known)
        table_clear_unused(&moved->entities, used, moved->entities.capacity);
    thread_pool_run(mover->workers, take_blocks, &rows, block_count(used), BLOCKS_A_WORKER);
    command_apply_all(&serial_context, sources);
    if (!head->paused || head->steps_left > 0) {
        if (head->paused)
            head->steps_left--;
        head->advanced = 1;
        head->tick = context.tick;
        index_neighbours(mover, &context);
        mover->line_of_sight.fixed_damage = committed->fixed_damage;
        ground_marks_update(&mover->ground_marks, mover->world, committed);
        resting_rows_wake_craters(&mover->resting, &context);
        resting_rows_wake_hovering(&mover->resting, &context);
        thread_pool_run(mover->workers, move_rows, &rows, used, ROWS_A_WORKER);
        scenario_fires_run(&serial_context);
        fire_mission_run(&serial_context);
        pull_triggers(&serial_context, &rows);
        mission_step(&serial_context);
        spawn_fall_back(&serial_context);
    }
    mover->left = head->checksum = checksum(mover, moved);
}
