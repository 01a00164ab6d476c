/* The set: the processes that keep a world running, and what the keeper knows of each.
 *
 * Only the keeper's one thread uses it. One process keeps a role. Once the set is up, two keep each
 * frame role: one holds the role's lock, the other stands by for it. So the kernel hands over the
 * role when the holder dies. */
#ifndef JOLON_SUPERVISOR_PROCESS_SET_H
#define JOLON_SUPERVISOR_PROCESS_SET_H

#include "ipc/segment/segment.h"
#include "supervisor/restart_policy.h"
#include "supervisor/held_output.h"

#define PROCESS_SET_CHILDREN    2
#define PLAN_ROLE_OPTIONS_MAX   16
#define PROCESS_SET_REFUSAL_MAX 1200 /* longest text of a refusal */

/* Options that are passed on to a role, each followed by its value if it has one. */
struct role_options {
    const char *argument[PLAN_ROLE_OPTIONS_MAX];
    int count;
};

/* The keeper's command line, which owns the strings. */
struct plan {
    const char *world, *out, *log, *ready;
    const char *commands, *events, *checkpoint, *every;
    const char *threads;
    struct role_options role_options[ROLE_COUNT];
    uint64_t hang_ms;
    bool left_out[ROLE_COUNT];
    bool background, json, sandbox_off;
    bool console; /* the set has a console */
};

/* A child process. */
struct child {
    int pid;        /* 0: none */
    bool was_ready; /* it held the role and was ready at the last check */
    bool hung;      /* the watchdog killed it because it hung */
    uint64_t spawned_ns;
    uint64_t frame_at_start;
    uint64_t stopped_ns; /* when a signal stopped it, 0: not stopped */
};

/* A role and the processes that keep it. */
struct service {
    enum role role;
    struct child child[PROCESS_SET_CHILDREN];
    int wanted;           /* number of children; 0: the set does not have this role */
    uint64_t spawn_at_ns; /* the next child starts no earlier */
    char refused[PROCESS_SET_REFUSAL_MAX]; /* reason of the last refusal; "": none */
    struct held_output held; /* output of a child that is tried again after a refusal */
    struct history history;
    uint64_t quiet_ns; /* when half its allowed silence had passed, and its processor time then */
    uint64_t quiet_used_ns;
    uint64_t work, work_ns; /* work counter of its slot, and when that last changed */
    uint64_t long_frames;   /* number of frames that were longer than allowed but made progress */
    uint64_t long_since_ns; /* heartbeat before the last such frame */
};

struct process_set {
    const struct plan *plan;
    char folder[256]; /* where the programs are */
    struct view view;
    struct service service[ROLE_COUNT];
    int log_fd;
};

/* Finds the programs' folder, opens the log, attaches to the world. Returns 0, or -1 with the
 * reason. */
int process_set_open(struct process_set *set, const struct plan *plan, struct error_text *error);

/* Starts each child that is wanted, due and missing. A process that cannot be started is tried
 * again. */
void process_set_spawn(struct process_set *set, uint64_t now_ns);

/* Ends every pause before a restart: the next process_set_spawn() starts the child. */
void process_set_end_pauses(struct process_set *set);

/* Reads the held output of all roles. Passes it to the log for roles that are ready again. */
void process_set_pass_output(struct process_set *set);

/* Returns true if a child of this set holds the role and is ready. */
bool process_set_ready(struct process_set *set, enum role role);

/* Returns true if the service has a child that lives and is not stopped. */
bool process_set_has_live_child(const struct service *service);

/* Returns the service and the child of a pid, or NULL if no child has this pid. */
struct service *process_set_find(struct process_set *set, int pid, struct child **child);

/* Returns the child that holds the role, or NULL. */
struct child *process_set_holder(struct process_set *set, enum role role);

/* Ends a role's processes with SIGTERM, after some seconds with SIGKILL. Blocks until they are
 * dead. Returns the holder's exit status as a shell reports it; 0 if there was no process. */
int process_set_stop(struct process_set *set, enum role role);

/* Ends a role like process_set_stop(), but makes sure that it completes its work: a process that is
 * missing, or is killed before it ends by itself, is started again for some seconds. Blocks.
 * Returns the exit status, EXIT_OK when the work is complete. */
int process_set_finish(struct process_set *set, enum role role);

/* Kills a role's processes with SIGKILL. Blocks until they are dead. */
void process_set_kill(struct process_set *set, enum role role);

/* Converts a status of waitpid() to that of a shell: the exit code, or 128 + signal. */
int process_set_exit_status(int status);

/* Runs one of the programs to its end; blocks. Its output goes to the log, or to the keeper's own.
 * Returns the exit status as a shell reports it. */
int process_set_run(const struct process_set *set, const char *program,
                    const char *const *arguments, bool to_log);

uint64_t process_set_frame(const struct process_set *set);

/* Returns true if a write to standard error would not block. */
bool process_set_stderr_writable(void);

/* Writes one line to the log and, in the foreground, to standard error. */
void process_set_log(const struct process_set *set, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
