/* Fills boxes and records from the rows, a block of rows at a time and four rows at once. The
 * results are equal to the bit to those of body_motion_compute, pair_filter_box and the functions
 * of strip_bins.h. */
#include "collider/broad_phase/body_boxes.h"

#include "collider/motion/ground_impact.h"
#include "world/maths/cpu_dispatch.h"
#include "world/entity/entity.h"
#include "world/entity/remote.h"
#include "world/state.h"

#include <string.h>

#define BLOCK  64
#define AHEAD  24   /* rows from the prefetch of one to its use */
#define LONG_M 64.0 /* extent in x from which a path is clipped to its strips */

/* Not all bodies whose boxes meet theirs are pairs with such rows. */
#define NOT_ALL_FOUND (BIN_RESTS | BIN_ROUND | BIN_AIR | BIN_WIDE)

typedef double four __attribute__((vector_size(4 * sizeof(double))));
typedef int64_t four_masks __attribute__((vector_size(4 * sizeof(int64_t))));
typedef float four_metres __attribute__((vector_size(4 * sizeof(float))));
typedef int32_t four_steps __attribute__((vector_size(4 * sizeof(int32_t))));
typedef uint32_t four_words __attribute__((vector_size(4 * sizeof(uint32_t))));

#define CHOOSE(mask, yes, no) ((four)(((mask) & (four_masks)(yes)) | (~(mask) & (four_masks)(no))))
#define CHOOSE_METRES(mask, yes, no)                                                               \
    ((four_metres)(((mask) & (four_steps)(yes)) | (~(mask) & (four_steps)(no))))

#define SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)

_Static_assert(BLOCK == 64, "a word has a bit for each row of a block");
_Static_assert(sizeof(struct path_box) == 6 * sizeof(float), "a box is its six bounds");

struct block {
    /* Where the paths begin and end. */
    _Alignas(64) double at[3][BLOCK], to[3][BLOCK];
    double margin[BLOCK];
    uint32_t rests[BLOCK]; /* BIN_RESTS or 0 */
    uint64_t cruises;      /* a bit for each row that cruises */
    uint32_t tag[BLOCK];
    struct bin_record record[BLOCK];
    uint32_t strip[BLOCK];      /* STRIP_COUNT: the row is in several strips */
    struct path_box box[BLOCK]; /* used for a block that is not full */
};

/* --- ways --------------------------------------------------------------------------------------*/

static inline void put_path(struct block *block, uint32_t k, const struct path *path)
{
    struct vec3 to = path_at(path, 1.0);
    block->at[0][k] = path->at.x;
    block->at[1][k] = path->at.y;
    block->at[2][k] = path->at.z;
    block->to[0][k] = to.x;
    block->to[1][k] = to.y;
    block->to[2][k] = to.z;
}

/* Reads the ends from the computed paths. */
static void take_paths(struct block *block, const struct path *path, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        __builtin_prefetch(&path[k + AHEAD]);
        put_path(block, k, &path[k]);
        block->rests[k] = pair_filter_rests(&path[k]) ? BIN_RESTS : 0;
    }
}

/* Reads the ends from the rows. A new row begins where it ends. */
static void take_places(struct block *block, const struct body_motion *motion, uint32_t first,
                        uint32_t count)
{
    const struct entity *w = motion->committed->entities.row + first;
    const struct entity *n = motion->next->entities.row + first;
    for (uint32_t k = 0; k < count; k++) {
        const struct entity *at = body_motion_old(motion, first + k) ? &w[k] : &n[k];
        __builtin_prefetch(&w[k + AHEAD]);
        __builtin_prefetch(&n[k + AHEAD]);
        block->at[0][k] = at->x;
        block->at[1][k] = at->y;
        block->at[2][k] = at->z;
        block->to[0][k] = n[k].x;
        block->to[1][k] = n[k].y;
        block->to[2][k] = n[k].z;
    }
}

/* Makes the paths of rows that cruise those of their stretches. */
static void take_stretches(const struct body_boxes *rows, struct block *block, uint32_t first,
                           uint32_t count)
{
    const uint64_t tick = rows->motion->next->head->tick - 1;
    const struct entity *row = rows->motion->next->entities.row + first;
    block->cruises = 0;
    for (uint32_t k = 0; k < count; k++)
        block->cruises |= (uint64_t)(row[k].cruise_tick > tick) << k;
    for (uint64_t bits = block->cruises; bits != 0; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(bits);
        struct path path = body_motion_stretch(rows->motion, first + k);
        put_path(block, k, &path);
    }
}

