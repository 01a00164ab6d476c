/* Moves munitions: ballistic by gravity and drag; missile.h has the guided ones. */
#include "mover/motion/projectile.h"

#include "mover/motion/drag.h"
#include "mover/motion/missile.h"
#include "world/world.h"

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
        missile_move(context, i, kind);
    } else {
        fall(context, i, kind);
    }
    double level = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
    if (level > 0.0)
        m->heading[i] = maths_heading(m->vx[i], m->vz[i]);
    m->pitch[i] = maths_atan2(m->vy[i], level);
}
