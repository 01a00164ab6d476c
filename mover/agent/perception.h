/* The percepts of an agent in this frame. Reads the committed world and row i of the moved table.
 * Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_PERCEPTION_H
#define JOLON_MOVER_AGENT_PERCEPTION_H

#include "mover/agent/behaviour_table.h"
#include "mover/context/step_context.h"

struct params;

struct notice {
    uint32_t percepts;      /* bits 1 << enum perceived */
    uint32_t threat, enemy; /* rows: a vehicle that fired at it, an enemy that it sees; SLOT_NONE */
};

#define PERCEPTION_BIT(name) (1u << PERCEPT_##name)

/* Frames from one decision of an agent to the next (a tenth of a second), and from one look to the
 * next (a second). In a world of many vehicles they are more, so that the decisions and the looks
 * of a frame stay below a number. */
uint32_t perception_think_frames(const struct params *params, uint32_t used);
uint32_t perception_look_frames(const struct params *params, uint32_t used);

/* Returns true if the agent of row i decides in this frame in its turn. Those that follow a script
 * all do so at once, in the first frame of each tenth of a second, so that they decide at the same
 * times at any rate of frames. */
bool perception_decides(const struct step_context *context, uint32_t i);

/* Returns true if row i decides where to drive: in its turn, or because a stretch begins in which
 * its turn falls. */
bool perception_looks_out(const struct step_context *context, uint32_t i);

/* Returns true if an event has happened to row i, so that it decides in this frame even if it is
 * not due. */
bool perception_event(const struct step_context *context, uint32_t i);

/* All percepts of row i. Clears the events (shot at, bumped) in its row. */
struct notice perception_notice(const struct step_context *context, uint32_t i);

/* Returns true if row i can fire and may fire. */
bool perception_armed(const struct step_context *context, uint32_t i);

/* Returns true if it saw its target within its last two looks. */
bool perception_in_sight(const struct step_context *context, uint32_t i);

/* Returns true if the row counts as hurt in the next frame, unless it is hurt again. */
bool perception_hurt_soon(const struct step_context *context, uint32_t i);

/* Returns true if row i, whose order is to stand, goes on standing until an event: no row of its
 * table applies, and none would if it looked for enemies or at its fuel. */
bool perception_settled(const struct step_context *context, uint32_t i);

#endif
