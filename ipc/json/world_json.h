/* Small additions to cJSON: what a world's values look like as JSON. Memory for a document that is
 * about to be printed has no way to fail but to end the process. */
#ifndef JOLON_IPC_JSON_WORLD_JSON_H
#define JOLON_IPC_JSON_WORLD_JSON_H

#include <cjson/cJSON.h>
#include <stdint.h>

struct event;
struct world;

void json_text(cJSON *object, const char *key, const char *text);
void json_number(cJSON *object, const char *key, double value); /* null when not finite */
void json_whole(cJSON *object, const char *key, uint64_t value);
void json_bool(cJSON *object, const char *key, int value);
void json_hex(cJSON *object, const char *key, uint64_t value); /* 16 digits */
/* A float in as few digits as give it back. */
void json_single(cJSON *object, const char *key, float value);
void json_triple(cJSON *object, const char *key, double x, double y, double z);
void json_triple_single(cJSON *object, const char *key, const float value[3]);
cJSON *json_object(cJSON *object, const char *key);
cJSON *json_array(cJSON *object, const char *key);

/* Prints the document on one line to standard output, and frees it. */
void json_print(cJSON *object);

/* An event as docs/events.md describes it. */
cJSON *json_event(const struct world *world, const struct event *event);

#endif
