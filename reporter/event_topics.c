/* Publishes the event ring. */
#include "reporter/event_topics.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"

#include "status.h"
#include "world/earth_location.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/event_text.h"
#include "world/params.h"

#include <string.h>

_Static_assert((int)jolon_RESPONSE_DESTROYED == (int)RESPONSE_DESTROYED &&
                   (int)RESPONSE_COUNT == (int)jolon_RESPONSE_DESTROYED + 1,
               "responses in ipc/topics/status.idl");
_Static_assert((int)jolon_STRUCK_AIR == (int)STRUCK_AIR &&
                   (int)STRUCK_COUNT == (int)jolon_STRUCK_AIR + 1,
               "what is struck in ipc/topics/status.idl");
_Static_assert((int)jolon_REASON_LEFT_WORLD == (int)REASON_LEFT_WORLD &&
                   (int)REASON_COUNT == (int)jolon_REASON_LEFT_WORLD + 1,
               "agents' reasons in ipc/topics/status.idl");
_Static_assert((int)jolon_CONTACT_END_NO_ROOM == (int)CONTACT_END_NO_ROOM &&
                   (int)CONTACT_END_REASON_COUNT == (int)jolon_CONTACT_END_NO_ROOM + 1,
               "reasons of ends in ipc/topics/status.idl");
_Static_assert((int)jolon_DAMAGE_DESTROYED == (int)DAMAGE_DESTROYED &&
                   (int)DAMAGE_COUNT == (int)jolon_DAMAGE_DESTROYED + 1,
               "damage in ipc/topics/status.idl");
_Static_assert(sizeof((jolon_CraterEvent *)0)->mgrs == MGRS_TEXT_MAX,
               "references of the grid in ipc/topics/status.idl");
_Static_assert(TOPIC_CONTACT_END - TOPIC_EVENTS + 1 == EVENT_TOPIC_COUNT,
               "event topics are in a row");

int event_topics_open(struct event_topics *events, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error)
{
    struct state_head head;
    *events = (struct event_topics){.run = run};
    earth_location_frame(&events->earth, view->world.params, view->world.terrain.squares.world_m);
    for (uint32_t i = 0; i < EVENT_TOPIC_COUNT; i++) {
        events->writer[i] = dds_topics_writer(link, (enum dds_topic)(TOPIC_EVENTS + i), error);
        if (events->writer[i] < 0)
            return -1;
        events->previous[i] = UINT64_MAX;
    }
    if (snapshot_head(&head, view) != 0)
        return error_text_set(error, "world \"%s\": its last frame cannot be read", view->name);
    /* The slot still holds the last frame that the predecessor finished, 0 when there was none. */
    const struct role_slot *slot = view->slot[view->role];
    uint64_t before = atomic_load_explicit(&slot->frame, memory_order_relaxed);
    uint64_t again = (uint64_t)(EVENT_TOPICS_AGAIN_S * view->world.params->hz);
    events->publish_from =
        head.event_end > EVENT_TOPICS_AGAIN ? head.event_end - EVENT_TOPICS_AGAIN : 0;
    events->publish_from_frame = before > again ? before - again : 0;
    events->gaps = atomic_load_explicit(&slot->gaps, memory_order_relaxed);
    /* Begins with the oldest event in the ring. Earlier events are no gap. */
    uint64_t slots = view->header->event_slots;
    events->cursor.next = head.event_end > slots ? head.event_end - slots : 0;
    events->cursor.next -= events_read(view, &events->cursor, events->event, 1);
    events->cursor.gap = 0;
    return 0;
}

static jolon_Point point_of(const double point[3])
{
    return (jolon_Point){point[0], point[1], point[2]};
}

static jolon_Direction direction_of(const float direction[3])
{
    return (jolon_Direction){direction[0], direction[1], direction[2]};
}

