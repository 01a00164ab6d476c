/* Chooses goals. */
#include "mover/agent/goal.h"

#include "mover/agent/fire_control.h"
#include "mover/agent/landing_place.h"
#include "mover/agent/mission_route.h"
#include "mover/agent/ship_course.h"
#include "mover/agent/script_player.h"
#include "mover/agent/target_search.h"
#include "mover/motion/kinematics.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define ARRIVED_M  25.0
#define ROOMY_M    100.0 /* an order of a land vehicle that is smaller than this has goals */
#define REACH      0.35  /* of its size apart, so that it has always one that is not reached; */
#define REACH_M    3.0   /* but no wheels get nearer than this */
#define HOME_M     150.0 /* a base has room for many vehicles */
#define FLEE_M     2000.0
#define DETOUR_M   400.0 /* around what blocks the path to the base */
#define GOAL_DRAWS 8
#define HULL_SHARE 0.4  /* of the height: the top of the hull, below the turret */
#define GUN_SHARE  0.9  /* of the height: the sight of the gun */
#define NEARER_M   10.0 /* steps in which it looks for the nearest place on the way */
#define IN_PLACE_M 3.0  /* near enough to a firing position */

static double unit(const struct step_context *context, uint32_t i, enum random_purpose purpose)
{
    return random_unit(context->world->params->seed, context->tick, context->m->row[i].id, purpose);
}

/* --- orders ------------------------------------------------------------------------------------*/

static bool suits(const struct step_context *context, uint32_t i, double x, double z)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    bool water = cover_is_water(terrain_cover(&context->world->terrain, x, z));
    return kind->domain == DOMAIN_AIR || (kind->domain == DOMAIN_SEA) == water;
}

/* A random point of its area on ground that suits its kind; ships: to which they can sail straight.
 */
static void patrol(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct area *area = &context->world->areas[m->row[i].order_arg];
    const bool ship = context->world->kinds[m->row[i].kind].domain == DOMAIN_SEA;
    for (int draw = 0; draw < GOAL_DRAWS; draw++) {
        double u = unit(context, i, RANDOM_GOAL_X) + (double)draw * 0.618033988749895;
        double v = unit(context, i, RANDOM_GOAL_Z) + (double)draw * 0.754877666246693;
        m->row[i].goal_x = area->x0 + (area->x1 - area->x0) * (u - floor(u));
        m->row[i].goal_z = area->z0 + (area->z1 - area->z0) * (v - floor(v));
        if (suits(context, i, m->row[i].goal_x, m->row[i].goal_z) &&
            (!ship || ship_course_is_clear(context, i, m->row[i].goal_x, m->row[i].goal_z)))
            return;
    }
}

static void route(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct route *route = &context->world->routes[m->row[i].order_arg];
    if (route->once) {
        mission_route_next(context, i, route);
        return;
    }
    uint32_t leg = m->row[i].leg % route->count;
    m->row[i].goal_x = context->world->route_points[route->first + leg].x;
    m->row[i].goal_z = context->world->route_points[route->first + leg].z;
    m->row[i].leg = (leg + 1) % route->count;
}

void goal_next(const struct step_context *context, uint32_t i)
{
    if (context->m->row[i].behaviour == BEHAVIOUR_PATROL)
        patrol(context, i);
    else if (context->m->row[i].behaviour == BEHAVIOUR_ROUTE)
        route(context, i);
}

void goal_resume(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    if (m->row[i].behaviour == BEHAVIOUR_SCRIPT)
        script_player_resume(context, i);
    if (m->row[i].behaviour == BEHAVIOUR_ROUTE &&
        context->world->routes[m->row[i].order_arg].once) {
        mission_route_resume(context, i, &context->world->routes[m->row[i].order_arg]);
        return;
    }
    if (m->row[i].behaviour == BEHAVIOUR_ROUTE) {
        uint32_t count = context->world->routes[m->row[i].order_arg].count;
        m->row[i].leg = (m->row[i].leg + count - 1) % count;
    }
    goal_next(context, i);
}

/* --- enemies -----------------------------------------------------------------------------------*/

static void along(const struct step_context *context, uint32_t i, double heading, double distance,
                  double *x, double *z)
{
    double sine, cosine;
    maths_sincos(heading, &sine, &cosine);
    *x = world_clamp(context->world, context->m->row[i].x + distance * sine);
    *z = world_clamp(context->world, context->m->row[i].z - distance * cosine);
}

