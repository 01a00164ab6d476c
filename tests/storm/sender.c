/* Sends random commands over the command socket. */
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
#define SPAWNS_MAX 200 /* keeps the world below its capacity */

struct sender {
    const struct storm_options *options;
    struct command_socket socket;
    struct command_client client;
    pthread_t thread;
    _Atomic bool end;
    _Atomic uint64_t give_up_ns; /* when to give up waiting for the last answer */
    struct prng prng;
    uint64_t sent, answered, spawns;
    uint32_t spawned;
};

static jolon_Command draw(struct sender *sender)
{
    jolon_Command command = {0};
    uint64_t kind = prng_below(&sender->prng, 4);
    command.x_m = 24900.0 + 200.0 * prng_unit(&sender->prng);
    command.z_m = 24900.0 + 200.0 * prng_unit(&sender->prng);
    command.entity = 1 + (uint32_t)prng_below(&sender->prng, 60);
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
        command.throttle = (float)prng_unit(&sender->prng);
        command.steer = (float)(2.0 * prng_unit(&sender->prng) - 1.0);
    }
    return command;
}

/* Sends a command and waits for its reply. The client repeats the command meanwhile. Returns false
 * if the storm ends first. */
static bool exchange(struct sender *sender, const jolon_Command *command)
{
    jolon_CommandReply reply;
    uint64_t sequence = command_client_send(&sender->client, command);
    for (;;) {
        command_client_poll(&sender->client);
        if (command_client_answered(&sender->client, sequence, &reply))
            return true;
        uint64_t now_ns = clock_now_ns();
        if (process_stopping() || (atomic_load(&sender->end) && now_ns > sender->give_up_ns))
            return false;
        command_client_wait(&sender->client, now_ns + WAIT_NS);
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
        clock_sleep_until_ns(clock_now_ns() + prng_below(&sender->prng, PAUSE_NS));
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
    sender->prng.state = options->seed ^ 0x5eed;
    if (command_client_open(&sender->client, command_socket_open(&sender->socket, options->world),
                            error) != 0 ||
        pthread_create(&sender->thread, NULL, send_all, sender) != 0) {
        sender_free(sender);
        return NULL;
    }
    return sender;
}

void sender_stop(struct sender *sender)
{
    sender->give_up_ns = clock_now_ns() + LAST_NS;
    atomic_store(&sender->end, true);
    pthread_join(sender->thread, NULL);
}

uint64_t sender_source(const struct sender *sender)
{
    return sender->client.source;
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
