/* Rows for new entities. */
#ifndef JOLON_MOVER_WEAPON_SPAWN_H
#define JOLON_MOVER_WEAPON_SPAWN_H

#include "mover/context/serial_context.h"

struct state_head;

/* Makes a free row an active entity of this kind, at rest, and returns it; the caller places it.
 * SLOT_NONE, and counted as refused, when the table is full. */
uint32_t spawn_entity(struct serial_context *context, uint16_t kind, uint8_t force);

/* Frees a row. */
void spawn_remove(struct serial_context *context, uint32_t row);

/* Returns how many rows new entities are placed in: a row for each entity, spare rows so that a
 * free row is not used again at once, and at most capacity. Pictures show the trail of an entity
 * until its row is used again. */
uint32_t spawn_roof(const struct state_head *head, uint32_t capacity);

/* Ends the rows in use after the last row that is not free, but not below the roof. Free rows are
 * zero, so a reference to a row beyond the end is void. Call it when the frame has made and removed
 * all entities. Not in a frame in which time stands still: its contacts are copied as they are, and
 * may name a row that a command has freed. */
void spawn_fall_back(struct serial_context *context);

#endif
