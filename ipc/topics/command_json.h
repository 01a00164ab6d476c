/* Orders from JSON: {"do":"drive","vehicle":7,"throttle":0.5}. */
#ifndef JOLON_IPC_TOPICS_COMMAND_JSON_H
#define JOLON_IPC_TOPICS_COMMAND_JSON_H

#include "ipc/topics/command_text.h"

#include <cjson/cJSON.h>

/* Reads an order out of an object: its verb in "do", and an argument each by its name. "id", which
 * is the caller's own, is not looked at. -1 with the reason: what is wrong and what would be right.
 */
int command_from_json(struct command_text *order, const cJSON *object, struct error_text *error);

/* The same without command_text_end(): the caller may add what was not said. */
int command_json_give(struct command_text *order, const cJSON *object, struct error_text *error);

#endif
