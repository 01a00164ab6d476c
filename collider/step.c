/* The collider's step, from top to bottom. */
#include "collider/step.h"

#include "collider/narrow_phase/cruise_rows.h"
#include "collider/parting/made_way.h"
#include "collider/remote_rows.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/held_rest.h"
#include "collider/resting/sleeping_contacts.h"
#include "collider/guard/turret_guard.h"
#include "collider/response/damage.h"
#include "collider/response/debris_push.h"
#include "collider/response/response.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/table_touch.h"
#include "world/entity/table_write.h"
#include "world/maths/hash.h"
#include "world/params.h"
#include "world/runtime/work_done.h"
#include "world/state.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define BLOCKS_A_WORKER 2u /* blocks taken at a time */

/* Returns a bit for each row that a world has room for, in whole blocks, or NULL. */
static uint64_t *rows_bits(const struct world *world)
{
    return calloc(1, written_bytes(world->params->capacity));
}

int collider_init(struct collider *collider, const struct world *world,
                  const struct crater *craters, struct thread_pool *workers)
{
    *collider =
        (struct collider){.world = world, .workers = workers, .fixed_hash_frame = UINT64_MAX};
    if (crater_index_init(&collider->craters, &world->terrain.squares, craters) != 0 ||
        square_bounds_init(&collider->heights, &world->terrain.squares, square_bounds_height,
                           &world->terrain) != 0 ||
        !(collider->written[0] = rows_bits(world)) || !(collider->written[1] = rows_bits(world)) ||
        !(collider->sprung = rows_bits(world)) || !(collider->fresh = rows_bits(world)) ||
        body_motion_init(&collider->motion, world) != 0 ||
        broad_phase_init(&collider->broad, world, workers) != 0 ||
        contact_queue_init(&collider->contacts, world, workers) != 0 ||
        island_init(&collider->island, world) != 0 ||
        contact_table_init(&collider->table, world) != 0 ||
        resting_init(&collider->resting, world, workers) != 0 ||
        free_bodies_init(&collider->free, world) != 0 ||
        end_guard_init(&collider->guard, world, workers) != 0 ||
        sphere_parting_init(&collider->spheres, world) != 0 ||
        aircraft_parting_init(&collider->aircraft, world, workers) != 0 ||
        charges_init(&collider->charges, world) != 0 ||
        pair_list_init(&collider->pairs, pair_filter_pairs_first(world)) != 0 ||
        pair_list_init(&collider->ends, 2 * (uint64_t)pair_filter_pairs_first(world)) != 0 ||
        !(collider->workspace = method_workspace_create(world, &collider->broad))) {
        collider_free(collider);
        errno = ENOMEM;
        return -1;
    }
    return 0;
}

void collider_free(struct collider *collider)
{
    crater_index_free(&collider->craters);
    square_bounds_free(&collider->heights);
    free(collider->written[0]);
    free(collider->written[1]);
    free(collider->sprung);
    free(collider->fresh);
    body_motion_free(&collider->motion);
    broad_phase_free(&collider->broad);
    contact_queue_free(&collider->contacts);
    island_free(&collider->island);
    contact_table_free(&collider->table);
    resting_free(&collider->resting);
    free_bodies_free(&collider->free);
    end_guard_free(&collider->guard);
    sphere_parting_free(&collider->spheres);
    aircraft_parting_free(&collider->aircraft);
    charges_free(&collider->charges);
    method_workspace_free(collider->workspace);
    pair_list_free(&collider->pairs);
    pair_list_free(&collider->ends);
    *collider = (struct collider){0};
}

void collider_touch(const struct collider *collider, const struct moved *moved,
                    const struct state states[2], uint32_t rows)
{
    table_touch(&states[0].entities, rows, true);
    table_touch(&states[1].entities, rows, true);
    table_touch(&moved->entities, rows, false);
    body_motion_touch(&collider->motion, rows);
    broad_phase_touch(&collider->broad, rows);
}

