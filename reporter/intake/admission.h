/* Admission: chooses the waiting command that goes into the command ring next.
 *
 * Each source (a client's connection) has a queue and budgets of its own. Sources are served in
 * turn, one command each, so a source that floods delays only itself. Operators' commands (pause,
 * resume, step, scale, remove, quit) go first and have ring slots reserved for them. Costly
 * commands (spawns, and munitions without a shooter) add bodies to the world, which makes every
 * frame slower. They have a budget for each source, one for all sources together, and a small one
 * for all while the world's frames take more than ADMISSION_STRAIN_SHARE of their time.
 *
 * Commands beyond a budget wait in their source's queue. When the queue is full, the caller stops
 * reading from that source, and the client's writes block. Nothing is dropped here.
 *
 * Times come from the caller. One thread. */
#ifndef JOLON_REPORTER_INTAKE_ADMISSION_H
#define JOLON_REPORTER_INTAKE_ADMISSION_H

#include "ipc/process/rate.h"

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

#define ADMISSION_SOURCES 128u
#define ADMISSION_QUEUE   16u /* waiting commands of one source */

/* Budgets a second and in one burst. They allow a program that drives 50 vehicles at 60 Hz. */
#define ADMISSION_COMMANDS_PER_S   3000u
#define ADMISSION_COMMANDS_BURST   300u
#define ADMISSION_COSTLY_PER_S     50u /* of one source */
#define ADMISSION_COSTLY_BURST     20u
#define ADMISSION_ALL_COSTLY_PER_S 100u /* of all sources */
#define ADMISSION_ALL_COSTLY_BURST 40u
#define ADMISSION_STRAINED_PER_S   8u /* of all sources, in a strained world */
#define ADMISSION_STRAINED_BURST   8u

/* The world is strained when the work of a frame takes more than this share of the frame's time. */
#define ADMISSION_STRAIN_SHARE 0.5

/* Commands that may wait in the ring. The mover takes 256 a frame, so an admitted command is
 * applied in the next frame. */
#define ADMISSION_RING_ROOM          192u
#define ADMISSION_RING_ROOM_OPERATOR 224u

struct admission_source {
    uint64_t client; /* its key (client_sockets.h), 0: free */
    struct rate commands, costly;
    uint32_t first, count; /* of the queue */
    jolon_Command queue[ADMISSION_QUEUE];
};

struct admission {
    struct admission_source source[ADMISSION_SOURCES];
    struct rate costly; /* of all sources */
    struct rate strained;
    uint32_t next; /* the source that is served first */
};

/* admission_enter() gives source i to a client, with an empty queue and full budgets.
 * admission_leave() frees it. */
void admission_enter(struct admission *admission, uint32_t i, uint64_t client);
void admission_leave(struct admission *admission, uint32_t i);

/* Returns true if the queue of source i has room. */
bool admission_room(const struct admission *admission, uint32_t i);

/* Appends a command to the queue of source i, which must have room. */
void admission_put(struct admission *admission, uint32_t i, const jolon_Command *command);

/* The state of the world on which admission depends. */
struct admission_world {
    uint64_t untaken; /* commands in the ring that no frame has taken */
    bool strained;    /* its frames take more than ADMISSION_STRAIN_SHARE of their time */
};

/* Takes the next command for the ring and its client. Returns false when none may go now. */
bool admission_take(struct admission *admission, const struct admission_world *world,
                    uint64_t now_ns, jolon_Command *command, uint64_t *client);

/* Returns true if a command waits, even if it may not go now. */
bool admission_waiting(const struct admission *admission);

/* Return true for operators' commands, and for commands that add bodies to the world. */
bool admission_is_operators(const jolon_Command *command);
bool admission_is_costly(const jolon_Command *command);

#endif
