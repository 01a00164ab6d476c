/* What became of an order, in words. Pure. */
#ifndef JOLON_CONSOLE_REPLY_H
#define JOLON_CONSOLE_REPLY_H

#include "console/body.h"
#include "console/watch.h"

/* Writes {"result": "done", "frame", "entity"}, or why not and what to do. */
void reply_put(struct answer *answer, const struct order *order, const jolon_CommandReply *reply,
               const struct watch *watch, const struct players *players);

/* No reply came. */
void reply_none(struct answer *answer, const struct order *order, bool heard);

#endif
