/* lag: measures the time from a key, or a push of a SpaceMouse, to the moved vehicle.
 *
 * It runs jolon-drive on a terminal of its own (a pty) and acts as its user. For each press it
 * waits until nothing changes, and then a random part of a frame. It notes the last committed frame
 * and the time, writes the key's byte, and reads every committed frame until the vehicle's throttle
 * has changed. The difference of the two frames is the lag. A missed frame counts as the later one
 * that was read. For a SpaceMouse it acts as the daemon: it writes motions to the socket that
 * SPNAV_SOCKET names, and reads the steering instead. */
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#define PRESSES_MAX  10000
#define FRAMES_MAX   64 /* a longer lag counts as this */
#define LIMIT_NS     (2 * (uint64_t)NS_PER_S)
#define START_NS     (10 * (uint64_t)NS_PER_S)
#define STILL_FRAMES 8 /* frames without a change after which nothing is pending */
#define FULL_PUSH    300
#define LOST_MAX     5

struct lag {
    const char *world, *program, *vehicle;
    bool spacemouse;
    uint32_t presses;
    struct view view;
    uint32_t row;
    pid_t pid;
    int terminal; /* the master side of the pty */
    int listener, device;
    char folder[32], path[64];
    uint64_t random;
    uint32_t frames[PRESSES_MAX];
    double ms[PRESSES_MAX];
    uint32_t lost;
};

static void parse(struct lag *lag, int argc, char **argv)
{
    static int input;
    static struct lag given = {.world = "default", .presses = 100, .random = 1, .device = -1};
    static const struct option_row rows[] = {
        {"world", "NAME", NULL, .text = &given.world, .letter = 'w'},
        {"input", "keys|spacemouse", NULL, .choice = &input},
        {"presses", "N", NULL, .u32 = &given.presses, .least = 1, .most = PRESSES_MAX},
        {"seed", "N", NULL, .u64 = &given.random, .least = 1, .most = UINT32_MAX},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "lag",
        .usage = "[--world NAME] [--input keys|spacemouse] [--presses N] [--seed N] JOLON-DRIVE ID",
        .rows = rows,
        .plain = 2};
    if (option_table_read(&table, argc, argv) != 2)
        die_usage("lag: needs the program jolon-drive and a vehicle's id");
    given.spacemouse = input == 1;
    given.program = argv[argc - 2];
    given.vehicle = argv[argc - 1];
    *lag = given;
}

static uint32_t random_below(struct lag *lag, uint32_t end)
{
    lag->random = lag->random * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(lag->random >> 33) % end;
}

static void listen_as_daemon(struct lag *lag)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    (void)snprintf(lag->folder, sizeof lag->folder, "/tmp/jolon-lag-XXXXXX");
    if (!mkdtemp(lag->folder))
        die_refused("%s: %s", lag->folder, strerror(errno));
    (void)snprintf(lag->path, sizeof lag->path, "%s/spnav", lag->folder);
    (void)stpncpy(address.sun_path, lag->path, sizeof address.sun_path - 1);
    lag->listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (lag->listener < 0 ||
        bind(lag->listener, (const struct sockaddr *)&address, sizeof address) != 0 ||
        listen(lag->listener, 1) != 0 || setenv("SPNAV_SOCKET", lag->path, 1) != 0)
        die_refused("%s: %s", lag->path, strerror(errno));
}

