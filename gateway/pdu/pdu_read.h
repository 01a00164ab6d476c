/* Reads the PDUs of a datagram. Nothing in the datagram is trusted: each length, count, version,
 * type and number is checked before it is used. Pure; any thread. */
#ifndef JOLON_GATEWAY_PDU_PDU_READ_H
#define JOLON_GATEWAY_PDU_PDU_READ_H

#include "gateway/pdu/pdu.h"

#include <stddef.h>

enum pdu_result {
    PDU_GOOD,
    PDU_END,     /* no further PDU; a length of 0 after another PDU ends a datagram too */
    PDU_SKIPPED, /* good, but of a type that Jolon does not know; the header alone is read */
    /* Faults of the datagram: the rest of it is dropped, because no length says where to go on. */
    PDU_BAD_HEADER, /* fewer than 12 octets are left */
    PDU_BAD_LENGTH, /* the length is below 12, or beyond the end of the datagram */
    /* Faults of a PDU, which alone is dropped. */
    PDU_BAD_VERSION, /* not 5 to 7 */
    PDU_BAD_FAMILY,  /* the family is not that of the type */
    PDU_TOO_SHORT,   /* the length has no room for the fields, or for the variable parameters */
    PDU_NOT_FINITE,  /* a number is infinite or not a number, or larger than 1e30 */
    PDU_BAD_ID,      /* an Entity State of a reserved number: 0, FFFF, entity FFFE */
    PDU_RESULTS
};

/* Returns what people are told of a result, such as "a length beyond the datagram". */
const char *pdu_result_text(enum pdu_result result);

struct pdu_cursor {
    const uint8_t *bytes;
    size_t size, at; /* at: where the next PDU begins */
};

/* Reads the next PDU of a datagram and moves the cursor behind it. After PDU_GOOD the whole pdu is
 * set. After another result the header is set if 12 octets were left, and the rest is undefined. A
 * cursor at the start has at = 0. Each call but the last moves the cursor by 12 octets at least. */
enum pdu_result pdu_read(struct pdu_cursor *cursor, struct pdu *pdu);

/* What was read, by result and by type. */
struct pdu_counts {
    uint64_t datagrams, octets;
    uint64_t result[PDU_RESULTS];
    uint64_t type[256]; /* PDUs whose version was right, by their type */
};

/* Adds one result of pdu_read(). */
void pdu_read_count(struct pdu_counts *counts, enum pdu_result result, const struct pdu *pdu);

#endif
