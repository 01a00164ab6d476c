/* Which contacts and bodies form the islands of one moment. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESPONSE_ISLAND_GATHER_H
#define JOLON_COLLIDER_RESPONSE_ISLAND_GATHER_H

#include "collider/response/island.h"

/* Takes this contact, which was just taken from the queue, all others of the same moment, and the
 * contacts that last behind them. Chains the contacts of each group from its root. */
void island_gather(struct response_context *context, const struct contact *contact);

#endif
