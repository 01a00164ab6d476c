/* A process's link to DDS: its domain, its participant, and the partitions of its world.
 *
 * A reporter has both partitions of its world (ipc/segment/world_partition.h). Any other process
 * has that of the world in this user's runtime folder. If an interface or a configuration is named
 * and the folder has no such world, it looks for the worlds of the name, of other machines and
 * users. If there is one, the process has that world's own partition, and hears no other. If there
 * are several, the user has to say which. If there is none yet, it has the partition of the name,
 * and hears nobody once several worlds have begun in it: see dds_link_is_single().
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
    const char *partition; /* that of one world, NULL: it follows from the world's name */
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
/* The same of programs that read a world. */
#define DDS_LINK_READER_OPTION_ROWS(link)                                                          \
    DDS_LINK_OPTION_ROWS(link),                                                                    \
    {"partition", "NAME@FOLDER",                                                                   \
     "of several worlds of one name the one for which 'jolon world paths -w NAME partition' "       \
     "prints this", .text = &(link).partition}
/* clang-format on */

struct dds_link_search;

struct dds_link {
    dds_entity_t domain, participant, publisher, subscriber;
    bool secure; /* by DDS Security: only participants with a valid certificate are heard */
    struct dds_link_search *search; /* for worlds of the name; NULL: it has one world's partition */
};

/* Opens the link. Returns 0, or -1 with the reason: no such interface, a wrong configuration, no
 * socket, no runtime folder, several worlds of the name, no such partition. Blocks for some
 * milliseconds, and where it looks for worlds of the name for one second after it has found one,
 * or for three seconds. */
int dds_link_open(struct dds_link *link, const struct dds_link_options *options, const char *world,
                  struct error_text *error);

/* Returns false if the link has the partition of a name and several worlds have published in it:
 * their samples cannot be told apart, and a command would reach all of them. Logs their partitions
 * once. Any thread, one at a time. Does not block. */
bool dds_link_is_single(const struct dds_link *link);

/* Closes the link with everything that was made in it. Cyclone DDS may hang in that; the process
 * then ends with exit_code after a second. */
void dds_link_close(struct dds_link *link, int exit_code);

#endif
