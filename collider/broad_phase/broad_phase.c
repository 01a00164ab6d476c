/* The broad phase over strips of gridsquares. */
#include "collider/broad_phase/broad_phase.h"

#include "collider/broad_phase/body_boxes.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/row_words.h"
#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/prefault.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

#define ROWS_A_PIECE   (2 * BROAD_PHASE_ROWS_TAKEN)
#define STRIPS_A_PIECE 4
#define QUERIES_LEAST  2048 /* fewer cost less than an index of all rows */
#define ALONE_MOST     8192 /* rows that one thread finishes sooner than others would wake */
#define ALONE_LEAST    256  /* and sooner than others that are awake would help */

int broad_phase_init(struct broad_phase *broad, const struct world *world,
                     struct thread_pool *workers)
{
    *broad = (struct broad_phase){
        .world = world, .workers = workers, .sweepers = thread_pool_threads(workers)};
    uint32_t rows = world->params->capacity, pairs = pair_filter_pairs_first(world);
    broad->box = malloc(rows * sizeof *broad->box);
    broad->sweeper = calloc(broad->sweepers, sizeof *broad->sweeper);
    broad->wider = calloc(rows, sizeof *broad->wider);
    broad->widened = reserve_take(rows, sizeof *broad->widened);
    bool taken = broad->box && broad->sweeper && broad->wider && broad->widened &&
                 static_boxes_init(&broad->fixed_boxes, world) == 0 &&
                 query_index_init(&broad->index, rows) == 0 &&
                 resting_records_init(&broad->resting, rows) == 0 &&
                 cruise_index_init(&broad->cruise, rows, world->terrain.squares.world_m) == 0 &&
                 (broad->binned = calloc(broad->cruise.words, sizeof *broad->binned)) != NULL;
    broad->cruises = world->params->cruise != 0;
    for (uint32_t i = 0; taken && i < broad->sweepers; i++)
        taken = sweep_worker_init(&broad->sweeper[i], rows, pairs) == 0;
    if (taken)
        return 0;
    broad_phase_free(broad);
    errno = ENOMEM;
    return -1;
}

void broad_phase_free(struct broad_phase *broad)
{
    for (uint32_t i = 0; broad->sweeper && i < broad->sweepers; i++)
        sweep_worker_free(&broad->sweeper[i]);
    static_boxes_free(&broad->fixed_boxes);
    query_index_free(&broad->index);
    resting_records_free(&broad->resting);
    cruise_index_free(&broad->cruise);
    free(broad->binned);
    free(broad->sweeper);
    free(broad->box);
    free(broad->wider);
    reserve_free(broad->widened);
    *broad = (struct broad_phase){0};
}

void broad_phase_touch(const struct broad_phase *broad, uint32_t rows)
{
    prefault_own(broad->box, rows * sizeof *broad->box);
    query_index_touch(&broad->index, rows);
    if (broad->world->params->cruise)
        cruise_index_touch(&broad->cruise, rows);
    for (uint32_t i = 0; i < broad->sweepers; i++)
        strip_bins_touch(&broad->sweeper[i].bins, rows);
}

struct job {
    struct broad_phase *broad;
    struct body_boxes rows;
    struct strips strips;
    double margin[KIND_COUNT_MAX];
    uint32_t flags[KIND_COUNT_MAX]; /* bits of the tag */
    broad_phase_take *take;         /* NULL: the rows are complete */
    void *context;
};

/* Makes the records of the rows of a block that are not kept. */
static void bin_block(struct job *job, struct sweep_worker *sweeper, uint32_t first, uint32_t end,
                      const struct moving_rows *moving)
{
    struct broad_phase *broad = job->broad;
    uint64_t *bin = broad->binned + first / 64;
    uint32_t count = resting_records_note(&broad->resting, first / BROAD_PHASE_ROWS_TAKEN, moving,
                                          broad->cruise.held, bin);
    if (count == end - first) {
        body_boxes_bin(&job->rows, sweeper, first, end);
        return;
    }
    for (uint32_t w = 0; w < RESTING_RECORDS_WORDS; w++) {
        if (bin[w] != 0)
            body_boxes_bin_some(&job->rows, sweeper, first + w * 64, bin[w]);
    }
}

static void bin_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    for (uint32_t row = first; row < end; row += BROAD_PHASE_ROWS_TAKEN) {
        uint32_t past = end - row < BROAD_PHASE_ROWS_TAKEN ? end : row + BROAD_PHASE_ROWS_TAKEN;
        struct moving_rows moving = {.all = true};
        if (job->take)
            job->take(job->context, row, past, &moving);
        bin_block(job, &job->broad->sweeper[worker], row, past, &moving);
        work_done();
    }
}