void goal_away(const struct step_context *context, uint32_t i, double heading, double distance)
{
    along(context, i, heading, distance, &context->m->row[i].goal_x, &context->m->row[i].goal_z);
}

void goal_cover(const struct step_context *context, uint32_t i, uint32_t enemy)
{
    static const double turns[] = {0.0, 0.6, -0.6, 1.2, -1.2};
    static const double ways[] = {40.0, 75.0, 120.0, 350.0, 900.0};
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct vec3 from = step_context_position(context, w, enemy);
    double away = maths_heading(m->row[i].x - from.x, m->row[i].z - from.z);
    struct vec3 eye = target_search_eye(context, enemy), to;
    for (int n = 0; n < 25; n++) {
        along(context, i, away + turns[n % 5], ways[n / 5], &to.x, &to.z);
        to.y = kinematics_ground(context, to.x, to.z) + kind->height_m +
               (kind->domain == DOMAIN_AIR ? kind->cruise_altitude_m : 0.0);
        if (suits(context, i, to.x, to.z) &&
            !line_of_sight_clear(context->line_of_sight, eye, to)) {
            m->row[i].goal_x = to.x;
            m->row[i].goal_z = to.z;
            return;
        }
    }
    goal_away(context, i, away, FLEE_M);
}

/* How well a place hides the vehicle from an enemy's eye: 2: its hull and not its gun; 1: all of
 * it; 0: nothing. */
static int hides(const struct step_context *context, const struct kind *kind, struct vec3 eye,
                 struct vec3 at)
{
    double ground = kinematics_ground(context, at.x, at.z);
    at.y = ground + HULL_SHARE * kind->height_m;
    if (line_of_sight_clear(context->line_of_sight, eye, at))
        return 0;
    at.y = ground + GUN_SHARE * kind->height_m;
    return line_of_sight_clear(context->line_of_sight, eye, at) ? 2 : 1;
}

/* Finds the best place for firing at the enemy. Returns how well it hides the vehicle; -1: it
 * cannot drive anywhere, and *best is where it is. */
static int find_position(const struct step_context *context, uint32_t i, uint32_t enemy,
                         struct vec3 *best)
{
    static const double turns[] = {HALF_PI, -HALF_PI, 2.2, -2.2, PI, 1.0, -1.0};
    static const double ways[] = {30.0, 60.0, 90.0};
    const struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct vec3 eye = target_search_eye(context, enemy), to = {0};
    struct vec3 at = step_context_position(context, w, enemy);
    double towards = maths_heading(at.x - m->row[i].x, at.z - m->row[i].z);
    double side = unit(context, i, RANDOM_GOAL_X) < 0.5 ? 1.0 : -1.0;
    int hidden = -1;
    double heading = towards, distance = 0.0;
    *best = entities_position(m, i);
    for (int n = 0; n < 21 && hidden < 2; n++) {
        heading = towards + side * turns[n % 7];
        distance = ways[n / 7];
        along(context, i, heading, distance, &to.x, &to.z);
        int found = suits(context, i, to.x, to.z) ? hides(context, kind, eye, to) : -1;
        if (found > hidden) {
            hidden = found;
            *best = to;
        }
    }
    for (double near = NEARER_M; hidden == 2 && near < distance; near += NEARER_M) {
        along(context, i, heading, near, &to.x, &to.z);
        if (suits(context, i, to.x, to.z) && hides(context, kind, eye, to) == 2) {
            *best = to;
            break;
        }
    }
    return hidden;
}

void goal_position(const struct step_context *context, uint32_t i, uint32_t enemy)
{
    struct vec3 place;
    (void)find_position(context, i, enemy, &place);
    context->m->row[i].goal_x = place.x;
    context->m->row[i].goal_z = place.z;
}

bool goal_hull_down(const struct step_context *context, uint32_t i, uint32_t enemy)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct vec3 eye = target_search_eye(context, enemy);
    return hides(context, kind, eye, entities_position(context->m, i)) == 2;
}

bool goal_cover_near(const struct step_context *context, uint32_t i, uint32_t enemy)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct vec3 eye = target_search_eye(context, enemy), place = entities_position(context->m, i);
    return hides(context, kind, eye, place) == 0 && find_position(context, i, enemy, &place) > 0;
}

void goal_target(const struct step_context *context, uint32_t i, uint32_t row, uint32_t id)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    if (m->row[i].target_id != id)
        fire_control_acquire(context, i);
    m->row[i].target_slot = row;
    m->row[i].target_id = id;
    struct vec3 at = step_context_position(context, w, row);
    m->row[i].goal_x = at.x;
    m->row[i].goal_z = at.z;
}

