/* Plays the steps of a script, one after the other or by the clock. */
#include "mover/agent/script_player.h"

#include "mover/agent/perception.h"
#include "mover/agent/driver_controls.h"
#include "mover/agent/goal.h"
#include "mover/agent/driving/shunting.h"
#include "mover/motion/kinematics.h"
#include "world/entity/script.h"
#include "world/state.h"
#include "world/world.h"

#define CRUISE_SHARE  0.75 /* share of full speed where a step gives no speed */
#define THERE_M       1.0  /* it has arrived within this and the path of a frame */
#define FACED_RAD     0.01 /* it faces a heading within this */
#define FOLLOW_S      0.7  /* time in which a helicopter's speed follows the wanted speed */
#define STANDS_MPS    0.05
#define LEVEL_M       2.0  /* it has a height within this */
#define AGILE_SHARE   0.35 /* share of the turn rate that a body has even at rest */
#define SHOT_WAIT_S   20.0 /* a shot that is not possible for so long is given up */
#define STEPS_A_FRAME 64   /* more steps that end at once go on in the next frame */

/* A row on its script. */
struct reading {
    const struct step_context *context;
    const struct script *script;
    const struct script_step *steps;
    const struct kind *kind;
    uint32_t i;
    double begin_s, end_s; /* simulated time at the beginning and at the end of the frame */
};

static struct reading read_row(const struct step_context *context, uint32_t i)
{
    const struct world *world = context->world;
    const struct script *script = &world->scripts[context->m->row[i].order_arg];
    return (struct reading){
        .context = context,
        .script = script,
        .steps = world->script_steps + script->first,
        .kind = &world->kinds[context->m->row[i].kind],
        .i = i,
        .begin_s = (double)(context->tick - 1) * context->dt_s,
        .end_s = (double)context->tick * context->dt_s,
    };
}

static uint32_t pass_of(const struct reading *r)
{
    return r->context->m->row[r->i].leg / r->script->count;
}

static const struct script_step *step_of(const struct reading *r)
{
    return &r->steps[r->context->m->row[r->i].leg % r->script->count];
}

/* Returns the time left until the step is due: an arrival at the end of a frame, and any other step
 * at the beginning of the first frame that it acts in, whatever the rate. */
static double seconds_to(const struct reading *r, const struct script_step *step)
{
    double now_s = step->type == STEP_ARRIVE ? r->end_s : r->begin_s;
    return step->at_s + (double)pass_of(r) * r->script->period_s - now_s;
}

/* Returns true if the time has come, rounded to frames. */
static bool is_time(const struct reading *r, double seconds)
{
    return seconds < 0.5 * r->context->dt_s;
}

static uint32_t tick_after(const struct reading *r, double seconds)
{
    return (uint32_t)(r->context->tick + (uint64_t)(seconds / r->context->dt_s + 0.5));
}

static void say(const struct reading *r, enum behaviour behaviour, enum agent_reason reason)
{
    struct entities *m = r->context->m;
    m->row[r->i].behaviour = (uint8_t)behaviour;
    m->row[r->i].trigger = (uint8_t)((m->row[r->i].trigger & (TRIGGER_FIRE | TRIGGER_FIRE_AT)) |
                                     (unsigned)(reason + 1) << TRIGGER_REASON_SHIFT);
}

/* --- from step to step -------------------------------------------------------------------------*/

static void begin(const struct reading *r, uint32_t leg)
{
    struct entities *m = r->context->m;
    m->row[r->i].leg = leg;
    m->row[r->i].until_tick = 0;
    m->row[r->i].throttle = m->row[r->i].steer = m->row[r->i].climb = 0.0f;
}

/* Begins the next step. Returns false if there is none; the row is then idle. */
static bool begin_next(const struct reading *r)
{
    struct entities *m = r->context->m;
    uint32_t leg = m->row[r->i].leg + 1;
    if (leg % r->script->count == 0 && !r->script->repeats) {
        m->row[r->i].order = BEHAVIOUR_IDLE;
        if (m->row[r->i].trigger >> TRIGGER_REASON_SHIFT) /* its arrival is this frame's event */
            m->row[r->i].behaviour = BEHAVIOUR_IDLE;
        else
            say(r, BEHAVIOUR_IDLE, REASON_SCRIPT);
        return false;
    }
    begin(r, leg);
    return true;
}

