/* The configuration of Cyclone DDS, as text. */
#ifndef JOLON_IPC_TOPICS_DDS_CONFIG_H
#define JOLON_IPC_TOPICS_DDS_CONFIG_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>

#define DDS_CONFIG_MAX 65536u /* bytes of a configuration file, with the NUL */
#define DDS_LOOPBACK   "127.0.0.1"

/* A participant that discovers by multicast discovers all others, which costs some milliseconds for
 * each pair: a hundred observers would keep two cores busy for half a minute. So on loopback
 * observers look for hosts only, at the hosts' ports. */
enum dds_part {
    DDS_PEER,
    DDS_HOST,     /* found by observers: one of the first DDS_HOSTS of a domain */
    DDS_OBSERVER, /* only reads; only hosts need to know it */
};
#define DDS_HOSTS 64u

/* Writes the built-in configuration for one IPv4 address of this machine into text. For
 * DDS_LOOPBACK and DDS_PEER it is config/cyclonedds.xml to the byte. Returns 0, or -1 with the
 * reason: address is not a dotted IPv4 address, or text is too small. */
int dds_config_builtin(char *text, size_t bytes, const char *address, enum dds_part part,
                       struct error_text *error);

/* Reads a configuration file into text. Returns 0, or -1 with the reason: it cannot be read, is too
 * long, or does not begin with an XML element. */
int dds_config_file(char *text, size_t bytes, const char *path, struct error_text *error);

/* Returns true if a configuration turns DDS Security on: it has an identity and the domain's rules.
 * The rules are not read. */
bool dds_config_secure(const char *text);

/* Finds the IPv4 address (dotted) of an interface, given by its address or its name. Returns 0, or
 * -1 with the reason, which lists the interfaces, when no interface that is up has it. */
int dds_config_interface(char *address, size_t bytes, const char *wanted, struct error_text *error);

#endif
