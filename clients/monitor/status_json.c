/* Writes the status as JSON. */
#include "clients/monitor/status_json.h"

#include "clients/monitor/vehicle_table.h"
#include "ipc/topics/entity_json.h"
#include "ipc/json/world_json.h"

#include <cjson/cJSON.h>

static void add_times(cJSON *object, const char *key, const jolon_Times *value)
{
    cJSON *child = json_object(object, key);
    json_number(child, "p50", value->p50_ms);
    json_number(child, "p99", value->p99_ms);
    json_number(child, "max", value->max_ms);
}

static void add_role(cJSON *roles, const jolon_ProcessStatus *status)
{
    cJSON *role = cJSON_CreateObject();
    json_text(role, "role", status->role);
    json_whole(role, "pid", status->pid);
    json_text(role, "state", world_mirror_process_state(status->state));
    json_number(role, "beat_age_ms", status->beat_age_ms);
    json_whole(role, "restarts", status->restarts);
    json_number(role, "stage_ms", status->stage_ms);
    json_number(role, "stage_p50_ms", status->stage_p50_ms);
    json_number(role, "stage_p99_ms", status->stage_p99_ms);
    json_number(role, "stage_max_ms", status->stage_max_ms);
    json_whole(role, "frame", status->frame);
    json_whole(role, "gaps", status->gaps);
    (void)cJSON_AddItemToArray(roles, role);
}

static void add_counters(cJSON *object, const jolon_FrameStatus *frame)
{
    json_whole(object, "collisions", frame->tally.collisions);
    json_whole(object, "fires", frame->tally.fires);
    json_whole(object, "detonations", frame->tally.detonations);
    json_whole(object, "craters", frame->craters);
    json_whole(object, "destroyed", frame->tally.destroyed);
    json_whole(object, "agent_changes", frame->tally.agent_changes);
    json_whole(object, "commands", frame->tally.commands);
    json_whole(object, "events_dropped", frame->tally.events_dropped);
    json_whole(object, "contacts", frame->contacts);
    json_whole(object, "contacts_refused", frame->contacts_refused);
}

/* Returns false if there is no memory for the table. */
static bool add_vehicles(cJSON *object, const struct world_mirror *mirror, const char *filter)
{
    struct vehicle_table table = {0};
    cJSON *list = json_array(object, "list");
    bool good = vehicle_table_build(&table, mirror, filter, VEHICLE_TABLE_ID, false);
    for (uint32_t i = 0; i < table.count; i++)
        (void)cJSON_AddItemToArray(list, entity_json(mirror, &mirror->batch.entity[table.row[i]]));
    vehicle_table_free(&table);
    return good;
}

char *status_json(const struct world_mirror *mirror, const char *filter, uint64_t now_ns)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", mirror->name);
    json_text(object, "state", world_mirror_run_state(mirror, now_ns));
    if (mirror->frame_ns) {
        json_whole(object, "commit", frame->frame);
        json_whole(object, "moved", frame->moved);
        json_number(object, "sim_time_s", frame->sim_time_s);
        json_number(object, "hz", frame->hz);
        json_bool(object, "paused", frame->paused);
        json_number(object, "time_scale", frame->time_scale);
        json_number(object, "rate_hz", frame->rate_hz);
        json_whole(object, "late_frames", frame->late_frames);
        json_whole(object, "vehicles", frame->vehicles);
        json_whole(object, "munitions", frame->munitions);
        json_whole(object, "events", frame->events);
        add_counters(object, frame);
        add_times(object, "frame_ms", &frame->frame_time);
        add_times(object, "recent_ms", &frame->recent);
        add_times(object, "mover_ms", &frame->mover_time);
        add_times(object, "collider_ms", &frame->collider_time);
    }
    if (mirror->has_batch)
        json_whole(object, "entities", mirror->batch.count);
    cJSON *roles = json_array(object, "roles");
    for (uint32_t i = 0; i < mirror->role_count; i++)
        add_role(roles, &mirror->role[i]);
    bool good = !filter || add_vehicles(object, mirror, filter);
    char *text = good ? cJSON_PrintUnformatted(object) : NULL;
    cJSON_Delete(object);
    return text;
}
