/* The history of commands: which (source, sequence) was taken, and what became of it.
 *
 * It keeps the last HISTORY_ENTRIES keys: at the most that the ring takes (ADMISSION_RING_ROOM a
 * frame) some 2.8 s at 60 Hz, many times a client's pause between two repeats. The command ring and
 * the event ring still know what the history has forgotten. Pure; one thread. */
#ifndef JOLON_REPORTER_INTAKE_COMMAND_HISTORY_H
#define JOLON_REPORTER_INTAKE_COMMAND_HISTORY_H

#include <stdbool.h>
#include <stdint.h>

#define HISTORY_ENTRIES 32768u
#define HISTORY_CHAINS  32768u /* a power of two */

struct history_entry {
    uint64_t source, sequence; /* source 0: the entry is empty */
    uint64_t frame;            /* that answered it */
    uint64_t client;           /* that sent it last (client_sockets.h), 0: not known */
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

/* Empties it. The seed should be a random number. */
void command_history_clear(struct command_history *history, uint64_t seed);

/* The entry of a key, NULL when the history does not have it. */
struct history_entry *command_history_find(struct command_history *history, uint64_t source,
                                           uint64_t sequence);

/* Notes a command that waits for its answer, and its client. A key that the history has already is
 * left as it is. */
void command_history_wait(struct command_history *history, uint64_t source, uint64_t sequence,
                          uint32_t type, uint64_t client);

/* Notes an answer, whether or not the history knew the command. Returns its entry. */
struct history_entry *command_history_answer(struct command_history *history, uint64_t source,
                                             uint64_t sequence, uint32_t type, uint32_t result,
                                             uint32_t entity, uint64_t frame);

#endif