/* --- rows that cruise --------------------------------------------------------------------------*/

/* Finds the rows whose stretch the rows that move may be in the way of. */
static void meet_cruising(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    const struct broad_phase *broad = job->broad;
    for (uint32_t w = first; w < end; w++) {
        for (uint64_t bits = broad->binned[w] & broad->resting.awake[w]; bits != 0;
             bits &= bits - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(bits);
            if (job->rows.input->entities->row[row].state != ENTITY_FREE &&
                broad->wider[row] == BODY_BOX_EXACT)
                cruise_index_pairs(&broad->cruise, row, &broad->box[row],
                                   &broad->sweeper[worker].pairs);
        }
    }
}

/* The same for the rows in contacts, also for those that do not move: their boxes are wider now. */
static void meet_widened(const struct broad_phase *broad, const struct method_input *input)
{
    for (uint32_t i = 0; i < broad->widened_count; i++) {
        uint32_t row = broad->widened[i];
        struct path_box box = broad->box[row];
        if (row >= input->rows || input->entities->row[row].state == ENTITY_FREE)
            continue;
        box.min_x -= (float)(2.0 * BODY_BOX_WIDER_M), box.max_x += (float)(2.0 * BODY_BOX_WIDER_M);
        box.min_z -= (float)(2.0 * BODY_BOX_WIDER_M), box.max_z += (float)(2.0 * BODY_BOX_WIDER_M);
        cruise_index_pairs(&broad->cruise, row, &box, &broad->sweeper[0].pairs);
    }
}

/* Adds rows that cruise and have been boxed to those that are held: those that do not move, or all.
 */
static void hold(struct broad_phase *broad, const struct body_motion *motion, bool all)
{
    uint32_t rows = motion->next->head->used;
    for (uint32_t w = 0; broad->cruises && w * 64 < rows; w++) {
        uint64_t bits = broad->binned[w] & ~broad->cruise.held[w];
        for (bits &= all ? UINT64_MAX : ~broad->resting.awake[w]; bits != 0; bits &= bits - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(bits);
            if (motion->next->entities.row[row].state != ENTITY_FREE &&
                body_motion_cruises(motion, row))
                cruise_index_add(&broad->cruise, row, &broad->box[row]);
        }
    }
}

void broad_phase_hold(struct broad_phase *broad, const struct body_motion *motion)
{
    hold(broad, motion, true);
}

void broad_phase_let_go(struct broad_phase *broad, uint32_t rows)
{
    for (uint32_t w = 0; w < broad->cruise.words && broad->cruise.count > 0; w++) {
        uint64_t gone = broad->cruise.held[w] & broad->resting.awake[w];
        if (w * 64 >= rows)
            gone = broad->cruise.held[w];
        for (; gone != 0; gone &= gone - 1)
            cruise_index_remove(&broad->cruise, w * 64 + (uint32_t)__builtin_ctzll(gone));
    }
}

void broad_phase_forget(struct broad_phase *broad)
{
    resting_records_forget(&broad->resting);
    cruise_index_clear(&broad->cruise);
}

static bool is_empty(const struct broad_phase *broad, uint32_t strip)
{
    for (uint32_t i = 0; i < broad->sweepers; i++) {
        if (broad->sweeper[i].bins.next[strip])
            return false;
    }
    return true;
}

static void meet_strips(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct sweep_worker *sweeper = &job->broad->sweeper[worker];
    for (uint32_t strip = first; strip < end; strip++) {
        if (!is_empty(job->broad, strip))
            sweep_and_prune_pairs(&job->strips, sweeper, strip);
    }
}

