/* Prints the result of a command as a line or as a JSON object. */
#ifndef JOLON_CLIENTS_CTL_RESULT_TEXT_H
#define JOLON_CLIENTS_CTL_RESULT_TEXT_H

#include "ipc/topics/command_text.h"

/* The command's place in the input. */
struct result_text_context {
    const char *world;
    uint32_t line;          /* of standard input, 0: the command line */
    uint32_t round, rounds; /* of a fire mission: the round from 1, their number */
};

/* Prints on standard output what was done. */
void result_text_done(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply);

/* Prints the result as JSON on standard output. reply NULL: no reply came. */
void result_text_json(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply);

/* Prints a refusal on standard error. more: what would be right, or "". */
void result_text_refusal(const struct command_text *order,
                         const struct result_text_context *context, const jolon_CommandReply *reply,
                         const char *more);

#endif
