/* Journals: opening, appending, and a file system without room. */
#include "recorder/log/journal.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/log.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#define CHECK_BEGINS     ",\"check\":\""
#define CHECK_LENGTH     (sizeof CHECK_BEGINS - 1 + 16 + sizeof "\"}" - 1)
#define FIRST_BYTES_MAX  ((size_t)4 * 1024 * 1024) /* a begin record with a long recipe, escaped */
#define WARN_INTERVAL_NS (10 * (uint64_t)NS_PER_S)

/* Writes the end of a record: the checksum of the length bytes at line, NUL-terminated. */
static void check_text(const char *line, size_t length, char text[CHECK_LENGTH + 1])
{
    snprintf(text, CHECK_LENGTH + 1, CHECK_BEGINS "%016" PRIx64 "\"}",
             (uint64_t)XXH3_64bits(line, length));
}

bool journal_check(const char *line, size_t length)
{
    char text[CHECK_LENGTH + 1];
    if (length <= CHECK_LENGTH || line[0] != '{')
        return false;
    check_text(line, length - CHECK_LENGTH, text);
    return memcmp(line + length - CHECK_LENGTH, text, CHECK_LENGTH) == 0;
}

/* --- opening -----------------------------------------------------------------------------------*/

/* The end of a file in memory: length bytes from offset begin. */
struct tail {
    char *text;
    off_t begin;
    size_t length;
};

static void read_tail(const struct journal *journal, struct tail *tail)
{
    struct stat status;
    if (fstat(journal->fd, &status) != 0 || !S_ISREG(status.st_mode))
        die_refused("%s %s: must be a plain file", journal->option, journal->path);
    off_t most = (off_t)JOURNAL_TAIL_BYTES;
    tail->begin = status.st_size > most ? status.st_size - most : 0;
    size_t wanted = (size_t)(status.st_size - tail->begin);
    tail->length = 0;
    tail->text = malloc(wanted + 1);
    if (!tail->text)
        die_refused("out of memory for the end of %s %s", journal->option, journal->path);
    while (tail->length < wanted) {
        ssize_t got = pread(journal->fd, tail->text + tail->length, wanted - tail->length,
                            tail->begin + (off_t)tail->length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            die_refused("%s %s: cannot read: %s", journal->option, journal->path, strerror(errno));
        if (got == 0)
            break;
        tail->length += (size_t)got;
    }
}

/* Returns the length of the tail up to the end of its last good record, starting at the first
 * whole line; 0 if there is no good record. *last: where the last good record begins, *bytes: its
 * length. */
static size_t good_length(const struct tail *tail, size_t *last, size_t *bytes)
{
    size_t at = 0, good = 0;
    if (tail->begin > 0) { /* the tail probably begins within a line */
        const char *end = memchr(tail->text, '\n', tail->length);
        at = end ? (size_t)(end - tail->text) + 1 : tail->length;
    }
    while (at < tail->length) {
        const char *end = memchr(tail->text + at, '\n', tail->length - at);
        size_t length = end ? (size_t)(end - tail->text) - at : 0;
        if (!end || !journal_check(tail->text + at, length))
            break;
        *last = at;
        *bytes = length;
        at += length + 1;
        good = at;
    }
    return good;
}

/* A file without a good record may be overwritten only if it can be a torn first record. */
static bool may_be_torn(const struct tail *tail, const char *begins)
{
    size_t length = strlen(begins);
    return tail->begin == 0 && !memchr(tail->text, '\n', tail->length) &&
           strncmp(tail->text, begins, tail->length < length ? tail->length : length) == 0;
}

static void cut(struct journal *journal, off_t size, off_t end)
{
    if (end < size) {
        CRASH_POINT("cut of a log");
        if (ftruncate(journal->fd, end) != 0)
            die_refused("%s %s: cannot cut off its damaged end: %s", journal->option, journal->path,
                        strerror(errno));
        log_warn("%s %s: cut off %lld bytes after its last good record", journal->option,
                 journal->path, (long long)(size - end));
    }
    if (lseek(journal->fd, end, SEEK_SET) < 0)
        die_refused("%s %s: %s", journal->option, journal->path, strerror(errno));
}

void journal_open(struct journal *journal, const char *option, const char *path, const char *begins)
{
    struct tail tail;
    size_t last = 0, bytes = 0;
    *journal = (struct journal){.option = option, .path = path};
    CRASH_POINT("log file");
    journal->fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0600);
    if (journal->fd < 0)
        die_refused("%s %s: cannot open: %s", option, path, strerror(errno));
    if (flock(journal->fd, LOCK_EX | LOCK_NB) != 0)
        die_refused("%s %s: another recorder writes it; name another file", option, path);
    read_tail(journal, &tail);
    size_t good = good_length(&tail, &last, &bytes);
    if (good == 0 && tail.length > 0 && !may_be_torn(&tail, begins))
        die_refused("%s %s: is no such log of Jolon, or damaged beyond its last %u MB; name "
                    "another file",
                    option, path, JOURNAL_TAIL_BYTES >> 20);
    cut(journal, tail.begin + (off_t)tail.length, tail.begin + (off_t)good);
    if (good > 0 && !(journal->last = strndup(tail.text + last, bytes)))
        die_refused("out of memory for the end of %s %s", option, path);
    free(tail.text);
}

