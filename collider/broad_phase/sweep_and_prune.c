/* Counting sort by west edge, then a sweep over neighbours in that order, many at a time.
 *
 * Records within a bucket are not sorted. Each record is compared with all that follow it up to the
 * end of its east edge's bucket, and the comparison looks at both edges. */
#include "collider/broad_phase/sweep_and_prune.h"

#include "collider/broad_phase/resting_records.h"
#include "world/maths/cpu_dispatch.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <string.h>

#define SORT_LEAST     6u  /* with fewer records every pair is compared */
#define BUCKET_BITS    16u /* at most: a quarter of a megabyte, which fits into a core's cache */
#define CROWDED        32u /* records in a bucket */
#define SAMPLES        8u
#define NARROWER       3u  /* bits of the number of a bucket where they are crowded */
#define BLOCK          16u /* records compared at a time */
#define NEAR           3u  /* following records that every record is compared with */
#define PADDING        (2 * BLOCK)
#define PREFETCH_PAIRS 8u
#define LINE_BYTES     64u
#define LONG_SLACK_M   0.05 /* more than rounding moves the strips' borders */

/* --- memory ------------------------------------------------------------------------------------*/

int sweep_worker_init(struct sweep_worker *sweeper, uint32_t rows, uint32_t pairs)
{
    uint64_t padded = (uint64_t)rows + PADDING;
    *sweeper = (struct sweep_worker){.capacity = rows};
    if (strip_bins_init(&sweeper->bins, rows) != 0 || pair_list_init(&sweeper->pairs, pairs) != 0 ||
        pair_list_init(&sweeper->fliers, rows) != 0)
        return -1;
    sweeper->record = reserve_take(padded, sizeof *sweeper->record);
    sweeper->sorted = reserve_take(padded, sizeof *sweeper->sorted);
    sweeper->min_x = reserve_take(padded, sizeof *sweeper->min_x);
    sweeper->max_x = reserve_take(padded, sizeof *sweeper->max_x);
    sweeper->low_z = reserve_take(padded, sizeof *sweeper->low_z);
    sweeper->high_z = reserve_take(padded, sizeof *sweeper->high_z);
    sweeper->tag = reserve_take(padded, sizeof *sweeper->tag);
    sweeper->bucket = reserve_take((1u << BUCKET_BITS) + 1, sizeof *sweeper->bucket);
    sweeper->candidate = reserve_take(SWEEP_AND_PRUNE_CANDIDATES, sizeof *sweeper->candidate);
    return sweeper->record && sweeper->sorted && sweeper->min_x && sweeper->max_x &&
                   sweeper->low_z && sweeper->high_z && sweeper->tag && sweeper->bucket &&
                   sweeper->candidate
               ? 0
               : -1;
}

void sweep_worker_free(struct sweep_worker *sweeper)
{
    strip_bins_free(&sweeper->bins);
    reserve_free(sweeper->record);
    reserve_free(sweeper->sorted);
    reserve_free(sweeper->min_x);
    reserve_free(sweeper->max_x);
    reserve_free(sweeper->low_z);
    reserve_free(sweeper->high_z);
    reserve_free(sweeper->tag);
    reserve_free(sweeper->bucket);
    reserve_free(sweeper->candidate);
    pair_list_free(&sweeper->pairs);
    pair_list_free(&sweeper->fliers);
    memset(sweeper, 0, sizeof *sweeper);
}

/* --- long ways ---------------------------------------------------------------------------------*/

