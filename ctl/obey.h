/* An order of jolon-ctl's carried out: resolved, sent, repeated until it is answered, and told. */
#ifndef JOLON_CTL_OBEY_H
#define JOLON_CTL_OBEY_H

#include "ctl/lookup.h"
#include "ctl/parse.h"
#include "topics/command_route.h"
#include "topics/mission.h"

struct ctl {
    struct ctl_request request;
    struct dds_link link; /* open when the request is remote */
    struct view view;     /* else */
    struct caller caller;
    struct command_route route; /* of the caller */
    struct lookup lookup;
    struct mission mission;
};

/* Carries out an order of that line of standard input, 0: of the command line, and says what came
 * of it. EXIT_OK when it was done; EXIT_REFUSED; EXIT_GAVE_UP: there was no reply. Blocks until all
 * its rounds are answered, the time is over, or a request to stop. */
int obey(struct ctl *ctl, struct order *order, uint32_t line);

#endif
