/* Writes the process table and sends signals. */
#include "clients/console/process_control.h"

#include "ipc/process/clock.h"
#include "ipc/segment/segment_locks.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/pidfd.h>
#include <unistd.h>

static void put_role(struct json_writer *json, const struct world_reader *reader, enum role role)
{
    const struct role_slot *slot = reader->view.slot[role];
    int pid = segment_holder(reader->name, role);
    uint64_t beat_ns = atomic_load(&slot->beat_ns), now_ns = clock_now_ns();
    json_writer_begin(json, '{');
    json_writer_key_word(json, "role", role_name(role));
    json_writer_key_word(
        json, "state", pid ? role_state_name((enum role_state)atomic_load(&slot->state)) : "dead");
    json_writer_key_whole(json, "pid", (uint64_t)pid);
    json_writer_key_whole(json, "restarts", atomic_load(&slot->starts) - 1);
    json_writer_key_number(json, "beat_age_ms",
                           now_ns > beat_ns ? (double)(now_ns - beat_ns) / 1e6 : 0.0, 1);
    json_writer_key_number(json, "stage_ms", (double)atomic_load(&slot->stage_ns) / 1e6, 3);
    json_writer_key_number(json, "stage_p99_ms",
                           (double)histogram_quantile(&slot->stage, 0.99) / 1e6, 3);
    json_writer_key_whole(json, "late_frames", atomic_load(&slot->late_frames));
    json_writer_key_whole(json, "frame", atomic_load(&slot->frame));
    json_writer_end(json, '}');
}

void process_control_list(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    if (!world_query_attached(query, answer))
        return;
    json_writer_begin(json, '[');
    for (int role = 0; role < ROLE_COUNT; role++) {
        if (atomic_load(&query->reader->view.slot[role]->starts) > 0)
            put_role(json, query->reader, (enum role)role);
    }
    json_writer_end(json, ']');
}

/* Sends a signal to the role's process. After the descriptor was opened the process must still hold
 * the role, so that another process with the same number is never hit. Returns 0, or an errno. */
static int signal_holder(const struct world_reader *reader, enum role role, int pid,
                         int signal_number)
{
    int fd = pidfd_open(pid, 0);
    if (fd < 0)
        return errno;
    int result = ESRCH;
    if (segment_holder(reader->name, role) == pid)
        result = pidfd_send_signal(fd, signal_number, NULL, 0) == 0 ? 0 : errno;
    close(fd);
    return result;
}

void process_control_end(const struct world_reader *reader, const char *name, bool restart,
                         struct http_answer *answer)
{
    enum role role = role_find(name);
    if (role == ROLE_NONE) {
        char names[ROLE_NAMES_BYTES];
        char next[ROLE_NAMES_BYTES + 16];
        snprintf(next, sizeof next, "there are %s", role_names(0, names, sizeof names));
        http_answer_error(answer, HTTP_ANSWER_BAD, next, "\"%.16s\" is no role", name);
        return;
    }
    int pid = segment_holder(reader->name, role);
    /* SIGTERM to a frame role would end the run. After SIGKILL the role is only restarted. */
    bool kills = !restart || role_has(role, ROLE_MAKES_FRAMES);
    int cause = pid ? signal_holder(reader, role, pid, kills ? SIGKILL : SIGTERM) : ESRCH;
    if (cause != 0) {
        http_answer_error(answer, HTTP_ANSWER_CONFLICT,
                          "the process table shows when it is there again",
                          "the %s does not run: %s", name, strerror(cause));
        return;
    }
    struct json_writer *json = &answer->json;
    json_writer_begin(json, '{');
    json_writer_key_word(json, "result", "done");
    json_writer_key_word(json, "role", name);
    json_writer_key_whole(json, "pid", (uint64_t)pid);
    json_writer_key_word(json, "signal", kills ? "KILL" : "TERM");
    json_writer_end(json, '}');
}