struct sweep_and_prune_span sweep_and_prune_span(float steps_per_m, const struct path *path,
                                                 const struct path_box *box, double margin,
                                                 uint32_t strip)
{
    double left = 1.0 - path->since, dx = path->along.x * left, dz = path->along.z * left;
    struct sweep_and_prune_span span = {bin_steps(steps_per_m, box->min_x),
                                        bin_steps(steps_per_m, box->max_x)};
    if (dz == 0.0)
        return span;
    /* The part of the path that is nearer to the strip than the body's reach. */
    double deep = BIN_STRIP_STEPS / (double)steps_per_m;
    double reach = margin + LONG_SLACK_M * deep / STRIP_LEAST_M, from = 0.0, to = 1.0;
    double enter = (deep * (double)strip - reach - path->at.z) / dz;
    double leave = (deep * (double)(strip + 1) + reach - path->at.z) / dz;
    if (strip == 0) /* bodies outside the world belong to the strip at its edge */
        enter = dz > 0.0 ? -INFINITY : INFINITY;
    if (strip == STRIP_COUNT - 1)
        leave = dz > 0.0 ? INFINITY : -INFINITY;
    from = maths_max(from, maths_min(enter, leave));
    to = maths_min(to, maths_max(enter, leave));
    if (!(from <= to))
        return span;
    double p = path->at.x + dx * from, q = path->at.x + dx * to;
    int32_t min_x = bin_steps(steps_per_m, (float)(maths_min(p, q) - reach));
    int32_t max_x = bin_steps(steps_per_m, (float)(maths_max(p, q) + reach));
    span.min_x = min_x > span.min_x ? min_x : span.min_x;
    span.max_x = max_x < span.max_x ? max_x : span.max_x;
    return span;
}

static struct sweep_and_prune_span span_in(const struct strips *strips, uint32_t tag,
                                           uint32_t strip)
{
    uint32_t row = tag & BIN_ROW;
    const struct path_box *box = &strips->box[row];
    if (!(tag & BIN_LONG))
        return (struct sweep_and_prune_span){bin_steps(strips->steps_per_m, box->min_x),
                                             bin_steps(strips->steps_per_m, box->max_x)};
    return sweep_and_prune_span(strips->steps_per_m, &strips->input->path[row], box,
                                strips->margin[strips->input->entities->row[row].kind], strip);
}

static bool spans_meet(struct sweep_and_prune_span p, struct sweep_and_prune_span q)
{
    return p.min_x <= q.max_x && q.min_x <= p.max_x;
}

/* --- what meets, exactly -----------------------------------------------------------------------*/

