/* Input devices. Each kind of device is a small module that translates the device's events into
 * intents. clients/drive/control_shaping.h then computes the controls from the intents of all
 * devices. One thread. */
#ifndef JOLON_CLIENTS_DRIVE_INPUT_H
#define JOLON_CLIENTS_DRIVE_INPUT_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

/* Axes with two directions. Right, up and forwards are positive. */
enum input_axis {
    AXIS_THROTTLE, /* a lever, which keeps its position when it is released */
    AXIS_STEER,
    AXIS_CLIMB,
    AXIS_AIM_X, /* the turret, or the control stick of an aircraft */
    AXIS_AIM_Y,
    AXIS_BRAKE, /* 0..1 */
    AXIS_COUNT
};

enum input_action {
    ACTION_FIRE,
    ACTION_LOCK, /* select the next enemy ahead as target */
    ACTION_UNLOCK,
    ACTION_STOP, /* throttle 0, wheels straight */
    ACTION_GEAR_UP,
    ACTION_GEAR_DOWN,
    ACTION_NEXT, /* change to the vehicle with the next id */
    ACTION_PREVIOUS,
    ACTION_NEAREST_KIND,  /* change to the nearest vehicle of the same kind */
    ACTION_NEAREST_FORCE, /* ... of the same force */
    ACTION_NEAREST_BLUE,
    ACTION_NEAREST_RED,
    ACTION_NEAREST_NEUTRAL,
    ACTION_RELEASE, /* return the vehicle to its agent */
    ACTION_TAKE,    /* drive the vehicle again */
    ACTION_LOOK_LEFT,
    ACTION_LOOK_RIGHT,
    ACTION_LOOK_AHEAD,
    ACTION_ZOOM_IN,
    ACTION_ZOOM_OUT,
    ACTION_HELP,
    ACTION_QUIT,
    ACTION_COUNT
};

enum intent_type {
    INTENT_SET,  /* the axis is at value, -1..1 */
    INTENT_RATE, /* the axis moves at a rate that grows with value, -1..1 */
    INTENT_DOWN, /* a key of the axis was pressed, or repeats; value is its direction, -1 or 1 */
    INTENT_UP,   /* that key was released */
    INTENT_ACT   /* the user has requested the action */
};

struct intent {
    enum intent_type type;
    enum input_axis axis;
    enum input_action action;
    float value;
    bool reports_release; /* INTENT_DOWN: an INTENT_UP will follow */
};

#define INTENTS_MAX 64u

/* The intents of one call of inputs_read(). Intents beyond INTENTS_MAX are dropped: no person is
 * that quick. */
struct intents {
    struct intent intent[INTENTS_MAX];
    uint32_t count;
};

/* An open device. */
struct input {
    int fd;               /* readable when the device has events */
    char description[96]; /* as people read it: "gamepad \"8BitDo Pro 2\"" */
    /* Reads the events that have come, without blocking. Returns -1 if the device was removed. */
    int (*read)(struct input *input, struct intents *queue);
    void (*close)(struct input *input);
    void *state; /* of the module */
};

static inline void intent_put(struct intents *queue, struct intent intent)
{
    if (queue->count < INTENTS_MAX)
        queue->intent[queue->count++] = intent;
}

static inline void intent_act(struct intents *queue, enum input_action action)
{
    intent_put(queue, (struct intent){.type = INTENT_ACT, .action = action});
}

static inline void intent_set(struct intents *queue, enum input_axis axis, double value)
{
    intent_put(queue, (struct intent){.type = INTENT_SET, .axis = axis, .value = (float)value});
}

#endif
