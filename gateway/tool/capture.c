/* Captures, by libpcap. The packets' own headers are read here. */
#include "gateway/tool/capture.h"

#include "gateway/pdu/octets.h"

#include <errno.h>
#include <fcntl.h>
#include <pcap/pcap.h>
#include <stdlib.h>
#include <unistd.h>

#define ETHERNET_BYTES 14u
#define IPV4_BYTES     20u
#define IPV6_BYTES     40u
#define UDP_BYTES      8u
#define SNAP_BYTES     262144
#define TYPE_IPV4      0x0800u
#define TYPE_IPV6      0x86ddu
#define TYPE_VLAN      0x8100u
#define UDP_NUMBER     17u
#define TTL            64u

struct capture_reader {
    pcap_t *pcap;
    char path[256];
};

struct capture_writer {
    pcap_t *pcap;
    pcap_dumper_t *dumper;
    uint8_t packet[ETHERNET_BYTES + IPV6_BYTES + UDP_BYTES + UINT16_MAX];
};

/* --- reading -----------------------------------------------------------------------------------*/

struct capture_reader *capture_open(const char *path, struct error_text *error)
{
    char reason[PCAP_ERRBUF_SIZE] = "";
    struct capture_reader *reader = calloc(1, sizeof *reader);
    if (!reader) {
        error_text_set(error, "%s: no memory", path);
        return NULL;
    }
    snprintf(reader->path, sizeof reader->path, "%s", path);
    reader->pcap = pcap_open_offline(path, reason);
    if (!reader->pcap) {
        error_text_set(error, "%s: is no capture that can be read: %s", path, reason);
        free(reader);
        return NULL;
    }
    return reader;
}

/* A part of a packet that is still to be read. */
struct rest {
    const uint8_t *at;
    size_t size;
};

static bool step(struct rest *rest, size_t bytes)
{
    if (bytes > rest->size)
        return false;
    rest->at += bytes;
    rest->size -= bytes;
    return true;
}

/* Steps over the header of the link. Returns the type of Ethernet of what follows, 0 when it is
 * unknown. */
static unsigned link_type(int link, struct rest *rest)
{
    unsigned type = 0;
    switch (link) {
    case DLT_EN10MB:
        if (!step(rest, ETHERNET_BYTES))
            return 0;
        type = octets_u16(rest->at - 2);
        while (type == TYPE_VLAN && step(rest, 4))
            type = octets_u16(rest->at - 2);
        return type;
    case DLT_LINUX_SLL:
        return step(rest, 16) ? octets_u16(rest->at - 2) : 0;
    case DLT_LINUX_SLL2:
        return step(rest, 20) ? octets_u16(rest->at - 20) : 0;
    case DLT_NULL:
    case DLT_LOOP:
        if (!step(rest, 4))
            return 0;
        break;
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
        break;
    default:
        return 0;
    }
    if (rest->size > 0)
        type = rest->at[0] >> 4 == 4 ? TYPE_IPV4 : rest->at[0] >> 4 == 6 ? TYPE_IPV6 : 0;
    return type;
}

/* Step over the header of IP and write its addresses. Return false if no UDP follows: also for
 * fragments, which no PDU needs. */
static bool read_ipv4(struct rest *rest, struct capture_datagram *datagram)
{
    if (rest->size < IPV4_BYTES || rest->at[0] >> 4 != 4)
        return false;
    size_t header = (size_t)(rest->at[0] & 15) * 4, total = octets_u16(rest->at + 2);
    if (header < IPV4_BYTES || header > rest->size || (octets_u16(rest->at + 6) & 0x3fff) != 0 ||
        rest->at[9] != UDP_NUMBER)
        return false;
    if (total >= header && total < rest->size) /* padding of Ethernet */
        rest->size = total;
    datagram->from.v4.sin_family = datagram->to.v4.sin_family = AF_INET;
    memcpy(&datagram->from.v4.sin_addr, rest->at + 12, 4);
    memcpy(&datagram->to.v4.sin_addr, rest->at + 16, 4);
    return step(rest, header);
}

static bool read_ipv6(struct rest *rest, struct capture_datagram *datagram)
{
    if (rest->size < IPV6_BYTES || rest->at[0] >> 4 != 6 || rest->at[6] != UDP_NUMBER)
        return false;
    datagram->from.v6.sin6_family = datagram->to.v6.sin6_family = AF_INET6;
    memcpy(&datagram->from.v6.sin6_addr, rest->at + 8, 16);
    memcpy(&datagram->to.v6.sin6_addr, rest->at + 24, 16);
    return step(rest, IPV6_BYTES);
}

static bool read_packet(int link, struct rest rest, struct capture_datagram *datagram)
{
    memset(datagram, 0, sizeof *datagram);
    unsigned type = link_type(link, &rest);
    bool udp = type == TYPE_IPV4   ? read_ipv4(&rest, datagram)
               : type == TYPE_IPV6 ? read_ipv6(&rest, datagram)
                                   : false;
    if (!udp || !step(&rest, UDP_BYTES))
        return false;
    const uint8_t *header = rest.at - UDP_BYTES;
    size_t length = octets_u16(header + 4);
    if (length < UDP_BYTES)
        return false;
    if (length - UDP_BYTES < rest.size)
        rest.size = length - UDP_BYTES;
    /* The port is at the same place in both kinds of address. */
    memcpy(&datagram->from.v4.sin_port, header, 2);
    memcpy(&datagram->to.v4.sin_port, header + 2, 2);
    datagram->bytes = rest.at;
    datagram->size = rest.size;
    return true;
}

