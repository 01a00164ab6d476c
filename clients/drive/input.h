/* Inputs: what a driver holds in the hands. Each sort is one small module that turns what its
 * device says into raw intents; clients/drive/control_shaping.h makes controls of them, the same
 * for all. One thread.
 */
#ifndef JOLON_CLIENTS_DRIVE_INPUT_H
#define JOLON_CLIENTS_DRIVE_INPUT_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

/* What can be pushed two ways: right, up and forwards are positive. */
enum input_axis {
    AXIS_THROTTLE, /* a lever: it stays where it was left */
    AXIS_STEER,
    AXIS_CLIMB,
    AXIS_AIM_X, /* the turret's; of aircraft, which have none, the stick's */
    AXIS_AIM_Y,
    AXIS_BRAKE, /* 0..1 */
    AXIS_COUNT
};

enum input_action {
    ACTION_FIRE,
    ACTION_LOCK, /* the next enemy ahead as target */
    ACTION_UNLOCK,
    ACTION_STOP, /* throttle to nothing, wheels straight */
    ACTION_GEAR_UP,
    ACTION_GEAR_DOWN,
    ACTION_NEXT, /* become the next vehicle */
    ACTION_PREVIOUS,
    ACTION_NEAREST_KIND,  /* the nearest other one of its kind */
    ACTION_NEAREST_FORCE, /* ... of its force */
    ACTION_NEAREST_BLUE,
    ACTION_NEAREST_RED,
    ACTION_NEAREST_NEUTRAL,
    ACTION_RELEASE, /* back to its agent */
    ACTION_TAKE,    /* drive it again */
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
    INTENT_SET,  /* axis stands at value, -1..1, until it says otherwise */
    INTENT_RATE, /* axis is moved, the faster the further from 0 value is */
    INTENT_DOWN, /* a key for axis, value -1 or 1, went down; again: its auto-repeat */
    INTENT_UP,   /* ... was let go */
    INTENT_ACT   /* action */
};

struct intent {
    enum intent_type type;
    enum input_axis axis;
    enum input_action action;
    float value;
    bool reports_release; /* INTENT_DOWN: an INTENT_UP will follow */
};

#define INTENTS_MAX 64u

/* Events of one look at the devices; what is too much is dropped: nobody's hands are that quick. */
struct intents {
    struct intent intent[INTENTS_MAX];
    uint32_t count;
};

/* One open device. */
struct input {
    int fd;               /* poll() it */
    char description[96]; /* for people: "gamepad \"8BitDo Pro 2\"" */
    /* Reads what is there without blocking; -1 when the device is gone. */
    int (*read)(struct input *input, struct intents *queue);
    void (*close)(struct input *input);
    void *state; /* the module's own */
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
