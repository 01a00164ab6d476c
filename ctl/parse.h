/* The command line of jolon-ctl, as a command. Pure but for ending the program on wrong usage. */
#ifndef JOLON_CTL_PARSE_H
#define JOLON_CTL_PARSE_H

#include "topics/dds_link.h"

#include "status.h"

#include <stdbool.h>

struct ctl_request {
    const char *world;
    const char *verb;
    double timeout_s;
    bool json;
    struct dds_link_options link;
    jolon_Command command; /* source and sequence are 0 */
};

/* Fills request from the arguments. Ends the program: with help on standard output (0), or with
 * one line that says what is wrong and what would be right (2). */
void ctl_parse(struct ctl_request *request, int argc, char **argv);

#endif
