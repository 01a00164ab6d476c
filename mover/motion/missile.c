/* Moves guided missiles. */
#include "mover/motion/missile.h"

#include "mover/motion/kinematics.h"
#include "world/entity/decoy.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define BOOST_MPS2 300.0 /* acceleration of a motor that burns until the end */
#define DRAG_PM    1e-4  /* [1/m] a coasting missile: deceleration over the square of its speed */
#define TURN_DRAG  0.1   /* of the load: deceleration by turning */
#define NAVIGATION 4.0   /* the path turns so many times as fast as the line of sight */
#define LEAD_SHARE                                                                                 \
    0.8 /* of the seeker's cone: with so much lead, the path turns as the line does */
#define LAG_S       0.25        /* of seeker and fins together */
#define FAILS_S     2.0         /* a failure shows within this time of flight */
#define STUCK_FINS  0.3         /* of full deflection, of a missile that has failed */
#define SMOKE_SHARE (1.0 / 3.0) /* of the decoy chance: smoke takes seconds to grow */

static double draw(const struct step_context *context, uint32_t i, enum random_purpose purpose)
{
    const struct entities *m = context->m;
    return random_unit(context->world->params->seed, m->row[i].born_tick, m->row[i].id, purpose);
}

static double age_s(const struct step_context *context, uint32_t i)
{
    return (double)((uint32_t)context->tick - context->m->row[i].born_tick) * context->dt_s;
}

/* --- speed -------------------------------------------------------------------------------------*/

static double speed_after(const struct step_context *context, uint32_t i, const struct kind *kind,
                          double speed)
{
    const struct entities *m = context->m;
    double right = (double)m->row[i].steer, up = (double)m->row[i].climb, dt_s = context->dt_s;
    if (!(kind->burn_s > 0.0))
        return kinematics_approach(speed, kind->max_speed_mps, BOOST_MPS2 * dt_s);
    if (age_s(context, i) <= kind->burn_s) {
        double push = (1.0 - MISSILE_LAUNCH_SHARE) * kind->max_speed_mps / kind->burn_s;
        return kinematics_approach(speed, kind->max_speed_mps, push * dt_s);
    }
    double load = (right * right + up * up) * kind->max_load * GRAVITY_MPS2;
    return maths_max(1.0, speed - (DRAG_PM * speed * speed + TURN_DRAG * load) * dt_s);
}

/* --- target ------------------------------------------------------------------------------------*/

/* The target as the missile sees it. */
struct seen_target {
    struct vec3 to;      /* [m] relative to the missile */
    struct vec3 closing; /* [m/s] velocity relative to the missile */
};

/* The angle of the target off the path. */
static double lead_of(struct vec3 velocity, struct vec3 to)
{
    return maths_atan2(vec3_length(vec3_cross(velocity, to)), vec3_dot(velocity, to));
}

static bool has_failed(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    double chance = draw(context, i, RANDOM_FAILURE), over = chance - kind->reliability;
    return over >= 0.0 && age_s(context, i) >= FAILS_S * over / (1.0 - kind->reliability);
}

/* Returns true if the target's decoys have taken the seeker. */
static bool is_decoyed(const struct step_context *context, uint32_t i, const struct kind *kind,
                       const struct seen_target *sight)
{
    const struct entities *w = &context->committed->entities;
    uint32_t target = context->m->row[i].target_slot;
    if (!decoy_due(w, target, sight->to, sight->closing, DECOY_S))
        return false;
    bool land = context->world->kinds[w->row[target].kind].domain == DOMAIN_LAND;
    return draw(context, i, RANDOM_DECOY) < kind->decoyed * (land ? SMOKE_SHARE : 1.0);
}

/* Returns false if it has no target, or has lost it now. */
static bool sees(const struct step_context *context, uint32_t i, const struct kind *kind,
                 struct vec3 velocity, struct seen_target *sight)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    uint32_t target = m->row[i].target_slot;
    if (m->row[i].target_id == 0 || !entities_alive(w, target, m->row[i].target_id))
        return false;
    sight->to = vec3_sub(step_context_position(context, w, target), entities_position(m, i));
    sight->to.y += kinematics_aim_height(context, w->row[target].kind);
    sight->closing = vec3_sub(step_context_velocity(context, w, target), velocity);
    if (lead_of(velocity, sight->to) <= kind->seeker_rad && !is_decoyed(context, i, kind, sight))
        return true;
    m->row[i].target_slot = m->row[i].target_id = 0;
    return false;
}

/* --- steering ----------------------------------------------------------------------------------*/

/* Unit vectors: along the path, to its right on the level, and up from it. */
struct axes {
    struct vec3 ahead, right, up;
};

static struct axes axes_of(struct vec3 velocity, double speed)
{
    struct axes axes = {.ahead = vec3_scale(velocity, 1.0 / speed)};
    double level = sqrt(axes.ahead.x * axes.ahead.x + axes.ahead.z * axes.ahead.z);
    axes.right = level > 1e-6 ? (struct vec3){-axes.ahead.z / level, 0.0, axes.ahead.x / level}
                              : (struct vec3){1.0, 0.0, 0.0};
    axes.up = vec3_cross(axes.right, axes.ahead);
    return axes;
}

