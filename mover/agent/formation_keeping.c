/* Finds the leader of a formation and the place of each follower, and steers to it. */
#include "mover/agent/formation_keeping.h"

#include "mover/agent/goal.h"
#include "mover/agent/driving/shunting.h"
#include "world/entity/event.h"
#include "world/entity/formation.h"
#include "world/state.h"
#include "world/world.h"

#define CATCH_UP_PS   0.5  /* [1/s] of the distance to its place, added to its leader's speed */
#define AHEAD_S       1.5  /* it steers for the place where its place will be after this time */
#define AHEAD_M       12.0 /* at least so far ahead of its place */
#define IN_PLACE_M    4.0  /* near enough when its leader stands */
#define STANDS_MPS    0.5
#define FAR_M         30.0 /* further from its place it drives straight there */
#define LANE_GAP_M    1.0  /* between the vehicle and the middle of its route */
#define LANE_AHEAD_M  20.0 /* it steers for a point of its lane at least so far ahead */
#define LANE_AHEAD_S  2.0
#define LANE_STRAYS_M 60.0 /* further from its leg it drives straight to the goal */
#define LEGS_BACK     48u /* of its leader's route, on which a member of a column looks for its way */

/* --- leaders -----------------------------------------------------------------------------------*/

/* Returns true if the member drives with the others. */
static bool present(const struct step_context *context, uint32_t slot)
{
    const struct entities *w = &context->committed->entities;
    enum behaviour behaviour = (enum behaviour)w->row[slot].behaviour;
    if (!entities_alive(w, slot, slot + 1) || w->row[slot].state != ENTITY_ACTIVE)
        return false;
    const struct kind *kind = &context->world->kinds[w->row[slot].kind];
    return behaviour != BEHAVIOUR_FLEE && behaviour != BEHAVIOUR_WITHDRAW &&
           behaviour != BEHAVIOUR_RESUPPLY && (kind->fuel_l <= 0.0 || w->row[slot].fuel_l > 0.0);
}

struct post {
    uint32_t leader; /* slot; SLOT_NONE: row i must lead */
    uint32_t before; /* slot of the member before it: the leader or a follower */
    uint32_t rank;   /* of row i; 1: the first behind the leader */
};

static struct post post_of(const struct step_context *context, const struct formation *formation,
                           uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    struct post post = {SLOT_NONE, SLOT_NONE, 1};
    for (uint32_t slot = formation->first; slot < formation->first + formation->count; slot++) {
        if (slot == i || !present(context, slot))
            continue;
        if (w->row[slot].order != BEHAVIOUR_FOLLOW) {
            post.leader = slot;
        } else if (slot < i) {
            post.before = slot;
            post.rank++;
        }
    }
    if (post.leader == SLOT_NONE && post.rank > 1)
        post.leader = post.before; /* the first follower takes over in this frame */
    if (post.before == SLOT_NONE)
        post.before = post.leader;
    return post;
}

/* The point after the route's nearest point: where a new leader goes on. */
static uint32_t nearest_leg(const struct step_context *context, uint32_t i,
                            const struct route *route)
{
    const struct entities *m = context->m;
    double least = INFINITY;
    uint32_t nearest = 0;
    for (uint32_t n = 0; n < route->count; n++) {
        const struct route_point *point = &context->world->route_points[route->first + n];
        double dx = point->x - m->row[i].x, dz = point->z - m->row[i].z;
        if (dx * dx + dz * dz < least) {
            least = dx * dx + dz * dz;
            nearest = n;
        }
    }
    return nearest + 1 < route->count ? nearest + 1 : 0;
}

static void take_the_lead(const struct step_context *context, uint32_t i,
                          const struct formation *formation)
{
    struct entities *m = context->m;
    m->row[i].order = (uint8_t)formation->order;
    m->row[i].order_arg = formation->order_arg;
    m->row[i].behaviour = m->row[i].order;
    m->row[i].trigger = (uint8_t)((REASON_LEADER_LOST + 1u) << TRIGGER_REASON_SHIFT);
    if (m->row[i].order == BEHAVIOUR_ROUTE)
        m->row[i].leg = nearest_leg(context, i, &context->world->routes[m->row[i].order_arg]);
    goal_next(context, i);
}

