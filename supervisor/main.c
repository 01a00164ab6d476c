/* jolon-keeper: keeps the processes of a world going until its run is over. The script jolon turns
 * into it once the world is made, with the set's lock held; nobody else starts it.
 *
 * One thread, one loop: children's deaths and requests come as signals that it waits for, and
 * between them it looks after the hearts. SIGTERM, SIGINT and SIGHUP end the set; SIGCONT ends
 * every pause before a restart. It restarts a child only after the kernel has reported its death,
 * and its own death takes them all along (they ask the kernel for that). */
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_locks.h"
#include "supervisor/confine.h"
#include "supervisor/options.h"
#include "supervisor/progress.h"
#include "supervisor/process_set.h"
#include "supervisor/watchdog.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define READY_NS         (15 * (uint64_t)NS_PER_S) /* for a role to be up before the next one starts */
#define HEIR_NS          (20 * (uint64_t)NS_PER_MS)
#define LAST_WORDS_BYTES 65536L                   /* of the log's end are looked through for them */
#define LEFT_NS          (5 * (uint64_t)NS_PER_S) /* for the processes of a dead set to be gone */

struct keeper {
    const struct plan *plan;
    struct process_set set;
    struct watchdog watchdog;
    struct progress progress;
    sigset_t signals;
    bool over; /* the run has ended, or the set gives up */
    bool gave_up;
    bool starting; /* not everybody is up yet */
    int code;
    uint64_t repaired_frame; /* the last repair was at this frame, UINT64_MAX: there was none */
    uint64_t begun_ns;
};

static void give_up(struct keeper *keeper, int code, const char *error)
{
    keeper->over = keeper->gave_up = true;
    keeper->code = code;
    process_set_note(&keeper->set, "the set gave up: %s", error);
}

/* Keeps the world as it is before a frame that kills whoever makes it, with what the frame is made
 * from, and ends the set. */
static void keep_poison(struct keeper *keeper, enum role role, int status)
{
    char path[4096], text[5000];
    uint64_t frame = process_set_frame(&keeper->set);
    process_set_kill(&keeper->set, role);
    int length = snprintf(path, sizeof path, "%s/poison-frame-%" PRIu64 ".jolon", keeper->plan->out,
                          frame + 1);
    int written =
        snprintf(text, sizeof text, "%s died %u times on frame %" PRIu64 ", last with status %d",
                 role_name(role), RESTART_POLICY_SAME_FRAME_DEATHS, frame + 1, status);
    const char *const save[] = {"jolon-world",       "save", "--inputs", "--world",
                                keeper->plan->world, "--",   path,       NULL};
    if (length < (int)sizeof path &&
        process_set_run(&keeper->set, "jolon-world", save, true) == EXIT_OK)
        snprintf(text + written, sizeof text - (size_t)written,
                 "; run it again with `jolon world replay-frame %s`", path);
    give_up(keeper, EXIT_GAVE_UP, text);
}

/* The role's own last line in a text, which is closed afterwards, for what it refused. */
static void last_words(const struct keeper *keeper, FILE *said, enum role role, char *text,
                       size_t size)
{
    char prefix[48], line[1024];
    int length = snprintf(prefix, sizeof prefix, "jolon-%s: ", role_name(role));
    snprintf(text, size, "%s refused; %s says why", role_name(role), keeper->plan->log);
    while (said && fgets(line, sizeof line, said)) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, prefix, (size_t)length) == 0)
            snprintf(text, size, "%s refused: %s", role_name(role), line + length);
    }
    if (said)
        fclose(said);
}

static FILE *end_of_log(const struct keeper *keeper)
{
    FILE *log = fopen(keeper->plan->log, "re");
    if (log && fseek(log, -LAST_WORDS_BYTES, SEEK_END) != 0)
        rewind(log); /* it is shorter */
    return log;
}

