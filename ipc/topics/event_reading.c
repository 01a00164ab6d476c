/* One function for each type of event. */
#include "ipc/topics/event_reading.h"

#include "world/runtime/check.h"

static struct event_party party(const jolon_Party *party)
{
    return (struct event_party){
        .id = party->id, .fixed = party->fixed, .damage = (uint8_t)party->damage};
}

static uint32_t entity_id(const jolon_Party *party)
{
    return party->fixed ? 0 : party->id;
}

static void read_point(double to[3], const jolon_Point *point)
{
    to[0] = point->x_m;
    to[1] = point->y_m;
    to[2] = point->z_m;
}

static void read_direction(float to[3], const jolon_Direction *direction)
{
    to[0] = direction->x;
    to[1] = direction->y;
    to[2] = direction->z;
}

static void read_collision(struct event_reading *reading, const jolon_CollisionEvent *from)
{
    struct event_collision *collision = &reading->event.collision;
    *collision = (struct event_collision){.a = party(&from->a),
                                          .b = party(&from->b),
                                          .toi = from->toi,
                                          .closing_mps = from->closing_mps,
                                          .angle_deg = from->angle_deg,
                                          .impulse_ns = from->impulse_ns,
                                          .response = from->response,
                                          .begins = from->begins};
    read_point(collision->point, &from->point);
    read_direction(collision->normal, &from->normal);
    read_direction(collision->direction_a, &from->direction);
    reading->kind[EVENT_TEXT_FIRST] = from->a.kind;
    reading->kind[EVENT_TEXT_SECOND] = from->b.kind;
    reading->ids[0] = entity_id(&from->a);
    reading->ids[1] = entity_id(&from->b);
}

static void read_fire(struct event_reading *reading, const jolon_FireEvent *from)
{
    reading->event.fire = (struct event_fire){.shooter = party(&from->shooter),
                                              .target = party(&from->target),
                                              .munition = party(&from->munition)};
    read_point(reading->event.fire.point, &from->point);
    reading->kind[EVENT_TEXT_FIRST] = from->shooter.kind;
    reading->kind[EVENT_TEXT_SECOND] = from->target.kind;
    reading->kind[EVENT_TEXT_MUNITION] = from->munition.kind;
    reading->ids[0] = from->shooter.id;
    reading->ids[1] = from->target.id;
    reading->ids[2] = from->munition.id;
}

static void read_detonation(struct event_reading *reading, const jolon_DetonationEvent *from)
{
    reading->event.detonation = (struct event_detonation){.munition = party(&from->munition),
                                                          .struck_party = party(&from->victim),
                                                          .explosive_kg = from->explosive_kg,
                                                          .struck = from->struck};
    read_point(reading->event.detonation.point, &from->point);
    reading->kind[EVENT_TEXT_FIRST] = from->victim.kind;
    reading->kind[EVENT_TEXT_MUNITION] = from->munition.kind;
    reading->ids[0] = from->munition.id;
    reading->ids[1] = entity_id(&from->victim);
}

static void read_crater(struct event_reading *reading, const jolon_CraterEvent *from)
{
    reading->event.crater =
        (struct event_crater){.radius_m = from->radius_m, .depth_m = from->depth_m};
    read_point(reading->event.crater.point, &from->point);
}

static void read_agent(struct event_reading *reading, const jolon_AgentEvent *from)
{
    reading->event.agent = (struct event_agent){.agent = party(&from->agent),
                                                .from = from->before,
                                                .to = from->after,
                                                .because = from->because};
    reading->kind[EVENT_TEXT_FIRST] = from->agent.kind;
    reading->ids[0] = from->agent.id;
}

static void read_contact_end(struct event_reading *reading, const jolon_ContactEndEvent *from)
{
    reading->event.contact_end = (struct event_contact_end){.a = party(&from->a),
                                                            .b = party(&from->b),
                                                            .lasted_s = from->lasted_s,
                                                            .impacts = from->impacts,
                                                            .impulse_ns = from->impulse_ns,
                                                            .because = from->because};
    reading->kind[EVENT_TEXT_FIRST] = from->a.kind;
    reading->kind[EVENT_TEXT_SECOND] = from->b.kind;
    reading->ids[0] = entity_id(&from->a);
    reading->ids[1] = entity_id(&from->b);
}

struct event_reading event_reading_of(enum dds_topic topic, const void *sample)
{
    struct event_reading reading = {.event.type = topic - TOPIC_EVENTS + 1u};
    switch (topic) {
#define X(tag, word)                                                                               \
    case TOPIC_##tag:                                                                              \
        read_##word(&reading, sample);                                                             \
        break;
        EVENT_TYPES_WITH_TOPIC(X)
#undef X
    default:
        CHECK(false);
    }
    return reading;
}
