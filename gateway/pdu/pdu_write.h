/* Writes PDUs for the wire. Pure; any thread. */
#ifndef JOLON_GATEWAY_PDU_PDU_WRITE_H
#define JOLON_GATEWAY_PDU_PDU_WRITE_H

#include "gateway/pdu/pdu.h"

#include <stddef.h>

/* The longest PDU that is written: with the headers of UDP and IPv6, a packet of Ethernet. */
#define PDU_WRITE_BYTES_MAX 1400u

/* Writes the PDU into bytes. The family, the length and the count of parts are computed; the status
 * is written for version 7 alone. Returns the number of octets, or 0 if the version is neither 6
 * nor 7, the type is unknown, or the PDU is longer than size. */
size_t pdu_write(const struct pdu *pdu, uint8_t *bytes, size_t size);

#endif
