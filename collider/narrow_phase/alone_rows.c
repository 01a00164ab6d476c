/* The records of all rows are compared at first, if there are any. Each row that may have company
 * then has a query, whose result is only whether there is any. */
#include "collider/narrow_phase/alone_rows.h"

#include "collider/broad_phase/broad_phase.h"
#include "collider/broad_phase/record_overlaps.h"
#include "collider/narrow_phase/contact_queue.h"
#include "collider/narrow_phase/cruise_rows.h"
#include "world/params.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

#define ROWS_A_PIECE   256u
#define STRIPS_A_PIECE 4u

int alone_rows_init(struct alone_rows *rows, const struct world *world, struct thread_pool *workers)
{
    uint32_t threads = thread_pool_threads(workers), lists = 0;
    *rows = (struct alone_rows){.workers = workers,
                                .near = calloc(threads, sizeof *rows->near),
                                .alone = calloc(world->params->capacity, sizeof *rows->alone),
                                .company = calloc(world->params->capacity, sizeof *rows->company)};
    while (rows->near && lists < threads &&
           pair_list_init(&rows->near[lists], broad_phase_found_most(world)) == 0)
        lists++;
    if (rows->alone && rows->company && lists == threads)
        return 0;
    alone_rows_free(rows);
    errno = ENOMEM;
    return -1;
}

void alone_rows_free(struct alone_rows *rows)
{
    for (uint32_t i = 0; rows->near && i < thread_pool_threads(rows->workers); i++)
        pair_list_free(&rows->near[i]);
    free(rows->near);
    free(rows->alone);
    free(rows->company);
    *rows = (struct alone_rows){0};
}

struct job {
    struct alone_rows *rows;
    const struct contact_input *input;
    const uint32_t *row;
    bool compared; /* the records of all rows: rows->company tells which ones met */
};

static struct path_box box_of(const struct contact_input *input, uint32_t row)
{
    const struct body_motion *motion = input->motion;
    const struct kind *kind = &motion->world->kinds[input->detect.entities->row[row].kind];
    const struct path path =
        motion->computed[row] ? motion->path[row] : body_motion_path(motion, row);
    return pair_filter_path_box(&path, pair_filter_margin(motion->world, kind));
}

static bool is_alone(const struct job *job, uint32_t row, struct pair_list *near)
{
    const struct contact_input *input = job->input;
    const struct path_box box = box_of(input, row);
    if (!pair_filter_box_within(&box, &input->broad->box[row]))
        return false;
    if (job->compared && !atomic_load_explicit(&job->rows->company[row], memory_order_relaxed))
        return true;
    near->count = 0;
    broad_phase_query_fixed(input->broad, &input->detect, &box, near);
    if (near->count > 0)
        return false;
    broad_phase_query(input->broad, &input->detect, &box, near);
    for (uint32_t i = 0; i < near->count; i++) {
        uint32_t other = near->pair[i].a;
        if (other != row && cruise_rows_box_meets(input, other, &box))
            return false;
    }
    return true;
}

static void find_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = context;
    for (uint32_t i = first; i < end; i++)
        job->rows->alone[job->row[i]] = is_alone(job, job->row[i], &job->rows->near[worker]);
}

static void compare_strips(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = context;
    const struct broad_phase *broad = job->input->broad;
    (void)worker;
    for (uint32_t strip = first; strip < end; strip++)
        record_overlaps_find(&broad->index, &broad->fixed_boxes, strip, job->rows->company);
}

/* Compares the records of all rows, if each row has one. */
static void compare_records(struct job *job)
{
    const uint32_t rows = job->input->detect.rows;
    job->compared = broad_phase_has_records(job->input->broad, rows);
    if (!job->compared)
        return;
    for (uint32_t row = 0; row < rows; row++)
        atomic_store_explicit(&job->rows->company[row], 0, memory_order_relaxed);
    thread_pool_run(job->rows->workers, compare_strips, job, STRIP_COUNT, STRIPS_A_PIECE);
}

void alone_rows_find(struct alone_rows *rows, const struct contact_input *input,
                     const uint32_t *row, uint32_t count)
{
    struct job job = {rows, input, row, false};
    compare_records(&job);
    thread_pool_run(rows->workers, find_some, &job, count, ROWS_A_PIECE);
}
