/* Wants read, and met. */
#include "clients/harness/subscription.h"

#include "ipc/process/clock.h"
#include "ipc/topics/entity_json.h"
#include "ipc/topics/event_json.h"
#include "ipc/topics/json_members.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/event_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int read_entity(uint32_t *id, const cJSON *item, const struct world_mirror *mirror,
                       struct reason *reason)
{
    const char *name = cJSON_GetStringValue(item);
    if (name) {
        *id = name_table_find(&mirror->names, name);
        return *id ? 0 : reason_set(reason, "'%.32s': no vehicle has that name", name);
    }
    double value = cJSON_IsNumber(item) ? item->valuedouble : 0.0;
    *id = value >= 1.0 && value <= UINT32_MAX ? (uint32_t)value : 0;
    if (!*id || (double)*id != value)
        return reason_set(reason, "not the id or the name of a vehicle");
    return 0;
}

static int read_near(struct subscription *wants, const cJSON *object,
                     const struct world_mirror *mirror, struct reason *reason)
{
    const cJSON *near = cJSON_GetObjectItemCaseSensitive(object, "near");
    const cJSON *within = cJSON_GetObjectItemCaseSensitive(object, "within_m");
    if (!near || !cJSON_IsNumber(within) || !(within->valuedouble >= 0.0))
        return reason_set(reason, "not like {\"near\":7,\"within_m\":500}");
    wants->within_m = within->valuedouble;
    return read_entity(&wants->near, near, mirror, reason);
}

static int read_entities(struct subscription *wants, const cJSON *value,
                         const struct world_mirror *mirror, struct reason *reason)
{
    if (cJSON_IsObject(value))
        return read_near(wants, value, mirror, reason);
    const char *text = cJSON_GetStringValue(value);
    wants->all = text && strcmp(text, "all") == 0;
    if (!wants->all && !cJSON_IsArray(value))
        return reason_set(reason, "not a list like [7,8], \"all\", or "
                                  "{\"near\":7,\"within_m\":500}");
    for (const cJSON *item = wants->all ? NULL : value->child; item; item = item->next) {
        if (wants->count == SUBSCRIPTION_ENTITIES_MAX)
            return reason_set(reason, "more than %u; ask for \"all\"", SUBSCRIPTION_ENTITIES_MAX);
        if (read_entity(&wants->id[wants->count++], item, mirror, reason) != 0)
            return -1;
    }
    return 0;
}

static const char *topic_word(uint32_t topic)
{
    return event_type_name((enum event_type)(EVENT_COLLISION + topic));
}

static int read_events(struct subscription *wants, const cJSON *value, struct reason *reason)
{
    const char *text = cJSON_GetStringValue(value);
    if (text && strcmp(text, "all") == 0) {
        wants->events = (1u << EVENT_MERGE_TOPICS) - 1;
        return 0;
    }
    if (!cJSON_IsArray(value))
        return reason_set(reason, "not a list like [\"fire\",\"collision\"], or \"all\"");
    for (const cJSON *item = value->child; item; item = item->next) {
        uint32_t topic = 0;
        const char *name = cJSON_GetStringValue(item);
        while (name && topic < EVENT_MERGE_TOPICS && strcmp(topic_word(topic), name) != 0)
            topic++;
        if (!name || topic == EVENT_MERGE_TOPICS)
            return reason_set(reason,
                              "'%.32s': not one of collision, fire, detonation, crater, "
                              "agent",
                              name ? name : "?");
        wants->events |= 1u << topic;
    }
    return 0;
}

static int read_member(struct subscription *wants, const cJSON *member,
                       const struct world_mirror *mirror, struct reason *reason)
{
    const char *name = member->string;
    if (strcmp(name, "entities") == 0)
        return read_entities(wants, member, mirror, reason);
    if (strcmp(name, "events") == 0)
        return read_events(wants, member, reason);
    if (strcmp(name, "frames") == 0) {
        wants->frames = cJSON_IsTrue(member);
        return cJSON_IsBool(member) ? 0 : reason_set(reason, "not true or false");
    }
    if (strcmp(name, "rate_hz") == 0) {
        wants->rate_hz = cJSON_IsNumber(member) ? member->valuedouble : 0.0;
        if (wants->rate_hz >= SUBSCRIPTION_RATE_MIN_HZ &&
            wants->rate_hz <= SUBSCRIPTION_RATE_MAX_HZ)
            return 0;
        return reason_set(reason, "not a number from %g to %g", SUBSCRIPTION_RATE_MIN_HZ,
                          SUBSCRIPTION_RATE_MAX_HZ);
    }
    return reason_set(reason, "no such thing; there are frames, entities, rate_hz, events");
}

