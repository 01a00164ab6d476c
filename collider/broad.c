/* The broad phase over strips. */
#include "collider/broad.h"

#include "world/clones.h"
#include "world/entity.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK          64
#define ROWS_A_PIECE   4096
#define STRIPS_A_PIECE 4
#define ALONE_MOST     8192 /* rows that one thread has done before others would have woken */
#define LONG_M         64.0 /* a way's extent in x from which it is clipped to its strips */

int broad_init(struct broad *broad, const struct world *world, struct workers *workers)
{
    *broad = (struct broad){.world = world, .workers = workers, .lanes = workers_threads(workers)};
    broad->box = malloc(world->params->capacity * sizeof *broad->box);
    broad->lane = calloc(broad->lanes, sizeof *broad->lane);
    if (!broad->box || !broad->lane || standing_init(&broad->standing, world) != 0) {
        broad_free(broad);
        errno = ENOMEM;
        return -1;
    }
    return 0;
}

void broad_free(struct broad *broad)
{
    for (uint32_t i = 0; broad->lane && i < broad->lanes; i++)
        strip_lane_free(&broad->lane[i]);
    for (int i = 0; i < WORKERS_MAX; i++)
        free(broad->list[i].pair);
    standing_free(&broad->standing);
    free(broad->lane);
    free(broad->box);
    *broad = (struct broad){0};
}

struct job {
    struct broad *broad;
    const struct detect_input *input;
    struct strips strips;
    double grow[KIND_COUNT_MAX];
    uint32_t flags[KIND_COUNT_MAX]; /* of the tag */
    _Atomic int failed;
};

/* --- rows into strips --------------------------------------------------------------------------*/

/* A block of rows on their way into the strips: each property in a row of its own, so that the
 * compiler makes vectors of the loops. What they do is what detect_box and bins.h's functions do.
 */
struct block {
    _Alignas(64) double grow[BLOCK];
    float min_x[BLOCK], max_x[BLOCK], min_z[BLOCK], max_z[BLOCK];
    int32_t west[BLOCK], east[BLOCK], north[BLOCK], south[BLOCK]; /* the same [steps] */
    uint32_t tag[BLOCK];
    uint32_t strip[BLOCK]; /* STRIP_COUNT: several */
    struct bin_record record[BLOCK];
    /* Fewer rows than a block are copied here first. */
    struct path path[BLOCK];
    struct sweep_box box[BLOCK];
};

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static bool rests(const struct path *path)
{
    uint64_t any = bits_of(path->along.x) | bits_of(path->along.y) | bits_of(path->along.z);
    return any << 1 == 0 && !path->turns; /* 0.0 or -0.0 each */
}

static void name_rows(const struct job *job, struct block *restrict block,
                      const struct path *restrict path, uint32_t first, uint32_t count)
{
    const struct entities *e = job->input->entities;
    const uint8_t *state = e->state + first, *behaviour = e->behaviour + first;
    const uint16_t *kinds = e->kind + first;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t kind = state[k] != ENTITY_FREE ? kinds[k] : 0;
        block->grow[k] = job->grow[kind];
        block->tag[k] = (first + k) | job->flags[kind] | (rests(&path[k]) ? BIN_RESTS : 0) |
                        (behaviour[k] == BEHAVIOUR_FLIGHT ? BIN_ROUND : 0);
    }
}

static void box_rows(struct block *restrict block, const struct path *restrict path,
                     struct sweep_box *restrict box)
{
    for (uint32_t k = 0; k < BLOCK; k++) {
        const struct path *way = &path[k];
        __builtin_prefetch(&way[2 * BLOCK], 0, 2);
        double left = 1.0 - way->since, grow = block->grow[k], low[2], high[2];
        double at[2] = {way->at.x, way->at.y}, along[2] = {way->along.x, way->along.y};
        for (int axis = 0; axis < 2; axis++) {
            double to = at[axis] + along[axis] * left;
            low[axis] = maths_min(at[axis], to) - grow;
            high[axis] = maths_max(at[axis], to) + grow;
        }
        double z = way->at.z, to_z = z + way->along.z * left;
        block->min_x[k] = box[k].min_x = (float)low[0];
        block->max_x[k] = box[k].max_x = (float)high[0];
        block->min_z[k] = box[k].min_z = (float)(maths_min(z, to_z) - grow);
        block->max_z[k] = box[k].max_z = (float)(maths_max(z, to_z) + grow);
        box[k].min_y = (float)low[1];
        box[k].max_y = (float)high[1];
    }
}

