/* Sources: whole files in memory. Files that are named by people may be anything; only regular
 * files of bounded size are read, and the bytes that were checked are the bytes that are parsed
 * and hashed. */
#ifndef JOLON_CONFIG_SOURCE_H
#define JOLON_CONFIG_SOURCE_H

#include "config/loader.h"

#include <libconfig.h>
#include <limits.h>
#include <stddef.h>

struct source {
    char path[PATH_MAX];
    char *text; /* NUL-terminated, but may hold NULs of its own */
    size_t bytes;
};

/* Reads a file of at most SCHEMA_FILE_BYTES_MAX. 0, or -1 with the message and nothing to free. */
int source_read(struct source *source, const char *path, struct loader_message *message);
void source_free(struct source *source);

/* Parses into config, which the caller has initialised and destroys. @include is refused: a
 * scenario is one file, and says all it says. 0, or -1 with the message. */
int source_parse(const struct source *source, config_t *config, struct loader_message *message);

#endif