/* Marks the rows whose path has no length and that do not turn. */
static void find_resting(const struct body_boxes *rows, struct block *block, uint32_t first,
                         uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        if (block->rests[k] && body_motion_rotates(rows->motion, first + k))
            block->rests[k] = 0;
    }
}

/* --- boxes and records -------------------------------------------------------------------------*/

static void take_kinds(const struct body_boxes *rows, struct block *block, uint32_t first,
                       uint32_t count)
{
    const struct entity *row = rows->input->entities->row + first;
    for (uint32_t k = 0; k < count; k++) {
        __builtin_prefetch(&row[k + AHEAD].kind);
        uint32_t kind = row[k].state != ENTITY_FREE ? row[k].kind : 0;
        block->margin[k] = rows->margin[kind];
        if (rows->wider && rows->wider[first + k] != BODY_BOX_EXACT)
            block->margin[k] += BODY_BOX_WIDER_M;
        block->tag[k] = (first + k) | rows->flags[kind];
        if (rows->flags[kind] & BIN_AIR && rows->input->heights)
            __builtin_prefetch(
                &rows->input->heights
                     ->bound[gridsquare_of(&rows->input->heights->squares, row[k].x, row[k].z)]);
    }
}

/* bin_steps() of four. */
static inline four_steps steps_of(float steps_per_m, four_metres metres)
{
    const four_metres none = {0}, last = {BIN_LAST, BIN_LAST, BIN_LAST, BIN_LAST};
    four_metres steps = metres * steps_per_m;
    steps = CHOOSE_METRES(steps > none, steps, none);
    steps = CHOOSE_METRES(steps < last, steps, last);
    return __builtin_convertvector(steps, four_steps);
}

/* Writes the bounds of four rows into four boxes; low and high hold x, y, z. */
static void put_boxes(struct path_box *box, const four_metres low[3], const four_metres high[3])
{
    four_metres xy_01 = SHUFFLE(low[0], low[1], 0, 4, 1, 5);
    four_metres xy_23 = SHUFFLE(low[0], low[1], 2, 6, 3, 7);
    four_metres zx_01 = SHUFFLE(low[2], high[0], 0, 4, 1, 5);
    four_metres zx_23 = SHUFFLE(low[2], high[0], 2, 6, 3, 7);
    four_metres yz_01 = SHUFFLE(high[1], high[2], 0, 4, 1, 5);
    four_metres yz_23 = SHUFFLE(high[1], high[2], 2, 6, 3, 7);
    const four_metres bounds[6] = {
        SHUFFLE(xy_01, zx_01, 0, 1, 4, 5), SHUFFLE(yz_01, xy_01, 0, 1, 6, 7),
        SHUFFLE(zx_01, yz_01, 2, 3, 6, 7), SHUFFLE(xy_23, zx_23, 0, 1, 4, 5),
        SHUFFLE(yz_23, xy_23, 0, 1, 6, 7), SHUFFLE(zx_23, yz_23, 2, 3, 6, 7)};
    memcpy(box, bounds, sizeof bounds);
}

/* Writes the bounds of four rows into four records. */
static void put_records(struct block *block, uint32_t k, four_steps west, four_steps east,
                        four_steps north, four_steps south)
{
    four_words strip = (four_words)north / BIN_STRIP_STEPS;
    four_words edge = strip * BIN_STRIP_STEPS;
    four_words low = (four_words)north - edge, high = (four_words)south - edge;
    four_words z = low | high << 16;
    four_words wide = (four_words)(east - west > BIN_WIDE_STEPS) & BIN_WIDE;
    for (uint32_t i = 0; i < 4; i++) {
        block->record[k + i] =
            (struct bin_record){west[i], east[i], z[i], block->tag[k + i] | wide[i]};
        block->strip[k + i] = high[i] < BIN_STRIP_STEPS ? strip[i] : STRIP_COUNT;
    }
}

/* Computes boxes and records from the ends. moved: the ends are positions, and the path leads from
 * one to the other as in body_motion_path. count: rows, to which up to three are added. Rows whose
 * path has no length are marked; returns true if there are any. */
