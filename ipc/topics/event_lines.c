/* Events as text. */
#include "ipc/topics/event_lines.h"

#include "ipc/process/clock.h"
#include "world/event_text.h"

#include <stdio.h>

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

/* Writes the event without its time. */
static void write_text(char text[EVENT_TEXT_MAX], enum dds_topic topic, const void *sample)
{
    struct event event = {0};
    const char *kind[EVENT_TEXT_PARTIES] = {NULL};
    if (topic == TOPIC_COLLISION) {
        const jolon_CollisionEvent *collision = sample;
        event.type = EVENT_COLLISION;
        event.collision = (struct event_collision){.a = party(&collision->a),
                                                   .b = party(&collision->b),
                                                   .closing_mps = collision->closing_mps,
                                                   .response = collision->response};
        kind[EVENT_TEXT_FIRST] = collision->a.kind;
        kind[EVENT_TEXT_SECOND] = collision->b.kind;
    } else if (topic == TOPIC_FIRE) {
        const jolon_FireEvent *fire = sample;
        event.type = EVENT_FIRE;
        event.fire =
            (struct event_fire){.shooter = party(&fire->shooter), .target = party(&fire->target)};
        kind[EVENT_TEXT_FIRST] = fire->shooter.kind;
        kind[EVENT_TEXT_SECOND] = fire->target.kind;
        kind[EVENT_TEXT_MUNITION] = fire->munition.kind;
    } else if (topic == TOPIC_DETONATION) {
        const jolon_DetonationEvent *detonation = sample;
        event.type = EVENT_DETONATION;
        event.detonation = (struct event_detonation){.struck_party = party(&detonation->victim),
                                                     .struck = detonation->struck};
        kind[EVENT_TEXT_FIRST] = detonation->victim.kind;
        kind[EVENT_TEXT_MUNITION] = detonation->munition.kind;
    } else if (topic == TOPIC_CRATER) {
        const jolon_CraterEvent *crater = sample;
        event.type = EVENT_CRATER;
        event.crater =
            (struct event_crater){.radius_m = crater->radius_m, .depth_m = crater->depth_m};
    } else {
        const jolon_AgentEvent *agent = sample;
        event.type = EVENT_AGENT;
        event.agent = (struct event_agent){.agent = party(&agent->agent),
                                           .from = agent->before,
                                           .to = agent->after,
                                           .because = agent->because};
        kind[EVENT_TEXT_FIRST] = agent->agent.kind;
    }
    event_text(text, &event, kind);
}

void event_lines_event(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    char time[EVENT_LINES_CLOCK_MAX], words[EVENT_TEXT_MAX];
    const jolon_EventHeader *header = event;
    write_text(words, topic, event);
    (void)snprintf(line, EVENT_MERGE_LINE_MAX, "%s %s", event_lines_clock(time, header->time_s),
                   words);
}

void event_lines_ids(uint32_t ids[EVENT_LINES_IDS], enum dds_topic topic, const void *event)
{
    const jolon_CollisionEvent *collision = event;
    const jolon_FireEvent *fire = event;
    const jolon_DetonationEvent *detonation = event;
    const jolon_AgentEvent *agent = event;
    ids[0] = ids[1] = ids[2] = 0;
    if (topic == TOPIC_COLLISION) {
        ids[0] = collision->a.fixed ? 0 : collision->a.id;
        ids[1] = collision->b.fixed ? 0 : collision->b.id;
    } else if (topic == TOPIC_FIRE) {
        ids[0] = fire->shooter.id;
        ids[1] = fire->target.id;
        ids[2] = fire->munition.id;
    } else if (topic == TOPIC_DETONATION) {
        ids[0] = detonation->munition.id;
        ids[1] = detonation->victim.fixed ? 0 : detonation->victim.id;
    } else if (topic == TOPIC_AGENT) {
        ids[0] = agent->agent.id;
    }
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
