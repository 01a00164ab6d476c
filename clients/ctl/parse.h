/* Parses the command line of jolon-ctl. Pure, except that wrong usage ends the process. */
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
    bool lines;  /* commands come from standard input, one a line */
    bool remote; /* commands go over DDS by link; else link is not used */
    struct dds_link_options link;
    struct command_text order;
};

/* Fills request. Ends the process at --help (exit 0) and at wrong usage (exit 2). */
void ctl_parse(struct ctl_request *request, int argc, char **argv);

/* Parses a line of standard input: a verb and its arguments, as on the command line. Changes the
 * line. Returns 0; 1 for an empty line or a comment (#); -1 with the error. */
int ctl_parse_line(struct command_text *order, char *line, struct error_text *error);

#endif
