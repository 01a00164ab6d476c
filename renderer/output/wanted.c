/* Rows found, made and given up. */
#include "renderer/output/wanted.h"

static bool is_same(const struct wanted_key *a, const struct wanted_key *b)
{
    return a->view == b->view && a->vehicle == b->vehicle && a->width == b->width &&
           a->height == b->height && a->bar == b->bar;
}

bool wanted_lives(const struct wanted *row, uint64_t now_ns)
{
    return row->generation != 0 && (row->holders > 0 || now_ns < row->asked_ns + WANTED_KEEP_NS);
}

uint32_t wanted_ask(struct wanted_table *table, const struct wanted_key *key, uint64_t now_ns)
{
    uint32_t found = WANTED_NONE;
    for (uint32_t i = 0; i < WANTED_MAX; i++) {
        const struct wanted *row = &table->row[i];
        bool lives = wanted_lives(row, now_ns);
        if (lives && is_same(&row->key, key)) {
            table->row[i].asked_ns = now_ns;
            return i;
        }
        if (!lives && found == WANTED_NONE)
            found = i;
    }
    if (found != WANTED_NONE)
        table->row[found] =
            (struct wanted){.key = *key, .generation = ++table->generations, .asked_ns = now_ns};
    return found;
}

void wanted_forget(struct wanted *row)
{
    if (row->holders == 0)
        row->generation = 0;
}