char *journal_first(const struct journal *journal)
{
    char *line = malloc(FIRST_BYTES_MAX);
    if (!line)
        die_refused("out of memory for the beginning of %s %s", journal->option, journal->path);
    ssize_t got = pread(journal->fd, line, FIRST_BYTES_MAX, 0);
    char *end = got > 0 ? memchr(line, '\n', (size_t)got) : NULL;
    if (!end || !journal_check(line, (size_t)(end - line))) {
        free(line);
        return NULL;
    }
    *end = '\0';
    return line;
}

bool journal_line_equals(const char *line, cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    size_t length = text ? strlen(text) - 1 : 0; /* without its closing brace */
    bool same = text && strncmp(line, text, length) == 0 &&
                strncmp(line + length, CHECK_BEGINS, sizeof CHECK_BEGINS - 1) == 0;
    cJSON_free(text);
    return same;
}

/* Reads the next line with its newline. Returns -1 only at the end of the file. A read error ends
 * the process, as everything after the last line read would be cut off. */
static ssize_t next_line(const struct journal *journal, FILE *file, char **line, size_t *capacity)
{
    ssize_t length = getline(line, capacity, file);
    if (ferror(file) || (length < 0 && !feof(file)))
        die_refused("%s %s: cannot read: %s; it is left as it is", journal->option, journal->path,
                    strerror(errno));
    return length;
}

/* Copies everything from an offset on. A partial copy of a killed process is overwritten. */
static void copy_from(const struct journal *journal, off_t from, const char *path)
{
    char buffer[65536];
    ssize_t got = 0;
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600);
    while (fd >= 0 && (got = pread(journal->fd, buffer, sizeof buffer, from)) > 0) {
        ssize_t put = write(fd, buffer, (size_t)got);
        if (put < 0)
            break;
        from += put; /* after a partial write the next one reports the full disk */
    }
    if (fd < 0 || got != 0 || fdatasync(fd) != 0)
        die_refused("%s %s: cannot keep its end as %s: %s", journal->option, journal->path, path,
                    strerror(errno));
    close(fd);
}

