/* Admission: which of the commands that wait may go into the command ring now.
 *
 * Each source (a client's connection) has a queue and budgets of its own. Sources take turns, one
 * command each, so that a source that floods delays only itself. Commands of operators (pause,
 * resume, step, scale, remove, quit) go before others and have ring slots that are kept for them.
 * Costly commands (spawns, and munitions out of the sky) put bodies into the world, whose frames
 * cost more for everybody. They have a budget a source, one for all sources together, and a small
 * one for all while the world's frames take more than ADMISSION_STRAIN_SHARE of their time.
 *
 * What exceeds a budget waits in its source's queue; when that is full, the caller reads no more of
 * that source, and the client's own writes block. Nothing is dropped here.
 *
 * Pure: times come from the caller. One thread. */
#ifndef JOLON_REPORTER_INTAKE_ADMISSION_H
#define JOLON_REPORTER_INTAKE_ADMISSION_H

#include "ipc/process/rate.h"

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

#define ADMISSION_SOURCES 128u
#define ADMISSION_QUEUE   16u /* commands that wait, of one source */

/* Budgets, a second and in one burst. The measure: a program that drives 50 vehicles at 60 Hz. */
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

/* Commands that may lie in the ring untaken. The mover takes 256 a frame, so what is admitted is
 * applied in the next frame. */
#define ADMISSION_RING_ROOM          192u
#define ADMISSION_RING_ROOM_OPERATOR 224u

struct admission_source {
    uint64_t client; /* its key (client_sockets.h), 0: the place is free */
    struct rate commands, costly;
    uint32_t first, count; /* of the queue */
    jolon_Command queue[ADMISSION_QUEUE];
};

struct admission {
    struct admission_source source[ADMISSION_SOURCES];
    struct rate costly; /* of all sources */
    struct rate strained;
    uint32_t next; /* the source whose turn comes first */
};

/* Gives place i to a client, with an empty queue and full budgets; takes it back. */
void admission_enter(struct admission *admission, uint32_t i, uint64_t client);
void admission_leave(struct admission *admission, uint32_t i);

/* Is there room in the queue of place i? */
bool admission_room(const struct admission *admission, uint32_t i);

/* Puts a command at the end of the queue of place i, which must have room. */
void admission_put(struct admission *admission, uint32_t i, const jolon_Command *command);

/* What the intake knows of the world when it admits commands. */
struct admission_world {
    uint64_t untaken; /* commands that lie in the ring */
    bool strained;    /* its frames take more than ADMISSION_STRAIN_SHARE of their time */
};

/* Takes the command that is to go into the ring next. Returns false when none may go now. Fills
 * command and client. */
bool admission_take(struct admission *admission, const struct admission_world *world,
                    uint64_t now_ns, jolon_Command *command, uint64_t *client);

/* True when a command waits, whether or not it may go now. */
bool admission_waiting(const struct admission *admission);

/* True for the commands that operators' slots are kept for, and for those that put bodies into the
 * world. */
bool admission_is_operators(const jolon_Command *command);
bool admission_is_costly(const jolon_Command *command);

#endif
