/* A line of the program's: an order, or what it wants to be told. What is wrong with one is told by
 * its number and ends nothing. */
#ifndef JOLON_CLIENTS_HARNESS_JSON_LINE_H
#define JOLON_CLIENTS_HARNESS_JSON_LINE_H

#include "clients/harness/session.h"

/* Carries out a line of so many bytes, terminated. The desk must have room. */
void json_line_execute(struct session *session, const char *line, size_t bytes);

/* The last line was longer than lines may be. */
void json_line_refuse_length(struct session *session);

/* Tells what is wrong with the last line; id: the program's own, as JSON, or NULL. */
void json_line_error(struct session *session, const char *id, const char *text);

#endif
