/* Slopes, faces of earthworks, bends and jolts, each as a speed at a place ahead. */
#include "mover/agent/driving/driving_pace.h"

#include "mover/agent/driving/earthwork_obstacles.h"
#include "mover/motion/drivetrain.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/terrain_cache.h"
#include "world/world.h"

#define BRAKE_SHARE  0.4   /* of the hardest braking, by which it slows down in time */
#define REACT_S      0.6   /* until a look has slowed the vehicle */
#define PLACES       4     /* of the ground, from here to the end of the way to a stop */
#define GENTLE       0.08  /* tangent: ground that slopes less limits no speed */
#define SIDE_M       110.0 /* [m] radius that it must be able to steer on a side slope */
#define SIGHT_M      40.0  /* [m] within which it can stop on a way down */
#define LEAST_MARGIN 0.3   /* [m/s2] that counts as left on the steepest ground */
#define RISE_MPS     4.0   /* up the face of an earthwork: it needs some way to get up */
#define FALL_MPS     2.0   /* and down: faster ones leave the ground at its edge */
#define BENDS        6     /* looked at */
#define BEND_SHARE   0.6   /* of the greatest lateral acceleration */
#define BEND_LEAST_M 4.0   /* half of a leg of its route counts as this at least */
#define BEND_MOST_M  25.0  /* and as this at most: from there it steers for the next point */
#define LEAST_MPS    2.5
#define THROWN_RPS   0.35 /* of roll and pitch: a crew that is thrown about brakes */
#define THROWN_SHARE 0.6  /* to this share of its speed */
#define THROWN_MPS   5.0  /* and not below this one */

struct pace {
    const struct kind *kind;
    double sine, cosine; /* of the heading */
    double present_mps;
    double brake_mps2, lateral_mps2;
    double way_m; /* that it looks ahead */
    double most_mps;
};

static struct pace begin(const struct step_context *context, uint32_t i, double heading_rad)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double friction = ground_grip_of(COVER_GRASS).friction;
    struct pace pace = {.kind = kind, .most_mps = INFINITY};
    double hardest = maths_min(BRAKES * kind->acceleration_mps2, friction * GRAVITY_MPS2);
    maths_sincos(heading_rad, &pace.sine, &pace.cosine);
    pace.present_mps = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    pace.brake_mps2 = BRAKE_SHARE * hardest;
    pace.lateral_mps2 = drivetrain_lateral(kind, friction);
    pace.way_m = pace.present_mps * REACT_S +
                 pace.present_mps * pace.present_mps / (2.0 * pace.brake_mps2) +
                 0.5 * kind->length_m;
    return pace;
}

/* Limits the speed so that it is no higher than this one after a way. */
static void limit(struct pace *pace, double speed_mps, double way_m)
{
    double left_m = maths_max(0.0, way_m - pace->present_mps * REACT_S);
    double square = speed_mps * speed_mps + 2.0 * pace->brake_mps2 * left_m;
    pace->most_mps = maths_min(pace->most_mps, maths_max(sqrt(square), LEAST_MPS));
}

/* --- slopes ------------------------------------------------------------------------------------*/

/* Limits the speed by the slope of the ground at a place, after a way. */
static void heed_slope(struct pace *pace, double east, double south, double way_m)
{
    double across = fabs(east * pace->cosine + south * pace->sine);
    double down = south * pace->cosine - east * pace->sine;
    if (across > GENTLE) {
        double pulls = GRAVITY_MPS2 * across / sqrt(1.0 + across * across);
        double margin = maths_max(pace->lateral_mps2 - pulls, LEAST_MARGIN);
        limit(pace, sqrt(margin * SIDE_M), way_m);
    }
    if (down > GENTLE) {
        double friction = ground_grip_of(COVER_GRASS).friction;
        double holds = GRAVITY_MPS2 * (friction - down) / sqrt(1.0 + down * down);
        limit(pace, sqrt(2.0 * maths_max(holds, LEAST_MARGIN) * SIGHT_M), way_m);
    }
}

static void heed_ground(const struct step_context *context, uint32_t i, struct pace *pace)
{
    const struct entities *m = context->m;
    for (int n = 0; n < PLACES; n++) {
        double way_m = pace->way_m * n / (PLACES - 1), east, south;
        double x = m->row[i].x + way_m * pace->sine, z = m->row[i].z - way_m * pace->cosine;
        if (!world_holds(context->world, x, z))
            return;
        terrain_cache_slopes(&context->world->terrain, &context->terrain_entries[i], x, z, &east,
                             &south);
        heed_slope(pace, east, south, way_m);
    }
}

