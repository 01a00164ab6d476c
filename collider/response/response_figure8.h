/* What belongs to figure 8 of the thesis (p. 22) beyond the two answers in
 * collider/response/response.h. */
#ifndef JOLON_COLLIDER_RESPONSE_RESPONSE_FIGURE8_H
#define JOLON_COLLIDER_RESPONSE_RESPONSE_FIGURE8_H

#include "collider/response/response.h"

/* Figure 8 as printed: damage of a fixed object by the mass of what struck it and nothing else, the
 * measure "mass" (thesis row 27). From mass_c1_kg on it is high, from mass_c2_kg medium, from
 * mass_c3_kg low, below that none: the figure's fourth constant only says once more where none
 * begins, and what it leaves open between the third and the fourth is none as well. Returns the
 * damage that the object has now. damage_fixed_object() is the measure "energy". */
enum damage damage_fixed_mass(struct response_context *respond, uint32_t object, double mass_kg);

#endif
