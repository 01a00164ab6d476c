/* The configuration that Cyclone DDS is given, as text. Pure but for reading the file; no DDS. */
#ifndef JOLON_TOPICS_DDS_CONFIG_H
#define JOLON_TOPICS_DDS_CONFIG_H

#include "ipc/segment.h"

#include <stddef.h>

#define DDS_CONFIG_MAX 65536u /* bytes of a configuration file, with a NUL */
#define DDS_LOOPBACK   "127.0.0.1"

/* Writes the built-in configuration for one IPv4 address of this machine into text; for
 * DDS_LOOPBACK it is config/cyclonedds.xml to the byte. -1 with the reason when address is not a
 * dotted IPv4 address or text is too small. */
int dds_config_builtin(char *text, size_t bytes, const char *address, struct reason *reason);

/* Reads a configuration file into text; -1 with the reason when it cannot be read, is too long, or
 * does not begin with an XML element. */
int dds_config_file(char *text, size_t bytes, const char *path, struct reason *reason);

/* Finds the IPv4 address (dotted, into address) of an interface given by its address or its name;
 * -1 with the reason, which lists what there is, when no interface that is up has it. */
int dds_config_interface(char *address, size_t bytes, const char *wanted, struct reason *reason);

#endif
