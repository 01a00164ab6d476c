/* Notices, events and statistics as lines on standard output. */
#include "clients/drive/plain_output.h"

#include "clients/drive/status_panel.h"
#include "ipc/topics/event_lines.h"

#include <stdio.h>
#include <string.h>

static bool print_line(const char *text)
{
    return puts(text) >= 0 && fflush(stdout) == 0;
}

bool plain_output_show(struct plain_output *output, const struct session *session,
                       const struct recent_events *events, uint64_t now_ns)
{
    char line[STATUS_PANEL_LINE];
    bool good = true;
    if (output->notices != session->notices && !session->refused) {
        output->notices = session->notices;
        (void)snprintf(line, sizeof line, "# %s", session->notice);
        good = print_line(line);
    }
    for (; good && output->events_printed < events->count; output->events_printed++) {
        (void)snprintf(line, sizeof line, "! %s",
                       events->line[output->events_printed % RECENT_EVENTS_KEPT]);
        good = print_line(line);
    }
    if (now_ns < output->line_ns)
        return good;
    output->line_ns = now_ns + output->period_ns;
    bool silent = !world_mirror_live(session->mirror, now_ns), was_silent = output->silent;
    output->silent = silent;
    if (silent && was_silent)
        return good;
    if (silent)
        event_lines_silence(stpcpy(line, "# "), sizeof line - 2, session->mirror, now_ns);
    else
        status_panel_line(line, session);
    return good && print_line(line);
}
