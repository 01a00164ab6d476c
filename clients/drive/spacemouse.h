/* A SpaceMouse: six degrees of freedom from the daemon spacenavd into intents (thesis row 11: the
 * harder it is pushed, the faster the change; its pick button fires). */
#ifndef JOLON_CLIENTS_DRIVE_SPACEMOUSE_H
#define JOLON_CLIENTS_DRIVE_SPACEMOUSE_H

#include "clients/drive/input.h"

/* What the daemon sends at full push, about. */
#define SPACEMOUSE_FULL 350.0

/* The puck: pushed right, up, forwards; turned about those axes. Pure. */
void spacemouse_motion(const int push[3], const int turn[3], struct intents *queue);
void spacemouse_button(int button, bool down, struct intents *queue);

/* Connects to spacenavd. 0, or -1 with the reason. */
int spacemouse_open(struct input *input, struct error_text *error);

#endif
