/* Reads gamepads with libevdev. */
#include "clients/drive/gamepad.h"

#include "clients/drive/device_library.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LIBRARY "libevdev.so.2"
#define PACKAGE "libevdev2"
#define FOLDER  "/dev/input"

static struct {
    int (*new_from_fd)(int, struct libevdev **);
    void (*free)(struct libevdev *);
    int (*has_event_code)(const struct libevdev *, unsigned int, unsigned int);
    const struct input_absinfo *(*get_abs_info)(const struct libevdev *, unsigned int);
    const char *(*get_name)(const struct libevdev *);
    int (*next_event)(struct libevdev *, unsigned int, struct input_event *);
} evdev;

static const struct device_library_function functions[] = {
    {"libevdev_new_from_fd", &evdev.new_from_fd},
    {"libevdev_free", &evdev.free},
    {"libevdev_has_event_code", &evdev.has_event_code},
    {"libevdev_get_abs_info", &evdev.get_abs_info},
    {"libevdev_get_name", &evdev.get_name},
    {"libevdev_next_event", &evdev.next_event},
};

static const struct {
    uint16_t code;
    enum input_action action;
} buttons[] = {
    {BTN_SOUTH, ACTION_FIRE},
    {BTN_TR, ACTION_FIRE},
    {BTN_EAST, ACTION_STOP},
    {BTN_WEST, ACTION_LOCK},
    {BTN_NORTH, ACTION_LOOK_AHEAD},
    {BTN_TL, ACTION_UNLOCK},
    {BTN_SELECT, ACTION_RELEASE},
    {BTN_START, ACTION_TAKE},
    {BTN_THUMBL, ACTION_NEAREST_FORCE},
    {BTN_THUMBR, ACTION_NEAREST_KIND},
    {BTN_TRIGGER, ACTION_FIRE},
    {BTN_THUMB, ACTION_LOCK},
    {BTN_THUMB2, ACTION_STOP},
};

/* A stick is measured from its middle, up and right positive; a pedal from its released end. */
static const struct {
    uint16_t code;
    enum input_axis axis;
    int direction; /* 0: a pedal */
} axes[] = {
    {ABS_X, AXIS_STEER, 1},   {ABS_Y, AXIS_CLIMB, -1},    {ABS_RX, AXIS_AIM_X, 1},
    {ABS_RY, AXIS_AIM_Y, -1}, {ABS_RZ, AXIS_THROTTLE, 0}, {ABS_GAS, AXIS_THROTTLE, 0},
    {ABS_Z, AXIS_BRAKE, 0},   {ABS_BRAKE, AXIS_BRAKE, 0},
};

static void decode_button(uint16_t code, struct intents *queue)
{
    for (size_t i = 0; i < sizeof buttons / sizeof buttons[0]; i++) {
        if (buttons[i].code == code)
            intent_act(queue, buttons[i].action);
    }
}

/* The directional pad: left and right change the vehicle, up and down the gear. */
static void decode_hat(struct gamepad *gamepad, int which, int32_t value, struct intents *queue)
{
    static const enum input_action actions[2][2] = {{ACTION_PREVIOUS, ACTION_NEXT},
                                                    {ACTION_GEAR_UP, ACTION_GEAR_DOWN}};
    int position = value < 0 ? -1 : value > 0;
    if (position != 0 && position != gamepad->hat[which])
        intent_act(queue, actions[which][position > 0]);
    gamepad->hat[which] = position;
}

static void decode_axis(const struct gamepad *gamepad, uint16_t code, int32_t value,
                        struct intents *queue)
{
    const struct gamepad_range *range = &gamepad->range[code];
    double low = range->low, span = (double)range->high - low;
    if (!(span > 0.0))
        return;
    double share = ((double)value - low) / span;
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++) {
        if (axes[i].code == code)
            intent_set(queue, axes[i].axis,
                       axes[i].direction == 0 ? share : axes[i].direction * (2.0 * share - 1.0));
    }
}

void gamepad_decode(struct gamepad *gamepad, uint16_t type, uint16_t code, int32_t value,
                    struct intents *queue)
{
    if (type == EV_KEY && value == 1)
        decode_button(code, queue);
    else if (type == EV_ABS && (code == ABS_HAT0X || code == ABS_HAT0Y))
        decode_hat(gamepad, code - ABS_HAT0X, value, queue);
    else if (type == EV_ABS && code < GAMEPAD_AXES)
        decode_axis(gamepad, code, value, queue);
}

