/* A journal: a file of records that a kill cannot spoil. One record a line, a JSON object whose
 * last member is the checksum of the line before it:
 *
 *     {"frame":7,...,"check":"0123456789abcdef"}
 *
 * 16 hex digits of the XXH3-64 of every byte before `,"check"`. Records are only ever appended. A
 * torn or damaged end is cut off when the journal is opened again, so that what it holds is always
 * a row of whole records. One process writes a journal; anybody reads it at any time. */
#ifndef JOLON_RECORDER_LOG_JOURNAL_H
#define JOLON_RECORDER_LOG_JOURNAL_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Opening looks at this much of the end [byte]; a record is far shorter. */
#define JOURNAL_TAIL_BYTES (4u * 1024u * 1024u)

struct journal {
    const char *option, *path; /* the caller's: "--events" and its value */
    int fd;
    char *last;    /* the last record when it was opened, without its end of line; NULL: none */
    char *waiting; /* bytes done .. used - 1 are still to be written */
    size_t done, used, room;
    int error;        /* errno of the write that did not go through, 0: all is well */
    uint64_t told_ns; /* when that was last said */
};

/* Opens or makes the file (mode 0600) and cuts off what is torn or damaged at its end. begins: how
 * the first record of such a journal begins; a file that begins otherwise is somebody else's and is
 * left as it is. Whatever is wrong ends the process with the reason (exit 1): not a plain file,
 * held by another recorder, no journal, no good record in the last JOURNAL_TAIL_BYTES. */
void journal_open(struct journal *journal, const char *option, const char *path,
                  const char *begins);

/* The first record of a journal, without its end of line; NULL when there is no good one. The
 * caller's to free. */
char *journal_first(const struct journal *journal);

/* Appends a record to what waits, and frees the object. */
void journal_put(struct journal *journal, cJSON *object);

/* Is the line the record of this object? Frees the object. */
bool journal_is(const char *line, cJSON *object);

/* Cuts the journal off before the first record that beyond() says so of, and keeps what is cut as
 * path.old, in the place of what had that name. journal->last is then the last record left. Only
 * before anything waits. Ends the process with the reason when that cannot be done: nothing is cut
 * then that is not in path.old. */
void journal_cut(struct journal *journal, bool (*beyond)(const char *line, void *context),
                 void *context);

/* Waits until everything written is on the disk. 0, or -1 with errno. */
int journal_sync(const struct journal *journal);

/* Writes what waits. 0; -1 when the file system has no room or fails (ENOSPC, EDQUOT, EFBIG, EIO,
 * EROFS, ESTALE, ENXIO): that is said at once and then every ten seconds, and what waits goes on
 * waiting. Any other error ends the process with the reason. */
int journal_flush(struct journal *journal);

/* Closes the file. 0; -1 when records that waited are lost. */
int journal_close(struct journal *journal);

/* Is this line (without its end of line) a record whose checksum is right? */
bool journal_check(const char *line, size_t length);

#endif
