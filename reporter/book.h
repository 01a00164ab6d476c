/* The book of commands: which (source, sequence) was taken, and what became of it.
 *
 * It keeps the last BOOK_ENTRIES keys. What it forgets is still known to the command ring and the
 * event ring; the book only saves looking there. Pure; one thread. */
#ifndef JOLON_REPORTER_BOOK_H
#define JOLON_REPORTER_BOOK_H

#include <stdbool.h>
#include <stdint.h>

#define BOOK_ENTRIES 4096u
#define BOOK_CHAINS  4096u /* a power of two */

struct book_entry {
    uint64_t source, sequence; /* source 0: the entry is empty */
    uint64_t frame;            /* that answered it */
    uint32_t type;             /* enum command_type */
    uint32_t result;           /* enum command_result, when answered */
    uint32_t entity;
    uint32_t next; /* entry + 1 in the same chain, 0 ends */
    bool answered;
};

struct book {
    struct book_entry entry[BOOK_ENTRIES];
    uint32_t chain[BOOK_CHAINS]; /* entry + 1, 0 for none */
    uint32_t oldest;             /* the entry to be overwritten next */
    uint32_t waiting;            /* entries not yet answered */
};

void book_clear(struct book *book);

/* The entry of a key, NULL when the book does not have it. */
const struct book_entry *book_find(struct book *book, uint64_t source, uint64_t sequence);

/* Notes a command that waits for its answer; one that is in the book is left as it is. */
void book_wait(struct book *book, uint64_t source, uint64_t sequence, uint32_t type);

/* Notes an answer, whether or not the book knew the command. */
const struct book_entry *book_answer(struct book *book, uint64_t source, uint64_t sequence,
                                     uint32_t type, uint32_t result, uint32_t entity,
                                     uint64_t frame);

#endif