/* --- the way of a column -----------------------------------------------------------------------*/

/* A place on a route. */
struct route_place {
    uint32_t leg; /* number of the point at which the leg ends */
    double x, z;
    double square; /* of the distance to it */
};

static const struct route_point *point_of(const struct step_context *context,
                                          const struct route *route, uint32_t number)
{
    return &context->world->route_points[route->first + number % route->count];
}

/* Finds the nearest place of the legs that the leader has driven. last: the leader's leg. */
static struct route_place nearest_place(const struct step_context *context, uint32_t i,
                                        const struct route *route, uint32_t last)
{
    const struct entities *m = context->m;
    struct route_place nearest = {.square = INFINITY};
    for (uint32_t back = 0; back < LEGS_BACK && back + 1 < route->count; back++) {
        uint32_t leg = (last + route->count - back) % route->count;
        const struct route_point *from = point_of(context, route, leg + route->count - 1);
        const struct route_point *to = point_of(context, route, leg);
        double dx = to->x - from->x, dz = to->z - from->z;
        double along = (m->row[i].x - from->x) * dx + (m->row[i].z - from->z) * dz;
        along = maths_clamp(along / maths_max(dx * dx + dz * dz, 1e-9), 0.0, 1.0);
        double x = from->x + along * dx, z = from->z + along * dz;
        double square =
            (m->row[i].x - x) * (m->row[i].x - x) + (m->row[i].z - z) * (m->row[i].z - z);
        if (square < nearest.square)
            nearest = (struct route_place){leg, x, z, square};
    }
    return nearest;
}

/* A member of a column that is far from its place drives along the route of its leader, whose
 * straight line may lead through houses or a wood. Returns true if it does, and sets its heading.
 */
static bool drive_along_route(const struct step_context *context, uint32_t i,
                              const struct formation *formation, uint32_t leader,
                              struct desired_motion *desired)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    if (formation->order != BEHAVIOUR_ROUTE || w->row[leader].order != BEHAVIOUR_ROUTE)
        return false;
    const struct route *route = &context->world->routes[formation->order_arg];
    if (route->once || route->count < 3)
        return false;
    uint32_t last = (w->row[leader].leg + route->count - 1) % route->count;
    struct route_place at = nearest_place(context, i, route, last);
    if (!(at.square < LANE_STRAYS_M * LANE_STRAYS_M))
        return false;
    double speed = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    double left = maths_max(AHEAD_M, AHEAD_S * speed) - sqrt(at.square);
    for (uint32_t n = 0; left > 0.0 && n < LEGS_BACK; n++) {
        const struct route_point *to = point_of(context, route, at.leg);
        double dx = to->x - at.x, dz = to->z - at.z, length = sqrt(dx * dx + dz * dz);
        double share = length > left ? left / length : 1.0;
        at.x += share * dx;
        at.z += share * dz;
        left -= length;
        if (at.leg == last)
            break;
        if (left > 0.0)
            at.leg = (at.leg + 1) % route->count;
    }
    desired->heading_rad = maths_heading(at.x - m->row[i].x, at.z - m->row[i].z);
    return true;
}

/* --- places ------------------------------------------------------------------------------------*/

