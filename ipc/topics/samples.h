/* Samples from the topics of a world's status: only those that a reporter could have written. Any
 * process in the domain can write there. A value that is not finite, is in no enumeration or does
 * not fit its table would reach tables and screens. */
#ifndef JOLON_IPC_TOPICS_SAMPLES_H
#define JOLON_IPC_TOPICS_SAMPLES_H

#include "ipc/topics/dds_topics.h"

#include <stdbool.h>

struct samples {
    dds_entity_t reader;
    enum dds_topic topic;
    void *sample; /* the last sample taken, valid until the next call; NULL at first */
    dds_instance_handle_t writer; /* the sample's writer */
};

/* Takes the next good sample. Returns false, holding none, when there is no further one. Begin with
 * {reader, topic}. Does not block. */
bool samples_next(struct samples *samples);

/* Returns true if a reporter could have written the sample, of any topic from WorldInfo to
 * EntityNames. In its texts, bytes that are no printable UTF-8 become '?'. */
bool samples_good(enum dds_topic topic, void *sample);

/* Returns true for a number that arithmetic can take: it is finite, and not far beyond those of any
 * world. Any thread. */
bool samples_number(double value);

#endif
