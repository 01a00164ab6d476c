/* Rows for new entities, and the frame's list of intents. */
#include "mover/context/serial_context.h"

#include "world/terrain/gridsquare.h"

#include <string.h>

static uint32_t free_row(struct serial_context *serial)
{
    struct state_head *head = serial->moved->head;
    const struct entities *m = &serial->moved->entities;
    if (head->vehicles + head->munitions >= m->capacity)
        return SLOT_NONE;
    for (uint32_t n = 0; n < m->capacity; n++) {
        uint32_t row = (head->alloc_next + n) % m->capacity;
        if (row < head->used && m->state[row] != ENTITY_FREE)
            continue;
        if (row > head->used) /* rows are first used in their order */
            row = head->used;
        return row;
    }
    return SLOT_NONE;
}

uint32_t spawn_entity(struct serial_context *serial, uint16_t kind_index, uint8_t force)
{
    struct state_head *head = serial->moved->head;
    struct entities *m = &serial->moved->entities;
    const struct kind *kind = &serial->move->world->kinds[kind_index];
    uint32_t row = free_row(serial);
    if (row == SLOT_NONE) {
        head->tally.spawns_refused++;
        return SLOT_NONE;
    }
    serial_context_changes(serial, row, COLUMNS_ALL);
    head->used = row < head->used ? head->used : row + 1;
    head->alloc_next = (row + 1) % m->capacity;
    entities_clear(m, row);
    m->id[row] = head->next_id++;
    m->kind[row] = kind_index;
    m->state[row] = ENTITY_ACTIVE;
    m->force[row] = force;
    m->born_tick[row] = (uint32_t)serial->move->tick;
    m->fuel_l[row] = kind->fuel_l;
    m->rounds[row] = kind->rounds;
    if (kind->domain == DOMAIN_MUNITION) {
        head->munitions++;
        m->behaviour[row] = m->order[row] = BEHAVIOUR_FLIGHT;
        m->until_tick[row] =
            (uint32_t)(serial->move->tick + (uint64_t)(kind->life_s / serial->move->dt_s));
    } else {
        head->vehicles++;
    }
    return row;
}

void spawn_remove(struct serial_context *serial, uint32_t row)
{
    struct state_head *head = serial->moved->head;
    const struct entities *m = &serial->moved->entities;
    if (serial->move->world->kinds[m->kind[row]].domain == DOMAIN_MUNITION)
        head->munitions--;
    else
        head->vehicles--;
    serial_context_changes(serial, row, COLUMNS_ALL);
    entities_clear(m, row);
}

struct event *serial_context_intent(struct serial_context *serial, enum event_type type)
{
    struct state_head *head = serial->moved->head;
    if (head->intent_count >= serial->move->world->params->intents_per_frame) {
        head->tally.events_dropped++;
        return NULL;
    }
    struct event *intent = &serial->moved->intents[head->intent_count++];
    memset(intent, 0, sizeof *intent); /* every byte: the digest sees them all */
    intent->type = type;
    return intent;
}

struct event_party serial_context_party(const struct serial_context *serial, uint32_t row)
{
    const struct entities *m = &serial->moved->entities;
    return (struct event_party){
        .id = m->id[row], .kind = m->kind[row], .fixed = 0, .damage = m->damage[row]};
}