void broad_phase_pairs_moved(struct broad_phase *broad, const struct method_input *input,
                             struct body_motion *motion, broad_phase_take *take, void *context)
{
    struct job job = {.broad = broad, .take = take, .context = context};
    uint32_t alone = thread_pool_is_held(broad->workers) ? ALONE_LEAST : ALONE_MOST;
    struct thread_pool *workers = input->rows > alone ? broad->workers : NULL;
    const struct world *world = input->world;
    for (uint32_t i = 0; i < world->counts.kinds && i < KIND_COUNT_MAX; i++) {
        job.margin[i] = pair_filter_margin(world, &world->kinds[i]);
        job.flags[i] = world->kinds[i].domain == DOMAIN_AIR ? BIN_AIR : 0;
    }
    job.rows = (struct body_boxes){.input = input,
                                   .motion = motion,
                                   .steps_per_m = broad->fixed_boxes.steps_per_m,
                                   .box = broad->box,
                                   .margin = job.margin,
                                   .flags = job.flags,
                                   .wider = broad->widened_count > 0 ? broad->wider : NULL,
                                   .awake = broad->cruises && motion ? broad->resting.awake : NULL};
    job.strips = (struct strips){.input = input,
                                 .motion = motion,
                                 .fixed_boxes = &broad->fixed_boxes,
                                 .resting = broad->resting.index.built ? &broad->resting : NULL,
                                 .steps_per_m = broad->fixed_boxes.steps_per_m,
                                 .box = broad->box,
                                 .margin = job.margin,
                                 .sweeper = broad->sweeper,
                                 .sweepers = broad->sweepers};
    broad->index.built = false;
    for (uint32_t i = 0; i < broad->sweepers; i++) {
        strip_bins_clear(&broad->sweeper[i].bins);
        broad->sweeper[i].fliers.count = 0;
        broad->sweeper[i].pairs.count = 0;
    }
    resting_records_begin(&broad->resting, input);
    if (broad->resting.never)
        cruise_index_clear(&broad->cruise);
    thread_pool_run(workers, bin_rows, &job, input->rows, ROWS_A_PIECE);
    broad_phase_let_go(broad, input->rows);
    if (motion)
        hold(broad, motion, false);
    if (broad->cruise.count > 0) {
        thread_pool_run(workers, meet_cruising, &job, (input->rows + 63) / 64, ROWS_A_PIECE / 64);
        meet_widened(broad, input);
    }
    thread_pool_run(workers, meet_strips, &job, STRIP_COUNT, STRIPS_A_PIECE);
    resting_records_end(&broad->resting, &job.rows);
    for (uint32_t i = 0; i < broad->sweepers; i++)
        broad->list[i] = broad->sweeper[i].pairs;
}

void broad_phase_pairs(struct broad_phase *broad, const struct method_input *input)
{
    broad_phase_pairs_moved(broad, input, NULL, NULL, NULL);
}

/* --- rows in contacts --------------------------------------------------------------------------*/

static void widen(struct broad_phase *broad, uint32_t row)
{
    if (broad->wider[row] == BODY_BOX_EXACT)
        broad->widened[broad->widened_count++] = row;
    broad->wider[row] = BODY_BOX_ASKED;
}

void broad_phase_widen(struct broad_phase *broad, const struct persistent_contact *contact,
                       uint32_t count)
{
    for (uint32_t i = 0; i < broad->widened_count; i++)
        broad->wider[broad->widened[i]] = BODY_BOX_EXACT;
    broad->widened_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        widen(broad, contact[i].a_row);
        if (!(contact[i].b_id & PERSISTENT_CONTACT_FIXED))
            widen(broad, contact[i].b_row);
    }
}

bool broad_phase_has_all(const struct broad_phase *broad, uint32_t row)
{
    return broad->wider[row] == BODY_BOX_WIDER;
}

/* --- queries -----------------------------------------------------------------------------------*/

/* Sorts the pairs that were added since, and removes doubles. */
static void order_found(struct pair_list *found, uint32_t since)
{
    struct pair *pair = found->pair + since;
    uint32_t count = found->count - since, kept = 0;
    if (count == 0)
        return;
    sort_words(pair, count);
    for (uint32_t i = 0; i < count; i++) {
        if (kept == 0 || pair[kept - 1].a != pair[i].a || pair[kept - 1].b != pair[i].b)
            pair[kept++] = pair[i];
    }
    found->count = since + kept;
}

/* Adds a pair. Rows in several strips are found in each, so doubles are removed when the list is
 * full. */
static void add_found(struct pair_list *found, uint32_t since, uint32_t a, uint32_t b)
{
    if (found->count == found->capacity)
        order_found(found, since);
    pair_list_add(found, a, b);
}

uint64_t broad_phase_found_most(const struct world *world)
{
    return 2 * ((uint64_t)world->params->capacity + world->counts.fixed) + 2;
}

