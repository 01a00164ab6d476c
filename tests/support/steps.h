/* What tests of mover/ and collider/ do with a fixture beyond running it: change what is constant
 * in a world, send commands, and stand in the middle of a frame.
 *
 * Whatever fails in here fails the cmocka test that called it. */
#ifndef JOLON_TESTS_SUPPORT_STEPS_H
#define JOLON_TESTS_SUPPORT_STEPS_H

#include "collider/response/response.h"
#include "mover/context/serial_context.h"
#include "tests/support/fixture.h"

/* --- what is constant in a world, writable for tests -------------------------------------------*/

struct kind *steps_kind(const struct fixture *fixture, const char *name);
struct params *steps_params(const struct fixture *fixture);

/* Sets every post's height [m]; context goes to the function. */
typedef double steps_height(double x, double z, const void *context);
void steps_ground(const struct fixture *fixture, steps_height *height, const void *context);

/* The plane 100 + east * (x - 25000) + south * (z - 25000): rises by these over one. */
void steps_plane(const struct fixture *fixture, double east, double south);

/* Sets the cover of the posts within the rectangle, borders included. */
void steps_cover(const struct fixture *fixture, enum cover cover, double x0, double z0, double x1,
                 double z1);

/* Height of the ground at a point, craters included. */
double steps_ground_at(const struct fixture *fixture, double x, double z);

/* --- rows --------------------------------------------------------------------------------------*/

/* The committed columns, writable. */
struct entities steps_rows(const struct fixture *fixture);
double steps_speed(const struct fixture *fixture, uint32_t row);

/* Back to a frame 0 without entities, events or craters: cheaper than another world. Kinds and
 * ground stay as they are. */
void steps_empty(struct fixture *fixture);

/* --- commands ----------------------------------------------------------------------------------*/

/* Appends to a ring; runs nothing. */
void steps_send(struct fixture *fixture, enum command_ring ring, struct command command);

/* Sends it by the console's ring, runs one frame and returns the answer. */
struct event_command steps_command(struct fixture *fixture, struct command command);

/* Drives a row: throttle, steer, climb; or brake and gear too. Must be done. Runs one frame. */
void steps_drive(struct fixture *fixture, uint32_t row, double throttle, double steer,
                 double climb);
void steps_pedals(struct fixture *fixture, uint32_t row, double throttle, double brake,
                  enum gearing gear);

/* Row of an id in the committed frame, SLOT_NONE when there is none. */
uint32_t steps_find(const struct fixture *fixture, uint32_t id);

/* Turns turret and gun of a row onto another in no time. */
void steps_lay(const struct fixture *fixture, uint32_t row, uint32_t target);

/* --- the middle of a frame ---------------------------------------------------------------------*/

/* The mover's serial half at the next frame's tick: the moved table is a copy of the committed
 * frame, and nothing has moved. step must live as long as context. */
void steps_serial_context(struct fixture *fixture, struct step_context *step,
                          struct serial_context *context);

/* The collider with the next frame's buffer a copy of the committed one, every row at rest and
 * nothing to meet. Free with steps_respond_end. */
void steps_respond(struct fixture *fixture, struct response_context *context);
void steps_respond_end(struct response_context *context);

/* --- purity ------------------------------------------------------------------------------------*/

/* The mover's step alone, from the committed frame into the moved table; may be repeated. */
void steps_move(struct fixture *fixture);

/* Everything that a step writes for this frame, as one hash: head, used rows of every column, and
 * what lies beside them. */
uint64_t steps_moved_hash(const struct fixture *fixture);
uint64_t steps_state_hash(const struct fixture *fixture, const struct state *state);

#endif
