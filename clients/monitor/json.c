/* JSON of the status. Where cJSON has no memory it makes nothing of nothing, and the
 * text at the end is missing: only that needs a look. */
#include "clients/monitor/json.h"

#include "clients/monitor/vehicle_table.h"
#include "ipc/topics/entity_json.h"
#include "ipc/topics/json_members.h"

#include <cjson/cJSON.h>

static void times(cJSON *object, const char *key, const jolon_Times *value)
{
    cJSON *child = cJSON_AddObjectToObject(object, key);
    put_number(child, "p50", value->p50_ms);
    put_number(child, "p99", value->p99_ms);
    put_number(child, "max", value->max_ms);
}

static void add_role(cJSON *roles, const jolon_ProcessStatus *status)
{
    cJSON *role = cJSON_CreateObject();
    put_word(role, "role", status->role);
    put_whole(role, "pid", status->pid);
    put_word(role, "state", world_mirror_process_state(status->state));
    put_number(role, "beat_age_ms", status->beat_age_ms);
    put_whole(role, "restarts", status->restarts);
    put_number(role, "stage_ms", status->stage_ms);
    put_number(role, "stage_p50_ms", status->stage_p50_ms);
    put_number(role, "stage_p99_ms", status->stage_p99_ms);
    put_number(role, "stage_max_ms", status->stage_max_ms);
    put_whole(role, "frame", status->frame);
    put_whole(role, "gaps", status->gaps);
    (void)cJSON_AddItemToArray(roles, role);
}

static void add_tally(cJSON *object, const jolon_FrameStatus *frame)
{
    put_whole(object, "collisions", frame->tally.collisions);
    put_whole(object, "fires", frame->tally.fires);
    put_whole(object, "detonations", frame->tally.detonations);
    put_whole(object, "craters", frame->craters);
    put_whole(object, "destroyed", frame->tally.destroyed);
    put_whole(object, "agent_changes", frame->tally.agent_changes);
    put_whole(object, "commands", frame->tally.commands);
    put_whole(object, "events_dropped", frame->tally.events_dropped);
}

/* False when there was no memory for it. */
static bool add_vehicles(cJSON *object, const struct world_mirror *mirror, const char *filter)
{
    struct vehicle_table table = {0};
    cJSON *list = cJSON_AddArrayToObject(object, "list");
    bool good = vehicle_table_build(&table, mirror, filter, VEHICLE_TABLE_ID, false);
    for (uint32_t i = 0; i < table.count; i++)
        (void)cJSON_AddItemToArray(list, entity_json(mirror, &mirror->batch.entity[table.row[i]]));
    vehicle_table_free(&table);
    return good;
}

char *json_status(const struct world_mirror *mirror, const char *filter, uint64_t now_ns)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    cJSON *object = cJSON_CreateObject();
    put_word(object, "world", mirror->name);
    put_word(object, "state", world_mirror_run_state(mirror, now_ns));
    if (mirror->frame_ns) {
        put_whole(object, "commit", frame->frame);
        put_whole(object, "moved", frame->moved);
        put_number(object, "sim_time_s", frame->sim_time_s);
        put_number(object, "hz", frame->hz);
        (void)cJSON_AddBoolToObject(object, "paused", frame->paused);
        put_number(object, "time_scale", frame->time_scale);
        put_number(object, "rate_hz", frame->rate_hz);
        put_whole(object, "late_frames", frame->late_frames);
        put_whole(object, "vehicles", frame->vehicles);
        put_whole(object, "munitions", frame->munitions);
        put_whole(object, "events", frame->events);
        add_tally(object, frame);
        times(object, "frame_ms", &frame->frame_time);
        times(object, "recent_ms", &frame->recent);
        times(object, "mover_ms", &frame->mover_time);
        times(object, "collider_ms", &frame->collider_time);
    }
    if (mirror->has_batch)
        put_whole(object, "entities", mirror->batch.count);
    cJSON *roles = cJSON_AddArrayToObject(object, "roles");
    for (uint32_t i = 0; i < mirror->role_count; i++)
        add_role(roles, &mirror->role[i]);
    bool good = !filter || add_vehicles(object, mirror, filter);
    char *text = good ? cJSON_PrintUnformatted(object) : NULL;
    cJSON_Delete(object);
    return text;
}
