/* Halvings of the step of one row after the other, until all of them stay. */
#include "collider/parting/made_way.h"

#include "world/world.h"

/* A row goes back until it is in somebody's way, to within a part of its step by so many halvings,
 * over all in so many passes at most: those behind it follow. It need not go back for less than
 * this [m]. */
#define HALVINGS 6u
#define PASSES   16u
#define ROOM_M   9e-3

/* The guard sends a row back to a half, a quarter or an eighth of its way, or farther. */
#define HALVED_MOST 3u
#define ROUNDING_M  1e-9

/* Puts a row so far on its step: a share of it. */
static void put_at(struct aircraft_parting *parting, const struct response_context *context,
                   uint32_t index, double share)
{
    struct aircraft_body *body = aircraft_parting_body(parting, parting->level_row[index]);
    body->body.path.at =
        vec3_add(body->home, vec3_scale(aircraft_parting_step(parting, context, index), share));
}

/* Returns true if a pair has less room than bodies at rest keep, where both are put: the search for
 * impacts takes what is nearer for a contact, which stops them. */
static bool is_narrow(const struct aircraft_parting *parting, const struct pair *pair)
{
    struct level_gap_memory memory = {0};
    struct level_gap gap;
    double apart_m;
    const struct turned_body a = aircraft_parting_turned(parting, pair->a),
                             b = aircraft_parting_turned(parting, pair->b);
    struct vec3 between = vec3_sub(b.body->path.at, a.body->path.at);
    double reach = a.body->bound_m + b.body->bound_m + CONTACT_REST_M;
    return vec3_dot(between, between) < reach * reach &&
           level_gap_find_more(&a, &b, CONTACT_REST_M, &gap, 1, &apart_m, &memory) > 0;
}

/* ended: the frame has, and any pair may have come near. Else only those that may by their steps.
 */
static bool is_in_the_way(const struct aircraft_parting *parting, uint32_t row, bool ended)
{
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        if ((pair->a == row || pair->b == row) && (ended || parting->pair[i].count > 0) &&
            is_narrow(parting, pair))
            return true;
    }
    return false;
}

/* Returns true if a row has a step to make way, and is in nobody itself. */
static bool makes_way(const struct aircraft_parting *parting, uint32_t index)
{
    const struct level_motion *pushed = &parting->level[index].pushed;
    uint32_t row = parting->level_row[index];
    return row != SLOT_NONE && aircraft_parting_body(parting, row)->in == 0 &&
           (pushed->x != 0.0 || pushed->z != 0.0);
}

/* Lets a row that makes way go no farther than somebody needs. Returns true if it goes less far. */
static bool draw_back(struct aircraft_parting *parting, const struct response_context *context,
                      uint32_t index, bool ended)
{
    struct level_motion *pushed = &parting->level[index].pushed;
    double far_m = vec3_length(aircraft_parting_step(parting, context, index));
    uint32_t row = parting->level_row[index];
    if (!makes_way(parting, index) || far_m <= ROOM_M)
        return false;
    double in = ROOM_M / far_m, out = 1.0;
    put_at(parting, context, index, in);
    if (is_in_the_way(parting, row, ended)) {
        for (uint32_t i = 0; i < HALVINGS; i++) {
            double middle = 0.5 * (in + out);
            put_at(parting, context, index, middle);
            if (is_in_the_way(parting, row, ended))
                in = middle;
            else
                out = middle;
        }
    } else {
        out = in;
    }
    put_at(parting, context, index, out);
    pushed->x *= out;
    pushed->z *= out;
    return out < 1.0;
}

static void draw_all_back(struct aircraft_parting *parting, const struct response_context *context,
                          bool ended)
{
    bool any = true;
    for (uint32_t pass = 0; any && pass < PASSES; pass++) {
        any = false;
        for (uint32_t n = 0; n < parting->levels; n++)
            any |= draw_back(parting, context, pass % 2 == 0 ? n : parting->levels - 1 - n, ended);
    }
}

/* The bounds of the steps are those of planes: beside them there may be room. */
void made_way_draw_back(struct aircraft_parting *parting, const struct response_context *context)
{
    for (uint32_t i = 0; i < parting->levels; i++) {
        uint32_t row = parting->level_row[i];
        if (row == SLOT_NONE)
            continue;
        aircraft_parting_body(parting, row)->home =
            entities_position(&context->next->entities, row);
        put_at(parting, context, i, 1.0);
    }
    draw_all_back(parting, context, false);
}

/* Returns which share of its path a row has kept: half of it, or less, if the guard has sent it
 * back. 0 if it does not end the frame on it. */
static double kept_of(const struct response_context *context, uint32_t row)
{
    const struct path *path = &context->path[row];
    struct vec3 at = entities_position(&context->next->entities, row);
    double keep = 1.0;
    if (context->motion->change[row] != 0)
        return 0.0;
    for (uint32_t i = 0; i <= HALVED_MOST; i++, keep *= 0.5) {
        struct vec3 there = vec3_add(path->at, vec3_scale(path->along, keep));
        if (vec3_length(vec3_sub(at, there)) < ROUNDING_M)
            return keep;
    }
    return 0.0;
}

/* Returns true if all that is near a row is listed, so that it is known what it may meet. */
static bool knows_all(const struct aircraft_parting *parting,
                      const struct response_context *context, uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        uint32_t other = pair->a == row ? pair->b : pair->a;
        if (other & PAIR_FIXED || (parting->rows.place[other] == 0 &&
                                   aircraft_parting_is_near(context, row, other, ROOM_M)))
            return false;
    }
    return true;
}

/* Finds how far a row has come to make way, and where it would be without. One that has met
 * something else, or is back where it began the frame, stays. */
static void find_home(struct aircraft_parting *parting, const struct response_context *context,
                      uint32_t index)
{
    struct level_motion *pushed = &parting->level[index].pushed;
    uint32_t row = parting->level_row[index];
    double keep = knows_all(parting, context, row) ? kept_of(context, row) : 0.0;
    pushed->x *= keep;
    pushed->z *= keep;
    aircraft_parting_body(parting, row)->home =
        vec3_sub(entities_position(&context->next->entities, row),
                 aircraft_parting_step(parting, context, index));
}

void made_way_settle(struct aircraft_parting *parting, struct response_context *context)
{
    if (parting->levels == 0)
        return;
    aircraft_parting_stand(parting, context, true);
    for (uint32_t i = 0; i < parting->levels; i++) {
        if (makes_way(parting, i))
            find_home(parting, context, i);
    }
    draw_all_back(parting, context, true);
    for (uint32_t i = 0; i < parting->levels; i++) {
        uint32_t row = parting->level_row[i];
        if (makes_way(parting, i))
            table_set_position(&context->writer, row,
                               aircraft_parting_body(parting, row)->body.path.at);
    }
}
