/* Responds to one contact at a time, in the order of time: the parties, the response's functions,
 * the event. */
#include "collider/response/response.h"

#include "collider/geometry/level_gap.h"
#include "collider/response/contact_table.h"
#include "collider/response/damage.h"
#include "collider/response/explosion.h"
#include "collider/response/ground_event.h"
#include "collider/response/island.h"
#include "collider/response/path_change.h"
#include "world/entity/kind.h"
#include "world/entity/persistent_contact.h"
#include "world/maths/maths.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

/* Bodies in contact that close no faster than this lean on each other or scrape along. */
#define LEANS_MPS 2.0

/* Bodies in contact that have not touched for this time have parted, and may strike each other
 * again [s]. */
#define PARTED_S 0.1

const struct response_functions *response_of(enum response_model model)
{
#define X(name, value, word, text) [MODEL_##name] = &response_##word,
    static const struct response_functions *const functions[] = {RESPONSE_MODELS(X)};
#undef X
    _Static_assert(sizeof functions / sizeof functions[0] == MODEL_COUNT, "a row each");
    return functions[model];
}

/* Tells the row's agent the heading away from the obstacle. */
static void set_bumped(struct response_context *context, uint32_t row, double away_x, double away_z)
{
    table_set_bumped(&context->writer, row, 1);
    table_set_bump_heading(&context->writer, row, (float)maths_heading(away_x, away_z));
}

/* Bodies on the ground push each other horizontally only: along the normal or, where that is too
 * steep, along the line between their positions. */
static struct vec3 level_normal(const struct response_context *context,
                                const struct contact *contact)
{
    struct vec3 level = {contact->impact.normal.x, 0.0, contact->impact.normal.z};
    double length = vec3_length(level);
    if (length < LEVEL_MIN) {
        struct vec3 a = path_at(&context->path[contact->a], contact->impact.toi), b;
        if (contact->b & PAIR_FIXED) {
            b = fixed_position(&context->world->fixed[contact->b & ~PAIR_FIXED]);
        } else {
            b = path_at(&context->path[contact->b], contact->impact.toi);
        }
        level = (struct vec3){b.x - a.x, 0.0, b.z - a.z};
        length = vec3_length(level);
    }
    return length > 0.0 ? vec3_scale(level, 1.0 / length) : (struct vec3){1.0, 0.0, 0.0};
}

/* Returns the velocity of the row's skin at the contact. */
static struct vec3 velocity_at(const struct response_context *context, uint32_t row,
                               const struct hull_contact *impact)
{
    struct vec3 w = path_change_spin(context, row, impact->toi);
    struct vec3 r = vec3_sub(impact->point, path_at(&context->path[row], impact->toi));
    return vec3_add(path_change_velocity(context, row, impact->toi), vec3_cross(w, r));
}

struct impact response_impact(const struct response_context *context, const struct contact *contact)
{
    const struct entities *e = &context->next->entities;
    struct impact impact = {.a = contact->a,
                            .b = contact->b,
                            .pair = contact->pair,
                            .time = contact->impact.toi,
                            .point = contact->impact.point,
                            .normal = contact->impact.normal,
                            .depth_m = contact->impact.depth_m};
    struct vec3 va = velocity_at(context, contact->a, &contact->impact), vb = {0.0, 0.0, 0.0};
    double other_heading;
    if (path_change_grounded(context, contact->a) &&
        (contact->b & PAIR_FIXED || path_change_grounded(context, contact->b)))
        impact.normal = level_normal(context, contact);
    if (contact->b & PAIR_FIXED) {
        other_heading = fixed_heading(&context->world->fixed[contact->b & ~PAIR_FIXED]);
    } else {
        vb = velocity_at(context, contact->b, &contact->impact);
        other_heading = e->row[contact->b].heading;
    }
    impact.closing_mps = maths_max(0.0, vec3_dot(vec3_sub(va, vb), impact.normal));
    impact.angle_rad = maths_wrap_turn(other_heading - e->row[contact->a].heading);
    return impact;
}

static struct event_party party_of(const struct response_context *context, uint32_t body)
{
    const struct entities *e = &context->next->entities;
    if (body & PAIR_FIXED) {
        uint32_t object = body & ~PAIR_FIXED;
        return (struct event_party){object + 1, context->world->fixed[object].kind, 1,
                                    (uint8_t)fallen_damage(context->next->fixed_damage[object])};
    }
    return (struct event_party){e->row[body].id, e->row[body].kind, 0, e->row[body].damage};
}

