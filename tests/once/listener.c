/* listener: a subscriber of all event topics that stores the received events in a file, so that it
 * can be killed at any time and continue. It writes each event once, as a line "TOPIC RUN SEQUENCE
 * FRAME INDEX".
 *
 * It follows the rules for receivers in docs/topics.md: it drops events that are not above the last
 * sequence of their topic in that run, and reports a missing sequence on standard error. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/topics/dds_topics.h"

#include "status.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TOPICS  (TOPIC_CONTACT_END - TOPIC_COLLISION + 1)
#define WAIT_NS ((uint64_t)20000000)

struct listener {
    struct dds_link link;
    dds_entity_t reader[TOPICS], waitset;
    int log;
    struct {
        bool any;
        uint64_t run, sequence;
    } last[TOPICS];
    uint64_t repeated;
};

/* Finds the last sequence of each topic in the file. Cuts off a last line that a kill has torn. */
static void resume(struct listener *listener, const char *path)
{
    struct stat status;
    listener->log = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (listener->log < 0 || fstat(listener->log, &status) != 0)
        die_refused("--log %s: %s", path, strerror(errno));
    char *text = malloc((size_t)status.st_size + 1);
    ssize_t length = text ? pread(listener->log, text, (size_t)status.st_size, 0) : -1;
    if (length < 0)
        die_refused("--log %s: cannot read", path);
    while (length > 0 && text[length - 1] != '\n')
        length--;
    if (ftruncate(listener->log, length) != 0)
        die_refused("--log %s: %s", path, strerror(errno));
    text[length] = '\0';
    for (const char *line = text; *line; line = strchr(line, '\n') + 1) {
        unsigned topic;
        uint64_t run, sequence;
        if (sscanf(line, "%u %" SCNu64 " %" SCNu64, &topic, &run, &sequence) != 3 ||
            topic >= TOPICS)
            die_refused("--log %s: is no log of this program", path);
        listener->last[topic].any = true;
        listener->last[topic].run = run;
        listener->last[topic].sequence = sequence;
    }
    free(text);
}

/* Each line is one write, so a kill leaves the whole line, nothing, or a torn last line. */
static void write_line(const struct listener *listener, unsigned topic,
                       const jolon_EventHeader *header)
{
    char line[160];
    int length = snprintf(line, sizeof line, "%u %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu32 "\n",
                          topic, header->run, header->sequence, header->frame, header->index);
    if (write(listener->log, line, (size_t)length) != length)
        die_refused("the log cannot be written: %s", strerror(errno));
}

static void receive(struct listener *listener, unsigned topic, const jolon_EventHeader *header)
{
    bool same_run = listener->last[topic].any && listener->last[topic].run == header->run;
    if (same_run && header->sequence <= listener->last[topic].sequence) {
        listener->repeated++;
        return;
    }
    if (same_run && header->previous != header->sequence &&
        header->previous != listener->last[topic].sequence)
        log_warn("topic %u: %" PRIu64 " follows %" PRIu64 ", the last one was %" PRIu64, topic,
                 header->sequence, header->previous, listener->last[topic].sequence);
    write_line(listener, topic, header);
    listener->last[topic].any = true;
    listener->last[topic].run = header->run;
    listener->last[topic].sequence = header->sequence;
}

static void receive_all(struct listener *listener)
{
    for (unsigned topic = 0; topic < TOPICS; topic++) {
        void *sample = NULL;
        dds_sample_info_t info;
        while (dds_take(listener->reader[topic], &sample, &info, 1, 1) > 0) {
            if (info.valid_data) /* every event begins with its header */
                receive(listener, topic, sample);
            (void)dds_return_loan(listener->reader[topic], &sample, 1);
            sample = NULL;
        }
    }
}

int main(int argc, char **argv)
{
    static struct listener listener;
    const struct dds_link_options options = {.quiet = true};
    struct error_text error;
    log_open("listener");
    if (argc != 5 || strcmp(argv[1], "--world") != 0 || strcmp(argv[3], "--log") != 0)
        die_usage("usage: listener --world NAME --log FILE");
    process_signals();
    resume(&listener, argv[4]);
    if (dds_link_open(&listener.link, &options, argv[2], &error) != 0)
        die_refused("%s", error.text);
    for (unsigned topic = 0; topic < TOPICS; topic++) {
        listener.reader[topic] =
            dds_topics_reader(&listener.link, (enum dds_topic)(TOPIC_COLLISION + topic), &error);
        if (listener.reader[topic] < 0)
            die_refused("%s", error.text);
    }
    listener.waitset = dds_topics_waitset(&listener.link, listener.reader, TOPICS, &error);
    if (listener.waitset < 0)
        die_refused("%s", error.text);
    while (!process_stopping()) {
        dds_topics_wait(listener.waitset, WAIT_NS);
        receive_all(&listener);
    }
    log_info("%" PRIu64 " repeats dropped", listener.repeated);
    (void)close(listener.log);
    dds_link_close(&listener.link, EXIT_OK);
    return EXIT_OK;
}
