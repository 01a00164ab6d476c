/* Wheels of a land vehicle as vertical rays with a spring and a damper each. Pure; any thread.
 *
 * On ground that craters and earthworks make uneven a wheel is a disc: it touches the highest of
 * the points before and behind it. So it rolls over an edge. The ends of tracks rise from the first
 * and the last road wheel, so that they climb a step. Ground before a wheel that is more than
 * reach_m higher than that under it is a wall: no wheel climbs it, and the shell
 * (mover/motion/chassis_shell.h) stands against it.
 *
 * A road wheel of a track is a wheel like others. Springs carry the body so that its position, the
 * middle of its underside, is on the ground at rest. */
#ifndef JOLON_MOVER_MOTION_SUSPENSION_H
#define JOLON_MOVER_MOTION_SUSPENSION_H

#include "mover/motion/rigid_body.h"

#define SUSPENSION_WHEELS_MAX (2u * CHASSIS_AXLES_MAX)

enum { WHEEL_ALONG, WHEEL_ACROSS, WHEEL_AXES };

struct wheel {
    struct vec3 place; /* [m] body axes, relative to the position: its lowest point without load */
    double side;       /* -1: left, 1: right */
    double bow;        /* 1: at the front end of a track, -1: at the rear end; 0: elsewhere */
    bool steers;
    /* In this sub-step. */
    double squeeze_m; /* how far the ground presses it from there; 0: it does not touch */
    double load_n;
    double stop_w;   /* power by which its bump stop is hit hard */
    double friction; /* of the ground under it: set by the caller */
    struct vec3 normal;
    struct vec3 arm;               /* [m, world axes] from the centre of mass to its contact */
    struct vec3 axis[WHEEL_AXES];  /* unit, in the plane of the ground */
    struct vec3 lever[WHEEL_AXES]; /* [m] */
    struct vec3 twist[WHEEL_AXES]; /* [1/(kg m)] change of spin by a unit impulse */
    double mass_kg[WHEEL_AXES];    /* impulse for a unit change of speed */
    double impulse_ns[WHEEL_AXES]; /* so far */
    double most_ns[WHEEL_AXES];    /* of it */
    double drive_ns;               /* by the engine */
    double grip_ns;                /* most of all together */
};

struct suspension {
    uint32_t count;
    struct wheel wheel[SUSPENSION_WHEELS_MAX];
    double sag_m;      /* by which the weight presses the springs */
    double most_m;     /* from which on the bump stop bears */
    double spring_npm; /* of a wheel */
    double damper_nspm;
    double wheelbase_m; /* from the steering axle to the middle of the others */
    double radius_m;    /* of a wheel */
    double bow_m;       /* length of the ends of tracks, which rise from the ground; 0 on wheels */
    double reach_m;     /* over the ground under a wheel: higher ground before it is a wall */
    double front_m;     /* from the middle to the front of the first wheel, or of the tracks */
    double ground_m;    /* length of the tracks on the ground, or between the outer axles */
};

/* Finds the wheels of a kind. uneven: there may be craters or earthworks under the body. On even
 * ground a track of more road wheels stands on three, which are as stiff against heave and pitch as
 * all of them. */
void suspension_of(const struct kind *kind, bool uneven, struct suspension *suspension);

/* Finds which wheels touch the ground, and their loads. Returns the sum of the loads [N]. uneven:
 * there may be craters or earthworks under the body. */
double suspension_load(struct suspension *suspension, const struct step_context *context,
                       const struct rigid_body *body, const struct mat3 *turn, bool uneven);

/* Returns the greatest force along the ground that all wheels together can bear [N], by their loads
 * and the friction under them. */
double suspension_grip(const struct suspension *suspension);

#endif
