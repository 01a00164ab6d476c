/* The renderer's command line. */
#ifndef JOLON_RENDERER_OPTIONS_H
#define JOLON_RENDERER_OPTIONS_H

#include "ipc/role.h"

#include <stdbool.h>
#include <stdint.h>

#define OPTIONS_SIDE_MIN 64u
#define OPTIONS_SIDE_MAX 4096u

struct options {
    const char *world, *out, *snap; /* out, snap: NULL when not given */
    enum role role;
    double fps;             /* pictures a second; below 0: the world's */
    uint32_t width, height; /* 0: the world's */
    int view;               /* enum view_mode; below 0: the world's */
    uint32_t follow;        /* entity id, 0: picks one */
    bool follow_given;      /* follows it even as a wreck; else the world's choice while it lives */
    int parent_pid;         /* 0: none */
    bool sandbox_off;
};

/* Ends the process on wrong usage (exit 2) and on --help and --version (exit 0). */
void options_read(struct options *options, int argc, char **argv);

#endif