struct step {
    struct collider *collider;
    const struct state *committed;
    const struct moved *moved;
    const struct state *next;
    uint32_t used;
    uint32_t known; /* first blocks of next that still hold what this process left */
    uint32_t sees;  /* the same, if this process has made the committed frame, too; else 0 */
};

_Static_assert(BROAD_PHASE_ROWS_TAKEN == CHECKSUM_ROWS, "rows are taken by whole blocks");

/* Rows of a block that may move before they are taken for all, without and with rows that cruise,
 * which cost less if they are not taken. */
#define FEW_MOVE       (CHECKSUM_ROWS / 4)
#define FEW_MOVE_ALONG (CHECKSUM_ROWS / 4 * 3)

/* Returns the bits of the rows that the mover wrote in this frame, as take_blocks() noted them: all
 * rows, where that is not known. */
static uint64_t *written_now(const struct step *step)
{
    return step->collider->written[(step->committed->head->frame + 1) & 1];
}

/* Finds the rows of a block whose pose is not that of the committed frame. */
static void find_moving(const struct step *step, uint32_t block, struct moving_rows *moving)
{
    const struct entities *m = &step->moved->entities, *w = &step->committed->entities;
    const uint64_t *written = written_now(step) + block * ROW_BLOCK_WORDS;
    uint32_t first = block * CHECKSUM_ROWS, old = step->committed->head->used, count = 0;
    uint32_t few = step->collider->broad.cruises ? FEW_MOVE_ALONG : FEW_MOVE;
    *moving = (struct moving_rows){.all = first >= old};
    for (uint32_t n = 0; !moving->all && n < ROW_BLOCK_WORDS; n++) {
        for (uint64_t left = written[n]; left != 0; left &= left - 1) {
            uint32_t row = first + n * 64 + (uint32_t)__builtin_ctzll(left);
            bool moves = row < step->used &&
                         (row >= old || resting_records_pose_differs(&m->row[row], &w->row[row]));
            moving->row[n] |= moves ? left & -left : 0;
        }
        count += (uint32_t)__builtin_popcountll(moving->row[n]);
    }
    moving->all |= count > few;
}

/* Copies the rows of a block in which the next buffer, which holds the frame before the committed
 * one, may differ from the moved table: those that the mover wrote in this frame and in the last
 * one, and those that responses wrote in the last one. A row that comes into use is written. */
static void take_stale(const struct step *step, uint32_t block)
{
    const uint64_t *before = step->collider->written[step->committed->head->frame & 1];
    uint64_t bits[ROW_BLOCK_WORDS];
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++) {
        uint32_t word = block * ROW_BLOCK_WORDS + w;
        bits[w] = step->moved->written[word] | before[word] | step->committed->written[word];
    }
    table_take_rows(state_table(step->next), moved_table(step->moved), block, bits);
}

/* Notes which rows of a block the mover wrote, which of these are on their springs, and which hold
 * another body than in the committed frame. */
static void note_written(const struct step *step, uint32_t block, bool known)
{
    const struct entity *m = step->moved->entities.row, *before = step->committed->entities.row;
    const uint32_t first = block * ROW_BLOCK_WORDS, old = step->committed->head->used;
    uint64_t *written = written_now(step);
    uint64_t *sprung = step->collider->sprung, *fresh = step->collider->fresh;
    for (uint32_t w = first; w < first + ROW_BLOCK_WORDS; w++) {
        uint32_t left_rows = step->used > w * 64 ? step->used - w * 64 : 0;
        uint64_t there = left_rows >= 64 ? UINT64_MAX : ((uint64_t)1 << left_rows) - 1;
        written[w] = there & (known ? step->moved->written[w] : UINT64_MAX);
        sprung[w] = fresh[w] = 0;
        for (uint64_t left = written[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            sprung[w] |= m[row].flags & ENTITY_FLAG_CHASSIS ? left & -left : 0;
            fresh[w] |= row >= old || m[row].id != before[row].id ? left & -left : 0;
        }
    }
}

/* Copies blocks of moved rows. */
static void take_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct step *step = context;
    (void)worker;
    for (uint32_t block = first; block < end; block++) {
        bool sees = block < step->sees;
        if (sees)
            take_stale(step, block);
        else
            table_take(state_table(step->next), moved_table(step->moved), block, step->used,
                       block < step->known);
        note_written(step, block, sees);
    }
}