/* A frame role found the world damaged: it is taken back to its last whole frame, once a frame. */
static void repair(struct keeper *keeper, enum role role)
{
    char text[PROCESS_SET_WORDS_MAX];
    const char *const repair_verb[] = {"jolon-world", "repair", "--world", keeper->plan->world,
                                       NULL};
    uint64_t frame = process_set_frame(&keeper->set);
    last_words(keeper, end_of_log(keeper), role, text, sizeof text);
    process_set_kill(&keeper->set, ROLE_MOVER);
    process_set_kill(&keeper->set, ROLE_COLLIDER);
    /* They may have read what was damaged: they begin anew as well. */
    process_set_kill(&keeper->set, ROLE_RECORDER);
    process_set_kill(&keeper->set, ROLE_INTAKE);
    process_set_kill(&keeper->set, ROLE_REPORTER);
    if (frame == keeper->repaired_frame || !strstr(text, "damaged") ||
        process_set_run(&keeper->set, "jolon-world", repair_verb, true) != EXIT_OK) {
        give_up(keeper, EXIT_REFUSED, text);
        return;
    }
    keeper->repaired_frame = process_set_frame(&keeper->set);
    process_set_note(&keeper->set, "%s; repaired, goes on from frame %" PRIu64, text,
                     keeper->repaired_frame);
}

/* Says once what a role refuses, however often it is tried again, and anew when that changes. */
static void tell_refusal(struct keeper *keeper, struct post *post)
{
    char text[PROCESS_SET_WORDS_MAX];
    struct words *words = &post->words;
    words_take(words, keeper->set.log_fd, false);
    FILE *said = words->used > 0 ? fmemopen(words->text, words->used, "r") : end_of_log(keeper);
    last_words(keeper, said, post->role, text, sizeof text);
    bool news = strcmp(text, post->refused) != 0;
    words_end(words, keeper->set.log_fd, news);
    if (news)
        process_set_note(&keeper->set, "goes on without the %s and keeps trying: %s",
                         role_name(post->role), text);
    snprintf(post->refused, sizeof post->refused, "%s", text);
}

static void take_death(struct keeper *keeper, struct post *post, struct child *child, int status)
{
    const struct child *heir = process_set_holder(&keeper->set, post->role);
    struct child dead = *child;
    char text[PROCESS_SET_WORDS_MAX];
    uint64_t delay = 0;
    struct death death = {.role = post->role,
                          .status = status,
                          /* Stopped from outside: no more its own doing than a kill. */
                          .hung = dead.hung && dead.stopped_ns == 0,
                          .stood_by = !dead.was_ready && heir && heir != child,
                          .was_ready = dead.was_ready,
                          .finished = frame_protocol_finished(&keeper->set.view),
                          .frame = process_set_frame(&keeper->set),
                          .frame_at_start = dead.frame_at_start,
                          .lived_ns = clock_now_ns() - dead.spawned_ns};
    *child = (struct child){0};
    switch (restart_policy_death(&post->history, &death, &delay)) {
    case VERDICT_RESTART:
        if (keeper->starting && post->role == ROLE_RECORDER && restart_policy_refused(status)) {
            last_words(keeper, end_of_log(keeper), post->role, text, sizeof text);
            give_up(keeper, EXIT_REFUSED, text); /* nobody asked for a run without a record */
            break;
        }
        /* Who stands by takes over now: another one to stand by has time until that is done. */
        if (delay == 0 && process_set_kept(post))
            delay = HEIR_NS;
        post->spawn_at_ns = clock_now_ns() + delay;
        bool refused = restart_policy_refused(status) && !death.stood_by;
        if (refused)
            tell_refusal(keeper, post);
        else if (dead.was_ready)
            post->refused[0] = '\0';
        process_set_spawn(&keeper->set, clock_now_ns());
        if (refused)
            break;
        process_set_note(&keeper->set, "%s (pid %d) ended with status %d at frame %" PRIu64,
                         role_name(post->role), dead.pid, status, death.frame);
        break;
    case VERDICT_FINISHED:
        keeper->over |= post->role == ROLE_MOVER; /* the collider's end comes before */
        post->wanted = 0;
        break;
    case VERDICT_REFUSED:
        repair(keeper, post->role);
        break;
    case VERDICT_POISON:
        keep_poison(keeper, post->role, status);
        break;
    case VERDICT_GIVE_UP:
        snprintf(text, sizeof text,
                 "%s died again and again without getting anything done, last with status %d",
                 role_name(post->role), status);
        give_up(keeper, EXIT_GAVE_UP, text);
        break;
    }
}

