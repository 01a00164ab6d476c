/* Start and end of the two stages of the frame loop, mover and collider. A stage's main is
 *
 *     stage_open(&stage, argc, argv, role);
 *     ... take the memory of the steps ...
 *     if (stage_enter(&stage)) { frames until the run ends }
 *     stage_close(&stage);
 *
 * Every refusal ends the process with one line (exit 1). */
#ifndef JOLON_IPC_STAGE_STAGE_H
#define JOLON_IPC_STAGE_STAGE_H

#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>

struct thread_pool;

struct stage_options {
    const char *world;
    uint32_t threads; /* 1..16 */
    int parent;       /* the stage ends when the process of this pid does; 0: none */
    bool stand_by;    /* wait for the role's holder to die instead of refusing */
    bool sandbox_off;
};

struct stage {
    struct stage_options options;
    struct sandbox sandbox;
    struct view view;
    struct thread_pool *workers;
};

/* Reads the command line, opens the log, installs the signal handlers, attaches to the world and
 * starts the threads. A stand-by process maps the world without its role. Wrong usage ends the
 * process (exit 2), and --help prints the usage and ends it (exit 0). */
void stage_open(struct stage *stage, int argc, char **argv, enum role role);

/* Ends a process that cannot allocate the memory of its steps (exit 1). errno says why. */
_Noreturn void stage_refuse_memory(const struct stage *stage);

/* Returns how many rows a stage should take memory for before it is ready. A guess: of a stand-by
 * process, another process may be writing the world. */
uint32_t stage_rows(const struct view *view);

/* Enters the sandbox, takes the role and marks it as ready. A stand-by process blocks until the
 * role's holder dies. Returns false if the process was asked to stop or the run ended meanwhile. */
bool stage_enter(struct stage *stage);

/* Stops the threads and detaches from the world. */
void stage_close(struct stage *stage);

#endif
