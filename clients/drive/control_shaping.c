/* Response curves of devices, and the time of keys. */
#include "clients/drive/control_shaping.h"

#include "world/maths/maths.h"

#define NS_A_SECOND 1e9

/* The longest step [s], so that nothing jumps after the process was stopped. */
#define STEP_MAX_S 0.1

/* The gears in the order of shifting. */
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

void control_shaping_reset(struct control_shaping *shaping, uint64_t now_ns)
{
    *shaping = (struct control_shaping){.gear = GEAR_AUTOMATIC, .step_ns = now_ns};
}

/* A press changes the value at once, so that a short tap has an effect. */
static void apply_press(struct control_shaping *shaping, enum input_axis axis, int direction)
{
    struct control_shaping_axis *a = &shaping->axis[axis];
    if (axis == AXIS_THROTTLE) {
        shaping->lever_wait =
            shaping->lever * direction < 0.0 && fabs(shaping->lever) <= LEVER_KICK;
        shaping->lever = shaping->lever_wait
                             ? 0.0
                             : maths_clamp(shaping->lever + direction * LEVER_KICK, -1.0, 1.0);
        return;
    }
    if (a->key * direction < 0.0)
        a->key = 0.0;
    a->key = maths_clamp(a->key + direction * KEY_KICK, axis == AXIS_BRAKE ? 0.0 : -1.0, 1.0);
}

static void key_down(struct control_shaping *shaping, const struct intent *event, uint64_t now_ns)
{
    struct control_shaping_axis *a = &shaping->axis[event->axis];
    int direction = event->value < 0.0f ? -1 : 1;
    bool again = a->held == direction;
    if (!again) {
        /* Nothing is reported between a press and its auto-repeat: it is still the same press. */
        bool same = !event->reports_release && a->direction == direction &&
                    now_ns - a->last_ns < KEY_SAME_NS;
        if (!same)
            a->down_ns = now_ns;
        apply_press(shaping, event->axis, direction);
    }
    a->held = a->direction = direction;
    a->last_ns = now_ns;
    a->until_ns =
        event->reports_release ? UINT64_MAX : now_ns + (again ? KEY_REPEAT_NS : KEY_FIRST_NS);
}

void control_shaping_apply(struct control_shaping *shaping, const struct intent *event,
                           uint64_t now_ns)
{
    struct control_shaping_axis *a = &shaping->axis[event->axis];
    switch (event->type) {
    case INTENT_SET:
        a->deflection = control_shaping_shape((double)event->value);
        if (event->axis == AXIS_THROTTLE)
            shaping->lever = a->deflection;
        break;
    case INTENT_RATE:
        a->rate = control_shaping_shape((double)event->value);
        break;
    case INTENT_DOWN:
        key_down(shaping, event, now_ns);
        break;
    case INTENT_UP:
        if ((double)a->held * (double)event->value > 0.0)
            a->held = 0;
        break;
    case INTENT_ACT:
        break;
    }
}

void control_shaping_stop(struct control_shaping *shaping)
{
    shaping->lever = 0.0;
    for (int i = 0; i < AXIS_COUNT; i++) {
        shaping->axis[i].held = 0;
        shaping->axis[i].key = 0.0;
    }
}

void control_shaping_gear(struct control_shaping *shaping, int by)
{
    int at = 0;
    while (shifts[at] != shaping->gear)
        at++;
    at += by;
    shaping->gear = shifts[at < 0 ? 0 : at >= GEAR_COUNT ? GEAR_COUNT - 1 : at];
}

static void step_lever(struct control_shaping *shaping, uint64_t now_ns, double dt_s)
{
    const struct control_shaping_axis *a = &shaping->axis[AXIS_THROTTLE];
    double before = shaping->lever;
    double held_s = (double)(now_ns - a->down_ns) / NS_A_SECOND;
    if (a->held && !shaping->lever_wait)
        shaping->lever += a->held * (LEVER_SLOW + LEVER_GROWTH * held_s) * dt_s;
    shaping->lever = maths_clamp(shaping->lever + a->rate * LEVER_RATE * dt_s, -1.0, 1.0);
    if (a->held && before * shaping->lever < 0.0) {
        shaping->lever = 0.0;
        shaping->lever_wait = true;
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

bool control_shaping_step(struct control_shaping *shaping, uint64_t now_ns)
{
    double dt_s = maths_min((double)(now_ns - shaping->step_ns) / NS_A_SECOND, STEP_MAX_S);
    bool moves = false;
    shaping->step_ns = now_ns;
    step_lever(shaping, now_ns, dt_s);
    for (int i = 0; i < AXIS_COUNT; i++) {
        struct control_shaping_axis *a = &shaping->axis[i];
        if (i != AXIS_THROTTLE)
            step_key(a, i == AXIS_BRAKE ? 0.0 : -1.0, now_ns, dt_s);
        if (a->held && now_ns >= a->until_ns)
            a->held = 0;
        moves |= a->held || fabs(a->key) > 0.0 || fabs(a->rate) > 0.0;
    }
    if (shaping->axis[AXIS_BRAKE].held) /* the vehicle stays stopped after braking */
        shaping->lever = 0.0;
    return moves;
}

static float axis_value(const struct control_shaping *shaping, enum input_axis axis, double low)
{
    const struct control_shaping_axis *a = &shaping->axis[axis];
    return (float)maths_clamp(a->deflection + a->key, low, 1.0);
}

struct controls control_shaping_controls(const struct control_shaping *shaping, bool aircraft)
{
    struct controls controls = {
        .throttle = (float)shaping->lever,
        .steer = axis_value(shaping, AXIS_STEER, -1.0),
        .climb = axis_value(shaping, AXIS_CLIMB, -1.0),
        .traverse = axis_value(shaping, AXIS_AIM_X, -1.0),
        .elevate = axis_value(shaping, AXIS_AIM_Y, -1.0),
        .brake = axis_value(shaping, AXIS_BRAKE, 0.0),
        .gear = shaping->gear,
    };
    if (aircraft) {
        controls.steer =
            (float)maths_clamp((double)controls.steer + (double)controls.traverse, -1.0, 1.0);
        controls.climb =
            (float)maths_clamp((double)controls.climb + (double)controls.elevate, -1.0, 1.0);
        controls.traverse = controls.elevate = 0.0f;
        controls.brake = (float)shaping->axis[AXIS_BRAKE].key; /* a puck pushed down: descend */
    }
    return controls;
}

bool control_shaping_aims(const struct control_shaping *shaping)
{
    for (int i = AXIS_AIM_X; i <= AXIS_AIM_Y; i++) {
        if (fabs(shaping->axis[i].deflection) > 0.0 || fabs(shaping->axis[i].key) > 0.0)
            return true;
    }
    return false;
}
