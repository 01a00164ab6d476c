/* A gamepad or joystick: events of the kernel's input layer into intents. The device is read
 * through libevdev, which is opened when one is asked for. */
#ifndef JOLON_CLIENTS_DRIVE_GAMEPAD_H
#define JOLON_CLIENTS_DRIVE_GAMEPAD_H

#include "clients/drive/input.h"

#include <linux/input.h>

/* What the device says of its axes, ABS_X to ABS_HAT0Y. */
#define GAMEPAD_AXES (ABS_HAT0Y + 1)

struct gamepad {
    struct gamepad_range {
        int32_t low, high; /* equal: it has no such axis */
    } range[GAMEPAD_AXES];
    int hat[2]; /* where the cross stands, -1..1: right, down */
    struct libevdev *device;
};

/* One event of the device: type, code and value of its event. Pure. */
void gamepad_decode(struct gamepad *gamepad, uint16_t type, uint16_t code, int32_t value,
                    struct intents *queue);

/* Opens the device; path: NULL for the first gamepad found. 0, or -1 with the reason. */
int gamepad_open(struct input *input, const char *path, struct error_text *error);

#endif
