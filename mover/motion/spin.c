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
    m->heading[i] = maths_wrap_turn(m->heading[i] - m->spin_y[i] * context->dt_s);
    m->spin_x[i] = m->spin_z[i] = 0.0;
    m->spin_y[i] = kinematics_approach(m->spin_y[i], 0.0, brake * context->dt_s);
}

static void turn_flying(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    struct entities *m = context->m;
    const struct mass_properties inertia = mass_properties_of(kind);
    struct vec3 spin = {m->spin_x[i], m->spin_y[i], m->spin_z[i]};
    struct quat turned = rotation_of(m->heading[i], m->pitch[i], m->roll[i]);
    free_rotation_turn(inertia.moment, &turned, &spin, context->dt_s);
    rotation_angles(turned, &m->heading[i], &m->pitch[i], &m->roll[i]);
    if (m->state[i] == ENTITY_ACTIVE && m->behaviour[i] != BEHAVIOUR_HOLD) { /* a pilot */
        double rate = vec3_length(spin);
        spin = vec3_scale(spin, maths_max(0.0, rate - PILOT_RPS2 * context->dt_s) / rate);
    }
    m->spin_x[i] = spin.x;
    m->spin_y[i] = spin.y;
    m->spin_z[i] = spin.z;
}

bool spin_row(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (m->spin_x[i] == 0.0 && m->spin_y[i] == 0.0 && m->spin_z[i] == 0.0)
        return false;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    bool flies =
        kind->domain == DOMAIN_AIR &&
        (m->state[i] == ENTITY_ACTIVE || m->y[i] > kinematics_ground(context, m->x[i], m->z[i]));
    if (flies)
        turn_flying(context, i, kind);
    else
        turn_standing(context, i, kind);
    return true;
}
