/* Merges two lists that are sorted by key. */
#include "collider/response/contact_table.h"

#include "collider/response/response.h"
#include "world/entity/event.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <string.h>

#define GAPS_A_PIECE    4u
#define TOUCHED_A_PIECE 32u

int contact_table_init(struct contact_table *table, const struct world *world)
{
    *table = (struct contact_table){.capacity = world->params->contact_slots};
    table->key = reserve_take(table->capacity, sizeof *table->key);
    table->pair = reserve_take(table->capacity, sizeof *table->pair);
    table->touched = reserve_take(table->capacity, sizeof *table->touched);
    table->gap = reserve_take(table->capacity, sizeof *table->gap);
    if (table->key && table->pair && table->touched && table->gap)
        return 0;
    contact_table_free(table);
    return -1;
}

void contact_table_free(struct contact_table *table)
{
    reserve_free(table->key);
    reserve_free(table->pair);
    reserve_free(table->touched);
    reserve_free(table->gap);
    *table = (struct contact_table){0};
}

/* --- what is known -----------------------------------------------------------------------------*/

static struct persistent_contact contact_of(const struct response_context *context, uint32_t a,
                                            uint32_t b)
{
    const struct entity *row = context->next->entities.row;
    if (b & PAIR_FIXED)
        return (struct persistent_contact){
            .a_row = a, .a_id = row[a].id, .b_row = SLOT_NONE, .b_id = b};
    uint32_t low = row[b].id < row[a].id ? b : a, high = low == a ? b : a;
    return (struct persistent_contact){
        .a_row = low, .a_id = row[low].id, .b_row = high, .b_id = row[high].id};
}

const struct persistent_contact *contact_table_find(const struct response_context *context,
                                                    uint32_t a, uint32_t b)
{
    const struct state *committed = context->motion->committed;
    const struct persistent_contact contact = contact_of(context, a, b);
    uint64_t key = persistent_contact_key(&contact);
    uint32_t low = 0, high = committed->head->contact_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (persistent_contact_key(&committed->contacts[middle]) < key)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < committed->head->contact_count &&
                 persistent_contact_key(&committed->contacts[low]) == key;
    return found ? &committed->contacts[low] : NULL;
}

bool contact_table_lets_through(const struct response_context *context, uint32_t b)
{
    const struct response_functions *functions = context->functions;
    if (b & PAIR_FIXED)
        return narrow_phase_lets_in(context->world, context->input.through_fixed, b & ~PAIR_FIXED);
    return !functions->joint && !functions->moving;
}

/* --- what touched ------------------------------------------------------------------------------*/

/* Returns true in the first frame of each simulated second. */
static bool second_begins(const struct response_context *context)
{
    double dt_s = context->world->params->dt_s;
    uint64_t tick = context->next->head->tick;
    return (uint64_t)((double)tick * dt_s) != (uint64_t)((double)(tick - 1) * dt_s);
}

bool contact_table_begins(struct response_context *context, uint32_t pair)
{
    uint32_t known = context->motion->committed->head->contact_count;
    if (pair == 0)
        return true;
    if (known + context->begun < context->world->params->contact_slots) {
        context->begun++;
        return true;
    }
    context->contacts->marks[pair - 1] |= CONTACT_NO_ROOM;
    context->next->head->tally.contacts_refused++;
    if (context->without_room != 0 || !second_begins(context))
        return false;
    context->without_room = pair;
    return true;
}

/* Returns true if the pair touched and has room, and both sides are still there. */
static bool has_touched(const struct response_context *context, uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    const struct entity *row = context->next->entities.row;
    uint8_t marks = context->contacts->marks[index];
    return marks & CONTACT_PRESSED && !(marks & CONTACT_NO_ROOM) &&
           row[pair->a].state != ENTITY_FREE &&
           (pair->b & PAIR_FIXED || row[pair->b].state != ENTITY_FREE);
}

/* The table's own lists are larger than the world's, if more pairs touch than it has room for. */
static void make_room(struct contact_table *table)
{
    if (table->count < table->capacity)
        return;
    uint32_t more = 2 * table->capacity + 1;
    table->key = reserve_grow(table->key, table->count, more, sizeof *table->key);
    table->pair = reserve_grow(table->pair, table->count, more, sizeof *table->pair);
    table->touched = reserve_grow(table->touched, 0, more, sizeof *table->touched);
    table->capacity = more;
}

