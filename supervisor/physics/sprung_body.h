/* A land vehicle on its springs as the physics check sees it: a shell over the ground, wheels that
 * bear it or do not, and the energy in their springs. It shares no code with the mover. One
 * thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_SPRUNG_BODY_H
#define JOLON_SUPERVISOR_PHYSICS_SPRUNG_BODY_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/surface.h"

/* Fills what the body's look says about its springs (struct sprung_look). */
void sprung_body_look(const struct surface *surface, struct body_look *body);

/* Measures the shell's depth in the ground, the fall of a vehicle in the air, and the energy of one
 * that nothing but its engine moves. The body's explanations must be complete. */
void sprung_body_measure(struct measures *measures, double dt_s, const struct body_look *body);

#endif
