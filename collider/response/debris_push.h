/* Debris that vehicles push (thesis, p. 15). What comes loose when a vehicle fells an object lies
 * in a list in the head of the state (world/entity/debris.h). It has mass, slides over the ground
 * until friction stops it, and exchanges momentum with the land vehicles that drive into it or that
 * it slides against. No vehicle turns by it, and none is displaced. */
#ifndef JOLON_COLLIDER_RESPONSE_DEBRIS_PUSH_H
#define JOLON_COLLIDER_RESPONSE_DEBRIS_PUSH_H

#include "collider/response/response_context.h"

/* What a vehicle felled. */
struct debris_fall {
    uint32_t object;
    double x, z;           /* [m] where it was struck */
    double away_x, away_z; /* unit, on the map, away from the striker */
    double speed_mps;      /* of the part that moves */
    double moving_kg;      /* its mass */
};

/* Lays the object down in the direction of the blow, and adds what is loose to the list. A full
 * list gives up the entry at rest that fell first: a trunk is scattered, and no obstacle any more,
 * and a heap lies where it fell again. If none is at rest, the new debris stays where it fell. */
void debris_push_add(struct response_context *context, const struct debris_fall *fall);

/* Moves all debris by a frame, and changes the velocities of the vehicles that touch it. After all
 * impacts: the new velocities are those of the next frame. Does nothing for an empty list. */
void debris_push_step(struct response_context *context);

#endif
