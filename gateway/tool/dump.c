/* The verb dump. */
#include "gateway/tool/dump.h"

#include "gateway/earth/geodesy.h"
#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/pdu_read.h"
#include "gateway/pdu/pdu_text.h"
#include "gateway/tool/capture.h"
#include "gateway/tool/listener.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define WAIT_NS (100 * (uint64_t)NS_PER_MS)

static struct {
    const char *listen, *interface, *type;
    bool json, summary;
    uint32_t port;
    uint64_t count;
    double seconds;
} given = {.port = PDU_PORT};

static struct pdu_counts counts;
static uint64_t shown, other_packets;

/* --- one PDU -----------------------------------------------------------------------------------*/

/* Returns the location of a PDU [m, ECEF], NULL when it has none. */
static const double *location_of(const struct pdu *pdu)
{
    const struct pdu_layout *layout = pdu_layout_of(pdu->header.type);
    const struct pdu_field *field = layout ? pdu_layout_field(layout, "location") : NULL;
    return field ? (const double *)(const void *)((const char *)pdu + field->member) : NULL;
}

static void write_place(const double *location, const char *format)
{
    struct geodesy_place place =
        geodesy_place_of((struct vec3){location[0], location[1], location[2]});
    char text[128];
    (void)snprintf(text, sizeof text, "%.8f,%.8f,%.3f", place.latitude_rad * DEG_PER_RAD,
                   place.longitude_rad * DEG_PER_RAD, place.height_m);
    fputs(format, stdout);
    fputs(text, stdout);
}

static void write_json(const struct capture_datagram *datagram, enum pdu_result result,
                       const struct pdu *pdu)
{
    char from[UDP_ADDRESS_TEXT];
    printf("{\"time_s\":%" PRIu64 ".%06u,\"from\":\"%s\",", datagram->time_us / 1000000u,
           (unsigned)(datagram->time_us % 1000000u),
           udp_address_text(&datagram->from, from, sizeof from));
    if (result == PDU_GOOD) {
        const double *location = location_of(pdu);
        pdu_json_write(stdout, pdu);
        if (location) {
            write_place(location, ",\"place\":[");
            fputs("]", stdout);
        }
    } else {
        if (result != PDU_BAD_HEADER) {
            pdu_json_write_header(stdout, &pdu->header);
            fputs(",", stdout);
        }
        printf("\"%s\":\"%s\"", result == PDU_SKIPPED ? "skipped" : "fault",
               pdu_result_text(result));
    }
    fputs("}\n", stdout);
}

static void write_text(const struct capture_datagram *datagram, enum pdu_result result,
                       const struct pdu *pdu)
{
    char from[UDP_ADDRESS_TEXT], clock[32];
    time_t time_s = (time_t)(datagram->time_us / 1000000u);
    struct tm utc;
    if (!gmtime_r(&time_s, &utc) || strftime(clock, sizeof clock, "%H:%M:%S", &utc) == 0)
        strcpy(clock, "?");
    printf("%s.%06u %s ", clock, (unsigned)(datagram->time_us % 1000000u),
           udp_address_text(&datagram->from, from, sizeof from));
    if (result == PDU_GOOD) {
        const double *location = location_of(pdu);
        pdu_text_write(stdout, pdu);
        if (location)
            write_place(location, " place=");
    } else {
        if (result != PDU_BAD_HEADER) {
            pdu_text_write_header(stdout, &pdu->header);
            fputs(" ", stdout);
        }
        printf("(%s%s)",
               result == PDU_SKIPPED ? "skipped: " : "dropped: ", pdu_result_text(result));
    }
    fputs("\n", stdout);
}

/* Counts and shows the PDUs of a datagram. Returns false when enough are shown. */
static bool take_datagram(const struct capture_datagram *datagram)
{
    static struct pdu pdu;
    struct pdu_cursor cursor = {datagram->bytes, datagram->size, 0};
    const struct pdu_layout *wanted = given.type ? pdu_layout_named(given.type) : NULL;
    enum pdu_result result;
    counts.datagrams++;
    counts.octets += datagram->size;
    while ((result = pdu_read(&cursor, &pdu)) != PDU_END) {
        pdu_read_count(&counts, result, &pdu);
        if (wanted && (result != PDU_GOOD || pdu.header.type != wanted->type))
            continue;
        if (!given.summary)
            (given.json ? write_json : write_text)(datagram, result, &pdu);
        if (++shown == given.count)
            return false;
    }
    return true;
}

/* --- where they come from ----------------------------------------------------------------------*/

static int read_capture(const char *path)
{
    struct error_text error;
    struct capture_datagram datagram;
    struct capture_reader *reader = capture_open(path, &error);
    if (!reader)
        die_refused("%s", error.text);
    int result;
    while ((result = capture_read(reader, &datagram, &other_packets, &error)) == 1 &&
           !process_stopping()) {
        if (given.port != 0 && udp_address_port(&datagram.to) != given.port)
            other_packets++;
        else if (!take_datagram(&datagram))
            break;
    }
    capture_close(reader);
    if (result >= 0)
        return EXIT_OK;
    fprintf(stderr, "jolon-dis: %s\n", error.text);
    return EXIT_REFUSED;
}

