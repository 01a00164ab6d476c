/* Lowers wrecks on water. The velocity (0, -SINK_MPS, 0) says that a wreck sinks. */
#include "mover/motion/ground/sinking.h"

#include "mover/motion/kinematics.h"
#include "world/world.h"

#define HULL_MPS  0.1
#define SINK_MPS  0.1 /* so slow that it begins at once without a gain of energy that shows */
#define HULL_DEEP 0.4 /* of its height: so far a hull settles */
#define UNDER_M   0.5 /* over the highest point of what has gone under */

static bool is_afloat(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return cover_is_water(terrain_cover(&context->world->terrain, m->x[i], m->z[i]));
}

bool sinking_hull(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double surface = kinematics_ground(context, m->x[i], m->z[i]);
    double deepest = surface - (is_afloat(context, i) ? HULL_DEEP * kind->height_m : 0.0);
    double lower = m->y[i] - HULL_MPS * context->dt_s;
    bool sinks = lower > deepest;
    m->y[i] = maths_clamp(lower, deepest, surface);
    m->vy[i] = sinks ? -HULL_MPS : 0.0;
    return sinks;
}

bool sinking_begin(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    if (!is_afloat(context, i))
        return false;
    entities_set_velocity(m, i, (struct vec3){0.0, -SINK_MPS, 0.0});
    m->spin_x[i] = m->spin_y[i] = m->spin_z[i] = 0.0;
    m->until_tick[i] = 0;
    return true;
}

bool sinking_row(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double under = kind->bound_m + UNDER_M;
    bool sinks = m->vx[i] == 0.0 && m->vy[i] == -SINK_MPS && m->vz[i] == 0.0;
    double surface = kinematics_ground(context, m->x[i], m->z[i]);
    if (!sinks && (m->y[i] > surface - under || !is_afloat(context, i)))
        return false;
    m->y[i] = maths_max(m->y[i] - SINK_MPS * context->dt_s, surface - under);
    if (m->y[i] > surface - under)
        return true;
    entities_set_velocity(m, i, (struct vec3){0.0, 0.0, 0.0});
    m->spin_x[i] = m->spin_y[i] = m->spin_z[i] = 0.0;
    m->until_tick[i] = (uint32_t)context->tick;
    return true;
}
