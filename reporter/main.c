/* jolon-reporter: the only process of a set that uses DDS. It publishes the status topics and, with
 * --remote-commands, passes on the commands of other machines. The frame loop waits neither for it
 * nor for its subscribers. */
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "reporter/entity_topic.h"
#include "reporter/event_topics.h"
#include "reporter/motion_topic.h"
#include "reporter/options.h"
#include "reporter/remote_commands.h"
#include "reporter/status_topics.h"
#include "ipc/sandbox/sandbox.h"

/* Longest waits between two polls: idle, and with a command in progress. With either the heartbeat
 * comes at least every 25 ms. */
#define WAIT_NS         (10 * (uint64_t)NS_PER_MS)
#define WAIT_COMMAND_NS (2 * (uint64_t)NS_PER_MS)

/* The longest time for events in one poll. */
#define EVENTS_LIMIT_NS (10 * (uint64_t)NS_PER_MS)

/* At the end: the longest times for the last events, and for subscribers to receive them. */
#define LAST_EVENTS_NS (500 * (uint64_t)NS_PER_MS)
#define LAST_ACKS_NS   (200 * (uint64_t)NS_PER_MS)

struct reporter {
    struct view view;
    struct dds_link link;
    struct status_topics status;
    struct event_topics events;
    struct remote_commands remote;
    bool takes_commands;
    struct entity_topic entities;
    struct motion_topic motions;
    uint64_t frame_due_ns, names_due_ns;
};

static int open_topics(struct reporter *reporter, struct error_text *error)
{
    const struct dds_link *link = &reporter->link;
    struct view *view = &reporter->view;
    if (status_topics_open(&reporter->status, view, link, error) != 0 ||
        status_topics_world(&reporter->status, view, error) != 0 ||
        status_topics_names(&reporter->status, view, error) != 0 ||
        event_topics_open(&reporter->events, view, link, reporter->status.run, error) != 0 ||
        entity_topic_open(&reporter->entities, view, link, reporter->status.run, error) != 0 ||
        motion_topic_open(&reporter->motions, view, link, reporter->status.run, error) != 0)
        return -1;
    if (reporter->takes_commands &&
        remote_commands_open(&reporter->remote, view->name, link, error) != 0)
        return -1;
    return 0;
}

/* Publishes the status of processes and frame ten times a second. */
static void publish_status(struct reporter *reporter, uint64_t now_ns)
{
    if (now_ns < reporter->frame_due_ns)
        return;
    reporter->frame_due_ns += STATUS_TOPICS_PERIOD_NS;
    if (reporter->frame_due_ns <= now_ns)
        reporter->frame_due_ns = now_ns + STATUS_TOPICS_PERIOD_NS;
    status_topics_processes(&reporter->status, &reporter->view, now_ns);
    status_topics_frame(&reporter->status, &reporter->view, now_ns);
}

/* Returns true when more work is waiting. */
static bool poll_once(struct reporter *reporter)
{
    struct role_slot *slot = reporter->view.slot[ROLE_REPORTER];
    uint64_t begun_ns = clock_now_ns();
    frame_protocol_beat(&reporter->view);
    if (reporter->takes_commands)
        remote_commands_poll(&reporter->remote, begun_ns);
    bool more =
        !event_topics_publish(&reporter->events, &reporter->view, begun_ns + EVENTS_LIMIT_NS);
    publish_status(reporter, begun_ns);
    more |= entity_topic_publish(&reporter->entities, &reporter->view, clock_now_ns());
    more |= motion_topic_publish(&reporter->motions, &reporter->view, clock_now_ns());
    if (begun_ns >= reporter->names_due_ns) {
        reporter->names_due_ns = begun_ns + NS_PER_S;
        status_topics_markings(
            &reporter->status, &reporter->view,
            snapshot_later(&reporter->entities.snapshot, &reporter->motions.snapshot));
    }
    uint64_t stage_ns = clock_now_ns() - begun_ns;
    log_frame(reporter->events.frame);
    atomic_store_explicit(&slot->gaps, reporter->events.gaps, memory_order_relaxed);
    frame_protocol_stage_done(&reporter->view, reporter->events.frame, stage_ns);
    return more;
}

/* Waits until the next poll is due, or a command comes. */
static void wait_for_poll(const struct reporter *reporter)
{
    if (reporter->takes_commands)
        remote_commands_wait(&reporter->remote, WAIT_COMMAND_NS, WAIT_NS);
    else /* an empty wait set would not wait */
        clock_sleep_until_ns(clock_now_ns() + WAIT_NS);
}

/* Publishes what is committed before the process ends, within bounds. */
static void publish_last(struct reporter *reporter)
{
    uint64_t now_ns = clock_now_ns();
    atomic_store(&reporter->view.slot[ROLE_REPORTER]->state, ROLE_STOPPING);
    (void)event_topics_publish(&reporter->events, &reporter->view, now_ns + LAST_EVENTS_NS);
    status_topics_processes(&reporter->status, &reporter->view, now_ns);
    status_topics_frame(&reporter->status, &reporter->view, now_ns);
    event_topics_flush(&reporter->events, clock_now_ns() + LAST_ACKS_NS);
}

int main(int argc, char **argv)
{
    static struct reporter reporter;
    struct sandbox sandbox;
    struct error_text error;
    log_open("reporter");
    struct options options;
    options_parse(&options, argc, argv);
    process_begin_beside(options.parent);
    if (sandbox_begin(&sandbox, ROLE_REPORTER, options.sandbox_off, &error) != 0 ||
        segment_attach(&reporter.view, options.world, ROLE_REPORTER, &error) != 0)
        die_refused("%s", error.text);
    options.link.part = DDS_HOST;
    reporter.takes_commands = options.remote_commands;
    if (dds_link_open(&reporter.link, &options.link, options.world, &error) != 0 ||
        open_topics(&reporter, &error) != 0 || sandbox_enter(&sandbox, &error) != 0) {
        segment_detach(&reporter.view);
        die_refused("%s", error.text);
    }
    remote_commands_tell(&reporter.view, reporter.takes_commands && !reporter.link.secure);
    segment_ready(&reporter.view);

    while (!process_stopping()) {
        if (!poll_once(&reporter))
            wait_for_poll(&reporter);
    }

    publish_last(&reporter);
    motion_topic_close(&reporter.motions);
    entity_topic_close(&reporter.entities);
    segment_detach(&reporter.view);
    dds_link_close(&reporter.link, EXIT_OK);
    return EXIT_OK;
}
