/* Parses and checks the bodies of requests. Pure.
 *
 * A command is as in ipc/topics/command_json.h. A command that passes is well-formed; only the
 * mover knows whether the world can do it now. */
#ifndef JOLON_CLIENTS_CONSOLE_REQUEST_BODY_H
#define JOLON_CLIENTS_CONSOLE_REQUEST_BODY_H

#include "clients/console/http_answer.h"
#include "clients/console/players.h"
#include "ipc/topics/command_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define REQUEST_BODY_ROLE_MAX 16u

/* Reads a command, in which the vehicle may be missing (0: the player's own), or the number of a
 * fire mission to cancel; cancel is 0 for a command. Returns false with the answer. */
bool request_body_order(struct command_text *order, uint32_t *cancel, const char *body,
                        size_t bytes, struct http_answer *answer);

/* Reads {"name": NAME}, and {"do": "kill" | "restart", "role": ROLE}. */
bool request_body_join(char name[PLAYERS_NAME_MAX], const char *body, size_t bytes,
                       struct http_answer *answer);
bool request_body_process(bool *restart, char role[REQUEST_BODY_ROLE_MAX], const char *body,
                          size_t bytes, struct http_answer *answer);

#endif