/* Cuts off the steps before a step whose time has come. A point whose time has passed is given up
 * when the next is due. Returns false if nothing is cut off. */
static bool cut_off(const struct reading *r)
{
    const struct entities *m = r->context->m;
    const struct script_step *step = step_of(r);
    uint32_t index = m->row[r->i].leg % r->script->count, first = m->row[r->i].leg - index;
    if (r->script->period_s > 0.0 &&
        is_time(r, (double)(pass_of(r) + 1) * r->script->period_s - r->begin_s)) {
        begin(r, first + r->script->count);
        return true;
    }
    if (step->next_due != UINT32_MAX && is_time(r, seconds_to(r, &r->steps[step->next_due]))) {
        begin(r, first + step->next_due);
        return true;
    }
    if (step->type == STEP_ARRIVE && index + 1 < r->script->count && step[1].type == STEP_ARRIVE &&
        is_time(r, seconds_to(r, &step[1]))) {
        begin(r, first + index + 1);
        return true;
    }
    return false;
}

/* --- speed -------------------------------------------------------------------------------------*/

static double distance_to(const struct reading *r, const struct script_step *step)
{
    const struct entities *m = r->context->m;
    double dx = step->x - m->row[r->i].x, dz = step->z - m->row[r->i].z;
    return sqrt(dx * dx + dz * dz);
}

static double speed_now(const struct reading *r)
{
    const struct entities *m = r->context->m;
    return sqrt(m->row[r->i].vx * m->row[r->i].vx + m->row[r->i].vz * m->row[r->i].vz);
}

/* Braking that it can rely on [m/s2]. A helicopter has to lean back first. */
static double slowing(const struct reading *r)
{
    double share = r->kind->domain == DOMAIN_LAND ? 0.8 * BRAKES : 0.75;
    return maths_max(share * r->kind->acceleration_mps2, 0.01);
}

/* The highest speed at which it can still turn to a point at this distance and angle. */
static double turning_speed(const struct reading *r, double metres, double off_rad)
{
    double sine, cosine;
    maths_sincos(fabs(off_rad), &sine, &cosine);
    double across = fabs(off_rad) < HALF_PI ? sine : 1.0;
    return AGILE_SHARE * r->kind->turn_rate_rps * metres / maths_max(2.0 * across, 1e-6);
}

/* The speed for a distance and a time. If it halts at the end it brakes at b in the last part of
 * the s seconds, so the distance at speed v is v s - v^2 / 2 b. */
static double timed_speed(const struct reading *r, const struct script_step *step, double metres,
                          double seconds)
{
    double brake = slowing(r);
    if (!is_time(r, seconds) && !step->halt)
        return metres / seconds;
    if (!is_time(r, seconds) && seconds * seconds > 2.0 * metres / brake)
        return brake * (seconds - sqrt(seconds * seconds - 2.0 * metres / brake));
    return r->kind->max_speed_mps;
}

static void desire_point(const struct reading *r, const struct script_step *step, double speed,
                         struct desired_motion *desired)
{
    struct entities *m = r->context->m;
    double metres = distance_to(r, step);
    m->row[r->i].goal_x = step->x;
    m->row[r->i].goal_z = step->z;
    desired->speed_mps = speed;
    if (metres > THERE_M)
        shunting_drive(r->context, r->i, step->x - m->row[r->i].x, step->z - m->row[r->i].z, speed,
                       desired);
    double off = maths_wrap_half(desired->heading_rad - m->row[r->i].heading), most = speed;
    if (step->halt) {
        double late = kind_hovers(r->kind) ? FOLLOW_S * slowing(r) : 0.0;
        most = maths_max(sqrt(2.0 * slowing(r) * metres) - late, 0.0);
    }
    most = maths_min(most, turning_speed(r, metres, off));
    desired->speed_mps = maths_clamp(desired->speed_mps, -most, most);
}