static bool bound_rows(struct block *block, bool moved, float steps_per_m, struct path_box *box,
                       uint32_t count)
{
    four_masks any = {0};
    for (uint32_t k = 0; k < count; k += 4) {
        const four margin = *(const four *)(const void *)&block->margin[k];
        four_metres low[3], high[3];
        four_masks rests = {-1, -1, -1, -1};
        for (int axis = 0; axis < 3; axis++) {
            four at, to;
            memcpy(&at, &block->at[axis][k], sizeof at);
            memcpy(&to, &block->to[axis][k], sizeof to);
            four along = to - at;
            rests &= along == 0.0;
            to = moved ? at + along : to;
            low[axis] = __builtin_convertvector(CHOOSE(at < to, at, to) - margin, four_metres);
            high[axis] = __builtin_convertvector(CHOOSE(at > to, at, to) + margin, four_metres);
        }
        any |= rests;
        for (uint32_t i = 0; moved && i < 4; i++)
            block->rests[k + i] = (uint32_t)rests[i] & BIN_RESTS;
        put_boxes(&box[k], low, high);
        put_records(block, k, steps_of(steps_per_m, low[0]), steps_of(steps_per_m, high[0]),
                    steps_of(steps_per_m, low[2]), steps_of(steps_per_m, high[2]));
    }
    return any[0] | any[1] | any[2] | any[3];
}

/* --- into strips -------------------------------------------------------------------------------*/

static void add_spanning(const struct body_boxes *rows, struct strip_bins *bins,
                         struct bin_record record)
{
    uint32_t row = record.tag & BIN_ROW;
    const struct path_box *box = &rows->box[row];
    double margin = rows->margin[rows->input->entities->row[row].kind];
    bool is_long = false;
    record.tag |= BIN_SPANS;
    if (record.tag & BIN_WIDE) {
        struct path path =
            rows->motion ? body_motion_path(rows->motion, row) : rows->input->path[row];
        is_long = fabs(path.along.x) > LONG_M;
    }
    if (is_long)
        record.tag |= BIN_LONG;
    if (rows->motion && record.tag & (BIN_LONG | BIN_AIR))
        body_motion_require(rows->motion, row);
    uint32_t last = bin_strip(rows->steps_per_m, box->max_z);
    for (uint32_t strip = bin_strip(rows->steps_per_m, box->min_z); strip <= last; strip++) {
        if (is_long) {
            struct sweep_and_prune_span span = sweep_and_prune_span(
                rows->steps_per_m, &rows->input->path[row], box, margin, strip);
            record.min_x = span.min_x;
            record.max_x = span.max_x;
        }
        record.z = bin_z(rows->steps_per_m, box->min_z, box->max_z, strip);
        strip_bins_add(bins, strip, record);
    }
}

/* Adds the row to the fliers if it can reach the ground or is a round. An aircraft that cruises
 * cannot (mover/motion/aircraft.c). */
static void add_flier(const struct body_boxes *rows, struct sweep_worker *sweeper,
                      const struct block *block, uint32_t k, uint32_t tag)
{
    const struct method_input *input = rows->input;
    uint32_t row = tag & BIN_ROW;
    struct vec3 at = {block->at[0][k], block->at[1][k], block->at[2][k]};
    struct vec3 to = {block->to[0][k], block->to[1][k], block->to[2][k]};
    if (!(tag & BIN_ROUND) && rows->motion) {
        double lower = ground_impact_lower(input->world, input->entities->row[row].kind);
        at.y -= lower;
        to.y -= lower;
    }
    if (input->entities->row[row].state != ENTITY_ACTIVE ||
        (!(tag & BIN_ROUND) && input->entities->row[row].flags & ENTITY_FLAG_LANDED) ||
        (!(tag & BIN_ROUND) && input->heights &&
         square_bounds_clear(input->heights, input->craters, at, to)))
        return;
    if (rows->motion)
        body_motion_require(rows->motion, row);
    pair_list_add(&sweeper->fliers, row, 0);
}

