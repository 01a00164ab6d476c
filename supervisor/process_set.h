/* The set: the processes that keep a world going, and what the keeper knows of each.
 *
 * Only the keeper's one thread uses it. A role is kept by one process, a frame role by two once the
 * set is up: one holds the role's lock, the other stands by for it, so that the kernel itself hands
 * the role over at the moment the holder is dead. */
#ifndef JOLON_SUPERVISOR_PROCESS_SET_H
#define JOLON_SUPERVISOR_PROCESS_SET_H

#include "ipc/segment/segment.h"
#include "supervisor/restart_policy.h"
#include "supervisor/words.h"

#define PROCESS_SET_CHILDREN  2
#define PLAN_PASSED_MAX       16
#define PROCESS_SET_WORDS_MAX 1200 /* of what a role refuses */

/* Options that are passed on to a role as they are, each followed by its value if it
 * has one. */
struct passed {
    const char *argument[PLAN_PASSED_MAX];
    int count;
};

/* What the set is started with; strings are the command line's. */
struct plan {
    const char *world, *out, *log, *ready;
    const char *commands, *events, *checkpoint, *every;
    const char *threads;
    struct passed passed[ROLE_COUNT];
    uint64_t hang_ms;
    bool left_out[ROLE_COUNT];
    bool background, json, sandbox_off;
    bool console; /* the set has one */
};

/* A child process. */
struct child {
    int pid;        /* 0: none */
    bool was_ready; /* it had the role and was up when last looked at */
    bool hung;      /* killed by us because it hung */
    uint64_t spawned_ns;
    uint64_t frame_at_start;
    uint64_t stopped_ns; /* since when a signal keeps it stopped, 0: it is not */
};

/* A role and who keeps it. */
struct post {
    enum role role;
    struct child child[PROCESS_SET_CHILDREN];
    int wanted;                          /* children: 0 when the set has no such role */
    uint64_t spawn_at_ns;                /* not before */
    char refused[PROCESS_SET_WORDS_MAX]; /* its last refusal; "": it has been ready since */
    struct words words;                  /* of one that is tried again after a refusal */
    struct history history;
    uint64_t quiet_ns; /* when it was silent for half of what it may, and its processor time then */
    uint64_t quiet_used_ns;
    uint64_t work, work_ns; /* what its slot's work was, and when it was last seen to change */
    uint64_t long_frames;   /* how often it was silent for longer than it may, but got on */
    uint64_t long_since_ns; /* the beat before the last of them */
};

struct process_set {
    const struct plan *plan;
    char folder[256]; /* of the programs */
    struct view view;
    struct post post[ROLE_COUNT];
    int log_fd;
};

/* Finds the programs' folder, opens the log, attaches to the world. 0, or -1 with the reason. */
int process_set_open(struct process_set *set, const struct plan *plan, struct error_text *error);

/* Starts what is wanted, due and not there. A process that cannot be started is tried again. */
void process_set_spawn(struct process_set *set, uint64_t now_ns);

/* Ends every pause: what is wanted and not there is started at the next process_set_spawn(). */
void process_set_hurry(struct process_set *set);

/* Passes on what roles say that are up again after a refusal. */
void process_set_listen(struct process_set *set);

/* Is the role's slot held and ready, by a child of this set? */
bool process_set_ready(struct process_set *set, enum role role);

/* Has the post a child that lives and is not stopped? */
bool process_set_kept(const struct post *post);

/* The post and child of a pid; NULL when it is none of ours. */
struct post *process_set_find(struct process_set *set, int pid, struct child **child);

/* Our process that has the role, NULL when none of ours has it. */
struct child *process_set_holder(struct process_set *set, enum role role);

/* Ends a role's processes: SIGTERM, after some seconds SIGKILL, and waits for their deaths. The
 * holder's exit status as a shell has it; 0 when there was none. */
int process_set_stop(struct process_set *set, enum role role);

/* Ends a role as process_set_stop() does, so that it has done its last work: one that is not there,
 * or that is killed before it has ended by itself, is started again for that, for some seconds. Its
 * exit status: EXIT_OK when its work is done. Blocks. */
int process_set_finish(struct process_set *set, enum role role);

/* SIGKILL to a role's processes, and waits for their deaths. */
void process_set_kill(struct process_set *set, enum role role);

/* A status of waitpid() as a shell has it: the exit code, or 128 and the signal. */
int process_set_status(int status);

/* Runs one of the programs to its end. Its output goes to the log, or where ours goes. The exit
 * status as a shell has it. */
int process_set_run(const struct process_set *set, const char *program,
                    const char *const *arguments, bool to_log);

uint64_t process_set_frame(const struct process_set *set);

/* May something be written to standard error without waiting for who reads it? */
bool process_set_heard(void);

/* One line to the log and, in the foreground, to standard error. */
void process_set_note(const struct process_set *set, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
