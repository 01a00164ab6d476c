/* Events of the topics as JSON objects. */
#include "ipc/topics/event_json.h"

#include "ipc/topics/json_members.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/enum_names.h"

#include <stdio.h>

static const char *damage(jolon_Damage value)
{
    return damage_name((enum damage)value);
}

static void party(cJSON *object, const char *key, const jolon_Party *value)
{
    cJSON *child = cJSON_AddObjectToObject(object, key);
    put_whole(child, "id", value->id);
    put_word(child, "kind", value->kind);
    (void)cJSON_AddBoolToObject(child, "fixed", value->fixed);
}

static void point(cJSON *object, const jolon_Point *value)
{
    const double place[3] = {value->x_m, value->y_m, value->z_m};
    (void)cJSON_AddItemToObject(object, "point", cJSON_CreateDoubleArray(place, 3));
}

static void direction(cJSON *object, const char *key, const jolon_Direction *value)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    (void)cJSON_AddItemToArray(array, put_float(value->x));
    (void)cJSON_AddItemToArray(array, put_float(value->y));
    (void)cJSON_AddItemToArray(array, put_float(value->z));
}

static void add_collision(cJSON *object, const jolon_CollisionEvent *event)
{
    put_word(object, "type", "collision");
    party(object, "a", &event->a);
    party(object, "b", &event->b);
    point(object, &event->point);
    direction(object, "normal", &event->normal);
    direction(object, "direction", &event->direction);
    put_number(object, "toi", event->toi);
    put_single(object, "closing_mps", event->closing_mps);
    put_single(object, "angle_deg", event->angle_deg);
    put_single(object, "impulse_ns", event->impulse_ns);
    put_word(object, "response", response_name((enum response)event->response));
    put_word(object, "damage_a", damage(event->a.damage));
    put_word(object, "damage_b", damage(event->b.damage));
}

static void add_fire(cJSON *object, const jolon_FireEvent *event)
{
    put_word(object, "type", "fire");
    party(object, "shooter", &event->shooter);
    party(object, "target", &event->target);
    party(object, "munition", &event->munition);
    point(object, &event->point);
}

static void add_detonation(cJSON *object, const jolon_DetonationEvent *event)
{
    put_word(object, "type", "detonation");
    party(object, "munition", &event->munition);
    point(object, &event->point);
    put_word(object, "struck", struck_name((enum struck)event->struck));
    put_whole(object, "id", event->victim.id);
    put_word(object, "kind", event->victim.kind);
    put_word(object, "damage", damage(event->victim.damage));
    put_single(object, "explosive_kg", event->explosive_kg);
}

static void add_crater(cJSON *object, const jolon_CraterEvent *event)
{
    put_word(object, "type", "crater");
    point(object, &event->point);
    put_single(object, "radius_m", event->radius_m);
    put_single(object, "depth_m", event->depth_m);
}

static void add_agent(cJSON *object, const jolon_AgentEvent *event)
{
    put_word(object, "type", "agent");
    put_whole(object, "id", event->agent.id);
    put_word(object, "kind", event->agent.kind);
    put_word(object, "from", behaviour_name((enum behaviour)event->before));
    put_word(object, "to", behaviour_name((enum behaviour)event->after));
    put_word(object, "because", agent_reason_name((enum agent_reason)event->because));
}

void event_json(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    const jolon_EventHeader *header = event;
    cJSON *object = cJSON_CreateObject();
    put_whole(object, "frame", header->frame);
    put_whole(object, "index", header->index);
    put_number(object, "time_s", header->time_s);
    if (topic == TOPIC_COLLISION)
        add_collision(object, event);
    else if (topic == TOPIC_FIRE)
        add_fire(object, event);
    else if (topic == TOPIC_DETONATION)
        add_detonation(object, event);
    else if (topic == TOPIC_CRATER)
        add_crater(object, event);
    else
        add_agent(object, event);
    if (!cJSON_PrintPreallocated(object, line, (int)EVENT_MERGE_LINE_MAX, 0))
        (void)snprintf(line, EVENT_MERGE_LINE_MAX,
                       "{\"frame\":%llu,\"index\":%u,\"type\":\"unprintable\"}",
                       (unsigned long long)header->frame, header->index);
    cJSON_Delete(object);
}
