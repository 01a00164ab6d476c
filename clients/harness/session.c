/* The session's loop. */
#include "clients/harness/session.h"

#include "clients/harness/json_line.h"
#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#define WAIT_NS        (250 * (uint64_t)NS_PER_MS)
#define WAIT_EVENTS_NS (25 * (uint64_t)NS_PER_MS) /* while events wait to be put in order */

/* Called by one of Cyclone DDS's threads. */
static void on_data(dds_entity_t reader, void *context)
{
    const struct session *session = context;
    (void)reader;
    (void)eventfd_write(session->wake_fd, 1);
}

static int listen_to(struct session *session, const dds_entity_t *readers, size_t count,
                     struct error_text *error)
{
    dds_listener_t *listener = dds_create_listener(session);
    dds_return_t code = DDS_RETCODE_OK;
    dds_lset_data_available(listener, on_data);
    for (size_t i = 0; i < count && code == DDS_RETCODE_OK; i++)
        code = dds_set_listener(readers[i], listener);
    dds_delete_listener(listener);
    return code == DDS_RETCODE_OK ? 0
                                  : error_text_set(error, "DDS listener: %s", dds_strretcode(code));
}

int session_open(struct session *session, struct error_text *error)
{
    const struct options *options = &session->options;
    session->wake_fd = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (session->wake_fd < 0)
        return error_text_set(error, "eventfd: %s", strerror(errno));
    if (dds_link_open(&session->link, &options->link, options->world, error) != 0 ||
        world_mirror_open(&session->mirror, &session->link, options->world, WORLD_MIRROR_BATCHES,
                          error) != 0 ||
        command_route_open(&session->route, &session->client, options->remote, &session->link,
                           options->world, error) != 0 ||
        listen_to(session, session->mirror.reader, WORLD_MIRROR_READERS, error) != 0 ||
        listen_to(session, &session->mirror.names_reader.reader, 1, error) != 0)
        return -1;
    session->leases.mirror = &session->mirror;
    session->leases.output = &session->output;
    session->queue.client = &session->client;
    session->queue.output = &session->output;
    session->queue.leases = &session->leases;
    session->queue.timeout_ns = (uint64_t)(options->timeout_s * NS_PER_S);
    return 0;
}

void session_close(struct session *session)
{
    if (session->has_merge)
        event_merge_close(&session->merge);
    world_mirror_close(&session->mirror);
    output_close(&session->output);
}

static bool knows_the_world(const struct session *session)
{
    return session->mirror.has_world && session->mirror.names.known && session->mirror.frame_ns;
}

bool session_wait_for_world(struct session *session)
{
    uint64_t until_ns = clock_now_ns() + session->queue.timeout_ns;
    while (!process_stopping()) {
        world_mirror_take(&session->mirror);
        if (knows_the_world(session))
            return true;
        if (clock_now_ns() >= until_ns)
            break;
        struct pollfd wake_fd = {.fd = session->wake_fd, .events = POLLIN};
        eventfd_t counter;
        (void)poll(&wake_fd, 1, 50);
        (void)eventfd_read(session->wake_fd, &counter);
    }
    return false;
}

/* Writes the world's description when it is new. The leases of the world before are forgotten. */
static void write_world(struct session *session)
{
    if (session->mirror.world.run == session->run)
        return;
    if (session->run)
        leases_clear(&session->leases);
    session->run = session->mirror.world.run;
    output_object(&session->output, OUTPUT_ANSWER, subscription_world(&session->mirror));
}

static bool takes_lines(const struct session *session)
{
    return command_queue_room(&session->queue) && session->output.used < OUTPUT_HOLD;
}

static void take_lines(struct session *session)
{
    static char line[INPUT_LINE_MAX + 1];
    size_t bytes = 0;
    while (takes_lines(session)) {
        enum input_result result = input_next(&session->input, line, &bytes);
        if (result == INPUT_NONE)
            return;
        if (result == INPUT_TOO_LONG)
            json_line_refuse_length(session);
        else
            json_line_execute(session, line, bytes);
    }
}

static void open_events(struct session *session)
{
    struct error_text error;
    if (session->has_merge || !session->subscription.events)
        return;
    session->has_merge = true;
    if (event_merge_open(&session->merge, &session->link, subscription_format, &error) != 0 ||
        listen_to(session, session->merge.reader, EVENT_TOPIC_COUNT, &error) != 0)
        json_line_error(session, NULL, error.text);
}

/* Releases the vehicles that the program still drives. */
static void release_all(struct session *session)
{
    for (uint32_t i = 0; i < session->leases.count && command_queue_room(&session->queue); i++) {
        struct command_text order;
        struct error_text error;
        struct command_text_value value = {.number = session->leases.held[i].command.entity};
        if (command_text_begin(&order, "release", &error) == 0 &&
            command_text_give(&order, COMMAND_TEXT_VEHICLE, &value, &error) == 0)
            command_queue_add(&session->queue, "", &order);
    }
    session->released = true;
}

void session_turn(struct session *session, uint64_t now_ns)
{
    eventfd_t counter;
    (void)eventfd_read(session->wake_fd, &counter);
    world_mirror_take(&session->mirror);
    write_world(session);
    take_lines(session);
    open_events(session);
    command_client_poll(&session->client);
    command_queue_turn(&session->queue, now_ns);
    leases_turn(&session->leases, &session->client, now_ns);
    subscription_states(&session->subscription, &session->mirror, &session->output, now_ns);
    if (session->has_merge)
        subscription_events(&session->subscription, &session->merge, &session->output);
    bool silent = session->input.ended && !session->input.used && !session->queue.count;
    if (silent && !session->released)
        release_all(session);
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

void session_wait(struct session *session)
{
    uint64_t now_ns = clock_now_ns();
    uint64_t wake_ns =
        now_ns + (session->has_merge && session->merge.count ? WAIT_EVENTS_NS : WAIT_NS);
    bool reads = !session->input.ended && input_room(&session->input) && takes_lines(session);
    struct pollfd watched[] = {
        {.fd = session->wake_fd, .events = POLLIN},
        {.fd = reads ? STDIN_FILENO : -1, .events = POLLIN},
        {.fd = session->output.used ? STDOUT_FILENO : -1, .events = POLLOUT},
        {.fd = command_client_descriptor(&session->client), .events = POLLIN},
    };
    wake_ns = earlier(wake_ns, command_client_due_ns(&session->client));
    wake_ns = earlier(wake_ns, command_queue_due_ns(&session->queue));
    wake_ns = earlier(wake_ns, leases_due_ns(&session->leases));
    wake_ns = earlier(wake_ns, subscription_due_ns(&session->subscription));
    uint64_t wait_ns = wake_ns > now_ns ? wake_ns - now_ns : 0;
    if (poll(watched, 4, (int)((wait_ns + NS_PER_MS - 1) / NS_PER_MS)) <= 0)
        return;
    if (watched[1].revents)
        input_read(&session->input);
    if (watched[2].revents)
        output_write(&session->output);
}

bool session_finished(const struct session *session)
{
    bool finished = session->input.ended && !session->input.used && session->released;
    return session->output.closed || (finished && !session->queue.count && !session->output.used);
}
