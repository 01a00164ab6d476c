/* The program's lines: commands and subscriptions. An error in a line is reported with the line's
 * number, and the session continues. */
#ifndef JOLON_CLIENTS_HARNESS_JSON_LINE_H
#define JOLON_CLIENTS_HARNESS_JSON_LINE_H

#include "clients/harness/session.h"

/* Executes a NUL-terminated line of `bytes` bytes. The command queue must have room. */
void json_line_execute(struct session *session, const char *line, size_t bytes);

/* Reports that the last line was too long. */
void json_line_refuse_length(struct session *session);

/* Reports an error in the last line. id: the program's id as JSON, or NULL. */
void json_line_error(struct session *session, const char *id, const char *text);

#endif
