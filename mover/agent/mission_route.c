/* A vehicle's place at a point follows from the seed, its id and the number of the point, so it is
 * the same after an interruption. */
#include "mover/agent/mission_route.h"

#include "mover/agent/goal.h"
#include "world/entity/kind.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

/* -1..1 */
static double sideways(const struct step_context *context, uint32_t i, uint32_t point,
                       enum random_purpose purpose)
{
    return 2.0 * random_unit(context->world->params->seed, point, context->m->row[i].id, purpose) -
           1.0;
}

static bool suits(const struct step_context *context, uint32_t i, double x, double z)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    bool water = cover_is_water(terrain_cover(&context->world->terrain, x, z));
    return kind->domain == DOMAIN_AIR || (kind->domain == DOMAIN_SEA) == water;
}

void mission_route_next(const struct step_context *context, uint32_t i, const struct route *route)
{
    struct entities *m = context->m;
    uint32_t leg = m->row[i].leg, number = route->first + leg;
    if (leg >= route->count)
        return;
    const struct route_point *point = &context->world->route_points[number];
    bool last = leg + 1 == route->count;
    double wide = (double)(last ? route->last_x_m : route->spread_m);
    double high = (double)(last ? route->last_z_m : route->spread_m);
    double x = point->x + wide * sideways(context, i, number, RANDOM_GOAL_X);
    double z = point->z + high * sideways(context, i, number, RANDOM_GOAL_Z);
    bool own = world_holds(context->world, x, z) && suits(context, i, x, z);
    m->row[i].goal_x = own ? x : point->x;
    m->row[i].goal_z = own ? z : point->z;
    m->row[i].leg = leg + 1;
}

void mission_route_resume(const struct step_context *context, uint32_t i, const struct route *route)
{
    if (context->m->row[i].leg > 0)
        context->m->row[i].leg--;
    mission_route_next(context, i, route);
}

void mission_route_blocked(const struct step_context *context, uint32_t i,
                           const struct route *route)
{
    struct entities *m = context->m;
    if (m->row[i].leg < route->count) {
        mission_route_next(context, i, route);
        return;
    }
    m->row[i].goal_x = m->row[i].x;
    m->row[i].goal_z = m->row[i].z;
}

void mission_route_pace(const struct step_context *context, uint32_t i, const struct route *route,
                        struct desired_motion *desired)
{
    const struct entities *m = context->m;
    if (context->world->kinds[m->row[i].kind].min_speed_mps > 0.0)
        return;
    uint64_t bound = 0;
    if (route->bound_s > 0.0f)
        bound = 1 + (uint64_t)((double)context->tick * context->dt_s / (double)route->bound_s);
    bool watches = bound > 0 && (bound + m->row[i].id) % 2 == 0;
    if (watches || (m->row[i].leg >= route->count && goal_arrived(context, i)))
        desired->speed_mps = 0.0;
}
