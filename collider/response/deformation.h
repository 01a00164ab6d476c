/* Energy becomes damage and dents of one body (thesis rows 26, 33, 47): rigidity decides how much
 * of the energy is damage at once and how far the skin gives way, moldability how much of that
 * remains. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESPONSE_DEFORMATION_H
#define JOLON_COLLIDER_RESPONSE_DEFORMATION_H

#include "world/entity/kind.h"

/* A kind's crush length over its smallest dimension: the depth of the dent by which a body without
 * rigidity is destroyed. Above half, dents from both sides would meet. */
#define DEFORMATION_LENGTH 0.25

/* Shallower dents are left out [m]: they would be invisible, and every light contact would leave
 * one. */
#define DEFORMATION_DENT_LEAST_M 0.01

struct deformation {
    double harm_j;    /* for damage_row(); the rest of the energy is lost in the elastic part */
    double plastic_m; /* depth of the dent that remains */
    double elastic_m; /* depth that recovers (world/entity/dent.h says how fast) */
};

/* Returns what an impact does to a body that absorbs this energy [J]. The depth grows linearly with
 * the energy up to the kind's resistance_j. Energy that is not above 0 has no effect. */
struct deformation deformation_of(const struct kind *kind, double joules);

#endif
