/* How the answer to a contact changes a body's path through the rest of the frame. */
#ifndef JOLON_COLLIDER_RESPONSE_PATH_CHANGE_H
#define JOLON_COLLIDER_RESPONSE_PATH_CHANGE_H

#include "collider/response/response_context.h"

/* The row stays where it is for the rest of the frame, which it ends with this velocity. */
void path_change_stay(struct response_context *respond, uint32_t row, double time,
                      struct vec3 velocity);

/* The row goes on along its path at a share of its speed. path_change_swept must follow. */
void path_change_slow(struct response_context *respond, uint32_t row, double time, double share);

/* The row goes on from `at` with this velocity and spin. If it stays, it remains there for the rest
 * of the frame, which it ends with both. spin_rps is as path_change_spin() returns it: the part
 * that the driver steers does not become the row's own. path_change_swept must follow once all rows
 * that leave at this time have left. */
void path_change_leave(struct response_context *respond, uint32_t row, double time, struct vec3 at,
                       struct vec3 velocity, struct vec3 spin_rps, bool stays);

/* Finds the contacts of the rows' new paths. */
void path_change_swept(struct response_context *respond, const uint32_t *rows, uint32_t count,
                       double time);

/* Returns how the row turns [rad/s, world axes]: the spin that collisions gave it and, on the
 * ground, what its driver steers. */
struct vec3 path_change_spin(const struct response_context *respond, uint32_t row);

/* Returns true for a row that the ground holds: a land vehicle, a ship, a wreck on the ground. */
bool path_change_grounded(const struct response_context *respond, uint32_t row);

#endif
