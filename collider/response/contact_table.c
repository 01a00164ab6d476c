/* Merges two lists that are sorted by key. */
#include "collider/response/contact_table.h"

#include "collider/response/response.h"
#include "world/entity/event.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

int contact_table_init(struct contact_table *table, const struct world *world)
{
    *table = (struct contact_table){.capacity = world->params->contact_slots};
    table->touched = reserve_take(table->capacity, sizeof *table->touched);
    return table->touched ? 0 : -1;
}

void contact_table_free(struct contact_table *table)
{
    reserve_free(table->touched);
    *table = (struct contact_table){0};
}

static struct persistent_contact contact_of(const struct response_context *context,
                                            const struct pair *pair, uint8_t marks)
{
    const struct entities *e = &context->next->entities;
    uint32_t tick = (uint32_t)context->next->head->tick, id = e->id[pair->a];
    struct persistent_contact contact = {.a_row = pair->a,
                                         .a_id = id,
                                         .b_row = SLOT_NONE,
                                         .b_id = pair->b,
                                         .begin_tick = tick,
                                         .pressed_tick = tick};
    contact.flags = marks & CONTACT_OVERLAPS ? PERSISTENT_CONTACT_OVERLAPS : 0;
    if (pair->b & PAIR_FIXED)
        return contact;
    bool swap = e->id[pair->b] < id;
    contact.a_row = swap ? pair->b : pair->a;
    contact.b_row = swap ? pair->a : pair->b;
    contact.a_id = e->id[contact.a_row];
    contact.b_id = e->id[contact.b_row];
    return contact;
}

/* --- what is known -----------------------------------------------------------------------------*/

bool contact_table_knows(const struct response_context *context, uint32_t a, uint32_t b,
                         uint32_t pair)
{
    const struct state *committed = context->motion->committed;
    const struct persistent_contact contact = contact_of(context, &(struct pair){a, b}, 0);
    uint64_t key = persistent_contact_key(&contact);
    uint32_t low = 0, high = committed->head->contact_count;
    if (pair != 0 && context->contacts->marks[pair - 1] & CONTACT_PRESSED)
        return true;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (persistent_contact_key(&committed->contacts[middle]) < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < committed->head->contact_count &&
           persistent_contact_key(&committed->contacts[low]) == key;
}

/* --- the next table ----------------------------------------------------------------------------*/

/* Moves the contact at the place down the heap, whose root has the greatest key. */
static void sift_down(struct persistent_contact *heap, uint32_t count, uint32_t place)
{
    struct persistent_contact contact = heap[place];
    uint64_t key = persistent_contact_key(&contact);
    for (uint32_t child = 2 * place + 1; child < count; child = 2 * place + 1) {
        if (child + 1 < count &&
            persistent_contact_key(&heap[child + 1]) > persistent_contact_key(&heap[child]))
            child++;
        if (persistent_contact_key(&heap[child]) <= key)
            break;
        heap[place] = heap[child];
        place = child;
    }
    heap[place] = contact;
}

static void sort(struct persistent_contact *contact, uint32_t count)
{
    for (uint32_t i = count / 2; i > 0; i--)
        sift_down(contact, count, i - 1);
    for (uint32_t last = count; last > 1; last--) {
        struct persistent_contact greatest = contact[0];
        contact[0] = contact[last - 1];
        contact[last - 1] = greatest;
        sift_down(contact, last - 1, 0);
    }
}

static void collect(struct contact_table *table, struct response_context *context)
{
    const struct contact_queue *contacts = context->contacts;
    const uint8_t *state = context->next->entities.state;
    table->count = 0;
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        const struct pair *pair = &contacts->pair[i];
        if (!(contacts->marks[i] & CONTACT_PRESSED) || state[pair->a] == ENTITY_FREE ||
            (!(pair->b & PAIR_FIXED) && state[pair->b] == ENTITY_FREE))
            continue;
        if (table->count == table->capacity)
            context->next->head->tally.contacts_refused++;
        else
            table->touched[table->count++] = contact_of(context, pair, contacts->marks[i]);
    }
    sort(table->touched, table->count);
}

/* A row whose path nobody has needed yet is as the mover left it. */
static bool moves(const struct response_context *context, uint32_t row)
{
    body_motion_require(context->motion, row);
    return context->motion->change[row] != 0 || !pair_filter_rests(&context->path[row]);
}

/* Returns true if the bodies of a contact that did not touch in this frame have parted. Those that
 * lie still beside each other are not looked at and stay in contact. */
static bool parted(const struct response_context *context, const struct persistent_contact *contact)
{
    const struct entities *e = &context->next->entities;
    bool fixed = contact->b_id & PERSISTENT_CONTACT_FIXED;
    uint32_t age = (uint32_t)context->next->head->tick - contact->pressed_tick;
    if (!entities_alive(e, contact->a_row, contact->a_id) ||
        (!fixed && !entities_alive(e, contact->b_row, contact->b_id)) ||
        (fixed &&
         !pair_filter_stands(&context->input.detect, contact->b_id & ~PERSISTENT_CONTACT_FIXED)))
        return true;
    return (double)age * context->world->params->dt_s > CONTACT_TABLE_LASTS_S &&
           (moves(context, contact->a_row) || (!fixed && moves(context, contact->b_row)));
}

/* The bodies were there in the committed frame, perhaps not any more. */
static struct event_party party_of(const struct response_context *context, uint32_t row,
                                   uint32_t id)
{
    const struct entities *w = &context->motion->committed->entities;
    if (!(id & PERSISTENT_CONTACT_FIXED))
        return (struct event_party){id, w->kind[row], 0, w->damage[row]};
    uint32_t object = id & ~PERSISTENT_CONTACT_FIXED;
    return (struct event_party){object + 1, context->world->fixed[object].kind, 1,
                                context->next->fixed_damage[object]};
}

static void end(struct response_context *context, const struct persistent_contact *contact)
{
    struct event *event = event_writer_event(&context->events, EVENT_CONTACT_END);
    uint32_t ticks = contact->pressed_tick - contact->begin_tick;
    if (!event)
        return;
    event->contact_end =
        (struct event_contact_end){.a = party_of(context, contact->a_row, contact->a_id),
                                   .b = party_of(context, contact->b_row, contact->b_id),
                                   .lasted_s = (double)ticks * context->world->params->dt_s};
}

static void put(struct response_context *context, const struct persistent_contact *contact)
{
    struct state *next = context->next;
    if (next->head->contact_count == context->world->params->contact_slots)
        next->head->tally.contacts_refused++;
    else
        next->contacts[next->head->contact_count++] = *contact;
}

void contact_table_finish(struct contact_table *table, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    uint32_t old = 0, new = 0;
    collect(table, context);
    context->next->head->contact_count = 0;
    while (old < committed->head->contact_count || new < table->count) {
        const struct persistent_contact *known = &committed->contacts[old];
        struct persistent_contact *touched = &table->touched[new];
        uint64_t known_key =
            old < committed->head->contact_count ? persistent_contact_key(known) : UINT64_MAX;
        uint64_t key = new < table->count ? persistent_contact_key(touched) : UINT64_MAX;
        if (key == known_key)
            touched->begin_tick = known->begin_tick;
        if (key <= known_key)
            put(context, touched);
        else if (parted(context, known))
            end(context, known);
        else
            put(context, known);
        new += key <= known_key;
        old += known_key <= key;
    }
}
