/* Shaping: curves of devices, and time of keys. */
#include "clients/drive/control_shaping.h"

#include "world/maths/maths.h"

#define NS_A_SECOND 1e9

/* The longest step at once: after a stop nothing jumps. [s] */
#define STEP_MAX_S 0.1

/* The order in which one shifts. */
static const enum gearing shifts[GEAR_COUNT] = {GEAR_REVERSE, GEAR_NEUTRAL, GEAR_LOW,
                                                GEAR_AUTOMATIC};

double control_shaping_shape(double value)
{
    double size = maths_clamp(fabs(value), 0.0, 1.0);
    if (!(size > CONTROL_SHAPING_DEAD))
        return 0.0;
    size = (size - CONTROL_SHAPING_DEAD) / (1.0 - CONTROL_SHAPING_DEAD);
    size *= CONTROL_SHAPING_LINEAR + (1.0 - CONTROL_SHAPING_LINEAR) * size * size;
    return value < 0.0 ? -size : size;
}

void control_shaping_reset(struct control_shaping *stick, uint64_t now_ns)
{
    *stick = (struct control_shaping){.gear = GEAR_AUTOMATIC, .step_ns = now_ns};
}

/* A press moves at once, so that a tap does something too. */
static void kick(struct control_shaping *stick, enum input_axis axis, int way)
{
    struct control_shaping_axis *a = &stick->axis[axis];
    if (axis == AXIS_THROTTLE) {
        stick->lever_wait = stick->lever * way < 0.0 && fabs(stick->lever) <= LEVER_KICK;
        stick->lever =
            stick->lever_wait ? 0.0 : maths_clamp(stick->lever + way * LEVER_KICK, -1.0, 1.0);
        return;
    }
    if (a->key * way < 0.0)
        a->key = 0.0;
    a->key = maths_clamp(a->key + way * KEY_KICK, axis == AXIS_BRAKE ? 0.0 : -1.0, 1.0);
}

static void key_down(struct control_shaping *stick, const struct intent *event, uint64_t now_ns)
{
    struct control_shaping_axis *a = &stick->axis[event->axis];
    int way = event->value < 0.0f ? -1 : 1;
    bool again = a->held == way;
    if (!again) {
        /* Between a press and its auto-repeat nothing is heard: it is still the same push. */
        bool same = !event->lifts && a->way == way && now_ns - a->last_ns < KEY_SAME_NS;
        if (!same)
            a->down_ns = now_ns;
        kick(stick, event->axis, way);
    }
    a->held = a->way = way;
    a->last_ns = now_ns;
    a->until_ns = event->lifts ? UINT64_MAX : now_ns + (again ? KEY_REPEAT_NS : KEY_FIRST_NS);
}

void control_shaping_take(struct control_shaping *stick, const struct intent *event,
                          uint64_t now_ns)
{
    struct control_shaping_axis *a = &stick->axis[event->axis];
    switch (event->type) {
    case INTENT_SET:
        a->hand = control_shaping_shape((double)event->value);
        if (event->axis == AXIS_THROTTLE)
            stick->lever = a->hand;
        break;
    case INTENT_RATE:
        a->rate = control_shaping_shape((double)event->value);
        break;
    case INTENT_DOWN:
        key_down(stick, event, now_ns);
        break;
    case INTENT_UP:
        if ((double)a->held * (double)event->value > 0.0)
            a->held = 0;
        break;
    case INTENT_ACT:
        break;
    }
}

void control_shaping_stop(struct control_shaping *stick)
{
    stick->lever = 0.0;
    for (int i = 0; i < AXIS_COUNT; i++) {
        stick->axis[i].held = 0;
        stick->axis[i].key = 0.0;
    }
}

void control_shaping_gear(struct control_shaping *stick, int by)
{
    int at = 0;
    while (shifts[at] != stick->gear)
        at++;
    at += by;
    stick->gear = shifts[at < 0 ? 0 : at >= GEAR_COUNT ? GEAR_COUNT - 1 : at];
}

