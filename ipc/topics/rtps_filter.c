/* Walks through a datagram's submessages and their parameter lists (RTPS 2.5, 8.3 and 9.4). Where
 * implementations may differ it reads as Cyclone DDS's q_receive.c does. */
#include "ipc/topics/rtps_filter.h"

#include <string.h>

#define HEADER_BYTES      20u
#define SUBMESSAGE_HEADER 4u
#define PREFIX_AT         8u

enum { PAD = 0x01, INFO_TS = 0x09, DATA = 0x15, DATA_FRAG = 0x16 };
enum { FLAG_LITTLE = 0x01, FLAG_INLINE_QOS = 0x02, FLAG_DATA = 0x04, FLAG_KEY = 0x08 };

/* Within DATA and DATA_FRAG. */
#define INLINE_QOS_OFFSET_AT 6u
#define WRITER_AT            12u
#define DATA_BYTES           24u

#define WRITER_PARTICIPANT 0x000100c2u
#define WRITER_TYPE_REPLY  0x000301c3u
#define KIND_MASK          0xffu
#define KIND_DISCOVERY     0xc2u /* built in, of keyed samples: parameter lists */

enum {
    PID_SENTINEL = 0x0001,
    PID_METATRAFFIC_UNICAST_LOCATOR = 0x0032,
    PID_STATUS_INFO = 0x0071,
    PID_TYPE_INFORMATION = 0x0075,
    PID_TYPE_INFORMATION_HIDDEN = 0x8075, /* an unknown vendor's parameter, which is ignored */
};
#define PARAMETER_HEADER 4u
#define LOCATOR_BYTES    24u
#define LOCATOR_UDPV4    1u
#define STATUS_GONE      0x03u /* disposed, unregistered */
#define ENCAPSULATION    4u

/* A part of the datagram, with its byte order. */
struct part {
    uint8_t *at;
    size_t length;
    bool little;
};

static uint32_t number(const struct part *part, size_t at, size_t bytes)
{
    uint32_t value = 0;
    for (size_t i = 0; i < bytes; i++)
        value = value << 8 | part->at[at + (part->little ? bytes - 1 - i : i)];
    return value;
}

static void put_u16(struct part *part, size_t at, uint16_t value)
{
    part->at[at + (part->little ? 0 : 1)] = (uint8_t)(value & 0xff);
    part->at[at + (part->little ? 1 : 0)] = (uint8_t)(value >> 8);
}

static uint32_t writer_of(const struct part *submessage)
{
    const struct part as_sent = {submessage->at, submessage->length, false};
    return number(&as_sent, WRITER_AT, 4);
}

static void note_locator(struct rtps_announcement *announcement, const struct part *value)
{
    uint32_t count = announcement->locator_count;
    if (value->length < LOCATOR_BYTES || number(value, 0, 4) != LOCATOR_UDPV4 ||
        count == RTPS_LOCATORS_MAX)
        return;
    memcpy(&announcement->locator[count].address, value->at + LOCATOR_BYTES - 4, 4);
    announcement->locator[count].port = (uint16_t)number(value, 4, 4);
    announcement->locator_count++;
}

/* Hides type information in a parameter list and returns the list's length. announcement may be
 * NULL. */
static size_t walk_parameters(struct part list, struct rtps_announcement *announcement)
{
    size_t at = 0;
    while (at + PARAMETER_HEADER <= list.length) {
        uint32_t id = number(&list, at, 2);
        struct part value = {list.at + at + PARAMETER_HEADER, number(&list, at + 2, 2),
                             list.little};
        if (id == PID_SENTINEL)
            return at + PARAMETER_HEADER;
        if (id == PID_TYPE_INFORMATION)
            put_u16(&list, at, PID_TYPE_INFORMATION_HIDDEN);
        if (value.length > list.length - at - PARAMETER_HEADER)
            break;
        if (announcement && id == PID_METATRAFFIC_UNICAST_LOCATOR)
            note_locator(announcement, &value);
        if (announcement && id == PID_STATUS_INFO && value.length >= 4)
            announcement->gone |= (value.at[3] & STATUS_GONE) != 0;
        at += PARAMETER_HEADER + value.length;
    }
    return list.length;
}