static uint32_t later(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Returns true if both bodies met in an earlier strip: bodies in several strips are a pair in the
 * first strip in which they meet. */
static bool met_before(const struct strips *strips, uint32_t a, uint32_t b, uint32_t strip)
{
    uint32_t first = later(bin_strip(strips->steps_per_m, strips->box[a & BIN_ROW].min_z),
                           bin_strip(strips->steps_per_m, strips->box[b & BIN_ROW].min_z));
    for (; first < strip; first++) {
        if (spans_meet(span_in(strips, a, first), span_in(strips, b, first)))
            return true;
    }
    return false;
}

/* Returns true if the bodies of two rows whose boxes meet cannot touch, because only corners of
 * their boxes meet. Of rows that cruise it has to be known what comes near to their boxes. */
static bool pass_by(const struct strips *strips, uint32_t a, uint32_t b)
{
    const struct entity *row = strips->input->entities->row;
    double margins_m = strips->margin[row[a].kind] + strips->margin[row[b].kind];
    return pair_filter_only_corners_meet(&strips->box[a], &strips->box[b], margins_m) &&
           !(strips->motion &&
             (body_motion_cruises(strips->motion, a) || body_motion_cruises(strips->motion, b)));
}

static void take_moving(const struct strips *strips, struct sweep_worker *sweeper, struct pair tags,
                        uint32_t strip)
{
    uint32_t p = tags.a & BIN_ROW, q = tags.b & BIN_ROW;
    uint32_t a = p < q ? p : q, b = p < q ? q : p;
    if (!pair_filter_boxes_meet(&strips->box[a], &strips->box[b]) ||
        (tags.a & tags.b & BIN_SPANS && met_before(strips, tags.a, tags.b, strip)) ||
        (tags.a & tags.b & BIN_REMOTE) ||
        ((tags.a | tags.b) & BIN_ROUND && pair_never_meets(strips->input->entities, a, b)) ||
        pass_by(strips, a, b))
        return;
    pair_list_add(&sweeper->pairs, a, b);
}

static bool met_object_before(const struct strips *strips, uint32_t tag,
                              const struct bin_record *object, uint32_t first, uint32_t strip)
{
    struct sweep_and_prune_span span = {object->min_x, object->max_x};
    for (first = later(first, bin_strip(strips->steps_per_m, strips->box[tag & BIN_ROW].min_z));
         first < strip; first++) {
        if (spans_meet(span_in(strips, tag, first), span))
            return true;
    }
    return false;
}

static void take_fixed(const struct strips *strips, struct sweep_worker *sweeper, uint32_t tag,
                       const struct bin_record *record, uint32_t strip)
{
    const struct method_input *input = strips->input;
    uint32_t row = tag & BIN_ROW, index = record->tag & BIN_OBJECT;
    const struct fixed_object *object = &input->world->fixed[index];
    if (tag & BIN_RESTS || !pair_filter_stands(input, index) ||
        !pair_filter_box_meets_fixed(input, &strips->box[row], object) ||
        (tag & record->tag & BIN_SPANS &&
         met_object_before(strips, tag, record,
                           static_boxes_strip(strips->fixed_boxes, input->world, object), strip)))
        return;
    /* An aircraft's path may not have been computed yet. */
    if (tag & BIN_AIR && strips->motion)
        body_motion_require(strips->motion, row);
    if (tag & BIN_AIR && !pair_filter_tests_fixed(input, row))
        return;
    pair_list_add(&sweeper->pairs, row, index | PAIR_FIXED);
}

static void take_candidates(struct sweep_worker *sweeper)
{
    const struct strips *strips = sweeper->strips;
    const struct pair *candidate = sweeper->candidate;
    uint32_t count = sweeper->candidates;
    for (uint32_t i = 0; i < count; i++) {
        if (i + PREFETCH_PAIRS < count) {
            __builtin_prefetch(&strips->box[candidate[i + PREFETCH_PAIRS].a & BIN_ROW]);
            __builtin_prefetch(&strips->box[candidate[i + PREFETCH_PAIRS].b & BIN_ROW]);
        }
        take_moving(strips, sweeper, candidate[i], sweeper->strip);
    }
    sweeper->candidates = 0;
    work_done();
}

/* --- gathering and sorting ---------------------------------------------------------------------*/

static void prefetch_chunk(const struct bin_chunk *chunk)
{
    for (uint32_t line = 0; chunk && line < BIN_CHUNK_BYTES; line += LINE_BYTES)
        __builtin_prefetch((const char *)chunk + line);
}

static void gather(const struct strips *strips, struct sweep_worker *sweeper, uint32_t strip)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < strips->sweepers; i++) {
        uint32_t count;
        const struct bin_chunk *chunk = strip_bins_last(&strips->sweeper[i].bins, strip, &count);
        for (; chunk; chunk = chunk->before, count = BIN_CHUNK_RECORDS) {
            prefetch_chunk(chunk->before_that);
            CHECK(count <= sweeper->capacity - total);
            memcpy(sweeper->record + total, chunk->record, count * sizeof *chunk->record);
            total += count;
        }
    }
    sweeper->count = total;
}

/* Divides what lies between two west edges into up to 2^bits buckets, and one. */
static void set_buckets(struct sweep_worker *sweeper, int32_t west, int32_t east, uint32_t bits)
{
    uint32_t across = 32 - (uint32_t)__builtin_clz((uint32_t)(east - west) | 1u);
    sweeper->shift = across > bits ? across - bits : 0;
    sweeper->first = (uint32_t)west >> sweeper->shift;
    sweeper->last = (uint32_t)east >> sweeper->shift;
}

/* Counts the records of each bucket, and collects their tags. */
static void count_records(struct sweep_worker *sweeper)
{
    uint32_t *bucket = sweeper->bucket, shift = sweeper->shift, first = sweeper->first;
    uint32_t count = sweeper->count, tags = 0;
    const struct bin_record *record = sweeper->record;
    memset(bucket, 0, (sweeper->last - first + 1) * sizeof *bucket);
    for (uint32_t i = 0; i < count; i++) {
        bucket[((uint32_t)record[i].min_x >> shift) - first]++;
        tags |= record[i].tag;
    }
    sweeper->tags = tags;
}

/* Returns true if the bucket of one of a few records holds many: each would be compared with all of
 * the others. */
