/* The bodies of requests, checked to the last member. Pure.
 *
 * An order is one of ipc/topics/command_json.h. What passes is well-formed; whether the world can
 * do it now, only the mover knows. */
#ifndef JOLON_CLIENTS_CONSOLE_REQUEST_BODY_H
#define JOLON_CLIENTS_CONSOLE_REQUEST_BODY_H

#include "clients/console/http_answer.h"
#include "clients/console/players.h"
#include "ipc/topics/command_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define REQUEST_BODY_ROLE_MAX 16u

/* Reads a command: an order, to which the vehicle of the player's own need not be said (it is left
 * 0), or the number of a mission to cancel; cancel is 0 for an order. False with the answer. */
bool request_body_order(struct command_text *order, uint32_t *cancel, const char *body,
                        size_t bytes, struct http_answer *answer);

/* Reads {"name": NAME}, and {"do": "kill" | "restart", "role": ROLE}. */
bool request_body_join(char name[PLAYERS_NAME_MAX], const char *body, size_t bytes,
                       struct http_answer *answer);
bool request_body_process(bool *restart, char role[REQUEST_BODY_ROLE_MAX], const char *body,
                          size_t bytes, struct http_answer *answer);

#endif
