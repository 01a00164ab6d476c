/* Columns of pairs, and lists of them by row. */
#include "collider/narrow_phase/contact_pairs.h"

#include "collider/narrow_phase/cruise_rows.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"

#include <string.h>

#define PAIRS_A_PIECE 256u

static void link_row(struct contact_queue *contacts, uint32_t row, uint32_t pair)
{
    contacts->link[contacts->link_count] = (struct contact_link){pair, contacts->head[row]};
    contacts->head[row] = ++contacts->link_count;
}

static void more_pairs(struct contact_queue *contacts)
{
    uint32_t held = contacts->pair_count, more = 2 * contacts->pair_capacity + 1;
    CHECK(held < PAIRS_MAX);
    contacts->pair = reserve_grow(contacts->pair, held, more, sizeof *contacts->pair);
    contacts->met = reserve_grow(contacts->met, held, more, sizeof *contacts->met);
    contacts->swept = reserve_grow(contacts->swept, held, more, sizeof *contacts->swept);
    contacts->marks = reserve_grow(contacts->marks, held, more, sizeof *contacts->marks);
    contacts->impacts = reserve_grow(contacts->impacts, held, more, sizeof *contacts->impacts);
    contacts->known = reserve_grow(contacts->known, held, more, sizeof *contacts->known);
    contacts->searched = reserve_grow(contacts->searched, held, more, sizeof *contacts->searched);
    contacts->rested =
        reserve_grow(contacts->rested, contacts->rested_count, more, sizeof *contacts->rested);
    contacts->due = reserve_grow(contacts->due, contacts->due_count, more, sizeof *contacts->due);
    contacts->rest = reserve_grow(contacts->rest, held, more, sizeof *contacts->rest);
    contacts->link = reserve_grow(contacts->link, contacts->link_count, 2 * (uint64_t)more,
                                  sizeof *contacts->link);
    contacts->pair_capacity = more;
}

/* Forgets what an earlier frame knew of pairs first .. end - 1. */
static void forget_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct contact_queue *contacts = context;
    uint32_t count = end - first;
    (void)worker;
    memset(&contacts->met[first], 0, count * sizeof *contacts->met);
    memset(&contacts->swept[first], 0, count * sizeof *contacts->swept);
    memset(&contacts->marks[first], 0, count * sizeof *contacts->marks);
    memset(&contacts->impacts[first], 0, count * sizeof *contacts->impacts);
    memset(&contacts->searched[first], 0, count * sizeof *contacts->searched);
    memset(&contacts->rest[first], 0, count * sizeof *contacts->rest);
    for (uint32_t i = first; i < end; i++)
        contacts->known[i] =
            (struct pair_known){.before_m = PAIR_NOT_MEASURED, .version_a = UINT32_MAX};
}

static void link_pair(struct contact_queue *contacts, uint32_t index)
{
    const struct pair *pair = &contacts->pair[index];
    link_row(contacts, pair->a, index);
    if (!(pair->b & PAIR_FIXED))
        link_row(contacts, pair->b, index);
}

void contact_pairs_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count)
{
    contacts->pair_count = contacts->link_count = 0;
    for (uint32_t i = 0; i < list_count; i++) {
        while (lists[i].count > contacts->pair_capacity - contacts->pair_count)
            more_pairs(contacts);
        for (uint32_t n = 0; n < lists[i].count; n++)
            contacts->pair[contacts->pair_count + n] = lists[i].pair[n];
        contacts->pair_count += lists[i].count;
    }
    thread_pool_run(contacts->workers, forget_some, contacts, contacts->pair_count, PAIRS_A_PIECE);
    for (uint32_t i = 0; i < contacts->pair_count; i++)
        link_pair(contacts, i);
}

uint32_t contact_pairs_add(struct contact_queue *contacts, struct pair pair)
{
    if (contacts->pair_count == contacts->pair_capacity)
        more_pairs(contacts);
    uint32_t index = contacts->pair_count++;
    contacts->pair[index] = pair;
    forget_some(contacts, index, index + 1, 0);
    link_pair(contacts, index);
    return index;
}