static void list_keys(struct contact_table *table, const struct response_context *context)
{
    table->count = 0;
    for (uint32_t i = 0; i < context->contacts->pair_count; i++) {
        const struct pair *pair = &context->contacts->pair[i];
        if (!has_touched(context, i))
            continue;
        const struct persistent_contact contact = contact_of(context, pair->a, pair->b);
        make_room(table);
        table->pair[table->count] = i;
        table->key[table->count++] = (struct contact_key){contact.a_id, contact.b_id};
    }
    sort_words(table->key, table->count);
}

/* Returns the place of a key that is in the list. */
static uint32_t place_of(const struct contact_table *table,
                         const struct persistent_contact *contact)
{
    uint32_t low = 0, high = table->count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        const struct contact_key *key = &table->key[middle];
        if (((uint64_t)key->a_id << 32 | key->b_id) <= persistent_contact_key(contact))
            low = middle;
        else
            high = middle;
    }
    return low;
}

static uint16_t flags_of(uint8_t marks)
{
    return (uint16_t)((marks & CONTACT_OVERLAPS ? PERSISTENT_CONTACT_OVERLAPS : 0u) |
                      (marks & CONTACT_HOLDS ? PERSISTENT_CONTACT_HOLDS : 0u) |
                      (marks & CONTACT_PARTS ? PERSISTENT_CONTACT_PARTS : 0u));
}

/* Returns the contact of a pair that has touched, as if it began in this frame. */
static struct persistent_contact touched_of(const struct response_context *context, uint32_t index)
{
    const struct contact_queue *contacts = context->contacts;
    const struct pair_impacts *impacts = &contacts->impacts[index];
    const struct resting_known *rested = contact_queue_knows_rested(contacts, index);
    struct persistent_contact contact =
        contact_of(context, contacts->pair[index].a, contacts->pair[index].b);
    contact.begin_tick = contact.pressed_tick = (uint32_t)context->next->head->tick;
    contact.flags = flags_of(contacts->marks[index]);
    contact.impacts = (uint16_t)impacts->count;
    contact.impulse_ns = impacts->impulse_ns;
    if (rested) {
        memcpy(contact.nearest, rested->memory.nearest, sizeof contact.nearest);
        memcpy(contact.load, rested->load, sizeof contact.load);
    }
    return contact;
}

struct table_job {
    struct contact_table *table;
    const struct response_context *context;
};

/* Puts the contacts of touching pairs first .. end - 1 into their places. */
static void collect_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct table_job *job = argument;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        struct persistent_contact contact = touched_of(job->context, job->table->pair[i]);
        job->table->touched[place_of(job->table, &contact)] = contact;
    }
}

static void collect(struct contact_table *table, const struct response_context *context)
{
    struct table_job job = {table, context};
    list_keys(table, context);
    thread_pool_run(context->contacts->workers, collect_some, &job, table->count, TOUCHED_A_PIECE);
}

/* --- what did not touch ------------------------------------------------------------------------*/

/* A row whose path nobody has needed yet is as the mover left it. */
static bool moves(const struct response_context *context, uint32_t row)
{
    return body_motion_moves(context->motion, row) || context->motion->change[row] != 0;
}

static bool gone(const struct response_context *context, const struct persistent_contact *contact)
{
    const struct entities *e = &context->next->entities;
    if (!entities_alive(e, contact->a_row, contact->a_id))
        return true;
    return contact->b_id & PERSISTENT_CONTACT_FIXED
               ? !pair_filter_stands(&context->input.detect,
                                     contact->b_id & ~PERSISTENT_CONTACT_FIXED)
               : !entities_alive(e, contact->b_row, contact->b_id);
}

static uint32_t side_b(const struct persistent_contact *contact)
{
    return contact->b_id & PERSISTENT_CONTACT_FIXED ? contact->b_id : contact->b_row;
}

/* Returns true if a row moves, or was moved after the contacts of an earlier frame: a remote entity
 * that is corrected. */
static bool may_part(const struct response_context *context, uint32_t row)
{
    return moves(context, row) || remote_is(&context->next->entities, row);
}

static bool one_may_part(const struct response_context *context,
                         const struct persistent_contact *contact)
{
    bool fixed = contact->b_id & PERSISTENT_CONTACT_FIXED;
    return may_part(context, contact->a_row) || (!fixed && may_part(context, contact->b_row));
}

