/* Looks at the ground at some places of a way. */
#include "mover/agent/driving/ground_obstacles.h"

#include "mover/agent/driving/earthwork_obstacles.h"
#include "mover/context/steep_ground.h"
#include "mover/motion/drivetrain.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/world.h"

#define HOLDS 0.9 /* share of the slope on which its tyres just hold it to the side */

/* Patrols go around ground that is steeper than 25 degrees, by its tangent. Costs are in shares of
 * the way's length: of such ground, and of each unit of the tangent beyond. So a patrol turns by up
 * to 55 degrees for it, and by 80 before a slope of 31. */
#define STEEP        0.4663
#define STEEP_COST   0.45
#define STEEPER_COST 2.5

/* Where the ground is tested, in shares of the way. What is in the water looks at the last two. */
static const double tested[] = {0.0625, 0.125, 0.25, 0.5, 1.0};
#define TESTED     ((int)(sizeof tested / sizeof tested[0]))
#define TESTED_WET 2

double ground_obstacles_slope(const struct kind *kind)
{
    const double friction = ground_grip_of(COVER_GRASS).friction;
    double sine, cosine;
    maths_sincos(kind->max_slope_rad, &sine, &cosine);
    return maths_min(sine / maths_max(cosine, 1e-9),
                     HOLDS * drivetrain_lateral(kind, friction) / GRAVITY_MPS2);
}

static enum domain domain_of(const struct step_context *context, uint32_t i)
{
    return (enum domain)context->world->kinds[context->m->row[i].kind].domain;
}

static bool in_world(const struct step_context *context, double x, double z)
{
    const double side_m = context->world->terrain.squares.world_m;
    return x > 0.0 && z > 0.0 && x < side_m && z < side_m;
}

double ground_obstacles_works(const struct step_context *context, uint32_t i,
                              const struct ground_way *way)
{
    const struct entities *m = context->m;
    const struct earthworks *works = &context->world->terrain.earthworks;
    const struct earthwork_way straight = {.x = m->row[i].x,
                                           .z = m->row[i].z,
                                           .ux = way->ux,
                                           .uz = way->uz,
                                           .length_m = way->length_m,
                                           .beside_m = way->beside_m,
                                           .ahead_m = way->ahead_m};
    return domain_of(context, i) == DOMAIN_LAND && works->count > 0
               ? earthwork_obstacles_free(works, &context->world->kinds[m->row[i].kind], &straight)
               : way->length_m;
}

/* Returns true if a land vehicle cannot get from one height to another within a way, up or down, or
 * would slide off the ground there: it is as steep as `most`. Where it stands on ground as steep it
 * may go on. */
static bool too_steep(const struct step_context *context, uint32_t i, double most, double rise_m,
                      double way_m, double x, double z)
{
    const struct entities *m = context->m;
    if (fabs(rise_m) >= most * way_m)
        return true;
    double there = steep_ground_at(context, i, x, z);
    return there >= most && there > steep_ground_at(context, i, m->row[i].x, m->row[i].z);
}

double ground_obstacles_free(const struct step_context *context, uint32_t i,
                             const struct ground_way *way)
{
    const struct entities *m = context->m;
    const enum domain domain = domain_of(context, i);
    double before_m = 0.0, before_y = m->row[i].y;
    double end_x = m->row[i].x + way->length_m * way->ux,
           end_z = m->row[i].z + way->length_m * way->uz;
    if (domain == DOMAIN_LAND && in_world(context, end_x, end_z) &&
        steep_ground_is_easy(context, i, end_x, end_z, way->slope))
        return way->length_m;
    double free_m = ground_obstacles_works(context, i, way);
    bool wet = cover_is_water(terrain_cover(&context->world->terrain, m->row[i].x, m->row[i].z));
    for (int n = wet ? TESTED - TESTED_WET : 0; n < TESTED; n++) {
        double distance = tested[n] * way->length_m;
        double x = m->row[i].x + distance * way->ux, z = m->row[i].z + distance * way->uz;
        if (!in_world(context, x, z) ||
            cover_is_water(terrain_cover(&context->world->terrain, x, z)) != (domain == DOMAIN_SEA))
            return maths_min(before_m, free_m);
        if (domain == DOMAIN_LAND) {
            double y = kinematics_ground(context, x, z);
            if (too_steep(context, i, way->slope, y - before_y, distance - before_m, x, z))
                return maths_min(before_m, free_m);
            before_y = y;
        }
        before_m = distance;
    }
    return free_m;
}

double ground_obstacles_cost(const struct step_context *context, uint32_t i,
                             const struct ground_way *way)
{
    const struct entities *m = context->m;
    const double dx = way->length_m * way->ux, dz = way->length_m * way->uz;
    if (domain_of(context, i) != DOMAIN_LAND || m->row[i].behaviour != BEHAVIOUR_PATROL ||
        !in_world(context, m->row[i].x + dx, m->row[i].z + dz) ||
        steep_ground_is_easy(context, i, m->row[i].x + dx, m->row[i].z + dz, STEEP))
        return 0.0;
    double most = steep_ground_on_way(context, i, dx, dz);
    return most < STEEP ? 0.0 : STEEP_COST + STEEPER_COST * (most - STEEP);
}