static jolon_Party party_of(const struct world *world, const struct event_party *party)
{
    jolon_Party wire = {
        .id = party->id, .fixed = party->fixed != 0, .damage = (jolon_Damage)party->damage};
    const char *kind = party->fixed ? "ground" : "none"; /* the terrain, or none */
    if (party->id)
        kind = party->kind < world->counts.kinds ? world->kinds[party->kind].name : "?";
    (void)stpncpy(wire.kind, kind, sizeof wire.kind - 1);
    return wire;
}

union event_sample {
    jolon_CollisionEvent collision;
    jolon_FireEvent fire;
    jolon_DetonationEvent detonation;
    jolon_CraterEvent crater;
    jolon_AgentEvent agent;
    jolon_ContactEndEvent contact_end;
};

/* The world of the events, and where it lies on the earth. */
struct event_scene {
    const struct world *world;
    const struct location_frame *earth;
};

typedef void fill_sample(union event_sample *sample, const jolon_EventHeader *header,
                         const struct event_scene *scene, const struct event *event);

/* Sets the place on the earth of a point of the world. */
static void set_place(jolon_Degrees *degrees, char mgrs[MGRS_TEXT_MAX],
                      const struct event_scene *scene, const double point[3])
{
    struct location_earth earth;
    location_earth(&earth, scene->earth, point[0], point[2]);
    *degrees = (jolon_Degrees){earth.latitude_deg, earth.longitude_deg};
    memcpy(mgrs, earth.mgrs, MGRS_TEXT_MAX);
}

static void fill_collision(union event_sample *sample, const jolon_EventHeader *header,
                           const struct event_scene *scene, const struct event *event)
{
    const struct event_collision *from = &event->collision;
    sample->collision = (jolon_CollisionEvent){
        .header = *header,
        .a = party_of(scene->world, &from->a),
        .b = party_of(scene->world, &from->b),
        .point = point_of(from->point),
        .normal = direction_of(from->normal),
        .toi = from->toi,
        .closing_mps = from->closing_mps,
        .angle_deg = from->angle_deg,
        .impulse_ns = from->impulse_ns,
        .direction = direction_of(from->direction_a),
        .response = (jolon_Response)from->response,
        .begins = from->begins != 0,
    };
    set_place(&sample->collision.degrees, sample->collision.mgrs, scene, from->point);
}

static void fill_fire(union event_sample *sample, const jolon_EventHeader *header,
                      const struct event_scene *scene, const struct event *event)
{
    const struct event_fire *from = &event->fire;
    sample->fire = (jolon_FireEvent){
        .header = *header,
        .shooter = party_of(scene->world, &from->shooter),
        .target = party_of(scene->world, &from->target),
        .munition = party_of(scene->world, &from->munition),
        .point = point_of(from->point),
    };
    set_place(&sample->fire.degrees, sample->fire.mgrs, scene, from->point);
}

static void fill_detonation(union event_sample *sample, const jolon_EventHeader *header,
                            const struct event_scene *scene, const struct event *event)
{
    const struct event_detonation *from = &event->detonation;
    sample->detonation = (jolon_DetonationEvent){
        .header = *header,
        .munition = party_of(scene->world, &from->munition),
        .victim = party_of(scene->world, &from->struck_party),
        .point = point_of(from->point),
        .explosive_kg = from->explosive_kg,
        .struck = (jolon_Struck)from->struck,
    };
    set_place(&sample->detonation.degrees, sample->detonation.mgrs, scene, from->point);
}

static void fill_crater(union event_sample *sample, const jolon_EventHeader *header,
                        const struct event_scene *scene, const struct event *event)
{
    const struct event_crater *from = &event->crater;
    sample->crater = (jolon_CraterEvent){
        .header = *header,
        .point = point_of(from->point),
        .radius_m = from->radius_m,
        .depth_m = from->depth_m,
    };
    set_place(&sample->crater.degrees, sample->crater.mgrs, scene, from->point);
}

