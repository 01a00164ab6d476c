/* Fights: how row i moves and fires in an attack. Any thread, each its own row. */
#ifndef JOLON_MOVER_FIGHT_H
#define JOLON_MOVER_FIGHT_H

#include "mover/doctrine.h"
#include "mover/move.h"

/* What it wants of its body, in the manner of its doctrine. */
void fight_wish(const struct move *move, uint32_t i, const struct doctrine_table *table,
                struct wish *wish);

/* Frames between two shots that an agent with a loaded gun tries. */
uint32_t fight_aim(const struct params *params);

/* Is it about to fire: in an attack, its target in sight and about within range, its gun loaded?
 * Costs next to nothing; whether the gun bears is turret.h's. */
bool fight_ready(const struct move *move, uint32_t i);

#endif
