/* The status and the events as lines of text. */
#include "monitor/lines.h"

#include "ipc/clock.h"
#include "world/world.h"

#include <stdio.h>
#include <string.h>

#define CLOCK_MAX 32

/* 00:03:25.7 */
static const char *clock_text(char text[CLOCK_MAX], double time_s)
{
    unsigned long long tenths = time_s > 0.0 ? (unsigned long long)(time_s * 10.0 + 1e-6) : 0;
    (void)snprintf(text, CLOCK_MAX, "%02llu:%02llu:%02llu.%llu", tenths / 36000, tenths / 600 % 60,
                   tenths / 10 % 60, tenths % 10);
    return text;
}

/* "59.9 of 60.0 Hz", or without the second number when frames are made as fast as can be */
static const char *rate_text(char text[CLOCK_MAX], const struct mirror *mirror)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    if (mirror->has_world && !mirror->world.real_time)
        (void)snprintf(text, CLOCK_MAX, "%.1f Hz", frame->rate_hz);
    else
        (void)snprintf(text, CLOCK_MAX, "%.1f of %.1f Hz", frame->rate_hz,
                       frame->hz * frame->time_scale);
    return text;
}

void lines_status(char line[LINES_MAX], const struct mirror *mirror, uint64_t now_ns)
{
    char time[CLOCK_MAX], rate[CLOCK_MAX];
    const jolon_FrameStatus *frame = &mirror->frame;
    if (!mirror_live(mirror, now_ns)) {
        lines_notice(line, mirror, now_ns);
        return;
    }
    (void)snprintf(line, LINES_MAX,
                   "%s  frame %llu  %s  %s  frame %.2f ms  late %llu  vehicles %u  "
                   "munitions %u  collisions %llu  destroyed %llu  events %llu",
                   mirror_run_state(mirror, now_ns), (unsigned long long)frame->frame,
                   clock_text(time, frame->sim_time_s), rate_text(rate, mirror),
                   frame->frame_time.p50_ms, (unsigned long long)frame->late_frames,
                   frame->vehicles, frame->munitions, (unsigned long long)frame->tally.collisions,
                   (unsigned long long)frame->tally.destroyed, (unsigned long long)frame->events);
}

void lines_world(char line[LINES_MAX], const struct mirror *mirror, uint64_t now_ns)
{
    char time[CLOCK_MAX];
    (void)snprintf(line, LINES_MAX, "jolon  %s  %s%s%s  frame %llu  %s", mirror->name,
                   mirror_run_state(mirror, now_ns), mirror->has_world ? "  " : "",
                   mirror->has_world ? mirror->world.ground : "",
                   (unsigned long long)mirror->frame.frame,
                   clock_text(time, mirror->frame.sim_time_s));
}

void lines_frame(char line[LINES_MAX], const struct mirror *mirror)
{
    char rate[CLOCK_MAX];
    const jolon_FrameStatus *frame = &mirror->frame;
    (void)snprintf(line, LINES_MAX, "%s  late %llu  frame ms p50 %.2f p99 %.2f max %.2f  scale %g",
                   rate_text(rate, mirror), (unsigned long long)frame->late_frames,
                   frame->frame_time.p50_ms, frame->frame_time.p99_ms, frame->frame_time.max_ms,
                   frame->time_scale);
}

void lines_counts(char line[LINES_MAX], const struct mirror *mirror)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    (void)snprintf(line, LINES_MAX,
                   "vehicles %u  destroyed %llu  munitions %u  collisions %llu  fires %llu  "
                   "craters %u",
                   frame->vehicles, (unsigned long long)frame->tally.destroyed, frame->munitions,
                   (unsigned long long)frame->tally.collisions,
                   (unsigned long long)frame->tally.fires, frame->craters);
}

