/* What jolon-ctl says of an answer: one line, or one JSON object. */
#ifndef JOLON_CLIENTS_CTL_RESULT_TEXT_H
#define JOLON_CLIENTS_CTL_RESULT_TEXT_H

#include "ipc/topics/command_text.h"

/* An order's place in what was asked for. */
struct result_text_context {
    const char *world;
    uint32_t line;          /* of standard input, 0: the command line */
    uint32_t round, rounds; /* of a fire mission: from 1, of so many */
};

/* It is done, in words, on standard output. */
void result_text_done(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply);

/* The answer as JSON, on standard output; reply NULL: there was none. */
void result_text_json(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply);

/* A refusal, on standard error; more: what would be right, or "". */
void result_text_refusal(const struct command_text *order,
                         const struct result_text_context *context, const jolon_CommandReply *reply,
                         const char *more);

#endif
