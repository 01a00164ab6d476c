/* Members of JSON objects. Where cJSON has no memory it makes nothing of nothing, and the text at
 * the end is missing: only that needs a look. */
#ifndef JOLON_IPC_TOPICS_JSON_MEMBERS_H
#define JOLON_IPC_TOPICS_JSON_MEMBERS_H

#include <cjson/cJSON.h>
#include <stdint.h>

/* What is no finite number is null. */
void put_number(cJSON *object, const char *key, double value);

/* Whole numbers beyond what a double holds stay whole. */
void put_whole(cJSON *object, const char *key, uint64_t value);

void put_word(cJSON *object, const char *key, const char *text);

/* As few digits as give a float back; the item itself, and as a member. */
cJSON *put_float(float value);
void put_single(cJSON *object, const char *key, float value);

#endif
