/* Carrying out the verdicts of the restart policy. */
#include "supervisor/role_exit.h"

#include "ipc/frame/frame_protocol.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

#define HAND_OVER_NS   (20 * (uint64_t)NS_PER_MS) /* for a stand-by process to take the role */
#define LOG_TAIL_BYTES 65536L                     /* of the log are searched for a refusal */

/* A frame ends every process that computes it. Saves the world before that frame, with the frame's
 * inputs, and ends the run. */
static void save_poison_frame(struct keeper *keeper, enum role role, int status)
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
    keeper_give_up(keeper, EXIT_GAVE_UP, text);
}

/* Finds the role's last line in its output, which may be NULL, and closes it. Without such a line
 * the text refers to the log. */
static void find_refusal(const struct keeper *keeper, FILE *output, enum role role, char *text,
                         size_t size)
{
    char prefix[48], line[1024];
    int length = snprintf(prefix, sizeof prefix, "jolon-%s: ", role_name(role));
    snprintf(text, size, "%s refused; %s says why", role_name(role), keeper->plan->log);
    while (output && fgets(line, sizeof line, output)) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, prefix, (size_t)length) == 0)
            snprintf(text, size, "%s refused: %s", role_name(role), line + length);
    }
    if (output)
        fclose(output);
}

static FILE *open_log_tail(const struct keeper *keeper)
{
    FILE *log = fopen(keeper->plan->log, "re");
    if (log && fseek(log, -LOG_TAIL_BYTES, SEEK_END) != 0)
        rewind(log); /* the log is shorter */
    return log;
}

/* A frame role has found the world damaged. Sets the world back to its last whole frame. A second
 * repair at the same frame would not help: the set gives up. */
static void repair(struct keeper *keeper, enum role role)
{
    char text[PROCESS_SET_REFUSAL_MAX];
    const char *const repair_verb[] = {"jolon-world", "repair", "--world", keeper->plan->world,
                                       NULL};
    uint64_t frame = process_set_frame(&keeper->set);
    find_refusal(keeper, open_log_tail(keeper), role, text, sizeof text);
    process_set_kill(&keeper->set, ROLE_MOVER);
    process_set_kill(&keeper->set, ROLE_COLLIDER);
    /* These three may have read damaged data. They are started again, too. */
    process_set_kill(&keeper->set, ROLE_RECORDER);
    process_set_kill(&keeper->set, ROLE_INTAKE);
    process_set_kill(&keeper->set, ROLE_REPORTER);
    if (frame == keeper->repaired_frame || !strstr(text, "damaged") ||
        process_set_run(&keeper->set, "jolon-world", repair_verb, true) != EXIT_OK) {
        keeper_give_up(keeper, EXIT_REFUSED, text);
        return;
    }
    keeper->repaired_frame = process_set_frame(&keeper->set);
    process_set_log(&keeper->set, "%s; repaired, goes on from frame %" PRIu64, text,
                    keeper->repaired_frame);
}

/* Logs the reason of a refusal, unless the role's last refusal had the same reason. */
static void note_refusal(struct keeper *keeper, struct service *service)
{
    char text[PROCESS_SET_REFUSAL_MAX];
    struct held_output *held = &service->held;
    held_output_read(held, keeper->set.log_fd, false);
    FILE *output = held->used > 0 ? fmemopen(held->text, held->used, "r") : open_log_tail(keeper);
    find_refusal(keeper, output, service->role, text, sizeof text);
    bool changed = strcmp(text, service->refused) != 0;
    held_output_close(held, keeper->set.log_fd, changed);
    if (changed)
        process_set_log(&keeper->set, "goes on without the %s and keeps trying: %s",
                        role_name(service->role), text);
    snprintf(service->refused, sizeof service->refused, "%s", text);
}

static void restart(struct keeper *keeper, struct service *service, const struct death *death,
                    int pid, uint64_t delay_ns)
{
    bool refused = restart_policy_refused(death->status) && !death->stood_by;
    /* The stand-by process takes over first: the new one is started after it. */
    if (delay_ns == 0 && process_set_has_live_child(service))
        delay_ns = HAND_OVER_NS;
    service->spawn_at_ns = clock_now_ns() + delay_ns;
    if (refused)
        note_refusal(keeper, service);
    else if (death->was_ready)
        service->refused[0] = '\0';
    process_set_spawn(&keeper->set, clock_now_ns());
    if (!refused)
        process_set_log(&keeper->set, "%s (pid %d) ended with status %d at frame %" PRIu64,
                        role_name(service->role), pid, death->status, death->frame);
}

static void handle_death(struct keeper *keeper, struct service *service, struct child *child,
                         int status)
{
    const struct child *holder = process_set_holder(&keeper->set, service->role);
    struct child dead = *child;
    char text[PROCESS_SET_REFUSAL_MAX];
    uint64_t delay_ns = 0;
    struct death death = {.role = service->role,
                          .status = status,
                          /* A process that was stopped from outside did not hang by itself. */
                          .hung = dead.hung && dead.stopped_ns == 0,
                          .stood_by = !dead.was_ready && holder && holder != child,
                          .was_ready = dead.was_ready,
                          .finished = frame_protocol_finished(&keeper->set.view),
                          .frame = process_set_frame(&keeper->set),
                          .frame_at_start = dead.frame_at_start,
                          .lived_ns = clock_now_ns() - dead.spawned_ns};
    *child = (struct child){0};
    switch (restart_policy_death(&service->history, &death, &delay_ns)) {
    case VERDICT_RESTART:
        if (keeper->starting && service->role == ROLE_RECORDER && restart_policy_refused(status)) {
            /* The user has not chosen a run without a record. */
            find_refusal(keeper, open_log_tail(keeper), service->role, text, sizeof text);
            keeper_give_up(keeper, EXIT_REFUSED, text);
            break;
        }
        restart(keeper, service, &death, dead.pid, delay_ns);
        break;
    case VERDICT_FINISHED:
        keeper->over |= service->role == ROLE_MOVER; /* the collider ends before the mover */
        service->wanted = 0;
        break;
    case VERDICT_REFUSED:
        repair(keeper, service->role);
        break;
    case VERDICT_POISON:
        save_poison_frame(keeper, service->role, status);
        break;
    case VERDICT_GIVE_UP:
        snprintf(text, sizeof text,
                 "%s died again and again without getting anything done, last with status %d",
                 role_name(service->role), status);
        keeper_give_up(keeper, EXIT_GAVE_UP, text);
        break;
    }
}

void role_exit_reap(struct keeper *keeper)
{
    struct child *child;
    int status;
    for (;;) {
        pid_t pid = waitpid(-1, &status, WNOHANG | WUNTRACED | WCONTINUED);
        if (pid <= 0)
            return;
        struct service *service = process_set_find(&keeper->set, pid, &child);
        if (!service)
            continue;
        if (WIFSTOPPED(status))
            child->stopped_ns = clock_now_ns();
        else if (WIFCONTINUED(status))
            child->stopped_ns = 0;
        else if (!keeper->over)
            handle_death(keeper, service, child, process_set_exit_status(status));
        else
            *child = (struct child){0};
    }
}
