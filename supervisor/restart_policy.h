/* What a death means: start again, end, or give up. Pure: a history and a death in, a verdict out.
 *
 * Only the mover and the collider can end a set. Every other role is started again for ever, after
 * pauses that double up to RESTART_POLICY_PAUSE_MAX_NS while it gets nothing done. */
#ifndef JOLON_SUPERVISOR_RESTART_POLICY_H
#define JOLON_SUPERVISOR_RESTART_POLICY_H

#include "ipc/segment/role.h"

#include <stdbool.h>
#include <stdint.h>

/* Crashes of a frame role on one frame after which that frame is poison. */
#define RESTART_POLICY_SAME_FRAME_DEATHS 3u
/* Crashes of a frame role in a row, without getting a frame done, after which the set gives up. */
#define RESTART_POLICY_QUICK_CRASHES 5u
/* The same for kills from outside: somebody's whim, or a machine that has no memory left. */
#define RESTART_POLICY_QUICK_KILLS 60u
/* Longest pause before a role that makes no frames is started again, and before one that does. */
#define RESTART_POLICY_PAUSE_MAX_NS       5000000000u
#define RESTART_POLICY_FRAME_PAUSE_MAX_NS 1000000000u

struct death {
    enum role role;
    int status;              /* as a shell has it: exit code, or 128 + signal */
    bool hung;               /* the keeper killed it because it hung */
    bool stood_by;           /* another process of ours has the role */
    bool was_ready;          /* it had the role and had said that it was up */
    bool finished;           /* the run's last frame is committed */
    uint64_t frame;          /* committed when it was found dead */
    uint64_t frame_at_start; /* and when it was started */
    uint64_t lived_ns;
};

/* Of one role; begin with zeros. */
struct history {
    uint32_t quick_crashes, quick_kills; /* in a row; refusals count as crashes */
    uint32_t stood_by;                   /* deaths in a row of who only stood by */
    uint32_t same_frame;                 /* crashes on crash_frame */
    uint64_t crash_frame;
};

enum verdict {
    VERDICT_RESTART,
    VERDICT_FINISHED, /* it ended because the run did */
    VERDICT_REFUSED,  /* a frame role ended with exit code 1 or 2: it said why */
    VERDICT_POISON,   /* this frame always kills the role */
    VERDICT_GIVE_UP   /* the role always dies */
};

/* Judges and remembers. *delay_ns: how long to wait before the restart. */
enum verdict restart_policy_death(struct history *history, const struct death *death,
                                  uint64_t *delay_ns);

/* Is this the exit status of a process that said what it refused? */
bool restart_policy_refused(int status);

#endif
