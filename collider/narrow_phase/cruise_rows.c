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

static double margin_of(const struct contact_input *input, uint32_t row)
{
    const struct kind *kind = &input->motion->world->kinds[input->detect.entities->kind[row]];
    double margin = pair_filter_margin(input->motion->world, kind);
    return input->broad->wider[row] != BODY_BOX_EXACT ? margin + BODY_BOX_WIDER_M : margin;
}

/* The row's box in this frame, to the bit as the broad phase computes it anew. */
static struct path_box box_of(const struct contact_input *input, uint32_t row)
{
    struct path path = body_motion_cruises(input->motion, row)
                           ? body_motion_stretch(input->motion, row)
                           : body_motion_path(input->motion, row);
    return pair_filter_path_box(&path, margin_of(input, row));
}

/* The line that the row's body is within around_m of in this frame, or until its stretch ends. */
static struct body_line line_of(const struct contact_input *input, uint32_t row)
{
    struct body_line line;
    if (body_motion_cruises(input->motion, row)) {
        line = body_motion_line(input->motion, row);
    } else {
        struct path path = body_motion_path(input->motion, row);
        line = (struct body_line){.from = path.at, .to = path_at(&path, 1.0)};
    }
    line.around_m += margin_of(input, row);
    return line;
}

static struct body_line fixed_line(const struct contact_input *input, uint32_t object)
{
    const struct world *world = input->detect.world;
    struct vec3 at = fixed_position(&world->fixed[object]);
    return (struct body_line){.from = at,
                              .to = at,
                              .around_m = pair_filter_fixed_reach(world, &world->fixed[object]) +
                                          pair_filter_slack(world)};
}

/* Returns the square of the distance on the map from a point to a line [m2]. */
static double square_from(struct vec3 point, const struct body_line *line)
{
    double dx = line->to.x - line->from.x, dz = line->to.z - line->from.z;
    double x = point.x - line->from.x, z = point.z - line->from.z;
    double share = maths_nearest_share(x, z, dx, dz);
    x -= share * dx;
    z -= share * dz;
    return x * x + z * z;
}

/* Returns true if both points are on one side of the straight line through the ends of another
 * one. */
static bool beside(struct vec3 p, struct vec3 q, const struct body_line *line)
{
    double dx = line->to.x - line->from.x, dz = line->to.z - line->from.z;
    double a = dx * (p.z - line->from.z) - dz * (p.x - line->from.x);
    double b = dx * (q.z - line->from.z) - dz * (q.x - line->from.x);
    return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0);
}

/* Returns true if two bodies stay so near to their lines that they cannot meet on the map. Lines
 * that do not cross are nearest to each other at an end of one of them. */
static bool apart(const struct body_line *a, const struct body_line *b)
{
    double reach = a->around_m + b->around_m, square = reach * reach;
    return (beside(a->from, a->to, b) || beside(b->from, b->to, a)) &&
           square_from(a->from, b) > square && square_from(a->to, b) > square &&
           square_from(b->from, a) > square && square_from(b->to, a) > square;
}

/* Returns true unless the boxes or the lines of a pair, of which one cruises, are apart. */
static bool meet(const struct contact_input *input, const struct pair *pair)
{
    struct path_box a = box_of(input, pair->a);
    struct body_line first, second;
    if (pair->b & PAIR_FIXED) {
        uint32_t object = pair->b & ~PAIR_FIXED;
        if (!pair_filter_box_meets_fixed(&input->detect, &a, &input->detect.world->fixed[object]))
            return false;
        second = fixed_line(input, object);
    } else {
        struct path_box b = box_of(input, pair->b);
        if (!pair_filter_boxes_meet(&a, &b) ||
            pair_never_meets(input->detect.entities, pair->a, pair->b))
            return false;
        second = line_of(input, pair->b);
    }
    first = line_of(input, pair->a);
    return !apart(&first, &second);
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
