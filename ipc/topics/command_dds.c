/* Commands over DDS. */
#include "ipc/topics/command_dds.h"

#include <errno.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

/* Runs in one of Cyclone DDS's threads. */
static void on_reply(dds_entity_t reader, void *context)
{
    const struct command_dds *dds = context;
    (void)reader;
    (void)eventfd_write(dds->wakeup, 1);
}

static int wake_on_reply(struct command_dds *dds, struct error_text *error)
{
    dds_listener_t *listener = dds_create_listener(dds);
    dds_lset_data_available(listener, on_reply);
    dds_return_t code = dds_set_listener(dds->replies, listener);
    dds_delete_listener(listener);
    return code == DDS_RETCODE_OK ? 0
                                  : error_text_set(error, "DDS listener: %s", dds_strretcode(code));
}

static void send_command(void *self, const jolon_Command *command)
{
    const struct command_dds *dds = self;
    if (dds_link_is_single(dds->link)) /* otherwise all worlds of the name would take it */
        (void)dds_write(dds->commands, command);
}

static bool receive(void *self, jolon_CommandReply *reply)
{
    const struct command_dds *dds = self;
    void *sample = NULL;
    dds_sample_info_t info;
    eventfd_t count;
    (void)eventfd_read(dds->wakeup, &count);
    while (dds_take(dds->replies, &sample, &info, 1, 1) > 0) {
        bool valid = info.valid_data;
        if (valid)
            *reply = *(const jolon_CommandReply *)sample;
        (void)dds_return_loan(dds->replies, &sample, 1);
        sample = NULL;
        if (valid)
            return true;
    }
    return false;
}

static bool reachable(void *self)
{
    const struct command_dds *dds = self;
    return dds_link_is_single(dds->link) && dds_topics_readers(dds->commands, NULL) > 0;
}

static int descriptor(void *self)
{
    const struct command_dds *dds = self;
    return dds->wakeup;
}

int command_dds_open(struct command_dds *dds, const struct dds_link *link,
                     struct command_link *command_link, struct error_text *error)
{
    static const struct command_transport transport = {send_command, receive, reachable,
                                                       descriptor};
    *command_link = (struct command_link){&transport, dds};
    dds->link = link;
    dds->wakeup = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (dds->wakeup < 0)
        return error_text_set(error, "eventfd: %s", strerror(errno));
    /* The reader first: the reply may come as soon as the command is sent. */
    if ((dds->replies = dds_topics_reader(link, TOPIC_REPLY, error)) < 0 ||
        (dds->commands = dds_topics_writer(link, TOPIC_COMMAND, error)) < 0)
        return -1;
    return wake_on_reply(dds, error);
}
