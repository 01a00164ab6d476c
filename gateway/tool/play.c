/* The verb play. */
#include "gateway/tool/play.h"

#include "gateway/pdu/pdu.h"
#include "gateway/tool/capture.h"
#include "gateway/tool/listener.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "world/runtime/parse_number.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static struct {
    const char *to, *interface;
    uint32_t port;
    double speed; /* 0: as fast as possible */
} given = {.to = "127.0.0.1", .port = PDU_PORT, .speed = 1.0};

static int take_speed(const char *value, struct error_text *error)
{
    if (strcmp(value, "max") == 0) {
        given.speed = 0.0;
        return 0;
    }
    return parse_real(value, 0.001, 1e6, &given.speed)
               ? 0
               : error_text_set(error, "must be max or a number from 0.001 to 1000000");
}

/* Waits until a datagram of the capture is due. The first is due at once; a capture whose clock
 * went back is not waited for. */
static void wait_for(uint64_t time_us, uint64_t first_us, uint64_t begun_ns)
{
    if (given.speed == 0.0 || time_us <= first_us)
        return;
    double after_s = (double)(time_us - first_us) / 1e6 / given.speed;
    uint64_t due_ns = begun_ns + (uint64_t)(after_s < 1e9 ? after_s * 1e9 : 1e18);
    while (clock_now_ns() < due_ns && !process_stopping())
        clock_sleep_until_ns(due_ns);
}

/* Sends a datagram. A full buffer of the system is waited for. */
static void send_one(int socket, const struct udp_address *to,
                     const struct capture_datagram *datagram)
{
    while (udp_socket_send(socket, to, datagram->bytes, datagram->size) != 0) {
        if (errno != EAGAIN && errno != ENOBUFS)
            die_refused("--to %s: cannot be sent: %s", given.to, strerror(errno));
        if (process_stopping())
            return;
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
}

int play_run(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"to", "ADDRESS[:PORT]", "where to send (default 127.0.0.1:3000)", .text = &given.to},
        {"interface", "NAME", "the interface by which multicast leaves, or an address that it has",
         .text = &given.interface},
        {"port", "N", "only datagrams that went to this port; 0: to any (default 3000)",
         .u32 = &given.port, .most = 65535},
        {"speed", "F|max", "times the speed of the recording, or without waiting (default 1)",
         .take = take_speed},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-dis play",
        .usage = "[options] FILE\nSends the datagrams of a capture again, as they are.",
        .rows = rows,
        .plain = 1};
    struct udp_address to;
    struct error_text error;
    struct capture_datagram datagram;
    uint64_t sent = 0, others = 0, first_us = 0, begun_ns = 0;
    if (option_table_read(&table, argc, argv) != 1)
        die_usage("dis play: needs a FILE, as in: jolon dis play exercise.pcap");
    if (udp_address_parse(&to, given.to, PDU_PORT, &error) != 0)
        die_usage("--to %s: %s", given.to, error.text);
    unsigned interface = listener_interface(given.interface);
    udp_address_scope(&to, interface);
    struct capture_reader *reader = capture_open(argv[argc - 1], &error);
    int socket = reader ? udp_socket_sender(&to, interface, &error) : -1;
    if (socket < 0)
        die_refused("%s", error.text);
    int result;
    while ((result = capture_read(reader, &datagram, &others, &error)) == 1 &&
           !process_stopping()) {
        if (given.port != 0 && udp_address_port(&datagram.to) != given.port) {
            others++;
            continue;
        }
        if (sent == 0) {
            first_us = datagram.time_us;
            begun_ns = clock_now_ns();
        }
        wait_for(datagram.time_us, first_us, begun_ns);
        send_one(socket, &to, &datagram);
        sent++;
    }
    capture_close(reader);
    fprintf(stderr, "%" PRIu64 " datagrams sent, %" PRIu64 " other packets\n", sent, others);
    if (result < 0)
        die_refused("%s", error.text);
    return EXIT_OK;
}
