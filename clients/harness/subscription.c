/* Reads subscriptions and writes what is subscribed to. */
#include "clients/harness/subscription.h"

#include "ipc/process/clock.h"
#include "ipc/topics/entity_json.h"
#include "ipc/topics/event_json.h"
#include "ipc/json/world_json.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/event_text.h"
#include "world/terrain/location.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int read_entity(uint32_t *id, const cJSON *item, const struct world_mirror *mirror,
                       struct error_text *error)
{
    const char *name = cJSON_GetStringValue(item);
    if (name) {
        *id = name_table_find(&mirror->names, name);
        return *id ? 0 : error_text_set(error, "'%.32s': no vehicle has that name", name);
    }
    double value = cJSON_IsNumber(item) ? item->valuedouble : 0.0;
    *id = value >= 1.0 && value <= UINT32_MAX ? (uint32_t)value : 0;
    if (!*id || (double)*id != value)
        return error_text_set(error, "not the id or the name of a vehicle");
    return 0;
}

static int read_near(struct subscription *subscription, const cJSON *object,
                     const struct world_mirror *mirror, struct error_text *error)
{
    const cJSON *near = cJSON_GetObjectItemCaseSensitive(object, "near");
    const cJSON *within = cJSON_GetObjectItemCaseSensitive(object, "within_m");
    if (!near || !cJSON_IsNumber(within) || !(within->valuedouble >= 0.0))
        return error_text_set(error, "not like {\"near\":7,\"within_m\":500}");
    subscription->within_m = within->valuedouble;
    return read_entity(&subscription->near, near, mirror, error);
}

static int read_entities(struct subscription *subscription, const cJSON *value,
                         const struct world_mirror *mirror, struct error_text *error)
{
    if (cJSON_IsObject(value))
        return read_near(subscription, value, mirror, error);
    const char *text = cJSON_GetStringValue(value);
    subscription->all = text && strcmp(text, "all") == 0;
    if (!subscription->all && !cJSON_IsArray(value))
        return error_text_set(error, "not a list like [7,8], \"all\", or "
                                     "{\"near\":7,\"within_m\":500}");
    for (const cJSON *item = subscription->all ? NULL : value->child; item; item = item->next) {
        if (subscription->count == SUBSCRIPTION_ENTITIES_MAX)
            return error_text_set(error, "more than %u; ask for \"all\"",
                                  SUBSCRIPTION_ENTITIES_MAX);
        if (read_entity(&subscription->id[subscription->count++], item, mirror, error) != 0)
            return -1;
    }
    return 0;
}

#define LISTED(tag, word) ", " #word
static const char types[] = EVENT_TYPES_WITH_TOPIC(LISTED); /* begins with a comma */

static const char *topic_word(uint32_t topic)
{
    return event_type_name((enum event_type)(EVENT_NONE + 1 + topic));
}

static int read_events(struct subscription *subscription, const cJSON *value,
                       struct error_text *error)
{
    const char *text = cJSON_GetStringValue(value);
    if (text && strcmp(text, "all") == 0) {
        subscription->events = (1u << EVENT_TOPIC_COUNT) - 1;
        return 0;
    }
    if (!cJSON_IsArray(value))
        return error_text_set(error, "not a list like [\"fire\",\"collision\"], or \"all\"");
    for (const cJSON *item = value->child; item; item = item->next) {
        uint32_t topic = 0;
        const char *name = cJSON_GetStringValue(item);
        while (name && topic < EVENT_TOPIC_COUNT && strcmp(topic_word(topic), name) != 0)
            topic++;
        if (!name || topic == EVENT_TOPIC_COUNT)
            return error_text_set(error, "'%.32s': not one of %s", name ? name : "?", types + 2);
        subscription->events |= 1u << topic;
    }
    return 0;
}

