/* Walls that are joined to a struck one (thesis p. 15: "corresponding responses in those
 * interconnected walls"). */
#ifndef JOLON_COLLIDER_RESPONSE_JOINED_WALLS_H
#define JOLON_COLLIDER_RESPONSE_JOINED_WALLS_H

#include "collider/response/response_context.h"

/* Walls nearer to each other than this are joined [m]. */
#define JOINED_WALLS_GAP_M 0.3

/* The share of an impact's energy that goes into the walls joined to the struck one, in equal
 * parts. Walls joined to those take nothing. */
#define JOINED_WALLS_SHARE 0.25

/* Returns how many standing objects of class building touch this one, which is of that class, and
 * puts them into the context's list of near bodies (charges.near, pair.b). The list stays valid
 * until the next explosion. 0 for an object of another class. */
uint32_t joined_walls_find(struct response_context *context, uint32_t object);

/* Damages the walls that joined_walls_find() found by equal parts of this energy [J]. */
void joined_walls_damage(struct response_context *context, double joules);

/* Returns true if the footprints of two objects are nearer than the gap: rectangles with the length
 * and width of their kinds. kinds: all kinds of the world. */
bool joined_walls_touch(const struct fixed_object *p, const struct fixed_object *q,
                        const struct kind *kinds);

#endif