/* Steers to a place that moves at a speed along (sine, -cosine). */
static void keep_place(const struct step_context *context, uint32_t i, double speed, double sine,
                       double cosine, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    double along = dx * sine - dz * cosine, off = sqrt(dx * dx + dz * dz);
    double ahead = maths_max(AHEAD_M, AHEAD_S * speed);
    if (speed < STANDS_MPS && kind->min_speed_mps <= 0.0) {
        desired->heading_rad = m->row[i].heading;
        desired->speed_mps = 0.0;
        if (off >= IN_PLACE_M)
            shunting_drive(context, i, dx, dz, maths_min(CATCH_UP_PS * off, kind->max_speed_mps),
                           desired);
        return;
    }
    if (off > FAR_M && along > 0.0)
        ahead = 0.0;
    desired->heading_rad = maths_heading(dx + ahead * sine, dz - ahead * cosine);
    desired->speed_mps = maths_clamp(speed + CATCH_UP_PS * along, 0.0, kind->max_speed_mps);
    if (off > FAR_M && along < 0.0 && kind->min_speed_mps <= 0.0)
        desired->speed_mps = maths_max(desired->speed_mps, STANDS_MPS); /* the others catch up */
}

/* On the route of its leader it does not drive up to the vehicle at this point, which drives at
 * this speed, where its place in the column lies behind it. */
static void keep_behind(const struct entities *m, uint32_t i, struct vec3 at, double speed,
                        double spacing_m, struct desired_motion *desired)
{
    double dx = at.x - m->row[i].x, dz = at.z - m->row[i].z;
    double most = speed + CATCH_UP_PS * (sqrt(dx * dx + dz * dz) - spacing_m);
    desired->speed_mps = maths_min(desired->speed_mps, maths_max(most, STANDS_MPS));
}

void formation_keeping_follow(const struct step_context *context, uint32_t i,
                              struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    if (m->row[i].order_arg >= context->world->counts.formations)
        return;
    const struct formation *formation = &context->world->formations[m->row[i].order_arg];
    if (i < formation->first || i - formation->first >= formation->count)
        return;
    struct post post = post_of(context, formation, i);
    if (post.leader == SLOT_NONE) {
        take_the_lead(context, i, formation);
        return;
    }
    /* In a column each vehicle follows the one before it, so that the column bends with its road.
     */
    bool column = formation->shape == FORMATION_COLUMN;
    uint32_t by = column ? post.before : post.leader;
    double ahead, right, sine, cosine;
    formation_place((enum formation_shape)formation->shape, formation->spacing_m,
                    column ? 1 : post.rank, &ahead, &right);
    maths_sincos(step_context_heading(context, w, by), &sine, &cosine);
    struct vec3 at = step_context_position(context, w, by);
    struct vec3 velocity = step_context_velocity(context, w, by);
    m->row[i].goal_x = at.x + ahead * sine + right * cosine;
    m->row[i].goal_z = at.z - ahead * cosine + right * sine;
    double speed = maths_max(0.0, velocity.x * sine - velocity.z * cosine);
    keep_place(context, i, speed, sine, cosine, desired);
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    if (column && dx * dx + dz * dz > FAR_M * FAR_M &&
        drive_along_route(context, i, formation, post.leader, desired))
        keep_behind(m, i, at, speed, formation->spacing_m, desired);
}

/* --- routes ------------------------------------------------------------------------------------*/

void formation_keeping_route(const struct step_context *context, uint32_t i,
                             struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const struct route *route = &context->world->routes[m->row[i].order_arg];
    const struct route_point *points = &context->world->route_points[route->first];
    const struct route_point *from = &points[(m->row[i].leg + route->count - 2) % route->count];
    double dx = m->row[i].goal_x - from->x, dz = m->row[i].goal_z - from->z;
    double length = sqrt(dx * dx + dz * dz);
    if (!(length > LANE_AHEAD_M))
        return;
    dx /= length;
    dz /= length;
    double x = m->row[i].x - from->x, z = m->row[i].z - from->z;
    double along = x * dx + z * dz, right = z * dx - x * dz;
    double next = along + maths_max(LANE_AHEAD_M, LANE_AHEAD_S * desired->speed_mps);
    if (along < 0.0 || next > length || fabs(right) > LANE_STRAYS_M)
        return;
    double lane = 0.5 * kind->width_m + LANE_GAP_M;
    desired->heading_rad = maths_heading((next - along) * dx - (lane - right) * dz,
                                         (next - along) * dz + (lane - right) * dx);
}
