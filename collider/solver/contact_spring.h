/* A temporary spring between two bodies at their contact (thesis row 43; Moore & Wilhelms,
 * "Collision Detection and Response for Computer Animation", SIGGRAPH 1988): the alternative to
 * impulses. The rebound is stiffer than the compression, and so returns only part of the energy.
 *
 * Moore & Wilhelms weaken the rebound instead, which then takes the longer the less it bounces, and
 * leaves no dent. Here the rebound has the stiffness divided by the square of restitution (Walton &
 * Braun, J. Rheol. 30, 1986): the speed out is restitution times the speed in, the contact ends in
 * time, and the compression that remains is the dent. In both phases the force grows linearly with
 * depth, so each is a quarter of a harmonic oscillation and needs no steps in time. Pure; any
 * thread. */
#ifndef JOLON_COLLIDER_SOLVER_CONTACT_SPRING_H
#define JOLON_COLLIDER_SOLVER_CONTACT_SPRING_H

struct contact_spring {
    double reduced_kg;    /* > 0: effective mass of both along the normal */
    double closing_mps;   /* >= 0 */
    double stiffness_npm; /* > 0 */
    double restitution;   /* 0..1 */
};

struct contact_spring_impact {
    double impulse_ns; /* along the normal, on each body */
    double depth_m;    /* greatest compression of both skins together */
    double left_m;     /* 0..depth_m: remaining when they part */
    double force_n;    /* greatest */
    double duration_s;
};

/* Returns the stiffness of two skins one behind the other, which is less than either. Both > 0. */
double contact_spring_in_series(double a_npm, double b_npm);

struct contact_spring_impact contact_spring_impact(const struct contact_spring *spring);

#endif
