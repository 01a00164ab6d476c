/* The history of commands: a ring of entries in hash chains. */
#include "reporter/intake/command_history.h"

#include <stddef.h>
#include <string.h>

/* Clients choose their keys. The seed is random, so that no client can choose keys of one chain. */
static uint32_t *chain_of(struct command_history *history, uint64_t source, uint64_t sequence)
{
    uint64_t hash = (source ^ history->seed) * 0x9e3779b97f4a7c15u; /* Fibonacci hashing */
    hash = ((hash ^ hash >> 32) + sequence) * 0x9e3779b97f4a7c15u;
    return &history->chain[(uint32_t)(hash >> 40) & (HISTORY_CHAINS - 1)];
}

struct history_entry *command_history_find(struct command_history *history, uint64_t source,
                                           uint64_t sequence)
{
    uint32_t link = *chain_of(history, source, sequence);
    while (link) {
        struct history_entry *entry = &history->entry[link - 1];
        if (entry->source == source && entry->sequence == sequence)
            return entry;
        link = entry->next;
    }
    return NULL;
}

static void forget(struct command_history *history, uint32_t place)
{
    const struct history_entry *entry = &history->entry[place];
    if (!entry->source)
        return;
    uint32_t *link = chain_of(history, entry->source, entry->sequence);
    while (*link != place + 1)
        link = &history->entry[*link - 1].next;
    *link = entry->next;
    if (!entry->answered)
        history->waiting--;
}

static struct history_entry *add(struct command_history *history, uint64_t source,
                                 uint64_t sequence, uint32_t type)
{
    uint32_t place = history->oldest;
    uint32_t *chain = chain_of(history, source, sequence);
    forget(history, place);
    struct history_entry *entry = &history->entry[place];
    *entry = (struct history_entry){
        .source = source, .sequence = sequence, .type = type, .next = *chain};
    *chain = place + 1;
    history->oldest = (place + 1) % HISTORY_ENTRIES;
    history->waiting++;
    return entry;
}

void command_history_clear(struct command_history *history, uint64_t seed)
{
    memset(history, 0, sizeof *history);
    history->seed = seed;
}

void command_history_wait(struct command_history *history, uint64_t source, uint64_t sequence,
                          uint32_t type, uint64_t client)
{
    if (!command_history_find(history, source, sequence))
        add(history, source, sequence, type)->client = client;
}

struct history_entry *command_history_answer(struct command_history *history, uint64_t source,
                                             uint64_t sequence, uint32_t type, uint32_t result,
                                             uint32_t entity, uint64_t frame)
{
    struct history_entry *entry = command_history_find(history, source, sequence);
    if (!entry)
        entry = add(history, source, sequence, type);
    if (!entry->answered)
        history->waiting--;
    entry->answered = true;
    entry->type = type;
    entry->result = result;
    entry->entity = entity;
    entry->frame = frame;
    return entry;
}
