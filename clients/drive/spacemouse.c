/* Reads a SpaceMouse with libspnav. */
#include "clients/drive/spacemouse.h"

#include "clients/drive/device_library.h"
#include "world/maths/maths.h"

#include <string.h>

/* Keeps spnav.h from including the X11 header, which is not needed here. */
#define SPNAV_CONFIG_H_
#include <spnav.h>

#define LIBRARY "libspnav.so.0"
#define PACKAGE "libspnav0 spacenavd"

static struct {
    int (*open)(void);
    int (*close)(void);
    int (*fd)(void);
    int (*poll_event)(spnav_event *);
} spnav;

static const struct device_library_function functions[] = {
    {"spnav_open", &spnav.open},
    {"spnav_close", &spnav.close},
    {"spnav_fd", &spnav.fd},
    {"spnav_poll_event", &spnav.poll_event},
};

static double share(int value)
{
    return maths_clamp(value / SPACEMOUSE_FULL, -1.0, 1.0);
}

void spacemouse_motion(const int push[3], const int turn[3], struct intents *queue)
{
    intent_put(queue, (struct intent){.type = INTENT_RATE,
                                      .axis = AXIS_THROTTLE,
                                      .value = (float)share(push[2])});
    intent_set(queue, AXIS_STEER, share(turn[1]));
    intent_set(queue, AXIS_CLIMB, share(push[1]));
    intent_set(queue, AXIS_BRAKE, maths_max(0.0, -share(push[1])));
    intent_set(queue, AXIS_AIM_X, share(push[0]));
    intent_set(queue, AXIS_AIM_Y, -share(turn[0]));
}

/* Button 0 is the pick button. */
void spacemouse_button(int button, bool down, struct intents *queue)
{
    static const enum input_action actions[] = {ACTION_FIRE, ACTION_LOCK, ACTION_NEXT,
                                                ACTION_PREVIOUS};
    if (down && button >= 0 && (size_t)button < sizeof actions / sizeof actions[0])
        intent_act(queue, actions[button]);
}

static int spacemouse_read(struct input *input, struct intents *queue)
{
    spnav_event event;
    int events = 0;
    (void)input;
    /* A motion makes six intents. */
    while (queue->count + 6 <= INTENTS_MAX && spnav.poll_event(&event) != 0) {
        const struct spnav_event_motion *motion = &event.motion;
        events++;
        if (event.type == SPNAV_EVENT_MOTION)
            spacemouse_motion((const int[3]){motion->x, motion->y, motion->z},
                              (const int[3]){motion->rx, motion->ry, motion->rz}, queue);
        else if (event.type == SPNAV_EVENT_BUTTON)
            spacemouse_button(event.button.bnum, event.button.press != 0, queue);
    }
    return events > 0 || queue->count > 0 ? 0 : -1; /* woken for nothing: the daemon is gone */
}

static void spacemouse_close(struct input *input)
{
    (void)input;
    (void)spnav.close();
}

int spacemouse_open(struct input *input, struct error_text *error)
{
    if (device_library_open(LIBRARY, PACKAGE, functions, sizeof functions / sizeof functions[0],
                            error) != 0)
        return -1;
    if (spnav.open() == -1)
        return error_text_set(error,
                              "no SpaceMouse: its daemon does not answer; is spacenavd running "
                              "(docs/driving.md)?");
    *input = (struct input){.fd = spnav.fd(),
                            .description = "SpaceMouse",
                            .read = spacemouse_read,
                            .close = spacemouse_close};
    return 0;
}
