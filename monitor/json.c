/* JSON of the status and of events. Where cJSON has no memory it makes nothing of nothing, and the
 * text at the end is missing: only that needs a look. */
#include "monitor/json.h"

#include "world/world.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

static void number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        (void)cJSON_AddNumberToObject(object, key, value);
    else
        (void)cJSON_AddNullToObject(object, key);
}

/* Whole numbers beyond what a double holds stay whole. */
static void whole(cJSON *object, const char *key, uint64_t value)
{
    char text[24];
    (void)snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    (void)cJSON_AddRawToObject(object, key, text);
}

/* As few digits as give a float back. */
static cJSON *single(float value)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.9g", (double)value);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

static void single_number(cJSON *object, const char *key, float value)
{
    (void)cJSON_AddItemToObject(object, key, single(value));
}

static void word(cJSON *object, const char *key, const char *text)
{
    (void)cJSON_AddStringToObject(object, key, text);
}

static void times(cJSON *object, const char *key, const jolon_Times *value)
{
    cJSON *child = cJSON_AddObjectToObject(object, key);
    number(child, "p50", value->p50_ms);
    number(child, "p99", value->p99_ms);
    number(child, "max", value->max_ms);
}

static void add_role(cJSON *roles, const jolon_ProcessStatus *status)
{
    cJSON *role = cJSON_CreateObject();
    word(role, "role", status->role);
    whole(role, "pid", status->pid);
    word(role, "state", mirror_process_state(status->state));
    number(role, "beat_age_ms", status->beat_age_ms);
    whole(role, "restarts", status->restarts);
    number(role, "stage_ms", status->stage_ms);
    number(role, "stage_p50_ms", status->stage_p50_ms);
    number(role, "stage_p99_ms", status->stage_p99_ms);
    number(role, "stage_max_ms", status->stage_max_ms);
    whole(role, "frame", status->frame);
    whole(role, "gaps", status->gaps);
    (void)cJSON_AddItemToArray(roles, role);
}

static void add_tally(cJSON *object, const jolon_FrameStatus *frame)
{
    whole(object, "collisions", frame->tally.collisions);
    whole(object, "fires", frame->tally.fires);
    whole(object, "detonations", frame->tally.detonations);
    whole(object, "craters", frame->craters);
    whole(object, "destroyed", frame->tally.destroyed);
    whole(object, "agent_changes", frame->tally.agent_changes);
    whole(object, "commands", frame->tally.commands);
    whole(object, "events_dropped", frame->tally.events_dropped);
}

char *json_status(const struct mirror *mirror, uint64_t now_ns)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    cJSON *object = cJSON_CreateObject();
    word(object, "world", mirror->name);
    word(object, "state", mirror_run_state(mirror, now_ns));
    if (mirror->frame_ns) {
        whole(object, "commit", frame->frame);
        whole(object, "moved", frame->moved);
        number(object, "sim_time_s", frame->sim_time_s);
        number(object, "hz", frame->hz);
        (void)cJSON_AddBoolToObject(object, "paused", frame->paused);
        number(object, "time_scale", frame->time_scale);
        number(object, "rate_hz", frame->rate_hz);
        whole(object, "late_frames", frame->late_frames);
        whole(object, "vehicles", frame->vehicles);
        whole(object, "munitions", frame->munitions);
        whole(object, "events", frame->events);
        add_tally(object, frame);
        times(object, "frame_ms", &frame->frame_time);
        times(object, "mover_ms", &frame->mover_time);
        times(object, "collider_ms", &frame->collider_time);
    }
    if (mirror->has_batch)
        whole(object, "entities", mirror->batch.count);
    cJSON *roles = cJSON_AddArrayToObject(object, "roles");
    for (uint32_t i = 0; i < mirror->role_count; i++)
        add_role(roles, &mirror->role[i]);
    char *text = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    return text;
}

static void party(cJSON *object, const char *key, const jolon_Party *value)
{
    cJSON *child = cJSON_AddObjectToObject(object, key);
    whole(child, "id", value->id);
    word(child, "kind", value->kind);
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
    (void)cJSON_AddItemToArray(array, single(value->x));
    (void)cJSON_AddItemToArray(array, single(value->y));
    (void)cJSON_AddItemToArray(array, single(value->z));
}

static const char *damage(jolon_Damage value)
{
    return damage_name((enum damage)value);
}

static void add_collision(cJSON *object, const jolon_CollisionEvent *event)
{
    word(object, "type", "collision");
    party(object, "a", &event->a);
    party(object, "b", &event->b);
    point(object, &event->point);
    direction(object, "normal", &event->normal);
    direction(object, "direction", &event->direction);
    number(object, "toi", event->toi);
    single_number(object, "closing_mps", event->closing_mps);
    single_number(object, "angle_deg", event->angle_deg);
    single_number(object, "impulse_ns", event->impulse_ns);
    word(object, "response", response_name((enum response)event->response));
    word(object, "damage_a", damage(event->a.damage));
    word(object, "damage_b", damage(event->b.damage));
}

static void add_fire(cJSON *object, const jolon_FireEvent *event)
{
    word(object, "type", "fire");
    party(object, "shooter", &event->shooter);
    party(object, "target", &event->target);
    party(object, "munition", &event->munition);
    point(object, &event->point);
}

static void add_detonation(cJSON *object, const jolon_DetonationEvent *event)
{
    word(object, "type", "detonation");
    party(object, "munition", &event->munition);
    point(object, &event->point);
    word(object, "struck", struck_name((enum struck)event->struck));
    whole(object, "id", event->victim.id);
    word(object, "kind", event->victim.kind);
    word(object, "damage", damage(event->victim.damage));
    single_number(object, "explosive_kg", event->explosive_kg);
}

static void add_crater(cJSON *object, const jolon_CraterEvent *event)
{
    word(object, "type", "crater");
    point(object, &event->point);
    single_number(object, "radius_m", event->radius_m);
    single_number(object, "depth_m", event->depth_m);
}

static void add_agent(cJSON *object, const jolon_AgentEvent *event)
{
    word(object, "type", "agent");
    whole(object, "id", event->agent.id);
    word(object, "kind", event->agent.kind);
    word(object, "from", behaviour_name((enum behaviour)event->before));
    word(object, "to", behaviour_name((enum behaviour)event->after));
    word(object, "because", agent_reason_name((enum agent_reason)event->because));
}

void json_event(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event)
{
    const jolon_EventHeader *header = event;
    cJSON *object = cJSON_CreateObject();
    whole(object, "frame", header->frame);
    whole(object, "index", header->index);
    number(object, "time_s", header->time_s);
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
    if (!cJSON_PrintPreallocated(object, line, (int)TAIL_LINE_MAX, 0))
        (void)snprintf(line, TAIL_LINE_MAX,
                       "{\"frame\":%llu,\"index\":%u,\"type\":\"unprintable\"}",
                       (unsigned long long)header->frame, header->index);
    cJSON_Delete(object);
}
