/* Gamepads and joysticks: translates events of the kernel's input layer into intents. libevdev,
 * which reads the device, is loaded only when a gamepad is opened. */
#ifndef JOLON_CLIENTS_DRIVE_GAMEPAD_H
#define JOLON_CLIENTS_DRIVE_GAMEPAD_H

#include "clients/drive/input.h"

#include <linux/input.h>

/* Number of the axes whose range is read from the device, ABS_X to ABS_HAT0Y. */
#define GAMEPAD_AXES (ABS_HAT0Y + 1)

struct gamepad {
    struct gamepad_range {
        int32_t low, high; /* equal: the device has no such axis */
    } range[GAMEPAD_AXES];
    int hat[2]; /* position of the directional pad, -1..1: right, down */
    struct libevdev *device;
};

/* Translates one event of the device. Pure. */
void gamepad_decode(struct gamepad *gamepad, uint16_t type, uint16_t code, int32_t value,
                    struct intents *queue);

/* Opens the device; path NULL: the first gamepad found. Returns 0, or -1 with the error. */
int gamepad_open(struct input *input, const char *path, struct error_text *error);

#endif
