/* Events as text. */
#include "ipc/topics/event_lines.h"

#include "ipc/process/clock.h"
#include "world/event_text.h"
#include "world/runtime/check.h"

#include <stdio.h>
#include <string.h>

const char *event_lines_clock(char text[EVENT_LINES_CLOCK_MAX], double time_s)
{
    unsigned long long tenths = time_s > 0.0 ? (unsigned long long)(time_s * 10.0 + 1e-6) : 0;
    (void)snprintf(text, EVENT_LINES_CLOCK_MAX, "%02llu:%02llu:%02llu.%llu", tenths / 36000,
                   tenths / 600 % 60, tenths / 10 % 60, tenths % 10);
    return text;
}

static struct event_party party(const jolon_Party *party)
{
    return (struct event_party){.id = party->id, .damage = (uint8_t)party->damage};
}

/* What the text of an event needs, and the ids of the entities that it is about. */
struct reading {
    struct event event;
    const char *kind[EVENT_TEXT_PARTIES];
    uint32_t ids[EVENT_LINES_IDS];
};

static uint32_t entity_id(const jolon_Party *party)
{
    return party->fixed ? 0 : party->id;
}

static void read_collision(struct reading *reading, const jolon_CollisionEvent *collision)
{
    reading->event.collision = (struct event_collision){.a = party(&collision->a),
                                                        .b = party(&collision->b),
                                                        .closing_mps = collision->closing_mps,
                                                        .response = collision->response};
    reading->kind[EVENT_TEXT_FIRST] = collision->a.kind;
    reading->kind[EVENT_TEXT_SECOND] = collision->b.kind;
    reading->ids[0] = entity_id(&collision->a);
    reading->ids[1] = entity_id(&collision->b);
}

static void read_fire(struct reading *reading, const jolon_FireEvent *fire)
{
    reading->event.fire =
        (struct event_fire){.shooter = party(&fire->shooter), .target = party(&fire->target)};
    reading->kind[EVENT_TEXT_FIRST] = fire->shooter.kind;
    reading->kind[EVENT_TEXT_SECOND] = fire->target.kind;
    reading->kind[EVENT_TEXT_MUNITION] = fire->munition.kind;
    reading->ids[0] = fire->shooter.id;
    reading->ids[1] = fire->target.id;
    reading->ids[2] = fire->munition.id;
}

static void read_detonation(struct reading *reading, const jolon_DetonationEvent *detonation)
{
    reading->event.detonation = (struct event_detonation){
        .struck_party = party(&detonation->victim), .struck = detonation->struck};
    reading->kind[EVENT_TEXT_FIRST] = detonation->victim.kind;
    reading->kind[EVENT_TEXT_MUNITION] = detonation->munition.kind;
    reading->ids[0] = detonation->munition.id;
    reading->ids[1] = entity_id(&detonation->victim);
}

static void read_crater(struct reading *reading, const jolon_CraterEvent *crater)
{
    reading->event.crater =
        (struct event_crater){.radius_m = crater->radius_m, .depth_m = crater->depth_m};
}

static void read_agent(struct reading *reading, const jolon_AgentEvent *agent)
{
    reading->event.agent = (struct event_agent){.agent = party(&agent->agent),
                                                .from = agent->before,
                                                .to = agent->after,
                                                .because = agent->because};
    reading->kind[EVENT_TEXT_FIRST] = agent->agent.kind;
    reading->ids[0] = agent->agent.id;
}

static void read_contact_end(struct reading *reading, const jolon_ContactEndEvent *end)
{
    reading->event.contact_end = (struct event_contact_end){
        .a = party(&end->a),
        .b = party(&end->b),
        .lasted_s = end->lasted_s,
        .because = end->because};
    reading->kind[EVENT_TEXT_FIRST] = end->a.kind;
    reading->kind[EVENT_TEXT_SECOND] = end->b.kind;
    reading->ids[0] = entity_id(&end->a);
    reading->ids[1] = entity_id(&end->b);
}

static struct reading read_event(enum dds_topic topic, const void *sample)
{
    struct reading reading = {.event.type = topic - TOPIC_EVENTS + 1u};
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

void event_lines_event(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    char time[EVENT_LINES_CLOCK_MAX], words[EVENT_TEXT_MAX];
    const jolon_EventHeader *header = event;
    struct reading reading = read_event(topic, event);
    event_text(words, &reading.event, reading.kind);
    (void)snprintf(line, EVENT_MERGE_LINE_MAX, "%s %s", event_lines_clock(time, header->time_s),
                   words);
}

void event_lines_ids(uint32_t ids[EVENT_LINES_IDS], enum dds_topic topic, const void *event)
{
    struct reading reading = read_event(topic, event);
    memcpy(ids, reading.ids, sizeof reading.ids);
}

void event_lines_silence(char *line, size_t bytes, const struct world_mirror *mirror,
                         uint64_t now_ns)
{
    line[0] = '\0';
    if (!mirror->frame_ns)
        (void)snprintf(line, bytes,
                       "world '%s': waiting for its reporter; `jolon worlds` lists the worlds",
                       mirror->name);
    else if (!world_mirror_live(mirror, now_ns))
        (void)snprintf(line, bytes,
                       "world '%s': silent for %llu s since frame %llu; waiting for its reporter",
                       mirror->name, (unsigned long long)((now_ns - mirror->frame_ns) / NS_PER_S),
                       (unsigned long long)mirror->frame.frame);
}
