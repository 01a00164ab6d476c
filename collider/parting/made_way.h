/* Aircraft that only make way for those that part: they go no farther than somebody needs. They are
 * drawn back when the steps are found, so that they meet nobody on a way for nothing, and again
 * when nothing of the frame moves any more: those for whom they made way may have been stopped by
 * an impact, or sent back by the guard. Pure; one caller, and its workers. */
#ifndef JOLON_COLLIDER_PARTING_MADE_WAY_H
#define JOLON_COLLIDER_PARTING_MADE_WAY_H

#include "collider/parting/aircraft_parting.h"

/* Shortens the steps of those that make way, which are found but not made. */
void made_way_draw_back(struct aircraft_parting *parting, const struct response_context *context);

/* Puts those that made way back at the frame's end. */
void made_way_settle(struct aircraft_parting *parting, struct response_context *context);

#endif