/* Adds the record of row k of the block, which is row `row` of the table and is in use. */
static void add_row(const struct body_boxes *rows, struct sweep_worker *sweeper,
                    const struct block *block, uint32_t k, uint32_t row)
{
    const struct entities *e = rows->input->entities;
    struct bin_record record = block->record[k];
    bool flies = e->row[row].behaviour == BEHAVIOUR_FLIGHT;
    record.tag |= block->rests[k] | (flies ? BIN_ROUND : 0) |
                  (e->row[row].behaviour == BEHAVIOUR_REMOTE ? BIN_REMOTE : 0);
    if (flies && remote_is_munition(e, row))
        record.tag |= BIN_REMOTE | BIN_AIR;
    if (rows->wider && rows->wider[row] != BODY_BOX_EXACT)
        rows->wider[row] = record.tag & NOT_ALL_FOUND ? BODY_BOX_ASKED : BODY_BOX_WIDER;
    if (block->strip[k] < STRIP_COUNT)
        strip_bins_add(&sweeper->bins, block->strip[k], record);
    else
        add_spanning(rows, &sweeper->bins, record);
    if (record.tag & (BIN_ROUND | BIN_AIR) && !(block->cruises >> k & 1))
        add_flier(rows, sweeper, block, k, record.tag);
}

/* --- blocks ------------------------------------------------------------------------------------*/

/* Rows first .. first + count - 1, at most BLOCK. What is in the way of an old stretch was found
 * when it began. */
static void bin_block(const struct body_boxes *rows, struct block *block,
                      struct sweep_worker *sweeper, uint32_t first, uint32_t count)
{
    struct path_box *box = rows->box + first, *to = count < BLOCK ? block->box : box;
    const struct entity *row = rows->input->entities->row + first;
    take_kinds(rows, block, first, count);
    if (rows->motion) {
        take_places(block, rows->motion, first, count);
        if (rows->awake)
            take_stretches(rows, block, first, count);
        if (bound_rows(block, true, rows->steps_per_m, to, BLOCK))
            find_resting(rows, block, first, count);
    } else {
        take_paths(block, rows->input->path + first, count);
        bound_rows(block, false, rows->steps_per_m, to, BLOCK);
    }
    if (count < BLOCK)
        memcpy(box, block->box, count * sizeof *box);
    uint64_t old = rows->awake ? block->cruises & ~rows->awake[first / 64] : 0;
    for (uint32_t k = 0; k < count; k++) {
        if (row[k].state != ENTITY_FREE && !(old >> k & 1))
            add_row(rows, sweeper, block, k, first + k);
    }
}

/* Takes a row into the block. Its path is that of its stretch if it cruises. */
static void take_row(const struct body_boxes *rows, struct block *block, uint32_t k, uint32_t row)
{
    const struct entities *e = rows->input->entities;
    bool cruises = rows->awake && body_motion_cruises(rows->motion, row);
    struct path path = cruises        ? body_motion_stretch(rows->motion, row)
                       : rows->motion ? body_motion_path(rows->motion, row)
                                      : rows->input->path[row];
    bool wider = rows->wider && rows->wider[row] != BODY_BOX_EXACT;
    put_path(block, k, &path);
    block->margin[k] = rows->margin[e->row[row].kind] + (wider ? BODY_BOX_WIDER_M : 0.0);
    block->tag[k] = row | rows->flags[e->row[row].kind];
    block->rests[k] = pair_filter_rests(&path) ? BIN_RESTS : 0;
    block->cruises |= (uint64_t)cruises << k;
}

VECTOR_CLONES void body_boxes_bin(const struct body_boxes *rows, struct sweep_worker *sweeper,
                                  uint32_t first, uint32_t end)
{
    struct block block = {0};
    for (uint32_t row = first; row < end; row += BLOCK)
        bin_block(rows, &block, sweeper, row, end - row < BLOCK ? end - row : BLOCK);
}

VECTOR_CLONES void body_boxes_bin_some(const struct body_boxes *rows, struct sweep_worker *sweeper,
                                       uint32_t first, uint64_t some)
{
    struct block block;
    uint32_t row[BLOCK], count = 0;
    block.cruises = 0;
    for (; some != 0; some &= some - 1) {
        uint32_t i = first + (uint32_t)__builtin_ctzll(some);
        if (rows->input->entities->row[i].state == ENTITY_FREE)
            continue;
        row[count] = i;
        take_row(rows, &block, count++, i);
    }
    for (uint32_t k = count; k % 4 != 0; k++) /* of rows that are not there */
        take_row(rows, &block, k, row[0]);
    bound_rows(&block, false, rows->steps_per_m, block.box, count);
    for (uint32_t k = 0; k < count; k++) {
        rows->box[row[k]] = block.box[k];
        add_row(rows, sweeper, &block, k, row[k]);
    }
}
