/* Sources: reading and parsing one file. */
#include "config/source.h"

#include "config/keys.h"
#include "config/literals.h"
#include "config/schema.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *type_of(mode_t mode)
{
    if (S_ISDIR(mode))
        return "a directory";
    if (S_ISFIFO(mode))
        return "a pipe";
    if (S_ISSOCK(mode))
        return "a socket";
    return "a device";
}

static int read_all(struct source *source, int fd, struct loader_message *message)
{
    const struct key_place place = {source->path, 0};
    size_t used = 0;

    while (used < source->bytes) {
        ssize_t got = read(fd, source->text + used, source->bytes - used);

        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return keys_refuse(message, place, NULL, NULL, "cannot be read: %s", strerror(errno));
        if (got == 0)
            return keys_refuse(message, place, NULL, NULL, "became shorter while it was read");
        used += (size_t)got;
    }
    source->text[used] = '\0';
    return 0;
}

int source_read(struct source *source, const char *path, struct loader_message *message)
{
    const struct key_place place = {path, 0};
    struct stat status;
    int result = -1;

    memset(source, 0, sizeof(*source));
    if (strlen(path) >= sizeof(source->path))
        return keys_refuse(message, place, NULL, NULL, "is too long for a path");
    memcpy(source->path, path, strlen(path) + 1);
    /* Without O_NONBLOCK the open of a pipe would wait for a writer. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0)
        return keys_refuse(message, place, NULL, NULL, "cannot be opened: %s", strerror(errno));
    if (fstat(fd, &status) != 0) {
        keys_refuse(message, place, NULL, NULL, "cannot be examined: %s", strerror(errno));
        goto err_open;
    }
    if (!S_ISREG(status.st_mode)) {
        keys_refuse(message, place, NULL, NULL, "is %s; allowed: a regular file",
                    type_of(status.st_mode));
        goto err_open;
    }
    if (status.st_size > (off_t)SCHEMA_FILE_BYTES_MAX) {
        keys_refuse(message, place, NULL, NULL, "has %lld bytes; allowed: up to %u",
                    (long long)status.st_size, SCHEMA_FILE_BYTES_MAX);
        goto err_open;
    }
    source->bytes = (size_t)status.st_size;
    source->text = malloc(source->bytes + 1);
    if (source->text == NULL) {
        keys_refuse(message, place, NULL, NULL, "no memory to read it");
        goto err_open;
    }
    result = read_all(source, fd, message);
    if (result != 0)
        source_free(source);
err_open:
    close(fd);
    return result;
}

void source_free(struct source *source)
{
    free(source->text);
    source->text = NULL;
    source->bytes = 0;
}

/* The parser follows @include to any file at all; it acts on it at the start of a line only. */
static int refuse_includes(const struct source *source, struct loader_message *message)
{
    int line = 1;

    for (const char *at = source->text; at != NULL && *at != '\0'; line++) {
        const char *word = at + strspn(at, " \t");

        if (strncmp(word, "@include", strlen("@include")) == 0) {
            const struct key_place place = {source->path, line};

            return keys_refuse(message, place, NULL, NULL,
                               "@include is not taken; write what it would include here");
        }
        at = strchr(at, '\n');
        if (at != NULL)
            at++;
    }
    return 0;
}

int source_parse(const struct source *source, config_t *config, struct loader_message *message)
{
    struct key_place place = {source->path, 0};

    if (strlen(source->text) != source->bytes)
        return keys_refuse(message, place, NULL, NULL, "is not text: it has a NUL byte");
    if (refuse_includes(source, message) != 0)
        return -1;
    char *text = literals_widen(source->text);
    if (text == NULL)
        return keys_refuse(message, place, NULL, NULL, "no memory to read it");
    int parsed = config_read_string(config, text);
    free(text);
    if (parsed != CONFIG_TRUE) {
        place.line = config_error_line(config);
        return keys_refuse(message, place, NULL, NULL,
                           "%s; right would be: group = { key = value; key = value; };",
                           config_error_text(config));
    }
    return 0;
}
