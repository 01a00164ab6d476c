/* The verb send. */
#include "gateway/tool/send.h"

#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/pdu_write.h"
#include "gateway/pdu/timestamp.h"
#include "gateway/tool/capture.h"
#include "gateway/tool/field_words.h"
#include "gateway/tool/listener.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define WORDS_MAX 64

static struct {
    const char *to, *interface, *file;
    bool fields;
    uint32_t version, exercise, status;
    uint64_t count;
    double every_s, timestamp_s;
} given = {.to = "127.0.0.1",
           .version = 7,
           .exercise = 1,
           .count = 1,
           .every_s = 1.0,
           .timestamp_s = -1.0};

static uint64_t now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static const struct option_row rows[] = {
    {"to", "ADDRESS[:PORT]", "where to send (default 127.0.0.1:3000)", .text = &given.to},
    {"interface", "NAME", "the interface by which multicast leaves, or an address that it has",
     .text = &given.interface},
    {"file", "FILE", "write a capture instead of sending", .text = &given.file},
    {"version", "N", "6 or 7 (default 7)", .u32 = &given.version, .least = 6, .most = 7},
    {"exercise", "N", "the exercise (default 1)", .u32 = &given.exercise, .least = 1, .most = 255},
    {"status", "N", "the PDU status of version 7 (default 0)", .u32 = &given.status, .most = 255},
    {"timestamp", "S", "seconds past the hour, as a relative time stamp (default: UTC)",
     .real = &given.timestamp_s, .low = 0.0, .high = 3599.99},
    {"count", "N", "send it N times (default 1)", .u64 = &given.count, .least = 1,
     .most = INT64_MAX},
    {"every", "S", "with --count: seconds from one to the next (default 1)", .real = &given.every_s,
     .low = 0.0, .high = 3600.0},
    {"fields", NULL, "list the fields of the type, and send nothing", .flag = &given.fields},
    OPTION_ROWS_END};

static const struct option_table table = {
    .program = "jolon-dis send",
    .usage =
        "[options] TYPE [FIELD=VALUE ...]\n"
        "Sends one PDU, or with --count the same several times. Fields that are not named are\n"
        "0; those of a type are listed by: jolon dis send --fields TYPE. As in:\n"
        "  jolon dis send entity-state id=1:1:7 type=1.1.225.1.1.2.0 force=1 \\\n"
        "    place=35.95,-121.25,300 attitude=90,0,0 marking=TANK\n"
        "  jolon dis send stop-freeze originator=7:1:0 receiver=1991:1:0 request=1\n"
        "An id is SITE:APPLICATION:ENTITY, a type of an entity has seven numbers, a vector has\n"
        "commas, place is latitude, longitude [deg] and height above the ellipsoid [m], and\n"
        "attitude is heading, pitch and roll [deg]. Each run sends from another port: a gateway\n"
        "takes one with the same id that comes within 6 s for another simulator.",
    .ending = "The types are entity-state, fire, detonation, collision, collision-elastic,\n"
              "create-entity, remove-entity, start-resume, stop-freeze, acknowledge.",
    .rows = rows,
    .plain = WORDS_MAX};

/* Writes the PDU with the time stamp of now. Returns its size. */
static size_t compose(struct pdu *pdu, uint8_t bytes[PDU_BYTES_MAX])
{
    pdu->header.timestamp = given.timestamp_s >= 0.0
                                ? timestamp_of(given.timestamp_s, false)
                                : timestamp_of((double)(now_us() % 3600000000u) / 1e6, true);
    return pdu_write(pdu, bytes, PDU_BYTES_MAX);
}

static void write_capture(struct pdu *pdu, const struct udp_address *to)
{
    static uint8_t bytes[PDU_BYTES_MAX];
    struct error_text error;
    struct capture_writer *writer = capture_create(given.file, &error);
    if (!writer)
        die_refused("%s", error.text);
    struct capture_datagram datagram = {
        .from = *to, .to = *to, .bytes = bytes, .time_us = now_us()};
    bool good = true;
    for (uint64_t i = 0; i < given.count && good; i++) {
        datagram.size = compose(pdu, bytes);
        good = capture_write(writer, &datagram) == 0;
        datagram.time_us += (uint64_t)(given.every_s * 1e6);
    }
    if (capture_finish(writer) != 0 || !good)
        die_refused("%s: cannot be written: %s", given.file, strerror(errno));
}

static void send_all(struct pdu *pdu, const struct udp_address *to, unsigned interface)
{
    static uint8_t bytes[PDU_BYTES_MAX];
    struct error_text error;
    int socket = udp_socket_sender(to, interface, &error);
    if (socket < 0)
        die_refused("%s", error.text);
    uint64_t due_ns = clock_now_ns();
    for (uint64_t i = 0; i < given.count && !process_stopping(); i++) {
        while (i > 0 && clock_now_ns() < due_ns && !process_stopping())
            clock_sleep_until_ns(due_ns);
        size_t size = compose(pdu, bytes);
        if (udp_socket_send(socket, to, bytes, size) != 0)
            die_refused("--to %s: cannot be sent: %s", given.to, strerror(errno));
        due_ns += (uint64_t)(given.every_s * 1e9);
    }
}

int send_run(int argc, char **argv)
{
    static struct pdu pdu;
    struct udp_address to;
    struct error_text error;
    int plain = option_table_read(&table, argc, argv);
    char **word = argv + argc - plain;
    if (plain == 0)
        die_usage("dis send: needs a TYPE, as in: jolon dis send entity-state id=1:1:1 "
                  "place=35.95,-121.25,300");
    const struct pdu_layout *layout = pdu_layout_named(word[0]);
    if (!layout)
        die_usage("%s: is no type; jolon dis send --help lists the types", word[0]);
    if (given.fields) {
        field_words_list(stdout, layout->type);
        return EXIT_OK;
    }
    if (udp_address_parse(&to, given.to, PDU_PORT, &error) != 0)
        die_usage("--to %s: %s", given.to, error.text);
    unsigned interface = listener_interface(given.interface);
    udp_address_scope(&to, interface);
    pdu.header = (struct pdu_header){.version = (uint8_t)given.version,
                                     .exercise = (uint8_t)given.exercise,
                                     .type = layout->type,
                                     .status = (uint8_t)given.status};
    if (layout->type == PDU_ENTITY_STATE) {
        pdu.entity_state.character_set = 1;
        pdu.entity_state.dead_reckoning = 1;
    }
    for (int i = 1; i < plain; i++) {
        if (field_words_set(&pdu, word[i], &error) != 0)
            die_usage("%s", error.text);
        for (int before = 1; before < i; before++)
            if (strncmp(word[i], word[before], strcspn(word[i], "=") + 1) == 0)
                die_usage("%s: the field has a value before: %s", word[i], word[before]);
    }
    if (given.file)
        write_capture(&pdu, &to);
    else
        send_all(&pdu, &to, interface);
    return EXIT_OK;
}
