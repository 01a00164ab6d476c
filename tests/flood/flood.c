/* flood: sends as many commands as one connection accepts, while another client drives a vehicle,
 * and tells how many frames the driver waited for each answer.
 *
 *     flood --world NAME --seconds S --vehicle ID [--spawn] [--idle CONNECTIONS]
 *     flood --packet         prints how many bytes a command's packet has
 *
 * --spawn floods with spawns of tanks on one spot instead of drives; --idle opens so many more
 * connections that send nothing. Prints one JSON object:
 * {"sent_per_s", "answers", "frames_p50", "frames_p99", "frames_max", "unanswered"}. */
#include "ipc/process/clock.h"
#include "ipc/segment/local_socket.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/command_packet.h"
#include "ipc/topics/command_socket.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define ANSWERS_MAX  100000u
#define PAUSE_NS     (20 * (uint64_t)NS_PER_MS) /* pause between two drives */
#define ANSWER_NS    (3 * (uint64_t)NS_PER_S)
#define TRIES        32 /* batch that the flooder writes before it reads the clock */
#define WANTED_PER_S 150000u

struct flood {
    const char *world;
    double seconds;
    uint32_t vehicle;
    uint32_t idle;
    bool spawn;
    _Atomic uint64_t *sent; /* shared with the flooder: commands that it tried to send */
    uint32_t frames[ANSWERS_MAX];
    uint32_t answers, unanswered;
};

static int print_packet(const char *value, struct error_text *detail)
{
    (void)value;
    (void)detail;
    printf("%zu\n", sizeof(struct command_packet));
    exit(EXIT_OK);
}

static struct flood parse(int argc, char **argv)
{
    static struct flood flood = {.world = "default", .seconds = 2.0, .vehicle = 1};
    static const struct option_row rows[] = {
        {"world", "NAME", NULL, .text = &flood.world, .letter = 'w'},
        {"seconds", "S", NULL, .real = &flood.seconds, .low = 0.1, .high = 3600.0},
        {"vehicle", "ID", NULL, .u32 = &flood.vehicle, .least = 1, .most = UINT32_MAX},
        {"idle", "N", NULL, .u32 = &flood.idle, .most = 1000},
        {"spawn", NULL, NULL, .flag = &flood.spawn},
        {"packet", NULL, NULL, .take = print_packet},
        OPTION_ROWS_END};
    static const struct option_table table = {.program = "flood", .rows = rows};
    option_table_read(&table, argc, argv);
    return flood;
}

static int connect_to(const struct flood *flood)
{
    struct error_text error;
    int fd = local_socket_connect(flood->world, COMMAND_SOCKET_SUFFIX,
                                  SOCK_SEQPACKET | SOCK_NONBLOCK, &error);
    if (fd < 0 && errno != EAGAIN) /* the backlog is full */
        die_refused("%s", error.text);
    return fd;
}

/* Sends at most WANTED_PER_S commands a second and never reads an answer. Thread of the flooder. */
_Noreturn static void flood_it(const struct flood *flood)
{
    struct command_packet packet = {
        .magic = COMMAND_PACKET_MAGIC,
        .version = COMMAND_PACKET_VERSION,
        .command = {.source = 4711 + (uint64_t)getpid(),
                    .type = flood->spawn ? jolon_COMMAND_SPAWN : jolon_COMMAND_DRIVE,
                    .entity = 2,
                    .x_m = 20000.0,
                    .z_m = 30000.0,
                    .altitude_m = -1.0}};
    (void)stpcpy(packet.command.kind, "tank");
    int fd = connect_to(flood);
    uint64_t begun_ns = clock_now_ns(), sent = 0;
    for (;;) {
        for (int i = 0; i < TRIES; i++) {
            packet.command.sequence++;
            (void)send(fd, &packet, sizeof packet, MSG_DONTWAIT | MSG_NOSIGNAL);
        }
        sent += TRIES;
        atomic_store(flood->sent, sent);
        clock_sleep_until_ns(begun_ns + sent * NS_PER_S / WANTED_PER_S);
    }
}

/* Drives the vehicle, one command at a time, and records the frames until each answer. */
static void drive(struct flood *flood, const struct view *view, struct command_client *caller,
                  uint64_t until_ns)
{
    while (clock_now_ns() < until_ns && flood->answers < ANSWERS_MAX) {
        const jolon_Command command = {
            .type = jolon_COMMAND_DRIVE, .entity = flood->vehicle, .throttle = 0.5F};
        jolon_CommandReply reply;
        uint64_t before = segment_load(&view->commit->commit);
        /* The result does not matter: the vehicle may be a wreck by now. */
        if (command_client_call(caller, &command, clock_now_ns() + ANSWER_NS, &reply))
            flood->frames[flood->answers++] = (uint32_t)(reply.frame - before);
        else
            flood->unanswered++;
        clock_sleep_until_ns(clock_now_ns() + PAUSE_NS);
    }
}

static int rising(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

int main(int argc, char **argv)
{
    static struct flood flood;
    static struct view view;
    static struct command_client caller;
    struct command_socket socket;
    struct error_text error;
    log_open("flood");
    flood = parse(argc, argv);
    process_signals();
    flood.sent =
        mmap(NULL, sizeof *flood.sent, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (flood.sent == MAP_FAILED || segment_attach(&view, flood.world, ROLE_NONE, &error) != 0 ||
        command_client_open(&caller, command_socket_open(&socket, flood.world), &error) != 0)
        die_refused("cannot begin");
    for (uint32_t i = 0; i < flood.idle; i++)
        (void)connect_to(&flood);
    uint64_t begun_ns = clock_now_ns();
    pid_t flooder = fork();
    if (flooder == 0)
        flood_it(&flood);
    drive(&flood, &view, &caller, begun_ns + (uint64_t)(flood.seconds * NS_PER_S));
    double seconds = (double)(clock_now_ns() - begun_ns) / NS_PER_S;
    double sent_per_s = (double)atomic_load(flood.sent) / seconds;
    kill(flooder, SIGKILL);
    (void)waitpid(flooder, NULL, 0);
    qsort(flood.frames, flood.answers, sizeof *flood.frames, rising);
    uint32_t last = flood.answers ? flood.answers - 1 : 0;
    printf("{\"sent_per_s\":%.0f,\"answers\":%u,\"frames_p50\":%u,\"frames_p99\":%u,"
           "\"frames_max\":%u,\"unanswered\":%u}\n",
           sent_per_s, flood.answers, flood.frames[last / 2], flood.frames[last * 99 / 100],
           flood.frames[last], flood.unanswered);
    return flood.answers > 0 ? EXIT_OK : EXIT_REFUSED;
}
