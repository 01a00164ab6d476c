/* Finds firing solutions, lays guns, and checks shots. */
#include "mover/weapon/turret.h"

#include "mover/motion/kinematics.h"
#include "mover/weapon/firing_table.h"
#include "world/entity/disabled.h"
#include "world/maths/rotation.h"
#include "world/state.h"
#include "world/world.h"

#define MUZZLE_SHARE   0.7   /* of the shooter's height */
#define LAID_RAD       0.004 /* a turret's gun fires when it is so near to its solution */
#define HULL_LAID_RAD  0.06  /* the same where the hull aims */
#define STAYS_RAD      0.002 /* a gun so near to its solution stays until it fires */
#define FRIEND_AHEAD_M 300.0 /* a gunner looks for friends so far ahead */
#define FRIEND_CLEAR_M 1.0   /* added to the radius of a friend */
#define LEAD_STEPS     4     /* iterations for the flight time: its error is then about 1e-4 */

struct vec3 turret_muzzle(const struct step_context *context, const struct entities *e, uint32_t i)
{
    const struct kind *kind = &context->world->kinds[e->row[i].kind];
    struct vec3 position = entities_position(e, i);
    position.y += kind->domain == DOMAIN_AIR ? 0.0 : MUZZLE_SHARE * kind->height_m;
    return position;
}

/* The direction by the munition's table for a point at which it is fired along an arc. */
static struct vec3 arc_to(const struct step_context *context, struct vec3 muzzle, uint16_t munition,
                          struct vec3 point)
{
    return firing_arc_direction(&context->firing_tables[munition].arc, muzzle, point);
}

static bool flies_on_arc(const struct step_context *context, uint16_t munition)
{
    return context->world->kinds[munition].delivery == DELIVERY_ARC;
}

/* The direction for a target that is at `to`, relative to the muzzle, and moves at velocity. The
 * table is for still air, so the round is aimed in the air's own frame, and carries the air's
 * velocity. What has no drag feels no wind. */
static struct vec3 lead_on(const struct firing_table *table, struct vec3 wind,
                           double muzzle_height_m, struct vec3 to, struct vec3 velocity)
{
    if (table->munition->drag == DRAG_NONE)
        wind = (struct vec3){0.0, 0.0, 0.0};
    velocity = vec3_sub(velocity, wind);
    double distance = vec3_length(to), height = muzzle_height_m + 0.5 * to.y;
    struct vec3 lead = to;
    for (int step = 0; step < LEAD_STEPS; step++) {
        struct firing_data data = firing_table_at(table, distance, height);
        lead = vec3_add(to, vec3_scale(velocity, data.flight_s));
        lead.y += data.drop_m;
        distance = vec3_length(lead);
    }
    if (!(distance > 0.0))
        return (struct vec3){0.0, 1.0, 0.0};
    lead = vec3_add(vec3_scale(lead, table->munition->max_speed_mps / distance), wind);
    return vec3_scale(lead, 1.0 / vec3_length(lead));
}

struct vec3 turret_lead(const struct step_context *context, struct vec3 muzzle, uint16_t munition,
                        const struct entities *e, uint32_t target)
{
    struct vec3 to = vec3_sub(step_context_position(context, e, target), muzzle);
    to.y += kinematics_aim_height(context, e->row[target].kind);
    if (flies_on_arc(context, munition))
        return arc_to(context, muzzle, munition, vec3_add(muzzle, to));
    return lead_on(&context->firing_tables[munition], context->wind, muzzle.y, to,
                   step_context_velocity(context, e, target));
}

struct vec3 turret_lead_point(const struct step_context *context, struct vec3 muzzle,
                              uint16_t munition, struct vec3 point)
{
    if (flies_on_arc(context, munition))
        return arc_to(context, muzzle, munition, point);
    return lead_on(&context->firing_tables[munition], context->wind, muzzle.y,
                   vec3_sub(point, muzzle), (struct vec3){0.0, 0.0, 0.0});
}

static struct mat3 pose_matrix(const struct entities *e, uint32_t i)
{
    return rotation_matrix(rotation_of(e->row[i].heading, e->row[i].pitch, e->row[i].roll));
}

/* The direction of the gun for this rotation of the body. */
static struct vec3 barrel_of(const struct entities *e, uint32_t i, const struct mat3 *body)
{
    double sine, cosine, sine_up, cosine_up;
    maths_sincos((double)e->row[i].turret, &sine, &cosine);
    maths_sincos((double)e->row[i].gun, &sine_up, &cosine_up);
    return rotation_apply(body, (struct vec3){cosine * cosine_up, sine_up, sine * cosine_up});
}

struct vec3 turret_barrel(const struct entities *e, uint32_t i)
{
    struct mat3 body = pose_matrix(e, i);
    return barrel_of(e, i, &body);
}