/* Copies a block of moved rows just before detection reads them. */
static void take_rows(void *context, uint32_t first, uint32_t end, struct moving_rows *moving)
{
    const struct step *step = context;
    uint32_t block = first / CHECKSUM_ROWS;
    take_blocks(context, block, block_count(end), 0);
    find_moving(step, block, moving);
}

/* Notes which rows commands have changed in a frame in which time does not advance. */
static void note_moving(const struct step *step, const struct method_input *input)
{
    struct broad_phase *broad = &step->collider->broad;
    struct resting_records *resting = &broad->resting;
    uint64_t bin[RESTING_RECORDS_WORDS];
    resting_records_begin(resting, input);
    for (uint32_t block = 0; block < block_count(step->used); block++) {
        struct moving_rows moving;
        find_moving(step, block, &moving);
        resting_records_note(resting, block, &moving, broad->cruise.held, bin);
    }
    broad_phase_let_go(broad, step->used);
}

/* Copies all moved rows. */
static void take_all(struct step *step)
{
    thread_pool_run(step->collider->workers, take_blocks, step, block_count(step->used),
                    BLOCKS_A_WORKER);
}

/* Returns how many blocks of next still hold what this process left there two frames ago. */
static uint32_t known_blocks(const struct collider *collider, const struct moved *moved,
                             const struct state *next)
{
    uint64_t frame = moved->head->frame, left = collider->left[frame & 1];
    bool own = left != 0 && next->head->checksum == left && next->head->frame + 2 == frame;
    return own ? block_count(next->head->used) : 0;
}

static void put_intents(struct event_writer *events, const struct moved *moved)
{
    for (uint32_t i = 0; i < moved->head->intent_count; i++) {
        const struct event *intent = &moved->intents[i];
        struct event *event = event_writer_event(events, (enum event_type)intent->type);
        if (event)
            memcpy(event->bytes, intent->bytes, sizeof event->bytes);
    }
}

static void require_paths(struct body_motion *motion, const struct pair_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        body_motion_require(motion, list->pair[i].a);
        if (!(list->pair[i].b & PAIR_FIXED))
            body_motion_require(motion, list->pair[i].b);
    }
}

/* Ends the stretches of rows that may meet something, or that touch something already. */
static void end_stretches(const struct step *step, const struct response_context *context)
{
    struct collider *collider = step->collider;
    const struct state *committed = step->committed;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        cruise_rows_stop(&context->input, contact->a_row);
        if (!(contact->b_id & PERSISTENT_CONTACT_FIXED))
            cruise_rows_stop(&context->input, contact->b_row);
    }
    cruise_rows_take_pairs(&context->input, &collider->pairs, &collider->ends);
    broad_phase_hold(&collider->broad, &collider->motion);
}

/* Copies the moved rows, block by block with the broad phase, and finds the frame's pairs by the
 * scenario's method. Computes all paths only if the method needs them, else those of pairs. */
static void find_pairs(struct step *step, const struct response_context *context)
{
    const struct method_input *input = &context->input.detect;
    struct collider *collider = step->collider;
    const struct method_functions *method =
        method_of((enum method)collider->world->params->collision.method);
    const struct state *committed = step->committed;
    bool widens = collider->world->params->collision.method == METHOD_SWEPT;
    broad_phase_widen(&collider->broad, committed->contacts,
                      widens ? committed->head->contact_count : 0);
    broad_phase_pairs_moved(&collider->broad, input, &collider->motion, take_rows, step);
    for (uint32_t row = 0; method->test != METHOD_TESTS_NEAR && row < input->rows; row++)
        body_motion_require(&collider->motion, row);
    collider->pairs.count = 0;
    method->pairs(input, collider->workspace, &collider->pairs);
    if (collider->broad.cruises)
        end_stretches(step, context);
    require_paths(&collider->motion, &collider->pairs);
    contact_queue_begin(&collider->contacts, &collider->pairs, 1);
}

