/* PDUs of events. */
#include "gateway/event_output.h"

#include "world/entity/remote.h"
#include "world/state.h"
#include "world/world.h"

#include <string.h>

void event_output_open(struct event_output *events, const struct view *view, uint64_t before)
{
    struct state_head head;
    uint64_t slots = view->header->event_slots;
    uint64_t commit = segment_load(&view->commit->commit);
    events->send_from_frame = before > 0 ? before + 1 : commit + 1;
    events->frame = commit;
    events->cursor = (struct event_cursor){0};
    if (snapshot_head(&head, view) == 0 && head.event_end > slots)
        events->cursor.next = head.event_end - slots;
}

/* --- who fired ---------------------------------------------------------------------------------*/

static void remember_shot(struct event_output *events, const struct event *event)
{
    const struct event_fire *fire = &event->fire;
    uint32_t place = fire->munition.id % EVENT_OUTPUT_SHOTS;
    events->shot[place].munition = fire->munition.id;
    events->shot[place].shooter = fire->shooter.id;
    events->shot[place].tick = event->tick;
    events->shot[place].muzzle = (struct vec3){fire->point[0], fire->point[1], fire->point[2]};
    events->shot[place].velocity = (struct vec3){0.0, 0.0, 0.0};
}

/* Remembers how the munitions fly, as those that have detonated have no row. */
static void remember_flights(struct event_output *events)
{
    const struct snapshot *snapshot = &events->entities->snapshot;
    const struct entities *e = &snapshot->entities;
    for (uint32_t row = 0; row < snapshot->head.used; row++) {
        if (e->row[row].behaviour != BEHAVIOUR_FLIGHT || e->row[row].state == ENTITY_FREE)
            continue;
        uint32_t place = e->row[row].id % EVENT_OUTPUT_SHOTS;
        if (events->shot[place].munition == e->row[row].id)
            events->shot[place].velocity = entities_velocity(e, row);
    }
}

/* Returns the velocity at which a munition has come to a point [m/s]: that of its last frame that
 * was seen, or the mean of its flight. */
static struct vec3 flight_velocity(const struct event_output *events, const struct world *world,
                                   uint32_t munition, const double point[3], uint64_t tick)
{
    uint32_t place = munition % EVENT_OUTPUT_SHOTS;
    const struct vec3 none = {0.0, 0.0, 0.0};
    if (munition == 0 || events->shot[place].munition != munition)
        return none;
    if (vec3_length(events->shot[place].velocity) > 0.0)
        return events->shot[place].velocity;
    struct vec3 way =
        vec3_sub((struct vec3){point[0], point[1], point[2]}, events->shot[place].muzzle);
    double time_s = (double)(tick - events->shot[place].tick) * world_dt_s(world);
    return time_s > 0.0 ? vec3_scale(way, 1.0 / time_s) : none;
}

static uint32_t shooter_of(const struct event_output *events, uint32_t munition)
{
    uint32_t place = munition % EVENT_OUTPUT_SHOTS;
    return munition != 0 && events->shot[place].munition == munition ? events->shot[place].shooter
                                                                     : 0;
}

/* --- what they say -----------------------------------------------------------------------------*/

static bool is_remote(const struct event_output *events, uint32_t id)
{
    uint32_t row = entity_output_row(events->entities, id);
    return row != SLOT_NONE && remote_is(&events->entities->snapshot.entities, row);
}

/* An entity of another simulator has the identifier by which its owner knows it. */
static struct pdu_id id_of(const struct event_output *events, uint32_t id)
{
    struct pdu_id to;
    (void)entity_ids_of(&events->entities->ids, id, &to);
    if (is_remote(events, id)) {
        uint32_t row = entity_output_row(events->entities, id);
        uint64_t remote = events->entities->snapshot.entities.row[row].driver;
        to = (struct pdu_id){(uint16_t)(remote >> 32), (uint16_t)(remote >> 16), (uint16_t)remote};
    }
    return to;
}

/* Rounds are no entities of DIS: they have no identifier there. */
static struct pdu_id munition_id(const struct event_output *events, const struct world *world,
                                 struct event_party munition)
{
    bool sent =
        munition.kind < world->counts.kinds && entity_output_sends(&world->kinds[munition.kind]);
    return id_of(events, sent ? munition.id : 0);
}

/* Fixed objects are none either. */
static struct pdu_id party_id(const struct event_output *events, struct event_party party)
{
    return id_of(events, party.fixed ? 0 : party.id);
}

static void set_place(double location[3], const struct event_output *events, const double point[3])
{
    struct vec3 ecef =
        local_frame_ecef(&events->entities->frame, (struct vec3){point[0], point[1], point[2]});
    location[0] = ecef.x;
    location[1] = ecef.y;
    location[2] = ecef.z;
}

