/* The driver's screen, for terminals of 60 x 20 characters or more. One a process. */
#ifndef JOLON_CLIENTS_DRIVE_SCREEN_H
#define JOLON_CLIENTS_DRIVE_SCREEN_H

#include "clients/drive/recent_events.h"

/* Starts curses. Returns 0, or -1 with the error if the terminal's type is not known. */
int screen_open(struct error_text *error);
void screen_close(void);

/* inputs: the devices in use, for the help. */
void screen_draw(const struct session *session, const struct recent_events *events,
                 const char *inputs, uint64_t now_ns);

#endif
