/* The command line of jolon-console. */
#ifndef JOLON_CLIENTS_CONSOLE_OPTIONS_H
#define JOLON_CLIENTS_CONSOLE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#define OPTIONS_PORT 8080u

struct options {
    const char *world;
    const char *address;
    uint32_t port;          /* 0..65535 */
    const char *token_file; /* NULL: a new token */
    int parent;             /* process id, 0: none */
    bool role;              /* this is the set's console, with the role's lock and slot */
    bool sandbox_off;
};

/* Fills options. Ends the process at --help (exit 0) and at wrong usage (exit 2). */
void options_parse(struct options *options, int argc, char **argv);

#endif
