/* The names of a world's vehicles as they come over DDS: the topic EntityNames. */
#ifndef JOLON_IPC_TOPICS_NAMES_READER_H
#define JOLON_IPC_TOPICS_NAMES_READER_H

#include "ipc/topics/dds_topics.h"
#include "ipc/topics/name_table.h"

struct names_reader {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader;
    dds_instance_handle_t writer; /* that the names came from */
    uint64_t looked_ns;           /* whether that writer is still there */
};

/* Makes the reader on the link, which must outlive it; -1 with the reason. */
int names_reader_open(struct names_reader *reader, const struct dds_link *link,
                      struct error_text *error);

/* Takes the names if they came, or came anew for another world. Does not block. */
void names_reader_take(struct names_reader *reader, struct name_table *names);

#endif
