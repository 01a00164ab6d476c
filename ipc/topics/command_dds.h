/* The link for commands to a world on another machine: DDS. That world's set must run with
 * --remote-commands. One thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_DDS_H
#define JOLON_IPC_TOPICS_COMMAND_DDS_H

#include "ipc/topics/command_link.h"
#include "ipc/topics/dds_topics.h"

struct command_dds {
    const struct dds_link *link; /* the caller's */
    dds_entity_t replies, commands;
    int wakeup; /* an eventfd that a thread of Cyclone DDS writes when a reply comes */
};

/* Makes the reader and the writer in an open link, with which they end. Returns 0, or -1 with the
 * reason. */
int command_dds_open(struct command_dds *dds, const struct dds_link *link,
                     struct command_link *command_link, struct error_text *error);

#endif
