/* What of an RTPS datagram reaches Cyclone DDS, and what it says of participants.
 *
 * Anybody who can send to its ports can send anything, and Cyclone DDS 0.10.2 aborts at some type
 * information (PID 0x0075). Jolon's topics match by name; so type information is hidden, and what
 * could carry it past this filter is refused (docs/decisions/023-datagrams-filtered.md). Pure. */
#ifndef JOLON_IPC_TOPICS_RTPS_FILTER_H
#define JOLON_IPC_TOPICS_RTPS_FILTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define RTPS_PREFIX_BYTES 12
#define RTPS_LOCATORS_MAX 4

/* What a participant says of itself in a datagram (SPDP). */
struct rtps_announcement {
    bool here, gone; /* it announces itself, or takes its leave; both false: nothing of the kind */
    uint8_t prefix[RTPS_PREFIX_BYTES];
    /* Where announcements to it go, of IPv4; none: where the datagram came from. */
    uint32_t locator_count;
    struct rtps_locator {
        uint32_t address; /* in the order of the network */
        uint16_t port;
    } locator[RTPS_LOCATORS_MAX];
};

/* Hides type information within the datagram, and reads an announcement of discovery without
 * security. False when the datagram is to be dropped: discovery in fragments, and answers to
 * questions for types, which are never asked. What is no RTPS, or is cut short, is left to Cyclone
 * DDS: what this passes is no better formed than before. */
bool rtps_filter(uint8_t *datagram, size_t length, struct rtps_announcement *announcement);

/* Is it an announcement of a participant? Of a longer datagram the first bytes will do. */
bool rtps_announces(uint8_t *datagram, size_t length);

#endif