/* Writes a velocity at a place of the world, by the clock as those of Entity States are. */
static void set_velocity(float to[3], const struct event_output *events, const double place[3],
                         struct vec3 velocity)
{
    double scale = events->entities->snapshot.head.time_scale;
    struct mat3 axes =
        local_frame_axes(&events->entities->frame, (struct vec3){place[0], place[1], place[2]});
    vec3_to_floats(to, vec3_scale(rotation_apply(&axes, velocity), scale));
}

/* Writes a point of the world in the body axes of an entity. */
static void set_point(float to[3], const struct event_output *events, struct event_party party,
                      const double point[3])
{
    uint32_t row = entity_output_row(events->entities, party.fixed ? 0 : party.id);
    if (row == SLOT_NONE)
        return;
    const struct entities *e = &events->entities->snapshot.entities;
    struct mat3 turn =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    struct vec3 from_middle =
        vec3_sub((struct vec3){point[0], point[1], point[2]}, entities_position(e, row));
    vec3_to_floats(to, local_frame_body_to_dis(rotation_back(&turn, from_middle)));
}

/* Munitions have one row for all forces. */
static const struct type_row *munition_type(const struct event_output *events,
                                            struct event_party munition)
{
    return type_table_row(events->entities->types, munition.kind, FORCE_NEUTRAL);
}

static void send_fire(struct event_output *events, const struct world *world,
                      const struct event_fire *fire)
{
    static struct pdu pdu;
    const struct entities *e = &events->entities->snapshot.entities;
    const struct type_row *type = munition_type(events, fire->munition);
    pdu.header.type = PDU_FIRE;
    pdu.fire = (struct pdu_fire){.firer = party_id(events, fire->shooter),
                                 .target = party_id(events, fire->target),
                                 .munition = munition_id(events, world, fire->munition),
                                 .event = id_of(events, fire->munition.id),
                                 .munition_type = type->type,
                                 .warhead = type->warhead,
                                 .fuse = type->fuse,
                                 .quantity = 1};
    set_place(pdu.fire.location, events, fire->point);
    uint32_t round = entity_output_row(events->entities, fire->munition.id);
    if (round != SLOT_NONE)
        set_velocity(pdu.fire.velocity, events, fire->point, entities_velocity(e, round));
    uint32_t target = entity_output_row(events->entities, fire->target.fixed ? 0 : fire->target.id);
    if (target != SLOT_NONE)
        pdu.fire.range = (float)vec3_length(
            vec3_sub(entities_position(e, target),
                     (struct vec3){fire->point[0], fire->point[1], fire->point[2]}));
    pdu_output_send(events->output, &pdu, 0.0);
}

static uint8_t result_of(const struct world *world, const struct event_detonation *detonation)
{
    static const uint8_t results[STRUCK_COUNT] = {[STRUCK_VEHICLE] = PDU_RESULT_ENTITY_IMPACT,
                                                  [STRUCK_FIXED] = PDU_RESULT_DETONATION,
                                                  [STRUCK_GROUND] = PDU_RESULT_GROUND_IMPACT,
                                                  [STRUCK_WATER] = PDU_RESULT_WATER,
                                                  [STRUCK_AIR] = PDU_RESULT_DETONATION};
    uint16_t kind = detonation->struck_party.kind;
    if (detonation->struck == STRUCK_FIXED && kind < world->counts.kinds &&
        world->kinds[kind].object_class == OBJECT_BUILDING)
        return PDU_RESULT_BUILDING;
    return detonation->struck < STRUCK_COUNT ? results[detonation->struck] : PDU_RESULT_OTHER;
}

static void send_detonation(struct event_output *events, const struct world *world,
                            const struct event *event)
{
    static struct pdu pdu;
    const struct event_detonation *detonation = &event->detonation;
    struct event_party munition = detonation->munition;
    const struct type_row *type = munition_type(events, munition);
    pdu.header.type = PDU_DETONATION;
    pdu.parts = 0;
    pdu.detonation = (struct pdu_detonation){
        .firer = id_of(events, shooter_of(events, munition.id)),
        .target = detonation->struck == STRUCK_VEHICLE ? party_id(events, detonation->struck_party)
                                                       : id_of(events, 0),
        .munition = munition_id(events, world, munition),
        .event = id_of(events, munition.id),
        .munition_type = type->type,
        .warhead = type->warhead,
        .fuse = type->fuse,
        .quantity = 1,
        .result = result_of(world, detonation)};
    set_place(pdu.detonation.location, events, detonation->point);
    set_velocity(pdu.detonation.velocity, events, detonation->point,
                 flight_velocity(events, world, munition.id, detonation->point, event->tick));
    if (detonation->struck == STRUCK_VEHICLE)
        set_point(pdu.detonation.point, events, detonation->struck_party, detonation->point);
    pdu_output_send(events->output, &pdu, 0.0);
}

