/* The broad phase over gridsquares. */
#include "collider/broad.h"

#include "world/square.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_A_PIECE  2048
#define PREFETCH_ROWS 8
#define RUNS_A_PIECE  1024
#define INSERTION_MAX 32

int broad_init(struct broad *broad, const struct world *world, struct workers *workers)
{
    *broad = (struct broad){.world = world, .workers = workers};
    broad->box = malloc(world->params->capacity * sizeof *broad->box);
    if (!broad->box)
        return -1;
    return 0;
}

void broad_free(struct broad *broad)
{
    free(broad->box);
    free(broad->entry);
    free(broad->other);
    for (int i = 0; i < WORKERS_MAX; i++)
        free(broad->list[i].pair);
    *broad = (struct broad){0};
}

static struct square_box squares_of(const struct sweep_box *box)
{
    return square_box_of((double)box->min_x, (double)box->min_z, (double)box->max_x,
                         (double)box->max_z);
}

struct job {
    struct broad *broad;
    const struct detect_input *input;
    _Atomic int failed;
};

/* --- against fixed objects ---------------------------------------------------------------------*/

/* An object that reaches several of the row's squares is taken in the first that both touch. */
static bool first_common(const struct world *world, const struct square_box *squares,
                         const struct fixed_object *object, int32_t column, int32_t row)
{
    double r = detect_fixed_reach(world, object);
    int32_t x0 = square_axis(object->x - r), z0 = square_axis(object->z - r);
    return column == (x0 > squares->x0 ? x0 : squares->x0) &&
           row == (z0 > squares->z0 ? z0 : squares->z0);
}

static int fixed_pairs(struct job *job, uint32_t i, struct pair_list *list)
{
    const struct world *world = job->broad->world;
    const struct sweep_box *box = &job->broad->box[i];
    struct square_box squares = squares_of(box);
    for (int32_t row = squares.z0; row <= squares.z1; row++) {
        for (int32_t column = squares.x0; column <= squares.x1; column++) {
            const uint32_t *objects;
            uint32_t count = world_reach(world, square_index(column, row), &objects);
            for (uint32_t n = 0; n < count; n++) {
                const struct fixed_object *object = &world->fixed[objects[n]];
                if (!detect_stands(job->input, objects[n]) ||
                    !detect_box_meets_fixed(job->input, box, object) ||
                    !first_common(world, &squares, object, column, row))
                    continue;
                if (pair_list_add(list, i, objects[n] | PAIR_FIXED) != 0)
                    return -1;
            }
        }
    }
    return 0;
}

static void sweep_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    const struct detect_input *input = job->input;
    const struct world *world = job->broad->world;
    for (uint32_t i = first; i < end; i++) {
        if (i + PREFETCH_ROWS < end) {
            struct vec3 ahead = input->path[i + PREFETCH_ROWS].at;
            __builtin_prefetch(&world->reach_start[square_of(ahead.x, ahead.z)]);
        }
        if (!detect_there(input, i))
            continue;
        job->broad->box[i] = detect_box(input, i);
        if (!detect_tests_fixed(input, i))
            continue;
        if (fixed_pairs(job, i, &job->broad->list[worker]) != 0)
            atomic_store(&job->failed, 1);
    }
}

/* --- against moving bodies ---------------------------------------------------------------------*/

static int reserve_entries(struct broad *broad, uint32_t count)
{
    if (count <= broad->entry_capacity)
        return 0;
    uint32_t capacity = count + count / 2 + 1024;
    struct bin_entry *entry = realloc(broad->entry, capacity * sizeof *entry);
    if (!entry)
        return -1;
    broad->entry = entry;
    struct bin_entry *other = realloc(broad->other, capacity * sizeof *other);
    if (!other)
        return -1;
    broad->other = other;
    broad->entry_capacity = capacity;
    return 0;
}

static int bin_rows(struct broad *broad, const struct detect_input *input)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < input->rows; i++) {
        if (!detect_there(input, i))
            continue;
        struct square_box squares = squares_of(&broad->box[i]);
        uint32_t more = (uint32_t)((squares.x1 - squares.x0 + 1) * (squares.z1 - squares.z0 + 1));
        if (reserve_entries(broad, count + more) != 0)
            return -1;
        for (int32_t row = squares.z0; row <= squares.z1; row++) {
            for (int32_t column = squares.x0; column <= squares.x1; column++)
                broad->entry[count++] = (struct bin_entry){square_index(column, row), i};
        }
    }
    broad->entry_count = count;
    return 0;
}

/* Stable radix sort by square: 18 bits in two passes of 9. */
static void sort_entries(struct broad *broad)
{
    for (int pass = 0; pass < 2; pass++) {
        uint32_t start[513] = {0};
        int shift = pass * 9;
        for (uint32_t i = 0; i < broad->entry_count; i++)
            start[(broad->entry[i].square >> shift & 511u) + 1]++;
        for (int digit = 0; digit < 512; digit++)
            start[digit + 1] += start[digit];
        for (uint32_t i = 0; i < broad->entry_count; i++)
            broad->other[start[broad->entry[i].square >> shift & 511u]++] = broad->entry[i];
        struct bin_entry *swap = broad->entry;
        broad->entry = broad->other;
        broad->other = swap;
    }
}

