/* Drops many bombs at once. */
#include "tests/bench/burst.h"

#include "ipc/process/log.h"
#include "world/checksum.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

/* Places on the map, row by row of a square of them. */
static struct vec3 place_of(uint32_t n, uint32_t bombs)
{
    uint32_t side = 1;
    while (side * side < bombs)
        side++;
    double gap_m = WORLD_SIDE_DEFAULT_M / (double)(side + 1);
    return (struct vec3){gap_m * (double)(n % side + 1), BURST_HEIGHT_M,
                         gap_m * (double)(n / side + 1)};
}

void burst_drop(struct view *view, uint32_t bombs)
{
    struct state *now = &view->w[segment_load(&view->commit->commit) & 1];
    struct state_head *head = now->head;
    const struct entities *e = &now->entities;
    uint16_t kind = kind_find(view->world.kinds, view->world.counts.kinds, "bomb");
    uint32_t second = (uint32_t)(1.0 / world_dt_s(&view->world));
    if (kind == KIND_NONE || bombs > e->capacity - head->used)
        die_refused("the world has no room for %u bombs", bombs);
    for (uint32_t n = 0; n < bombs; n++) {
        uint32_t row = head->used++;
        entities_clear(e, row);
        e->row[row].id = head->next_id++;
        e->row[row].kind = kind;
        e->row[row].state = ENTITY_ACTIVE;
        e->row[row].behaviour = e->row[row].order = BEHAVIOUR_FLIGHT;
        e->row[row].born_tick = (uint32_t)head->tick;
        e->row[row].until_tick = (uint32_t)head->tick + second + n % second;
        entities_set_position(e, row, place_of(n, bombs));
    }
    head->munitions += bombs;
    head->alloc_next = head->used % e->capacity;
    state_seal(now, view->world.counts.fixed);
}
