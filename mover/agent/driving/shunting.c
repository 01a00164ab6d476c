/* Chooses the way of each stroke. */
#include "mover/agent/driving/shunting.h"

#include "mover/agent/driving/progress.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/world.h"

#define STROKE_MPS 2.5   /* of strokes on its way */
#define OVER       0.9   /* share of the speed of a stroke about its place at which it ends */
#define OVER_M     0.2   /* and any one with less room */
#define GAP_M      0.3   /* to what stands around it */
#define WIDE_M     1.0   /* it turns without strokes where the gap is so much */
#define ENOUGH_M   0.5   /* and forwards again, to the end, where it is so much */
#define EXACT_RAD  0.005 /* of a heading that is given to it */
#define LEAST_M    0.4   /* a stroke that is shorter is not worth a change */
#define SLOW_MPS   3.0   /* a faster vehicle brakes before it shunts */
#define OFF_RAD    0.35  /* by less it need not turn to get past what blocks it */
#define ALONG_RAD  0.6   /* it backs out if its back is to its goal within this */
#define AROUND_RAD 4.7   /* it does not go on to turn the long way around by more */
#define NEAR_RAD   0.05  /* it drives to its goal if it heads there within this */
#define NEAR_M     1.0   /* a circle so near to the goal leads there */
#define BEHIND     3.0   /* turning circles' radii to a place to which it drives backwards */
#define BACK_SHARE 0.4   /* of its full speed at most */
#define ROOM       1.25 /* when it drives forwards again the goal is outside such a larger circle */

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

/* A stroke about its place gains and loses its speed within a share of a radian of the tightest
 * circle. */
double shunting_speed(const struct kind *kind, bool faces)
{
    return faces ? sqrt(kind->acceleration_mps2 * kind->least_turn_m) : STROKE_MPS;
}

/* --- the stroke that it is in ------------------------------------------------------------------*/

/* Returns how many full turns the dodge has: 0 if it does not shunt. */
static double turns_of(const struct entities *m, uint32_t i)
{
    return floor(((double)m->row[i].dodge + PI) / TWO_PI);
}

double shunting_dodge(const struct entities *m, uint32_t i)
{
    return turns_of(m, i) == 0.0 ? (double)m->row[i].dodge : 0.0;
}

static struct shunting_stroke stroke_of(const struct entities *m, uint32_t i)
{
    const double turns = turns_of(m, i);
    return (struct shunting_stroke){.ahead = signbit(m->row[i].throttle) ? -1.0 : 1.0,
                                    .side = fabs(turns) > 1.0 ? 0.0 : turns};
}

static bool goes_straight(const struct entities *m, uint32_t i)
{
    return fabs(turns_of(m, i)) > 1.0;
}

/* Returns its speed in the direction of a stroke. */
static double speed_of(const struct step_context *context, uint32_t i,
                       struct shunting_stroke stroke)
{
    const struct entities *m = context->m;
    double sine, cosine, forward, rightward;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    kinematics_along(m, i, sine, cosine, &forward, &rightward);
    return stroke.ahead * forward;
}

static struct shunting_pose pose_of(const struct entities *m, uint32_t i)
{
    return (struct shunting_pose){
        .x = m->row[i].x, .z = m->row[i].z, .heading_rad = m->row[i].heading};
}

static struct shunting_stroke opposite(struct shunting_stroke stroke)
{
    return (struct shunting_stroke){.ahead = -stroke.ahead, .side = stroke.side};
}

void shunting_keep(const struct step_context *context, uint32_t i, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (turns_of(m, i) == 0.0) {
        desired->speed_mps = desired->shunts ? 0.0 : desired->speed_mps; /* it has not chosen yet */
        return;
    }
    desired->speed_mps = stroke_of(m, i).ahead * shunting_speed(kind, desired->shunts);
    desired->shunts = true;
}

void shunting_take(const struct step_context *context, uint32_t i, const struct shunting_way *way,
                   struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double turns = way->stroke.side != 0.0 ? way->stroke.side : 2.0;
    m->row[i].dodge =
        (float)(maths_wrap_half(way->heading_rad - desired->heading_rad) + turns * TWO_PI);
    desired->speed_mps = way->stroke.ahead * shunting_speed(kind, desired->shunts);
    desired->shunts = true;
}

/* --- to turn at its place ----------------------------------------------------------------------*/

