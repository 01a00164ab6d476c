/* A body of another simulator that strikes a vehicle of ours, as its owner tells by a Collision
 * (REMOTE_STRUCK of world/entity/remote.h without a munition).
 *
 * Our collider has most such contacts itself, and the gateway tells of the others alone. The
 * vehicle gets the impulse through its middle that the two masses exchange when they meet with the
 * speed at which they approach each other there. Bodies that part already exchange none, so a
 * collision that is told late does not count twice. */
#ifndef JOLON_MOVER_REMOTE_IMPACT_H
#define JOLON_MOVER_REMOTE_IMPACT_H

#include "mover/context/serial_context.h"
#include "world/entity/remote.h"

/* Strikes row target, an own vehicle or wreck. body: the row of what strikes it, SLOT_NONE when it
 * is not known here. */
enum remote_refusal remote_impact(struct serial_context *context,
                                  const struct remote_record *record, uint32_t target,
                                  uint32_t body);

#endif
