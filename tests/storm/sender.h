/* Sends commands over the command socket during the storm, one after the other. Each is repeated
 * under its key until it is answered. A thread of its own. */
#ifndef JOLON_TESTS_STORM_SENDER_H
#define JOLON_TESTS_STORM_SENDER_H

#include "tests/storm/storm.h"

struct sender;

/* Starts to send options->commands commands. Returns NULL with an error. */
struct sender *sender_start(const struct storm_options *options, struct error_text *error);

/* Sends no more commands and waits at most 30 s for the last answer. */
void sender_stop(struct sender *sender);

uint64_t sender_source(const struct sender *sender); /* source of all its commands */
uint64_t sender_sent(const struct sender *sender);   /* commands 1 .. sent */
uint64_t sender_answered(const struct sender *sender);

void sender_free(struct sender *sender);

#endif
