/* Finding, making and evicting rows. */
#include "renderer/output/picture_requests.h"

#include <stddef.h>

static bool is_same(const struct picture_requests_key *a, const struct picture_requests_key *b)
{
    return a->view == b->view && a->vehicle == b->vehicle && a->width == b->width &&
           a->height == b->height && a->bar == b->bar;
}

bool picture_requests_lives(const struct picture_requests *row, uint64_t now_ns)
{
    return row->generation != 0 &&
           (row->unanswered > 0 || now_ns < row->requested_ns + PICTURE_REQUESTS_KEEP_NS);
}

/* Returns true if a is evicted before b. */
static bool goes_before(const struct picture_requests *a, const struct picture_requests *b,
                        uint64_t now_ns)
{
    bool a_lives = picture_requests_lives(a, now_ns), b_lives = picture_requests_lives(b, now_ns);
    return a_lives != b_lives ? b_lives : a_lives && a->requested_ns < b->requested_ns;
}

uint32_t picture_requests_ask(struct picture_requests_table *table,
                              const struct picture_requests_key *key, uint64_t now_ns)
{
    struct picture_requests *found = NULL;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        struct picture_requests *row = &table->row[i];
        bool lives = picture_requests_lives(row, now_ns);
        if (lives && is_same(&row->key, key)) {
            row->requested_ns = now_ns;
            row->watched = true;
            return i;
        }
        bool stays = lives && (row->unanswered > 0 || row->watched);
        if (!stays && (found == NULL || goes_before(row, found, now_ns)))
            found = row;
    }
    if (found == NULL)
        return PICTURE_REQUESTS_NONE;
    *found = (struct picture_requests){
        .key = *key, .generation = ++table->generations, .requested_ns = now_ns};
    return (uint32_t)(found - table->row);
}

void picture_requests_forget(struct picture_requests *row)
{
    if (row->unanswered == 0)
        row->generation = 0;
}
