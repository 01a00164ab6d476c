/* Further operations on a fixture for tests of mover/ and collider/: they change constants of a
 * world, send commands, and call parts of a frame. A failure in here fails the calling cmocka test.
 */
#ifndef JOLON_TESTS_SUPPORT_STEPS_H
#define JOLON_TESTS_SUPPORT_STEPS_H

#include "collider/response/response.h"
#include "mover/context/serial_context.h"
#include "tests/support/fixture.h"

/* --- constants of a world ----------------------------------------------------------------------*/

struct kind *steps_kind(const struct fixture *fixture, const char *name);
struct params *steps_params(const struct fixture *fixture);

/* Gives the world a ring of so many events, a power of two, before its first frame. Its memory is
 * larger, which does no harm. */
void steps_small_ring(const struct fixture *fixture, uint32_t slots);

/* Sets the height of every post [m]. context is passed to the function. */
typedef double steps_height(double x, double z, const void *context);
void steps_ground(const struct fixture *fixture, steps_height *height, const void *context);

/* A steps_height of hills of up to 6 m, so that nothing stands level. context is not used. */
double steps_waves(double x, double z, const void *context);

/* Sets the ground to the plane 100 + east * (x - 25000) + south * (z - 25000) [m]. east, south:
 * slopes. */
void steps_plane(const struct fixture *fixture, double east, double south);

/* Sets the cover of the posts within the rectangle, borders included. */
void steps_cover(const struct fixture *fixture, enum cover cover, double x0, double z0, double x1,
                 double z1);

/* Returns the height of the ground at a point, craters included [m]. */
double steps_ground_at(const struct fixture *fixture, double x, double z);

/* --- rows --------------------------------------------------------------------------------------*/

/* Puts a vehicle that stands, with an agent whose order is this behaviour. Returns its row. */
uint32_t steps_put(struct fixture *fixture, const char *kind, struct vec3 at, enum force force,
                   enum behaviour behaviour);

/* Puts a vehicle on the ground that drives where it heads, and holds its course. Returns its row.
 */
uint32_t steps_put_driving(struct fixture *fixture, const char *kind, double x, double z,
                           double heading_deg, double speed_mps);

/* The row's agent hears that `by` has fired at it. */
void steps_threaten(const struct fixture *fixture, uint32_t row, uint32_t by);

/* Makes another row the target of a row's agent. */
void steps_target(const struct fixture *fixture, uint32_t row, uint32_t target);

/* Returns the columns of the committed frame, writable. */
struct entities steps_rows(const struct fixture *fixture);
double steps_speed(const struct fixture *fixture, uint32_t row);

/* Return where a row is in the committed frame, and its velocity, also if it cruises. */
struct vec3 steps_position(const struct fixture *fixture, uint32_t row);
struct vec3 steps_velocity(const struct fixture *fixture, uint32_t row);

/* Returns to a frame 0 without entities, events and craters, which is cheaper than another world.
 * Kinds and ground stay. */
void steps_empty(struct fixture *fixture);

/* --- commands ----------------------------------------------------------------------------------*/

/* Appends a command to a ring. Computes no frame. */
void steps_send(struct fixture *fixture, enum command_ring ring, struct command command);

/* Sends a command by the clients' ring, computes one frame and returns the answer. */
struct event_command steps_command(struct fixture *fixture, struct command command);

/* Sends a drive command for a row with throttle, steer and climb, or with throttle, brake and gear.
 * It must be done. Computes one frame. */
void steps_drive(struct fixture *fixture, uint32_t row, double throttle, double steer,
                 double climb);
void steps_pedals(struct fixture *fixture, uint32_t row, double throttle, double brake,
                  enum gearing gear);

/* Returns the row of an id in the committed frame, or SLOT_NONE. */
uint32_t steps_find(const struct fixture *fixture, uint32_t id);

/* Sets turret and gun of a row so that they aim at the target. */
void steps_aim(const struct fixture *fixture, uint32_t row, uint32_t target);

/* --- the middle of a frame ---------------------------------------------------------------------*/

/* Prepares the mover's serial part of the next frame. The moved table is a copy of the committed
 * frame, and nothing has moved. step must live as long as context. */
void steps_serial_context(struct fixture *fixture, struct step_context *step,
                          struct serial_context *context);

/* Prepares the collider's response in the next frame. The next buffer is a copy of the committed
 * one, all rows are at rest and there are no contacts. Free with steps_respond_end(). */
void steps_respond(struct fixture *fixture, struct response_context *context);

/* Fails unless a world ends 60 frames with the same bytes by all methods that sweep, on one thread
 * and on three. begin: opens the world in the fixture by a method. */
void steps_methods_agree(struct fixture *fixture, void (*begin)(const char *method));

/* Makes what a row of this frame holds another body than that of the committed frame. */
void steps_replace(struct fixture *fixture, struct response_context *context, uint32_t row,
                   uint32_t id);
void steps_respond_end(struct response_context *context);

/* Returns the horizontal gap between two rows as they stand in a table, below 0 for an overlap [m].
 * More than 9 m are 9. */
double steps_gap(const struct fixture *fixture, const struct entities *entities, uint32_t a,
                 uint32_t b);

/* Returns the deepest overlap of any two of the first rows in the committed frame [m]. */
double steps_deepest(const struct fixture *fixture, uint32_t count);

/* Returns how far one of the first rows is off the ground under its middle at most [m]. */
double steps_off_the_ground(const struct fixture *fixture, uint32_t count);

/* --- purity ------------------------------------------------------------------------------------*/

/* Computes the mover's step alone, from the committed frame into the moved table. May be repeated.
 */
void steps_move(struct fixture *fixture);

/* Return one hash of everything that a step writes for this frame: head, used rows of all columns,
 * and the data beside them. */
uint64_t steps_moved_hash(const struct fixture *fixture);
uint64_t steps_state_hash(const struct fixture *fixture, const struct state *state);

#endif
