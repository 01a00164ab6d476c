/* Sends commands and takes replies. */
#include "ipc/topics/command_client.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <poll.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

int command_client_open(struct command_client *client, struct command_link link,
                        struct error_text *error)
{
    *client = (struct command_client){.link = link};
    client->source = command_client_source();
    return client->source ? 0 : error_text_set(error, "the system gives no random numbers");
}

uint64_t command_client_source(void)
{
    uint64_t source = 0;
    while (source == 0) {
        if (getrandom(&source, sizeof source, 0) != (ssize_t)sizeof source)
            return 0;
        source >>= 11;
    }
    return source;
}

static struct command_client_call *find(struct command_client *client, uint64_t sequence)
{
    for (uint32_t i = 0; i < client->count; i++) {
        if (client->call[i].command.sequence == sequence)
            return &client->call[i];
    }
    return NULL;
}

static void drop(struct command_client *client, struct command_client_call *call)
{
    size_t after = (size_t)(&client->call[client->count] - (call + 1));
    memmove(call, call + 1, after * sizeof *call);
    client->count--;
}

static void drop_older_drives(struct command_client *client, const jolon_Command *command)
{
    for (uint32_t i = client->count; i-- > 0;) {
        const jolon_Command *older = &client->call[i].command;
        if (older->type == jolon_COMMAND_DRIVE && older->entity == command->entity &&
            older->source == command->source && !client->call[i].answered)
            drop(client, &client->call[i]);
    }
}

uint64_t command_client_send(struct command_client *client, const jolon_Command *command)
{
    struct command_client_call call = {.command = *command};
    if (!call.command.source)
        call.command.source = client->source;
    if (command->type == jolon_COMMAND_DRIVE)
        drop_older_drives(client, &call.command);
    if (client->count == COMMAND_CLIENT_WAITING_MAX)
        return 0;
    call.command.sequence = ++client->sequence;
    call.repeat_ns = clock_now_ns() + COMMAND_CLIENT_REPEAT_NS;
    client->link.transport->send(client->link.self,
                                 &call.command); /* a command that is lost here is repeated */
    client->call[client->count++] = call;
    return call.command.sequence;
}

static void take_replies(struct command_client *client)
{
    jolon_CommandReply reply;
    while (client->link.transport->receive(client->link.self, &reply)) {
        struct command_client_call *call = find(client, reply.sequence);
        if (call && call->command.source == reply.source) {
            call->reply = reply;
            call->answered = true;
        }
    }
}

void command_client_poll(struct command_client *client)
{
    uint64_t now_ns = clock_now_ns();
    take_replies(client);
    for (uint32_t i = 0; i < client->count; i++) {
        struct command_client_call *call = &client->call[i];
        if (call->answered || now_ns < call->repeat_ns)
            continue;
        client->link.transport->send(client->link.self, &call->command);
        call->repeat_ns = now_ns + COMMAND_CLIENT_REPEAT_NS;
    }
}

bool command_client_answered(struct command_client *client, uint64_t sequence,
                             jolon_CommandReply *reply)
{
    struct command_client_call *call = find(client, sequence);
    if (!call || !call->answered)
        return false;
    *reply = call->reply;
    drop(client, call);
    return true;
}

void command_client_forget(struct command_client *client, uint64_t sequence)
{
    struct command_client_call *call = find(client, sequence);
    if (call)
        drop(client, call);
}

uint64_t command_client_due_ns(const struct command_client *client)
{
    uint64_t due_ns = UINT64_MAX;
    for (uint32_t i = 0; i < client->count; i++) {
        const struct command_client_call *call = &client->call[i];
        if (!call->answered && call->repeat_ns < due_ns)
            due_ns = call->repeat_ns;
    }
    return due_ns;
}

bool command_client_call(struct command_client *client, const jolon_Command *command,
                         uint64_t until_ns, jolon_CommandReply *reply)
{
    uint64_t sequence = command_client_send(client, command);
    while (sequence) {
        command_client_poll(client);
        if (command_client_answered(client, sequence, reply))
            return true;
        if (clock_now_ns() >= until_ns || process_stopping())
            break;
        command_client_wait(client, until_ns);
    }
    command_client_forget(client, sequence);
    return false;
}

bool command_client_reachable(const struct command_client *client)
{
    return client->link.transport->reachable(client->link.self);
}

int command_client_descriptor(const struct command_client *client)
{
    return client->link.transport->descriptor(client->link.self);
}

void command_client_wait(const struct command_client *client, uint64_t until_ns)
{
    struct pollfd reply = {.fd = command_client_descriptor(client), .events = POLLIN};
    uint64_t due_ns = command_client_due_ns(client), now_ns = clock_now_ns();
    uint64_t wake_ns = due_ns < until_ns ? due_ns : until_ns;
    uint64_t left_ns = wake_ns > now_ns ? wake_ns - now_ns : 0;
    struct timespec left = {.tv_sec = (time_t)(left_ns / NS_PER_S),
                            .tv_nsec = (long)(left_ns % NS_PER_S)};
    (void)ppoll(&reply, 1, &left, NULL);
}
