/* Writes the result of a command as an answer. Pure. */
#ifndef JOLON_CLIENTS_CONSOLE_RESULT_TEXT_H
#define JOLON_CLIENTS_CONSOLE_RESULT_TEXT_H

#include "clients/console/request_body.h"
#include "clients/console/world_reader.h"

/* Writes {"result": "done", "frame", "entity"}, or the error and what to do. */
void result_text_put(struct http_answer *answer, const struct command_text *order,
                     const jolon_CommandReply *reply, const struct world_reader *reader,
                     const struct players *players);

/* Writes that no reply came. heard: the world takes commands. */
void result_text_none(struct http_answer *answer, const struct command_text *order, bool heard);

#endif
