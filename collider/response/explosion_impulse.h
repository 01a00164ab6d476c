/* The impulse of an explosion on a body (thesis p. 8), and whether it overturns a vehicle. Pure;
 * any thread.
 *
 * The impulse per area is the reflected impulse of Kingery & Bulmash, "Airblast parameters from TNT
 * spherical air burst and hemispherical surface burst", ARBRL-TR-02555 (1984), as Swisdak fitted it
 * for hemispherical charges on the ground ("Simplified Kingery airblast calculations", 1994):
 *     i = cbrt(W) * exp(6.7853 - 1.3466 L + 0.101 L^2 - 0.01123 L^3),  L = ln Z
 * i [Pa s], W the charge [kg of TNT], R the distance [m], Z = R / cbrt(W) [m/kg^(1/3)]. exp and ln
 * differ between machines, so the function here is the rational
 *     i = cbrt(W) * (570 / Z + 305 / Z^2)
 * which is within 1.2 % of that fit for Z from 0.2 to 8, and within 4.3 % up to 40. */
#ifndef JOLON_COLLIDER_RESPONSE_EXPLOSION_IMPULSE_H
#define JOLON_COLLIDER_RESPONSE_EXPLOSION_IMPULSE_H

#include "world/entity/kind.h"
#include "world/maths/rotation.h"

#include <stdbool.h>

/* Below this scaled distance the gases of the charge surround the body, and a law of reflection at
 * a wall no longer holds: the impulse stays what it is there [m/kg^(1/3)]. */
#define EXPLOSION_IMPULSE_LEAST_Z 0.5

/* A case of steel takes a part of the energy, so that a round pushes as a bare charge of this share
 * of its explosive does. */
#define EXPLOSION_IMPULSE_CASED 0.6

/* Returns the impulse per area [Pa s] at a distance [m] from a bare charge, both >= 0. It is 0 for
 * a charge of nothing. */
double explosion_impulse_pas(double explosive_kg, double distance_m);

/* A body that an explosion pushes: a box with the sides of its kind. */
struct explosion_impulse_target {
    const struct kind *kind;
    struct vec3 centre; /* [m, world] of the box */
    struct mat3 turn;   /* world = turn * body */
};

struct explosion_impulse {
    struct vec3 impulse_ns; /* along the line from the charge to the centre */
    struct vec3 point;      /* [m, world] where it acts */
};

/* Returns the whole impulse of a round's charge on the body: the impulse per area times the area
 * that the box shows to the charge. Both the impulse per area and the point follow from its values
 * at eight points of the box (Gauss's rule with two points an axis), so the nearer end is pushed
 * harder and the body turns away. A charge at the centre pushes nothing. */
struct explosion_impulse explosion_impulse_on(const struct explosion_impulse_target *target,
                                              struct vec3 charge, double explosive_kg);

/* Returns true if a land vehicle that gets this impulse at its centre of mass [N s, along its own
 * axes] goes over the edge of its track or of its front or rear: if the energy of its rotation
 * about that edge on the ground lifts the centre of mass over the edge. The wheels do not slide
 * meanwhile, so this overstates how easily a vehicle overturns on ice, and not on soil that they
 * dig into. */
bool explosion_impulse_overturns(const struct kind *kind, double forward_ns, double right_ns);

#endif
