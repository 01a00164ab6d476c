/* From PDUs to records: Fire, Detonation and Collision. */
#include "gateway/remote_input_internal.h"

#define SHOTS_A_SECOND 1000u

#define MASS_MOST_KG 1e9f

/* Collisions and munitions number their events apart. */
#define COLLISION_EVENT ((uint64_t)1 << 48)

/* --- Fire and Detonation -----------------------------------------------------------------------*/

/* Writes the record of a shot. place: where it was in the world, NULL: nobody knows. */
static void put_shot(struct remote_input *input, struct view *view,
                     const struct remote_record *record, const struct vec3 *place, uint64_t now_ns)
{
    struct told_event shot = event_memory_of(record, now_ns);
    shot.placed = place != NULL;
    shot.place = place ? *place : (struct vec3){0};
    if (event_memory_has(&input->heard, &shot)) {
        input->repeated++;
        return;
    }
    if (!rate_take(&input->shots, SHOTS_A_SECOND, SHOTS_A_SECOND, now_ns)) {
        input->refused[REMOTE_INPUT_SHOTS]++;
        return;
    }
    if (remote_input_append(input, view, *record) != 0) {
        input->refused[REMOTE_INPUT_RING]++;
        return;
    }
    event_memory_note(&input->heard, &shot);
    if (record->type == REMOTE_FIRE)
        input->fires++;
    else
        input->struck++;
}

static uint32_t slot_of(const struct remote_input *input, uint64_t remote)
{
    const struct remote_entry *entry = remote ? remote_table_find(&input->table, remote) : NULL;
    return entry ? entry->track.slot : SLOT_NONE;
}

void remote_input_fire(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       uint64_t now_ns)
{
    const struct pdu_fire *fire = &pdu->fire;
    struct vec3 place = remote_input_place(input, fire->location);
    uint16_t kind = remote_input_kind(input, fire->munition_type, true);
    struct remote_record record = {.remote = id_of(fire->firer),
                                   .event = id_of(fire->event),
                                   .type = REMOTE_FIRE,
                                   .slot = slot_of(input, id_of(fire->firer)),
                                   .entity = entity_ids_back(&input->own, fire->target),
                                   .kind = kind,
                                   .position = {place.x, place.y, place.z}};
    if (kind == KIND_NONE)
        input->refused[REMOTE_INPUT_TYPE]++;
    else if (remote_input_in_world(input, place))
        put_shot(input, view, &record, &place, now_ns);
}

/* Returns how far a munition has flown, by the Fire of its event, or from who fired it. 0 when
 * neither is known: it is then taken for one from a muzzle right here. */
static double flown_of(const struct remote_input *input, uint64_t event, uint64_t firer,
                       struct vec3 to, uint64_t now_ns)
{
    const struct told_event *fire = event_memory_fire(&input->heard, event, firer, now_ns);
    const struct remote_entry *entry = firer ? remote_table_find(&input->table, firer) : NULL;
    if (fire)
        return vec3_length(vec3_sub(to, fire->place));
    return entry && entry->placed ? vec3_length(vec3_sub(to, entry->place)) : 0.0;
}

/* A munition that detonates is no longer in flight. */
static void end_flight(struct remote_input *input, struct view *view, uint64_t munition,
                       const struct udp_address *from, uint64_t now_ns)
{
    struct remote_entry *entry = munition ? remote_table_find(&input->table, munition) : NULL;
    if (entry && remote_input_owns(input, entry, from, now_ns) &&
        view->world.kinds[entry->track.kind].domain == DOMAIN_MUNITION && entry->track.remote != 0)
        remote_input_lose(input, view, entry);
}

/* Returns true if a detonation has the result that it was near something. What has struck the
 * ground may be told of some metres above ours, as the ground of its owner is another. */
static bool bursts_in_air(uint8_t result)
{
    return result == PDU_RESULT_ENTITY_PROXIMATE || result == PDU_RESULT_GROUND_PROXIMATE ||
           result == PDU_RESULT_OBJECT_PROXIMATE || result == PDU_RESULT_AIR_BURST;
}

static bool detonates(uint8_t result)
{
    return result != PDU_RESULT_DUD && (result < PDU_RESULT_MISS || result > PDU_RESULT_MISS_LAST);
}

void remote_input_detonation(struct remote_input *input, struct view *view, const struct pdu *pdu,
                             const struct udp_address *from, uint64_t now_ns)
{
    const struct pdu_detonation *detonation = &pdu->detonation;
    uint16_t kind = remote_input_kind(input, detonation->munition_type, true);
    struct vec3 place = remote_input_place(input, detonation->location);
    struct remote_record record = {.remote = id_of(detonation->firer),
                                   .event = id_of(detonation->event),
                                   .type = REMOTE_STRUCK,
                                   .slot = slot_of(input, id_of(detonation->firer)),
                                   .entity = entity_ids_back(&input->own, detonation->target),
                                   .kind = kind,
                                   .model =
                                       bursts_in_air(detonation->result) ? REMOTE_BURST_IN_AIR : 0};
    end_flight(input, view, id_of(detonation->munition), from, now_ns);
    record.flown_m = (float)flown_of(input, record.event, record.remote, place, now_ns);
    bool hits = record.entity != 0 && detonation->result == PDU_RESULT_ENTITY_IMPACT;
    if (!detonates(detonation->result))
        return;
    if (kind == KIND_NONE) {
        input->refused[REMOTE_INPUT_TYPE]++;
        return;
    }
    if (!remote_input_in_world(input, place))
        return;
    struct vec3 at = place;
    /* Where it is in the body of our vehicle holds also if we have the vehicle elsewhere. */
    if (hits)
        place = local_frame_body_from_dis(vec3_limited(vec3_of(detonation->point), 1e3));
    else
        record.entity = 0;
    record.position[0] = place.x;
    record.position[1] = place.y;
    record.position[2] = place.z;
    const struct mat3 axes = local_frame_axes(input->frame, at);
    vec3_to_floats(record.velocity, rotation_back(&axes, vec3_limited(vec3_of(detonation->velocity),
                                                                      REMOTE_INPUT_SPEED_MPS)));
    put_shot(input, view, &record, &at, now_ns);
}

