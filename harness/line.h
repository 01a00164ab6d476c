/* A line of the program's: an order, or what it wants to be told. What is wrong with one is told by
 * its number and ends nothing. */
#ifndef JOLON_HARNESS_LINE_H
#define JOLON_HARNESS_LINE_H

#include "harness/session.h"

/* Carries out a line of so many bytes, terminated. The desk must have room. */
void line_obey(struct session *session, const char *line, size_t bytes);

/* The last line was longer than lines may be. */
void line_refuse_length(struct session *session);

/* Tells what is wrong with the last line; id: the program's own, as JSON, or NULL. */
void line_complain(struct session *session, const char *id, const char *text);

#endif
