/* The bodies of requests, checked to the last member. Pure.
 *
 * An order is one of topics/order_json.h. What passes is well-formed; whether the world can do it
 * now, only the mover knows. */
#ifndef JOLON_CONSOLE_BODY_H
#define JOLON_CONSOLE_BODY_H

#include "console/answer.h"
#include "console/players.h"
#include "topics/order.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BODY_ROLE_MAX 16u

/* Reads a command: an order, to which the vehicle of the player's own need not be said (it is left
 * 0), or the number of a mission to cancel; cancel is 0 for an order. False with the answer. */
bool body_order(struct order *order, uint32_t *cancel, const char *body, size_t bytes,
                struct answer *answer);

/* Reads {"name": NAME}, and {"do": "kill" | "restart", "role": ROLE}. */
bool body_join(char name[PLAYERS_NAME_MAX], const char *body, size_t bytes, struct answer *answer);
bool body_process(bool *restart, char role[BODY_ROLE_MAX], const char *body, size_t bytes,
                  struct answer *answer);

#endif
