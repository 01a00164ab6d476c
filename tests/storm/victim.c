/* Strikes. */
#include "tests/storm/victim.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Of a hundred strikes, and of rounds. */
#define STOPS          6
#define STOP_CONTINUES 6
#define PAIRS          0.10
#define CHASES         0.10
#define UNBORN         0.30 /* of the chases */
#define STAND_BYS      0.06
#define SUPERVISORS    0.006
#define AT_ONCE        0.15 /* of the gaps */
#define ALONE          0.20 /* of the gaps: not before all is well again, so that one is measured */
#define ALONE_STOPPED  0.60 /* likewise after a stop, which takes so much longer */

/* More deaths of a role than this without a frame between them are a role that gets nothing done,
 * and is given up: that is another test's. */
#define FRUITLESS_MAX 3

#define NOBODY_NS         ((uint64_t)20 * NS_PER_S)
#define ALONE_NS          ((uint64_t)NS_PER_S)
#define CHASE_NS          (500 * (uint64_t)NS_PER_MS)
#define POLL_NS           (NS_PER_MS / 20)
#define SILENCE_OTHERS_MS 2000.0 /* that a role outside the frame loop is allowed */

static bool is_stage(uint32_t role)
{
    return role == ROLE_MOVER || role == ROLE_COLLIDER;
}

static int pid_of(const struct victims *victims, uint32_t role)
{
    return (int)atomic_load(&victims->band->view.slot[role]->pid);
}

/* --- one strike --------------------------------------------------------------------------------*/

static void continue_later(struct victims *victims, int pidfd, uint32_t role)
{
    const struct storm_options *options = victims->band->options;
    double limit_ms = is_stage(role) ? options->hang_ms : SILENCE_OTHERS_MS;
    double after_ms = limit_ms * (0.5 + chance_unit(&victims->chance));
    for (int i = 0; i < PENDING_MAX; i++) {
        if (victims->pending[i].pidfd < 0) {
            victims->pending[i].pidfd = pidfd;
            victims->pending[i].due_ns = clock_now_ns() + (uint64_t)(after_ms * NS_PER_MS);
            return;
        }
    }
    (void)band_signal(pidfd, SIGCONT); /* so many are stopped already */
    close(pidfd);
}

static uint64_t commit_of(const struct victims *victims)
{
    return atomic_load(&victims->band->view.commit->commit);
}

static void count_fruitless(struct victims *victims, uint32_t role)
{
    uint64_t commit = commit_of(victims);
    if (commit != victims->fruitless[role].commit)
        victims->fruitless[role].count = 0;
    victims->fruitless[role].commit = commit;
    victims->fruitless[role].count++;
}

static bool may_strike(const struct victims *victims, uint32_t role)
{
    return victims->fruitless[role].count < FRUITLESS_MAX ||
           commit_of(victims) != victims->fruitless[role].commit;
}

/* True when it met a living process of the set. */
static bool strike_pid(struct victims *victims, int pid, uint32_t role, enum deed deed)
{
    int pidfd = pid == victims->killed[role] ? -1 : band_pin(victims->band, pid);
    if (pidfd < 0)
        return false;
    if (process_state(pid) == 'T')
        deed = DEED_KILL;                               /* it is stopped already */
    if (is_stage(role) && pid == pid_of(victims, role)) /* not one that stands by */
        watcher_fault(victims->watcher, role, pid, deed);
    count_fruitless(victims, role);
    (void)band_signal(pidfd, deed == DEED_KILL ? SIGKILL : SIGSTOP);
    if (deed == DEED_KILL)
        victims->killed[role] = pid;
    victims->struck[role][deed]++;
    victims->done++;
    victims->last = deed;
    if (deed == DEED_STOP_CONTINUE)
        continue_later(victims, pidfd, role);
    else
        close(pidfd);
    return true;
}

static enum deed draw_deed(struct victims *victims)
{
    uint64_t drawn = chance_below(&victims->chance, 100);
    if (drawn < STOPS)
        return DEED_STOP;
    return drawn < STOPS + STOP_CONTINUES ? DEED_STOP_CONTINUE : DEED_KILL;
}