/* Turns turret and gun towards these angles, at most at their rates and within the gun's limits. */
static void lay(const struct step_context *context, uint32_t i, const struct kind *kind,
                double turret, double gun)
{
    struct entities *m = context->m;
    double most = kind->turret_rate_rps * context->dt_s;
    double off = maths_wrap_half(turret - (double)m->row[i].turret);
    gun = maths_clamp(gun, kind->gun_low_rad, kind->gun_high_rad);
    m->row[i].turret =
        (float)maths_wrap_half((double)m->row[i].turret + maths_clamp(off, -most, most));
    m->row[i].gun =
        (float)kinematics_approach((double)m->row[i].gun, gun, kind->gun_rate_rps * context->dt_s);
}

static bool has_target(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    return m->row[i].target_id != 0 &&
           entities_alive(w, m->row[i].target_slot, m->row[i].target_id);
}

/* The direction for its goal, a point on the ground. */
static struct vec3 lead_goal(const struct step_context *context, uint32_t i, uint16_t munition)
{
    const struct entities *m = context->m;
    struct vec3 goal = {m->row[i].goal_x,
                        kinematics_ground(context, m->row[i].goal_x, m->row[i].goal_z),
                        m->row[i].goal_z};
    return turret_lead_point(context, turret_muzzle(context, m, i), munition, goal);
}

/* Finds the solution for its target, or for its goal with TRIGGER_FIRE_AT. turret, gun: the angles
 * of the solution. */
static void solve(const struct step_context *context, uint32_t i, const struct kind *kind,
                  struct turret_solution *solution, double *turret, double *gun)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    const struct kind *target = &context->world->kinds[w->row[m->row[i].target_slot].kind];
    solution->body = pose_matrix(m, i);
    solution->lead = m->row[i].trigger & TRIGGER_FIRE_AT
                         ? lead_goal(context, i, kind->munition)
                         : turret_lead(context, turret_muzzle(context, m, i),
                                       kind_munition_at(kind, target), w, m->row[i].target_slot);
    solution->found = true;
    struct vec3 lead = rotation_back(&solution->body, solution->lead);
    double level = sqrt(lead.x * lead.x + lead.z * lead.z);
    *turret = maths_atan2(lead.z, lead.x);
    *gun = maths_atan2(lead.y, level);
}

/* Turns turret and gun by the fields traverse and elevate. */
static void lay_by_rates(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    const struct entities *m = context->m;
    lay(context, i, kind,
        (double)m->row[i].turret +
            (double)m->row[i].traverse * kind->turret_rate_rps * context->dt_s,
        (double)m->row[i].gun + (double)m->row[i].elevate * kind->gun_rate_rps * context->dt_s);
}

static float share_of(double off, double most)
{
    return fabs(off) <= STAYS_RAD ? 0.0f
                                  : (float)maths_clamp(off / maths_max(most, 1e-9), -1.0, 1.0);
}

/* Sets the rates that reach these angles by the next decision of the agent. A gun that is laid well
 * enough does not move: it is laid exactly when it fires. */
static void set_rates(const struct step_context *context, uint32_t i, const struct kind *kind,
                      double turret, double gun)
{
    struct entities *m = context->m;
    double time_s = (double)context->think_frames * context->dt_s;
    gun = maths_clamp(gun, kind->gun_low_rad, kind->gun_high_rad);
    m->row[i].traverse = share_of(maths_wrap_half(turret - (double)m->row[i].turret),
                                  kind->turret_rate_rps * time_s);
    m->row[i].elevate = share_of(gun - (double)m->row[i].gun, kind->gun_rate_rps * time_s);
}

/* An agent's gun. It is laid exactly when it is about to fire or returns to rest, else by the rates
 * that the agent sets when it decides. */
static void by_agent(const struct step_context *context, uint32_t i, const struct kind *kind,
                     struct turret_solution *solution)
{
    struct entities *m = context->m;
    double turret, gun;
    if (m->row[i].trigger & TRIGGER_FIRE_AT) {
        solve(context, i, kind, solution, &turret, &gun);
        lay(context, i, kind, turret, gun);
        return;
    }
    if (m->row[i].target_id == 0) {
        m->row[i].traverse = m->row[i].elevate = 0.0f;
        if (flies_on_arc(context, kind->munition))
            return; /* a howitzer stays as it was laid */
        if (m->row[i].turret != 0.0f || m->row[i].gun != 0.0f)
            lay(context, i, kind, 0.0, 0.0);
        return;
    }
    bool fires = (m->row[i].trigger & TRIGGER_FIRE) != 0;
    if ((fires || step_context_thinks(context, i)) && has_target(context, i)) {
        solve(context, i, kind, solution, &turret, &gun);
        set_rates(context, i, kind, turret, gun);
        if (fires) {
            lay(context, i, kind, turret, gun);
            return;
        }
    }
    if (m->row[i].traverse != 0.0f || m->row[i].elevate != 0.0f)
        lay_by_rates(context, i, kind);
}

void turret_turn(const struct step_context *context, uint32_t i, struct turret_solution *solution)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    solution->found = false;
    if (kind->munition == KIND_NONE || disabled_gun(kind, m, i))
        return;
    if (m->row[i].behaviour != BEHAVIOUR_DRIVEN) {
        by_agent(context, i, kind, solution);
    } else if (m->row[i].traverse != 0.0f ||
               m->row[i].elevate != 0.0f) { /* a driver who aims by hand cancels the target */
        m->row[i].target_slot = m->row[i].target_id = 0;
        lay_by_rates(context, i, kind);
    } else if (has_target(context, i)) {
        double turret, gun;
        solve(context, i, kind, solution, &turret, &gun);
        lay(context, i, kind, turret, gun);
    }
}

