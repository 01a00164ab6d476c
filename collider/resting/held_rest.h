/* Vehicles that rest on their springs and partly on another body. Their springs would move them,
 * and the guard at the end of each frame (collider/guard/end_guard.h) puts them back: they stand
 * still, and the contact that holds them is marked in the table. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_HELD_REST_H
#define JOLON_COLLIDER_RESTING_HELD_REST_H

#include "collider/response/response_context.h"

#include <stdbool.h>

/* Returns true if a row ends the frame in the pose in which it began it, without any motion. */
bool held_rest_ended(const struct response_context *context, uint32_t row);

/* Returns true if a row that a contact held in the frame before began this one at rest, and the
 * mover has moved it by no more than springs do: no engine drives it, and it does not fall. */
bool held_rest_stays(const struct response_context *context, uint32_t row);

/* Turns a vehicle on its springs whose engine drives it back to how it began the frame, and leaves
 * it where it has come. Springs that turn it into another body would else hold it there, however
 * its engine parts the two. Returns false for any other row. */
bool held_rest_turn_back(struct response_context *context, uint32_t row);

/* Puts a row back to where it began the frame. Nothing of the frame must have been solved yet. */
void held_rest_put_back(struct response_context *context, uint32_t row);

/* Pins a row that has been put back: the mover leaves it where it stands (mover/motion/chassis.h),
 * so that nothing in its heap moves and all of it sleeps. */
void held_rest_pin(const struct response_context *context, uint32_t row);

/* Lets the pinned rows go of which a contact holds no longer what it held in the frame before. The
 * frame's list of contacts must be finished. */
void held_rest_let_go(const struct response_context *context);

/* A vehicle that leaves its springs takes the pose of one that stands. Where a contact keeps it in
 * the pose that it had, it stays on them. */
void held_rest_keep_springs(struct response_context *context, uint32_t row);

/* Marks the contacts that have kept a row where it began the frame, with CONTACT_HOLDS. */
void held_rest_mark(struct response_context *context, uint32_t row);

#endif
