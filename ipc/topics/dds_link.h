/* A process's link to DDS: its domain, its participant, and the partitions of its world.
 *
 * A reporter has both partitions of its world (ipc/segment/world_partition.h). Any other process
 * has that of the world in this user's runtime folder. If an interface or a configuration is named
 * and the folder has no such world, it has the partition of the name, and so finds worlds of other
 * machines and users.
 *
 * The configuration is given to Cyclone DDS explicitly, so that CYCLONEDDS_URI in the environment
 * changes nothing. */
#ifndef JOLON_IPC_TOPICS_DDS_LINK_H
#define JOLON_IPC_TOPICS_DDS_LINK_H

#include "ipc/process/option_table.h"
#include "ipc/segment/segment.h"
#include "ipc/topics/dds_config.h"

#include <dds/dds.h>
#include <stdbool.h>

struct dds_link_options {
    const char *config;    /* a configuration file, NULL: the built-in one */
    const char *interface; /* an IPv4 address or an interface's name, NULL: loopback */
    uint32_t domain;       /* 0..230 */
    bool quiet;            /* Cyclone DDS's warnings are not logged */
    enum dds_part part;
};

#define DDS_LINK_DOMAIN_MAX 230u

/* clang-format off */
/* The options of every program with a link. They fill its struct dds_link_options. */
#define DDS_LINK_OPTION_ROWS(link)                                                                 \
    {"dds-config", "FILE", "a Cyclone DDS configuration instead of the built-in one",              \
     .text = &(link).config},                                                                      \
    {"interface", "ADDRESS", "DDS over this interface (address or name) instead of loopback",      \
     .text = &(link).interface},                                                                   \
    {"domain", "N", "DDS domain, 0 to 230 (default 0)", .u32 = &(link).domain,                     \
     .most = DDS_LINK_DOMAIN_MAX}
/* clang-format on */

struct dds_link {
    dds_entity_t domain, participant, publisher, subscriber;
    bool secure; /* by DDS Security: only participants with a valid certificate are heard */
};

/* Opens the link. Returns 0, or -1 with the reason: no such interface, a wrong configuration, no
 * socket, no runtime folder. Blocks for some milliseconds. */
int dds_link_open(struct dds_link *link, const struct dds_link_options *options, const char *world,
                  struct error_text *error);

/* Closes the link with everything that was made in it. Cyclone DDS may hang in that; the process
 * then ends with exit_code after a second. */
void dds_link_close(struct dds_link *link, int exit_code);

#endif
