/* The configuration that Cyclone DDS is given, as text. Pure but for reading the file; no DDS. */
#ifndef JOLON_IPC_TOPICS_DDS_CONFIG_H
#define JOLON_IPC_TOPICS_DDS_CONFIG_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>

#define DDS_CONFIG_MAX 65536u /* bytes of a configuration file, with a NUL */
#define DDS_LOOPBACK   "127.0.0.1"

/* Everybody who discovers by multicast discovers everybody, which costs some milliseconds a pair:
 * a hundred onlookers would keep two cores busy for half a minute with one another. On loopback
 * they look for hosts alone, at the ports where these are. */
enum dds_part {
    DDS_PEER,
    DDS_HOST,     /* one that onlookers find: of the first DDS_HOSTS of a domain */
    DDS_ONLOOKER, /* it only reads, and nobody need know of it but hosts */
};
#define DDS_HOSTS 64u

/* Writes the built-in configuration for one IPv4 address of this machine into text; for
 * DDS_LOOPBACK and DDS_PEER it is config/cyclonedds.xml to the byte. -1 with the reason when
 * address is not a dotted IPv4 address or text is too small. */
int dds_config_builtin(char *text, size_t bytes, const char *address, enum dds_part part,
                       struct error_text *error);

/* Reads a configuration file into text; -1 with the reason when it cannot be read, is too long, or
 * does not begin with an XML element. */
int dds_config_file(char *text, size_t bytes, const char *path, struct error_text *error);

/* Does a configuration turn DDS Security on: an identity, and rules of the domain? What the rules
 * say is not looked at. */
bool dds_config_secure(const char *text);

/* Finds the IPv4 address (dotted, into address) of an interface given by its address or its name;
 * -1 with the reason, which lists what there is, when no interface that is up has it. */
int dds_config_interface(char *address, size_t bytes, const char *wanted, struct error_text *error);

#endif