static void put(double to[3], struct vec3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/* Returns true if the pair has touched in this frame before. */
static bool has_touched(const struct response_context *context, const struct impact *impact)
{
    return impact->pair != 0 && context->contacts->marks[impact->pair - 1] & CONTACT_PRESSED;
}

static void remember(struct response_context *context, const struct impact *impact)
{
    if (impact->pair != 0)
        context->contacts->marks[impact->pair - 1] |= CONTACT_PRESSED;
}

bool passes_through(struct response_context *context, const struct impact *impact)
{
    if (!(impact->b & PAIR_FIXED) || !contact_table_lets_through(context, impact->b))
        return false;
    if (!has_touched(context, impact) && !contact_table_find(context, impact->a, impact->b))
        return false;
    remember(context, impact);
    return true;
}

enum impact_role response_role(struct response_context *context, const struct impact *impact)
{
    const struct persistent_contact *known = contact_table_find(context, impact->a, impact->b);
    bool before = has_touched(context, impact);
    remember(context, impact);
    bool slow = impact->closing_mps < LEANS_MPS || contact_table_lets_through(context, impact->b);
    if (!known && !before) {
        if (contact_table_begins(context, impact->pair))
            return IMPACT_BEGINS;
        return slow ? IMPACT_WITHIN : IMPACT_RENEWS;
    }
    if (slow)
        return IMPACT_LEANS;
    if (before)
        return IMPACT_WITHIN;
    uint32_t frames = (uint32_t)context->next->head->tick - known->pressed_tick - 1;
    return frames * context->world->params->dt_s < PARTED_S ? IMPACT_WITHIN : IMPACT_RENEWS;
}

static uint8_t damage_of(const struct response_context *context, uint32_t body)
{
    return party_of(context, body).damage;
}

static struct event *tell(struct response_context *context)
{
    context->next->head->tally.collisions++;
    return event_writer_event(&context->events, EVENT_COLLISION);
}

struct report response_report(struct response_context *context, const struct impact *impact,
                              enum impact_role role)
{
    struct vec3 direction = entities_velocity(&context->next->entities, impact->a);
    double speed = vec3_length(direction);
    bool told = role == IMPACT_BEGINS || role == IMPACT_RENEWS;
    return (struct report){.role = role,
                           .event = told ? tell(context) : NULL,
                           .damage = {damage_of(context, impact->a), damage_of(context, impact->b)},
                           .direction_a = speed > 0.0 ? vec3_scale(direction, 1.0 / speed)
                                                      : (struct vec3){0, 0, 0}};
}

static bool is_worse(const struct response_context *context, const struct report *report,
                     const struct impact *impact)
{
    return damage_of(context, impact->a) > report->damage[0] ||
           damage_of(context, impact->b) > report->damage[1];
}

/* Adds an impact to what its pair had in this frame. An overlap without an impact has no pair. */
static void add_impact(struct response_context *context, const struct impact *impact,
                       const struct outcome *outcome)
{
    if (impact->pair == 0)
        return;
    struct pair_impacts *impacts = &context->contacts->impacts[impact->pair - 1];
    impacts->count++;
    impacts->impulse_ns += (float)outcome->impulse_ns;
}

void write_collision_event(struct response_context *context, const struct report *report,
                           const struct impact *impact, const struct outcome *outcome)
{
    if (outcome->response == RESPONSE_STOP || outcome->response == RESPONSE_BOUNCE) {
        set_bumped(context, impact->a, -impact->normal.x, -impact->normal.z);
        if (!(impact->b & PAIR_FIXED))
            set_bumped(context, impact->b, impact->normal.x, impact->normal.z);
    }
    struct event *event = report->event;
    add_impact(context, impact, outcome);
    if (report->role == IMPACT_WITHIN && is_worse(context, report, impact))
        event = tell(context);
    if (!event)
        return;
    struct event_collision *collision = &event->collision;
    collision->a = party_of(context, impact->a);
    collision->b = party_of(context, impact->b);
    put(collision->point, impact->point);
    vec3_to_floats(collision->normal, impact->normal);
    vec3_to_floats(collision->direction_a, report->direction_a);
    collision->toi = impact->time;
    collision->closing_mps = (float)impact->closing_mps;
    collision->angle_deg = (float)(impact->angle_rad * DEG_PER_RAD);
    collision->impulse_ns = (float)outcome->impulse_ns;
    collision->response = outcome->response;
    collision->begins = report->role == IMPACT_BEGINS;
}

/* Ends the approach of bodies in a persistent contact: takes out their closing speed and conserves
 * momentum. */
static void end_approach(struct response_context *context, const struct impact *impact)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kinds = context->world->kinds;
    bool fixed = impact->b & PAIR_FIXED;
    double ma = kinds[e->row[impact->a].kind].mass_kg,
           mb = fixed ? 0.0 : kinds[e->row[impact->b].kind].mass_kg;
    double share = fixed ? 1.0 : mb / (ma + mb);
    const struct {
        uint32_t row;
        double push;
    } side[2] = {{impact->a, -share}, {impact->b, 1.0 - share}};
    for (int i = 0; i < (fixed ? 1 : 2); i++) {
        uint32_t row = side[i].row;
        struct vec3 push = vec3_scale(impact->normal, side[i].push * impact->closing_mps);
        const struct vec3 spin = path_change_spin(context, row, impact->time);
        path_change_leave(context, row, impact->time, path_at(&context->path[row], impact->time),
                          vec3_add(path_change_velocity(context, row, impact->time), push), spin,
                          false);
    }
    const uint32_t rows[2] = {impact->a, impact->b};
    path_change_swept(context, rows, fixed ? 1 : 2, impact->time);
}