static bool is_crowded(const struct sweep_worker *sweeper)
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct bin_record *record = &sweeper->record[(uint64_t)i * sweeper->count / SAMPLES];
        if (sweeper->bucket[((uint32_t)record->min_x >> sweeper->shift) - sweeper->first] > CROWDED)
            return true;
    }
    return false;
}

/* Chooses narrower buckets, and those only between the first and the last west edge: a heap of
 * vehicles fills a small part of its strip. */
static void set_narrow_buckets(struct sweep_worker *sweeper, uint32_t bits)
{
    int32_t west = INT32_MAX, east = 0;
    for (uint32_t i = 0; i < sweeper->count; i++) {
        int32_t x = sweeper->record[i].min_x;
        west = x < west ? x : west;
        east = x > east ? x : east;
    }
    set_buckets(sweeper, west, east, bits < BUCKET_BITS ? bits : BUCKET_BITS);
}

/* Returns where the records end that begin west of x, or in its bucket. */
static uint32_t end_at(const struct sweep_worker *sweeper, int32_t x)
{
    uint32_t key = (uint32_t)x >> sweeper->shift;
    if (key < sweeper->first)
        return 0;
    return sweeper->bucket[(key < sweeper->last ? key : sweeper->last) - sweeper->first];
}

/* Splits the records into one array for each word. All four words are copied, since gcc vectorises
 * nothing less. */
static void spread(const uint32_t *restrict word, int32_t *restrict min_x, int32_t *restrict max_x,
                   int32_t *restrict low_z, int32_t *restrict high_z, uint32_t *restrict tag)
{
    for (size_t k = 0; k < BLOCK; k++) {
        min_x[k] = (int32_t)word[4 * k];
        max_x[k] = (int32_t)word[4 * k + 1];
        low_z[k] = (int32_t)(word[4 * k + 2] & 0xffffu);
        high_z[k] = (int32_t)(word[4 * k + 2] >> 16);
        tag[k] = word[4 * k + 3];
    }
}

static void sort_records(struct sweep_worker *sweeper)
{
    const struct bin_record *record = sweeper->record;
    struct bin_record *sorted = sweeper->sorted;
    uint32_t count = sweeper->count, end = 0, bits = 5;
    while (1u << bits < count && bits < BUCKET_BITS)
        bits++;
    set_buckets(sweeper, 0, (1 << BIN_BITS) - 1, bits); /* as many as records, or more */
    count_records(sweeper);
    if (is_crowded(sweeper)) {
        set_narrow_buckets(sweeper, bits + NARROWER);
        count_records(sweeper);
    }
    uint32_t *bucket = sweeper->bucket, shift = sweeper->shift, first = sweeper->first;
    for (uint32_t i = 0; i <= sweeper->last - first; i++) {
        uint32_t more = bucket[i];
        bucket[i] = end;
        end += more;
    }
    for (uint32_t i = 0; i < count; i++)
        sorted[bucket[((uint32_t)record[i].min_x >> shift) - first]++] = record[i];
    for (uint32_t i = count; i < count + PADDING; i++)
        sorted[i] = (struct bin_record){.min_x = INT32_MAX, .max_x = INT32_MIN};
    for (uint32_t i = 0; i < count + BLOCK; i += BLOCK)
        spread((const void *)&sorted[i], sweeper->min_x + i, sweeper->max_x + i, sweeper->low_z + i,
               sweeper->high_z + i, sweeper->tag + i);
}

/* --- the sweep ---------------------------------------------------------------------------------*/

/* Sets hit[k] if record k meets the one `offset` after it. */
static void compare_neighbours(const int32_t *restrict min_x, const int32_t *restrict max_x,
                               const int32_t *restrict low_z, const int32_t *restrict high_z,
                               uint32_t offset, uint8_t *restrict hit)
{
    for (uint32_t k = 0; k < BLOCK; k++)
        hit[k] = (min_x[k + offset] <= max_x[k]) & (min_x[k] <= max_x[k + offset]) &
                 (low_z[k + offset] <= high_z[k]) & (low_z[k] <= high_z[k + offset]);
}

