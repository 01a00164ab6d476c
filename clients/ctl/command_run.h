/* Runs a command of jolon-ctl: resolves its names, sends it until it is answered, and prints the
 * result. */
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
    struct command_route route; /* of the client */
    struct lookup lookup;
    struct command_series series;
};

/* Runs a command and prints the result. line: of standard input, 0: the command line. Returns
 * EXIT_OK if it was done, EXIT_REFUSED, or EXIT_GAVE_UP without a reply. Blocks until all rounds
 * are answered, at most for the timeout a round, or until a request to stop. */
int command_run(struct ctl *ctl, struct command_text *order, uint32_t line);

#endif
