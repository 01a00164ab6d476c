/* Numbers and words into JSON. */
#include "ipc/topics/json_members.h"

#include <math.h>
#include <stdio.h>

void put_number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        (void)cJSON_AddNumberToObject(object, key, value);
    else
        (void)cJSON_AddNullToObject(object, key);
}

void put_whole(cJSON *object, const char *key, uint64_t value)
{
    char text[24];
    (void)snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    (void)cJSON_AddRawToObject(object, key, text);
}

cJSON *put_float(float value)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.9g", (double)value);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

void put_single(cJSON *object, const char *key, float value)
{
    (void)cJSON_AddItemToObject(object, key, put_float(value));
}

void put_word(cJSON *object, const char *key, const char *text)
{
    (void)cJSON_AddStringToObject(object, key, text);
}