static double angle_between(struct vec3 a, struct vec3 b)
{
    return maths_atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

bool turret_lay(const struct step_context *context, const struct table_writer *writer, uint32_t i,
                struct vec3 direction)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (disabled_gun(kind, m, i))
        return false;
    struct mat3 body = pose_matrix(m, i);
    struct vec3 own = rotation_back(&body, direction);
    double turret = maths_atan2(own.z, own.x);
    double gun = maths_atan2(own.y, sqrt(own.x * own.x + own.z * own.z));
    lay(context, i, kind, turret, gun);
    table_set_turret(writer, i, m->row[i].turret);
    table_set_gun(writer, i, m->row[i].gun);
    return angle_between(barrel_of(m, i, &body), direction) <= LAID_RAD;
}

static double laid_rad(const struct kind *kind)
{
    return kind->turret_rate_rps > 0.0 ? LAID_RAD : HULL_LAID_RAD;
}

/* turret_bears() for a barrel's direction. solution: this frame's, or NULL. */
static bool bears(const struct step_context *context, const struct entities *rows, uint32_t i,
                  uint32_t target, struct vec3 barrel, const struct turret_solution *solution)
{
    const struct kind *kind = &context->world->kinds[rows->row[i].kind];
    const struct kind *munition = &context->world->kinds[kind->munition];
    const struct kind *aimed_at =
        &context->world->kinds[context->committed->entities.row[target].kind];
    struct vec3 muzzle = turret_muzzle(context, rows, i), to;
    double most = laid_rad(kind);
    if (munition->guidance == GUIDANCE_HOMING) {
        most = munition->seeker_rad;
        to =
            vec3_sub(step_context_position(context, &context->committed->entities, target), muzzle);
    } else {
        to = solution ? solution->lead
                      : turret_lead(context, muzzle, kind_munition_at(kind, aimed_at),
                                    &context->committed->entities, target);
    }
    return angle_between(barrel, to) <= most;
}

bool turret_bears(const struct step_context *context, const struct entities *rows, uint32_t i,
                  uint32_t target)
{
    return bears(context, rows, i, target, turret_barrel(rows, i), NULL);
}

/* Returns true if the round would pass near a friend or a neutral vehicle on its way to the
 * target. */
static bool friend_ahead(const struct step_context *context, uint32_t i, uint32_t target,
                         struct vec3 barrel)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    uint32_t layers = NEIGHBOUR_INDEX_LAYER(m->row[i].force) | NEIGHBOUR_INDEX_LAYER(FORCE_NEUTRAL);
    struct vec3 muzzle = turret_muzzle(context, m, i);
    double reach = maths_min(
        FRIEND_AHEAD_M,
        vec3_length(vec3_sub(step_context_position(context, w, target), entities_position(m, i))));
    struct neighbour_query query =
        neighbour_query_begin(context->neighbours, layers, m->row[i].x, m->row[i].z, reach);
    const struct neighbour_index_entry *entry;
    while ((entry = neighbour_query_next(&query)) != NULL) {
        uint32_t j = entry->row;
        if (j == i || j == target)
            continue;
        double clear = context->world->kinds[w->row[j].kind].radius_m + FRIEND_CLEAR_M;
        struct vec3 to = vec3_sub(step_context_position(context, w, j), muzzle);
        double along = vec3_dot(to, barrel);
        if (along > 0.0 && vec3_dot(to, to) - along * along < clear * clear)
            return true;
    }
    return false;
}

void turret_hold_fire(const struct step_context *context, uint32_t i,
                      const struct turret_solution *solution)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    bool at_target = solution->found && !(m->row[i].trigger & TRIGGER_FIRE_AT);
    if (m->row[i].trigger & TRIGGER_FIRE_AT && kind->munition != KIND_NONE &&
        angle_between(turret_barrel(m, i), lead_goal(context, i, kind->munition)) > laid_rad(kind))
        m->row[i].trigger &= (uint8_t)~TRIGGER_FIRE_AT;
    if (!(m->row[i].trigger & TRIGGER_FIRE))
        return;
    if (kind->munition != KIND_NONE && m->row[i].rounds > 0 && has_target(context, i) &&
        context->tick >= m->row[i].reload_tick && !(m->row[i].flags & ENTITY_FLAG_HOLD_FIRE)) {
        uint32_t target = m->row[i].target_slot;
        struct vec3 to =
            vec3_sub(step_context_position(context, w, target), entities_position(m, i));
        struct vec3 barrel =
            solution->found ? barrel_of(m, i, &solution->body) : turret_barrel(m, i);
        if (vec3_length(to) < kind->range_m &&
            bears(context, m, i, target, barrel, at_target ? solution : NULL) &&
            !friend_ahead(context, i, target, barrel))
            return;
    }
    m->row[i].trigger &= (uint8_t)~TRIGGER_FIRE;
}