static void step_lever(struct control_shaping *stick, uint64_t now_ns, double dt_s)
{
    const struct control_shaping_axis *a = &stick->axis[AXIS_THROTTLE];
    double before = stick->lever;
    double held_s = (double)(now_ns - a->down_ns) / NS_A_SECOND;
    if (a->held && !stick->lever_wait)
        stick->lever += a->held * (LEVER_SLOW + LEVER_GROWTH * held_s) * dt_s;
    stick->lever = maths_clamp(stick->lever + a->rate * LEVER_RATE * dt_s, -1.0, 1.0);
    if (a->held && before * stick->lever < 0.0) {
        stick->lever = 0.0;
        stick->lever_wait = true;
    }
}

static void step_key(struct control_shaping_axis *a, double low, uint64_t now_ns, double dt_s)
{
    double held_s = (double)(now_ns - a->down_ns) / NS_A_SECOND;
    if (a->held)
        a->key = maths_clamp(a->key + a->held * (KEY_RATE + KEY_GROWTH * held_s) * dt_s, low, 1.0);
    else if (a->key > 0.0)
        a->key = maths_max(0.0, a->key - CENTRE_RATE * dt_s);
    else
        a->key = maths_min(0.0, a->key + CENTRE_RATE * dt_s);
}

bool control_shaping_step(struct control_shaping *stick, uint64_t now_ns)
{
    double dt_s = maths_min((double)(now_ns - stick->step_ns) / NS_A_SECOND, STEP_MAX_S);
    bool moves = false;
    stick->step_ns = now_ns;
    step_lever(stick, now_ns, dt_s);
    for (int i = 0; i < AXIS_COUNT; i++) {
        struct control_shaping_axis *a = &stick->axis[i];
        if (i != AXIS_THROTTLE)
            step_key(a, i == AXIS_BRAKE ? 0.0 : -1.0, now_ns, dt_s);
        if (a->held && now_ns >= a->until_ns)
            a->held = 0;
        moves |= a->held || fabs(a->key) > 0.0 || fabs(a->rate) > 0.0;
    }
    if (stick->axis[AXIS_BRAKE].held) /* who brakes does not drive on afterwards */
        stick->lever = 0.0;
    return moves;
}

static float axis_value(const struct control_shaping *stick, enum input_axis axis, double low)
{
    const struct control_shaping_axis *a = &stick->axis[axis];
    return (float)maths_clamp(a->hand + a->key, low, 1.0);
}

struct controls control_shaping_controls(const struct control_shaping *stick, bool aircraft)
{
    struct controls controls = {
        .throttle = (float)stick->lever,
        .steer = axis_value(stick, AXIS_STEER, -1.0),
        .climb = axis_value(stick, AXIS_CLIMB, -1.0),
        .traverse = axis_value(stick, AXIS_AIM_X, -1.0),
        .elevate = axis_value(stick, AXIS_AIM_Y, -1.0),
        .brake = axis_value(stick, AXIS_BRAKE, 0.0),
        .gear = stick->gear,
    };
    if (aircraft) {
        controls.steer =
            (float)maths_clamp((double)controls.steer + (double)controls.traverse, -1.0, 1.0);
        controls.climb =
            (float)maths_clamp((double)controls.climb + (double)controls.elevate, -1.0, 1.0);
        controls.traverse = controls.elevate = 0.0f;
        controls.brake = (float)stick->axis[AXIS_BRAKE].key; /* a puck pushed down sinks */
    }
    return controls;
}

bool control_shaping_aims(const struct control_shaping *stick)
{
    for (int i = AXIS_AIM_X; i <= AXIS_AIM_Y; i++) {
        if (fabs(stick->axis[i].hand) > 0.0 || fabs(stick->axis[i].key) > 0.0)
            return true;
    }
    return false;
}