static uint32_t draw_role(struct victims *victims)
{
    static const uint32_t roles[] = {ROLE_MOVER,    ROLE_MOVER,    ROLE_MOVER,    ROLE_COLLIDER,
                                     ROLE_COLLIDER, ROLE_COLLIDER, ROLE_RECORDER, ROLE_INTAKE,
                                     ROLE_INTAKE,   ROLE_REPORTER, ROLE_RENDERER};
    for (;;) {
        uint32_t role = roles[chance_below(&victims->chance, sizeof roles / sizeof *roles)];
        if (atomic_load(&victims->band->view.slot[role]->starts) > 0)
            return role;
    }
}

/* Draws until somebody is met; the role, or -1 when there is nobody for so long. not: a role that
 * it shall not be. */
static int strike_one(struct victims *victims, uint32_t not )
{
    uint64_t until = clock_now_ns() + NOBODY_NS;
    enum deed deed = draw_deed(victims);
    while (clock_now_ns() < until && !process_stopping()) {
        uint32_t role = draw_role(victims);
        if (role != not &&may_strike(victims, role) &&
            strike_pid(victims, pid_of(victims, role), role, deed))
            return (int)role;
        victims_wait(victims, clock_now_ns() + POLL_NS);
    }
    return error_text_set(&victims->error, "nobody to strike for %.0f s: the set is not restarted",
                          (double)NOBODY_NS / 1e9);
}

/* --- chases ------------------------------------------------------------------------------------*/

/* A child of the supervisor that was not there before, before it has said who it is. */
static int newborn(const struct victims *victims, const int *before, int count)
{
    int children[64];
    int now = band_children(victims->band->supervisor, children, 64);
    for (int i = 0; i < now; i++) {
        bool old = false;
        for (int j = 0; j < count; j++)
            old |= children[i] == before[j];
        if (!old)
            return children[i];
    }
    return 0;
}

static bool is_role(int pid, uint32_t role)
{
    char path[64], name[32] = "", wanted[32];
    snprintf(path, sizeof path, "/proc/%d/comm", pid);
    snprintf(wanted, sizeof wanted, "jolon-%s\n", role_name((enum role)role));
    FILE *file = fopen(path, "r");
    if (!file)
        return false;
    bool read = fgets(name, sizeof name, file) != NULL;
    fclose(file);
    return read && strcmp(name, wanted) == 0;
}

/* Kills a stage, and then its replacement: in its first millisecond, or while it starts. */
static int chase(struct victims *victims)
{
    int before[64], count = band_children(victims->band->supervisor, before, 64);
    bool early = chance_unit(&victims->chance) < UNBORN;
    uint32_t role = chance_below(&victims->chance, 2) ? ROLE_MOVER : ROLE_COLLIDER;
    int old = pid_of(victims, role);
    if (!may_strike(victims, role) || !strike_pid(victims, old, role, DEED_KILL))
        return strike_one(victims, STRUCK_ROLES) < 0 ? -1 : 0;
    uint64_t until = clock_now_ns() + CHASE_NS;
    while (clock_now_ns() < until && !process_stopping()) {
        int next = early ? newborn(victims, before, count) : pid_of(victims, role);
        if (next != 0 && next != old && (!early || is_role(next, role))) {
            if (!early)
                victims_wait(victims, clock_now_ns() + chance_below(&victims->chance, NS_PER_MS));
            if (may_strike(victims, role) && strike_pid(victims, next, role, DEED_KILL)) {
                victims->unborn += pid_of(victims, role) != next;
                victims->chased++;
            }
            return 0;
        }
        victims_wait(victims, clock_now_ns() + POLL_NS);
    }
    return 0;
}

