/* The terminal under our hands: keys one by one and unseen, releases where it can tell them; and
 * all of it given back at any end, a crash included. One a process. */
#ifndef JOLON_CLIENTS_DRIVE_TERMINAL_H
#define JOLON_CLIENTS_DRIVE_TERMINAL_H

#include <stdbool.h>

/* Takes over standard input if it is a terminal; screen: standard output shows a full screen, which
 * is to be left as well. Ctrl-Z does nothing meanwhile: who sleeps does not drive. */
void terminal_open(bool screen);

/* Gives it back; may be called more than once, and from a signal handler. */
void terminal_restore(void);

/* Was its size changed since the last call? */
bool terminal_resized(void);

#endif