static int read_member(struct subscription *subscription, const cJSON *member,
                       const struct world_mirror *mirror, struct error_text *error)
{
    const char *name = member->string;
    if (strcmp(name, "entities") == 0)
        return read_entities(subscription, member, mirror, error);
    if (strcmp(name, "events") == 0)
        return read_events(subscription, member, error);
    if (strcmp(name, "frames") == 0) {
        subscription->frames = cJSON_IsTrue(member);
        return cJSON_IsBool(member) ? 0 : error_text_set(error, "not true or false");
    }
    if (strcmp(name, "places") == 0) {
        subscription->places = cJSON_IsTrue(member);
        return cJSON_IsBool(member) ? 0 : error_text_set(error, "not true or false");
    }
    if (strcmp(name, "rate_hz") == 0) {
        subscription->rate_hz = cJSON_IsNumber(member) ? member->valuedouble : 0.0;
        if (subscription->rate_hz >= SUBSCRIPTION_RATE_MIN_HZ &&
            subscription->rate_hz <= SUBSCRIPTION_RATE_MAX_HZ)
            return 0;
        return error_text_set(error, "not a number from %g to %g", SUBSCRIPTION_RATE_MIN_HZ,
                              SUBSCRIPTION_RATE_MAX_HZ);
    }
    return error_text_set(error, "no such member; there are frames, entities, places, rate_hz, "
                                 "events");
}

int subscription_read(struct subscription *subscription, const cJSON *want,
                      const struct world_mirror *mirror, struct error_text *error)
{
    struct subscription *read = calloc(1, sizeof *read);
    struct error_text detail;
    int result = 0;
    if (!read)
        return error_text_set(error, "want: out of memory");
    read->rate_hz = SUBSCRIPTION_RATE_HZ;
    read->from_run = mirror->world.run;
    read->from = mirror->frame.frame;
    read->missed = subscription->missed;
    if (!cJSON_IsObject(want))
        result = error_text_set(error, "want: not an object like {\"entities\":[7,8]}");
    for (const cJSON *member = result == 0 ? want->child : NULL; member && result == 0;
         member = member->next) {
        if (read_member(read, member, mirror, &detail) != 0)
            result = error_text_set(error, "want: %.32s: %.400s", member->string, detail.text);
    }
    if (result == 0)
        *subscription = *read;
    free(read);
    return result;
}

static bool subscription_entities(const struct subscription *subscription)
{
    return subscription->all || subscription->near || subscription->count;
}

static bool is_wanted(const struct subscription *subscription, const jolon_Entity *entity,
                      const jolon_Entity *middle)
{
    if (subscription->all)
        return true;
    if (subscription->near) {
        double dx = middle ? entity->x_m - middle->x_m : 0.0;
        double dz = middle ? entity->z_m - middle->z_m : 0.0;
        return middle && dx * dx + dz * dz <= subscription->within_m * subscription->within_m;
    }
    for (uint32_t i = 0; i < subscription->count; i++) {
        if (subscription->id[i] == entity->id)
            return true;
    }
    return false;
}

static void add_place(cJSON *object, const struct location_frame *frame, const jolon_Entity *entity)
{
    struct location_earth earth;
    location_earth(&earth, frame, entity->x_m, entity->z_m);
    json_number(object, "latitude_deg", earth.latitude_deg);
    json_number(object, "longitude_deg", earth.longitude_deg);
    json_text(object, "mgrs", earth.mgrs);
}

static void write_entities(const struct subscription *subscription,
                           const struct world_mirror *mirror, struct output *output)
{
    const struct world_mirror_batch *batch = &mirror->batch;
    const jolon_Entity *middle =
        subscription->near ? world_mirror_entity(mirror, subscription->near) : NULL;
    cJSON *object = cJSON_CreateObject();
    cJSON *list = json_array(object, "entities");
    struct location_frame frame;
    location_frame_make(&frame, mirror->world.latitude_deg, mirror->world.longitude_deg,
                        mirror->world.side_m);
    json_whole(object, "frame", batch->frame);
    for (uint32_t i = 0; i < batch->count; i++) {
        if (!is_wanted(subscription, &batch->entity[i], middle))
            continue;
        cJSON *entity = entity_json(mirror, &batch->entity[i]);
        if (subscription->places)
            add_place(entity, &frame, &batch->entity[i]);
        (void)cJSON_AddItemToArray(list, entity);
    }
    output_object(output, OUTPUT_STATE, object);
}

static void write_frame(const struct world_mirror *mirror, struct output *output, uint64_t now_ns)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "frame", frame->frame);
    json_number(object, "time_s", frame->sim_time_s);
    json_text(object, "state", world_mirror_run_state(mirror, now_ns));
    json_number(object, "rate_hz", frame->rate_hz);
    json_whole(object, "late_frames", frame->late_frames);
    json_whole(object, "vehicles", frame->vehicles);
    json_whole(object, "munitions", frame->munitions);
    json_whole(object, "events", frame->events);
    output_object(output, OUTPUT_STATE, object);
}

