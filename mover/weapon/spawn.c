/* Rows for new entities. */
#include "mover/weapon/spawn.h"

#include "world/entity/event.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define SPARE_ROWS  128u
#define SPARE_SHARE 16u /* one spare row for so many entities */
#define ROOF_STEP   64u /* each change of the rows in use hashes a whole block anew */

uint32_t spawn_roof(const struct state_head *head, uint32_t capacity)
{
    uint32_t live = head->vehicles + head->munitions;
    uint32_t roof = live + SPARE_ROWS + live / SPARE_SHARE;
    roof = (roof + ROOF_STEP - 1) / ROOF_STEP * ROOF_STEP;
    return roof < capacity ? roof : capacity;
}

/* Searches the rows below the roof, one after the other and then again from the first, so that a
 * row stays free for a while. */
static uint32_t free_row(struct serial_context *context)
{
    struct state_head *head = context->moved->head;
    const struct entities *m = &context->moved->entities;
    uint32_t roof = spawn_roof(head, m->capacity);
    uint32_t row = head->alloc_next < roof ? head->alloc_next : 0;
    for (uint32_t n = 0; n < roof; n++, row = row + 1 < roof ? row + 1 : 0) {
        if (row >= head->used) /* rows are used for the first time in their order */
            return head->used;
        if (m->row[row].state == ENTITY_FREE)
            return row;
    }
    return SLOT_NONE;
}

void spawn_fall_back(struct serial_context *context)
{
    struct state_head *head = context->moved->head;
    const struct entities *m = &context->moved->entities;
    uint32_t roof = spawn_roof(head, m->capacity), used = head->used;
    while (used > roof && m->row[used - 1].state == ENTITY_FREE)
        used--;
    head->used = used;
}

uint32_t spawn_entity(struct serial_context *context, uint16_t kind_index, uint8_t force)
{
    struct state_head *head = context->moved->head;
    struct entities *m = &context->moved->entities;
    const struct kind *kind = &context->step->world->kinds[kind_index];
    uint32_t row = free_row(context);
    if (row == SLOT_NONE) {
        head->tally.spawns_refused++;
        return SLOT_NONE;
    }
    head->used = row < head->used ? head->used : row + 1;
    head->alloc_next = (row + 1) % m->capacity;
    table_clear_row(&context->writer, row);
    m->row[row].id = head->next_id++;
    m->row[row].kind = kind_index;
    m->row[row].state = ENTITY_ACTIVE;
    m->row[row].force = force;
    m->row[row].born_tick = (uint32_t)context->step->tick;
    m->row[row].fuel_l = kind->fuel_l;
    m->row[row].rounds = kind->rounds;
    if (kind->domain == DOMAIN_MUNITION) {
        head->munitions++;
        m->row[row].behaviour = m->row[row].order = BEHAVIOUR_FLIGHT;
        m->row[row].until_tick =
            (uint32_t)(context->step->tick + (uint64_t)(kind->life_s / context->step->dt_s));
    } else {
        head->vehicles++;
    }
    return row;
}

void spawn_remove(struct serial_context *context, uint32_t row)
{
    struct state_head *head = context->moved->head;
    const struct entities *m = &context->moved->entities;
    if (context->step->world->kinds[m->row[row].kind].domain == DOMAIN_MUNITION)
        head->munitions--;
    else
        head->vehicles--;
    table_clear_row(&context->writer, row);
}
