/* The driver's screen: 80 x 24 or larger. One a process. */
#ifndef JOLON_CLIENTS_DRIVE_SCREEN_H
#define JOLON_CLIENTS_DRIVE_SCREEN_H

#include "clients/drive/recent_events.h"

/* Takes the terminal's screen; -1 with the reason when its type is not known. */
int screen_open(struct error_text *error);
void screen_close(void);

/* inputs: what is in use, as inputs.said. */
void screen_draw(const struct session *session, const struct recent_events *events,
                 const char *inputs, uint64_t now_ns);

#endif
