/* Writes the status as lines of text. */
#include "clients/monitor/status_lines.h"

#include "ipc/process/clock.h"
#include "ipc/topics/event_lines.h"

#include <stdio.h>
#include <string.h>

/* "59.9 of 60.0 Hz"; without the second number if the world does not run in real time. */
static const char *rate_text(char text[EVENT_LINES_CLOCK_MAX], const struct world_mirror *mirror)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    if (mirror->has_world && !mirror->world.real_time)
        (void)snprintf(text, EVENT_LINES_CLOCK_MAX, "%.1f Hz", frame->rate_hz);
    else
        (void)snprintf(text, EVENT_LINES_CLOCK_MAX, "%.1f of %.1f Hz", frame->rate_hz,
                       frame->hz * frame->time_scale);
    return text;
}

void status_lines_status(char line[STATUS_LINES_MAX], const struct world_mirror *mirror,
                         uint64_t now_ns)
{
    char time[EVENT_LINES_CLOCK_MAX], rate[EVENT_LINES_CLOCK_MAX];
    const jolon_FrameStatus *frame = &mirror->frame;
    if (!world_mirror_live(mirror, now_ns)) {
        event_lines_silence(line, STATUS_LINES_MAX, mirror, now_ns);
        return;
    }
    (void)snprintf(line, STATUS_LINES_MAX,
                   "%s  frame %llu  %s  %s  frame %.2f ms  late %llu  vehicles %u  "
                   "munitions %u  collisions %llu  destroyed %llu  events %llu",
                   world_mirror_run_state(mirror, now_ns), (unsigned long long)frame->frame,
                   event_lines_clock(time, frame->sim_time_s), rate_text(rate, mirror),
                   frame->frame_time.p50_ms, (unsigned long long)frame->late_frames,
                   frame->vehicles, frame->munitions, (unsigned long long)frame->tally.collisions,
                   (unsigned long long)frame->tally.destroyed, (unsigned long long)frame->events);
}

void status_lines_world(char line[STATUS_LINES_MAX], const struct world_mirror *mirror,
                        uint64_t now_ns)
{
    char time[EVENT_LINES_CLOCK_MAX];
    (void)snprintf(line, STATUS_LINES_MAX, "jolon  %s  %s%s%s  frame %llu  %s", mirror->name,
                   world_mirror_run_state(mirror, now_ns), mirror->has_world ? "  " : "",
                   mirror->has_world ? mirror->world.ground : "",
                   (unsigned long long)mirror->frame.frame,
                   event_lines_clock(time, mirror->frame.sim_time_s));
}

void status_lines_frame(char line[STATUS_LINES_MAX], const struct world_mirror *mirror)
{
    char rate[EVENT_LINES_CLOCK_MAX];
    const jolon_FrameStatus *frame = &mirror->frame;
    (void)snprintf(
        line, STATUS_LINES_MAX, "%s  late %llu  frame ms p50 %.2f p99 %.2f max %.2f  scale %g",
        rate_text(rate, mirror), (unsigned long long)frame->late_frames, frame->frame_time.p50_ms,
        frame->frame_time.p99_ms, frame->frame_time.max_ms, frame->time_scale);
}

void status_lines_counts(char line[STATUS_LINES_MAX], const struct world_mirror *mirror)
{
    const jolon_FrameStatus *frame = &mirror->frame;
    (void)snprintf(line, STATUS_LINES_MAX,
                   "vehicles %u  destroyed %llu  munitions %u  collisions %llu  fires %llu  "
                   "craters %u",
                   frame->vehicles, (unsigned long long)frame->tally.destroyed, frame->munitions,
                   (unsigned long long)frame->tally.collisions,
                   (unsigned long long)frame->tally.fires, frame->craters);
}

void status_lines_process_head(char line[STATUS_LINES_MAX])
{
    (void)snprintf(line, STATUS_LINES_MAX, "%-10s %-9s %8s %8s %8s %8s %8s %8s", "role", "state",
                   "pid", "beat ms", "p50 ms", "p99 ms", "max ms", "restarts");
}

void status_lines_process(char line[STATUS_LINES_MAX], const jolon_ProcessStatus *status)
{
    (void)snprintf(line, STATUS_LINES_MAX, "%-10s %-9s %8u %8.1f %8.3f %8.3f %8.3f %8llu",
                   status->role, world_mirror_process_state(status->state), status->pid,
                   status->beat_age_ms, status->stage_p50_ms, status->stage_p99_ms,
                   status->stage_max_ms, (unsigned long long)status->restarts);
}
