/* Ends the stretches of rows that may meet something. */
#include "collider/narrow_phase/cruise_rows.h"

#include "collider/narrow_phase/contact_queue.h"
#include "world/state.h"
#include "world/cruise_pose.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

void cruise_rows_stop(const struct contact_input *input, uint32_t row)
{
    struct body_motion *motion = input->motion;
    if (!body_motion_cruises(motion, row))
        return;
    cruise_pose_stop(&input->writer, motion->world, motion->craters, row, motion->next->head->tick);
    motion->computed[row] = 0;
}

/* The row's box in this frame, to the bit as the broad phase computes it anew. */
static struct path_box box_of(const struct contact_input *input, uint32_t row)
{
    const struct kind *kind = &input->motion->world->kinds[input->detect.entities->kind[row]];
    struct path path = body_motion_cruises(input->motion, row)
                           ? body_motion_stretch(input->motion, row)
                           : body_motion_path(input->motion, row);
    double margin = pair_filter_margin(input->motion->world, kind);
    if (input->broad->wider[row] != BODY_BOX_EXACT)
        margin += BODY_BOX_WIDER_M;
    return pair_filter_path_box(&path, margin);
}

static bool meet(const struct contact_input *input, const struct pair *pair)
{
    struct path_box a = box_of(input, pair->a), b;
    if (pair->b & PAIR_FIXED)
        return pair_filter_box_meets_fixed(&input->detect, &a,
                                           &input->detect.world->fixed[pair->b & ~PAIR_FIXED]);
    b = box_of(input, pair->b);
    return pair_filter_boxes_meet(&a, &b) &&
           !pair_never_meets(input->detect.entities, pair->a, pair->b);
}

static bool has_cruising(const struct contact_input *input, const struct pair *pair)
{
    return body_motion_cruises(input->motion, pair->a) ||
           (!(pair->b & PAIR_FIXED) && body_motion_cruises(input->motion, pair->b));
}

/* Stretches end after all pairs have been looked at, so that their order does not matter. */
void cruise_rows_take_pairs(const struct contact_input *input, struct pair_list *pairs)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pairs->count; i++) {
        const struct pair pair = pairs->pair[i];
        if (!has_cruising(input, &pair) || meet(input, &pair))
            pairs->pair[count++] = pair;
    }
    pairs->count = count;
    for (uint32_t i = 0; i < count; i++) {
        cruise_rows_stop(input, pairs->pair[i].a);
        if (!(pairs->pair[i].b & PAIR_FIXED))
            cruise_rows_stop(input, pairs->pair[i].b);
    }
}

/* Takes the rows out of the list, from number `since` on, that cruise and whose boxes do not meet
 * this one, and ends the stretches of the others. */
static void take_found(const struct contact_input *input, const struct path_box *box,
                       struct pair_list *found, uint32_t since)
{
    uint32_t count = since;
    for (uint32_t i = since; i < found->count; i++) {
        uint32_t row = found->pair[i].a;
        if (body_motion_cruises(input->motion, row)) {
            struct path_box its = box_of(input, row);
            if (!pair_filter_boxes_meet(box, &its))
                continue;
            cruise_rows_stop(input, row);
        }
        found->pair[count++] = found->pair[i];
    }
    found->count = count;
}

void cruise_rows_query(const struct contact_input *input, const struct path_box *box,
                       struct pair_list *found)
{
    uint32_t since = found->count;
    broad_phase_query(input->broad, &input->detect, box, found);
    take_found(input, box, found, since);
}

void cruise_rows_meet_written(const struct contact_input *input, struct pair_list *found)
{
    const struct broad_phase *broad = input->broad;
    const struct entities *e = input->detect.entities;
    for (uint32_t w = 0; w * 64 < input->detect.rows && broad->cruise.count > 0; w++) {
        for (uint64_t bits = ~broad->resting.same[w]; bits != 0; bits &= bits - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(bits);
            if (row >= input->detect.rows || e->state[row] == ENTITY_FREE)
                continue;
            const struct path ends = {.at = entities_position(e, row)};
            const struct kind *kind = &input->detect.world->kinds[e->kind[row]];
            double margin = pair_filter_margin(input->detect.world, kind);
            struct path_box box = pair_filter_path_box(&ends, margin);
            found->count = 0;
            cruise_index_query(&broad->cruise, &box, found);
            take_found(input, &box, found, 0);
        }
    }
    found->count = 0;
}