/* After events were lost, libevdev reports the present state as SYNC events. */
static int gamepad_read(struct input *input, struct intents *queue)
{
    struct gamepad *gamepad = input->state;
    struct input_event event;
    unsigned how = LIBEVDEV_READ_FLAG_NORMAL;
    while (queue->count < INTENTS_MAX) {
        int code = evdev.next_event(gamepad->device, how, &event);
        if (code == -EAGAIN && how == LIBEVDEV_READ_FLAG_SYNC)
            how = LIBEVDEV_READ_FLAG_NORMAL;
        else if (code == -EAGAIN || code == -EINTR)
            return 0;
        else if (code < 0)
            return -1;
        else if (code == LIBEVDEV_READ_STATUS_SYNC)
            how = LIBEVDEV_READ_FLAG_SYNC;
        if (code >= 0)
            gamepad_decode(gamepad, event.type, event.code, event.value, queue);
    }
    return 0;
}

static void gamepad_close(struct input *input)
{
    struct gamepad *gamepad = input->state;
    evdev.free(gamepad->device);
    (void)close(input->fd);
    free(gamepad);
}

/* Returns true if the device has a stick and a button of a gamepad or joystick. */
static bool is_gamepad(const struct libevdev *device)
{
    return evdev.has_event_code(device, EV_ABS, ABS_X) &&
           evdev.has_event_code(device, EV_ABS, ABS_Y) &&
           (evdev.has_event_code(device, EV_KEY, BTN_GAMEPAD) ||
            evdev.has_event_code(device, EV_KEY, BTN_JOYSTICK));
}

static void read_ranges(struct gamepad *gamepad)
{
    for (unsigned code = 0; code < GAMEPAD_AXES; code++) {
        const struct input_absinfo *info = evdev.get_abs_info(gamepad->device, code);
        if (info && info->maximum > info->minimum)
            gamepad->range[code] = (struct gamepad_range){info->minimum, info->maximum};
    }
}

static int open_device(struct input *input, const char *path, struct error_text *error)
{
    struct libevdev *device = NULL;
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return error_text_set(error, "%s: %s%s", path, strerror(errno),
                              errno == EACCES ? "; the group input may read it (docs/driving.md)"
                                              : "");
    int code = evdev.new_from_fd(fd, &device);
    struct gamepad *gamepad = calloc(1, sizeof *gamepad);
    if (code < 0 || !gamepad || !is_gamepad(device)) {
        if (code >= 0)
            evdev.free(device);
        free(gamepad);
        (void)close(fd);
        return error_text_set(error, "%s: not a gamepad or joystick", path);
    }
    gamepad->device = device;
    read_ranges(gamepad);
    *input =
        (struct input){.fd = fd, .read = gamepad_read, .close = gamepad_close, .state = gamepad};
    (void)snprintf(input->description, sizeof input->description, "gamepad \"%s\"",
                   evdev.get_name(device));
    return 0;
}

/* Opens the gamepad with the lowest device number. */
static int find_device(struct input *input, struct error_text *error)
{
    struct dirent **entry = NULL;
    struct error_text detail = {0};
    bool denied = false;
    int found = -1;
    int count = scandir(FOLDER, &entry, NULL, versionsort);
    for (int i = 0; i < count; i++) {
        char path[sizeof FOLDER + sizeof entry[i]->d_name];
        (void)snprintf(path, sizeof path, FOLDER "/%s", entry[i]->d_name);
        if (found != 0 && strncmp(entry[i]->d_name, "event", 5) == 0) {
            found = open_device(input, path, &detail);
            denied = denied || (found != 0 && access(path, R_OK) != 0);
        }
        free(entry[i]);
    }
    free(entry);
    if (found == 0)
        return 0;
    return error_text_set(error, "no gamepad among " FOLDER "/event*%s",
                          denied ? "; some are readable by the group input only (docs/driving.md)"
                                 : "");
}

int gamepad_open(struct input *input, const char *path, struct error_text *error)
{
    if (device_library_open(LIBRARY, PACKAGE, functions, sizeof functions / sizeof functions[0],
                            error) != 0)
        return -1;
    return path ? open_device(input, path, error) : find_device(input, error);
}
