/* A fixed object that breaks, or bends aside, before a vehicle: energy and momentum (thesis rows 28
 * and 32). Pure; any thread.
 *
 * First the vehicle breaks what holds the object. That takes the object's strength from the
 * vehicle's energy; its impulse goes into the ground. Then the vehicle takes the loose part with
 * it: both leave with a common speed, and momentum is conserved. */
#ifndef JOLON_COLLIDER_RESPONSE_BREAKING_H
#define JOLON_COLLIDER_RESPONSE_BREAKING_H

#include "world/entity/kind.h"

#include <stdbool.h>

struct breaking_input {
    double striker_kg;  /* > 0: effective mass of the vehicle at the contact, along the normal */
    double closing_mps; /* >= 0 */
    double strength_j;  /* >= 0: breaks the object; 0 if it only bends */
    double debris_kg;   /* >= 0: the part that moves */
};

struct breaking {
    bool breaks;       /* false: the energy is less than the strength; nothing else is set */
    double speed_mps;  /* of vehicle and debris along the normal, 0..closing_mps */
    double impulse_ns; /* on the vehicle, against the normal: to the fixing and to the debris */
    double lost_j; /* strength_j, and what debris and vehicle crush of each other. With the kinetic
                      energies of both afterwards this is the vehicle's energy before. */
};

struct breaking breaking_of(const struct breaking_input *input);

/* Returns the mass that moves with the vehicle when the object breaks [kg]; height_m: of the
 * contact over the object's foot.
 *
 * A bush moves as a whole. A tree or pole is a free rod: struck at a height, it resists like
 * M / (1 + 12 (height / H - 1/2)^2), a quarter of its mass at its foot. Of all others the part of
 * the outer walls moves that is before the vehicle, by its width and height; what falls from above
 * is not counted. */
double breaking_debris_kg(const struct kind *object, const struct kind *striker, double height_m);

#endif
