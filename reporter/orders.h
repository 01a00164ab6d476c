/* Orders: commands from DDS into the command ring, and their replies back.
 *
 * A command is done once however often it comes and whenever this process is killed: the ring and
 * the events tell a successor what was taken and what was answered, and what was not taken the
 * sender repeats. When the ring is full nothing more is taken out of DDS until it has room. */
#ifndef JOLON_REPORTER_ORDERS_H
#define JOLON_REPORTER_ORDERS_H

#include "reporter/book.h"
#include "topics/dds_topics.h"

struct orders {
    dds_entity_t reader, writer;
    struct command held; /* found no room in the ring yet */
    bool holding;
    uint64_t refused_logged_ns, full_logged_ns;
    struct book book;
};

/* Recalls what a predecessor took, then makes the reader and writer; -1 with the reason. */
int orders_open(struct orders *orders, const struct view *view, const struct dds_link *link,
                struct reason *reason);

/* Takes what has come and puts it into the ring of view. When the run is over, and the answers of
 * its last frame were noted, the rest is refused. Does not block. */
void orders_take(struct orders *orders, struct view *view, bool over);

/* An EVENT_COMMAND was committed: notes the answer, and sends the reply if reply is true. */
void orders_answer(struct orders *orders, const struct event *event, bool reply);

/* Are there commands in the ring that wait for their answer? */
bool orders_waiting(const struct orders *orders);

#endif