/* Every child that changed its state since the last look. */
static void take_children(struct keeper *keeper)
{
    struct child *child;
    int status;
    for (;;) {
        pid_t pid = waitpid(-1, &status, WNOHANG | WUNTRACED | WCONTINUED);
        if (pid <= 0)
            return;
        struct post *post = process_set_find(&keeper->set, pid, &child);
        if (!post)
            continue;
        if (WIFSTOPPED(status))
            child->stopped_ns = clock_now_ns();
        else if (WIFCONTINUED(status))
            child->stopped_ns = 0;
        else if (!keeper->over)
            take_death(keeper, post, child, process_set_status(status));
        else
            *child = (struct child){0};
    }
}

/* Waits for a signal or the next tick, and does what either asks for. */
static void turn(struct keeper *keeper)
{
    const struct timespec tick = {.tv_nsec = (long)WATCHDOG_TICK_NS};
    int signal_number = sigtimedwait(&keeper->signals, NULL, &tick);
    if (signal_number == SIGCONT)
        process_set_hurry(&keeper->set);
    else if (signal_number > 0 && signal_number != SIGCHLD)
        keeper->over = true;
    take_children(keeper);
    process_set_listen(&keeper->set);
    if (keeper->over)
        return;
    uint64_t now = clock_now_ns();
    watchdog_turn(&keeper->watchdog, &keeper->set, now);
    process_set_spawn(&keeper->set, now);
    if (!keeper->plan->background && !keeper->plan->json)
        progress_turn(&keeper->progress, &keeper->set.view);
}

/* Is the role still to be waited for? Not when it is left out, refused, or dies again and again. */
static bool starts(const struct post *post)
{
    return post->wanted > 0 && post->refused[0] == '\0' &&
           post->history.quick_crashes < RESTART_POLICY_QUICK_CRASHES;
}

/* One role after the other, the mover last: frames begin when everybody is there to see them. */
static void start_set(struct keeper *keeper)
{
    static const enum role order[] = {ROLE_COLLIDER, ROLE_RECORDER, ROLE_INTAKE, ROLE_REPORTER,
                                      ROLE_RENDERER, ROLE_CONSOLE,  ROLE_MOVER};
    struct process_set *set = &keeper->set;
    int wanted[ROLE_COUNT];
    for (int i = 0; i < ROLE_COUNT; i++) {
        wanted[i] = set->post[i].wanted;
        set->post[i].wanted = 0;
    }
    for (size_t i = 0; i < sizeof order / sizeof order[0] && !keeper->over; i++) {
        struct post *post = &set->post[order[i]];
        uint64_t until = clock_now_ns() + READY_NS;
        post->wanted = wanted[order[i]];
        process_set_spawn(set, clock_now_ns());
        while (!keeper->over && !process_set_ready(set, order[i]) && starts(post)) {
            turn(keeper);
            if (clock_now_ns() > until) {
                process_set_note(set, "the %s is not ready after %.0f s; goes on meanwhile",
                                 role_name(order[i]), (double)READY_NS / 1e9);
                break;
            }
        }
    }
    /* Now somebody to stand by for each who makes frames. */
    for (int i = 0; i < ROLE_COUNT && !keeper->over; i++) {
        if (restart_policy_makes_frames((enum role)i))
            set->post[i].wanted = PROCESS_SET_CHILDREN;
    }
}

/* The pipe in which the script waits; opened before the keeper may write in few places alone. */
static int open_ready(const char *path)
{
    return path ? open(path, O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC) : -1;
}

/* Somebody who did not read the manual shall not be able to say that he was not told. */
static void warn_of_strangers(const struct process_set *set)
{
    if (atomic_load(&set->view.slot[ROLE_REPORTER]->unguarded) != 0)
        process_set_note(
            set, "WARNING: the reporter takes commands from everybody who reaches its network "
                 "(--remote-commands without DDS Security; docs/topics.md, \"Security\")");
}

static void say_ready(int fd)
{
    if (fd < 0)
        return;
    (void)!write(fd, "ready\n", 6);
    close(fd);
}

static void stop_set(struct keeper *keeper)
{
    /* Nothing new first, then those who report the rest. */
    static const enum role order[] = {ROLE_MOVER,   ROLE_COLLIDER, ROLE_INTAKE,  ROLE_RECORDER,
                                      ROLE_CONSOLE, ROLE_RENDERER, ROLE_REPORTER};
    for (size_t i = 0; i < sizeof order / sizeof order[0]; i++) {
        if (order[i] != ROLE_RECORDER) {
            (void)process_set_stop(&keeper->set, order[i]);
            continue;
        }
        if (keeper->plan->left_out[ROLE_RECORDER] ||
            process_set_finish(&keeper->set, ROLE_RECORDER) == EXIT_OK)
            continue;
        process_set_note(&keeper->set, "the recorder could not write all: see its last lines in %s",
                         keeper->plan->log);
        if (keeper->code == EXIT_OK)
            keeper->code = EXIT_REFUSED;
    }
}

