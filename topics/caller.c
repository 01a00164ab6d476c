/* Commands out, replies in. */
#include "topics/caller.h"

#include "ipc/clock.h"
#include "ipc/process.h"

#include <string.h>
#include <sys/random.h>

int caller_open(struct caller *caller, const struct dds_link *link, struct reason *reason)
{
    *caller = (struct caller){0};
    /* The reader first: the reply may come as soon as the command is out. */
    if ((caller->replies = dds_topics_reader(link, TOPIC_REPLY, reason)) < 0 ||
        (caller->waitset = dds_topics_waitset(link, &caller->replies, 1, reason)) < 0 ||
        (caller->commands = dds_topics_writer(link, TOPIC_COMMAND, reason)) < 0)
        return -1;
    caller->source = caller_source();
    return caller->source ? 0 : reason_set(reason, "the system gives no random numbers");
}

uint64_t caller_source(void)
{
    uint64_t source = 0;
    while (source == 0) {
        if (getrandom(&source, sizeof source, 0) != (ssize_t)sizeof source)
            return 0;
        source >>= 11;
    }
    return source;
}

static struct caller_call *find(struct caller *caller, uint64_t sequence)
{
    for (uint32_t i = 0; i < caller->count; i++) {
        if (caller->call[i].command.sequence == sequence)
            return &caller->call[i];
    }
    return NULL;
}

static void drop(struct caller *caller, struct caller_call *call)
{
    size_t after = (size_t)(&caller->call[caller->count] - (call + 1));
    memmove(call, call + 1, after * sizeof *call);
    caller->count--;
}

static void drop_older_drives(struct caller *caller, const jolon_Command *command)
{
    for (uint32_t i = caller->count; i-- > 0;) {
        const jolon_Command *older = &caller->call[i].command;
        if (older->type == jolon_COMMAND_DRIVE && older->entity == command->entity &&
            older->source == command->source && !caller->call[i].answered)
            drop(caller, &caller->call[i]);
    }
}

uint64_t caller_send(struct caller *caller, const jolon_Command *command)
{
    struct caller_call call = {.command = *command};
    if (!call.command.source)
        call.command.source = caller->source;
    if (command->type == jolon_COMMAND_DRIVE)
        drop_older_drives(caller, &call.command);
    if (caller->count == CALLER_WAITING_MAX)
        return 0;
    call.command.sequence = ++caller->sequence;
    call.repeat_ns = clock_now_ns() + CALLER_REPEAT_NS;
    (void)dds_write(caller->commands, &call.command); /* what does not get out is repeated */
    caller->call[caller->count++] = call;
    return call.command.sequence;
}

static void take_replies(struct caller *caller)
{
    void *sample = NULL;
    dds_sample_info_t info;
    while (dds_take(caller->replies, &sample, &info, 1, 1) > 0) {
        const jolon_CommandReply *reply = sample;
        struct caller_call *call = info.valid_data ? find(caller, reply->sequence) : NULL;
        if (call && call->command.source == reply->source) {
            call->reply = *reply;
            call->answered = true;
        }
        (void)dds_return_loan(caller->replies, &sample, 1);
        sample = NULL;
    }
}

void caller_turn(struct caller *caller)
{
    uint64_t now_ns = clock_now_ns();
    take_replies(caller);
    for (uint32_t i = 0; i < caller->count; i++) {
        struct caller_call *call = &caller->call[i];
        if (call->answered || now_ns < call->repeat_ns)
            continue;
        (void)dds_write(caller->commands, &call->command);
        call->repeat_ns = now_ns + CALLER_REPEAT_NS;
    }
}

bool caller_answered(struct caller *caller, uint64_t sequence, jolon_CommandReply *reply)
{
    struct caller_call *call = find(caller, sequence);
    if (!call || !call->answered)
        return false;
    *reply = call->reply;
    drop(caller, call);
    return true;
}

void caller_forget(struct caller *caller, uint64_t sequence)
{
    struct caller_call *call = find(caller, sequence);
    if (call)
        drop(caller, call);
}

uint64_t caller_due_ns(const struct caller *caller)
{
    uint64_t due_ns = UINT64_MAX;
    for (uint32_t i = 0; i < caller->count; i++) {
        const struct caller_call *call = &caller->call[i];
        if (!call->answered && call->repeat_ns < due_ns)
            due_ns = call->repeat_ns;
    }
    return due_ns;
}

bool caller_call(struct caller *caller, const jolon_Command *command, uint64_t until_ns,
                 jolon_CommandReply *reply)
{
    uint64_t sequence = caller_send(caller, command);
    while (sequence) {
        caller_turn(caller);
        if (caller_answered(caller, sequence, reply))
            return true;
        uint64_t now_ns = clock_now_ns(), due_ns = caller_due_ns(caller);
        if (now_ns >= until_ns || process_stopping())
            break;
        uint64_t wake_ns = due_ns < until_ns ? due_ns : until_ns;
        dds_topics_wait(caller->waitset, wake_ns > now_ns ? wake_ns - now_ns : 0);
    }
    caller_forget(caller, sequence);
    return false;
}

bool caller_heard(const struct caller *caller)
{
    dds_publication_matched_status_t matched = {0};
    return dds_get_publication_matched_status(caller->commands, &matched) >= 0 &&
           matched.current_count > 0;
}