void lines_process_head(char line[LINES_MAX])
{
    (void)snprintf(line, LINES_MAX, "%-10s %-9s %8s %8s %8s %8s %8s %8s", "role", "state", "pid",
                   "beat ms", "p50 ms", "p99 ms", "max ms", "restarts");
}

void lines_process(char line[LINES_MAX], const jolon_ProcessStatus *status)
{
    (void)snprintf(line, LINES_MAX, "%-10s %-9s %8u %8.1f %8.3f %8.3f %8.3f %8llu", status->role,
                   mirror_process_state(status->state), status->pid, status->beat_age_ms,
                   status->stage_p50_ms, status->stage_p99_ms, status->stage_max_ms,
                   (unsigned long long)status->restarts);
}

void lines_notice(char line[LINES_MAX], const struct mirror *mirror, uint64_t now_ns)
{
    line[0] = '\0';
    if (!mirror->frame_ns)
        (void)snprintf(line, LINES_MAX,
                       "world '%s': waiting for its reporter; `jolon worlds` lists those there are",
                       mirror->name);
    else if (!mirror_live(mirror, now_ns))
        (void)snprintf(line, LINES_MAX,
                       "world '%s': silent for %llu s since frame %llu; waiting for its reporter",
                       mirror->name, (unsigned long long)((now_ns - mirror->frame_ns) / NS_PER_S),
                       (unsigned long long)mirror->frame.frame);
}

/* "tank 12", "tree 40211", "ground" */
static const char *party_text(char text[48], const jolon_Party *party)
{
    if (party->id)
        (void)snprintf(text, 48, "%s %u", party->kind, party->id);
    else
        (void)snprintf(text, 48, "%s", party->kind);
    return text;
}

static void put_collision(char *text, size_t bytes, const jolon_CollisionEvent *event)
{
    char a[48], b[48];
    (void)snprintf(text, bytes, "%s hit %s at %.1f m/s: %s", party_text(a, &event->a),
                   party_text(b, &event->b), (double)event->closing_mps,
                   response_name((enum response)event->response));
}

static void put_fire(char *text, size_t bytes, const jolon_FireEvent *event)
{
    char shooter[48], target[48];
    const char *by = event->shooter.id ? party_text(shooter, &event->shooter) : "the sky";
    if (event->target.id)
        (void)snprintf(text, bytes, "%s fired at %s", by, party_text(target, &event->target));
    else
        (void)snprintf(text, bytes, "%s fired a %s", by, event->munition.kind);
}

static void put_detonation(char *text, size_t bytes, const jolon_DetonationEvent *event)
{
    char victim[48];
    const char *struck = event->victim.id ? party_text(victim, &event->victim)
                                          : struck_name((enum struck)event->struck);
    (void)snprintf(text, bytes, "%s struck %s", event->munition.kind, struck);
}

void lines_event(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event)
{
    char time[CLOCK_MAX];
    const jolon_EventHeader *header = event;
    int used = snprintf(line, TAIL_LINE_MAX, "%s ", clock_text(time, header->time_s));
    char *text = line + used;
    size_t bytes = TAIL_LINE_MAX - (size_t)used;
    if (topic == TOPIC_COLLISION) {
        put_collision(text, bytes, event);
    } else if (topic == TOPIC_FIRE) {
        put_fire(text, bytes, event);
    } else if (topic == TOPIC_DETONATION) {
        put_detonation(text, bytes, event);
    } else if (topic == TOPIC_CRATER) {
        const jolon_CraterEvent *crater = event;
        (void)snprintf(text, bytes, "crater of %.1f m, %.1f m deep", (double)crater->radius_m,
                       (double)crater->depth_m);
    } else {
        const jolon_AgentEvent *agent = event;
        (void)snprintf(text, bytes, "%s %u: %s to %s, %s", agent->agent.kind, agent->agent.id,
                       behaviour_name((enum behaviour)agent->before),
                       behaviour_name((enum behaviour)agent->after),
                       agent_reason_name((enum agent_reason)agent->because));
    }
}
