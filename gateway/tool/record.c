/* The verb record. */
#include "gateway/tool/record.h"

#include "gateway/pdu/pdu.h"
#include "gateway/tool/capture.h"
#include "gateway/tool/listener.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define WAIT_NS (100 * (uint64_t)NS_PER_MS)

static struct {
    const char *listen, *interface;
    uint64_t count;
    double seconds;
} given = {.listen = "127.0.0.1"};

/* Writes what comes until the end. Returns the number of datagrams; good becomes false when the
 * file cannot be written. */
static uint64_t record_all(struct capture_writer *writer, int socket, const struct udp_address *at,
                           bool *good)
{
    static uint8_t bytes[UDP_SOCKET_BYTES_MAX];
    uint64_t recorded = 0;
    uint64_t until_ns =
        given.seconds > 0.0 ? clock_now_ns() + (uint64_t)(given.seconds * 1e9) : UINT64_MAX;
    while (*good && !process_stopping() && clock_now_ns() < until_ns &&
           (given.count == 0 || recorded < given.count)) {
        struct capture_datagram datagram = {.to = *at, .bytes = bytes};
        struct timespec now;
        if (!udp_socket_wait(socket, WAIT_NS))
            continue;
        int size = udp_socket_receive(socket, bytes, sizeof bytes, &datagram.from);
        if (size < 0)
            continue;
        clock_gettime(CLOCK_REALTIME, &now);
        datagram.size = (size_t)size;
        datagram.time_us = (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
        *good = capture_write(writer, &datagram) == 0;
        recorded += *good;
    }
    return recorded;
}

int record_run(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"listen", "ADDRESS[:PORT]", "where datagrams come (default 127.0.0.1:3000)",
         .text = &given.listen},
        {"interface", "NAME", "the interface by which a group is joined, or an address that it has",
         .text = &given.interface},
        {"count", "N", "end after N datagrams", .u64 = &given.count, .least = 1, .most = INT64_MAX},
        {"seconds", "S", "end after S seconds", .real = &given.seconds, .low = 0.001, .high = 1e6},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-dis record",
        .usage = "[options] FILE\nWrites the datagrams that come until Ctrl-C into a new capture.",
        .rows = rows,
        .plain = 1};
    struct udp_address at;
    struct error_text error;
    if (option_table_read(&table, argc, argv) != 1)
        die_usage("dis record: needs a FILE, as in: jolon dis record exercise.pcap");
    int socket = listener_open(given.listen, given.interface, &at);
    const char *path = argv[argc - 1];
    struct capture_writer *writer = capture_create(path, &error);
    if (!writer)
        die_refused("%s", error.text);
    bool good = true;
    uint64_t recorded = record_all(writer, socket, &at, &good);
    int cause = errno;
    if (capture_finish(writer) != 0) {
        cause = errno;
        good = false;
    }
    if (!good)
        die_refused("%s: cannot be written: %s", path, strerror(cause));
    fprintf(stderr, "%" PRIu64 " datagrams in %s\n", recorded, path);
    return EXIT_OK;
}
