/* How the guard at a frame's end sends a body back on its way (collider/guard/end_guard.h). Pure;
 * one thread. */
#ifndef JOLON_COLLIDER_GUARD_SEND_BACK_H
#define JOLON_COLLIDER_GUARD_SEND_BACK_H

#include "collider/response/response_context.h"

#include <stdint.h>

#define SEND_BACK_HALF 3u /* so often a row goes back by half, the next time all the way */
#define SEND_BACK_TURN 4u /* then a vehicle that drives goes back by its turn alone */
#define SEND_BACK_MOST 5u /* bodies in the air that go together go back among themselves before */

/* Sends a row back for the n-th time in the frame, on its way from where it began it. drift: how
 * far it goes together with others in the air [m]; 0: it does not. Those that do keep their
 * velocity. Returns how often the row counts as sent back: SEND_BACK_MOST if it is where it began
 * the frame. */
uint8_t send_back_go(struct response_context *context, uint32_t row, struct vec3 drift,
                     uint32_t times);

#endif
