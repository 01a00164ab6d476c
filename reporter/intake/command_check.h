/* Checks a command from outside and converts it into the form of the command ring.
 *
 * A client can send anything: NaN, numbers out of range, unknown names. A command that passes is
 * well-formed. Whether its entity exists, and the world can do it now, only the mover knows. */
#ifndef JOLON_REPORTER_INTAKE_COMMAND_CHECK_H
#define JOLON_REPORTER_INTAKE_COMMAND_CHECK_H

#include "status.h"
#include "world/entity/command.h"

struct world;

#define COMMAND_CHECK_FRAMES_MAX   1000000u
#define COMMAND_CHECK_SCALE_MIN    0.01
#define COMMAND_CHECK_SCALE_MAX    100.0
#define COMMAND_CHECK_ALTITUDE_MAX 20000.0 /* [m] */
#define COMMAND_CHECK_SPEED_MAX    2000.0  /* [m/s] */

/* Fills command from wire. Returns COMMAND_DONE when it may go into the ring, else the reason. */
enum command_result command_check(struct command *command, const jolon_Command *wire,
                                  const struct world *world);

#endif