void subscription_states(struct subscription *subscription, const struct world_mirror *mirror,
                         struct output *output, uint64_t now_ns)
{
    if (now_ns < subscription_due_ns(subscription))
        return;
    uint64_t period_ns = (uint64_t)(NS_PER_S / subscription->rate_hz);
    bool fresh = mirror->has_batch && mirror->batch.frame != subscription->frame;
    if (subscription_entities(subscription) && !fresh && !subscription->frames) {
        subscription->due_ns = now_ns + NS_PER_S / 100; /* the next batch is about to come */
        return;
    }
    subscription->due_ns = subscription->due_ns + period_ns > now_ns
                               ? subscription->due_ns + period_ns
                               : now_ns + period_ns;
    if (!output_takes_states(output))
        return;
    if (subscription->frames)
        write_frame(mirror, output, now_ns);
    if (subscription_entities(subscription) && fresh)
        write_entities(subscription, mirror, output);
    subscription->frame = mirror->batch.frame;
}

uint64_t subscription_due_ns(const struct subscription *subscription)
{
    return subscription->frames || subscription_entities(subscription) ? subscription->due_ns
                                                                       : UINT64_MAX;
}

/* "T RUN FRAME {...}": T is the topic, as a letter from 'a'. */
void subscription_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    char json[EVENT_MERGE_LINE_MAX];
    const jolon_EventHeader *header = event;
    event_json(json, topic, event);
    int used =
        snprintf(line, EVENT_MERGE_LINE_MAX, "%c %llu %llu ", 'a' + (int)(topic - TOPIC_EVENTS),
                 (unsigned long long)header->run, (unsigned long long)header->frame);
    size_t length = strlen(json);
    if (length >= EVENT_MERGE_LINE_MAX - (size_t)used)
        length = (size_t)snprintf(json, sizeof json, "{\"type\":\"unprintable\"}");
    memcpy(line + used, json, length + 1);
}

struct event_output {
    const struct subscription *subscription;
    struct output *output;
};

static bool write_event(void *context, const char *line)
{
    char text[EVENT_MERGE_LINE_MAX + 16];
    const struct event_output *target = context;
    char *at;
    uint64_t run = strtoull(line + 2, &at, 10);
    uint64_t frame = strtoull(at, &at, 10);
    const struct subscription *subscription = target->subscription;
    if (!(subscription->events & 1u << (line[0] - 'a')) ||
        (run == subscription->from_run && frame < subscription->from))
        return true;
    (void)snprintf(text, sizeof text, "{\"event\":%s}", at + 1);
    output_line(target->output, OUTPUT_EVENT, text);
    return true;
}

void subscription_events(struct subscription *subscription, struct event_merge *merge,
                         struct output *output)
{
    struct event_output target = {.subscription = subscription, .output = output};
    if (!event_merge_poll(merge, write_event, &target))
        output->closed = true; /* no memory */
    if (merge->missed > subscription->missed)
        output_missed(output, merge->missed - subscription->missed);
    subscription->missed = merge->missed;
}

cJSON *subscription_world(const struct world_mirror *mirror)
{
    const jolon_WorldInfo *world = &mirror->world;
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", world->world);
    json_whole(object, "run", world->run);
    json_text(object, "ground", world->ground);
    json_number(object, "hz", world->hz);
    json_number(object, "side_m", world->side_m);
    json_number(object, "latitude_deg", world->latitude_deg);
    json_number(object, "longitude_deg", world->longitude_deg);
    json_whole(object, "capacity", world->capacity);
    json_bool(object, "real_time", world->real_time);
    cJSON *kinds = json_array(object, "kinds");
    for (uint32_t i = 0; i < world->kinds._length; i++) {
        const jolon_KindInfo *kind = &world->kinds._buffer[i];
        if (kind->domain == jolon_DOMAIN_FIXED)
            continue;
        cJSON *item = cJSON_CreateObject();
        json_text(item, "name", kind->name);
        json_text(item, "domain", domain_name((enum domain)kind->domain));
        json_single(item, "length_m", kind->length_m);
        json_single(item, "max_speed_mps", kind->max_speed_mps);
        json_single(item, "range_m", kind->range_m);
        (void)cJSON_AddItemToArray(kinds, item);
    }
    cJSON *names = json_object(object, "names");
    for (uint32_t i = 0; i < mirror->names.count; i++)
        json_whole(names, mirror->names.entry[i].name, mirror->names.entry[i].id);
    return object;
}
