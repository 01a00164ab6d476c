/* Captures: files of recorded packets (pcap and pcapng), as tcpdump, Wireshark and tshark have
 * them. Only UDP is read. Nothing in a file is trusted. */
#ifndef JOLON_GATEWAY_TOOL_CAPTURE_H
#define JOLON_GATEWAY_TOOL_CAPTURE_H

#include "gateway/udp/udp_address.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A datagram of a capture. */
struct capture_datagram {
    struct udp_address from, to;
    uint64_t time_us; /* since 1970, of the capture */
    const uint8_t *bytes;
    size_t size;
};

struct capture_reader; /* of libpcap */
struct capture_writer;

/* Opens a file. Returns NULL with the reason in error. */
struct capture_reader *capture_open(const char *path, struct error_text *error);

/* Reads the next datagram of UDP; other packets are counted in others and stepped over. The bytes
 * are valid until the next call. Returns 1, 0 at the end, or -1 with the reason in error. */
int capture_read(struct capture_reader *reader, struct capture_datagram *datagram, uint64_t *others,
                 struct error_text *error);
void capture_close(struct capture_reader *reader);

/* Creates a file, which must not exist, with packets of Ethernet. Returns NULL with the reason in
 * error. */
struct capture_writer *capture_create(const char *path, struct error_text *error);

/* Adds a datagram; both addresses are of one family. Returns 0, or -1 with errno. */
int capture_write(struct capture_writer *writer, const struct capture_datagram *datagram);

/* Writes what is left. Returns 0, or -1 with errno; the file is closed in any case. */
int capture_finish(struct capture_writer *writer);

#endif
