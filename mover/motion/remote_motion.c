/* Dead reckoning of remote entities. */
#include "mover/motion/remote_motion.h"

#include "mover/motion/kinematics.h"
#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/maths/dead_reckoning.h"
#include "world/maths/rotation.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_clamp.h"
#include "world/world.h"

static const struct mat3 identity = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

static unsigned model_of(const struct entities *m, uint32_t i)
{
    return m->row[i].order_arg & REMOTE_MODEL_MASK;
}

static bool turns(unsigned model)
{
    return model == DEAD_RECKONING_RPW || model == DEAD_RECKONING_RVW ||
           model == DEAD_RECKONING_RPB || model == DEAD_RECKONING_RVB;
}

static bool accelerates(unsigned model)
{
    return model == DEAD_RECKONING_RVW || model == DEAD_RECKONING_FVW ||
           model == DEAD_RECKONING_RVB || model == DEAD_RECKONING_FVB;
}

static struct vec3 spin_of(const struct entities *m, uint32_t i)
{
    return (struct vec3){m->row[i].spin_x, m->row[i].spin_y, m->row[i].spin_z};
}

/* The owner has been silent for too long to be extrapolated. */
static void stop(struct entities *m, uint32_t i)
{
    m->row[i].order_arg = (m->row[i].order_arg & ~REMOTE_MODEL_MASK) | DEAD_RECKONING_STATIC;
    entities_set_velocity(m, i, (struct vec3){0.0, 0.0, 0.0});
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
    m->row[i].climb = m->row[i].traverse = m->row[i].elevate = 0.0f;
}

static void set_acceleration(struct entities *m, uint32_t i, struct vec3 acceleration)
{
    m->row[i].climb = (float)acceleration.x;
    m->row[i].traverse = (float)acceleration.y;
    m->row[i].elevate = (float)acceleration.z;
}

/* Leads a row whose axes turn with the body to its state one frame later. The body axes of the
 * formula are those of the world at the frame's beginning. */
static struct vec3 extrapolate_body(const struct step_context *context, uint32_t i, unsigned model)
{
    struct entities *m = context->m;
    struct dead_reckoning state = {.model = (uint8_t)model,
                                   .position = entities_position(m, i),
                                   .velocity = entities_velocity(m, i),
                                   .acceleration = remote_acceleration(m, i),
                                   .rates = spin_of(m, i),
                                   .matrix = identity};
    struct vec3 at, velocity = state.velocity;
    struct mat3 since;
    dead_reckoning_at(&state, context->dt_s, &at, &since);
    if (accelerates(model))
        velocity = vec3_add(velocity, vec3_scale(state.acceleration, context->dt_s));
    entities_set_velocity(m, i, rotation_apply(&since, velocity));
    set_acceleration(m, i, rotation_apply(&since, state.acceleration));
    return at;
}

/* Leads the row to the model's state one frame later, and returns the place. */
static struct vec3 extrapolate(const struct step_context *context, uint32_t i, unsigned model)
{
    struct entities *m = context->m;
    if (model == DEAD_RECKONING_RPB || model == DEAD_RECKONING_RVB)
        return extrapolate_body(context, i, model);
    struct vec3 velocity = entities_velocity(m, i);
    struct vec3 at = vec3_add(entities_position(m, i), vec3_scale(velocity, context->dt_s));
    if (!accelerates(model))
        return at;
    struct vec3 gain = vec3_scale(remote_acceleration(m, i), context->dt_s);
    entities_set_velocity(m, i, vec3_add(velocity, gain));
    return vec3_add(at, vec3_scale(gain, 0.5 * context->dt_s));
}

static void turn(const struct step_context *context, uint32_t i, struct vec3 rates_rps)
{
    struct entities *m = context->m;
    if (vec3_dot(rates_rps, rates_rps) == 0.0)
        return;
    struct quat now = rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll);
    rotation_angles(rotation_spun(now, rates_rps, context->dt_s), &m->row[i].heading,
                    &m->row[i].pitch, &m->row[i].roll);
}

bool remote_motion_stands(const struct entities *m, uint32_t i)
{
    return model_of(m, i) == DEAD_RECKONING_STATIC;
}

bool remote_motion_move(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    uint32_t tick = (uint32_t)context->tick;
    double silent_s = (double)(tick - m->row[i].seen_tick) * context->dt_s;
    unsigned model = model_of(m, i);
    if (model == DEAD_RECKONING_STATIC)
        return true;
    if (silent_s > REMOTE_TRUST_S ||
        silent_s * vec3_length(entities_velocity(m, i)) > REMOTE_TRUST_M) {
        stop(m, i);
        return true;
    }
    struct vec3 at = extrapolate(context, i, model);
    if (turns(model))
        turn(context, i, spin_of(m, i));
    if (!world_holds(context->world, at.x, at.z))
        return false;
    if (m->row[i].order_arg >> REMOTE_FLAGS_SHIFT & REMOTE_FLAG_CLAMPED)
        (void)ground_clamp(&context->world->terrain, context->craters, REMOTE_CLAMP_M, &at);
    entities_set_position(m, i, at);
    return true;
}
