/* A sub-step by which a land vehicle moves as a body on its springs (mover/motion/chassis.h).
 *
 * It reads nothing but the row, the ground and what the frame asks for. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_CHASSIS_RUN_H
#define JOLON_MOVER_MOTION_CHASSIS_RUN_H

#include "mover/motion/chassis_shell.h"
#include "mover/motion/tyre.h"

/* A sub-step is at most so long [s]. */
#define CHASSIS_SUBSTEP_S (1.0 / 60.0)

/* A vehicle in a sub-step. */
struct chassis {
    const struct step_context *context; /* its dt_s is that of the sub-step */
    const struct kind *kind;
    struct rigid_body body;
    struct suspension suspension;
    struct drivetrain drivetrain;
    struct desired_motion desired; /* in this frame */
    double most_mps;               /* that fuel and debris allow */
    double friction;               /* mean of the ground under the wheels in the last part */
    double fall_j;                 /* energy by which stops and shell were hit hard, from below */
    double strike_j;               /* the same by upright ground: a wall, a bank */
    struct chassis_shell shell;    /* of no points until it is needed */
    bool cratered, littered;       /* there may be craters, debris under it */
    bool bent;                     /* its shell may get into the ground of a hollow */
    bool rough;                    /* a wheel is on its bump stop or bears next to nothing */
    bool level;                    /* every wheel bears */
    bool drowns;                   /* water that is too deep slows or holds it */
};

/* Prepares row i for a sub-step with this desired motion. The fuel of the row is not burnt. */
void chassis_run_begin(struct chassis *chassis, const struct step_context *context, uint32_t i,
                       const struct desired_motion *desired);

/* Moves the body for the sub-step. */
void chassis_run(struct chassis *chassis);

#endif
