/* Moves munitions: ballistic by gravity and drag; missile.h has the guided ones. */
#include "mover/motion/projectile.h"

#include "mover/motion/drag.h"
#include "mover/motion/missile.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

/* Returns the acceleration of a round by drag, which acts against its speed in the air, and
 * gravity. */
static struct vec3 acceleration(const struct kind *kind, struct vec3 velocity, struct vec3 wind,
                                double height_m)
{
    struct vec3 air = vec3_sub(velocity, wind);
    double rate = drag_rate(kind, vec3_length(air), height_m);
    return (struct vec3){-rate * air.x, -rate * air.y - GRAVITY_MPS2, -rate * air.z};
}

/* The midpoint method: exact without drag. */
void projectile_fall(const struct kind *kind, struct vec3 wind, double dt_s, struct vec3 *at,
                     struct vec3 *velocity)
{
    struct vec3 begun = acceleration(kind, *velocity, wind, at->y);
    struct vec3 middle = vec3_add(*velocity, vec3_scale(begun, 0.5 * dt_s));
    struct vec3 mean = acceleration(kind, middle, wind, at->y + 0.5 * dt_s * velocity->y);
    *at = vec3_add(*at, vec3_scale(middle, dt_s));
    *velocity = vec3_add(*velocity, vec3_scale(mean, dt_s));
}

struct vec3 projectile_wind(const struct params *params)
{
    double sine, cosine;
    maths_sincos(params->wind_from_rad, &sine, &cosine);
    return (struct vec3){-params->wind_mps * sine, 0.0, params->wind_mps * cosine};
}

static void fall(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    struct vec3 at = entities_position(m, i), velocity = entities_velocity(m, i);
    projectile_fall(kind, context->wind, context->dt_s, &at, &velocity);
    entities_set_position(m, i, at);
    entities_set_velocity(m, i, velocity);
}

void projectile_move(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (kind->guidance == GUIDANCE_HOMING) {
        missile_move(context, i, kind);
    } else {
        fall(context, i, kind);
    }
    double level = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    if (level > 0.0)
        m->row[i].heading = maths_heading(m->row[i].vx, m->row[i].vz);
    m->row[i].pitch = maths_atan2(m->row[i].vy, level);
}
