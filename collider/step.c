/* The collider's step, from top to bottom. */
#include "collider/step.h"

#include "collider/respond.h"

#include <stdlib.h>
#include <string.h>

#define ROWS_A_PIECE 4096

int collider_init(struct collider *collider, const struct world *world,
                  const struct crater *craters, struct workers *workers)
{
    uint32_t capacity = world->params->capacity;
    *collider =
        (struct collider){.world = world, .workers = workers, .fixed_hash_frame = UINT64_MAX};
    if (crater_index_init(&collider->craters, craters) != 0 ||
        motion_init(&collider->motion, world) != 0 ||
        broad_init(&collider->broad, world, workers) != 0 ||
        contacts_init(&collider->contacts, capacity, workers) != 0 ||
        island_init(&collider->island, capacity) != 0) {
        collider_free(collider);
        return -1;
    }
    return 0;
}

void collider_free(struct collider *collider)
{
    crater_index_free(&collider->craters);
    motion_free(&collider->motion);
    broad_free(&collider->broad);
    contacts_free(&collider->contacts);
    island_free(&collider->island);
    detect_workspace_free(collider->workspace);
    free(collider->pairs.pair);
    *collider = (struct collider){0};
}

struct stage {
    struct collider *collider;
    const struct moved *moved;
    struct state *next;
};

/* Copies the moved rows and draws their ways. */
static void take_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct stage *stage = context;
    (void)worker;
    entities_copy(&stage->next->entities, &stage->moved->entities, first, end - first);
    for (uint32_t i = first; i < end; i++)
        motion_take(&stage->collider->motion, i);
}

static void put_intents(struct sink *sink, const struct moved *moved)
{
    for (uint32_t i = 0; i < moved->head->intent_count; i++) {
        const struct event *intent = &moved->intents[i];
        struct event *event = sink_event(sink, (enum event_type)intent->type);
        if (event)
            memcpy(event->bytes, intent->bytes, sizeof event->bytes);
    }
}

/* Rounds and aircraft that reach the ground; rounds whose life ends with the frame, unless
 * something earlier ends it. */
static int find_ends(struct collider *collider, const struct respond *respond)
{
    const struct state *next = respond->next;
    const struct entities *e = &next->entities;
    for (uint32_t i = 0; i < next->head->used; i++) {
        if (contacts_ground(&collider->contacts, &respond->input, i) != 0)
            return -1;
        if (e->state[i] == ENTITY_ACTIVE && e->behaviour[i] == BEHAVIOUR_FLIGHT &&
            next->head->tick >= e->until_tick[i] &&
            contacts_add_end(&collider->contacts, i, CONTACT_AIR, 1.0) != 0)
            return -1;
    }
    return 0;
}

/* The frame's pairs by the method chosen. The broad phase runs with every method: blasts and
 * changed ways look up what is near in it. */
static int find_pairs(struct collider *collider, const struct detect_input *input)
{
    detect_method *method =
        detect_method_of((enum method)collider->world->params->collision.method);
    if (broad_pairs(&collider->broad, input) != 0)
        return -1;
    if (!method)
        return contacts_begin(&collider->contacts, collider->broad.list, WORKERS_MAX);
    collider->pairs.count = 0;
    if (method(input, &collider->workspace, &collider->pairs) != 0)
        return -1;
    return contacts_begin(&collider->contacts, &collider->pairs, 1);
}

static int collide_all(struct collider *collider, struct respond *respond)
{
    struct contact contact;
    if (find_pairs(collider, &respond->input.detect) != 0 ||
        contacts_find(&collider->contacts, &respond->input) != 0 ||
        find_ends(collider, respond) != 0)
        return -1;
    while (contacts_next(&collider->contacts, &respond->input, &contact)) {
        if (respond_contact(respond, &contact) != 0)
            return -1;
    }
    return 0;
}

static void begin_head(struct state_head *head, const struct state_head *moved)
{
    *head = *moved;
    head->intent_count = 0;
    head->mover_ns = 0;
    head->checksum = 0;
}

/* Fixed objects are rarely damaged: their hash is kept from frame to frame until one is. */
static uint64_t fixed_hash(struct collider *collider, const struct state *committed,
                           const struct state *next)
{
    if (collider->fixed_hash_frame != committed->head->frame ||
        next->head->tally.fixed_damaged != committed->head->tally.fixed_damaged)
        collider->fixed_hash = state_fixed_hash(next, collider->world->counts.fixed);
    collider->fixed_hash_frame = next->head->frame;
    return collider->fixed_hash;
}

/* The checksum of the frame that is now whole. What it added to the lists is not kept: a frame that
 * is computed again may add something else. */
static uint64_t checksum(struct collider *collider, const struct state *committed,
                         const struct state *next)
{
    struct row_hashes rows;
    list_hashes_extend(&collider->lists, committed);
    struct list_hashes lists = collider->lists;
    list_hashes_extend(&lists, next);
    row_hashes_all(&rows, &next->entities, next->head->used, collider->workers);
    return state_checksum_of(next, &rows, fixed_hash(collider, committed, next), &lists);
}

struct respond collider_respond(struct collider *collider, struct state *next)
{
    const struct world *world = collider->world;
    enum response_model model = (enum response_model)world->params->collision.response;
    bool impulses = model == MODEL_IMPULSE || model == MODEL_SPRING;
    return (struct respond){
        .world = world,
        .broad = &collider->broad,
        .contacts = &collider->contacts,
        .motion = &collider->motion,
        .input = {.detect = {.world = world,
                             .entities = &next->entities,
                             .path = collider->motion.path,
                             .fixed_damage = next->fixed_damage,
                             .craters = &collider->craters,
                             .rows = next->head->used},
                  .motion = &collider->motion,
                  .broad = &collider->broad,
                  .meets = impulses ? CONTACT_MEETS_MAX : 1,
                  .through_fixed = !impulses},
        .next = next,
        .path = collider->motion.path,
        .island = &collider->island,
    };
}

int collider_step(struct collider *collider, const struct state *committed,
                  const struct moved *moved, struct state *next, const struct event_ring *ring)
{
    const struct world *world = collider->world;
    struct stage stage = {collider, moved, next};
    int result = 0;
    if (crater_index_update(&collider->craters, committed->head->crater_count) != 0)
        return -1;
    begin_head(next->head, moved->head);
    memcpy(next->fixed_damage, committed->fixed_damage, world->counts.fixed);
    motion_begin(&collider->motion, committed, next);
    workers_run(collider->workers, take_rows, &stage, moved->head->used, ROWS_A_PIECE);

    struct respond respond = collider_respond(collider, next);
    respond.sink = (struct sink){.slot = ring->slot,
                                 .slots = ring->slots,
                                 .first = committed->head->event_end,
                                 .frame = next->head->frame,
                                 .tick = next->head->tick,
                                 .most = world->params->events_per_frame,
                                 .tally = &next->head->tally};
    put_intents(&respond.sink, moved);
    if (next->head->advanced) {
        result = collide_all(collider, &respond);
        contacts_end(&collider->contacts);
    }
    respond_end(&respond);
    next->head->event_end = respond.sink.first + respond.sink.count;
    next->head->event_digest = sink_digest(&respond.sink, committed->head->event_digest);
    next->head->checksum = checksum(collider, committed, next);
    return result;
}