static struct part rest_of(const struct part *part, size_t at, bool little)
{
    return (struct part){part->at + at, part->length - at, little};
}

/* For DATA and DATA_FRAG. Numbers have the submessage's byte order. */
static void walk_data(const struct part *data, struct rtps_announcement *announcement)
{
    const uint8_t flags = data->at[1];
    const uint32_t writer = writer_of(data);
    size_t at = INLINE_QOS_OFFSET_AT + 2 + number(data, INLINE_QOS_OFFSET_AT, 2);
    bool participant = data->at[0] == DATA && writer == WRITER_PARTICIPANT;
    if (!participant)
        announcement = NULL;
    if (at > data->length)
        return;
    if (flags & FLAG_INLINE_QOS)
        at += walk_parameters(rest_of(data, at, data->little), announcement);
    if (data->at[0] == DATA && flags & (FLAG_DATA | FLAG_KEY) &&
        (writer & KIND_MASK) == KIND_DISCOVERY && at + ENCAPSULATION <= data->length) {
        /* The second byte of the encapsulation tells the byte order: odd is little endian. */
        bool little = data->at[at + 1] & 1;
        (void)walk_parameters(rest_of(data, at + ENCAPSULATION, little), announcement);
    }
    if (participant) {
        announcement->gone |= (flags & FLAG_KEY) != 0;
        announcement->here = !announcement->gone;
    }
}

/* Finds the submessage at this offset and sets bytes to its stated length. Returns false when there
 * is none. */
static bool submessage_at(struct part *submessage, uint8_t *datagram, size_t length, size_t at,
                          size_t *bytes)
{
    if (length - at < SUBMESSAGE_HEADER)
        return false;
    *submessage = (struct part){datagram + at, length - at, (datagram[at + 1] & FLAG_LITTLE) != 0};
    *bytes = SUBMESSAGE_HEADER + number(submessage, 2, 2);
    if (*bytes == SUBMESSAGE_HEADER && submessage->at[0] != PAD && submessage->at[0] != INFO_TS)
        *bytes = submessage->length; /* 0: up to the end */
    return true;
}

static bool is_rtps(const uint8_t *datagram, size_t length)
{
    return length >= HEADER_BYTES && memcmp(datagram, "RTPS", 4) == 0;
}

bool rtps_filter(uint8_t *datagram, size_t length, struct rtps_announcement *announcement)
{
    struct part submessage;
    size_t at = HEADER_BYTES, bytes;
    announcement->here = announcement->gone = false;
    announcement->locator_count = 0;
    if (!is_rtps(datagram, length))
        return true;
    memcpy(announcement->prefix, datagram + PREFIX_AT, RTPS_PREFIX_BYTES);
    while (submessage_at(&submessage, datagram, length, at, &bytes) && bytes <= length - at) {
        submessage.length = bytes;
        at += bytes;
        bool fragment = submessage.at[0] == DATA_FRAG;
        if ((submessage.at[0] != DATA && !fragment) || bytes < DATA_BYTES)
            continue;
        uint32_t writer = writer_of(&submessage);
        if (writer == WRITER_TYPE_REPLY || (fragment && (writer & KIND_MASK) == KIND_DISCOVERY))
            return false;
        walk_data(&submessage, announcement);
    }
    return true;
}

bool rtps_announces(uint8_t *datagram, size_t length)
{
    struct part submessage;
    size_t at = HEADER_BYTES, bytes;
    if (!is_rtps(datagram, length))
        return false;
    while (submessage_at(&submessage, datagram, length, at, &bytes)) {
        if (submessage.at[0] == DATA && submessage.length >= WRITER_AT + 4 &&
            writer_of(&submessage) == WRITER_PARTICIPANT)
            return true;
        if (bytes > submessage.length)
            return false;
        at += bytes;
    }
    return false;
}
