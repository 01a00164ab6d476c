/* Rows of remote entities in the collider (world/entity/remote.h).
 *
 * A contact with a remote entity is solved like any other, with the entity's mass, so that our
 * vehicles get the impulse of it. What the entity itself does then is its owner's to say: at the
 * end of the frame its row is what the mover left.
 *
 * Then it is corrected: it is led towards where its owner has it. A correction is no motion. It
 * lies between two frames, so the body has swept nothing and has no speed by it. Where it ends in
 * one of ours, the next frame parts the two as it parts what overlaps at the start. */
#ifndef JOLON_COLLIDER_REMOTE_ROWS_H
#define JOLON_COLLIDER_REMOTE_ROWS_H

#include "collider/response/response_context.h"

/* Puts the rows of remote entities back that the responses of this frame have changed, and corrects
 * those that are not where their owner has them. moved: the mover's table. Costs nothing in a world
 * without room for remote entities. */
void remote_rows_settle(struct response_context *context, const struct entities *moved);

#endif