/* Returns true if it is at its point. A row that continues from there need only pass as near as it
 * can turn. */
static bool is_there(const struct reading *r, const struct script_step *step)
{
    double near = THERE_M + speed_now(r) * r->context->dt_s;
    if (r->kind->min_speed_mps > 0.0)
        near += 2.0 * r->kind->max_speed_mps / maths_max(r->kind->turn_rate_rps, 0.01);
    else if (!step->halt)
        near += r->kind->radius_m;
    return distance_to(r, step) < near;
}

/* --- steps: each sets the desired motion and returns true when it is over ----------------------*/

static bool move_to_point(const struct reading *r, const struct script_step *step,
                          struct desired_motion *desired)
{
    desire_point(r, step, step->amount > 0.0 ? step->amount : CRUISE_SHARE * r->kind->max_speed_mps,
                 desired);
    if (!is_there(r, step))
        return false;
    say(r, BEHAVIOUR_SCRIPT, REASON_ARRIVED);
    return true;
}

/* The step ends at its time. */
static bool arrive(const struct reading *r, const struct script_step *step,
                   struct desired_motion *desired)
{
    double seconds = seconds_to(r, step);
    /* The distance is measured before the motion of this frame, the time after it. */
    desire_point(r, step, timed_speed(r, step, distance_to(r, step), seconds + r->context->dt_s),
                 desired);
    if (!is_time(r, seconds) ||
        (!is_there(r, step) &&
         distance_to(r, step) > fabs(desired->speed_mps) * r->context->dt_s + THERE_M))
        return false;
    say(r, BEHAVIOUR_SCRIPT, REASON_ARRIVED);
    return true;
}

static bool face(const struct reading *r, const struct script_step *step,
                 struct desired_motion *desired)
{
    return shunting_face(r->context, r->i, step->amount, FACED_RAD, desired);
}

/* Waits until its own time, or for a duration since it began. */
static bool wait(const struct reading *r, const struct script_step *step)
{
    uint32_t *until = &r->context->m->row[r->i].until_tick;
    if (step->at_s >= 0.0)
        return is_time(r, seconds_to(r, step) + step->amount);
    if (*until == 0)
        *until = tick_after(r, step->amount);
    return r->context->tick >= *until;
}

static bool controls(const struct reading *r, const struct script_step *step,
                     struct desired_motion *desired)
{
    struct entities *m = r->context->m;
    if (wait(r, step))
        return true;
    m->row[r->i].throttle = step->throttle;
    m->row[r->i].steer = step->steer;
    m->row[r->i].climb = step->climb;
    driver_controls_motion(r->context, r->i, desired);
    return false;
}

/* Asks for a shot until it has been fired or has been impossible for too long. A vehicle without a
 * turret turns its hull to the target. */
static bool fire(const struct reading *r, const struct script_step *step,
                 struct desired_motion *desired)
{
    struct entities *m = r->context->m;
    const struct entities *w = &r->context->committed->entities;
    uint32_t i = r->i, tick = (uint32_t)r->context->tick, target = step->target_slot;
    bool loaded = tick >= m->row[i].reload_tick;
    if (r->kind->munition == KIND_NONE || m->row[i].rounds == 0 ||
        (m->row[i].until_tick != 0 && !loaded)) /* it has fired and is loading */
        return true;
    if (step->type == STEP_FIRE &&
        (!entities_alive(w, target, target + 1) || w->row[target].state != ENTITY_ACTIVE))
        return true;
    if (step->type == STEP_FIRE) {
        m->row[i].target_slot = target;
        m->row[i].target_id = target + 1;
    }
    if (!loaded)
        return false;
    if (m->row[i].until_tick == 0)
        m->row[i].until_tick = tick_after(r, SHOT_WAIT_S);
    m->row[i].trigger |= step->type == STEP_FIRE ? TRIGGER_FIRE : TRIGGER_FIRE_AT;
    m->row[i].goal_x = step->type == STEP_FIRE ? m->row[i].goal_x : step->x;
    m->row[i].goal_z = step->type == STEP_FIRE ? m->row[i].goal_z : step->z;
    struct vec3 at = {step->x, 0.0, step->z};
    if (step->type == STEP_FIRE)
        at = step_context_position(r->context, w, target);
    if (!(r->kind->turret_rate_rps > 0.0))
        (void)shunting_face(r->context, i, maths_heading(at.x - m->row[i].x, at.z - m->row[i].z),
                            FACED_RAD, desired);
    return tick >= m->row[i].until_tick;
}

