/* Percepts: what an agent notices in this frame. Reads the committed world, and row i of the moved
 * table; nothing is changed but what an event leaves behind in row i. Any thread. */
#ifndef JOLON_MOVER_AGENT_PERCEPTION_H
#define JOLON_MOVER_AGENT_PERCEPTION_H

#include "mover/agent/behaviour_table.h"
#include "mover/context/step_context.h"

struct params;

struct notice {
    uint32_t percepts;      /* bits 1 << enum percept */
    uint32_t threat, enemy; /* rows: who fired, whom it sees; SLOT_NONE */
};

#define PERCEPTION_BIT(name) (1u << PERCEPT_##name)

/* Frames between two thoughts of one agent: a tenth of a second's; and between two of its looks: a
 * second's. More in a world of so many vehicles that they would think or look too often together.
 */
uint32_t perception_think_frames(const struct params *params, uint32_t used);
uint32_t perception_look_frames(const struct params *params, uint32_t used);

/* Did something happen to row i that it must notice now, whoever's turn it is? */
bool perception_event(const struct step_context *context, uint32_t i);

/* All that row i notices. Takes the events (shot at, bumped) out of its row. */
struct notice perception_notice(const struct step_context *context, uint32_t i);

/* Does row i see that other row: near enough, within its view, nothing between? */
bool perception_sees(const struct step_context *context, uint32_t i, uint32_t other);

/* The eye of row i, and the point of it that others look for [m, world]. */
struct vec3 perception_eye(const struct step_context *context, uint32_t i);
struct vec3 perception_middle(const struct step_context *context, uint32_t i);

/* Can row i fire, and may it? */
bool perception_armed(const struct step_context *context, uint32_t i);

/* Has it seen its target lately, so that it knows where to aim? */
bool perception_in_sight(const struct step_context *context, uint32_t i);

#endif
