/* Turrets and guns turn at the end of a frame, when all bodies are where they end it. Each turns on
 * its own, the turret and then the gun, in the order of the rows, and stops where it touches
 * another body or a wall. So no part ends the frame in anything that its body did not end it in.
 * Pure; one thread. */
#ifndef JOLON_COLLIDER_GUARD_TURRET_GUARD_H
#define JOLON_COLLIDER_GUARD_TURRET_GUARD_H

#include "collider/response/response_context.h"

/* Turns the turrets and guns of the frame, and writes the angles of those that were stopped. All
 * bodies must be where they end the frame. */
void turret_guard_run(struct response_context *context);

#endif
