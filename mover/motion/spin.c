/* Turns bodies by their spin. Tyres, the water or a pilot slow it. */
#include "mover/motion/spin.h"

#include "mover/motion/kinematics.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"
#include "world/world.h"

#define WATER_DRAG_MPS2 2.0 /* the same for a hull in the water */
#define PILOT_RPS2      1.5 /* how fast a pilot stops the spin of an aircraft */

static void turn_standing(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    double drag = kind->domain == DOMAIN_SEA ? WATER_DRAG_MPS2 : GROUND_GRIP * GRAVITY_MPS2;
    double brake = drag / (0.25 * maths_max(kind->length_m, 1.0));
    m->row[i].heading = maths_wrap_turn(m->row[i].heading - m->row[i].spin_y * context->dt_s);
    m->row[i].spin_x = m->row[i].spin_z = 0.0;
    m->row[i].spin_y = kinematics_approach(m->row[i].spin_y, 0.0, brake * context->dt_s);
}

static void turn_flying(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    const struct mass_properties inertia = mass_properties_of(kind);
    struct vec3 spin = {m->row[i].spin_x, m->row[i].spin_y, m->row[i].spin_z};
    struct quat turned = rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll);
    free_rotation_turn(inertia.moment, &turned, &spin, context->dt_s);
    rotation_angles(turned, &m->row[i].heading, &m->row[i].pitch, &m->row[i].roll);
    if (m->row[i].state == ENTITY_ACTIVE && m->row[i].behaviour != BEHAVIOUR_HOLD) { /* a pilot */
        double rate = vec3_length(spin);
        spin = vec3_scale(spin, maths_max(0.0, rate - PILOT_RPS2 * context->dt_s) / rate);
    }
    m->row[i].spin_x = spin.x;
    m->row[i].spin_y = spin.y;
    m->row[i].spin_z = spin.z;
}

bool spin_row(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (m->row[i].spin_x == 0.0 && m->row[i].spin_y == 0.0 && m->row[i].spin_z == 0.0)
        return false;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    bool flies = kind->domain == DOMAIN_AIR &&
                 (m->row[i].state == ENTITY_ACTIVE ||
                  m->row[i].y > kinematics_ground(context, m->row[i].x, m->row[i].z));
    if (flies)
        turn_flying(context, i, kind);
    else
        turn_standing(context, i, kind);
    return true;
}
