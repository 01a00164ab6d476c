/* Moves munitions: ballistic by gravity and drag, or homing by proportional navigation. */
#include "mover/motion/projectile.h"

#include "mover/motion/drag.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/world.h"

#define BOOST_MPS2 300.0 /* a missile's acceleration to full speed */
#define NAVIGATION 4.0   /* the path turns so many times as fast as the line of sight */

/* Turns velocity towards direction (unit) by at most most_rad, keeping its length. */
static struct vec3 turned(struct vec3 velocity, struct vec3 direction, double most_rad)
{
    double speed = vec3_length(velocity);
    if (speed <= 0.0)
        return velocity;
    struct vec3 ahead = vec3_scale(velocity, 1.0 / speed);
    double along = vec3_dot(ahead, direction);
    struct vec3 side = vec3_sub(direction, vec3_scale(ahead, along));
    double across = vec3_length(side);
    double angle = maths_atan2(across, along);
    if (angle <= most_rad)
        return vec3_scale(direction, speed);
    if (across <= 0.0) { /* straight behind: it may turn to either side */
        side = (struct vec3){-ahead.z, 0.0, ahead.x};
        across = maths_max(vec3_length(side), 1e-12);
    }
    double sine, cosine;
    maths_sincos(most_rad, &sine, &cosine);
    return vec3_add(vec3_scale(ahead, speed * cosine), vec3_scale(side, speed * sine / across));
}

/* Returns true if the target is in the seeker's cone. Its range is not limited. */
static bool sees(const struct kind *kind, struct vec3 velocity, struct vec3 to)
{
    double across = vec3_length(vec3_cross(velocity, to)), along = vec3_dot(velocity, to);
    return maths_atan2(across, along) <= kind->seeker_rad;
}

/* The direction (unit) to fly for a target at `to` that moves at `closing`, relative to the
 * missile. A path that turns NAVIGATION times as fast as the line of sight stops that line from
 * turning, and so meets a crossing target without an estimate of the time of flight (Zarchan,
 * Tactical and Strategic Missile Guidance, chapter 2). */
static struct vec3 navigated(struct vec3 velocity, struct vec3 to, struct vec3 closing, double dt_s)
{
    double square = maths_max(vec3_dot(to, to), 1e-6);
    struct vec3 sight_rps = vec3_scale(vec3_cross(to, closing), 1.0 / square);
    struct vec3 turn = vec3_scale(vec3_cross(sight_rps, velocity), NAVIGATION * dt_s);
    struct vec3 next = vec3_add(velocity, turn);
    return vec3_scale(next, 1.0 / maths_max(vec3_length(next), 1e-9));
}

static void home(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    uint32_t target = m->target_slot[i];
    struct vec3 velocity = entities_velocity(m, i);
    double speed = vec3_length(velocity);
    double faster = kinematics_approach(speed, kind->max_speed_mps, BOOST_MPS2 * context->dt_s);
    if (speed > 0.0)
        velocity = vec3_scale(velocity, faster / speed);
    if (m->target_id[i] != 0 && entities_alive(w, target, m->target_id[i])) {
        struct vec3 to = vec3_sub(entities_position(w, target), entities_position(m, i));
        to.y += kinematics_aim_height(context, w->kind[target]);
        if (sees(kind, velocity, to))
            velocity =
                turned(velocity,
                       navigated(velocity, to, vec3_sub(entities_velocity(w, target), velocity),
                                 context->dt_s),
                       kind->turn_rate_rps * context->dt_s);
        else /* a target that has left the seeker's cone is lost for good */
            m->target_slot[i] = m->target_id[i] = 0;
    }
    entities_set_velocity(m, i, velocity);
    entities_set_position(m, i,
                          vec3_add(entities_position(m, i), vec3_scale(velocity, context->dt_s)));
}

/* Returns the acceleration of a round by drag and gravity. */
static struct vec3 acceleration(const struct kind *kind, struct vec3 velocity, double height_m)
{
    double rate = drag_rate(kind, vec3_length(velocity), height_m);
    return (struct vec3){-rate * velocity.x, -rate * velocity.y - GRAVITY_MPS2, -rate * velocity.z};
}

/* The midpoint method: exact without drag. */
static void fall(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    double dt_s = context->dt_s;
    struct vec3 at = entities_position(m, i), velocity = entities_velocity(m, i);
    struct vec3 begun = acceleration(kind, velocity, at.y);
    struct vec3 middle = vec3_add(velocity, vec3_scale(begun, 0.5 * dt_s));
    struct vec3 mean = acceleration(kind, middle, at.y + 0.5 * dt_s * velocity.y);
    entities_set_position(m, i, vec3_add(at, vec3_scale(middle, dt_s)));
    entities_set_velocity(m, i, vec3_add(velocity, vec3_scale(mean, dt_s)));
}

void projectile_move(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    if (kind->guidance == GUIDANCE_HOMING) {
        home(context, i, kind);
    } else {
        fall(context, i, kind);
    }
    double level = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
    if (level > 0.0)
        m->heading[i] = maths_heading(m->vx[i], m->vz[i]);
    m->pitch[i] = maths_atan2(m->vy[i], level);
}
