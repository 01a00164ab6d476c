/* The step's serial half: what reaches beyond one row (new entities, shots, answers to commands),
 * done in a fixed order after every row has been moved. */
#ifndef JOLON_MOVER_CONTEXT_SERIAL_CONTEXT_H
#define JOLON_MOVER_CONTEXT_SERIAL_CONTEXT_H

#include "mover/context/step_context.h"
#include "mover/step.h"

struct serial_context {
    const struct step_context *move;
    struct moved *moved;
    struct moved_pieces *pieces;
};

/* Whoever makes a row, or changes one beside moving it, says which columns (COLUMN_BIT): they are
 * hashed again. */
static inline void serial_context_changes(struct serial_context *serial, uint32_t row,
                                          uint64_t columns)
{
    serial->pieces->changed[row / CHECKSUM_ROWS] |= columns;
}

/* spawn.c: a free row made into an active entity of this kind at rest, SLOT_NONE when the table is
 * full (counted in the tally). Life, ids and counts are set; the caller places it. */
uint32_t spawn_entity(struct serial_context *serial, uint16_t kind, uint8_t force);
void spawn_remove(struct serial_context *serial, uint32_t row);

/* Appends an intent and returns it zeroed but for its type; NULL when the frame has no room. */
struct event *serial_context_intent(struct serial_context *serial, enum event_type type);
struct event_party serial_context_party(const struct serial_context *serial, uint32_t row);

/* fire.c: row fires its munition at target's row, or ahead when SLOT_NONE. False when it has no
 * munition or no room for another entity or event; nothing has changed then. */
bool fire_shoot(struct serial_context *serial, uint32_t shooter, uint32_t target,
                uint16_t munition);
/* The same at a point on the ground. */
bool fire_shoot_at(struct serial_context *serial, uint32_t shooter, double x, double z,
                   uint16_t munition);
/* A munition of this kind falls on the ground at (x, z). */
bool fire_drop_bomb(struct serial_context *serial, uint16_t munition, double x, double z);

/* command_apply.c: applies what the rings hold, before anything moves. */
void command_apply_all(struct serial_context *serial, const struct command_source *sources);

#endif
