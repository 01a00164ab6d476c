/* Frames whose every value follows from their number. */
#include "tests/support/numbered_frame.h"

#include "world/entity/entity.h"
#include "world/state.h"

#include <stdbool.h>
#include <stdint.h>

static uint64_t value_of(uint64_t frame, uint32_t row)
{
    return frame * 2654435761u + row;
}

void numbered_frame_fill(struct state_head *head, struct entities *entities, uint32_t rows)
{
    uint64_t frame = head->frame;
    head->used = rows;
    head->tick = frame * 3;
    head->event_digest = value_of(frame, rows);
    head->tally.spawns_refused = frame;
    for (uint32_t i = 0; i < rows; i++) {
#define X(type, name) entities->row[i].name = (type)(value_of(frame, i) & 0xffff);
        ENTITY_FIELDS(X)
#undef X
    }
}

bool numbered_frame_head(const struct state_head *head)
{
    uint64_t frame = head->frame;
    return frame == 0 ||
           (head->tick == frame * 3 && head->event_digest == value_of(frame, head->used) &&
            head->tally.spawns_refused == frame);
}

bool numbered_frame_rows(const struct state_head *head, const struct entities *entities)
{
    if (head->frame == 0)
        return true;
    for (uint32_t i = 0; i < head->used; i++) {
#define X(type, name)                                                                              \
    if (entities->row[i].name != (type)(value_of(head->frame, i) & 0xffff))                        \
        return false;
        ENTITY_FIELDS(X)
#undef X
    }
    return true;
}