void journal_truncate(struct journal *journal, bool (*beyond)(const char *line, void *context),
                      void *context)
{
    char old[4096];
    char *line = NULL, *last = NULL;
    size_t capacity = 0;
    off_t end = 0;
    if ((size_t)snprintf(old, sizeof old, "%s.old", journal->path) >= sizeof old)
        die_refused("%s %s: cannot keep its end: the name is too long; name another file",
                    journal->option, journal->path);
    /* Reads the locked file, even if another file has its name by now. */
    int fd = fcntl(journal->fd, F_DUPFD_CLOEXEC, 0);
    FILE *file = fd >= 0 && lseek(fd, 0, SEEK_SET) == 0 ? fdopen(fd, "r") : NULL;
    if (!file)
        die_refused("%s %s: cannot read: %s", journal->option, journal->path, strerror(errno));
    for (ssize_t length; (length = next_line(journal, file, &line, &capacity)) > 0; end += length) {
        line[length - 1] = '\0';
        if (!journal_check(line, (size_t)length - 1))
            die_refused("%s %s: damaged at byte %lld; name another file", journal->option,
                        journal->path, (long long)end);
        if (beyond(line, context))
            break;
        free(last);
        last = strdup(line);
        if (!last)
            die_refused("out of memory for the end of %s %s", journal->option, journal->path);
    }
    copy_from(journal, end, old);
    free(journal->last);
    journal->last = last;
    free(line);
    fclose(file);
    if (ftruncate(journal->fd, end) != 0 || lseek(journal->fd, end, SEEK_SET) < 0)
        die_refused("%s %s: cannot cut: %s", journal->option, journal->path, strerror(errno));
}

/* --- appending ---------------------------------------------------------------------------------*/

static void reserve(struct journal *journal, size_t bytes)
{
    if (journal->capacity - journal->used >= bytes)
        return;
    size_t capacity = 2 * (journal->used + bytes);
    char *larger = realloc(journal->pending, capacity);
    if (!larger)
        die_refused("out of memory for records of %s %s", journal->option, journal->path);
    journal->pending = larger;
    journal->capacity = capacity;
}

void journal_append(struct journal *journal, cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    if (!text)
        die_refused("out of memory for a record of %s %s", journal->option, journal->path);
    size_t length = strlen(text) - 1; /* without its closing brace */
    reserve(journal, length + CHECK_LENGTH + 2);
    char *to = journal->pending + journal->used;
    memcpy(to, text, length + 2); /* the checksum overwrites the brace and the NUL */
    check_text(text, length, to + length);
    to[length + CHECK_LENGTH] = '\n';
    journal->used += length + CHECK_LENGTH + 1;
    cJSON_free(text);
}

/* Returns true for an error that may pass: no room, or a device that fails, is gone, or has become
 * read-only. If the recorder ended here, a world paused by its back-pressure would stay paused. */
static bool may_pass(int error)
{
    return error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO || error == EROFS ||
           error == ESTALE || error == ENXIO;
}

int journal_flush(struct journal *journal)
{
    while (journal->done < journal->used) {
        CRASH_POINT("write to a log");
        ssize_t wrote = write(journal->fd, journal->pending + journal->done,
                              CRASH_POINT_PART(journal->used - journal->done));
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote < 0 && !may_pass(errno))
            die_refused("%s %s: cannot write: %s", journal->option, journal->path, strerror(errno));
        if (wrote < 0) {
            journal->error = errno;
            if (log_due(&journal->warned_ns, WARN_INTERVAL_NS))
                log_warn("%s %s: cannot write: %s; tries again until it can", journal->option,
                         journal->path, strerror(journal->error));
            return -1;
        }
        CRASH_POINT("after a write to a log");
        journal->done += (size_t)wrote;
    }
    if (journal->error != 0)
        log_info("%s %s: can be written again", journal->option, journal->path);
    journal->error = 0;
    journal->warned_ns = 0;
    journal->done = journal->used = 0;
    return 0;
}

bool journal_flush_to(struct journal *journal, uint64_t *written, uint64_t next)
{
    if (journal_flush(journal) != 0)
        return false;
    *written = next;
    return true;
}

int journal_sync(const struct journal *journal)
{
    return fdatasync(journal->fd);
}

int journal_close(struct journal *journal)
{
    int result = journal_flush(journal);
    if (close(journal->fd) != 0)
        result = -1;
    free(journal->pending);
    free(journal->last);
    *journal = (struct journal){.fd = -1};
    return result;
}
