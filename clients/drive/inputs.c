/* Opens, awaits and reads the devices. */
#include "clients/drive/inputs.h"

#include "clients/drive/gamepad.h"
#include "clients/drive/spacemouse.h"
#include "clients/drive/terminal_keys.h"
#include "ipc/process/clock.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static void add_to_summary(struct inputs *inputs, const char *text)
{
    size_t used = strlen(inputs->summary);
    inputs->summary_changed = true;
    (void)snprintf(inputs->summary + used, sizeof inputs->summary - used, "%s%s", used ? "; " : "",
                   text);
}

/* Adds a device that was opened, or notes why it was not. Returns -1 if it is needed. */
static int note_result(struct inputs *inputs, int result, bool needed, struct error_text *detail,
                       struct error_text *error)
{
    if (result == 0)
        add_to_summary(inputs, inputs->input[inputs->count++].description);
    else if (needed)
        return error_text_set(error, "%s", detail->text);
    else
        add_to_summary(inputs, detail->text);
    return 0;
}

int inputs_open(struct inputs *inputs, enum inputs_choice choice, const char *path,
                struct error_text *error)
{
    struct error_text detail;
    *inputs = (struct inputs){0};
    if (terminal_keys_open(&inputs->input[0], error) != 0)
        return -1;
    inputs->count = 1;
    add_to_summary(inputs, inputs->input[0].description);
    bool gamepad = choice == INPUTS_GAMEPAD || path;
    bool spacemouse = choice == INPUTS_SPACEMOUSE;
    if ((gamepad || choice == INPUTS_AUTO) &&
        note_result(inputs, gamepad_open(&inputs->input[inputs->count], path, &detail), gamepad,
                    &detail, error) != 0)
        return -1;
    if ((spacemouse || choice == INPUTS_AUTO) &&
        note_result(inputs, spacemouse_open(&inputs->input[inputs->count], &detail), spacemouse,
                    &detail, error) != 0)
        return -1;
    return 0;
}

void inputs_close(struct inputs *inputs)
{
    for (uint32_t i = 0; i < inputs->count; i++)
        inputs->input[i].close(&inputs->input[i]);
    inputs->count = 0;
}

/* Removes a device. The keys, at place 0, keep their place and are only marked as ended. */
static void drop_input(struct inputs *inputs, uint32_t which)
{
    struct input *input = &inputs->input[which];
    if (which == 0) {
        inputs->keys_ended = true;
        return;
    }
    (void)snprintf(inputs->summary, sizeof inputs->summary, "keys; the %s is gone",
                   input->description);
    inputs->summary_changed = true;
    input->close(input);
    inputs->count--;
    memmove(input, input + 1, (inputs->count - which) * sizeof *input);
}

void inputs_read(struct inputs *inputs, bool keys_wanted, uint64_t until_ns, struct intents *queue)
{
    struct pollfd waits[INPUTS_MAX];
    uint64_t now_ns = clock_now_ns();
    uint64_t left_ns = now_ns < until_ns ? until_ns - now_ns : 0;
    struct timespec left = {(time_t)(left_ns / NS_PER_S), (long)(left_ns % NS_PER_S)};
    queue->count = 0;
    for (uint32_t i = 0; i < inputs->count; i++)
        waits[i] = (struct pollfd){.fd = inputs->input[i].fd, .events = POLLIN};
    if (!keys_wanted || inputs->keys_ended)
        waits[0].fd = -1;
    if (ppoll(waits, inputs->count, &left, NULL) <= 0)
        return;
    for (uint32_t i = inputs->count; i-- > 0;) {
        struct input *input = &inputs->input[i];
        if (waits[i].revents && input->read(input, queue) != 0)
            drop_input(inputs, i);
    }
}