/* Sets hit[k] if record k meets this box. */
static void compare_with(const int32_t *restrict min_x, const int32_t *restrict max_x,
                         const int32_t *restrict low_z, const int32_t *restrict high_z,
                         const struct bin_record *restrict one, uint8_t *restrict hit)
{
    int32_t one_min = one->min_x, one_max = one->max_x;
    int32_t one_low = (int32_t)(one->z & 0xffffu), one_high = (int32_t)(one->z >> 16);
    for (uint32_t k = 0; k < BLOCK; k++)
        hit[k] = (min_x[k] <= one_max) & (one_min <= max_x[k]) & (low_z[k] <= one_high) &
                 (one_low <= high_z[k]);
}

/* Sets hit[k] if the bucket of record k's east edge holds records beyond its NEAR neighbours. */
static void compare_buckets(const int32_t *restrict min_x, const int32_t *restrict max_x,
                            uint32_t shift, uint8_t *restrict hit)
{
    for (uint32_t k = 0; k < BLOCK; k++)
        hit[k] = min_x[k + NEAR + 1] >> shift <= max_x[k] >> shift;
}

/* Lists the places of the bytes that are 1 and returns their number. */
static uint32_t list_hits(const uint8_t *hit, uint8_t *place)
{
    uint32_t count = 0;
    for (uint32_t word = 0; word < BLOCK; word += 8) {
        uint64_t bits;
        memcpy(&bits, hit + word, sizeof bits);
        for (; bits != 0; bits &= bits - 1)
            place[count++] = (uint8_t)(word + (uint32_t)__builtin_ctzll(bits) / 8);
    }
    return count;
}

static void found(struct sweep_worker *sweeper, uint32_t a, uint32_t b)
{
    if (a & b & BIN_RESTS)
        return;
    if (sweeper->candidates == SWEEP_AND_PRUNE_CANDIDATES)
        take_candidates(sweeper);
    sweeper->candidate[sweeper->candidates++] = (struct pair){a, b};
}

static void sweep_far(struct sweep_worker *sweeper, uint32_t i)
{
    uint8_t hit[BLOCK], place[BLOCK];
    const struct bin_record *one = &sweeper->sorted[i];
    uint32_t last = end_at(sweeper, one->max_x);
    for (uint32_t j = i + NEAR + 1; j < last; j += BLOCK) {
        compare_with(sweeper->min_x + j, sweeper->max_x + j, sweeper->low_z + j,
                     sweeper->high_z + j, one, hit);
        uint32_t hits = list_hits(hit, place);
        for (uint32_t n = 0; n < hits; n++)
            found(sweeper, one->tag, sweeper->tag[j + place[n]]);
    }
}

/* Compares each record of a block with its neighbours to the east. */
static void sweep_block(struct sweep_worker *sweeper, uint32_t i)
{
    uint8_t hit[BLOCK], place[BLOCK];
    for (uint32_t offset = 1; offset <= NEAR; offset++) {
        compare_neighbours(sweeper->min_x + i, sweeper->max_x + i, sweeper->low_z + i,
                           sweeper->high_z + i, offset, hit);
        uint32_t hits = list_hits(hit, place);
        for (uint32_t n = 0; n < hits; n++) {
            const uint32_t *tag = sweeper->tag + i + place[n];
            found(sweeper, tag[0], tag[offset]);
        }
    }
    compare_buckets(sweeper->min_x + i, sweeper->max_x + i, sweeper->shift, hit);
    uint32_t hits = list_hits(hit, place);
    for (uint32_t n = 0; n < hits; n++)
        sweep_far(sweeper, i + place[n]);
}

static void sweep_sorted(struct sweep_worker *sweeper)
{
    for (uint32_t i = 0; i < sweeper->count; i += BLOCK)
        sweep_block(sweeper, i);
}

static void sweep_few(struct sweep_worker *sweeper)
{
    const struct bin_record *record = sweeper->record;
    for (uint32_t i = 0; i + 1 < sweeper->count; i++) {
        for (uint32_t j = i + 1; j < sweeper->count; j++) {
            if (bin_meet(&record[i], &record[j]))
                found(sweeper, record[i].tag, record[j].tag);
        }
    }
}

/* --- bodies that rest --------------------------------------------------------------------------*/

