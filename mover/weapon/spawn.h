/* Rows for new entities. */
#ifndef JOLON_MOVER_WEAPON_SPAWN_H
#define JOLON_MOVER_WEAPON_SPAWN_H

#include "mover/context/serial_context.h"

/* Makes a free row an active entity of this kind, at rest, and returns it; the caller places it.
 * SLOT_NONE, and counted as refused, when the table is full. */
uint32_t spawn_entity(struct serial_context *context, uint16_t kind, uint8_t force);

/* Frees a row. */
void spawn_remove(struct serial_context *context, uint32_t row);

#endif
