/* PDUs as text for people and as JSON for programs. */
#ifndef JOLON_GATEWAY_PDU_PDU_TEXT_H
#define JOLON_GATEWAY_PDU_PDU_TEXT_H

#include "gateway/pdu/pdu.h"

#include <stdio.h>

/* Return the name of a type ("entity-state", or "type 20" of one that has no name here), and that
 * of a force ("friendly"). The text of a type may be that of the last call. */
const char *pdu_type_name(uint8_t type);
const char *pdu_force_name(uint8_t force);

/* Writes the header and each field as NAME=VALUE, in one line without its end. */
void pdu_text_write(FILE *file, const struct pdu *pdu);

/* Writes the same as members of a JSON object, without its braces:
 * "pdu":"entity-state","version":7, and so on. Numbers are written so that reading them gives the
 * same bits. */
void pdu_json_write(FILE *file, const struct pdu *pdu);

/* Write the header alone, for a PDU whose body was not read. */
void pdu_text_write_header(FILE *file, const struct pdu_header *header);
void pdu_json_write_header(FILE *file, const struct pdu_header *header);

#endif
