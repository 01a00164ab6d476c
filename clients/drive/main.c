/* jolon-drive: a person drives a vehicle of a world, with a terminal's keys and other input
 * devices, and sees its state. */
#include "clients/drive/inputs.h"
#include "clients/drive/recent_events.h"
#include "clients/drive/options.h"
#include "clients/drive/plain_output.h"
#include "clients/drive/screen.h"
#include "clients/drive/terminal.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/world_partition.h"
#include "ipc/topics/command_route.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define LEAVE_NS (1 * (uint64_t)NS_PER_S)

struct drive {
    struct options options;
    struct dds_link link;
    struct world_mirror mirror;
    struct event_merge merge;
    struct command_client client;
    struct command_route route; /* of the client */
    struct inputs inputs;
    struct session session;
    struct recent_events events;
    struct plain_output plain;
    uint64_t period_ns; /* between two pictures of the screen */
    uint64_t draw_ns;   /* when the next picture is due */
};

/* Shows the session. Returns false if the reader of standard output has gone. */
static bool show(struct drive *drive, bool touched, uint64_t now_ns)
{
    if (drive->options.plain)
        return plain_output_show(&drive->plain, &drive->session, &drive->events, now_ns);
    if (touched || now_ns >= drive->draw_ns) {
        screen_draw(&drive->session, &drive->events, drive->inputs.summary, now_ns);
        drive->draw_ns = now_ns + drive->period_ns;
    }
    return true;
}

/* Keys from a pipe wait until there is a vehicle; a person's keys do not. The end of the pipe ends
 * the session. */
static bool keys_wanted(const struct drive *drive)
{
    return !drive->options.plain || drive->session.state >= SESSION_DRIVING ||
           drive->session.state == SESSION_WATCHING || isatty(STDIN_FILENO);
}

/* Each turn first reads the inputs and sends commands, for a short delay, and then reads the
 * world's data and shows it. */
static void run(struct drive *drive)
{
    struct session *session = &drive->session;
    uint64_t due_ns = 0;
    bool good = true;
    while (!process_stopping() && !session->ended && good) {
        struct intents intents;
        inputs_read(&drive->inputs, keys_wanted(drive), due_ns, &intents);
        uint64_t now_ns = clock_now_ns();
        for (uint32_t i = 0; i < intents.count; i++)
            session_apply(session, &intents.intent[i], now_ns);
        if (drive->inputs.summary_changed)
            session_notify(session, now_ns, "in use: %s", drive->inputs.summary);
        drive->inputs.summary_changed = false;
        due_ns = session_turn(session, now_ns);
        world_mirror_take(&drive->mirror);
        (void)event_merge_poll(&drive->merge, recent_events_take, &drive->events);
        good = show(drive, intents.count > 0, clock_now_ns());
        session->ended |= drive->inputs.keys_ended && session->fire == 0;
    }
}

/* Refuses a world that is not in this user's runtime folder, where its commands would go. A remote
 * world is waited for. */
static int check_world(const struct options *options, struct error_text *error)
{
    const char *partition = options->link.partition;
    char own[WORLD_PARTITION_MAX];
    struct view view;
    if (options->remote)
        return 0;
    if (partition && world_partition_own(own, options->world, error) != 0)
        return -1;
    if (partition && strcmp(partition, own) != 0)
        return error_text_set(error,
                              "--partition %.64s: is a world of another runtime folder, which "
                              "takes commands over DDS alone; right would be: --remote as well",
                              partition);
    if (segment_attach(&view, options->world, ROLE_NONE, error) != 0)
        return -1;
    segment_detach(&view);
    return 0;
}

static void open_all(struct drive *drive)
{
    struct error_text error;
    const struct options *options = &drive->options;
    if (check_world(options, &error) != 0 ||
        inputs_open(&drive->inputs, options->input, options->device, &error) != 0 ||
        dds_link_open(&drive->link, &options->link, options->world, &error) != 0 ||
        world_mirror_open(&drive->mirror, &drive->link, options->world, WORLD_MIRROR_MOTIONS,
                          &error) != 0 ||
        event_merge_open(&drive->merge, &drive->link, recent_events_format, &error) != 0 ||
        command_route_open(&drive->route, &drive->client, options->remote, &drive->link,
                           options->world, &error) != 0)
        die_refused("%s", error.text);
    session_open(&drive->session, &drive->mirror, &drive->client, options->wanted, clock_now_ns());
    drive->events.session = &drive->session;
    drive->period_ns = (uint64_t)(NS_PER_S / options->rate_hz);
    drive->plain.period_ns = drive->period_ns;
    if (!options->plain && screen_open(&error) != 0)
        die_refused("%s", error.text);
    terminal_open(!options->plain);
}

int main(int argc, char **argv)
{
    static struct drive drive;
    log_open("drive");
    options_parse(&drive.options, argc, argv);
    drive.options.link.quiet = !drive.options.plain;
    process_signals();
    open_all(&drive);
    run(&drive);
    session_leave(&drive.session, clock_now_ns() + LEAVE_NS);
    if (!drive.options.plain)
        screen_close();
    terminal_restore();
    int code = drive.session.refused ? EXIT_REFUSED : EXIT_OK;
    if (drive.session.refused)
        (void)fprintf(stderr, "jolon-drive: %s\n", drive.session.notice);
    inputs_close(&drive.inputs);
    event_merge_close(&drive.merge);
    world_mirror_close(&drive.mirror);
    (void)fflush(stdout);
    dds_link_close(&drive.link, code);
    return code;
}
