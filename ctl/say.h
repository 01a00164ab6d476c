/* What jolon-ctl says of an answer: one line, or one JSON object. */
#ifndef JOLON_CTL_SAY_H
#define JOLON_CTL_SAY_H

#include "topics/order.h"

/* An order's place in what was asked for. */
struct say_place {
    const char *world;
    uint32_t line;          /* of standard input, 0: the command line */
    uint32_t round, rounds; /* of a fire mission: from 1, of so many */
};

/* It is done, in words, on standard output. */
void say_done(const struct order *order, const struct say_place *place,
              const jolon_CommandReply *reply);

/* The answer as JSON, on standard output; reply NULL: there was none. */
void say_json(const struct order *order, const struct say_place *place,
              const jolon_CommandReply *reply);

/* A refusal, on standard error; more: what would be right, or "". */
void say_refusal(const struct order *order, const struct say_place *place,
                 const jolon_CommandReply *reply, const char *more);

#endif
