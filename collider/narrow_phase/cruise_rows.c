/* Ends the stretches of rows that may meet something. */
#include "collider/narrow_phase/cruise_rows.h"

#include "collider/narrow_phase/contact_queue.h"
#include "world/cruise_pose.h"
#include "world/maths/sort.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <string.h>

#define LEAST_TICKS 6u /* a stretch that would be shorter ends at once */

/* Ends the stretch of the row at the tick if it cruises then. */
static void end_at(const struct contact_input *input, uint32_t row, uint64_t tick)
{
    struct body_motion *motion = input->motion;
    if (cruise_pose_end(&input->writer, motion->world, motion->craters, row, tick,
                        motion->next->head->tick))
        motion->computed[row] = 0;
}

void cruise_rows_stop(const struct contact_input *input, uint32_t row)
{
    if (body_motion_cruises(input->motion, row))
        end_at(input, row, input->motion->next->head->tick);
}

static double margin_of(const struct contact_input *input, uint32_t row)
{
    const struct kind *kind = &input->motion->world->kinds[input->detect.entities->row[row].kind];
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

/* Returns the tick at which the row's stretch ends; that of this frame if it does not cruise. */
static uint64_t end_of(const struct contact_input *input, uint32_t row)
{
    const struct body_motion *motion = input->motion;
    return body_motion_cruises(motion, row) ? motion->next->entities.row[row].cruise_tick
                                            : motion->next->head->tick;
}

/* The line that the row's body is within around_m of in this frame, or until its stretch ends, but
 * no longer than to the tick. Collisions will turn a body that has a wider box. */
static struct body_line line_of(const struct contact_input *input, uint32_t row, uint64_t tick)
{
    const struct body_motion *motion = input->motion;
    const double reach_m = margin_of(input, row);
    if (body_motion_cruises(motion, row)) {
        uint64_t end = end_of(input, row);
        return body_motion_line_around(motion, row, tick < end ? tick : end, reach_m);
    }
    if (input->broad->wider[row] == BODY_BOX_EXACT)
        return body_motion_frame_line(motion, row, reach_m);
    struct path path = body_motion_path(motion, row);
    return (struct body_line){.from = path.at, .to = path_at(&path, 1.0), .around_m = reach_m};
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

/* Returns true if the bodies of a pair, of which one cruises, may come near to each other where the
 * stretch of each of them goes on no longer than to its tick. */
static bool meet_until(const struct contact_input *input, const struct pair *pair, uint64_t a_tick,
                       uint64_t b_tick)
{
    const struct body_line first = line_of(input, pair->a, a_tick);
    const struct body_line second = pair->b & PAIR_FIXED ? fixed_line(input, pair->b & ~PAIR_FIXED)
                                                         : line_of(input, pair->b, b_tick);
    return !apart(&first, &second);
}

/* Returns true unless the boxes or the lines of a pair, of which one cruises, are apart. */
static bool meet(const struct contact_input *input, const struct pair *pair)
{
    struct path_box a = box_of(input, pair->a);
    if (pair->b & PAIR_FIXED) {
        const struct fixed_object *object = &input->detect.world->fixed[pair->b & ~PAIR_FIXED];
        if (!pair_filter_box_meets_fixed(&input->detect, &a, object))
            return false;
    } else {
        struct path_box b = box_of(input, pair->b);
        if (!pair_filter_boxes_meet(&a, &b) ||
            pair_never_meets(input->detect.entities, pair->a, pair->b))
            return false;
    }
    return meet_until(input, pair, UINT64_MAX, UINT64_MAX);
}

/* Returns true if a row moves in this frame, begins a stretch, or has a wider box. By the tables
 * alone: a process that wrote the row in the frame before finds more pairs of it than a new one. */
static bool comes(const struct contact_input *input, uint32_t row)
{
    const struct body_motion *motion = input->motion;
    const struct resting_records *resting = &input->broad->resting;
    return input->broad->wider[row] != BODY_BOX_EXACT || !body_motion_old(motion, row) ||
           ((resting_records_awake(resting, row) || resting_records_written(resting, row)) &&
            resting_records_pose_differs(&motion->committed->entities.row[row],
                                         &motion->next->entities.row[row]));
}

/* Returns true if neither row of a pair comes anywhere: whether they meet was found before. */
static bool both_stay(const struct contact_input *input, const struct pair *pair)
{
    return !comes(input, pair->a) && (pair->b & PAIR_FIXED || !comes(input, pair->b));
}

static bool has_cruising(const struct contact_input *input, const struct pair *pair)
{
    return body_motion_cruises(input->motion, pair->a) ||
           (!(pair->b & PAIR_FIXED) && body_motion_cruises(input->motion, pair->b));
}

/* Returns true if the row's stretch can be made shorter, and still leads the same way. */
static bool may_shorten(const struct contact_input *input, uint32_t row)
{
    const struct entities *e = &input->motion->next->entities;
    const uint64_t now = input->motion->next->head->tick;
    double left_s = cruise_left_s(e, row, now - 1, world_dt_s(input->motion->world));
    return body_motion_cruises(input->motion, row) &&
           cruise_off(e->row[row].cruise_rps, e->row[row].cruise_mps2, left_s) <= CRUISE_OFF_M;
}

/* Which stretches of a pair are made shorter; the other ones go on to their ends. */
struct cut {
    bool a, b;
};

static bool meet_if_cut(const struct contact_input *input, const struct pair *pair, struct cut cut,
                        uint64_t tick)
{
    return meet_until(input, pair, cut.a ? tick : UINT64_MAX, cut.b ? tick : UINT64_MAX);
}

/* Returns the tick up to which the stretches that are cut may go on: that of this frame if they
 * have to end now. It is the last one to an eighth of the time. */
static uint64_t last_apart(const struct contact_input *input, const struct pair *pair,
                           struct cut cut)
{
    const uint64_t now = input->motion->next->head->tick;
    uint64_t last = cut.a ? end_of(input, pair->a) : now;
    if (cut.b && end_of(input, pair->b) > last)
        last = end_of(input, pair->b);
    uint64_t most = last - now, least = most / 2;
    while (least >= LEAST_TICKS && meet_if_cut(input, pair, cut, now + least)) {
        most = least;
        least /= 2;
    }
    if (least < LEAST_TICKS)
        return now;
    for (uint64_t step = least / 2; step > least / 16; step /= 2) {
        if (least + step < most && !meet_if_cut(input, pair, cut, now + least + step))
            least += step;
    }
    return now + least;
}

/* Notes that the row's stretch must not go on beyond the tick. */
static void note_end(struct pair_list *ends, const struct contact_input *input, uint32_t row,
                     uint64_t tick)
{
    if (body_motion_cruises(input->motion, row) && end_of(input, row) > tick)
        pair_list_add(ends, row, (uint32_t)tick);
}

/* Notes which stretches of a pair that meets must not go on, and for how long: of two that cruise
 * that of the one which loses less by it. Returns false if both have to end now. */
static bool shorten_pair(const struct contact_input *input, const struct pair *pair,
                         struct pair_list *ends)
{
    const uint64_t now = input->motion->next->head->tick;
    const bool moves_b = !(pair->b & PAIR_FIXED);
    const bool a = may_shorten(input, pair->a), b = moves_b && may_shorten(input, pair->b);
    uint64_t a_tick = a ? last_apart(input, pair, (struct cut){.a = true}) : now;
    uint64_t b_tick = b ? last_apart(input, pair, (struct cut){.b = true}) : now;
    if (a_tick == now && b_tick == now) {
        uint64_t both = a && b ? last_apart(input, pair, (struct cut){true, true}) : now;
        note_end(ends, input, pair->a, both);
        if (moves_b)
            note_end(ends, input, pair->b, both);
        return both > now;
    }
    uint64_t a_loses = end_of(input, pair->a) - a_tick;
    if (b_tick == now || (a_tick > now && a_loses <= end_of(input, pair->b) - b_tick))
        note_end(ends, input, pair->a, a_tick);
    else
        note_end(ends, input, pair->b, b_tick);
    return true;
}

/* Ends are made after all pairs have been looked at, and each row's first one, so that their order
 * does not matter. */
void cruise_rows_take_pairs(const struct contact_input *input, struct pair_list *pairs,
                            struct pair_list *ends)
{
    uint32_t count = 0;
    ends->count = 0;
    for (uint32_t i = 0; i < pairs->count; i++) {
        const struct pair pair = pairs->pair[i];
        if (has_cruising(input, &pair) &&
            (both_stay(input, &pair) || !meet(input, &pair) || shorten_pair(input, &pair, ends)))
            continue;
        pairs->pair[count++] = pair;
    }
    pairs->count = count;
    sort_words(ends->pair, ends->count);
    for (uint32_t i = 0; i < ends->count; i++) {
        if (i == 0 || ends->pair[i].a != ends->pair[i - 1].a)
            end_at(input, ends->pair[i].a, ends->pair[i].b);
    }
}

bool cruise_rows_box_meets(const struct contact_input *input, uint32_t row,
                           const struct path_box *box)
{
    if (!body_motion_cruises(input->motion, row))
        return true;
    const struct path_box its = box_of(input, row);
    return pair_filter_boxes_meet(box, &its);
}

/* Takes the rows out of the list, from number `since` on, that cruise and whose boxes do not meet
 * this one, and ends the stretches of the others. */
static void take_found(const struct contact_input *input, const struct path_box *box,
                       struct pair_list *found, uint32_t since)
{
    uint32_t count = since;
    for (uint32_t i = since; i < found->count; i++) {
        uint32_t row = found->pair[i].a;
        if (!cruise_rows_box_meets(input, row, box))
            continue;
        cruise_rows_stop(input, row);
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

/* Ends the stretches of the rows that are found, if what is left of them is near to this line. */
static void stop_near(const struct contact_input *input, const struct path_box *box,
                      const struct body_line *line, const struct pair_list *found)
{
    for (uint32_t i = 0; i < found->count; i++) {
        const uint32_t row = found->pair[i].a;
        if (!body_motion_cruises(input->motion, row) || !cruise_rows_box_meets(input, row, box))
            continue;
        const struct body_line its = line_of(input, row, UINT64_MAX);
        if (!apart(line, &its))
            cruise_rows_stop(input, row);
    }
}

/* Ends the stretches that a row which stands there is in the way of. */
static void meet_standing(const struct contact_input *input, uint32_t row, struct pair_list *found)
{
    const struct entities *e = input->detect.entities;
    const double margin_m =
        pair_filter_margin(input->detect.world, &input->detect.world->kinds[e->row[row].kind]);
    const struct path ends = {.at = entities_position(e, row)};
    const struct path_box box = pair_filter_path_box(&ends, margin_m);
    const struct body_line line = body_motion_standing_line(input->motion, row, margin_m);
    found->count = 0;
    cruise_index_query(&input->broad->cruise, &box, found);
    stop_near(input, &box, &line, found);
}

/* A stretch that was made shorter was written, too, and is in nobody's way. */
void cruise_rows_meet_written(const struct contact_input *input, struct pair_list *found)
{
    const struct broad_phase *broad = input->broad;
    for (uint32_t w = 0; w * 64 < input->detect.rows && broad->cruise.count > 0; w++) {
        for (uint64_t bits = broad->resting.written[w]; bits != 0; bits &= bits - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(bits);
            if (row < input->detect.rows && input->detect.entities->row[row].state != ENTITY_FREE &&
                !body_motion_cruises(input->motion, row))
                meet_standing(input, row, found);
        }
    }
    found->count = 0;
}