static void read_network(void)
{
    static uint8_t bytes[UDP_SOCKET_BYTES_MAX];
    struct udp_address at;
    int socket = listener_open(given.listen ? given.listen : "127.0.0.1", given.interface, &at);
    setvbuf(stdout, NULL, _IOLBF, 0);
    uint64_t until_ns =
        given.seconds > 0.0 ? clock_now_ns() + (uint64_t)(given.seconds * 1e9) : UINT64_MAX;
    while (!process_stopping() && clock_now_ns() < until_ns && !ferror(stdout)) {
        struct capture_datagram datagram = {.to = at, .bytes = bytes};
        if (!udp_socket_wait(socket, WAIT_NS))
            continue;
        int size = udp_socket_receive(socket, bytes, sizeof bytes, &datagram.from);
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        datagram.time_us = (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
        datagram.size = size > 0 ? (size_t)size : 0;
        if (size >= 0 && !take_datagram(&datagram))
            break;
    }
}

/* --- the summary -------------------------------------------------------------------------------*/

static void write_json_summary(void)
{
    printf("{\"datagrams\":%" PRIu64 ",\"octets\":%" PRIu64 ",\"other_packets\":%" PRIu64
           ",\"good\":%" PRIu64 ",\"skipped\":%" PRIu64 ",\"types\":{",
           counts.datagrams, counts.octets, other_packets, counts.result[PDU_GOOD],
           counts.result[PDU_SKIPPED]);
    const char *between = "";
    for (unsigned type = 0; type < 256; type++) {
        if (counts.type[type] == 0)
            continue;
        printf("%s\"%u\":%" PRIu64, between, type, counts.type[type]);
        between = ",";
    }
    fputs("},\"faults\":{", stdout);
    between = "";
    for (unsigned result = PDU_BAD_HEADER; result < PDU_RESULTS; result++) {
        if (counts.result[result] == 0)
            continue;
        printf("%s\"%s\":%" PRIu64, between, pdu_result_text((enum pdu_result)result),
               counts.result[result]);
        between = ",";
    }
    fputs("}}\n", stdout);
}

static void write_summary(FILE *file)
{
    fprintf(file, "%" PRIu64 " datagrams, %" PRIu64 " octets, %" PRIu64 " other packets\n",
            counts.datagrams, counts.octets, other_packets);
    for (unsigned type = 0; type < 256; type++) {
        if (counts.type[type] > 0)
            fprintf(file, "%8" PRIu64 " %s%s\n", counts.type[type], pdu_type_name((uint8_t)type),
                    pdu_layout_of((uint8_t)type) ? "" : " (skipped)");
    }
    for (unsigned result = PDU_BAD_HEADER; result < PDU_RESULTS; result++) {
        if (counts.result[result] > 0)
            fprintf(file, "%8" PRIu64 " dropped: %s\n", counts.result[result],
                    pdu_result_text((enum pdu_result)result));
    }
}

static int check_type(const char *value, struct error_text *error)
{
    return pdu_layout_named(value)
               ? 0
               : error_text_set(error, "is no type; there are entity-state, fire, detonation, "
                                       "collision, collision-elastic, create-entity, "
                                       "remove-entity, start-resume, stop-freeze, acknowledge");
}

static void check_output(void)
{
    if (fflush(stdout) != 0 || ferror(stdout))
        die_refused("standard output: cannot be written");
}

int dump_run(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"listen", "ADDRESS[:PORT]", "without FILE: where PDUs come (default 127.0.0.1:3000)",
         .text = &given.listen},
        {"interface", "NAME", "the interface by which a group is joined, or an address that it has",
         .text = &given.interface},
        {"port", "N", "with FILE: only datagrams to this port; 0: to any (default 3000)",
         .u32 = &given.port, .most = 65535},
        {"type", "NAME", "only PDUs of this type, such as entity-state", .text = &given.type,
         .take = check_type},
        {"count", "N", "end after N PDUs", .u64 = &given.count, .least = 1, .most = INT64_MAX},
        {"seconds", "S", "without FILE: end after S seconds", .real = &given.seconds, .low = 0.001,
         .high = 1e6},
        {"summary", NULL, "only how many of each type there are, on standard output",
         .flag = &given.summary},
        {"json", NULL, "a JSON object a line", .flag = &given.json},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-dis dump",
        .usage = "[options] [FILE]\nShows the PDUs of a capture, or those that come until Ctrl-C.",
        .ending = "What was dropped or skipped is counted on standard error at the end.",
        .rows = rows,
        .plain = 1};
    int plain = option_table_read(&table, argc, argv), code = EXIT_OK;
    if (plain == 1 && (given.listen || given.seconds > 0.0 || given.interface))
        die_usage(
            "dis dump: --listen, --interface and --seconds are for what comes by the network; "
            "%s is a file",
            argv[argc - 1]);
    if (plain == 1)
        code = read_capture(argv[argc - 1]);
    else
        read_network();
    check_output();
    if (given.json && given.summary)
        write_json_summary();
    else
        write_summary(given.summary ? stdout : stderr);
    check_output();
    return code;
}