static void fill_agent(union event_sample *sample, const jolon_EventHeader *header,
                       const struct event_scene *scene, const struct event *event)
{
    const struct event_agent *from = &event->agent;
    sample->agent = (jolon_AgentEvent){
        .header = *header,
        .agent = party_of(scene->world, &from->agent),
        .before = (jolon_Behaviour)from->from,
        .after = (jolon_Behaviour)from->to,
        .because = (jolon_AgentReason)from->because,
    };
}

static void fill_contact_end(union event_sample *sample, const jolon_EventHeader *header,
                             const struct event_scene *scene, const struct event *event)
{
    const struct event_contact_end *from = &event->contact_end;
    sample->contact_end = (jolon_ContactEndEvent){
        .header = *header,
        .a = party_of(scene->world, &from->a),
        .b = party_of(scene->world, &from->b),
        .lasted_s = from->lasted_s,
        .impacts = from->impacts,
        .impulse_ns = from->impulse_ns,
        .because = (jolon_ContactEndReason)from->because,
    };
}

static fill_sample *const fill[] = {
#define X(tag, word) fill_##word,
    EVENT_TYPES_WITH_TOPIC(X)
#undef X
};

/* Returns false when DDS had no room, and the event must be written again. */
static bool publish_one(struct event_topics *events, const struct event_scene *scene,
                        const struct event *event, bool publish)
{
    uint32_t topic = event->type - 1;
    dds_return_t code = DDS_RETCODE_OK;
    jolon_EventHeader header = {
        .run = events->run,
        .sequence = event->sequence,
        .previous =
            events->previous[topic] == UINT64_MAX ? event->sequence : events->previous[topic],
        .frame = event->frame,
        .index = event->index,
        .time_s = (double)event->tick * scene->world->params->dt_s,
    };
    if (publish) {
        union event_sample sample;
        fill[topic](&sample, &header, scene, event);
        code = dds_write(events->writer[topic], &sample);
    }
    if (code == DDS_RETCODE_TIMEOUT)
        return false;
    if (code != DDS_RETCODE_OK && log_due(&events->logged_ns, NS_PER_S))
        log_warn("%s event %llu not published: %s", event_type_name((enum event_type)event->type),
                 (unsigned long long)event->sequence, dds_strretcode(code));
    events->previous[topic] = event->sequence;
    return true;
}

static void count_gap(struct event_topics *events)
{
    if (!events->cursor.gap)
        return;
    events->gaps += events->cursor.gap;
    if (log_due(&events->logged_ns, NS_PER_S))
        log_warn("%llu events were overwritten before they could be published; %llu so far",
                 (unsigned long long)events->cursor.gap, (unsigned long long)events->gaps);
    events->cursor.gap = 0;
}

bool event_topics_publish(struct event_topics *events, const struct view *view, uint64_t until_ns)
{
    uint64_t commit = atomic_load_explicit(&view->commit->commit, memory_order_acquire);
    const struct event_scene scene = {&view->world, &events->earth};
    while (clock_now_ns() < until_ns) {
        uint32_t count = events_read(view, &events->cursor, events->event, EVENT_TOPICS_AT_ONCE);
        count_gap(events);
        if (count == 0) {
            events->frame = commit;
            return true;
        }
        for (uint32_t i = 0; i < count; i++) {
            const struct event *event = &events->event[i];
            bool publish = event->sequence >= events->publish_from ||
                           event->frame >= events->publish_from_frame;
            if (event->type > EVENT_NONE && event->type <= EVENT_TOPIC_COUNT &&
                !publish_one(events, &scene, event, publish)) {
                events->cursor.next = event->sequence;
                return false;
            }
        }
    }
    return false;
}

void event_topics_flush(const struct event_topics *events, uint64_t until_ns)
{
    for (uint32_t i = 0; i < EVENT_TOPIC_COUNT; i++) {
        uint64_t now_ns = clock_now_ns();
        if (now_ns < until_ns)
            (void)dds_wait_for_acks(events->writer[i], (dds_duration_t)(until_ns - now_ns));
    }
}
