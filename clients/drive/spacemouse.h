/* SpaceMouse: translates the six degrees of freedom that the daemon spacenavd reports into intents
 * (thesis row 11: a harder push changes faster; the pick button fires). */
#ifndef JOLON_CLIENTS_DRIVE_SPACEMOUSE_H
#define JOLON_CLIENTS_DRIVE_SPACEMOUSE_H

#include "clients/drive/input.h"

/* The value that the daemon reports at about full deflection. */
#define SPACEMOUSE_FULL 350.0

/* Translates a motion of the puck: pushed right, up, forwards; turned about these axes. Pure. */
void spacemouse_motion(const int push[3], const int turn[3], struct intents *queue);
void spacemouse_button(int button, bool down, struct intents *queue);

/* Connects to spacenavd. Returns 0, or -1 with the error. */
int spacemouse_open(struct input *input, struct error_text *error);

#endif
