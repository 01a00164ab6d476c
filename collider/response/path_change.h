/* How the response to a contact changes a body's path in the rest of the frame. */
#ifndef JOLON_COLLIDER_RESPONSE_PATH_CHANGE_H
#define JOLON_COLLIDER_RESPONSE_PATH_CHANGE_H

#include "collider/response/response_context.h"

/* Keeps the row where it is for the rest of the frame; this is its velocity at the end. */
void path_change_stay(struct response_context *context, uint32_t row, double time,
                      struct vec3 velocity);

/* The row continues along its path at a share of its speed. Call path_change_swept afterwards. */
void path_change_slow(struct response_context *context, uint32_t row, double time, double share);

/* The row continues from `at` with this velocity and spin. One that falls freely falls on. If it
 * stays, it remains there for the rest of the frame and has both at the end. A body in the air
 * rotates freely from then on. spin_rps is as path_change_spin() returns it for the time; the
 * driver's part does not become the row's own spin. Call path_change_swept once all rows that leave
 * at this time have left. */
void path_change_leave(struct response_context *context, uint32_t row, double time, struct vec3 at,
                       struct vec3 velocity, struct vec3 spin_rps, bool stays);

/* Finds the contacts of the rows' new paths. */
void path_change_swept(struct response_context *context, const uint32_t *rows, uint32_t count,
                       double time);

/* Returns the row's velocity at a time in [path.since, 1]: without the speed that one that falls
 * freely will have by its weight afterwards, and without the rolling of one on the ground, which
 * an answer ends. */
struct vec3 path_change_velocity(const struct response_context *context, uint32_t row, double time);

/* Returns the row's rotation at a time in [path.since, 1] [rad/s, world axes]. On the ground: its
 * spin from collisions and the driver's steering. In the air: the spin at the orientation of that
 * time that has the angular momentum of the row, which is constant until the frame's end. */
struct vec3 path_change_spin(const struct response_context *context, uint32_t row, double time);

/* Returns true for a row that the ground supports: a land vehicle, a ship, a wreck that lies on the
 * ground in whatever pose. */
bool path_change_grounded(const struct response_context *context, uint32_t row);

/* Returns true for a row that the ground supports and that only holds its course. The ground tilts
 * it and lifts it, whatever presses on it, so for contacts its position moves on the map and it
 * turns about the vertical. */
bool path_change_on_course(const struct response_context *context, uint32_t row);

/* Returns the centre of mass of a row with these axes, from its position [m, world axes]. That of a
 * row on its course counts as above its position, as if it stood level: its velocity is that of its
 * position. */
struct vec3 path_change_arm(const struct response_context *context, uint32_t row,
                            const struct mat3 *axes);

#endif
