/* Munitions: ballistic under gravity alone, or homing on their target. */
#include "mover/move.h"

#define BOOST_MPS2 300.0 /* a missile's acceleration to full speed */

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
    if (across <= 0.0) { /* straight behind: any way round will do */
        side = (struct vec3){-ahead.z, 0.0, ahead.x};
        across = maths_max(vec3_length(side), 1e-12);
    }
    double sine, cosine;
    maths_sincos(most_rad, &sine, &cosine);
    return vec3_add(vec3_scale(ahead, speed * cosine), vec3_scale(side, speed * sine / across));
}

static void home(const struct move *move, uint32_t i, const struct kind *kind)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    struct vec3 velocity = entities_velocity(m, i);
    double speed = vec3_length(velocity);
    double faster = pose_approach(speed, kind->max_speed_mps, BOOST_MPS2 * move->dt_s);
    if (speed > 0.0)
        velocity = vec3_scale(velocity, faster / speed);
    if (entities_alive(w, m->target_slot[i], m->target_id[i])) {
        uint32_t target = m->target_slot[i];
        struct vec3 to = vec3_sub(entities_position(w, target), entities_position(m, i));
        double distance = vec3_length(to);
        /* Lead: where the target is after the time of flight. */
        to = vec3_add(to,
                      vec3_scale(entities_velocity(w, target), distance / maths_max(faster, 1.0)));
        to.y += pose_aim_height(move, w->kind[target]);
        distance = vec3_length(to);
        if (distance > 0.0)
            velocity =
                turned(velocity, vec3_scale(to, 1.0 / distance), kind->turn_rate_rps * move->dt_s);
    }
    entities_set_velocity(m, i, velocity);
    entities_set_position(m, i,
                          vec3_add(entities_position(m, i), vec3_scale(velocity, move->dt_s)));
}

void move_flight(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    if (kind->guidance == GUIDANCE_HOMING) {
        home(move, i, kind);
    } else { /* exact for constant gravity */
        m->x[i] += m->vx[i] * move->dt_s;
        m->y[i] += (m->vy[i] - 0.5 * GRAVITY_MPS2 * move->dt_s) * move->dt_s;
        m->z[i] += m->vz[i] * move->dt_s;
        m->vy[i] -= GRAVITY_MPS2 * move->dt_s;
    }
    double level = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
    if (level > 0.0)
        m->heading[i] = maths_heading(m->vx[i], m->vz[i]);
    m->pitch[i] = maths_atan2(m->vy[i], level);
}