/* bin_steps of each. In two loops: of one, gcc makes branches. */
static void scale(float *restrict metres, int32_t *restrict steps)
{
    for (uint32_t k = 0; k < BLOCK; k++)
        metres[k] = bin_scaled(metres[k]);
    for (uint32_t k = 0; k < BLOCK; k++)
        steps[k] = (int32_t)metres[k];
}

static void make_records(struct block *restrict block)
{
    for (size_t k = 0; k < BLOCK; k++) {
        uint32_t north = (uint32_t)block->north[k];
        uint32_t strip = north / BIN_STRIP_STEPS, edge = strip * BIN_STRIP_STEPS;
        uint32_t south = (uint32_t)block->south[k] - edge;
        int32_t width = block->east[k] - block->west[k];
        block->record[k].min_x = block->west[k];
        block->record[k].max_x = block->east[k];
        block->record[k].z = (north - edge) | south << 16;
        block->record[k].tag = block->tag[k] | (width > BIN_WIDE_STEPS ? BIN_WIDE : 0);
        block->strip[k] = south < BIN_STRIP_STEPS ? strip : STRIP_COUNT;
    }
}

static int add_spanning(const struct job *job, struct bins *bins, uint32_t tag)
{
    uint32_t row = tag & BIN_ROW;
    const struct path *path = &job->input->path[row];
    const struct sweep_box *box = &job->broad->box[row];
    bool is_long = fabs(path->along.x) > LONG_M;
    double grow = job->grow[job->input->entities->kind[row]];
    struct bin_record record = {.min_x = bin_steps(box->min_x),
                                .max_x = bin_steps(box->max_x),
                                .tag = tag | BIN_SPANS | (is_long ? BIN_LONG | BIN_WIDE : 0)};
    uint32_t last = bin_strip(box->max_z);
    for (uint32_t strip = bin_strip(box->min_z); strip <= last; strip++) {
        if (is_long) {
            struct strip_span span = strip_span(path, box, grow, strip);
            record.min_x = span.min_x;
            record.max_x = span.max_x;
        }
        record.z = bin_z(box->min_z, box->max_z, strip);
        if (bins_add(bins, strip, record) != 0)
            return -1;
    }
    return 0;
}

static int add_rows(const struct job *job, struct bins *bins, const struct block *block,
                    uint32_t first, uint32_t count)
{
    const uint8_t *state = job->input->entities->state + first;
    for (uint32_t k = 0; k < count; k++) {
        if (state[k] == ENTITY_FREE)
            continue;
        if ((block->strip[k] < STRIP_COUNT ? bins_add(bins, block->strip[k], block->record[k])
                                           : add_spanning(job, bins, block->record[k].tag)) != 0)
            return -1;
    }
    return 0;
}

static int bin_block(const struct job *job, struct block *block, struct bins *bins, uint32_t first,
                     uint32_t count)
{
    const struct path *path = job->input->path + first;
    struct sweep_box *box = job->broad->box + first;
    if (count < BLOCK) {
        memcpy(block->path, path, count * sizeof *path);
        path = block->path;
        box = block->box;
    }
    name_rows(job, block, path, first, count);
    box_rows(block, path, box);
    if (count < BLOCK)
        memcpy(job->broad->box + first, box, count * sizeof *box);
    scale(block->min_x, block->west);
    scale(block->max_x, block->east);
    scale(block->min_z, block->north);
    scale(block->max_z, block->south);
    make_records(block);
    return add_rows(job, bins, block, first, count);
}

VECTOR_CLONES static void bin_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct block block = {0};
    struct bins *bins = &job->broad->lane[worker].bins;
    for (uint32_t row = first; row < end; row += BLOCK) {
        if (bin_block(job, &block, bins, row, end - row < BLOCK ? end - row : BLOCK) != 0)
            atomic_store(&job->failed, 1);
    }
}

/* --- strips ------------------------------------------------------------------------------------*/

static void meet_strips(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct strip_lane *lane = &job->broad->lane[worker];
    for (uint32_t strip = first; strip < end; strip++) {
        if (strip_pairs(&job->strips, lane, strip) != 0)
            atomic_store(&job->failed, 1);
    }
}