/* --- earthworks --------------------------------------------------------------------------------*/

static void heed_face(void *context, double far_m, double slope)
{
    if (fabs(slope) > GENTLE)
        limit(context, (slope > 0.0 ? RISE_MPS : FALL_MPS) / fabs(slope), far_m);
}

static void heed_works(const struct step_context *context, uint32_t i, struct pace *pace)
{
    const struct earthworks *works = &context->world->terrain.earthworks;
    const struct earthwork_way way = {.x = context->m->row[i].x,
                                      .z = context->m->row[i].z,
                                      .ux = pace->sine,
                                      .uz = -pace->cosine,
                                      .length_m = pace->way_m,
                                      .beside_m = 0.5 * pace->kind->width_m,
                                      .ahead_m = 0.5 * pace->kind->length_m};
    if (works->count > 0)
        earthwork_obstacles_faces(works, pace->kind, &way, heed_face, pace);
}

/* --- bends -------------------------------------------------------------------------------------*/

/* Two legs of a route that meet in a bend [m, on the map]. */
struct bend {
    double in_x, in_z, out_x, out_z;
    double in_m, out_m; /* their lengths */
};

/* Limits the speed by a bend, after a way to its corner. */
static void heed_bend(struct pace *pace, const struct bend *bend, double way_m)
{
    double lengths = bend->in_m * bend->out_m;
    if (lengths <= 0.0)
        return;
    double sine = fabs(bend->in_x * bend->out_z - bend->in_z * bend->out_x) / lengths;
    double cosine = (bend->in_x * bend->out_x + bend->in_z * bend->out_z) / lengths;
    double half = maths_clamp(0.5 * maths_min(bend->in_m, bend->out_m), BEND_LEAST_M, BEND_MOST_M);
    /* The arc that touches both legs half a leg from the corner; the tangent of half the angle is
     * sine / (1 + cosine). */
    double radius = half * maths_max(1.0 + cosine, 0.0) / maths_max(sine, 1e-6);
    if (cosine < 0.0)
        radius = maths_min(radius, half);
    limit(pace, sqrt(BEND_SHARE * pace->lateral_mps2 * radius), way_m - half);
}

static double length_of(double x, double z)
{
    return sqrt(x * x + z * z);
}

static void heed_route(const struct step_context *context, uint32_t i, struct pace *pace)
{
    const struct entities *m = context->m;
    if (m->row[i].behaviour != BEHAVIOUR_ROUTE)
        return;
    const struct route *route = &context->world->routes[m->row[i].order_arg];
    if (route->once || route->count < 3) /* each has places of its own at the points of a mission */
        return;
    const struct route_point *points = &context->world->route_points[route->first];
    uint32_t n = m->row[i].leg % route->count;
    struct bend bend = {.in_x = m->row[i].goal_x - m->row[i].x,
                        .in_z = m->row[i].goal_z - m->row[i].z};
    double way_m = bend.in_m = length_of(bend.in_x, bend.in_z);
    for (int b = 0; b < BENDS && way_m - BEND_MOST_M < pace->way_m; b++) {
        const struct route_point *at = &points[(n + route->count - 1) % route->count];
        bend.out_x = points[n].x - at->x;
        bend.out_z = points[n].z - at->z;
        bend.out_m = length_of(bend.out_x, bend.out_z);
        heed_bend(pace, &bend, way_m);
        way_m += bend.out_m;
        bend.in_x = bend.out_x;
        bend.in_z = bend.out_z;
        bend.in_m = bend.out_m;
        n = (n + 1) % route->count;
    }
}

/* --- jolts -------------------------------------------------------------------------------------*/

static void heed_jolts(const struct step_context *context, uint32_t i, struct pace *pace)
{
    const struct entities *m = context->m;
    double square = m->row[i].spin_x * m->row[i].spin_x + m->row[i].spin_z * m->row[i].spin_z;
    if (square > THROWN_RPS * THROWN_RPS)
        pace->most_mps =
            maths_min(pace->most_mps, maths_max(THROWN_SHARE * pace->present_mps, THROWN_MPS));
}

double driving_pace(const struct step_context *context, uint32_t i, double heading_rad)
{
    struct pace pace = begin(context, i, heading_rad);
    heed_ground(context, i, &pace);
    heed_works(context, i, &pace);
    heed_route(context, i, &pace);
    heed_jolts(context, i, &pace);
    return pace.most_mps;
}
