/* Engine, brakes and steering of a land vehicle: from the desired motion to forces. Wheels have no
 * speed of their own: engine and brakes act as forces at the ground. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_DRIVETRAIN_H
#define JOLON_MOVER_MOTION_DRIVETRAIN_H

#include "mover/context/step_context.h"
#include "mover/motion/ground_grip.h"

/* Shares of the engine's power that reach the ground. */
#define DRIVETRAIN_BY_TRACKS 0.55
#define DRIVETRAIN_BY_WHEELS 0.7

/* A driver turns the steering wheel, or pulls the levers of tracks, at this rate [1/s]: from the
 * middle to the stop in half a second. */
#define DRIVETRAIN_WHEEL_PS 2.0

/* What the vehicle is asked for in a frame. */
struct drivetrain {
    const struct kind *kind;
    double wanted_mps;
    double slowing;    /* 0..1 of the hardest braking, if it is faster than that */
    double hand_brake; /* 0..1 */
    double asked_rps;  /* turn rate, to the right: by an agent */
    double turn;       /* -1..1 of the wheel that a driver asks for */
    double wheel;      /* -1..1: where the steering wheel is; it turns with DRIVETRAIN_WHEEL_PS */
    double curve;      /* [1/m] of the path, to the right: wheels */
    double yaw_rps;    /* to the right: tracks */
    bool driven, neutral;
};

struct drivetrain_force {
    double drive_n; /* along the heading */
    double brake_n; /* most that brakes and rolling resistance hold against the motion */
};

/* Finds what a desired motion asks for in a frame. */
struct drivetrain drivetrain_of(const struct step_context *context, uint32_t i,
                                const struct desired_motion *desired);

/* Steers for a sub-step at this speed along the heading. */
void drivetrain_steer(struct drivetrain *drivetrain, double forward_mps, double friction,
                      double dt_s);

/* What the ground gives in a sub-step. */
struct drivetrain_ground {
    double rise;      /* sine of the slope along the heading */
    double grip_n;    /* most that all wheels can bear along the ground */
    double rolling_n; /* resistance against rolling */
};

/* Returns the forces at the ground. */
struct drivetrain_force drivetrain_force(const struct drivetrain *drivetrain, double forward_mps,
                                         const struct drivetrain_ground *ground);

/* Returns the power of the kind that reaches the ground [W]. */
double drivetrain_power(const struct kind *kind);

/* Returns by how much less than its surplus of power gives a kind gains speed: engine, wheels and
 * tracks gain speed as well, and a driver changes gears. Over 1. (Gillespie, Fundamentals of
 * Vehicle Dynamics, has 1.1 to 1.5 for the rotating masses in the middle gears.) */
double drivetrain_gears(const struct kind *kind);

/* Returns the greatest lateral acceleration at which an agent drives [m/s2]: below the grip, and
 * below 0.8 of that which would overturn the vehicle. */
double drivetrain_lateral(const struct kind *kind, double friction);

#endif