int capture_read(struct capture_reader *reader, struct capture_datagram *datagram, uint64_t *others,
                 struct error_text *error)
{
    for (;;) {
        struct pcap_pkthdr *packet;
        const uint8_t *bytes;
        int result = pcap_next_ex(reader->pcap, &packet, &bytes);
        if (result == PCAP_ERROR_BREAK)
            return 0;
        if (result != 1)
            return error_text_set(error, "%s: cannot be read further: %s", reader->path,
                                  pcap_geterr(reader->pcap));
        if (read_packet(pcap_datalink(reader->pcap), (struct rest){bytes, packet->caplen},
                        datagram)) {
            datagram->time_us =
                (uint64_t)packet->ts.tv_sec * 1000000u + (uint64_t)packet->ts.tv_usec;
            return 1;
        }
        (*others)++;
    }
}

void capture_close(struct capture_reader *reader)
{
    pcap_close(reader->pcap);
    free(reader);
}

/* --- writing -----------------------------------------------------------------------------------*/

struct capture_writer *capture_create(const char *path, struct error_text *error)
{
    struct capture_writer *writer = calloc(1, sizeof *writer);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    FILE *stream = file >= 0 ? fdopen(file, "wb") : NULL;
    if (!writer || !stream) {
        error_text_set(error, "%s: cannot be made: %s", path, strerror(errno));
        goto err_file;
    }
    writer->pcap = pcap_open_dead(DLT_EN10MB, SNAP_BYTES);
    writer->dumper = writer->pcap ? pcap_dump_fopen(writer->pcap, stream) : NULL;
    if (!writer->dumper) {
        error_text_set(error, "%s: cannot be written: %s", path,
                       writer->pcap ? pcap_geterr(writer->pcap) : "no memory");
        goto err_pcap;
    }
    return writer;
err_pcap:
    if (writer->pcap)
        pcap_close(writer->pcap);
err_file:
    if (stream)
        fclose(stream);
    else if (file >= 0)
        close(file);
    free(writer);
    return NULL;
}

/* The sum of the Internet checksum: 16 bits a step, without the carries. */
static uint32_t sum(uint32_t sum, const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i + 1 < size; i += 2)
        sum += octets_u16(bytes + i);
    return size % 2 == 1 ? sum + ((uint32_t)bytes[size - 1] << 8) : sum;
}

static uint16_t checksum(uint32_t sum)
{
    while (sum >> 16 != 0)
        sum = (sum & 0xffff) + (sum >> 16);
    return (uint16_t)~sum;
}

/* Writes the headers of Ethernet and IP. Returns where UDP begins. The addresses of Ethernet are
 * zero, as on loopback. */
static uint8_t *put_headers(uint8_t *packet, const struct capture_datagram *datagram)
{
    uint16_t udp = (uint16_t)(UDP_BYTES + datagram->size);
    bool v6 = datagram->to.any.sa_family == AF_INET6;
    uint8_t *ip = packet + ETHERNET_BYTES;
    memset(packet, 0, ETHERNET_BYTES + IPV6_BYTES);
    octets_put_u16(packet + 12, v6 ? TYPE_IPV6 : TYPE_IPV4);
    if (v6) {
        ip[0] = 0x60;
        octets_put_u16(ip + 4, udp);
        ip[6] = UDP_NUMBER;
        ip[7] = TTL;
        memcpy(ip + 8, &datagram->from.v6.sin6_addr, 16);
        memcpy(ip + 24, &datagram->to.v6.sin6_addr, 16);
        return ip + IPV6_BYTES;
    }
    ip[0] = 0x45;
    octets_put_u16(ip + 2, (uint16_t)(IPV4_BYTES + udp));
    ip[8] = TTL;
    ip[9] = UDP_NUMBER;
    memcpy(ip + 12, &datagram->from.v4.sin_addr, 4);
    memcpy(ip + 16, &datagram->to.v4.sin_addr, 4);
    octets_put_u16(ip + 10, checksum(sum(0, ip, IPV4_BYTES)));
    return ip + IPV4_BYTES;
}

int capture_write(struct capture_writer *writer, const struct capture_datagram *datagram)
{
    bool v6 = datagram->to.any.sa_family == AF_INET6;
    if (datagram->size > UINT16_MAX - IPV4_BYTES - UDP_BYTES ||
        datagram->from.any.sa_family != datagram->to.any.sa_family) {
        errno = EINVAL;
        return -1;
    }
    uint8_t *udp = put_headers(writer->packet, datagram);
    size_t length = UDP_BYTES + datagram->size, addresses = v6 ? 32 : 8;
    octets_put_u16(udp, udp_address_port(&datagram->from));
    octets_put_u16(udp + 2, udp_address_port(&datagram->to));
    octets_put_u16(udp + 4, (uint16_t)length);
    octets_put_u16(udp + 6, 0);
    memcpy(udp + UDP_BYTES, datagram->bytes, datagram->size);
    uint32_t total = sum(UDP_NUMBER + (uint32_t)length, udp - addresses, addresses + length);
    uint16_t check = checksum(total);
    octets_put_u16(udp + 6, check != 0 ? check : 0xffff);
    size_t size = (size_t)(udp - writer->packet) + length;
    struct pcap_pkthdr packet = {.caplen = (uint32_t)size, .len = (uint32_t)size};
    packet.ts.tv_sec = (time_t)(datagram->time_us / 1000000u);
    packet.ts.tv_usec = (suseconds_t)(datagram->time_us % 1000000u);
    pcap_dump((u_char *)writer->dumper, &packet, writer->packet);
    return ferror(pcap_dump_file(writer->dumper)) ? -1 : 0;
}

int capture_finish(struct capture_writer *writer)
{
    int result = pcap_dump_flush(writer->dumper);
    pcap_dump_close(writer->dumper);
    pcap_close(writer->pcap);
    free(writer);
    return result;
}
