/* Samples as they come from a topic of a world's status: only those that a reporter could have
 * written. Anybody in the domain can write there; a number that is none, a value that no
 * enumeration has or a count that does not fit would be carried on into tables and screens. */
#ifndef JOLON_IPC_TOPICS_SAMPLES_H
#define JOLON_IPC_TOPICS_SAMPLES_H

#include "ipc/topics/dds_topics.h"

#include <stdbool.h>

struct samples {
    dds_entity_t reader;
    enum dds_topic topic;
    void *sample;                 /* the one taken, valid until the next; NULL at first */
    dds_instance_handle_t writer; /* who wrote it */
};

/* Takes the next sample that is there and good; false, with nothing held, at the last. Begin with
 * {reader, topic}. Does not block. */
bool samples_next(struct samples *samples);

/* Could a reporter have written it? Bytes of its texts that are no printable text, as UTF-8, become
 * '?'. Any sample of the topics of the status, from WorldInfo to EntityNames. */
bool samples_good(enum dds_topic topic, void *sample);

#endif
