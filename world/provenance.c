/* The provenance of a world. */
#include "world/provenance.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROOM_BYTES 4096u /* room for it is a multiple of this */

int provenance_add(struct provenance *recipe, const char *key, const char *value)
{
    size_t length = strlen(key) + 1 + strlen(value) + 1;
    if (length > PROVENANCE_BYTES_MAX - recipe->bytes) {
        errno = EOVERFLOW;
        return -1;
    }
    char *longer = realloc(recipe->text, recipe->bytes + length);
    if (!longer)
        return -1;
    snprintf(longer + recipe->bytes, length, "%s=%s", key, value);
    recipe->text = longer;
    recipe->bytes += (uint32_t)length;
    return 0;
}

void provenance_free(struct provenance *recipe)
{
    free(recipe->text);
    *recipe = (struct provenance){0};
}

uint32_t provenance_room(uint32_t bytes)
{
    return (bytes / ROOM_BYTES + 1) * ROOM_BYTES;
}

const char *provenance_next(const char *text, uint32_t bytes, uint32_t *at)
{
    if (*at >= bytes || text[*at] == '\0')
        return NULL;
    const char *next = text + *at;
    const char *end = memchr(next, '\0', bytes - *at);
    *at = end ? (uint32_t)(end - text) + 1 : bytes;
    return end ? next : NULL;
}

const char *provenance_value(const char *text, const char *key)
{
    size_t length = strlen(key);
    return strncmp(text, key, length) == 0 && text[length] == '=' ? text + length + 1 : NULL;
}

const char *provenance_find(const char *text, uint32_t bytes, const char *key)
{
    uint32_t at = 0;
    for (const char *next = provenance_next(text, bytes, &at); next;
         next = provenance_next(text, bytes, &at)) {
        const char *value = provenance_value(next, key);
        if (value)
            return value;
    }
    return NULL;
}
