/* A world's values as JSON. These functions end the process (exit 1) when cJSON has no memory. */
#ifndef JOLON_IPC_JSON_WORLD_JSON_H
#define JOLON_IPC_JSON_WORLD_JSON_H

#include "world/event_text.h"

#include <cjson/cJSON.h>
#include <stdint.h>

struct event;
struct world;

void json_text(cJSON *object, const char *key, const char *text);
void json_number(cJSON *object, const char *key, double value); /* null if not finite */
void json_whole(cJSON *object, const char *key, uint64_t value);
void json_bool(cJSON *object, const char *key, int value);
void json_hex(cJSON *object, const char *key, uint64_t value); /* 16 digits */
/* Writes a float with 9 significant digits, which restore it exactly. */
void json_single(cJSON *object, const char *key, float value);
void json_triple(cJSON *object, const char *key, double x, double y, double z);
void json_triple_single(cJSON *object, const char *key, const float value[3]);
cJSON *json_object(cJSON *object, const char *key);
cJSON *json_array(cJSON *object, const char *key);

/* Prints the document on one line to standard output, and frees it. */
void json_print(cJSON *object);

/* Adds an event's type and the members of that type, as docs/events.md describes them. kind: the
 * names of its parties' kinds. */
void json_event_members(cJSON *object, const struct event *event,
                        const char *const kind[EVENT_TEXT_PARTIES]);

/* Returns a new object of an event with its frame, index and time. */
cJSON *json_event(const struct world *world, const struct event *event);

#endif
