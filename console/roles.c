/* The process table, and signals. */
#include "console/roles.h"

#include "console/tell.h"
#include "ipc/clock.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/pidfd.h>
#include <unistd.h>

static void put_role(struct text *text, const struct watch *watch, enum role role)
{
    const struct role_slot *slot = watch->view.slot[role];
    int pid = segment_holder(watch->name, role);
    uint64_t beat_ns = atomic_load(&slot->beat_ns), now_ns = clock_now_ns();
    text_begin(text, '{');
    text_key_word(text, "role", role_name(role));
    text_key_word(text, "state",
                  pid ? role_state_name((enum role_state)atomic_load(&slot->state)) : "dead");
    text_key_whole(text, "pid", (uint64_t)pid);
    text_key_whole(text, "restarts", atomic_load(&slot->starts) - 1);
    text_key_number(text, "beat_age_ms", now_ns > beat_ns ? (double)(now_ns - beat_ns) / 1e6 : 0.0,
                    1);
    text_key_number(text, "stage_ms", (double)atomic_load(&slot->stage_ns) / 1e6, 3);
    text_key_number(text, "stage_p99_ms", (double)histogram_quantile(&slot->stage, 0.99) / 1e6, 3);
    text_key_whole(text, "late_frames", atomic_load(&slot->late_frames));
    text_key_whole(text, "frame", atomic_load(&slot->frame));
    text_end(text, '}');
}

void tell_processes(const struct tell *tell, struct answer *answer)
{
    struct text *text = &answer->text;
    if (!tell_there(tell, answer))
        return;
    text_begin(text, '[');
    for (int role = 0; role < ROLE_COUNT; role++) {
        if (atomic_load(&tell->watch->view.slot[role]->starts) > 0)
            put_role(text, tell->watch, (enum role)role);
    }
    text_end(text, ']');
}

/* The process is still the role's when the descriptor is its own: another one with its number is
 * never hit. 0, or an errno. */
static int signal_holder(const struct watch *watch, enum role role, int pid, int signal_number)
{
    int fd = pidfd_open(pid, 0);
    if (fd < 0)
        return errno;
    int result = ESRCH;
    if (segment_holder(watch->name, role) == pid)
        result = pidfd_send_signal(fd, signal_number, NULL, 0) == 0 ? 0 : errno;
    close(fd);
    return result;
}

void roles_end(const struct watch *watch, const char *name, bool restart, struct answer *answer)
{
    enum role role = role_find(name);
    if (role == ROLE_NONE) {
        answer_error(
            answer, ANSWER_BAD,
            "there are mover, collider, reporter, recorder, renderer, renderer-2 ..., console",
            "\"%.16s\" is no role", name);
        return;
    }
    int pid = segment_holder(watch->name, role);
    /* Asked to stop, a frame role would end the run; killed, it is only replaced. */
    bool kills = !restart || role == ROLE_MOVER || role == ROLE_COLLIDER;
    int cause = pid ? signal_holder(watch, role, pid, kills ? SIGKILL : SIGTERM) : ESRCH;
    if (cause != 0) {
        answer_error(answer, ANSWER_CONFLICT, "the process table shows when it is there again",
                     "the %s does not run: %s", name, strerror(cause));
        return;
    }
    struct text *text = &answer->text;
    text_begin(text, '{');
    text_key_word(text, "result", "done");
    text_key_word(text, "role", name);
    text_key_whole(text, "pid", (uint64_t)pid);
    text_key_word(text, "signal", kills ? "KILL" : "TERM");
    text_end(text, '}');
}
