/* Orders from JSON: {"do":"drive","vehicle":7,"throttle":0.5}. */
#ifndef JOLON_IPC_TOPICS_COMMAND_JSON_H
#define JOLON_IPC_TOPICS_COMMAND_JSON_H

#include "ipc/topics/command_text.h"

#include <cjson/cJSON.h>

/* Reads an order from an object: its verb in "do", and each argument by its name. "id", which
 * belongs to the caller, is ignored. Returns 0, or -1 with the reason: what is wrong and what would
 * be right. */
int command_from_json(struct command_text *order, const cJSON *object, struct error_text *error);

/* As command_from_json(), without command_text_end(): the caller may add missing arguments. */
int command_json_give(struct command_text *order, const cJSON *object, struct error_text *error);

#endif
