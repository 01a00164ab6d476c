/* All input devices of a driver. */
#ifndef JOLON_CLIENTS_DRIVE_INPUTS_H
#define JOLON_CLIENTS_DRIVE_INPUTS_H

#include "clients/drive/input.h"

#define INPUTS_MAX 3

enum inputs_choice { INPUTS_AUTO, INPUTS_KEYS, INPUTS_GAMEPAD, INPUTS_SPACEMOUSE };

struct inputs {
    struct input input[INPUTS_MAX];
    uint32_t count;
    bool keys_ended;      /* the pipe has ended or the terminal was closed */
    bool summary_changed; /* set with each change of the summary; its reader clears it */
    char summary[256];    /* as people read it: the devices in use, and why others are not */
};

/* Opens the keys and the devices of the choice: INPUTS_AUTO opens those that there are; a device
 * that is named must be there. path: of the gamepad, NULL: any. Returns 0, or -1 with the error. */
int inputs_open(struct inputs *inputs, enum inputs_choice choice, const char *path,
                struct error_text *error);
void inputs_close(struct inputs *inputs);

/* Waits for events, at most until until_ns (CLOCK_MONOTONIC), and reads them. Keys are not read
 * unless keys_wanted. A device that was removed is closed and noted in the summary. */
void inputs_read(struct inputs *inputs, bool keys_wanted, uint64_t until_ns, struct intents *queue);

#endif