static void meet_resting(const struct strips *strips, struct sweep_worker *sweeper, uint32_t strip)
{
    const struct resting_records *resting = strips->resting;
    for (uint32_t i = 0; i < sweeper->count; i++) {
        const struct bin_record *one = &sweeper->record[i];
        uint32_t count;
        if (one->tag & BIN_RESTS)
            continue;
        const struct bin_record *other =
            query_index_from(&resting->index, strip, one->min_x, one->max_x, &count);
        for (; count > 0; count--, other++) {
            if (bin_meet(one, other) && resting_records_holds(resting, other))
                found(sweeper, one->tag, other->tag);
        }
    }
}

/* --- fixed objects -----------------------------------------------------------------------------*/

/* Finds the objects that one record meets. Looks at a few at a time and without branches: as a rule
 * none is met, and the number of objects passed cannot be predicted. */
static void look_around(const struct strips *strips, struct sweep_worker *sweeper,
                        const struct bin_record *one, uint32_t strip)
{
    const struct bin_record *object = static_boxes_from(strips->fixed_boxes, strip, one->min_x);
    for (; object->min_x <= one->max_x; object += STATIC_BOXES_AHEAD) {
        uint32_t met = 0;
        for (uint32_t i = 0; i < STATIC_BOXES_AHEAD; i++)
            met |= (uint32_t)bin_meet(one, &object[i]) << i;
        for (; met != 0; met &= met - 1) {
            const struct bin_record *hit = &object[__builtin_ctz(met)];
            take_fixed(strips, sweeper, one->tag, hit, strip);
        }
    }
}

/* Finds the sorted records that one object meets, except wide ones. */
static void look_from(const struct strips *strips, struct sweep_worker *sweeper,
                      const struct bin_record *object, uint32_t strip)
{
    uint8_t hit[BLOCK], place[BLOCK];
    int32_t west = object->min_x - BIN_WIDE_STEPS - (1 << sweeper->shift);
    uint32_t end = end_at(sweeper, object->max_x);
    for (uint32_t i = west > 0 ? end_at(sweeper, west) : 0; i < end; i += BLOCK) {
        compare_with(sweeper->min_x + i, sweeper->max_x + i, sweeper->low_z + i,
                     sweeper->high_z + i, object, hit);
        uint32_t hits = list_hits(hit, place);
        for (uint32_t n = 0; n < hits; n++) {
            uint32_t tag = sweeper->tag[i + place[n]];
            if (!(tag & BIN_WIDE))
                take_fixed(strips, sweeper, tag, object, strip);
        }
    }
}

static void meet_fixed(const struct strips *strips, struct sweep_worker *sweeper, uint32_t strip)
{
    const struct static_boxes *fixed_boxes = strips->fixed_boxes;
    uint32_t first = fixed_boxes->start[strip],
             end = fixed_boxes->start[strip + 1] - STATIC_BOXES_AHEAD;
    bool crowded = sweeper->count >= SORT_LEAST && sweeper->count > end - first;
    if (first == end)
        return;
    for (uint32_t i = first; crowded && i < end; i++)
        look_from(strips, sweeper, &fixed_boxes->record[i], strip);
    if (crowded && !(sweeper->tags & BIN_WIDE))
        return;
    for (uint32_t i = 0; i < sweeper->count; i++) {
        const struct bin_record *one = &sweeper->record[i];
        if ((!crowded || one->tag & BIN_WIDE) && !(one->tag & BIN_RESTS))
            look_around(strips, sweeper, one, strip);
    }
}

VECTOR_CLONES void sweep_and_prune_pairs(const struct strips *strips, struct sweep_worker *sweeper,
                                         uint32_t strip)
{
    sweeper->strips = strips;
    sweeper->strip = strip;
    gather(strips, sweeper, strip);
    if (sweeper->count == 0)
        return;
    if (sweeper->count < SORT_LEAST) {
        sweep_few(sweeper);
    } else {
        sort_records(sweeper);
        sweep_sorted(sweeper);
    }
    if (strips->resting)
        meet_resting(strips, sweeper, strip);
    take_candidates(sweeper);
    if (strips->input->world->counts.fixed > 0)
        meet_fixed(strips, sweeper, strip);
}
