/* The command line of jolon-ctl, as an order. Pure but for ending the program on wrong usage. */
#ifndef JOLON_CLIENTS_CTL_PARSE_H
#define JOLON_CLIENTS_CTL_PARSE_H

#include "ipc/topics/dds_link.h"
#include "ipc/topics/command_text.h"

#include <stdbool.h>

#define CTL_LINE_MAX 1024u

struct ctl_request {
    const char *world;
    double timeout_s;
    bool json;
    bool lines;  /* orders come from standard input, one a line */
    bool remote; /* over DDS, by link; else to a world of this user, and link is not used */
    struct dds_link_options link;
    struct command_text order;
};

/* Fills request from the arguments. Ends the program: with help on standard output (0), or with
 * one line that says what is wrong and what would be right (2). */
void ctl_parse(struct ctl_request *request, int argc, char **argv);

/* An order of standard input: a verb and its arguments, as on the command line. Changes the line.
 * 0; 1 for an empty line or a comment (#); -1 with the reason. */
int ctl_parse_line(struct command_text *order, char *line, struct error_text *error);

#endif
