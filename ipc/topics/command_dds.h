/* The link for commands to a world on another machine: DDS, where that world's set was started with
 * --remote-commands. One thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_DDS_H
#define JOLON_IPC_TOPICS_COMMAND_DDS_H

#include "ipc/topics/command_link.h"
#include "ipc/topics/dds_topics.h"

struct command_dds {
    dds_entity_t replies, commands;
    int bell; /* an eventfd that a thread of Cyclone DDS rings */
};

/* Makes the reader and the writer in an open link; they end with it. 0, or -1 with the reason. */
int command_dds_open(struct command_dds *dds, const struct dds_link *link,
                     struct command_link *command_link, struct error_text *error);

#endif
