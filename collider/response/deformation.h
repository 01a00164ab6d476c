/* Energy into harm and dents, for one body (thesis rows 26, 33, 47): rigidity decides how much of a
 * blow harms at once and how far the skin gives way, moldability how much of that stays. Pure; any
 * thread. */
#ifndef JOLON_COLLIDER_RESPONSE_DEFORMATION_H
#define JOLON_COLLIDER_RESPONSE_DEFORMATION_H

#include "world/entity/kind.h"

/* A kind's crush length over its smallest dimension: so deep is a body without rigidity dented by
 * the blow that destroys it. Deeper than half, dents from both sides would meet. */
#define DEFORMATION_LENGTH 0.25

/* Dents less deep than this are none [m]: they could not be seen, and every graze would leave one.
 */
#define DEFORMATION_DENT_LEAST_M 0.01

struct deformation {
    double harm_j; /* for damage_row(); the rest of the energy warms the skin that springs back */
    double plastic_m; /* depth of the dent that stays */
    double elastic_m; /* depth that comes back, world/entity/dent.h says how fast */
};

/* What a blow does to a body that takes so much of its energy [J]. The depth grows evenly with the
 * energy up to the kind's resistance_j. Energy that is not above 0 does nothing. */
struct deformation deformation_of(const struct kind *kind, double joules);

#endif