/* Returns true if the bodies have not touched for so long that their contact ends. */
static bool is_old(const struct response_context *context, const struct persistent_contact *contact)
{
    uint32_t age = (uint32_t)context->next->head->tick - contact->pressed_tick;
    return (double)age * context->world->params->dt_s > CONTACT_TABLE_LASTS_S;
}

static double reach_of(const struct response_context *context, uint32_t side)
{
    return side & PAIR_FIXED
               ? pair_filter_fixed_reach(context->world, &context->world->fixed[side & ~PAIR_FIXED])
               : pair_filter_row_reach(&context->input.detect, side);
}

/* Returns true if the bounds of a gap show the same as the gap: whether the bodies touch, and
 * whether they are so far apart that their contact may end. */
static bool suffice(const struct gap_bounds *gap)
{
    return gap->least_m > CONTACT_TABLE_PARTED_M ||
           (gap->least_m > CONTACT_TOUCHING_M && gap->most_m <= CONTACT_TABLE_PARTED_M);
}

/* Returns the gap of two models, or a bound of it that shows the same. */
static double gap_of_models(const struct response_context *context,
                            const struct persistent_contact *contact, const struct swept_body *a,
                            const struct swept_body *b)
{
    struct gap_memory *gaps = &context->contacts->gaps;
    const struct pair pair = {contact->a_row, side_b(contact)};
    const struct gap_bounds known = gap_memory_recall(gaps, &pair, a, b);
    if (suffice(&known))
        return known.least_m;
    double gap_m = time_of_impact_gap_up_to(a, b, 0.0, CONTACT_TABLE_PARTED_M);
    gap_memory_note(gaps, &pair, a, b, gap_m, CONTACT_TABLE_PARTED_M);
    return gap_m;
}

/* Returns how far the bodies are apart at the end of the frame, below 0 if they overlap [m]. Beyond
 * the gap at which a contact ends it says only that. */
static double gap_at_end(const struct response_context *context,
                         const struct persistent_contact *contact)
{
    const struct body_motion *motion = context->motion;
    const struct entities *e = &context->next->entities;
    uint32_t a = contact->a_row, b = side_b(contact);
    struct swept_body body_a = body_motion_standing(motion, e, a);
    struct swept_body body_b = body_motion_standing(motion, e, b);
    struct vec3 between = vec3_sub(body_b.path.at, body_a.path.at);
    return motion->models ? gap_of_models(context, contact, &body_a, &body_b)
                          : vec3_length(between) - reach_of(context, a) - reach_of(context, b);
}

/* --- gaps --------------------------------------------------------------------------------------*/

/* Lists the known contacts that bear no load in this frame, and of which the gap says whether they
 * go on. Bodies that lie still beside each other are not looked at. */
static void list_gaps(struct contact_table *table, const struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    uint32_t at = 0;
    table->gaps = 0;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *known = &committed->contacts[i];
        uint64_t key = persistent_contact_key(known);
        while (at < table->count && persistent_contact_key(&table->touched[at]) < key)
            at++;
        bool bears = at < table->count && persistent_contact_key(&table->touched[at]) == key;
        if (!bears &&
            (is_old(context, known) || contact_table_lets_through(context, side_b(known))) &&
            !gone(context, known) && one_may_part(context, known))
            table->gap[table->gaps++].contact = i;
    }
}

static void measure_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct table_job *job = argument;
    const struct state *committed = job->context->motion->committed;
    for (uint32_t i = first; i < end; i++) {
        struct contact_gap *gap = &job->table->gap[i];
        gap->gap_m = gap_at_end(job->context, &committed->contacts[gap->contact]);
    }
    work_done_by(worker);
}

static void measure_gaps(struct contact_table *table, const struct response_context *context)
{
    struct table_job job = {table, context};
    list_gaps(table, context);
    thread_pool_run(context->contacts->workers, measure_some, &job, table->gaps, GAPS_A_PIECE);
}

/* --- ends --------------------------------------------------------------------------------------*/

/* A body that is gone is as it was in the committed frame. */
static struct event_party party_of(const struct response_context *context, uint32_t row,
                                   uint32_t id)
{
    const struct entities *e = &context->next->entities;
    if (!(id & PERSISTENT_CONTACT_FIXED) && !entities_alive(e, row, id))
        e = &context->motion->committed->entities;
    if (!(id & PERSISTENT_CONTACT_FIXED))
        return (struct event_party){id, e->row[row].kind, 0, e->row[row].damage};
    uint32_t object = id & ~PERSISTENT_CONTACT_FIXED;
    return (struct event_party){object + 1, context->world->fixed[object].kind, 1,
                                (uint8_t)fallen_damage(context->next->fixed_damage[object])};
}