int subscription_read(struct subscription *wants, const cJSON *want,
                      const struct world_mirror *mirror, struct reason *reason)
{
    struct subscription *read = calloc(1, sizeof *read);
    struct reason why;
    int result = 0;
    if (!read)
        return reason_set(reason, "want: out of memory");
    read->rate_hz = SUBSCRIPTION_RATE_HZ;
    read->from_run = mirror->world.run;
    read->from = mirror->frame.frame;
    read->missed = wants->missed;
    if (!cJSON_IsObject(want))
        result = reason_set(reason, "want: not an object like {\"entities\":[7,8]}");
    for (const cJSON *member = result == 0 ? want->child : NULL; member && result == 0;
         member = member->next) {
        if (read_member(read, member, mirror, &why) != 0)
            result = reason_set(reason, "want: %.32s: %.400s", member->string, why.text);
    }
    if (result == 0)
        *wants = *read;
    free(read);
    return result;
}

static bool subscription_entities(const struct subscription *wants)
{
    return wants->all || wants->near || wants->count;
}

static bool is_wanted(const struct subscription *wants, const jolon_Entity *entity,
                      const jolon_Entity *middle)
{
    if (wants->all)
        return true;
    if (wants->near) {
        double dx = middle ? entity->x_m - middle->x_m : 0.0;
        double dz = middle ? entity->z_m - middle->z_m : 0.0;
        return middle && dx * dx + dz * dz <= wants->within_m * wants->within_m;
    }
    for (uint32_t i = 0; i < wants->count; i++) {
        if (wants->id[i] == entity->id)
            return true;
    }
    return false;
}

static void put_line(struct output *output, enum output_sort sort, cJSON *object)
{
    char *line = cJSON_PrintUnformatted(object);
    output_line(output, sort, line);
    cJSON_free(line);
    cJSON_Delete(object);
}

static void tell_entities(const struct subscription *wants, const struct world_mirror *mirror,
                          struct output *output)
{
    const struct world_mirror_batch *batch = &mirror->batch;
    const jolon_Entity *middle = wants->near ? world_mirror_entity(mirror, wants->near) : NULL;
    cJSON *object = cJSON_CreateObject();
    cJSON *list = cJSON_AddArrayToObject(object, "entities");
    put_whole(object, "frame", batch->frame);
    for (uint32_t i = 0; i < batch->count; i++) {
        if (is_wanted(wants, &batch->entity[i], middle))
            (void)cJSON_AddItemToArray(list, entity_json(mirror, &batch->entity[i]));
    }
    put_line(output, OUTPUT_STATE, object);
}

static void tell_frame(const struct world_mirror *mirror, struct output *output, uint64_t now_ns)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    cJSON *object = cJSON_CreateObject();
    put_whole(object, "frame", frame->frame);
    put_number(object, "time_s", frame->sim_time_s);
    put_word(object, "state", world_mirror_run_state(mirror, now_ns));
    put_number(object, "rate_hz", frame->rate_hz);
    put_whole(object, "late_frames", frame->late_frames);
    put_whole(object, "vehicles", frame->vehicles);
    put_whole(object, "munitions", frame->munitions);
    put_whole(object, "events", frame->events);
    put_line(output, OUTPUT_STATE, object);
}

