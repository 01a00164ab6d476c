/* One contact at a time, in the order of time: who met whom, which model answers, and the event. */
#include "collider/respond.h"

int respond_stay(struct respond *respond, uint32_t row, double time, struct vec3 velocity)
{
    struct path *path = &respond->path[row];
    struct vec3 at = path_at(path, time);
    *path = (struct path){.at = at, .along = {0.0, 0.0, 0.0}, .since = time};
    entities_set_position(&respond->next->entities, row, at);
    entities_set_velocity(&respond->next->entities, row, velocity);
    return contacts_change(respond->contacts, &respond->input, row, time);
}

int respond_slow(struct respond *respond, uint32_t row, double time, double share)
{
    struct entities *e = &respond->next->entities;
    struct path *path = &respond->path[row];
    struct vec3 at = path_at(path, time);
    *path = (struct path){.at = at, .along = vec3_scale(path->along, share), .since = time};
    entities_set_position(e, row, path_at(path, 1.0));
    entities_set_velocity(e, row, vec3_scale(entities_velocity(e, row), share));
    return contacts_change(respond->contacts, &respond->input, row, time);
}

void respond_bump(struct respond *respond, uint32_t row, double away_x, double away_z)
{
    struct entities *e = &respond->next->entities;
    e->bumped[row] = 1;
    e->bump_heading[row] = (float)maths_heading(away_x, away_z);
}

static struct impact impact_of(const struct respond *respond, const struct contact *contact)
{
    const struct entities *e = &respond->next->entities;
    const struct world *world = respond->world;
    struct impact impact = {.a = contact->a, .b = contact->b, .time = contact->toi};
    struct vec3 pa = path_at(&respond->path[contact->a], contact->toi);
    struct vec3 va = entities_velocity(e, contact->a);
    struct vec3 pb, vb = {0.0, 0.0, 0.0};
    double other_heading;
    if (contact->b & PAIR_FIXED) {
        const struct fixed_object *object = &world->fixed[contact->b & ~PAIR_FIXED];
        pb = (struct vec3){object->x, (double)object->y, object->z};
        other_heading = (double)object->turn * (TWO_PI / 65536.0);
    } else {
        pb = path_at(&respond->path[contact->b], contact->toi);
        vb = entities_velocity(e, contact->b);
        other_heading = e->heading[contact->b];
    }
    struct vec3 between = vec3_sub(pb, pa);
    double distance = vec3_length(between);
    impact.normal = distance > 0.0 ? vec3_scale(between, 1.0 / distance)
                                   : (struct vec3){0.0, 1.0, 0.0}; /* centre in centre: any way */
    impact.point =
        vec3_add(pa, vec3_scale(impact.normal, world->kinds[e->kind[contact->a]].radius_m));
    impact.closing_mps = maths_max(0.0, vec3_dot(vec3_sub(va, vb), impact.normal));
    impact.angle_rad = maths_wrap_turn(other_heading - e->heading[contact->a]);
    return impact;
}

static int answer(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    bool fixed = impact->b & PAIR_FIXED;
    switch ((enum response_model)respond->world->params->collision.response) {
    case MODEL_FIGURE8:
        return fixed ? figure8_fixed(respond, impact, outcome)
                     : figure8_moving(respond, impact, outcome);
    case MODEL_IMPULSE:
        return fixed ? impulse_fixed(respond, impact, outcome)
                     : impulse_moving(respond, impact, outcome);
    default:
        return 0;
    }
}

static struct event_party party_of(const struct respond *respond, uint32_t body)
{
    const struct entities *e = &respond->next->entities;
    if (body & PAIR_FIXED) {
        uint32_t object = body & ~PAIR_FIXED;
        return (struct event_party){object + 1, respond->world->fixed[object].kind, 1,
                                    respond->next->fixed_damage[object]};
    }
    return (struct event_party){e->id[body], e->kind[body], 0, e->damage[body]};
}