static void end(struct response_context *context, const struct persistent_contact *contact,
                enum contact_end_reason because)
{
    struct event *event = event_writer_event(&context->events, EVENT_CONTACT_END);
    uint32_t ticks = contact->pressed_tick - contact->begin_tick;
    if (!event)
        return;
    event->contact_end =
        (struct event_contact_end){.a = party_of(context, contact->a_row, contact->a_id),
                                   .b = party_of(context, contact->b_row, contact->b_id),
                                   .lasted_s = (double)ticks * context->world->params->dt_s,
                                   .impacts = contact->impacts,
                                   .impulse_ns = contact->impulse_ns,
                                   .because = because};
}

/* --- the next table ----------------------------------------------------------------------------*/

static void put(struct response_context *context, const struct persistent_contact *contact)
{
    struct state *next = context->next;
    next->contacts[next->head->contact_count++] = *contact;
}

/* Puts a known contact that touched: it goes on. */
static void renew(struct response_context *context, const struct persistent_contact *known,
                  const struct persistent_contact *touched)
{
    struct persistent_contact contact = *touched;
    uint32_t impacts = (uint32_t)known->impacts + touched->impacts;
    contact.begin_tick = known->begin_tick;
    contact.impacts = impacts < PERSISTENT_CONTACT_IMPACTS_MAX ? (uint16_t)impacts
                                                               : PERSISTENT_CONTACT_IMPACTS_MAX;
    contact.impulse_ns += known->impulse_ns;
    put(context, &contact);
}

/* Puts a known contact without an impact or a load in this frame, or ends it. gap: of its bodies,
 * or NULL if it says nothing about the contact. Bodies that overlapped in the last frame have been
 * looked at in this one, and do no longer: their group may sleep. Where a body moves, none holds
 * the other. */
static void keep(struct response_context *context, const struct persistent_contact *known,
                 const struct contact_gap *gap)
{
    struct persistent_contact contact = *known;
    contact.flags &= (uint16_t) ~(PERSISTENT_CONTACT_OVERLAPS | PERSISTENT_CONTACT_PARTS);
    if (one_may_part(context, known))
        contact.flags &= (uint16_t)~PERSISTENT_CONTACT_HOLDS;
    memset(contact.load, 0, sizeof contact.load);
    if (gone(context, known)) {
        end(context, known, CONTACT_END_GONE);
        return;
    }
    if (gap && gap->gap_m <= CONTACT_TOUCHING_M)
        contact.pressed_tick = (uint32_t)context->next->head->tick;
    work_done();
    if (gap && is_old(context, &contact) && gap->gap_m > CONTACT_TABLE_PARTED_M)
        end(context, known, CONTACT_END_PARTED);
    else
        put(context, &contact);
}

/* Ends the contact without room whose beginning was told. */
static void end_without_room(struct response_context *context)
{
    if (context->without_room == 0)
        return;
    uint32_t index = context->without_room - 1;
    const struct pair *pair = &context->contacts->pair[index];
    const struct pair_impacts *impacts = &context->contacts->impacts[index];
    struct persistent_contact contact = contact_of(context, pair->a, pair->b);
    contact.impacts = (uint16_t)impacts->count;
    contact.impulse_ns = impacts->impulse_ns;
    end(context, &contact, CONTACT_END_NO_ROOM);
}

void contact_table_finish(struct contact_table *table, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    uint32_t old = 0, new = 0, gap = 0, count = committed->head->contact_count;
    collect(table, context);
    measure_gaps(table, context);
    context->next->head->contact_count = 0;
    while (old < count || new < table->count) {
        const struct persistent_contact *known = &committed->contacts[old];
        const struct persistent_contact *touched = &table->touched[new];
        uint64_t known_key = old < count ? persistent_contact_key(known) : UINT64_MAX;
        uint64_t key = new < table->count ? persistent_contact_key(touched) : UINT64_MAX;
        if (key == known_key)
            renew(context, known, touched);
        else if (key < known_key)
            put(context, touched);
        else
            keep(context, known,
                 gap < table->gaps && table->gap[gap].contact == old ? &table->gap[gap++] : NULL);
        new += key <= known_key;
        old += known_key <= key;
    }
    end_without_room(context);
}
