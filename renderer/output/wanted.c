/* Rows found, made and given up. */
#include "renderer/output/wanted.h"

#include <stddef.h>

static bool is_same(const struct wanted_key *a, const struct wanted_key *b)
{
    return a->view == b->view && a->vehicle == b->vehicle && a->width == b->width &&
           a->height == b->height && a->bar == b->bar;
}

bool wanted_lives(const struct wanted *row, uint64_t now_ns)
{
    return row->generation != 0 && (row->holders > 0 || now_ns < row->asked_ns + WANTED_KEEP_NS);
}

/* Is a better to give up than b? */
static bool goes_before(const struct wanted *a, const struct wanted *b, uint64_t now_ns)
{
    bool a_lives = wanted_lives(a, now_ns), b_lives = wanted_lives(b, now_ns);
    return a_lives != b_lives ? b_lives : a_lives && a->asked_ns < b->asked_ns;
}

uint32_t wanted_ask(struct wanted_table *table, const struct wanted_key *key, uint64_t now_ns)
{
    struct wanted *found = NULL;
    for (uint32_t i = 0; i < WANTED_MAX; i++) {
        struct wanted *row = &table->row[i];
        bool lives = wanted_lives(row, now_ns);
        if (lives && is_same(&row->key, key)) {
            row->asked_ns = now_ns;
            row->watched = true;
            return i;
        }
        bool stays = lives && (row->holders > 0 || row->watched);
        if (!stays && (found == NULL || goes_before(row, found, now_ns)))
            found = row;
    }
    if (found == NULL)
        return WANTED_NONE;
    *found = (struct wanted){.key = *key, .generation = ++table->generations, .asked_ns = now_ns};
    return (uint32_t)(found - table->row);
}

void wanted_forget(struct wanted *row)
{
    if (row->holders == 0)
        row->generation = 0;
}