/* --- home --------------------------------------------------------------------------------------*/

/* Its place at its force's base. */
static void base_place(const struct step_context *context, uint32_t i, double *x, double *z)
{
    const struct entities *m = context->m;
    const struct force_base *base = &context->world->params->base[m->row[i].force % FORCE_COUNT];
    *x = base->x;
    *z = base->z;
    if (kind_hovers(&context->world->kinds[m->row[i].kind]))
        landing_place_find(context, i, x, z);
}

void goal_base(const struct step_context *context, uint32_t i)
{
    base_place(context, i, &context->m->row[i].goal_x, &context->m->row[i].goal_z);
}

/* Returns the longer side of the rectangle of a route, or ROOMY_M if it is longer. */
static double route_size(const struct step_context *context, const struct route *route)
{
    const struct route_point *point = context->world->route_points + route->first;
    double x0 = point[0].x, x1 = x0, z0 = point[0].z, z1 = z0, size = 0.0;
    for (uint32_t n = 1; n < route->count && size < ROOMY_M; n++) {
        x0 = maths_min(x0, point[n].x);
        x1 = maths_max(x1, point[n].x);
        z0 = maths_min(z0, point[n].z);
        z1 = maths_max(z1, point[n].z);
        size = maths_max(x1 - x0, z1 - z0);
    }
    return maths_min(size, ROOMY_M);
}

/* Returns how large the area or the route is to which its order keeps a land vehicle, at most
 * ROOMY_M [m]. */
static double order_size(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (context->world->kinds[m->row[i].kind].domain != DOMAIN_LAND)
        return ROOMY_M;
    if (m->row[i].behaviour == BEHAVIOUR_PATROL) {
        const struct area *area = &context->world->areas[m->row[i].order_arg];
        return maths_min(maths_max(area->x1 - area->x0, area->z1 - area->z0), ROOMY_M);
    }
    if (m->row[i].behaviour != BEHAVIOUR_ROUTE)
        return ROOMY_M;
    const struct route *route = &context->world->routes[m->row[i].order_arg];
    return route->once ? ROOMY_M : route_size(context, route);
}

static bool within(const struct step_context *context, uint32_t i, double x, double z,
                   double metres)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double dx = x - m->row[i].x, dz = z - m->row[i].z;
    /* A jet's turning radius is speed over turn rate. */
    if (kind->min_speed_mps > 0.0)
        metres =
            maths_max(metres, 2.0 * kind->max_speed_mps / maths_max(kind->turn_rate_rps, 0.01));
    metres += kind->radius_m;
    return dx * dx + dz * dz < metres * metres;
}

bool goal_arrived(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const double size = order_size(context, i);
    double metres = ARRIVED_M;
    if (size < ROOMY_M)
        metres = maths_min(metres, maths_max(REACH * size, REACH_M) -
                                       context->world->kinds[m->row[i].kind].radius_m);
    return within(context, i, m->row[i].goal_x, m->row[i].goal_z, metres);
}

bool goal_is_place(const struct step_context *context, uint32_t i)
{
    return REACH * order_size(context, i) <= REACH_M;
}

bool goal_in_position(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    return dx * dx + dz * dz < IN_PLACE_M * IN_PLACE_M;
}

bool goal_at_base(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const enum domain domain = (enum domain)context->world->kinds[m->row[i].kind].domain;
    double x, z;
    base_place(context, i, &x, &z);
    if (within(context, i, x, z, domain == DOMAIN_AIR ? ARRIVED_M : HOME_M))
        return true;
    return domain == DOMAIN_SEA && m->row[i].goal_x != x && goal_arrived(context, i);
}

void goal_blocked(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    switch ((enum behaviour)m->row[i].behaviour) {
    case BEHAVIOUR_FLEE:
        goal_away(context, i, TWO_PI * unit(context, i, RANDOM_GOAL_X), FLEE_M);
        break;
    case BEHAVIOUR_WITHDRAW:
        if (context->world->kinds[m->row[i].kind].domain == DOMAIN_SEA)
            goal_away(context, i, 0.0, 0.0);
        else
            goal_away(context, i, TWO_PI * unit(context, i, RANDOM_GOAL_X), DETOUR_M);
        break;
    case BEHAVIOUR_ROUTE:
        if (context->world->routes[m->row[i].order_arg].once)
            mission_route_blocked(context, i, &context->world->routes[m->row[i].order_arg]);
        else
            goal_next(context, i);
        break;
    default:
        goal_next(context, i);
        break;
    }
}
