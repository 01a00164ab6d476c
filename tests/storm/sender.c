/* Commands over the command socket. */
#include "tests/storm/sender.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/command_socket.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define LAST_NS    ((uint64_t)30 * NS_PER_S)
#define WAIT_NS    (150 * (uint64_t)NS_PER_MS)
#define PAUSE_NS   (20 * (uint64_t)NS_PER_MS)
#define SPAWNS_MAX 200 /* the world's capacity is not what is tested */

struct sender {
    const struct storm_options *options;
    struct command_socket socket;
    struct command_client caller;
    pthread_t thread;
    _Atomic bool end;
    _Atomic uint64_t end_ns; /* when to give up on the last */
    struct chance chance;
    uint64_t sent, answered, spawns;
    uint32_t spawned; /* the last one's id, 0: none */
};

static jolon_Command draw(struct sender *sender)
{
    jolon_Command command = {0};
    uint64_t kind = chance_below(&sender->chance, 4);
    command.x_m = 24900.0 + 200.0 * chance_unit(&sender->chance);
    command.z_m = 24900.0 + 200.0 * chance_unit(&sender->chance);
    command.entity = 1 + (uint32_t)chance_below(&sender->chance, 60);
    if (kind == 0 && sender->spawns < SPAWNS_MAX) {
        command.type = jolon_COMMAND_SPAWN;
        command.altitude_m = -1.0;
        command.behaviour = jolon_BEHAVIOUR_PATROL;
        (void)strcpy(command.kind, "jeep");
        sender->spawns++;
    } else if (kind == 1) {
        command.type = jolon_COMMAND_FIRE;
        command.entity = 0;
        (void)strcpy(command.kind, "shell");
    } else if (kind == 2) {
        command.type = jolon_COMMAND_RELEASE;
    } else {
        command.type = jolon_COMMAND_DRIVE;
        command.throttle = (float)chance_unit(&sender->chance);
        command.steer = (float)(2.0 * chance_unit(&sender->chance) - 1.0);
    }
    return command;
}

/* The caller repeats the command until its reply comes. */
static bool exchange(struct sender *sender, const jolon_Command *command)
{
    jolon_CommandReply reply;
    uint64_t sequence = command_client_send(&sender->caller, command);
    for (;;) {
        command_client_poll(&sender->caller);
        if (command_client_answered(&sender->caller, sequence, &reply))
            return true;
        uint64_t now_ns = clock_now_ns();
        if (process_stopping() || (atomic_load(&sender->end) && now_ns > sender->end_ns))
            return false;
        command_client_wait(&sender->caller, now_ns + WAIT_NS);
    }
}

static void *send_all(void *argument)
{
    struct sender *sender = argument;
    while (!atomic_load(&sender->end) && sender->sent < sender->options->commands) {
        jolon_Command command = draw(sender);
        sender->sent++;
        if (!exchange(sender, &command))
            break;
        sender->answered++;
        clock_sleep_until_ns(clock_now_ns() + chance_below(&sender->chance, PAUSE_NS));
    }
    return NULL;
}

struct sender *sender_start(const struct storm_options *options, struct error_text *error)
{
    struct sender *sender = calloc(1, sizeof *sender);
    if (!sender) {
        error_text_set(error, "out of memory");
        return NULL;
    }
    sender->options = options;
    sender->chance.state = options->seed ^ 0x5eed;
    if (command_client_open(&sender->caller, command_socket_open(&sender->socket, options->world),
                            error) != 0 ||
        pthread_create(&sender->thread, NULL, send_all, sender) != 0) {
        sender_free(sender);
        return NULL;
    }
    return sender;
}

void sender_stop(struct sender *sender)
{
    sender->end_ns = clock_now_ns() + LAST_NS;
    atomic_store(&sender->end, true);
    pthread_join(sender->thread, NULL);
}

uint64_t sender_source(const struct sender *sender)
{
    return sender->caller.source;
}

uint64_t sender_sent(const struct sender *sender)
{
    return sender->sent;
}

uint64_t sender_answered(const struct sender *sender)
{
    return sender->answered;
}

void sender_free(struct sender *sender)
{
    command_socket_close(&sender->socket);
    free(sender);
}
