/* The names of a world's vehicles from the topic EntityNames. */
#ifndef JOLON_IPC_TOPICS_NAMES_READER_H
#define JOLON_IPC_TOPICS_NAMES_READER_H

#include "ipc/topics/dds_topics.h"
#include "ipc/topics/name_table.h"

struct names_reader {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader;
    dds_instance_handle_t writer; /* of the names */
    uint64_t looked_ns;           /* when that writer was last checked */
};

/* Makes the reader on the link, which must outlive it. Returns 0, or -1 with the reason. */
int names_reader_open(struct names_reader *reader, const struct dds_link *link,
                      struct error_text *error);

/* Takes the names that came, also those of a new world. Does not block. */
void names_reader_take(struct names_reader *reader, struct name_table *names);

#endif
