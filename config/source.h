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

/* Reads a file of at most `most` bytes that the user named: it may lie anywhere, behind a symbolic
 * link too. 0, or -1 with the message and nothing to free. */
int source_read(struct source *source, const char *path, size_t most,
                struct loader_message *message);

/* Reads the file `name` of a folder, for names that came out of files or directories: one that
 * could lead out of the folder (with a '/', "..", a symbolic link) is refused. The folder is the
 * user's and may lie anywhere. 0, or -1 with the message and nothing to free. */
int source_read_in(struct source *source, const char *folder, const char *name, size_t most,
                   struct loader_message *message);

void source_free(struct source *source);

/* Parses into config, which the caller has zeroed and destroys. @include is refused: a
 * scenario is one file, and says all it says. So is nesting and a group larger than any schema has,
 * before the parser builds it. 0, or -1 with the message. */
int source_parse(const struct source *source, config_t *config, struct loader_message *message);

#endif
