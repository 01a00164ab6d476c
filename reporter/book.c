/* The book of commands: a ring of entries, found by chains of their keys' hashes. */
#include "reporter/book.h"

#include <stddef.h>
#include <string.h>

static uint32_t chain_of(uint64_t source, uint64_t sequence)
{
    /* Fibonacci hashing: sources are random, sequences count up from 1. */
    uint64_t hash = (source ^ (sequence * 0x9e3779b97f4a7c15u)) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(hash >> 40) & (BOOK_CHAINS - 1);
}

static struct book_entry *find(struct book *book, uint64_t source, uint64_t sequence)
{
    uint32_t link = book->chain[chain_of(source, sequence)];
    while (link) {
        struct book_entry *entry = &book->entry[link - 1];
        if (entry->source == source && entry->sequence == sequence)
            return entry;
        link = entry->next;
    }
    return NULL;
}

static void forget(struct book *book, uint32_t place)
{
    const struct book_entry *entry = &book->entry[place];
    if (!entry->source)
        return;
    uint32_t *link = &book->chain[chain_of(entry->source, entry->sequence)];
    while (*link != place + 1)
        link = &book->entry[*link - 1].next;
    *link = entry->next;
    if (!entry->answered)
        book->waiting--;
}

static struct book_entry *add(struct book *book, uint64_t source, uint64_t sequence, uint32_t type)
{
    uint32_t place = book->oldest;
    uint32_t *chain = &book->chain[chain_of(source, sequence)];
    forget(book, place);
    struct book_entry *entry = &book->entry[place];
    *entry =
        (struct book_entry){.source = source, .sequence = sequence, .type = type, .next = *chain};
    *chain = place + 1;
    book->oldest = (place + 1) % BOOK_ENTRIES;
    book->waiting++;
    return entry;
}

void book_clear(struct book *book)
{
    memset(book, 0, sizeof *book);
}

const struct book_entry *book_find(struct book *book, uint64_t source, uint64_t sequence)
{
    return find(book, source, sequence);
}

void book_wait(struct book *book, uint64_t source, uint64_t sequence, uint32_t type)
{
    if (!find(book, source, sequence))
        (void)add(book, source, sequence, type);
}

const struct book_entry *book_answer(struct book *book, uint64_t source, uint64_t sequence,
                                     uint32_t type, uint32_t result, uint32_t entity,
                                     uint64_t frame)
{
    struct book_entry *entry = find(book, source, sequence);
    if (!entry)
        entry = add(book, source, sequence, type);
    if (!entry->answered)
        book->waiting--;
    entry->answered = true;
    entry->type = type;
    entry->result = result;
    entry->entity = entity;
    entry->frame = frame;
    return entry;
}
