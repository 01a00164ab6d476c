/* Sends commands over the command socket while the storm goes on, one after the other, each
 * repeated under its key until it is answered. A thread of its own. */
#ifndef JOLON_TESTS_STORM_SENDER_H
#define JOLON_TESTS_STORM_SENDER_H

#include "tests/storm/storm.h"

struct sender;

/* Starts sending at most commands of them. NULL with the reason. */
struct sender *sender_start(const struct storm_options *options, struct error_text *error);

/* Sends no new ones and waits until the last is answered, at most 30 s. */
void sender_stop(struct sender *sender);

uint64_t sender_source(const struct sender *sender); /* key of all its commands */
uint64_t sender_sent(const struct sender *sender);   /* 1 .. sent */
uint64_t sender_answered(const struct sender *sender);

void sender_free(struct sender *sender);

#endif
