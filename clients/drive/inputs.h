/* All inputs of a driver together. */
#ifndef JOLON_CLIENTS_DRIVE_INPUTS_H
#define JOLON_CLIENTS_DRIVE_INPUTS_H

#include "clients/drive/input.h"

#define INPUTS_MAX 3

enum inputs_choice { INPUTS_AUTO, INPUTS_KEYS, INPUTS_GAMEPAD, INPUTS_SPACEMOUSE };

struct inputs {
    struct input input[INPUTS_MAX];
    uint32_t count;
    bool keys_ended;      /* nobody types any more: the end of a pipe, a terminal that went */
    bool summary_changed; /* said has changed; whoever says it to people clears this */
    char summary[256];    /* for people: what is in use, and what is not and why */
};

/* Opens keys, and of the devices those chosen: with INPUTS_AUTO what is there, else the one named,
 * without which it is refused. path: of the gamepad, NULL for any. */
int inputs_open(struct inputs *inputs, enum inputs_choice choice, const char *path,
                struct error_text *error);
void inputs_close(struct inputs *inputs);

/* Waits until something can be read, at most until_ns (CLOCK_MONOTONIC), and reads it. Keys are
 * left where they are while not wanted. A device that goes is closed, and said says so. */
void inputs_read(struct inputs *inputs, bool keys_wanted, uint64_t until_ns, struct intents *queue);

#endif
