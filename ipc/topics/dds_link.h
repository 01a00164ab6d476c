/* A process's link to DDS: its domain, participant, and the one partition of its world.
 *
 * Shared by the reporter, jolon-ctl and the monitor. The configuration is given to Cyclone DDS in
 * so many words, so that CYCLONEDDS_URI in somebody's environment changes nothing. */
#ifndef JOLON_IPC_TOPICS_DDS_LINK_H
#define JOLON_IPC_TOPICS_DDS_LINK_H

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

/* Options of the command line that every program with a link has: --dds-config, --interface and
 * --domain. For getopt_long; dds_link_option takes one, and ends the program on a wrong value. */
#define DDS_LINK_OPTION_FIRST 1000
#define DDS_LINK_LONG_OPTIONS                                                                      \
    {"dds-config", required_argument, NULL, DDS_LINK_OPTION_FIRST},                                \
        {"interface", required_argument, NULL, DDS_LINK_OPTION_FIRST + 1},                         \
    {                                                                                              \
        "domain", required_argument, NULL, DDS_LINK_OPTION_FIRST + 2                               \
    }

struct dds_link {
    dds_entity_t domain, participant, publisher, subscriber;
    bool secure; /* by DDS Security: nobody is heard whose certificate does not allow it */
};

/* True when option was one of them. */
bool dds_link_option(struct dds_link_options *options, int option, const char *argument);

/* Ends the program, with one line that says what would be right, when no world can have the name
 * that --world gave. */
void dds_link_check_world(const char *name);

/* Opens the link; 0, or -1 with the reason: no such interface, a wrong configuration, no socket.
 * Blocks for some milliseconds. */
int dds_link_open(struct dds_link *link, const struct dds_link_options *options, const char *world,
                  struct reason *reason);

/* Closes the link with all that was made in it. When Cyclone DDS hangs in that, which it may, the
 * process ends with exit_code after a second. */
void dds_link_close(struct dds_link *link, int exit_code);

#endif
