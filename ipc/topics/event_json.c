/* Events of the topics as JSON objects. */
#include "ipc/topics/event_json.h"

#include "ipc/json/world_json.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/enum_names.h"
#include "world/runtime/check.h"

#include <stdio.h>

static const char *damage(jolon_Damage value)
{
    return damage_name((enum damage)value);
}

static void party(cJSON *object, const char *key, const jolon_Party *value)
{
    cJSON *child = json_object(object, key);
    json_whole(child, "id", value->id);
    json_text(child, "kind", value->kind);
    json_bool(child, "fixed", value->fixed);
}

static void point(cJSON *object, const jolon_Point *value)
{
    json_triple(object, "point", value->x_m, value->y_m, value->z_m);
}

static void direction(cJSON *object, const char *key, const jolon_Direction *value)
{
    json_triple_single(object, key, (const float[3]){value->x, value->y, value->z});
}

static void add_collision(cJSON *object, const jolon_CollisionEvent *event)
{
    party(object, "a", &event->a);
    party(object, "b", &event->b);
    point(object, &event->point);
    direction(object, "normal", &event->normal);
    direction(object, "direction", &event->direction);
    json_number(object, "toi", event->toi);
    json_single(object, "closing_mps", event->closing_mps);
    json_single(object, "angle_deg", event->angle_deg);
    json_single(object, "impulse_ns", event->impulse_ns);
    json_text(object, "response", response_name((enum response)event->response));
    json_text(object, "damage_a", damage(event->a.damage));
    json_text(object, "damage_b", damage(event->b.damage));
    json_bool(object, "begins", event->begins);
}

static void add_fire(cJSON *object, const jolon_FireEvent *event)
{
    party(object, "shooter", &event->shooter);
    party(object, "target", &event->target);
    party(object, "munition", &event->munition);
    point(object, &event->point);
}

static void add_detonation(cJSON *object, const jolon_DetonationEvent *event)
{
    party(object, "munition", &event->munition);
    point(object, &event->point);
    json_text(object, "struck", struck_name((enum struck)event->struck));
    json_whole(object, "id", event->victim.id);
    json_text(object, "kind", event->victim.kind);
    json_text(object, "damage", damage(event->victim.damage));
    json_single(object, "explosive_kg", event->explosive_kg);
}

static void add_crater(cJSON *object, const jolon_CraterEvent *event)
{
    point(object, &event->point);
    json_single(object, "radius_m", event->radius_m);
    json_single(object, "depth_m", event->depth_m);
}

static void add_agent(cJSON *object, const jolon_AgentEvent *event)
{
    json_whole(object, "id", event->agent.id);
    json_text(object, "kind", event->agent.kind);
    json_text(object, "from", behaviour_name((enum behaviour)event->before));
    json_text(object, "to", behaviour_name((enum behaviour)event->after));
    json_text(object, "because", agent_reason_name((enum agent_reason)event->because));
}

static void add_contact_end(cJSON *object, const jolon_ContactEndEvent *event)
{
    party(object, "a", &event->a);
    party(object, "b", &event->b);
    json_number(object, "lasted_s", event->lasted_s);
    json_whole(object, "impacts", event->impacts);
    json_single(object, "impulse_ns", event->impulse_ns);
    json_text(object, "because",
              contact_end_reason_name((enum contact_end_reason)event->because));
}

void event_json(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    const jolon_EventHeader *header = event;
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "frame", header->frame);
    json_whole(object, "index", header->index);
    json_number(object, "time_s", header->time_s);
    switch (topic) {
#define X(tag, word)                                                                               \
    case TOPIC_##tag:                                                                              \
        json_text(object, "type", #word);                                                          \
        add_##word(object, event);                                                                 \
        break;
        EVENT_TYPES_WITH_TOPIC(X)
#undef X
    default:
        CHECK(false);
    }
    if (!cJSON_PrintPreallocated(object, line, (int)EVENT_MERGE_LINE_MAX, 0))
        (void)snprintf(line, EVENT_MERGE_LINE_MAX,
                       "{\"frame\":%llu,\"index\":%u,\"type\":\"unprintable\"}",
                       (unsigned long long)header->frame, header->index);
    cJSON_Delete(object);
}
