/* Passes commands from DDS to the intake, and replies to DDS. */
#include "reporter/remote_commands.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/segment/runtime_folder.h"

#include <unistd.h>

#define TAKE_AT_ONCE 256
#define BUSY_NS      (500 * (uint64_t)NS_PER_MS)

int remote_commands_open(struct remote_commands *remote, const char *world,
                         const struct dds_link *link, struct error_text *error)
{
    /* Finding the runtime folder needs more than the sandbox allows, so it is found now. */
    int folder = runtime_folder_open(error);
    *remote = (struct remote_commands){.world = world};
    if (folder < 0)
        return -1;
    close(folder);
    remote->writer = dds_topics_writer(link, TOPIC_REPLY, error);
    if (remote->writer < 0)
        return -1;
    remote->reader = dds_topics_reader(link, TOPIC_COMMAND, error);
    if (remote->reader < 0)
        return -1;
    remote->waitset = dds_topics_waitset(link, &remote->reader, 1, error);
    return remote->waitset < 0 ? -1 : 0;
}

/* Returns the entry of a DDS writer. A new writer replaces the one that has been silent for
 * longest. */
static struct remote_sender *find_sender(struct remote_commands *remote,
                                         dds_instance_handle_t handle)
{
    struct remote_sender *oldest = &remote->sender[0];
    for (uint32_t i = 0; i < REMOTE_SENDERS; i++) {
        struct remote_sender *sender = &remote->sender[i];
        if (sender->handle == handle)
            return sender;
        if (sender->heard_ns < oldest->heard_ns)
            oldest = sender;
    }
    if (oldest->handle)
        command_socket_close(&oldest->socket);
    *oldest = (struct remote_sender){.handle = handle};
    oldest->link = command_socket_open(&oldest->socket, remote->world);
    return oldest;
}

static void pass_commands(struct remote_commands *remote, uint64_t now_ns)
{
    for (int i = 0; i < TAKE_AT_ONCE; i++) {
        void *sample = NULL;
        dds_sample_info_t info;
        if (dds_take(remote->reader, &sample, &info, 1, 1) <= 0)
            return;
        if (info.valid_data) {
            struct remote_sender *sender = find_sender(remote, info.publication_handle);
            sender->heard_ns = now_ns;
            sender->link.transport->send(sender->link.self, sample);
        }
        (void)dds_return_loan(remote->reader, &sample, 1);
    }
}

static void pass_replies(struct remote_commands *remote)
{
    jolon_CommandReply reply;
    for (uint32_t i = 0; i < REMOTE_SENDERS; i++) {
        const struct remote_sender *sender = &remote->sender[i];
        while (sender->handle && sender->link.transport->receive(sender->link.self, &reply))
            (void)dds_write(remote->writer, &reply); /* repeated if it is lost */
    }
}

void remote_commands_poll(struct remote_commands *remote, uint64_t now_ns)
{
    pass_commands(remote, now_ns);
    pass_replies(remote);
}

static bool busy(const struct remote_commands *remote, uint64_t now_ns)
{
    for (uint32_t i = 0; i < REMOTE_SENDERS; i++) {
        if (remote->sender[i].handle && now_ns - remote->sender[i].heard_ns < BUSY_NS)
            return true;
    }
    return false;
}

void remote_commands_wait(const struct remote_commands *remote, uint64_t busy_ns, uint64_t idle_ns)
{
    dds_topics_wait(remote->waitset, busy(remote, clock_now_ns()) ? busy_ns : idle_ns);
}

void remote_commands_tell(struct view *view, bool unguarded)
{
    atomic_store_explicit(&view->slot[ROLE_REPORTER]->unguarded, unguarded, memory_order_relaxed);
    if (!unguarded)
        return;
    log_warn("************************************************************************");
    log_warn("* --remote-commands WITHOUT DDS Security: every host that reaches this *");
    log_warn("* machine's DDS ports commands the world: pauses, fills and empties it. *");
    log_warn("* docs/topics.md, \"Security\", says how to let in only known clients.   *");
    log_warn("************************************************************************");
}
