/* An order of jolon-ctl's carried out: resolved, sent, repeated until it is answered, and told. */
#ifndef JOLON_CLIENTS_CTL_COMMAND_RUN_H
#define JOLON_CLIENTS_CTL_COMMAND_RUN_H

#include "clients/ctl/lookup.h"
#include "clients/ctl/parse.h"
#include "ipc/topics/command_route.h"
#include "ipc/topics/command_series.h"

struct ctl {
    struct ctl_request request;
    struct dds_link link; /* open when the request is remote */
    struct view view;     /* else */
    struct command_client client;
    struct command_route route; /* of the caller */
    struct lookup lookup;
    struct command_series series;
};

/* Carries out an order of that line of standard input, 0: of the command line, and says what came
 * of it. EXIT_OK when it was done; EXIT_REFUSED; EXIT_GAVE_UP: there was no reply. Blocks until all
 * its rounds are answered, the time is over, or a request to stop. */
int command_run(struct ctl *ctl, struct command_text *order, uint32_t line);

#endif