/* With so many lasting contacts a frame has dozens of jobs, and takes the better part of a
 * millisecond. */
#define CROWDED 64u

static bool is_crowded(const struct collider *collider)
{
    return collider->motion.committed->head->contact_count >= CROWDED && !collider->slept;
}

/* Bodies end the frame on the ground that its explosions leave. */
static void settle_on_new_ground(const struct step *step, struct response_context *context)
{
    const uint32_t known = step->committed->head->crater_count;
    const uint32_t count = context->next->head->crater_count;
    if (count == known)
        return;
    crater_index_update(&step->collider->craters, count);
    ground_placement_dug(context, known);
}

static bool is_discrete(const struct world *world)
{
    return method_discrete((enum method)world->params->collision.method);
}

/* Solves the contacts of free bodies, and parts those in the air that begin in each other. */
static void solve_free(struct collider *collider, struct response_context *context)
{
    free_bodies_solve(&collider->free, context);
    aircraft_parting_run(&collider->aircraft, context, &collider->free);
}

static void collide_all(struct step *step, struct response_context *context)
{
    struct collider *collider = step->collider;
    struct contact contact;
    /* Spheres that touch are solved by impacts alone; those that are deep in each other part. */
    bool rest = context->functions->joint && collider->motion.models;
    bool spheres = context->functions->joint && !rest && !is_discrete(collider->world);
    if (is_crowded(collider))
        thread_pool_hold(collider->workers);
    find_pairs(step, context);
    context->contacts_sleep = collider->slept = sleeping_contacts_all(context);
    if (rest) {
        resting_solve(&collider->resting, context);
        solve_free(collider, context);
    } else if (spheres) {
        struct contact_groups *groups = &collider->resting.groups;
        contact_groups_find_begun(groups, context);
        collider->resting.moved_count =
            sphere_parting_run(&collider->spheres, context, groups->begun, groups->begun_count,
                               collider->resting.moved);
    }
    contact_queue_find(&collider->contacts, &context->input);
    contact_queue_find_ends(&collider->contacts, &context->input, context->next->head->tick);
    while (contact_queue_next(&collider->contacts, &context->input, &contact)) {
        response_contact(context, &contact);
        work_done();
    }

    if (rest)
        aircraft_parting_share(&collider->aircraft, context, &collider->free);
    settle_on_new_ground(step, context);
    if (context->functions->joint)
        end_guard_run(&collider->guard, &collider->resting, &collider->free, context);
    else
        ground_placement_changed(context);
    if (rest) {
        made_way_settle(&collider->aircraft, context);
        turret_guard_run(context);
    }
    if (context->functions->joint)
        debris_push_step(context);
    remote_rows_settle(context, &step->moved->entities);
    damage_overturned(context);
    if (collider->broad.cruises)
        cruise_rows_meet_written(&context->input, &collider->pairs);
    if (!sleeping_contacts_keep(context)) {
        contact_table_finish(&collider->table, context);
        held_rest_let_go(context);
    }
    thread_pool_let_go(collider->workers);
}

static void begin_head(struct state_head *head, const struct state_head *moved)
{
    *head = *moved;
    head->intent_count = 0;
    head->mover_ns = 0;
    head->checksum = 0;
}

/* Copies the contacts into a frame in which time does not advance. */
static void copy_contacts(const struct state *committed, struct state *next)
{
    uint32_t count = committed->head->contact_count;
    next->head->contact_count = count;
    memcpy(next->contacts, committed->contacts, count * sizeof *next->contacts);
}

/* Fixed objects are rarely damaged, so their hash is kept from frame to frame until one is. */
static uint64_t fixed_hash(struct collider *collider, const struct state *committed,
                           const struct state *next)
{
    if (collider->fixed_hash_frame != committed->head->frame ||
        next->head->tally.fixed_damaged != committed->head->tally.fixed_damaged)
        collider->fixed_hash = state_fixed_hash(next, collider->world->counts.fixed);
    collider->fixed_hash_frame = next->head->frame;
    return collider->fixed_hash;
}

