/* A source is a whole file in memory. Users may name any file; only regular files of limited size
 * are read. A file is read once, so that the bytes that are checked, parsed and hashed are the
 * same. */
#ifndef JOLON_CONFIG_SYNTAX_SOURCE_H
#define JOLON_CONFIG_SYNTAX_SOURCE_H

#include "world/runtime/error_text.h"

#include <libconfig.h>
#include <limits.h>
#include <stddef.h>

struct source {
    char path[PATH_MAX];
    char *text; /* ends with a NUL; the file may have more of them */
    size_t bytes;
};

/* Reads a file of at most `most` bytes that the user named. It may be anywhere, and the path may
 * have symbolic links. 0; -1 with the message, and nothing to free. */
int source_read(struct source *source, const char *path, size_t most, struct error_text *error);

/* Reads the file `name` of a folder. The name may come from a file or a directory, so it is refused
 * when it could lead out of the folder: a '/', "..", a symbolic link. The folder is the user's
 * choice and may be anywhere. 0; -1 with the message, and nothing to free. */
int source_read_in(struct source *source, const char *folder, const char *name, size_t most,
                   struct error_text *error);

void source_free(struct source *source);

/* Parses into config, which the caller has zeroed and later destroys. Refuses @include, because a
 * scenario is complete in one file. Refuses deeper nesting and larger groups than any schema has
 * before libconfig builds them. 0; -1 with the message. */
int source_parse(const struct source *source, config_t *config, struct error_text *error);

#endif
