/* The history of commands: which (source, sequence) was taken, and its result.
 *
 * It keeps the last HISTORY_ENTRIES keys. At the highest rate of commands (ADMISSION_RING_ROOM a
 * frame) this is about 2.8 s at 60 Hz, much longer than a client waits between two repeats. Older
 * keys are still in the command ring and the event ring. One thread. */
#ifndef JOLON_REPORTER_INTAKE_COMMAND_HISTORY_H
#define JOLON_REPORTER_INTAKE_COMMAND_HISTORY_H

#include <stdbool.h>
#include <stdint.h>

#define HISTORY_ENTRIES 32768u
#define HISTORY_CHAINS  32768u /* a power of two */

struct history_entry {
    uint64_t source, sequence; /* source 0: the entry is empty */
    uint64_t frame;            /* the frame that answered it */
    uint64_t client;           /* the client that sent it last (client_sockets.h), 0: unknown */
    uint32_t type;             /* enum command_type */
    uint32_t result;           /* enum command_result, when answered */
    uint32_t entity;
    uint32_t next; /* entry + 1 in the same chain, 0 ends */
    bool answered;
};

struct command_history {
    struct history_entry entry[HISTORY_ENTRIES];
    uint32_t chain[HISTORY_CHAINS]; /* entry + 1, 0 for none */
    uint32_t oldest;                /* the entry to be overwritten next */
    uint32_t waiting;               /* entries not yet answered */
    uint64_t seed;                  /* of the chains' hash */
};

/* Empties the history. The seed should be random. */
void command_history_clear(struct command_history *history, uint64_t seed);

/* Returns the entry of a key, NULL when there is none. */
struct history_entry *command_history_find(struct command_history *history, uint64_t source,
                                           uint64_t sequence);

/* Adds a command that waits for its answer, with its client. A key that exists stays as it is. */
void command_history_wait(struct command_history *history, uint64_t source, uint64_t sequence,
                          uint32_t type, uint64_t client);

/* Adds an answer, also to an unknown command. Returns its entry. */
struct history_entry *command_history_answer(struct command_history *history, uint64_t source,
                                             uint64_t sequence, uint32_t type, uint32_t result,
                                             uint32_t entity, uint64_t frame);

#endif