void subscription_states(struct subscription *wants, const struct world_mirror *mirror,
                         struct output *output, uint64_t now_ns)
{
    if (now_ns < subscription_due_ns(wants))
        return;
    uint64_t period_ns = (uint64_t)(NS_PER_S / wants->rate_hz);
    bool fresh = mirror->has_batch && mirror->batch.frame != wants->frame;
    if (subscription_entities(wants) && !fresh && !wants->frames) {
        wants->due_ns = now_ns + NS_PER_S / 100; /* the next batch is about to come */
        return;
    }
    wants->due_ns =
        wants->due_ns + period_ns > now_ns ? wants->due_ns + period_ns : now_ns + period_ns;
    if (!output_wants_states(output))
        return;
    if (wants->frames)
        tell_frame(mirror, output, now_ns);
    if (subscription_entities(wants) && fresh)
        tell_entities(wants, mirror, output);
    wants->frame = mirror->batch.frame;
}

uint64_t subscription_due_ns(const struct subscription *wants)
{
    return wants->frames || subscription_entities(wants) ? wants->due_ns : UINT64_MAX;
}

/* "T RUN FRAME {...}": T is the topic, as a letter from 'a'. */
void subscription_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    char json[EVENT_MERGE_LINE_MAX];
    const jolon_EventHeader *header = event;
    event_json(json, topic, event);
    int used =
        snprintf(line, EVENT_MERGE_LINE_MAX, "%c %llu %llu ", 'a' + (int)(topic - TOPIC_COLLISION),
                 (unsigned long long)header->run, (unsigned long long)header->frame);
    size_t length = strlen(json);
    if (length >= EVENT_MERGE_LINE_MAX - (size_t)used)
        length = (size_t)snprintf(json, sizeof json, "{\"type\":\"unprintable\"}");
    memcpy(line + used, json, length + 1);
}

struct telling {
    const struct subscription *wants;
    struct output *output;
};

static bool tell_event(void *context, const char *line)
{
    char told[EVENT_MERGE_LINE_MAX + 16];
    const struct telling *telling = context;
    char *at;
    uint64_t run = strtoull(line + 2, &at, 10);
    uint64_t frame = strtoull(at, &at, 10);
    const struct subscription *wants = telling->wants;
    if (!(wants->events & 1u << (line[0] - 'a')) || (run == wants->from_run && frame < wants->from))
        return true;
    (void)snprintf(told, sizeof told, "{\"event\":%s}", at + 1);
    output_line(telling->output, OUTPUT_EVENT, told);
    return true;
}

void subscription_events(struct subscription *wants, struct event_merge *tail,
                         struct output *output)
{
    struct telling telling = {.wants = wants, .output = output};
    if (!event_merge_turn(tail, tell_event, &telling))
        output->gone = true; /* no memory */
    if (tail->missed > wants->missed)
        output_missed(output, tail->missed - wants->missed);
    wants->missed = tail->missed;
}

char *subscription_world(const struct world_mirror *mirror)
{
    const jolon_WorldInfo *world = &mirror->world;
    cJSON *object = cJSON_CreateObject();
    put_word(object, "world", world->world);
    put_whole(object, "run", world->run);
    put_word(object, "ground", world->ground);
    put_number(object, "hz", world->hz);
    put_number(object, "side_m", world->side_m);
    put_whole(object, "capacity", world->capacity);
    (void)cJSON_AddBoolToObject(object, "real_time", world->real_time);
    cJSON *kinds = cJSON_AddArrayToObject(object, "kinds");
    for (uint32_t i = 0; i < world->kinds._length; i++) {
        const jolon_KindInfo *kind = &world->kinds._buffer[i];
        if (kind->domain == jolon_DOMAIN_FIXED)
            continue;
        cJSON *item = cJSON_CreateObject();
        put_word(item, "name", kind->name);
        put_word(item, "domain", domain_name((enum domain)kind->domain));
        put_single(item, "length_m", kind->length_m);
        put_single(item, "max_speed_mps", kind->max_speed_mps);
        put_single(item, "range_m", kind->range_m);
        (void)cJSON_AddItemToArray(kinds, item);
    }
    cJSON *names = cJSON_AddObjectToObject(object, "names");
    for (uint32_t i = 0; i < mirror->names.count; i++)
        put_whole(names, mirror->names.entry[i].name, mirror->names.entry[i].id);
    char *line = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    return line;
}
