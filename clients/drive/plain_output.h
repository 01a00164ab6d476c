/* Plain output: lines on standard output instead of a screen, for scripts and pipes. */
#ifndef JOLON_CLIENTS_DRIVE_PLAIN_OUTPUT_H
#define JOLON_CLIENTS_DRIVE_PLAIN_OUTPUT_H

#include "clients/drive/recent_events.h"

struct plain_output {
    uint64_t period_ns; /* between two lines of statistics */
    uint64_t line_ns;   /* when the next line of statistics is due */
    uint64_t events_printed;
    uint32_t notices; /* of the session, printed so far */
    bool silent;      /* the last line reported that the world is silent */
};

/* Prints the notices and events since the last call, and a line of statistics when it is due.
 * Returns false if standard output cannot be written, because its reader has gone. */
bool plain_output_show(struct plain_output *output, const struct session *session,
                       const struct recent_events *events, uint64_t now_ns);

#endif
