/* Reads and parses one file. */
#include "config/syntax/source.h"

#include "config/syntax/key_table.h"
#include "config/syntax/literals.h"
#include "config/syntax/schema.h"
#include "world/runtime/checked_alloc.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
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
    if (S_ISLNK(mode))
        return "a symbolic link";
    return "a device";
}

static int read_all(struct source *source, int fd, struct error_text *error)
{
    const struct key_place place = {source->path, 0};
    size_t used = 0;
    while (used < source->bytes) {
        ssize_t got = read(fd, source->text + used, source->bytes - used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return key_table_refuse(error, place, NULL, NULL, "cannot be read: %s",
                                    strerror(errno));
        if (got == 0)
            return key_table_refuse(error, place, NULL, NULL, "became shorter while it was read");
        used += (size_t)got;
    }
    source->text[used] = '\0';
    return 0;
}

static int check_status(const struct stat *status, size_t most, struct key_place place,
                        struct error_text *error)
{
    if (!S_ISREG(status->st_mode))
        return key_table_refuse(error, place, NULL, NULL, "is %s; allowed: a regular file",
                                type_of(status->st_mode));
    if (status->st_size > (off_t)most)
        return key_table_refuse(error, place, NULL, NULL, "has %lld bytes; allowed: up to %zu",
                                (long long)status->st_size, most);
    return 0;
}

/* Opens a file in folder (AT_FDCWD: the working directory). The status is checked before the file
 * is opened, because opening a device may have an effect, and again after, because the name may
 * have changed its meaning. follow: 0 or AT_SYMLINK_NOFOLLOW. -1 with the message. */
static int open_checked(int folder, const char *name, int follow, struct key_place place,
                        size_t most, struct stat *status, struct error_text *error)
{
    int flags = O_RDONLY | O_CLOEXEC | O_NOCTTY;
    if (fstatat(folder, name, status, follow) == 0 && check_status(status, most, place, error) != 0)
        return -1;
    /* Without O_NONBLOCK the open of a pipe would wait for a writer. */
    int fd = openat(folder, name, flags | O_NONBLOCK | (follow != 0 ? O_NOFOLLOW : 0));
    if (fd < 0)
        return key_table_refuse(error, place, NULL, NULL, "cannot be opened: %s", strerror(errno));
    if (fstat(fd, status) != 0) {
        key_table_refuse(error, place, NULL, NULL, "cannot be examined: %s", strerror(errno));
        goto err_open;
    }
    if (check_status(status, most, place, error) == 0)
        return fd;
err_open:
    close(fd);
    return -1;
}

/* Reads an open file whole, and closes it. */
static int take(struct source *source, int fd, const struct stat *status, struct error_text *error)
{
    const struct key_place place = {source->path, 0};
    int result = -1;
    if (fd < 0)
        return -1;
    source->bytes = (size_t)status->st_size;
    source->text = malloc(source->bytes + 1);
    if (source->text == NULL)
        key_table_refuse(error, place, NULL, NULL, "no memory to read it");
    else
        result = read_all(source, fd, error);
    if (result != 0)
        source_free(source);
    close(fd);
    return result;
}

int source_read(struct source *source, const char *path, size_t most, struct error_text *error)
{
    const struct key_place place = {path, 0};
    struct stat status;
    memset(source, 0, sizeof(*source));
    if (strlen(path) >= sizeof(source->path))
        return key_table_refuse(error, place, NULL, NULL, "is too long for a path");
    memcpy(source->path, path, strlen(path) + 1);
    int fd = open_checked(AT_FDCWD, path, 0, place, most, &status, error);
    return take(source, fd, &status, error);
}

int source_read_in(struct source *source, const char *folder, const char *name, size_t most,
                   struct error_text *error)
{
    const struct key_place place = {source->path, 0};
    struct stat status;
    memset(source, 0, sizeof(*source));
    int length = snprintf(source->path, sizeof(source->path), "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof(source->path))
        return key_table_refuse(error, place, NULL, NULL, "is too long for a path");
    if (name[0] == '\0' || strchr(name, '/') != NULL || strcmp(name, ".") == 0 ||
        strcmp(name, "..") == 0)
        return key_table_refuse(error, place, NULL, NULL,
                                "is not the name of a file in %s; allowed: a name without '/'",
                                folder);
    int dir = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (dir < 0)
        return key_table_refuse(error, place, NULL, NULL, "cannot be opened: %s", strerror(errno));
    /* A name without a slash leads out of the folder only by a symbolic link. */
    int fd = open_checked(dir, name, AT_SYMLINK_NOFOLLOW, place, most, &status, error);
    close(dir);
    return take(source, fd, &status, error);
}

void source_free(struct source *source)
{
    free(source->text);
    source->text = NULL;
    source->bytes = 0;
}

/* libconfig would read any file that an @include at the start of a line names. */
static int refuse_includes(const struct source *source, struct error_text *error)
{
    int line = 1;
    for (const char *at = source->text; at != NULL && *at != '\0'; line++) {
        const char *word = at + strspn(at, " \t");
        if (strncmp(word, "@include", strlen("@include")) == 0) {
            const struct key_place place = {source->path, line};
            return key_table_refuse(
                error, place, NULL, NULL,
                "@include is not supported; right would be: the included text itself");
        }
        at = strchr(at, '\n');
        if (at != NULL)
            at++;
    }
    return 0;
}

/* Refuses trees that no schema has before libconfig builds them: it keeps every part in memory, and
 * each key added to a group costs a search of the group. It also takes a string that never ends for
 * the end of the file. */
static int check_shape(const struct source *source, struct error_text *error)
{
    struct literals_shape shape;
    literals_measure(source->text, &shape);
    const struct key_place deepest = {source->path, shape.deepest_line};
    const struct key_place open = {source->path, shape.open_line};
    const struct key_place fullest = {source->path, shape.fullest_line};
    if (shape.open_line > 0)
        return key_table_refuse(
            error, open, NULL, NULL,
            "has a string or comment that never ends; right would be: a closing \" or */");
    if (shape.deepest > SCHEMA_DEPTH_MAX)
        return key_table_refuse(error, deepest, NULL, NULL,
                                "is nested %u deep; allowed: up to %u levels of ( [ {",
                                shape.deepest, SCHEMA_DEPTH_MAX);
    if (shape.fullest > SCHEMA_MEMBERS_MAX)
        return key_table_refuse(error, fullest, NULL, NULL,
                                "is a group of %u keys; allowed: up to %u", shape.fullest,
                                SCHEMA_MEMBERS_MAX);
    return 0;
}

struct parsing {
    config_t *config;
    const char *text;
    int result;
};

static void parse(void *context)
{
    struct parsing *parsing = context;
    config_init(parsing->config);
    parsing->result = config_read_string(parsing->config, parsing->text);
}

/* Copies a line of the text, without the space around it and with "..." for what has no room. */
static void quote_line(const char *text, int line, char *quoted, size_t room)
{
    for (int n = 1; n < line && text != NULL; n++) {
        text = strchr(text, '\n');
        text = text != NULL ? text + 1 : NULL;
    }
    text = text != NULL ? text + strspn(text, " \t\r") : "";
    size_t length = strcspn(text, "\n");
    while (length > 0 && strchr(" \t\r", text[length - 1]) != NULL)
        length--;
    snprintf(quoted, room, "%.*s%s", (int)(length < room - 4 ? length : room - 4), text,
             length < room - 4 ? "" : "...");
}

/* Returns true if the text has the word where a value may stand, as the 1.0 / 0.0 of a program
 * prints it. */
static bool has_value(const char *text, const char *word)
{
    const char *found = strcasestr(text, word);
    while (found != NULL && (found == text || strchr(" =:,[(-+", found[-1]) == NULL))
        found = strcasestr(found + 1, word);
    return found != NULL && !isalpha((unsigned char)found[strlen(word)]);
}

/* Refuses what libconfig cannot read. It names the line alone. */
static int refuse_syntax(const struct source *source, const config_t *config,
                         struct error_text *error)
{
    const struct key_place place = {source->path, config_error_line(config)};
    char quoted[100];
    quote_line(source->text, place.line, quoted, sizeof quoted);
    const char *what = config_error_text(config);
    const char *right = "group = { key = value; key = value; };";
    if (strcmp(what, "duplicate setting name") == 0) {
        what = "a key that its group already has";
        right = "each key once in a group";
    } else if (quoted[0] == '\0') {
        snprintf(quoted, sizeof quoted, "the end of the text");
    } else if (has_value(quoted, "yes") || has_value(quoted, "no")) {
        right = "true or false";
    } else if (has_value(quoted, "nan") || has_value(quoted, "inf")) {
        right = "a finite number, as 1.5 or 2e3";
    }
    return key_table_refuse(error, place, NULL, NULL, "%s, at or before `%s`; right would be: %s",
                            what, quoted, right);
}

/* The line of the first NUL byte of a text. */
static struct key_place nul_place(const struct source *source)
{
    struct key_place place = {source->path, 1};
    for (const char *at = source->text; *at != '\0'; at++)
        place.line += *at == '\n';
    return place;
}

int source_parse(const struct source *source, config_t *config, struct error_text *error)
{
    const struct key_place place = {source->path, 0};
    if (strlen(source->text) != source->bytes)
        return key_table_refuse(error, nul_place(source), NULL, NULL,
                                "has a NUL byte; right would be: text");
    if (refuse_includes(source, error) != 0 || check_shape(source, error) != 0)
        return -1;
    char *text = literals_widen(source->text);
    if (text == NULL)
        return key_table_refuse(error, place, NULL, NULL, "no memory to read it");
    struct parsing parsing = {config, text, CONFIG_FALSE};
    bool whole = memory_guarded(parse, &parsing);
    free(text);
    if (!whole) {
        memset(config, 0, sizeof(*config)); /* what it holds may be half made */
        return key_table_refuse(error, place, NULL, NULL, "no memory to read it");
    }
    if (parsing.result != CONFIG_TRUE)
        return refuse_syntax(source, config, error);
    return 0;
}
