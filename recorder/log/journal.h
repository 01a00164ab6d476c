/* A journal: a file of records that a kill cannot damage. Each line is one record, a JSON object
 * whose last member is the checksum of the line before it:
 *
 *     {"frame":7,...,"check":"0123456789abcdef"}
 *
 * The checksum is the XXH3-64 of every byte before `,"check"`, as 16 hex digits. Records are only
 * appended. A torn or damaged end is cut off when the journal is opened again, so that a journal
 * always consists of whole records. One process writes a journal; other processes may read it at
 * any time. */
#ifndef JOLON_RECORDER_LOG_JOURNAL_H
#define JOLON_RECORDER_LOG_JOURNAL_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Opening searches this much of the file's end for a good record [byte]. A record is far
 * shorter. */
#define JOURNAL_TAIL_BYTES (4u * 1024u * 1024u)

struct journal {
    const char *option, *path; /* the caller's: the option's name, "--events", and its value */
    int fd;
    char *last;    /* the last record at opening, without its newline; NULL: none */
    char *pending; /* bytes done .. used - 1 are still to be written */
    size_t done, used, capacity;
    int error;          /* errno of the last write if it failed, else 0 */
    uint64_t warned_ns; /* for log_due() */
};

/* Opens or creates the file (mode 0600) and cuts off a torn or damaged end. begins: the first bytes
 * of every journal of this kind; a file that begins otherwise is left as it is. Ends the process
 * with the reason (exit 1) if the path is not a plain file, if another recorder holds it, if it is
 * not such a journal, or if its last JOURNAL_TAIL_BYTES hold no good record. */
void journal_open(struct journal *journal, const char *option, const char *path,
                  const char *begins);

/* Returns the first record, without its newline, or NULL if it is damaged or missing. The caller
 * frees it. */
char *journal_first(const struct journal *journal);

/* Appends a record to the pending ones, and frees the object. */
void journal_append(struct journal *journal, cJSON *object);

/* Returns true if the line is the record of this object. Frees the object. */
bool journal_line_equals(const char *line, cJSON *object);

/* Cuts the journal before the first record for which beyond() returns true. The part cut off is
 * kept as path.old, which is replaced. journal->last is then the last record left. Call only while
 * no record is pending. Ends the process with the reason if that fails; nothing has then been cut
 * that is not in path.old. */
void journal_truncate(struct journal *journal, bool (*beyond)(const char *line, void *context),
                      void *context);

/* Waits until everything written is on the disk. Returns 0, or -1 with errno. */
int journal_sync(const struct journal *journal);

/* Writes the pending records. Returns 0, or -1 if the file system has no room or fails (ENOSPC,
 * EDQUOT, EFBIG, EIO, EROFS, ESTALE, ENXIO). That is logged at once and then every ten seconds, and
 * the records stay pending. Any other error ends the process with the reason. */
int journal_flush(struct journal *journal);

/* Writes pending records, and then sets *written to next: the number of the record after them.
 * Returns false if they stay pending. */
bool journal_flush_to(struct journal *journal, uint64_t *written, uint64_t next);

/* Closes the file. Returns 0, or -1 if pending records are lost. */
int journal_close(struct journal *journal);

/* Returns true if this line (without its newline) is a record with a correct checksum. */
bool journal_check(const char *line, size_t length);

#endif
