/* Single contacts under impulses. */
#ifndef JOLON_COLLIDER_RESPONSE_CONTACT_IMPULSE_H
#define JOLON_COLLIDER_RESPONSE_CONTACT_IMPULSE_H

#include "collider/response/island.h"

/* Returns true if the fixed object bends aside or breaks, so that the row continues more slowly.
 * Nothing else needs to be done about the contact then. */
bool contact_impulse_gives_way(struct response_context *context, struct island_contact *met);

/* Returns the solver's contact: normal, restitution, friction. bodies are those of the contact. */
struct solver_contact contact_impulse_contact(const struct response_context *context,
                                              const struct island_contact *met,
                                              const struct solver_body bodies[2]);

/* Applies the lost energy to both sides and writes the event. */
void contact_impulse_damage(struct response_context *context, struct island_contact *met,
                            const struct solver_contact *contact);

/* Returns the kind of a row, or of a fixed object with PAIR_FIXED. */
const struct kind *contact_impulse_kind(const struct response_context *context, uint32_t body);

/* Returns the velocity of the body at a point [m/s]. */
struct vec3 contact_impulse_velocity(const struct solver_body *body, struct vec3 point);

#endif
