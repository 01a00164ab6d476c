/* Compares what the set has written with what it must have written. */
#ifndef JOLON_TESTS_STORM_CONSISTENCY_H
#define JOLON_TESTS_STORM_CONSISTENCY_H

#include "tests/storm/tested_set.h"

struct consistency {
    uint64_t frame, digest, event_digest; /* of the last committed frame */
    uint64_t events;                      /* committed */
    uint64_t lost, repeated; /* in the log of events, by sequence and by (frame, index) */
    uint64_t collisions;
    bool compared; /* the undisturbed run reached the same frame */
    uint64_t reference_digest, reference_event_digest;
    uint64_t commands_lost, commands_repeated; /* sent commands with no answer, and with several */
};

/* Takes the last frame's digests from the set's mapping. Called after the set has stopped. Returns
 * 0, or -1 with an error. */
int consistency_read_world(struct consistency *consistency, const struct tested_set *set,
                           struct error_text *error);

/* Reads the log of events. Every sequence from 0 on must occur once with ascending (frame, index),
 * and every command 1 .. sent of this source must be answered once. Returns 0, or -1 with an error.
 */
int consistency_read_log(struct consistency *consistency, const struct storm_options *options,
                         uint64_t source, uint64_t sent, struct error_text *error);

/* Runs the same scenario undisturbed to the same frame. If commands were sent, it replays the log
 * of commands. Returns 0, or -1 with an error. */
int consistency_run_reference(struct consistency *consistency, const struct storm_options *options,
                              struct error_text *error);

#endif