static void start(struct lag *lag)
{
    struct winsize size = {.ws_row = 24, .ws_col = 80};
    if (lag->spacemouse)
        listen_as_daemon(lag);
    lag->pid = forkpty(&lag->terminal, NULL, NULL, &size);
    if (lag->pid == 0) {
        (void)setenv("TERM", "xterm", 1);
        (void)execl(lag->program, lag->program, "--world", lag->world, "--input",
                    lag->spacemouse ? "spacemouse" : "keys", lag->vehicle, (char *)NULL);
        _exit(127);
    }
    if (lag->pid < 0 || fcntl(lag->terminal, F_SETFL, O_NONBLOCK) != 0)
        die_refused("a terminal: %s", strerror(errno));
    if (lag->spacemouse) {
        struct pollfd wait = {.fd = lag->listener, .events = POLLIN};
        if (poll(&wait, 1, 5000) == 1)
            lag->device = accept4(lag->listener, NULL, NULL, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (lag->device < 0)
            die_refused("%s does not look for a SpaceMouse", lag->program);
    }
}

/* Reads what jolon-drive prints, so that it never blocks. */
static void drain(const struct lag *lag)
{
    char bytes[4096];
    while (read(lag->terminal, bytes, sizeof bytes) > 0) {
    }
    while (lag->device >= 0 && read(lag->device, bytes, sizeof bytes) > 0) {
    }
}

/* Returns the column in the last committed frame. *commit: the frame's number. */
static float look(const struct lag *lag, uint64_t *commit)
{
    float value;
    do {
        *commit = segment_load(&lag->view.commit->commit);
        const struct entities *e = &lag->view.w[*commit & 1].entities;
        value = lag->spacemouse ? e->row[lag->row].steer : e->row[lag->row].throttle;
        atomic_thread_fence(memory_order_acquire);
    } while (segment_load(&lag->view.commit->commit) != *commit);
    return value;
}

/* Waits until nothing changes for some frames. Returns false at the limit. */
static bool settle(const struct lag *lag)
{
    uint64_t commit, until_ns = clock_now_ns() + LIMIT_NS;
    float last = look(lag, &commit);
    for (uint32_t still = 0; still < STILL_FRAMES;) {
        uint64_t now_ns = clock_now_ns();
        if (now_ns > until_ns)
            return false;
        (void)frame_protocol_wait(&lag->view, commit, now_ns + LIMIT_NS);
        drain(lag);
        float value = look(lag, &commit);
        still = value == last ? still + 1 : 0;
        last = value;
    }
    return true;
}

static void push(const struct lag *lag, bool out)
{
    const int motion[8] = {0, 0, 0, 0, 0, out ? FULL_PUSH : 0, 0, 16};
    ssize_t written = lag->spacemouse ? write(lag->device, motion, sizeof motion)
                                      : write(lag->terminal, out ? "w" : "x", 1);
    if (written <= 0)
        die_refused("jolon-drive does not drive the vehicle: %s", strerror(errno));
}

/* Makes one press. Returns false if it had no effect. */
static bool press(struct lag *lag, uint32_t which)
{
    uint64_t commit;
    if (!settle(lag))
        return false;
    clock_sleep_until_ns(clock_now_ns() + random_below(lag, 20000000));
    drain(lag);
    float before = look(lag, &commit);
    uint64_t at = commit, pressed_ns = clock_now_ns();
    push(lag, (which & 1) == 0);
    while (clock_now_ns() - pressed_ns < LIMIT_NS) {
        (void)frame_protocol_wait(&lag->view, commit, pressed_ns + LIMIT_NS);
        float value = look(lag, &commit);
        if (value != before) {
            uint64_t frames = commit - at;
            lag->ms[which] = (double)(clock_now_ns() - pressed_ns) / NS_PER_MS;
            lag->frames[which] = frames < FRAMES_MAX ? (uint32_t)frames : FRAMES_MAX;
            return true;
        }
    }
    return false;
}

static int by_frames(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static int by_ms(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static void report(struct lag *lag, uint32_t count)
{
    uint32_t p99 = count - 1 - count / 100;
    qsort(lag->frames, count, sizeof *lag->frames, by_frames);
    qsort(lag->ms, count, sizeof *lag->ms, by_ms);
    printf("input %s presses %u lost %u frames median %u p99 %u worst %u "
           "ms median %.1f p99 %.1f worst %.1f\n",
           lag->spacemouse ? "spacemouse" : "keys", count, lag->lost, lag->frames[count / 2],
           lag->frames[p99], lag->frames[count - 1], lag->ms[count / 2], lag->ms[p99],
           lag->ms[count - 1]);
}

static void finish(const struct lag *lag)
{
    (void)kill(lag->pid, SIGTERM);
    for (int i = 0; i < 300 && waitpid(lag->pid, NULL, WNOHANG) == 0; i++) {
        drain(lag);
        clock_sleep_until_ns(clock_now_ns() + 10 * (uint64_t)NS_PER_MS);
    }
    if (lag->spacemouse) {
        (void)unlink(lag->path);
        (void)rmdir(lag->folder);
    }
}

int main(int argc, char **argv)
{
    static struct lag lag;
    struct error_text error;
    uint64_t commit;
    log_open("lag");
    parse(&lag, argc, argv);
    if (segment_attach(&lag.view, lag.world, ROLE_NONE, &error) != 0)
        die_refused("%s", error.text);
    uint32_t id = (uint32_t)strtoul(lag.vehicle, NULL, 10);
    (void)look(&lag, &commit);
    const struct state *state = &lag.view.w[commit & 1];
    lag.row = entities_find(&state->entities, state->head->used, id);
    if (lag.row == SLOT_NONE)
        die_refused("no vehicle %s in world %s", lag.vehicle, lag.world);
    start(&lag);
    uint64_t until_ns = clock_now_ns() + START_NS;
    while (clock_now_ns() < until_ns &&
           lag.view.w[commit & 1].entities.row[lag.row].behaviour != BEHAVIOUR_DRIVEN) {
        drain(&lag);
        clock_sleep_until_ns(clock_now_ns() + 20 * (uint64_t)NS_PER_MS);
    }
    uint32_t count = 0;
    uint32_t in_a_row = 0; /* the vehicle can no longer be driven */
    for (uint32_t i = 0; i < lag.presses && in_a_row < LOST_MAX && !process_stopping(); i++) {
        in_a_row = press(&lag, count) ? 0 : in_a_row + 1;
        count += in_a_row == 0;
        lag.lost += in_a_row > 0;
    }
    finish(&lag);
    segment_detach(&lag.view);
    if (count == 0 || in_a_row == LOST_MAX)
        die_refused("the last of %u presses had no effect: is the vehicle destroyed?", count);
    report(&lag, count);
    return EXIT_OK;
}