/* Proportional navigation: a path that turns NAVIGATION times as fast as the line of sight stops
 * that line from turning, and so meets a crossing target without an estimate of the time of flight
 * (Zarchan, Tactical and Strategic Missile Guidance, chapter 2). While the missile is slower than
 * its target, that would turn the target out of the seeker's cone. right, up: fins, -1..1. */
static void navigate(const struct kind *kind, struct vec3 velocity, const struct axes *axes,
                     const struct seen_target *sight, double *right, double *up)
{
    double square = maths_max(vec3_dot(sight->to, sight->to), 1e-6);
    struct vec3 sight_rps = vec3_scale(vec3_cross(sight->to, sight->closing), 1.0 / square);
    bool leads = lead_of(velocity, sight->to) > LEAD_SHARE * kind->seeker_rad;
    struct vec3 pull = vec3_scale(vec3_cross(sight_rps, velocity), leads ? 1.0 : NAVIGATION);
    double most = maths_max(kind->max_load * GRAVITY_MPS2, 1e-9);
    *right = vec3_dot(pull, axes->right) / most;
    *up = vec3_dot(pull, axes->up) / most;
    double size = sqrt(*right * *right + *up * *up);
    if (size > 1.0) {
        *right /= size;
        *up /= size;
    }
}

/* The fins of a missile that has failed stick, and it has no target any more. */
static void swerve(const struct step_context *context, uint32_t i, double *right, double *up)
{
    struct entities *m = context->m;
    m->row[i].target_slot = m->row[i].target_id = 0;
    *right = m->row[i].id % 2 ? STUCK_FINS : -STUCK_FINS;
    *up = -0.5 * STUCK_FINS;
}

/* Turns the velocity by the fins, at most at the kind's rate of turn. */
static struct vec3 turned(const struct step_context *context, uint32_t i, const struct kind *kind,
                          const struct axes *axes, double speed)
{
    double right = (double)context->m->row[i].steer, up = (double)context->m->row[i].climb;
    double size = sqrt(right * right + up * up);
    double angle = size * kind->max_load * GRAVITY_MPS2 * context->dt_s / maths_max(speed, 1.0);
    if (size <= 0.0)
        return vec3_scale(axes->ahead, speed);
    double sine, cosine;
    maths_sincos(maths_min(angle, kind->turn_rate_rps * context->dt_s), &sine, &cosine);
    struct vec3 side =
        vec3_add(vec3_scale(axes->right, right / size), vec3_scale(axes->up, up / size));
    return vec3_add(vec3_scale(axes->ahead, speed * cosine), vec3_scale(side, speed * sine));
}

/* Moves the fins towards what the seeker asks for. */
static void move_fins(const struct step_context *context, uint32_t i, double right, double up)
{
    struct entities *m = context->m;
    double share = context->dt_s / (LAG_S + 0.5 * context->dt_s);
    share = maths_min(share, 1.0);
    m->row[i].steer += (float)((right - (double)m->row[i].steer) * share);
    m->row[i].climb += (float)((up - (double)m->row[i].climb) * share);
}

/* --- fuze --------------------------------------------------------------------------------------*/

/* Bursts where it passes an aircraft near enough in this frame. Otherwise its contact bursts it. */
static void burst_beside(const struct step_context *context, uint32_t i,
                         const struct seen_target *sight, struct vec3 velocity)
{
    struct entities *m = context->m;
    const struct kind *target =
        &context->world->kinds[context->committed->entities.row[m->row[i].target_slot].kind];
    double square = maths_max(vec3_dot(sight->closing, sight->closing), 1e-9);
    double nearest_s = -vec3_dot(sight->to, sight->closing) / square;
    if (target->domain != DOMAIN_AIR || nearest_s < 0.0 || nearest_s > context->dt_s)
        return;
    struct vec3 miss = vec3_add(sight->to, vec3_scale(sight->closing, nearest_s));
    if (vec3_length(miss) > target->radius_m + MISSILE_FUZE_M)
        return;
    entities_set_position(m, i, vec3_add(entities_position(m, i), vec3_scale(velocity, nearest_s)));
    m->row[i].until_tick = (uint32_t)context->tick;
}

void missile_move(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    struct vec3 velocity = entities_velocity(m, i);
    double before = maths_max(vec3_length(velocity), 1e-6), right = 0.0, up = 0.0;
    struct axes axes = axes_of(velocity, before);
    double speed = speed_after(context, i, kind, before);
    struct seen_target sight;
    bool failed = has_failed(context, i, kind);
    bool guided = !failed && sees(context, i, kind, velocity, &sight);
    if (guided)
        navigate(kind, velocity, &axes, &sight, &right, &up);
    if (failed)
        swerve(context, i, &right, &up);
    move_fins(context, i, right, up);
    velocity = turned(context, i, kind, &axes, speed);
    entities_set_velocity(m, i, velocity);
    struct vec3 to = vec3_add(entities_position(m, i), vec3_scale(velocity, context->dt_s));
    if (guided)
        burst_beside(context, i, &sight, velocity);
    if (!guided || m->row[i].until_tick != (uint32_t)context->tick)
        entities_set_position(m, i, to);
}