static void put(double to[3], struct vec3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

static void put_float(float to[3], struct vec3 from)
{
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
}

/* Bodies that touched a moment ago and press on each other no harder than an engine's start: that
 * is one long contact, told of when it began. */
#define LEAN_S 0.25

/* How the other side of a contact is remembered: an entity by its id, which no slot change blurs.
 */
static uint32_t body_mark(const struct respond *respond, uint32_t body)
{
    return body & PAIR_FIXED ? body : respond->next->entities.id[body];
}

static bool touched(const struct respond *respond, uint32_t row, uint32_t mark)
{
    const struct entities *e = &respond->next->entities;
    uint64_t age = respond->next->head->tick - e->touch_tick[row];
    return e->touch_body[row] == mark && (double)age * respond->world->params->dt_s <= LEAN_S;
}

static bool leans(const struct respond *respond, const struct impact *impact)
{
    return impact->closing_mps < lean_mps(respond->world->params->dt_s) &&
           (touched(respond, impact->a, body_mark(respond, impact->b)) ||
            (!(impact->b & PAIR_FIXED) &&
             touched(respond, impact->b, body_mark(respond, impact->a))));
}

static void remember(struct respond *respond, const struct impact *impact)
{
    struct entities *e = &respond->next->entities;
    uint32_t tick = (uint32_t)respond->next->head->tick;
    e->touch_body[impact->a] = body_mark(respond, impact->b);
    e->touch_tick[impact->a] = tick;
    if (!(impact->b & PAIR_FIXED)) {
        e->touch_body[impact->b] = body_mark(respond, impact->a);
        e->touch_tick[impact->b] = tick;
    }
}

/* The row goes on from time with this velocity instead of the one that it came with; the boxes of
 * the broad phase leave room for a change of up to lean_mps(). */
static int go_on(struct respond *respond, uint32_t row, double time, struct vec3 velocity)
{
    struct entities *e = &respond->next->entities;
    struct path *path = &respond->path[row];
    struct vec3 change = vec3_sub(velocity, entities_velocity(e, row));
    *path = (struct path){
        .at = path_at(path, time),
        .along = vec3_add(path->along, vec3_scale(change, respond->world->params->dt_s)),
        .since = time};
    entities_set_position(e, row, path_at(path, 1.0));
    entities_set_velocity(e, row, velocity);
    return contacts_change(respond->contacts, &respond->input, row, time);
}

/* Leaning bodies only stop pressing: what each brings along the normal is taken out, shared so that
 * momentum stays. */
static int lean(struct respond *respond, const struct impact *impact)
{
    const struct entities *e = &respond->next->entities;
    const struct kind *kinds = respond->world->kinds;
    double ma = kinds[e->kind[impact->a]].mass_kg;
    bool fixed = impact->b & PAIR_FIXED;
    double share = 1.0;
    if (!fixed) {
        double mb = kinds[e->kind[impact->b]].mass_kg;
        share = mb / (ma + mb);
        struct vec3 push = vec3_scale(impact->normal, (1.0 - share) * impact->closing_mps);
        if (go_on(respond, impact->b, impact->time,
                  vec3_add(entities_velocity(e, impact->b), push)) != 0)
            return -1;
    }
    struct vec3 held = vec3_scale(impact->normal, share * impact->closing_mps);
    return go_on(respond, impact->a, impact->time, vec3_sub(entities_velocity(e, impact->a), held));
}

/* The event's place is taken before the answer, so that what follows from it comes after it. */
static int collide(struct respond *respond, const struct contact *contact)
{
    struct entities *e = &respond->next->entities;
    struct impact impact = impact_of(respond, contact);
    struct outcome outcome = {RESPONSE_NONE, 0.0};
    bool leaning = leans(respond, &impact);
    remember(respond, &impact);
    if (leaning)
        return respond->world->params->collision.response != MODEL_NONE ? lean(respond, &impact)
                                                                        : 0;
    struct event *event = sink_event(&respond->sink, EVENT_COLLISION);
    struct vec3 direction = entities_velocity(e, contact->a);
    double speed = vec3_length(direction);
    respond->next->head->tally.collisions++;
    if (answer(respond, &impact, &outcome) != 0)
        return -1;
    if (outcome.response == RESPONSE_STOP || outcome.response == RESPONSE_BOUNCE) {
        respond_bump(respond, impact.a, -impact.normal.x, -impact.normal.z);
        if (!(impact.b & PAIR_FIXED))
            respond_bump(respond, impact.b, impact.normal.x, impact.normal.z);
    }
    if (!event)
        return 0;
    struct event_collision *collision = &event->collision;
    collision->a = party_of(respond, impact.a);
    collision->b = party_of(respond, impact.b);
    put(collision->point, impact.point);
    put_float(collision->normal, impact.normal);
    if (speed > 0.0)
        put_float(collision->direction_a, vec3_scale(direction, 1.0 / speed));
    collision->toi = impact.time;
    collision->closing_mps = (float)impact.closing_mps;
    collision->angle_deg = (float)(impact.angle_rad * DEG_PER_RAD);
    collision->impulse_ns = (float)outcome.impulse_ns;
    collision->response = outcome.response;
    return 0;
}

/* An aircraft meets the ground. */
static int crash(struct respond *respond, const struct contact *contact)
{
    struct entities *e = &respond->next->entities;
    struct vec3 velocity = entities_velocity(e, contact->a);
    struct event *event = sink_event(&respond->sink, EVENT_COLLISION);
    struct vec3 at = path_at(&respond->path[contact->a], contact->toi);
    struct vec3 normal =
        terrain_normal(&respond->world->terrain, respond->input.craters, at.x, at.z);
    respond->next->head->tally.collisions++;
    struct vec3 slide = vec3_sub(velocity, vec3_scale(normal, vec3_dot(velocity, normal)));
    /* A wreck first: what still flies would meet the ground again where it stays. */
    if (harm_destroy(respond, contact->a, contact->toi) != 0 ||
        respond_stay(respond, contact->a, contact->toi, vec3_scale(slide, 0.3)) != 0)
        return -1;
    if (event) {
        event->collision.a = party_of(respond, contact->a);
        event->collision.b = (struct event_party){0, KIND_NONE, 1, DAMAGE_NONE};
        put(event->collision.point, respond->path[contact->a].at);
        put_float(event->collision.normal, vec3_scale(normal, -1.0));
        event->collision.toi = contact->toi;
        event->collision.closing_mps = (float)maths_max(0.0, -vec3_dot(velocity, normal));
        event->collision.response = RESPONSE_DESTROYED;
    }
    return 0;
}

static bool is_round(const struct respond *respond, uint32_t body)
{
    return body < PAIR_FIXED && respond->next->entities.behaviour[body] == BEHAVIOUR_FLIGHT;
}

int respond_contact(struct respond *respond, const struct contact *contact)
{
    bool round_a = is_round(respond, contact->a), round_b = is_round(respond, contact->b);
    if (contact->b >= PAIR_FIXED && contact->b < CONTACT_AIR &&
        respond->next->fixed_damage[contact->b & ~PAIR_FIXED] >= DAMAGE_HIGH)
        return 0; /* it fell earlier in this frame */
    int result;
    if (round_a && round_b) {
        result = blast_munition(respond, contact->a, CONTACT_AIR, contact->toi);
        if (result == 0)
            result = blast_munition(respond, contact->b, CONTACT_AIR, contact->toi);
    } else if (round_a) {
        result = blast_munition(respond, contact->a, contact->b, contact->toi);
    } else if (round_b) {
        result = blast_munition(respond, contact->b, contact->a, contact->toi);
    } else if (contact->b >= CONTACT_AIR) {
        result = crash(respond, contact);
    } else {
        result = collide(respond, contact);
    }
    return result == 0 ? blast_all(respond) : -1;
}