/* Sends what one of the two bodies says of their collision. */
static void send_collision(struct event_output *events, const struct world *world,
                           const struct event *event, struct event_party issuer,
                           struct event_party other)
{
    static struct pdu pdu;
    struct pdu_id id;
    if (issuer.fixed || issuer.kind >= world->counts.kinds ||
        !entity_output_sends(&world->kinds[issuer.kind]) ||
        !entity_ids_of(&events->entities->ids, issuer.id, &id) || is_remote(events, issuer.id))
        return;
    pdu.header.type = PDU_COLLISION;
    pdu.collision = (struct pdu_collision){.issuer = id,
                                           .other = party_id(events, other),
                                           .mass = (float)world->kinds[issuer.kind].mass_kg};
    /* Events of the run are counted: the number and the issuer are not used twice within a day. */
    pdu.collision.event = (struct pdu_id){
        id.site, id.application, (uint16_t)(1 + event->sequence % ENTITY_IDS_PER_APPLICATION)};
    uint32_t row = entity_output_row(events->entities, issuer.id);
    if (row != SLOT_NONE) /* as it was when the bodies met, not after it */
        set_velocity(pdu.collision.velocity, events, event->collision.point,
                     entity_output_velocity_before(events->entities, row, event->tick));
    set_point(pdu.collision.point, events, other, event->collision.point);
    pdu_output_send(events->output, &pdu, 0.0);
}

static void send_event(struct event_output *events, const struct world *world,
                       const struct event *event)
{
    switch ((enum event_type)event->type) {
    case EVENT_FIRE:
        send_fire(events, world, &event->fire);
        break;
    case EVENT_DETONATION:
        send_detonation(events, world, event);
        break;
    case EVENT_COLLISION:
        send_collision(events, world, event, event->collision.a, event->collision.b);
        send_collision(events, world, event, event->collision.b, event->collision.a);
        break;
    default:
        break;
    }
}

/* Returns true if a PDU is sent for an event. A crater is the ground impact of its detonation. */
static bool is_sent(const struct event_output *events, const struct event *event)
{
    if (event->frame < events->send_from_frame)
        return false;
    /* What another simulator told is not told again: its shots have no munition here. */
    return (event->type == EVENT_FIRE && event->fire.munition.id != 0) ||
           (event->type == EVENT_DETONATION && !event->detonation.remote) ||
           (event->type == EVENT_COLLISION && !event->collision.remote &&
            event->collision.closing_mps >= EVENT_OUTPUT_COLLISION_MPS);
}

/* Tells the way in which collisions of remote entities our own collider has had. */
static void note_met(const struct event_output *events, const struct event_collision *collision,
                     uint64_t now_ns)
{
    const struct event_party *own[2] = {&collision->a, &collision->b};
    for (int i = 0; i < 2 && events->remotes; i++) {
        const struct event_party *other = own[1 - i];
        if (own[i]->fixed || other->fixed || !is_remote(events, other->id))
            continue;
        uint32_t row = entity_output_row(events->entities, other->id);
        remote_input_met(events->remotes, own[i]->id,
                         events->entities->snapshot.entities.row[row].driver, now_ns);
    }
}

/* Tells the way in what the world has refused of it. */
static void note_refused(const struct event_output *events, const struct event_input *input)
{
    if (events->remotes && input->refused > 0)
        remote_input_world_refused(events->remotes, input->remote, input->refused, input->because);
}

/* Returns how many events wait from this one on, as far as the snapshot knows. */
static uint64_t waiting_from(const struct event_output *events, uint64_t sequence)
{
    uint64_t end = events->entities->snapshot.head.event_end;
    return end > sequence ? end - sequence : 1;
}

void event_output_send(struct event_output *events, const struct view *view, uint64_t now_ns)
{
    uint64_t commit = segment_load(&view->commit->commit);
    uint32_t count;
    events->waiting = 0;
    while ((count = events_read(view, &events->cursor, events->event, EVENT_OUTPUT_AT_ONCE)) > 0) {
        for (uint32_t i = 0; i < count; i++) {
            const struct event *event = &events->event[i];
            if (event->type == EVENT_FIRE && event->fire.munition.id != 0)
                remember_shot(events, event);
            if (event->type == EVENT_INPUT && event->frame >= events->send_from_frame)
                note_refused(events, &event->input);
            if (event->type == EVENT_COLLISION && !event->collision.remote &&
                event->frame + EVENT_OUTPUT_RECENT >= commit)
                note_met(events, &event->collision, now_ns);
            if (!is_sent(events, event))
                continue;
            if (!pdu_output_take(events->output, PDU_OUTPUT_EVENT, now_ns)) {
                events->waiting = waiting_from(events, event->sequence);
                events->postponed++;
                events->cursor.next = event->sequence;
                return;
            }
            send_event(events, &view->world, event);
            events->frame = event->frame > 0 ? event->frame - 1 : 0;
        }
    }
    remember_flights(events);
    events->frame = commit;
}
