/* The search for a target: which enemy a crew finds, and when. Reads the committed world and row i
 * of the moved table. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_TARGET_SEARCH_H
#define JOLON_MOVER_AGENT_TARGET_SEARCH_H

#include "mover/context/step_context.h"

/* How a crew looks for enemies. */
enum target_search {
    TARGET_SEARCH_CALM, /* it finds an enemy in its view after a random time; one that never flees
                           (ENTITY_FLAG_STAND) finds only those that its rounds may harm */
    TARGET_SEARCH_ALERT /* in a fight: it finds at once an enemy that its rounds may harm */
};

/* Returns a row: an enemy that row i sees and would fire at, or SLOT_NONE. The time to find one is
 * exponential, with a mean of 1 s near by and 30 s at the end of its sight (the form of Nicoll 1994
 * and the NVEOL search model). Crews side by side take different targets. */
uint32_t target_search(const struct step_context *context, uint32_t i, enum target_search how);

/* Returns true if row i sees the other row: in range, within its view, with nothing between,
 * not even smoke. */
bool target_search_sees(const struct step_context *context, uint32_t i, uint32_t other);

/* The eye of row i, and the point of row i that others look at [m, world]. */
struct vec3 target_search_eye(const struct step_context *context, uint32_t i);
struct vec3 target_search_middle(const struct step_context *context, uint32_t i);

#endif