bool shunting_face(const struct step_context *context, uint32_t i, double heading_rad,
                   double exact_rad, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    bool faces = fabs(maths_wrap_half(heading_rad - m->row[i].heading)) < exact_rad;
    desired->heading_rad = heading_rad;
    desired->speed_mps = 0.0;
    if (faces || !shunting_has_wheels(context, i))
        return faces;
    desired->speed_mps = shunting_speed(&context->world->kinds[m->row[i].kind], true);
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

/* Returns true if it backs off from a goal within its turning circle, or has to. */
static bool is_too_near(const struct step_context *context, uint32_t i,
                        const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const bool backs = turns_of(m, i) != 0.0 && stroke_of(m, i).ahead < 0.0;
    return !desired->shunts && circles_goal(context, i, desired, backs ? ROOM : 1.0);
}

bool shunting_looks(const struct step_context *context, uint32_t i, double heading_rad,
                    const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct shunting_stroke on = {.ahead = 1.0};
    if (!shunting_has_wheels(context, i) || !(desired->speed_mps > 0.0))
        return false;
    return desired->shunts || is_too_near(context, i, desired) ||
           (fabs(maths_wrap_half(heading_rad - m->row[i].heading)) > OFF_RAD &&
            (turns_of(m, i) != 0.0 || speed_of(context, i, on) < SLOW_MPS));
}

/* Returns true if it gets to a heading by an arc, which keeps a gap. */
static bool has_room(const struct step_context *context, uint32_t i,
                     const struct shunting_room *room, double heading_rad, double gap_m)
{
    const struct shunting_pose pose = pose_of(context->m, i);
    const double left = maths_wrap_half(heading_rad - pose.heading_rad);
    const double way_m = fabs(left) * room->circle_m;
    const struct shunting_stroke arc = {.ahead = 1.0, .side = left < 0.0 ? -1.0 : 1.0};
    return shunting_room_free(room, &pose, arc, way_m, gap_m) >= way_m;
}

bool shunting_begins(const struct step_context *context, uint32_t i,
                     const struct shunting_room *room, double heading_rad,
                     const struct desired_motion *desired)
{
    if (desired->shunts || is_too_near(context, i, desired))
        return true;
    return room->count > 0 &&
           (turns_of(context->m, i) != 0.0 || !has_room(context, i, room, heading_rad, WIDE_M));
}

/* Sets the way to a stroke. Returns true if it has some room. */
static bool go_by(const struct step_context *context, uint32_t i, const struct shunting_room *room,
                  double heading_rad, struct shunting_stroke stroke, struct shunting_way *way)
{
    const struct shunting_pose pose = pose_of(context->m, i);
    const double left = maths_wrap_turn(stroke.side * (heading_rad - pose.heading_rad));
    const double turn = stroke.side * maths_min(left, HALF_PI);
    const double most_m = stroke.side != 0.0 ? left * room->circle_m : PI * room->circle_m;
    *way = (struct shunting_way){.stroke = stroke,
                                 .heading_rad = maths_wrap_turn(pose.heading_rad + turn),
                                 .free_m = shunting_room_free(room, &pose, stroke, most_m, GAP_M)};
    return way->free_m >= maths_min(OVER_M, most_m);
}

/* Goes on with the stroke that it is in. A stroke about its place ends at a speed, so that it stays
 * near. Returns false if the stroke is over. */
static bool go_on(const struct step_context *context, uint32_t i, const struct shunting_room *room,
                  double heading_rad, bool faces, struct shunting_way *way)
{
    const struct entities *m = context->m;
    const struct shunting_stroke stroke = stroke_of(m, i);
    const double speed = shunting_speed(&context->world->kinds[m->row[i].kind], faces);
    if (turns_of(m, i) == 0.0 || stroke.side == 0.0 ||
        maths_wrap_turn(stroke.side * (heading_rad - m->row[i].heading)) > AROUND_RAD ||
        (!faces && stroke.ahead < 0.0 && has_room(context, i, room, heading_rad, ENOUGH_M)))
        return false;
    if (faces && speed_of(context, i, stroke) >= OVER * speed &&
        go_by(context, i, room, heading_rad, opposite(stroke), way) && way->free_m >= LEAST_M)
        return true;
    return go_by(context, i, room, heading_rad, stroke, way);
}

/* Straight on, by the longer one of the ways before and behind it, or the one that it is on. */
static bool go_straight(const struct step_context *context, uint32_t i,
                        const struct shunting_room *room, struct shunting_way *way)
{
    const struct entities *m = context->m;
    const struct shunting_stroke stroke = stroke_of(m, i);
    struct shunting_way behind;
    if (goes_straight(m, i) && go_by(context, i, room, m->row[i].heading, stroke, way))
        return true;
    (void)go_by(context, i, room, m->row[i].heading, (struct shunting_stroke){.ahead = -1.0},
                &behind);
    (void)go_by(context, i, room, m->row[i].heading, (struct shunting_stroke){.ahead = 1.0}, way);
    if (behind.free_m >= way->free_m)
        *way = behind;
    return way->free_m >= LEAST_M;
}

/* To turn about its place it looks for room once: straight on as far as it gets. */
static bool look_for_room(const struct step_context *context, uint32_t i,
                          const struct shunting_room *room, struct shunting_way *way)
{
    const struct entities *m = context->m;
    if (progress_backed_off(context, i))
        return false;
    return goes_straight(m, i) ? go_by(context, i, room, m->row[i].heading, stroke_of(m, i), way)
                               : go_straight(context, i, room, way);
}

bool shunting_choose(const struct step_context *context, uint32_t i,
                     const struct shunting_room *room, double heading_rad,
                     const struct desired_motion *desired, struct shunting_way *way)
{
    const struct entities *m = context->m;
    const struct shunting_pose pose = pose_of(m, i);
    const double left = maths_wrap_half(heading_rad - pose.heading_rad);
    const double back_rad = maths_wrap_turn(heading_rad + PI);
    const double longest_m = (desired->shunts ? 1.0 : PI) * room->circle_m;
    struct shunting_stroke stroke = {.ahead = -1.0, .side = left < 0.0 ? -1.0 : 1.0};
    if (is_too_near(context, i, desired) && go_by(context, i, room, heading_rad, stroke, way))
        return true;
    if (go_on(context, i, room, heading_rad, desired->shunts, way))
        return true;
    if (shunting_room_plan(room, &pose, heading_rad, desired->shunts ? EXACT_RAD : 0.5 * OFF_RAD,
                           longest_m, &stroke))
        return go_by(context, i, room, heading_rad, stroke, way);
    if (desired->shunts)
        return look_for_room(context, i, room, way);
    if (fabs(maths_wrap_half(back_rad - pose.heading_rad)) < ALONG_RAD) {
        *way = (struct shunting_way){
            .stroke = {.ahead = -1.0}, .heading_rad = back_rad, .backs_out = true};
        return true;
    }
    if (shunting_room_plan(room, &pose, back_rad, OFF_RAD, longest_m, &stroke))
        return go_by(context, i, room, back_rad, stroke, way);
    return go_straight(context, i, room, way);
}
