/* peer: a foreign participant in a world's DDS domain, for tests of what it can do to the others.
 *
 *     peer -w WORLD [--dds-config FILE] [--domain N] capture FILE
 *         reads every topic and writes commands that change nothing, for two seconds; FILE has
 *         every datagram that it sent (tests/rtps/sent.h)
 *     peer ... command
 *         sends one such command again and again: "answered" or, after three seconds, "unanswered"
 *     peer ... read
 *         waits for the status of a frame: "heard" or, after three seconds, "unheard"
 *     peer ... hostile SEED
 *         writes samples on every topic of the world's status that no reporter would write, for
 *         three seconds (tests/rtps/hostile.h) */
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "tests/rtps/hostile.h"
#include "tests/rtps/sent.h"
#include "ipc/topics/dds_topics.h"

#include "status.h"

#include <stdlib.h>
#include <string.h>

#define CAPTURE_NS  ((uint64_t)2 * NS_PER_S)
#define HOSTILE_NS  ((uint64_t)3 * NS_PER_S)
#define PATIENCE_NS ((uint64_t)3 * NS_PER_S)
#define REPEAT_NS   ((uint64_t)100 * NS_PER_MS)

struct peer {
    struct dds_link link;
    const char *world;
    dds_entity_t reader[TOPIC_COUNT], commands; /* 0: none */
    uint64_t source, sequence;
    bool heard[TOPIC_COUNT]; /* a sample of the topic; a reply only if it is for this peer */
};

static void open_reader(struct peer *peer, enum dds_topic topic)
{
    struct error_text error;
    peer->reader[topic] = dds_topics_reader(&peer->link, topic, &error);
    if (peer->reader[topic] < 0)
        die_refused("%s", error.text);
}

static void open_writer(struct peer *peer)
{
    struct error_text error;
    peer->source = clock_now_ns() | 1;
    peer->commands = dds_topics_writer(&peer->link, TOPIC_COMMAND, &error);
    if (peer->commands < 0)
        die_refused("%s", error.text);
}

/* Makes a command that releases a vehicle that cannot exist. */
static void send_command(struct peer *peer, uint64_t sequence)
{
    jolon_Command command = {.source = peer->source,
                             .sequence = sequence,
                             .type = jolon_COMMAND_RELEASE,
                             .entity = UINT32_MAX,
                             .throttle = 0.5F,
                             .x_m = 25000.0,
                             .z_m = 25000.0};
    (void)stpncpy(command.kind, "tank", sizeof command.kind - 1);
    if (peer->commands)
        (void)dds_write(peer->commands, &command);
}

static void take(struct peer *peer)
{
    for (int i = 0; i < TOPIC_COUNT; i++) {
        void *sample = NULL;
        dds_sample_info_t info;
        while (peer->reader[i] && dds_take(peer->reader[i], &sample, &info, 1, 1) > 0) {
            if (info.valid_data &&
                (i != TOPIC_REPLY || ((const jolon_CommandReply *)sample)->source == peer->source))
                peer->heard[i] = true;
            (void)dds_return_loan(peer->reader[i], &sample, 1);
            sample = NULL;
        }
    }
}

/* Reads until the topic has been received, or until the limit. Meanwhile repeats the same command
 * or sends other ones. */
static void run(struct peer *peer, uint64_t length_ns, int wanted, bool repeat)
{
    uint64_t begun_ns = clock_now_ns(), due_ns = begun_ns;
    while (clock_now_ns() - begun_ns < length_ns && (wanted < 0 || !peer->heard[wanted])) {
        if (clock_now_ns() >= due_ns) {
            send_command(peer, repeat ? 1 : ++peer->sequence);
            due_ns += REPEAT_NS;
        }
        clock_sleep_until_ns(clock_now_ns() + REPEAT_NS / 10);
        take(peer);
    }
}

static void capture(struct peer *peer, const char *path)
{
    FILE *file = fopen(path, "wbe");
    if (!file)
        die_refused("%s: cannot write", path);
    sent_keep(file);
    for (int i = 0; i < TOPIC_COUNT; i++)
        open_reader(peer, (enum dds_topic)i);
    open_writer(peer);
    run(peer, CAPTURE_NS, -1, false);
    dds_link_close(&peer->link, EXIT_REFUSED);
    sent_keep(NULL);
    if (fclose(file) != 0)
        die_refused("%s: cannot write", path);
}

static void say(bool yes, const char *word, const char *otherwise)
{
    (void)puts(yes ? word : otherwise);
}

int main(int argc, char **argv)
{
    static struct peer peer = {.world = "default"};
    static struct dds_link_options options = {.part = DDS_PEER};
    static const struct option_row rows[] = {OPTION_ROW_WORLD(peer, NULL),
                                             DDS_LINK_OPTION_ROWS(options), OPTION_ROWS_END};
    static const struct option_table table = {.program = "peer", .rows = rows, .plain = 2};
    struct error_text error;
    log_open("peer");
    int count = option_table_read(&table, argc, argv);
    const char *verb = count > 0 ? argv[argc - count] : "";
    const char *value = count > 1 ? argv[argc - 1] : NULL;
    bool captures = strcmp(verb, "capture") == 0, hostile = strcmp(verb, "hostile") == 0;
    if ((captures || hostile) != (value != NULL))
        die_usage("tests/rtps/peer.c says how to call it");
    if (hostile)
        options.part = DDS_HOST; /* monitors must find no other writer */
    if (dds_link_open(&peer.link, &options, peer.world, &error) != 0)
        die_refused("%s", error.text);
    if (captures) {
        capture(&peer, value);
        return EXIT_OK;
    }
    if (hostile) {
        hostile_write(&peer.link, strtoull(value, NULL, 10), HOSTILE_NS);
    } else if (strcmp(verb, "command") == 0) {
        open_reader(&peer, TOPIC_REPLY);
        open_writer(&peer);
        run(&peer, PATIENCE_NS, TOPIC_REPLY, true);
        say(peer.heard[TOPIC_REPLY], "answered", "unanswered");
    } else if (strcmp(verb, "read") == 0) {
        open_reader(&peer, TOPIC_FRAME);
        run(&peer, PATIENCE_NS, TOPIC_FRAME, true);
        say(peer.heard[TOPIC_FRAME], "heard", "unheard");
    } else {
        die_usage("'%s': capture, command, read or hostile", verb);
    }
    dds_link_close(&peer.link, EXIT_REFUSED);
    return EXIT_OK;
}
