/* Shots: a new munition, its dispersion, and the alarm of its target. */
#ifndef JOLON_MOVER_WEAPON_FIRE_H
#define JOLON_MOVER_WEAPON_FIRE_H

#include "mover/context/serial_context.h"

/* Row shooter fires at row target, or straight ahead for SLOT_NONE. munition KIND_NONE: its kind's
 * own. False, with nothing changed, when it has no munition or the frame has no room for an entity
 * or an event. */
bool fire_shoot(struct serial_context *context, uint32_t shooter, uint32_t target,
                uint16_t munition);

/* The same at a point on the ground. */
bool fire_shoot_at(struct serial_context *context, uint32_t shooter, double x, double z,
                   uint16_t munition);

/* A munition of this kind falls from the sky onto (x, z). */
bool fire_drop_bomb(struct serial_context *context, uint16_t munition, double x, double z);

#endif
