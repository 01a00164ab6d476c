/* Commands over DDS. */
#include "tests/storm/sender.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "topics/dds_topics.h"

#include "status.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define REPEAT_NS  (150 * (uint64_t)NS_PER_MS)
#define LAST_NS    ((uint64_t)30 * NS_PER_S)
#define PAUSE_NS   (20 * (uint64_t)NS_PER_MS)
#define SPAWNS_MAX 200 /* the world's capacity is not what is tested */

struct sender {
    const struct storm_options *options;
    struct dds_link link;
    dds_entity_t replies, commands, waitset;
    pthread_t thread;
    _Atomic bool end;
    _Atomic uint64_t end_ns; /* when to give up on the last */
    struct chance chance;
    uint64_t source, sent, answered, spawns;
    uint32_t spawned; /* the last one's id, 0: none */
};

static jolon_Command draw(struct sender *sender)
{
    jolon_Command command = {.source = sender->source, .sequence = sender->sent + 1};
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

static bool take_reply(struct sender *sender, const jolon_Command *command)
{
    bool found = false;
    void *sample = NULL;
    dds_sample_info_t info;
    while (dds_take(sender->replies, &sample, &info, 1, 1) > 0) {
        const jolon_CommandReply *reply = sample;
        found |= info.valid_data && reply->source == command->source &&
                 reply->sequence == command->sequence;
        (void)dds_return_loan(sender->replies, &sample, 1);
        sample = NULL;
    }
    return found;
}

static bool exchange(struct sender *sender, const jolon_Command *command)
{
    uint64_t repeat_ns = 0;
    for (;;) {
        uint64_t now_ns = clock_now_ns();
        if (take_reply(sender, command))
            return true;
        if (process_stopping() || (atomic_load(&sender->end) && now_ns > sender->end_ns))
            return false;
        if (now_ns >= repeat_ns) {
            (void)dds_write(sender->commands, command);
            repeat_ns = now_ns + REPEAT_NS;
        }
        dds_topics_wait(sender->waitset, repeat_ns - now_ns);
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

struct sender *sender_start(const struct storm_options *options, struct reason *reason)
{
    const struct dds_link_options link = {.quiet = true};
    struct sender *sender = calloc(1, sizeof *sender);
    if (!sender) {
        reason_set(reason, "out of memory");
        return NULL;
    }
    sender->options = options;
    sender->chance.state = options->seed ^ 0x5eed;
    sender->source = 1 + (chance_next(&sender->chance) >> 12);
    if (dds_link_open(&sender->link, &link, options->world, reason) != 0) {
        free(sender);
        return NULL;
    }
    if ((sender->replies = dds_topics_reader(&sender->link, TOPIC_REPLY, reason)) < 0 ||
        (sender->waitset = dds_topics_waitset(&sender->link, &sender->replies, 1, reason)) < 0 ||
        (sender->commands = dds_topics_writer(&sender->link, TOPIC_COMMAND, reason)) < 0 ||
        pthread_create(&sender->thread, NULL, send_all, sender) != 0) {
        dds_link_close(&sender->link, EXIT_REFUSED);
        free(sender);
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
    return sender->source;
}

uint64_t sender_sent(const struct sender *sender)
{
    return sender->sent;
}

uint64_t sender_answered(const struct sender *sender)
{
    return sender->answered;
}

void sender_free(struct sender *sender, int exit_code)
{
    dds_link_close(&sender->link, exit_code);
    free(sender);
}
