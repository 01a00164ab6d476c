/* The recorder's options. */
#ifndef JOLON_RECORDER_OPTIONS_H
#define JOLON_RECORDER_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

struct options {
    const char *world;
    const char *commands, *events; /* files; events NULL: no event log */
    const char *checkpoint;        /* NULL: none */
    uint64_t every;                /* frames between two checkpoints */
    int parent;                    /* pid to die with, 0 for none */
    bool sandbox_off;
};

/* Wrong usage ends the process (exit 2), and so does --help (exit 0). */
struct options options_read(int argc, char **argv);

#endif