uint32_t contact_pairs_find(const struct contact_queue *contacts, const struct pair *pair)
{
    for (uint32_t link = contacts->head[pair->a]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        const struct pair *known = &contacts->pair[index];
        if (known->a == pair->a && known->b == pair->b)
            return index + 1;
    }
    return 0;
}

/* Notes with which rows the row is paired, or forgets it. Of a row in a crowd there are so many
 * that a search for each that it meets would cost more. */
static void note_partners(struct contact_queue *contacts, uint32_t row, uint8_t paired)
{
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        if (!(pair->b & PAIR_FIXED))
            contacts->paired[pair->a == row ? pair->b : pair->a] = paired;
    }
}

/* The row's partners have been noted. resting: two bodies that rest are a pair, too. */
static void meet(struct contact_queue *contacts, const struct contact_input *input, uint32_t row,
                 uint32_t other, bool resting)
{
    bool fixed = other & PAIR_FIXED;
    struct pair pair = {fixed || row < other ? row : other, fixed || row < other ? other : row};
    if (other == row || (fixed ? contact_pairs_find(contacts, &pair) : contacts->paired[other]))
        return;
    if (!fixed)
        body_motion_require(input->motion, other);
    if (fixed || (resting ? !pair_never_meets(input->detect.entities, pair.a, pair.b)
                          : !pair_excluded(&input->detect, pair.a, pair.b))) {
        contact_pairs_add(contacts, pair);
        if (!fixed)
            contacts->paired[other] = 1;
    }
}

static struct path_box box_union(const struct path_box *a, const struct path_box *b)
{
    return (struct path_box){
        a->min_x < b->min_x ? a->min_x : b->min_x, a->min_y < b->min_y ? a->min_y : b->min_y,
        a->min_z < b->min_z ? a->min_z : b->min_z, a->max_x > b->max_x ? a->max_x : b->max_x,
        a->max_y > b->max_y ? a->max_y : b->max_y, a->max_z > b->max_z ? a->max_z : b->max_z,
    };
}

/* Pairs the row with those rows that have left their boxes. */
static void meet_strayed(struct contact_queue *contacts, const struct contact_input *input,
                         uint32_t row, const struct path_box *box, bool resting)
{
    for (uint32_t i = 0; i < contacts->stray_count; i++) {
        if (pair_filter_boxes_meet(box, &input->broad->box[contacts->strayed[i]]))
            meet(contacts, input, row, contacts->strayed[i], resting);
    }
}

/* Pairs the row with all that its box meets. */
static void meet_near(struct contact_queue *contacts, const struct contact_input *input,
                      uint32_t row, const struct path_box *box, bool resting)
{
    cruise_rows_query(input, box, &contacts->near);
    uint32_t rows = contacts->near.count;
    broad_phase_query_fixed(input->broad, &input->detect, box, &contacts->near);
    for (uint32_t i = 0; i < contacts->near.count; i++) {
        const struct pair *near = &contacts->near.pair[i];
        meet(contacts, input, row, i < rows ? near->a : near->b, resting);
    }
}

void contact_pairs_look(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting, float wider_m)
{
    struct path_box *known = &input->broad->box[row];
    struct path_box box = pair_filter_box(&input->detect, row);
    box.min_x -= wider_m, box.max_x += wider_m;
    box.min_z -= wider_m, box.max_z += wider_m;
    bool strays = !pair_filter_box_within(&box, known);
    bool has_all = !strays && broad_phase_has_all(input->broad, row);
    contacts->near.count = 0;
    if (has_all && contacts->stray_count == 0)
        return;
    note_partners(contacts, row, 1);
    if (!has_all)
        meet_near(contacts, input, row, &box, resting);
    meet_strayed(contacts, input, row, &box, resting);
    note_partners(contacts, row, 0);
    if (!strays)
        return;
    if (!contacts->strays[row])
        contacts->strayed[contacts->stray_count++] = row;
    contacts->strays[row] = 1;
    *known = box_union(known, &box);
}