int broad_pairs(struct broad *broad, const struct detect_input *input)
{
    struct job job = {.broad = broad, .input = input};
    struct workers *workers = input->rows > ALONE_MOST ? broad->workers : NULL;
    const struct world *world = input->world;
    for (uint32_t i = 0; i < world->counts.kinds; i++) {
        job.grow[i] = detect_grow(world, &world->kinds[i]);
        job.flags[i] = world->kinds[i].domain == DOMAIN_AIR ? BIN_AIR : 0;
    }
    job.strips = (struct strips){.input = input,
                                 .standing = &broad->standing,
                                 .box = broad->box,
                                 .grow = job.grow,
                                 .lane = broad->lane,
                                 .lanes = broad->lanes};
    for (uint32_t i = 0; i < broad->lanes; i++) {
        bins_clear(&broad->lane[i].bins);
        broad->lane[i].pairs = broad->list[i];
        broad->lane[i].pairs.count = 0;
    }
    workers_run(workers, bin_rows, &job, input->rows, ROWS_A_PIECE);
    workers_run(workers, meet_strips, &job, STRIP_COUNT, STRIPS_A_PIECE);
    for (uint32_t i = 0; i < broad->lanes; i++) {
        broad->list[i] = broad->lane[i].pairs;
        broad->lane[i].pairs = (struct pair_list){0};
    }
    if (atomic_load(&job.failed)) {
        errno = ENOMEM;
        return -1;
    }
    return 0;
}

/* --- queries -----------------------------------------------------------------------------------*/

static int by_row(const void *p, const void *q)
{
    const struct pair *a = p, *b = q;
    return a->a != b->a ? (a->a < b->a ? -1 : 1) : (a->b > b->b) - (a->b < b->b);
}

/* Puts what was added since in order, each once. */
static void order_found(struct pair_list *found, uint32_t since)
{
    struct pair *pair = found->pair + since;
    uint32_t count = found->count - since, kept = 0;
    if (count == 0)
        return;
    qsort(pair, count, sizeof *pair, by_row);
    for (uint32_t i = 0; i < count; i++) {
        if (kept == 0 || by_row(&pair[kept - 1], &pair[i]) != 0)
            pair[kept++] = pair[i];
    }
    found->count = since + kept;
}

static struct bin_record record_of(const struct sweep_box *box, uint32_t strip)
{
    return (struct bin_record){.min_x = bin_steps(box->min_x),
                               .max_x = bin_steps(box->max_x),
                               .z = bin_z(box->min_z, box->max_z, strip)};
}

static int query_strip(const struct broad *broad, const struct bins *bins, uint32_t strip,
                       const struct sweep_box *box, struct pair_list *found)
{
    struct bin_record one = record_of(box, strip);
    uint32_t count;
    const struct bin_chunk *chunk = bins_last(bins, strip, &count);
    for (; chunk; chunk = chunk->before, count = BIN_CHUNK_RECORDS) {
        for (uint32_t i = 0; i < count; i++) {
            uint32_t row = chunk->record[i].tag & BIN_ROW;
            if (bin_meet(&one, &chunk->record[i]) && detect_boxes_meet(box, &broad->box[row]) &&
                pair_list_add(found, row, 0) != 0)
                return -1;
        }
    }
    return 0;
}

int broad_query(const struct broad *broad, const struct detect_input *input,
                const struct sweep_box *box, struct pair_list *found)
{
    uint32_t since = found->count, last = bin_strip(box->max_z);
    (void)input;
    for (uint32_t strip = bin_strip(box->min_z); strip <= last; strip++) {
        for (uint32_t i = 0; i < broad->lanes; i++) {
            if (query_strip(broad, &broad->lane[i].bins, strip, box, found) != 0)
                return -1;
        }
    }
    order_found(found, since);
    return 0;
}

int broad_query_fixed(const struct broad *broad, const struct detect_input *input,
                      const struct sweep_box *box, struct pair_list *found)
{
    uint32_t since = found->count, last = bin_strip(box->max_z);
    for (uint32_t strip = bin_strip(box->min_z); strip <= last; strip++) {
        struct bin_record one = record_of(box, strip);
        const struct bin_record *object = standing_from(&broad->standing, strip, one.min_x);
        for (; object->min_x <= one.max_x; object++) {
            uint32_t index = object->tag & BIN_OBJECT;
            if (bin_meet(&one, object) &&
                detect_box_meets_fixed(input, box, &input->world->fixed[index]) &&
                pair_list_add(found, 0, index | PAIR_FIXED) != 0)
                return -1;
        }
    }
    order_found(found, since);
    return 0;
}