/* Strikes a child that is of a stage's program and does not hold the role, if there is one. */
static int strike_stand_by(struct victims *victims)
{
    int children[64], count = band_children(victims->band->supervisor, children, 64);
    enum deed deed = draw_deed(victims);
    uint32_t role = chance_below(&victims->chance, 2) ? ROLE_MOVER : ROLE_COLLIDER;
    for (int i = 0; i < count; i++) {
        if (children[i] == pid_of(victims, role) || !is_role(children[i], role))
            continue;
        if (strike_pid(victims, children[i], role, deed)) {
            victims->stand_bys++;
            return 0;
        }
    }
    return strike_one(victims, STRUCK_ROLES) < 0 ? -1 : 0;
}

/* --- the supervisor ----------------------------------------------------------------------------*/

static int strike_supervisor(struct victims *victims)
{
    struct band *band = victims->band;
    int pidfd = band_pin_supervisor(band);
    if (pidfd < 0)
        return error_text_set(&victims->error, "the supervisor (pid %d) is gone", band->supervisor);
    watcher_fault(victims->watcher, STRUCK_SUPERVISOR, band->supervisor, DEED_KILL);
    (void)band_signal(pidfd, SIGKILL);
    close(pidfd);
    victims->struck[STRUCK_SUPERVISOR][DEED_KILL]++;
    victims->done++;
    int result = band_adopt(band, &victims->error);
    band_reap();
    return result;
}

/* --- rounds ------------------------------------------------------------------------------------*/

void victims_begin(struct victims *victims, struct band *band, struct watcher *watcher,
                   uint64_t seed)
{
    *victims = (struct victims){.band = band, .watcher = watcher, .chance = {seed}};
    for (int i = 0; i < PENDING_MAX; i++)
        victims->pending[i].pidfd = -1;
}

int victims_round(struct victims *victims)
{
    double kind = chance_unit(&victims->chance);
    if (kind < SUPERVISORS)
        return strike_supervisor(victims);
    if (kind < SUPERVISORS + CHASES)
        return chase(victims);
    if (kind < SUPERVISORS + CHASES + STAND_BYS)
        return strike_stand_by(victims);
    int first = strike_one(victims, STRUCK_ROLES);
    if (first < 0)
        return -1;
    if (kind < SUPERVISORS + CHASES + STAND_BYS + PAIRS) {
        victims->pairs++;
        return strike_one(victims, (uint32_t)first) < 0 ? -1 : 0;
    }
    return 0;
}

void victims_gap(struct victims *victims)
{
    double kind = chance_unit(&victims->chance);
    double gap_ms = victims->band->options->gap_ms * chance_unit(&victims->chance);
    uint64_t until = clock_now_ns() + ALONE_NS;
    if (kind < AT_ONCE)
        return;
    if (kind < AT_ONCE + (victims->last == DEED_KILL ? ALONE : ALONE_STOPPED)) {
        while (!watcher_calm(victims->watcher, 0) && clock_now_ns() < until)
            victims_wait(victims, clock_now_ns() + POLL_NS);
    }
    victims_wait(victims, clock_now_ns() + (uint64_t)(gap_ms * NS_PER_MS));
}

void victims_wait(struct victims *victims, uint64_t until_ns)
{
    for (;;) {
        uint64_t now = clock_now_ns(), next = until_ns;
        for (int i = 0; i < PENDING_MAX; i++) {
            if (victims->pending[i].pidfd < 0)
                continue;
            if (victims->pending[i].due_ns <= now) {
                (void)band_signal(victims->pending[i].pidfd, SIGCONT);
                close(victims->pending[i].pidfd);
                victims->pending[i].pidfd = -1;
            } else if (victims->pending[i].due_ns < next) {
                next = victims->pending[i].due_ns;
            }
        }
        if (now >= until_ns || process_stopping())
            return;
        clock_sleep_until_ns(next);
    }
}

void victims_end(struct victims *victims)
{
    for (int i = 0; i < PENDING_MAX; i++) {
        if (victims->pending[i].pidfd >= 0)
            victims->pending[i].due_ns = 0;
    }
    victims_wait(victims, 0);
}