static void tell_pictures(const struct plan *plan)
{
    static const char *const names[] = {"chase", "map"};
    char path[4096];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        int length = snprintf(path, sizeof path, "%s/%s.png", plan->out, names[i]);
        if (length < (int)sizeof path && access(path, R_OK) == 0)
            printf("  picture: %s\n", path);
    }
}

static void summarise(struct keeper *keeper)
{
    const struct plan *plan = keeper->plan;
    char wall[32];
    snprintf(wall, sizeof wall, "%.3f", (double)(clock_now_ns() - keeper->begun_ns) / 1e9);
    const char *const arguments[] = {"jolon-world",
                                     "summary",
                                     "--world",
                                     plan->world,
                                     "--wall",
                                     wall,
                                     plan->json ? "--json" : NULL,
                                     NULL};
    if (process_set_run(&keeper->set, "jolon-world", arguments, plan->background) != EXIT_OK)
        keeper->code = EXIT_REFUSED;
    if (!plan->json && !plan->background)
        tell_pictures(plan);
}

/* When the world's memory goes away, so do these. */
static void guard_removes(const struct segment_paths *paths)
{
    char socket[SEGMENT_PATH_MAX + 16];
    process_guard_removes(paths->object);
    process_guard_removes(paths->name);
    process_guard_removes(paths->lock);
    snprintf(socket, sizeof socket, "%s.commands", paths->name);
    process_guard_removes(socket);
    snprintf(socket, sizeof socket, "%s.pictures", paths->name);
    process_guard_removes(socket);
}

int main(int argc, char **argv)
{
    struct plan plan = options_plan(argc, argv);
    struct keeper keeper = {.plan = &plan, .repaired_frame = UINT64_MAX};
    struct error_text error;
    struct segment_paths paths;
    log_open("keeper");
    sigemptyset(&keeper.signals);
    sigaddset(&keeper.signals, SIGCHLD);
    sigaddset(&keeper.signals, SIGINT);
    sigaddset(&keeper.signals, SIGTERM);
    sigaddset(&keeper.signals, SIGHUP);
    sigaddset(&keeper.signals, SIGCONT);
    sigprocmask(SIG_BLOCK, &keeper.signals, NULL);
    /* What we inherited, the lock above all, is not our children's. */
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    /* The script ignored these while it turned into us; blocked, they would be dropped. */
    process_signals();
    if (segment_paths(&paths, plan.world, &error) != 0)
        die_refused("%s", error.text);
    guard_removes(&paths);
    int ready = open_ready(plan.ready);
    /* The children of a set that was killed die with it, but not in no time. */
    if (process_set_open(&keeper.set, &plan, &error) != 0 ||
        segment_wait_free(plan.world, ROLE_RENDERER, clock_now_ns() + LEFT_NS, &error) != 0 ||
        confine_keeper(&plan, &error) != 0)
        die_refused("%s", error.text);
    keeper.begun_ns = keeper.watchdog.last_ns = keeper.watchdog.since_ns = clock_now_ns();
    keeper.progress = progress_begin();
    uint64_t begun_frame = process_set_frame(&keeper.set);
    keeper.starting = true;
    start_set(&keeper);
    keeper.starting = false;
    if (!keeper.gave_up) {
        warn_of_strangers(&keeper.set);
        say_ready(ready);
    }
    while (!keeper.over)
        turn(&keeper);
    stop_set(&keeper);
    if (!plan.background && !plan.json)
        progress_end(&keeper.progress, &keeper.set.view);
    if (!keeper.gave_up)
        summarise(&keeper);
    /* A set that could not start loses no world that another one left. */
    if (keeper.gave_up && begun_frame > 0 && process_set_frame(&keeper.set) == begun_frame)
        process_set_note(&keeper.set, "world \"%s\" stays at frame %" PRIu64, plan.world,
                         begun_frame);
    else if (segment_remove_own(plan.world, &error) != 0)
        process_set_note(&keeper.set, "%s",
                         error.text); /* somebody has a role still, by that lock */
    return keeper.code;
}
