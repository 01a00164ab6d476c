/* Prints frame, time, counts and speed on one line. */
#include "supervisor/progress.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/frame/snapshot.h"
#include "supervisor/process_set.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

struct progress progress_begin(void)
{
    return (struct progress){.live = isatty(STDERR_FILENO) == 1};
}

static void show(const struct progress *progress, const struct view *view)
{
    struct state_head head;
    if (snapshot_head(&head, view) != 0)
        return;
    const struct histogram *whole = &view->slot[ROLE_COLLIDER]->whole;
    fprintf(stderr,
            "%sframe %" PRIu64 "  %.1f s  %u vehicles  %u in flight  %" PRIu64
            " collisions  %" PRIu64 " shots  %" PRIu64 " destroyed  %.0f us a frame%s  %s",
            progress->live ? "\r" : "", head.frame, state_time_s(&view->world, &head),
            head.vehicles, head.munitions, head.tally.collisions, head.tally.fires,
            head.tally.destroyed, (double)histogram_quantile(whole, 0.5) / 1e3,
            head.paused ? "  paused" : "", progress->live ? "" : "\n");
    fflush(stderr);
}

void progress_update(struct progress *progress, const struct view *view)
{
    if (process_set_stderr_writable() &&
        log_due(&progress->shown_ns, progress->live ? NS_PER_S / 4 : 5 * (uint64_t)NS_PER_S))
        show(progress, view);
}

void progress_end(const struct progress *progress, const struct view *view)
{
    if (!progress->live)
        return;
    show(progress, view);
    fputc('\n', stderr);
}
