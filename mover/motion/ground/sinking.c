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
    return cover_is_water(terrain_cover(&context->world->terrain, m->row[i].x, m->row[i].z));
}

bool sinking_hull(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double surface = kinematics_ground(context, m->row[i].x, m->row[i].z);
    double deepest = surface - (is_afloat(context, i) ? HULL_DEEP * kind->height_m : 0.0);
    double lower = m->row[i].y - HULL_MPS * context->dt_s;
    bool sinks = lower > deepest;
    m->row[i].y = maths_clamp(lower, deepest, surface);
    m->row[i].vy = sinks ? -HULL_MPS : 0.0;
    return sinks;
}

bool sinking_begin(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    if (!is_afloat(context, i))
        return false;
    entities_set_velocity(m, i, (struct vec3){0.0, -SINK_MPS, 0.0});
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
    m->row[i].until_tick = 0;
    return true;
}

bool sinking_row(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double under = kind->bound_m + UNDER_M;
    bool sinks = m->row[i].vx == 0.0 && m->row[i].vy == -SINK_MPS && m->row[i].vz == 0.0;
    double surface = kinematics_ground(context, m->row[i].x, m->row[i].z);
    if (!sinks && (m->row[i].y > surface - under || !is_afloat(context, i)))
        return false;
    m->row[i].y = maths_max(m->row[i].y - SINK_MPS * context->dt_s, surface - under);
    if (m->row[i].y > surface - under)
        return true;
    entities_set_velocity(m, i, (struct vec3){0.0, 0.0, 0.0});
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
    m->row[i].until_tick = (uint32_t)context->tick;
    return true;
}
