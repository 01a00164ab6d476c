/* A filter of RTPS datagrams before Cyclone DDS, which also reads participants' announcements.
 *
 * Any process that can reach its ports can send anything, and Cyclone DDS 0.10.2 aborts at some
 * type information (PID 0x0075). Jolon's topics match by name, so type information is hidden, and
 * submessages that could carry it past this filter are refused
 * (docs/decisions/023-datagrams-filtered.md). */
#ifndef JOLON_IPC_TOPICS_RTPS_FILTER_H
#define JOLON_IPC_TOPICS_RTPS_FILTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define RTPS_PREFIX_BYTES 12
#define RTPS_LOCATORS_MAX 4

/* A participant's announcement of itself (SPDP). */
struct rtps_announcement {
    bool here, gone; /* it announces itself, or leaves; both false: no announcement */
    uint8_t prefix[RTPS_PREFIX_BYTES];
    /* The IPv4 addresses for announcements to it; none: the datagram's source. */
    uint32_t locator_count;
    struct rtps_locator {
        uint32_t address; /* in network byte order */
        uint16_t port;
    } locator[RTPS_LOCATORS_MAX];
};

/* Hides type information in the datagram, and reads an announcement that is not encrypted. Returns
 * false when the datagram must be dropped: discovery in fragments, and replies to requests for
 * types, which are never sent. A datagram that is not RTPS, or is cut short, passes unchanged. */
bool rtps_filter(uint8_t *datagram, size_t length, struct rtps_announcement *announcement);

/* Returns true if the datagram is an announcement of a participant. The first bytes are enough. */
bool rtps_announces(uint8_t *datagram, size_t length);

#endif
