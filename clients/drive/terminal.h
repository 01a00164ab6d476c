/* The terminal's settings: keys without echo or line buffering, and with releases where the
 * terminal reports them. They are restored at every end of the process, a crash included. One a
 * process. */
#ifndef JOLON_CLIENTS_DRIVE_TERMINAL_H
#define JOLON_CLIENTS_DRIVE_TERMINAL_H

#include <stdbool.h>

/* Changes the settings if standard input is a terminal. screen: standard output shows a full
 * screen, which is to be left as well. Ctrl-Z has no effect, as a stopped process cannot drive. */
void terminal_open(bool screen);

/* Restores the terminal. May be called more than once, and from a signal handler. */
void terminal_restore(void);

/* Returns true if the terminal's size has changed since the last call. */
bool terminal_resized(void);

#endif
