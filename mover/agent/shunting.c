/* Chooses the way of each stroke. */
#include "mover/agent/shunting.h"

#include "mover/agent/perception.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/world.h"

#define OVER        0.9  /* share of the speed of a stroke at which it ends */
#define STANDS_MPS  0.5  /* a vehicle that is slower, */
#define BLOCKED_MPS 0.3  /* and that its look lets go no faster, is blocked */
#define OFF_RAD     0.35 /* by less it need not turn to get past what blocks it */
#define NEAR_RAD    0.05 /* it drives to its goal if it heads there within this */
#define NEAR_M      1.0  /* a circle so near to the goal leads there */
#define BEHIND      3.0  /* turning circles' radii to a place to which it drives backwards */
#define BACK_SHARE  0.4  /* of its full speed at most */
#define ROOM        1.25 /* when it drives forwards again the goal is outside such a larger circle */

bool shunting_has_wheels(const struct step_context *context, uint32_t i)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    return kind->domain == DOMAIN_LAND && !kind->tracked;
}

bool shunting_aims_hull(const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND && !kind->tracked && kind->munition != KIND_NONE &&
           !(kind->turret_rate_rps > 0.0);
}

/* The speed at which a stroke ends: it gains and loses this speed within a share of a radian of the
 * tightest circle. */
static double stroke_mps(const struct kind *kind)
{
    return sqrt(kind->acceleration_mps2 * kind->least_turn_m);
}

static bool goes_back(const struct step_context *context, uint32_t i)
{
    return signbit(context->m->row[i].throttle) != 0;
}

/* Its speed in the direction of its stroke. */
static double speed_of(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double sine, cosine, forward, rightward;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    kinematics_along(m, i, sine, cosine, &forward, &rightward);
    return goes_back(context, i) ? -forward : forward;
}

/* The speed that its last look lets it go, of a wanted one. */
static double allowed(const struct step_context *context, uint32_t i, double wanted_mps)
{
    return wanted_mps * (1.0 - (double)context->m->row[i].ease);
}

static bool is_blocked(const struct step_context *context, uint32_t i, double wanted_mps)
{
    return allowed(context, i, wanted_mps) < BLOCKED_MPS && speed_of(context, i) < STANDS_MPS;
}

/* Returns true if its stroke is over: it is as fast as it should get, or something is in its way.
 */
static bool is_over(const struct step_context *context, uint32_t i, double stroke)
{
    double most = maths_min(stroke, allowed(context, i, stroke));
    return speed_of(context, i) >= OVER * maths_max(most, BLOCKED_MPS) ||
           is_blocked(context, i, stroke);
}

/* --- to turn at its place ----------------------------------------------------------------------*/

bool shunting_face(const struct step_context *context, uint32_t i, double heading_rad,
                   double exact_rad, struct desired_motion *desired)
{
    struct entities *m = context->m;
    bool faces = fabs(maths_wrap_half(heading_rad - m->row[i].heading)) < exact_rad;
    desired->heading_rad = heading_rad;
    desired->speed_mps = 0.0;
    if (faces || !shunting_has_wheels(context, i))
        return faces;
    double stroke = stroke_mps(&context->world->kinds[m->row[i].kind]);
    bool back = goes_back(context, i);
    if (perception_looks_out(context, i) && is_over(context, i, stroke))
        back = !back;
    m->row[i].dodge = 0.0f;
    desired->speed_mps = back ? -stroke : stroke;
    desired->shunts = true;
    return false;
}

/* --- to a place near by ------------------------------------------------------------------------*/

void shunting_drive(const struct step_context *context, uint32_t i, double east_m, double south_m,
                    double speed_mps, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double most_m = BEHIND * kind->least_turn_m;
    desired->heading_rad = maths_heading(east_m, south_m);
    desired->speed_mps = speed_mps;
    if (!shunting_has_wheels(context, i) || east_m * east_m + south_m * south_m > most_m * most_m ||
        fabs(maths_wrap_half(desired->heading_rad - m->row[i].heading)) < HALF_PI)
        return;
    desired->heading_rad = maths_wrap_turn(desired->heading_rad + PI);
    desired->speed_mps = -maths_min(speed_mps, BACK_SHARE * kind->max_speed_mps);
}

/* --- on its way --------------------------------------------------------------------------------*/

/* Returns true if it drives to its goal and cannot get there by its tightest circle, made larger by
 * a factor. */
static bool circles_goal(const struct step_context *context, uint32_t i,
                         const struct desired_motion *desired, double larger)
{
    const struct entities *m = context->m;
    double radius = larger * context->world->kinds[m->row[i].kind].least_turn_m;
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z, sine, cosine;
    double square = dx * dx + dz * dz;
    if (square > 4.0 * radius * radius || square == 0.0 ||
        fabs(maths_wrap_half(maths_heading(dx, dz) - desired->heading_rad)) > NEAR_RAD)
        return false;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    double across = fabs(dx * cosine + dz * sine);
    double inside = maths_max(radius - NEAR_M, 0.0);
    return square - 2.0 * radius * across + radius * radius < inside * inside;
}

/* Returns how far it has to turn to where its last look sent it. */
static double turn_left(const struct step_context *context, uint32_t i,
                        const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    return fabs(
        maths_wrap_half(desired->heading_rad + (double)m->row[i].dodge - m->row[i].heading));
}

void shunting_steer(const struct step_context *context, uint32_t i, struct desired_motion *desired)
{
    if (desired->driven || desired->shunts || !(desired->speed_mps > 0.0) ||
        !shunting_has_wheels(context, i))
        return;
    double stroke = stroke_mps(&context->world->kinds[context->m->row[i].kind]);
    bool back = goes_back(context, i);
    if (perception_looks_out(context, i)) {
        double left = turn_left(context, i, desired);
        if (back)
            back = !is_over(context, i, stroke) &&
                   (left > OFF_RAD || circles_goal(context, i, desired, ROOM));
        else
            back = circles_goal(context, i, desired, 1.0) ||
                   (left > OFF_RAD && is_blocked(context, i, desired->speed_mps));
    }
    desired->shunts = back;
    if (back)
        desired->speed_mps = -stroke;
}