static bool climb(const struct reading *r, const struct script_step *step)
{
    const struct entities *m = r->context->m;
    double height = m->row[r->i].y - kinematics_ground(r->context, m->row[r->i].x, m->row[r->i].z);
    return r->kind->domain != DOMAIN_AIR || fabs(height - step->altitude_m) < LEVEL_M;
}

/* Returns the vehicle to its agent with an order. A vehicle that withdraws then stays at its
 * base. */
static void order(const struct reading *r, const struct script_step *step)
{
    struct entities *m = r->context->m;
    bool home = step->behaviour == BEHAVIOUR_WITHDRAW;
    m->row[r->i].order = (uint8_t)(home ? BEHAVIOUR_IDLE : step->behaviour);
    m->row[r->i].order_arg = step->order_arg;
    m->row[r->i].leg = 0;
    m->row[r->i].until_tick = 0;
    m->row[r->i].goal_x = m->row[r->i].x; /* has arrived, so its agent chooses the next goal */
    m->row[r->i].goal_z = m->row[r->i].z;
    if (home) /* to its own place there */
        goal_base(r->context, r->i);
    say(r, (enum behaviour)step->behaviour, REASON_SCRIPT);
}

/* Carries out the present step. Returns true if it is over; the next can then begin in the same
 * frame. */
static bool do_step(const struct reading *r, struct desired_motion *desired)
{
    const struct script_step *step = step_of(r);
    *desired = (struct desired_motion){.heading_rad = r->context->m->row[r->i].heading,
                                       .altitude_m = step->altitude_m};
    if (step->type != STEP_ARRIVE && step->at_s >= 0.0 && !is_time(r, seconds_to(r, step)))
        return false; /* it stands until its time */
    switch ((enum step_type)step->type) {
    case STEP_GO:
        return move_to_point(r, step, desired);
    case STEP_ARRIVE:
        return arrive(r, step, desired);
    case STEP_FACE:
        return face(r, step, desired);
    case STEP_STOP:
        return speed_now(r) <= maths_max(STANDS_MPS, r->kind->min_speed_mps);
    case STEP_WAIT:
        return wait(r, step);
    case STEP_FIRE:
    case STEP_FIRE_AT:
        return fire(r, step, desired);
    case STEP_CONTROLS:
        return controls(r, step, desired);
    case STEP_ALTITUDE:
        return climb(r, step);
    default:
        order(r, step);
        return false;
    }
}

/* A row has one event a frame at most. After an arrival the script goes on in the next frame. */
void script_player_motion(const struct step_context *context, uint32_t i,
                          struct desired_motion *desired)
{
    const struct reading r = read_row(context, i);
    for (int n = 0; n < STEPS_A_FRAME && cut_off(&r); n++)
        continue;
    for (int n = 0; n < STEPS_A_FRAME && do_step(&r, desired); n++) {
        if (!begin_next(&r) || context->m->row[i].trigger != 0)
            return;
    }
}

void script_player_resume(const struct step_context *context, uint32_t i)
{
    context->m->row[i].until_tick = (uint32_t)context->tick;
}

uint32_t script_player_percepts(const struct step_context *context, uint32_t i)
{
    const struct script *script = &context->world->scripts[context->m->row[i].order_arg];
    return script->reacts ? UINT32_MAX
                          : PERCEPTION_BIT(NO_FUEL) | PERCEPTION_BIT(BUMP) |
                                PERCEPTION_BIT(TIME_OVER) | PERCEPTION_BIT(LEASE_OVER) |
                                PERCEPTION_BIT(STALLED) | PERCEPTION_BIT(STUCK_FAST);
}
