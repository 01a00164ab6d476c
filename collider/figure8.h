/* What belongs to figure 8 of the thesis (p. 22) beyond the two answers in collider/respond.h. */
#ifndef JOLON_COLLIDER_FIGURE8_H
#define JOLON_COLLIDER_FIGURE8_H

#include "collider/respond.h"

/* Figure 8 as printed: damage of a fixed object by the mass of what struck it and nothing else, the
 * measure "mass" (thesis row 27). From mass_c1_kg on it is high, from mass_c2_kg medium, from
 * mass_c3_kg low, below that none: the figure's fourth constant only says once more where none
 * begins, and what it leaves open between the third and the fourth is none as well. Returns the
 * damage that the object has now. harm_fixed() is the measure "energy". */
enum damage harm_fixed_mass(struct respond *respond, uint32_t object, double mass_kg);

#endif
