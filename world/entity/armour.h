/* Armour and what penetrates it. Pure; any thread.
 *
 * A round of a kind with penetration_mm meets the armour of the side that it comes from. The path
 * through it is thickness / cos(angle), with the angle between the line of flight and the line
 * square to that side. A round that penetrates 0.9 of it never gets through, 1.1 always, and in
 * between the probability rises linearly. */
#ifndef JOLON_WORLD_ENTITY_ARMOUR_H
#define JOLON_WORLD_ENTITY_ARMOUR_H

#include "world/entity/kind.h"
#include "world/maths/maths.h"

#include <stdbool.h>

/* Thinner armour stops nothing: there the energy of a hit counts [mm]. */
#define ARMOUR_LEAST_MM 10.0

/* From this angle on a round without a shaped charge glances off: cos 72 degrees. */
#define ARMOUR_RICOCHET_COSINE 0.309

/* A penetrating round disables a vehicle that resists so many times its energy, or one that resists
 * less. A machine gun's rounds do little inside a carrier. */
#define ARMOUR_INSIDE 4.0

/* What is lost of a round's energy on armour that it does not penetrate: the share that does harm.
 */
#define ARMOUR_OUTSIDE 0.02

enum armour_effect { ARMOUR_NONE, ARMOUR_HOLDS, ARMOUR_DEFLECTS, ARMOUR_PENETRATED };

struct armour_hit {
    enum aspect aspect;
    double cosine;      /* of the angle between the line of flight and the line square to it */
    double path_mm;     /* of steel along the line of flight */
    double probability; /* of penetration */
};

/* What a round strikes. flight, outwards: unit, in axes of the vehicle's body (forward, up, right):
 * the round's direction relative to the vehicle, and the normal of the surface that it strikes. */
struct armour_hit armour_hit_of(const struct kind *vehicle, double penetration_mm,
                                struct vec3 flight, struct vec3 outwards);

/* Returns true if the round may get through a side of the vehicle, from the best range. Without
 * penetration_mm its energy counts, and it always may. from_above: it comes from an aircraft, which
 * also sees the top. */
bool armour_yields(const struct kind *vehicle, const struct kind *round, bool from_above);

/* Returns how far the round may fly and still get through the front or the sides of the vehicle,
 * square to them [m]; 0 where it never does, INFINITY where it always does. */
double armour_reach_m(const struct kind *vehicle, const struct kind *round);

/* Returns what the round still penetrates after flown_m [mm]. */
double armour_penetration(const struct kind *round, double flown_m);

/* luck: uniform in [0, 1). */
enum armour_effect armour_effect_of(const struct kind *vehicle, const struct kind *round,
                                    const struct armour_hit *hit, double luck);

/* What a round costs that penetrates. */
enum armour_loss { ARMOUR_LOSS_MOBILITY, ARMOUR_LOSS_FIRE, ARMOUR_LOSS_ALL };

/* Returns the loss by luck, uniform in [0, 1). */
enum armour_loss armour_loss_of(double luck);

/* Returns true if a round of this energy disables what it finds behind the armour. */
bool armour_disables(const struct kind *vehicle, double joules);

/* Returns the harm of a penetration [J]. By luck, uniform in [0, 1), the vehicle loses its mobility
 * (0.3: medium damage), its fire (0.3: high damage), or is lost (0.4). Two of the first make high
 * damage, and three a loss. joules: energy of the round and its charge. */
double armour_harm(const struct kind *vehicle, double joules, double luck);

#endif
