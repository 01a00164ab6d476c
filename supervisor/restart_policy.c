/* The rules of the restart policy. */
#include "supervisor/restart_policy.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#define STATUS_KILLED  (128 + 9)
#define FREE_RESTARTS  8u /* kills from outside without a pause */
#define FIRST_PAUSE_NS (50 * (uint64_t)NS_PER_MS)
#define LONG_LIFE_NS   (5 * (uint64_t)NS_PER_S) /* of a role outside the frame loop */

bool restart_policy_refused(int status)
{
    return status == EXIT_REFUSED || status == EXIT_USAGE;
}

/* The first deaths, up to free, cost no pause. After that the pause doubles with each death. */
static uint64_t pause_after(enum role role, uint32_t deaths, uint32_t free)
{
    uint64_t most = role_has(role, ROLE_MAKES_FRAMES) ? RESTART_POLICY_FRAME_PAUSE_MAX_NS
                                                      : RESTART_POLICY_PAUSE_MAX_NS;
    uint64_t pause = deaths > free ? FIRST_PAUSE_NS : 0;
    for (uint32_t i = free + 1; i < deaths && pause < most; i++)
        pause *= 2;
    return pause < most ? pause : most;
}

static enum verdict give_up_after(enum role role, uint32_t deaths, uint32_t most)
{
    return role_has(role, ROLE_MAKES_FRAMES) && deaths >= most ? VERDICT_GIVE_UP : VERDICT_RESTART;
}

/* A kill from outside, or a request to stop that the keeper did not send, is no fault of the frame,
 * and hardly one of the role. */
static enum verdict killed(struct history *history, const struct death *death, uint64_t *delay_ns)
{
    history->quick_kills++;
    *delay_ns = pause_after(death->role, history->quick_kills, FREE_RESTARTS);
    return give_up_after(death->role, history->quick_kills, RESTART_POLICY_QUICK_KILLS);
}

/* The role crashed, or it makes no frames and refused. The cause of a refusal may pass: a port in
 * use, a full disk. */
static enum verdict failed(struct history *history, const struct death *death, uint64_t *delay_ns)
{
    if (role_has(death->role, ROLE_MAKES_FRAMES)) {
        if (history->crash_frame != death->frame)
            history->same_frame = 0;
        history->crash_frame = death->frame;
        if (++history->same_frame >= RESTART_POLICY_SAME_FRAME_DEATHS)
            return VERDICT_POISON;
    }
    history->quick_crashes++;
    *delay_ns = pause_after(death->role, history->quick_crashes, 1);
    return give_up_after(death->role, history->quick_crashes, RESTART_POLICY_QUICK_CRASHES);
}

/* Work that the role has done since its start clears its earlier deaths. */
static void forgive(struct history *history, const struct death *death)
{
    bool frames = death->frame > death->frame_at_start;
    bool makes_frames = role_has(death->role, ROLE_MAKES_FRAMES);
    if (death->was_ready)
        history->stood_by = 0;
    if (makes_frames ? frames : death->was_ready)
        history->quick_kills = 0;
    if (makes_frames ? frames : death->was_ready && death->lived_ns > LONG_LIFE_NS)
        history->quick_crashes = 0;
}

enum verdict restart_policy_death(struct history *history, const struct death *death,
                                  uint64_t *delay_ns)
{
    *delay_ns = 0;
    if (death->status == EXIT_OK && role_has(death->role, ROLE_MAKES_FRAMES) && death->finished)
        return VERDICT_FINISHED;
    if (death->stood_by) { /* no frame was lost, and the role has a holder */
        *delay_ns = pause_after(death->role, ++history->stood_by, FREE_RESTARTS);
        return VERDICT_RESTART;
    }
    if (restart_policy_refused(death->status) && role_has(death->role, ROLE_MAKES_FRAMES))
        return VERDICT_REFUSED;
    forgive(history, death);
    if (death->status == EXIT_OK || (death->status == STATUS_KILLED && !death->hung))
        return killed(history, death, delay_ns);
    return failed(history, death, delay_ns);
}
