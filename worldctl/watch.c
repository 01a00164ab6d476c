/* Verb watch: the watchdog beside the supervisor. It kills a role whose heart stands still; the
 * supervisor, which waits for its children, starts it again once it is dead. */
#include "worldctl/verbs.h"

#include "ipc/clock.h"
#include "ipc/frame.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "worldctl/arguments.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define TICK_NS        (20 * (uint64_t)NS_PER_MS)
#define LATE_TICK_NS   (3 * TICK_NS) /* the watcher itself stood still: it judges nobody by that */
#define STARTING_NS    (10 * (uint64_t)NS_PER_S)
#define OTHERS_NS      (2 * (uint64_t)NS_PER_S) /* roles outside the frame loop */
#define STAGES_ALLOWED 8 /* a beat may be this many of its last frame's work old */

/* How long this role may be silent. */
static uint64_t allowed_ns(const struct view *view, enum role role, uint64_t hang_ns)
{
    const struct role_slot *slot = view->slot[role];
    uint64_t frames_ns = (uint64_t)(5e9 * view->world.params->dt_s);
    uint64_t work_ns = STAGES_ALLOWED * atomic_load(&slot->stage_ns);
    uint64_t allowed = hang_ns > frames_ns ? hang_ns : frames_ns;
    if (atomic_load(&slot->state) == ROLE_STARTING || atomic_load(&slot->frame) == 0)
        return STARTING_NS;
    if (role > ROLE_COLLIDER && allowed < OTHERS_NS)
        allowed = OTHERS_NS;
    return allowed > work_ns ? allowed : work_ns;
}

/* What the watcher remembers of a role since its last beat. */
struct watched {
    uint64_t beat_ns; /* the beat */
    uint64_t cpu_ns;  /* processor time that it had used then */
};

/* Processor time [ns] and state letter of a process; false when it is gone. */
static bool process_time(int pid, uint64_t *cpu_ns, char *state)
{
    char path[64], line[512];
    snprintf(path, sizeof path, "/proc/%d/schedstat", pid);
    FILE *file = fopen(path, "r");
    bool read = file && fgets(line, sizeof line, file);
    if (file)
        fclose(file);
    if (!read)
        return false;
    *cpu_ns = strtoull(line, NULL, 10);
    *state = process_state(pid);
    return *state != '\0';
}

/* A process that wants to run and is not let is starved by the machine, and no replacement would do
 * better; one that is stopped or blocked, or runs without beating, hangs. */
static bool starved(int pid, const struct watched *watched, uint64_t silent_ns)
{
    uint64_t cpu_ns;
    char state;
    return process_time(pid, &cpu_ns, &state) && state == 'R' &&
           cpu_ns - watched->cpu_ns < silent_ns / 2;
}

static void judge(const struct view *view, enum role role, struct watched *watched,
                  uint64_t since_ns, uint64_t hang_ns)
{
    const struct role_slot *slot = view->slot[role];
    uint64_t now = clock_now_ns();
    uint64_t beat = atomic_load(&slot->beat_ns);
    int pid = (int)atomic_load(&slot->pid);
    uint32_t state = atomic_load(&slot->state);
    uint64_t from = beat > since_ns ? beat : since_ns;
    char letter;
    if (pid == 0 || (state != ROLE_STARTING && state != ROLE_READY))
        return;
    if (beat != watched->beat_ns) {
        watched->beat_ns = beat;
        if (!process_time(pid, &watched->cpu_ns, &letter))
            watched->cpu_ns = 0;
        return;
    }
    if (now < from || now - from <= allowed_ns(view, role, hang_ns) ||
        starved(pid, watched, now - from))
        return;
    if (segment_holder(view->name, role) != pid)
        return; /* dead already, or another one took over */
    log_warn("%s (pid %d) has not beaten for %.0f ms: killing it", role_name(role), pid,
             (double)(now - beat) / 1e6);
    kill(pid, SIGKILL);
}

static void progress(const struct view *view, bool live)
{
    struct state_head head;
    if (snapshot_head(&head, view) != 0)
        return;
    const struct histogram *whole = &view->slot[ROLE_COLLIDER]->whole;
    fprintf(stderr,
            "%sframe %" PRIu64 "  %.1f s  %u vehicles  %u in flight  %" PRIu64
            " collisions  %" PRIu64 " shots  %" PRIu64 " destroyed  %.0f us a frame%s  %s",
            live ? "\r" : "", head.frame, world_time_s(&view->world, &head), head.vehicles,
            head.munitions, head.tally.collisions, head.tally.fires, head.tally.destroyed,
            (double)histogram_quantile(whole, 0.5) / 1e3, head.paused ? "  paused" : "",
            live ? "" : "\n");
    fflush(stderr);
}

int verb_watch(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    struct view view;
    bool live = isatty(STDERR_FILENO) == 1;
    log_open("watch");
    process_signals();
    process_die_with_parent(arguments.parent);
    arguments_attach(&arguments, &view);
    uint64_t since = clock_now_ns();
    uint64_t last = since, shown = 0;
    struct watched watched[ROLE_COUNT] = {0};
    while (!process_stopping()) {
        uint64_t now = clock_now_ns();
        if (now - last > LATE_TICK_NS)
            since = now;
        last = now;
        for (int role = 0; role < ROLE_COUNT; role++)
            judge(&view, (enum role)role, &watched[role], since, arguments.hang_ms * NS_PER_MS);
        if (arguments.progress && log_due(&shown, live ? NS_PER_S / 4 : 5 * (uint64_t)NS_PER_S))
            progress(&view, live);
        clock_sleep_until_ns(now + TICK_NS);
    }
    if (arguments.progress && live) { /* the line stays as the run's last word */
        progress(&view, live);
        fputc('\n', stderr);
    }
    segment_detach(&view);
    return EXIT_OK;
}