/* Two boxes that share several squares meet in the first they share. */
static bool first_shared(const struct sweep_box *a, const struct sweep_box *b, uint32_t square)
{
    float min_x = a->min_x > b->min_x ? a->min_x : b->min_x;
    float min_z = a->min_z > b->min_z ? a->min_z : b->min_z;
    return square_of((double)min_x, (double)min_z) == square;
}

static int pair_up(struct job *job, const struct bin_entry *p, const struct bin_entry *q,
                   struct pair_list *list)
{
    const struct sweep_box *box = job->broad->box;
    uint32_t a = p->row < q->row ? p->row : q->row;
    uint32_t b = p->row < q->row ? q->row : p->row;
    if (!detect_boxes_meet(&box[a], &box[b]) || !first_shared(&box[a], &box[b], p->square) ||
        detect_apart(job->input, a, b))
        return 0;
    return pair_list_add(list, a, b);
}

/* Heap sort by west edge, for squares too crowded for insertion. Rows are told apart by number, so
 * the order is one. */
static bool west_of(const struct sweep_box *box, struct bin_entry p, struct bin_entry q)
{
    float px = box[p.row].min_x, qx = box[q.row].min_x;
    return px < qx || (!(qx < px) && p.row < q.row);
}

static void sift(const struct sweep_box *box, struct bin_entry *run, uint32_t root, uint32_t count)
{
    for (uint32_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && west_of(box, run[child], run[child + 1]))
            child++;
        if (!west_of(box, run[root], run[child]))
            return;
        struct bin_entry swap = run[root];
        run[root] = run[child];
        run[child] = swap;
        root = child;
    }
}

static void sort_run(const struct sweep_box *box, struct bin_entry *run, uint32_t count)
{
    if (count <= INSERTION_MAX) {
        for (uint32_t i = 1; i < count; i++) {
            struct bin_entry entry = run[i];
            uint32_t j = i;
            for (; j > 0 && west_of(box, entry, run[j - 1]); j--)
                run[j] = run[j - 1];
            run[j] = entry;
        }
        return;
    }
    for (uint32_t i = count / 2; i-- > 0;)
        sift(box, run, i, count);
    for (uint32_t end = count - 1; end > 0; end--) {
        struct bin_entry swap = run[0];
        run[0] = run[end];
        run[end] = swap;
        sift(box, run, 0, end);
    }
}

/* Sort and sweep along x within one square. */
static int square_pairs(struct job *job, struct bin_entry *run, uint32_t count,
                        struct pair_list *list)
{
    const struct sweep_box *box = job->broad->box;
    sort_run(box, run, count);
    for (uint32_t i = 0; i + 1 < count; i++) {
        for (uint32_t j = i + 1; j < count && box[run[j].row].min_x <= box[run[i].row].max_x; j++) {
            if (pair_up(job, &run[i], &run[j], list) != 0)
                return -1;
        }
    }
    return 0;
}

/* Squares that hold more than one row, as (first entry, entries), into the sort's second buffer. */
static uint32_t list_runs(struct broad *broad)
{
    const struct bin_entry *entry = broad->entry;
    struct bin_entry *runs = broad->other;
    uint32_t count = 0;
    for (uint32_t i = 0, end; i < broad->entry_count; i = end) {
        for (end = i + 1; end < broad->entry_count && entry[end].square == entry[i].square;)
            end++;
        if (end - i > 1)
            runs[count++] = (struct bin_entry){i, end - i};
    }
    return count;
}

static void meet_squares(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct broad *broad = job->broad;
    for (uint32_t i = first; i < end; i++) {
        struct bin_entry run = broad->other[i];
        if (square_pairs(job, &broad->entry[run.square], run.row, &broad->list[worker]) != 0)
            atomic_store(&job->failed, 1);
    }
}

int broad_pairs(struct broad *broad, const struct detect_input *input)
{
    struct job job = {.broad = broad, .input = input};
    for (int i = 0; i < WORKERS_MAX; i++)
        broad->list[i].count = 0;
    workers_run(broad->workers, sweep_rows, &job, input->rows, ROWS_A_PIECE);
    if (bin_rows(broad, input) != 0) {
        errno = ENOMEM;
        return -1;
    }
    sort_entries(broad);
    workers_run(broad->workers, meet_squares, &job, list_runs(broad), RUNS_A_PIECE);
    if (atomic_load(&job.failed)) {
        errno = ENOMEM;
        return -1;
    }
    return 0;
}

uint32_t broad_square(const struct broad *broad, uint32_t square, const struct bin_entry **first)
{
    uint32_t low = 0, high = broad->entry_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (broad->entry[middle].square < square)
            low = middle + 1;
        else
            high = middle;
    }
    uint32_t end = low;
    while (end < broad->entry_count && broad->entry[end].square == square)
        end++;
    *first = broad->entry + low;
    return end - low;
}
