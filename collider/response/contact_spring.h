/* A temporary spring between two bodies where they touch (thesis row 43; Moore & Wilhelms,
 * "Collision Detection and Response for Computer Animation", SIGGRAPH 1988): the alternative to
 * impulses. It is stiffer on the way back than on the way in, and so gives back only part of what
 * it took.
 *
 * Moore & Wilhelms weaken the way back, which takes ever longer the less it bounces, and leaves
 * nothing bent. Here it is the stiffness over the square of restitution (Walton & Braun, J. Rheol.
 * 30, 1986): the speed out is restitution times the speed in, the contact ends in time, and what
 * does not come back is the dent. Either way the force grows evenly with depth, so that each way is
 * a quarter of a harmonic oscillation and needs no steps in time. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESPONSE_CONTACT_SPRING_H
#define JOLON_COLLIDER_RESPONSE_CONTACT_SPRING_H

struct contact_spring {
    double reduced_kg;    /* > 0: effective mass of the two along the normal */
    double closing_mps;   /* >= 0 */
    double stiffness_npm; /* > 0 */
    double restitution;   /* 0..1 */
};

struct contact_spring_impact {
    double impulse_ns; /* along the normal, on each of them */
    double depth_m;    /* greatest compression of the two skins together */
    double left_m;     /* 0..depth_m: of it when they part */
    double force_n;    /* greatest */
    double duration_s;
};

/* Two skins one behind the other give way as one softer spring. Both > 0. */
double contact_spring_in_series(double a_npm, double b_npm);

struct contact_spring_impact contact_spring_impact(const struct contact_spring *spring);

#endif