/* --- Collision ---------------------------------------------------------------------------------*/

void remote_input_met(struct remote_input *input, uint32_t entity, uint64_t remote, uint64_t now_ns)
{
    uint32_t at = input->met_count++ % REMOTE_INPUT_BODIES;
    input->met[at].entity = entity;
    input->met[at].remote = remote;
    input->met[at].heard_ns = now_ns;
}

static bool has_met(const struct remote_input *input, const struct remote_record *record,
                    uint64_t heard_ns)
{
    for (uint32_t i = 0; i < REMOTE_INPUT_BODIES; i++) {
        if (input->met[i].entity == record->entity && input->met[i].remote == record->remote &&
            input->met[i].heard_ns + (uint64_t)(REMOTE_INPUT_BEFORE_S * 1e9) > heard_ns)
            return true;
    }
    return false;
}

/* Lets a collision wait for our own collider. A free place has no time. */
static void await_collider(struct remote_input *input, const struct remote_record *record,
                           uint64_t now_ns)
{
    for (uint32_t i = 0; i < REMOTE_INPUT_BODIES; i++) {
        if (input->bodies[i].heard_ns != 0)
            continue;
        input->bodies[i].heard_ns = now_ns;
        input->bodies[i].record = *record;
        return;
    }
    input->refused[REMOTE_INPUT_BODY]++;
}

/* What a Collision and a Collision-Elastic say alike. */
struct body {
    struct pdu_id issuer, other, event;
    const float *velocity, *point;
    float mass_kg, restitution;
};

static struct body body_of(const struct pdu *pdu)
{
    const struct pdu_collision *c = &pdu->collision;
    const struct pdu_collision_elastic *e = &pdu->collision_elastic;
    if (pdu->header.type == PDU_COLLISION)
        return (struct body){c->issuer,
                             c->other,
                             c->event,
                             c->velocity,
                             c->point,
                             c->mass,
                             c->collision_type == 1 ? 1.0f : 0.0f};
    return (struct body){e->issuer, e->other, e->event,      e->velocity,
                         e->point,  e->mass,  e->restitution};
}

/* A collision of two of others is theirs. */
void remote_input_collision(struct remote_input *input, const struct pdu *pdu, uint64_t now_ns)
{
    struct body body = body_of(pdu);
    struct remote_record record = {.remote = id_of(body.issuer),
                                   .event =
                                       id_of(body.event) ? id_of(body.event) | COLLISION_EVENT : 0,
                                   .type = REMOTE_STRUCK,
                                   .slot = slot_of(input, id_of(body.issuer)),
                                   .entity = entity_ids_back(&input->own, body.other),
                                   .kind = KIND_NONE,
                                   .mass_kg = body.mass_kg,
                                   .restitution = body.restitution};
    if (record.entity == 0)
        return;
    if (!(body.mass_kg > 0.0f && body.mass_kg <= MASS_MOST_KG)) {
        input->refused[REMOTE_INPUT_BODY]++;
        return;
    }
    if (!(body.restitution >= 0.0f && body.restitution <= 1.0f))
        record.restitution = body.restitution > 1.0f ? 1.0f : 0.0f;
    struct vec3 point = local_frame_body_from_dis(vec3_limited(vec3_of(body.point), 1e3));
    record.position[0] = point.x;
    record.position[1] = point.y;
    record.position[2] = point.z;
    /* A Collision has no place: its axes are those at the body that strikes, where it is known. */
    const struct remote_entry *issuer = remote_table_find(&input->table, record.remote);
    const struct mat3 axes = issuer && issuer->placed
                                 ? local_frame_axes(input->frame, issuer->place)
                                 : input->frame->axes;
    vec3_to_floats(record.velocity, rotation_back(&axes, vec3_limited(vec3_of(body.velocity),
                                                                      REMOTE_INPUT_SPEED_MPS)));
    await_collider(input, &record, now_ns);
}

void remote_input_tell_bodies(struct remote_input *input, struct view *view, uint64_t now_ns)
{
    for (uint32_t i = 0; i < REMOTE_INPUT_BODIES; i++) {
        uint64_t heard_ns = input->bodies[i].heard_ns;
        if (heard_ns == 0)
            continue;
        bool met = has_met(input, &input->bodies[i].record, heard_ns);
        if (!met && now_ns - heard_ns < (uint64_t)(REMOTE_INPUT_AFTER_S * 1e9))
            continue;
        if (met)
            input->collisions++;
        else
            put_shot(input, view, &input->bodies[i].record, NULL, now_ns);
        input->bodies[i].heard_ns = 0;
    }
}
