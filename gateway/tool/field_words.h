/* Fields of PDUs from words NAME=VALUE of a command line. */
#ifndef JOLON_GATEWAY_TOOL_FIELD_WORDS_H
#define JOLON_GATEWAY_TOOL_FIELD_WORDS_H

#include "gateway/pdu/pdu.h"
#include "world/runtime/error_text.h"

#include <stdio.h>

/* Sets a field of a PDU whose header has its type. Beside the fields of the type (pdu_layout.h)
 * there are, where the type has a location: place=LATITUDE,LONGITUDE,HEIGHT (degrees, metres above
 * the ellipsoid), and for an Entity State: attitude=HEADING,PITCH,ROLL (degrees, at the location,
 * which must be set before), turret=DEGREES and gun=DEGREES (articulated parts). Returns 0, or -1
 * with the reason in error. */
int field_words_set(struct pdu *pdu, const char *word, struct error_text *error);

/* Writes the fields of a type with the form of their values, one a line. */
void field_words_list(FILE *file, uint8_t type);

#endif