static struct bin_record record_of(const struct broad_phase *broad, const struct path_box *box,
                                   uint32_t strip)
{
    const float steps_per_m = broad->fixed_boxes.steps_per_m;
    return (struct bin_record){.min_x = bin_steps(steps_per_m, box->min_x),
                               .max_x = bin_steps(steps_per_m, box->max_x),
                               .z = bin_z(steps_per_m, box->min_z, box->max_z, strip)};
}

/* What a query looks for, and where it puts the rows. */
struct query {
    const struct broad_phase *broad;
    const struct path_box *box;
    struct pair_list *found;
    uint32_t since;
};

static void query_records(const struct query *query, const struct bin_record *one,
                          const struct bin_record *record, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t row = record[i].tag & BIN_ROW;
        if (bin_meet(one, &record[i]) &&
            pair_filter_boxes_meet(query->box, &query->broad->box[row]))
            add_found(query->found, query->since, row, 0);
    }
}

static void query_bins(const struct query *query, const struct strip_bins *bins, uint32_t strip,
                       const struct bin_record *one)
{
    uint32_t count;
    const struct bin_chunk *chunk = strip_bins_last(bins, strip, &count);
    for (; chunk; chunk = chunk->before, count = BIN_CHUNK_RECORDS)
        query_records(query, one, chunk->record, count);
}

static void query_resting(const struct query *query, uint32_t strip, const struct bin_record *one)
{
    const struct resting_records *resting = &query->broad->resting;
    uint32_t count;
    const struct bin_record *record =
        query_index_from(&resting->index, strip, one->min_x, one->max_x, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (resting_records_holds(resting, &record[i]))
            query_records(query, one, &record[i], 1);
    }
}

static void query_strip(const struct query *query, uint32_t strip)
{
    const struct broad_phase *broad = query->broad;
    const struct bin_record one = record_of(broad, query->box, strip);
    if (broad->resting.index.built)
        query_resting(query, strip, &one);
    if (broad->index.built) {
        uint32_t count;
        const struct bin_record *record =
            query_index_from(&broad->index, strip, one.min_x, one.max_x, &count);
        query_records(query, &one, record, count);
        return;
    }
    for (uint32_t i = 0; i < broad->sweepers; i++)
        query_bins(query, &broad->sweeper[i].bins, strip, &one);
}

void broad_phase_expect_queries(struct broad_phase *broad, uint32_t queries)
{
    const struct strip_bins *bins[THREAD_POOL_MAX];
    if (queries < QUERIES_LEAST || broad->index.built)
        return;
    for (uint32_t i = 0; i < broad->sweepers; i++)
        bins[i] = &broad->sweeper[i].bins;
    query_index_build(&broad->index, bins, broad->sweepers);
}

bool broad_phase_has_records(const struct broad_phase *broad, uint32_t rows)
{
    for (uint32_t w = 0; broad->index.built && w * 64 < rows; w++) {
        uint64_t used = row_words_below(w, rows);
        /* A row that cruises and begins nothing is held, and has no record. */
        if (used & (~broad->binned[w] | (broad->cruise.held[w] & ~broad->resting.awake[w])))
            return false;
    }
    return broad->index.built;
}

void broad_phase_query(const struct broad_phase *broad, const struct method_input *input,
                       const struct path_box *box, struct pair_list *found)
{
    uint32_t since = found->count, last = bin_strip(broad->fixed_boxes.steps_per_m, box->max_z);
    const struct query query = {broad, box, found, since};
    (void)input;
    for (uint32_t strip = bin_strip(broad->fixed_boxes.steps_per_m, box->min_z); strip <= last;
         strip++)
        query_strip(&query, strip);
    if (broad->cruises)
        cruise_index_query(&broad->cruise, box, found);
    order_found(found, since);
}

void broad_phase_query_fixed(const struct broad_phase *broad, const struct method_input *input,
                             const struct path_box *box, struct pair_list *found)
{
    uint32_t since = found->count, last = bin_strip(broad->fixed_boxes.steps_per_m, box->max_z);
    for (uint32_t strip = bin_strip(broad->fixed_boxes.steps_per_m, box->min_z); strip <= last;
         strip++) {
        struct bin_record one = record_of(broad, box, strip);
        const struct bin_record *object = static_boxes_from(&broad->fixed_boxes, strip, one.min_x);
        for (; object->min_x <= one.max_x; object++) {
            uint32_t index = object->tag & BIN_OBJECT;
            if (bin_meet(&one, object) &&
                pair_filter_box_meets_fixed(input, box, &input->world->fixed[index]))
                add_found(found, since, 0, index | PAIR_FIXED);
        }
    }
    order_found(found, since);
}
