/* Decides after a death whether to restart, to end, or to give up. Pure functions of a history and
 * a death.
 *
 * Only deaths of mover and collider can end a set. Every other role is restarted for ever. Its
 * pauses double up to RESTART_POLICY_PAUSE_MAX_NS while it dies before it gets work done. */
#ifndef JOLON_SUPERVISOR_RESTART_POLICY_H
#define JOLON_SUPERVISOR_RESTART_POLICY_H

#include "ipc/segment/role.h"

#include <stdbool.h>
#include <stdint.h>

/* After this many crashes of a frame role on one frame, that frame is poison. */
#define RESTART_POLICY_SAME_FRAME_DEATHS 3u
/* After this many crashes of a frame role in a row without a completed frame, the set gives up. */
#define RESTART_POLICY_QUICK_CRASHES 5u
/* The same for kills from outside: by a user, or by the kernel when memory is out. */
#define RESTART_POLICY_QUICK_KILLS 60u
/* Longest pause before a restart [ns]: of other roles, and of frame roles. */
#define RESTART_POLICY_PAUSE_MAX_NS       5000000000u
#define RESTART_POLICY_FRAME_PAUSE_MAX_NS 1000000000u

struct death {
    enum role role;
    int status;              /* as a shell reports it: exit code, or 128 + signal */
    bool hung;               /* the watchdog killed it because it hung */
    bool stood_by;           /* another process of the set holds the role */
    bool was_ready;          /* it held the role and had been ready */
    bool finished;           /* the run's last frame is committed */
    uint64_t frame;          /* the committed frame when it was found dead */
    uint64_t frame_at_start; /* the committed frame when it was started */
    uint64_t lived_ns;
};

/* Deaths of one role. Start with zeros. */
struct history {
    uint32_t quick_crashes, quick_kills; /* in a row; refusals count as crashes */
    uint32_t stood_by;                   /* deaths in a row of processes that only stood by */
    uint32_t same_frame;                 /* crashes on crash_frame */
    uint64_t crash_frame;
};

enum verdict {
    VERDICT_RESTART,
    VERDICT_FINISHED, /* it ended because the run has ended */
    VERDICT_REFUSED,  /* a frame role ended with exit code 1 or 2, after stating the reason */
    VERDICT_POISON,   /* computing this frame always kills the role */
    VERDICT_GIVE_UP   /* the role dies every time */
};

/* Returns the verdict on a death and adds it to the history. *delay_ns: pause before the
 * restart. */
enum verdict restart_policy_death(struct history *history, const struct death *death,
                                  uint64_t *delay_ns);

/* Returns true for the exit status of a process that refused: EXIT_REFUSED or EXIT_USAGE. */
bool restart_policy_refused(int status);

#endif
