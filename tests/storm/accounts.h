/* What the storm left, against what should be there. */
#ifndef JOLON_TESTS_STORM_ACCOUNTS_H
#define JOLON_TESTS_STORM_ACCOUNTS_H

#include "tests/storm/band.h"

struct accounts {
    uint64_t frame, digest, event_digest; /* of the last committed frame */
    uint64_t events;                      /* committed */
    uint64_t lost, repeated;              /* of them in the log of events, by number and by key */
    uint64_t collisions;
    bool compared; /* there was something to compare the digest with */
    uint64_t calm_digest, calm_event_digest;
    uint64_t commands_lost, commands_repeated; /* sent ones without an answer, with several */
};

/* Takes the last frame's digests from the set's mapping, once it has stopped. 0, or -1 with the
 * reason. */
int accounts_world(struct accounts *accounts, const struct band *band, struct error_text *error);

/* Reads the log of events: every sequence from 0 on once, keys ascending; and the answers to
 * commands of this source, of which 1 .. sent must be there once. 0, or -1 with the reason. */
int accounts_log(struct accounts *accounts, const struct storm_options *options, uint64_t source,
                 uint64_t sent, struct error_text *error);

/* Runs the same scenario undisturbed to the same frame: with the commands of the log of commands
 * where there were some. 0, or -1 with the reason. */
int accounts_calm(struct accounts *accounts, const struct storm_options *options,
                  struct error_text *error);

#endif
