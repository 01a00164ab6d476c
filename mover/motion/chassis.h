/* A land vehicle as one rigid body on springs (docs/decisions/035-chassis.md).
 *
 * Nearly all land vehicles follow the ground (mover/motion/ground_vehicle.h). A row with
 * ENTITY_FLAG_CHASSIS moves as a body instead: on wheels or road wheels, each a ray with a spring,
 * a damper and a tyre; it rolls, slides, jumps and overturns. The field jolt_tick says when it was
 * last disturbed. After CHASSIS_CALM_S without disturbance it follows the ground again.
 * ground_vehicle.c then moves its height and its angles to those of the ground bit by bit, and
 * takes the flag away when they agree.
 *
 * The mover sets the flag for a row that is driven or spins, and where the ground is rough for its
 * speed. The collider sets it for a row that is pushed. All of this follows from the row's state
 * and the ground. Nothing but the row's position, pose, velocity and spin is kept between frames,
 * and of a driven row where its steering wheel is: -1..1 in the field dodge, which avoidance does
 * not need then.
 *
 * A hard landing adds to harm_j. The collider makes damage of it.
 */
#ifndef JOLON_MOVER_MOTION_CHASSIS_H
#define JOLON_MOVER_MOTION_CHASSIS_H

#include "mover/context/step_context.h"

/* A chassis is calm for so long before its vehicle follows the ground again [s]. */
#define CHASSIS_CALM_S 1.0

/* Up to this tilt a vehicle follows the ground however it drives; beyond, while its tyres hold it
 * there. And the greatest step that it drives over. */
#define CHASSIS_TILT_RAD  0.4363323129985824 /* 25 degrees */
#define CHASSIS_LOW_CLIMB 1.2                /* share of max_slope_rad that low gear climbs */
#define CHASSIS_STEP_M    0.3

/* A vehicle in water wants no more than this [m/s]. */
#define CHASSIS_FORD_MPS 2.0

/* Edges under the corners of a body may lift a vehicle that follows the ground by so much. The
 * wheels of a body on its springs do not stand on such edges, so with more it would come to float.
 */
#define CHASSIS_LIFT_M 0.06

/* How a vehicle leans on a slope, and how it gains speed ahead and to the right on the map. */
struct chassis_slope {
    double pitch_rad, roll_rad;
    double gain_mps2, lateral_mps2;
};

/* Returns true if a vehicle of this kind leans by at most CHASSIS_TILT_RAD, or if its tyres hold it
 * on ground with this friction: it neither slides nor leans over, and needs no springs. */
bool chassis_holds(const struct kind *kind, double friction, const struct chassis_slope *slope);

/* Returns true if row i, an active land vehicle, moves as a body in this frame. driven: a driver or
 * a script has its controls. */
bool chassis_takes(const struct step_context *context, uint32_t i, bool driven);

/* Moves it. It fords water as deep as its kind can. Returns true if deeper water, a slope or the
 * edge of the world blocks it. */
bool chassis_move(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired);

/* Notes that row i is disturbed in this frame: it moves as a body from the next frame on. */
void chassis_disturb(const struct step_context *context, uint32_t i);

#endif
