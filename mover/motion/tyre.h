/* Forces between the wheels of a body and the ground, along the ground. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_TYRE_H
#define JOLON_MOVER_MOTION_TYRE_H

#include "mover/motion/drivetrain.h"
#include "mover/motion/suspension.h"

/* What the wheels do in a sub-step. */
struct tyre_demand {
    const struct drivetrain *drivetrain;
    struct drivetrain_force force;
    double side;   /* share of the friction under a wheel that holds to the sides */
    double grip_n; /* most that all wheels can bear, over 0: drive and brakes are shared by it */
    double dt_s;
};

/* Returns the share of the friction that holds a vehicle to the sides: 1 on wheels, less on tracks
 * in a wide turn. */
double tyre_side_share(const struct kind *kind, double forward_mps, double yaw_rps);

/* inverse: of the moments of inertia on world axes [1/(kg m2)]. Changes velocity and spin by the
 * forces of tyres or tracks within dt_s: drive, brakes, side forces within the friction of each
 * wheel. No force reverses the slip that it acts against. */
void tyre_solve(struct suspension *suspension, struct rigid_body *body, const struct mat3 *turn,
                const struct mat3 *inverse, const struct tyre_demand *demand);

#endif