/* The checksum of the finished frame. The hashes of the lists are kept only up to the committed
 * frame, since this frame may be computed again. */
static uint64_t checksum(const struct step *step, const struct state *next)
{
    struct collider *collider = step->collider;
    const struct state *committed = step->committed;
    uint32_t used = next->head->used;
    list_hashes_extend(&collider->lists, committed);
    struct list_hashes lists = collider->lists;
    list_hashes_extend(&lists, next);
    memcpy(next->written, collider->broad.resting.written,
           written_bytes(collider->world->params->capacity));
    table_hash_written(state_table(next), &step->moved->entities, used, next->written);
    return state_checksum_of(next, rows_hash(next->hashes, used),
                             fixed_hash(collider, committed, next), &lists);
}

struct response_context collider_response_context(struct collider *collider, struct state *next)
{
    const struct world *world = collider->world;
    const struct response_functions *functions =
        response_of((enum response_model)world->params->collision.response);
    const struct table_writer writer = {&next->entities, NULL, collider->broad.resting.written};
    return (struct response_context){
        .world = world,
        .functions = functions,
        .broad = &collider->broad,
        .contacts = &collider->contacts,
        .motion = &collider->motion,
        .input = {.detect = {.world = world,
                             .entities = &next->entities,
                             .path = collider->motion.path,
                             .fixed_damage = next->fixed_damage,
                             .craters = &collider->craters,
                             .heights = &collider->heights,
                             .rows = next->head->used},
                  .motion = &collider->motion,
                  .broad = &collider->broad,
                  .meets = functions->joint ? CONTACT_MEETS_MAX : 1,
                  .through_fixed = !functions->joint,
                  .writer = writer},
        .next = next,
        .path = collider->motion.path,
        .charges = &collider->charges,
        .island = &collider->island,
        .moved = collider->written[next->head->frame & 1],
        .sprung = collider->sprung,
        .fresh = collider->fresh,
        .writer = writer,
    };
}

void collider_step(struct collider *collider, const struct state *committed,
                   const struct moved *moved, struct state *next, const struct event_ring *ring)
{
    const struct world *world = collider->world;
    struct step step = {.collider = collider,
                        .committed = committed,
                        .moved = moved,
                        .next = next,
                        .used = moved->head->used,
                        .known = known_blocks(collider, moved, next)};
    uint64_t *left = &collider->left[moved->head->frame & 1];
    /* An own buffer holds the frame before the committed one. */
    bool same_damage =
        step.known > 0 && next->head->tally.fixed_damaged == committed->head->tally.fixed_damaged;
    /* Else rows have changed that this process has not seen. */
    if (committed->head->checksum == collider->left[committed->head->frame & 1])
        step.sees = step.known;
    else
        broad_phase_forget(&collider->broad);
    uint32_t held = step.known > 0 ? next->head->used : next->entities.capacity;
    table_clear_unused(&next->entities, step.used, held);
    crater_index_update(&collider->craters, committed->head->crater_count);
    begin_head(next->head, moved->head);
    if (!same_damage)
        memcpy(next->fixed_damage, committed->fixed_damage, world->counts.fixed);
    body_motion_begin(&collider->motion, committed, next, &collider->craters);

    struct response_context context = collider_response_context(collider, next);
    context.events = (struct event_writer){.slot = ring->slot,
                                           .slots = ring->slots,
                                           .first = committed->head->event_end,
                                           .frame = next->head->frame,
                                           .tick = next->head->tick,
                                           .most = world->params->events_per_frame,
                                           .tally = &next->head->tally};
    put_intents(&context.events, moved);
    if (next->head->advanced) {
        collide_all(&step, &context);
        contact_queue_end(&collider->contacts);
    } else {
        take_all(&step);
        note_moving(&step, &context.input.detect);
        copy_contacts(committed, next);
    }
    next->head->event_end = context.events.first + context.events.count;
    next->head->event_digest = event_writer_digest(&context.events, committed->head->event_digest);
    *left = next->head->checksum = checksum(&step, next);
}