static void collide(struct response_context *context, const struct contact *contact)
{
    const struct response_functions *functions = context->functions;
    response_function *answer = contact->b & PAIR_FIXED ? functions->fixed : functions->moving;
    struct impact impact = response_impact(context, contact);
    struct outcome outcome = {RESPONSE_NONE, 0.0};
    if (passes_through(context, &impact))
        return;
    enum impact_role role = response_role(context, &impact);
    if (role == IMPACT_LEANS) {
        if (answer)
            end_approach(context, &impact);
        return;
    }
    struct report report = response_report(context, &impact, role);
    if (answer)
        answer(context, &impact, &outcome);
    write_collision_event(context, &report, &impact, &outcome);
}

/* Returns the velocity of an aircraft at a time of the frame. The mover gave it that of the frame's
 * end; what it gains in the rest of the frame it does not have yet. */
static struct vec3 crash_velocity(const struct response_context *context, uint32_t row, double time)
{
    const struct body_motion *motion = context->motion;
    struct vec3 velocity = entities_velocity(&context->next->entities, row);
    if (!body_motion_old(motion, row) || motion->change[row] != 0)
        return velocity;
    return vec3_lerp(entities_velocity(&motion->before, row), velocity, time);
}

/* Destroys an aircraft that hits the ground. */
static void crash(struct response_context *context, const struct contact *contact)
{
    uint32_t row = contact->a;
    double time = contact->impact.toi;
    struct vec3 velocity = crash_velocity(context, row, time);
    struct vec3 at = path_at(&context->path[row], time);
    struct vec3 normal =
        terrain_normal(&context->world->terrain, context->input.detect.craters, at.x, at.z);
    /* Make it a wreck first: an aircraft that stays there would meet the ground again. The mover
     * gives the wreck the impulse of the ground, in the next frame. */
    damage_destroy(context, row, time);
    path_change_stay(context, row, time, velocity);
    ground_event_write(context, row,
                       &(struct ground_strike){
                           .at = at,
                           .velocity = velocity,
                           .normal = normal,
                           .closing_mps = maths_max(0.0, -vec3_dot(velocity, normal)),
                           .time = time,
                           .response = RESPONSE_DESTROYED,
                       });
}

static bool is_round(const struct response_context *context, uint32_t body)
{
    return body < PAIR_FIXED && context->next->entities.row[body].behaviour == BEHAVIOUR_FLIGHT;
}

void response_contact(struct response_context *context, const struct contact *contact)
{
    bool round_a = is_round(context, contact->a), round_b = is_round(context, contact->b);
    double time = contact->impact.toi;
    struct vec3 normal = contact->impact.normal;
    if (contact->b >= PAIR_FIXED && contact->b < CONTACT_AIR &&
        !pair_filter_stands(&context->input.detect, contact->b & ~PAIR_FIXED))
        return; /* it was destroyed earlier in this frame */
    if (round_a && round_b) {
        explosion_munition(context, contact->a, CONTACT_AIR, normal, time);
        explosion_munition(context, contact->b, CONTACT_AIR, normal, time);
    } else if (round_a) {
        explosion_munition(context, contact->a, contact->b, normal, time);
    } else if (round_b) {
        explosion_munition(context, contact->b, contact->a, vec3_scale(normal, -1.0), time);
    } else if (contact->b >= CONTACT_AIR) {
        crash(context, contact);
    } else if (context->functions->joint) {
        island_answer(context, contact);
    } else {
        collide(context, contact);
    }
    explosion_all(context);
}
