/* The search for a kind by its name. */
#include "world/entity/kind.h"

#include <string.h>

uint16_t kind_find(const struct kind *kinds, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strncmp(kinds[i].name, name, KIND_NAME_MAX) == 0)
            return (uint16_t)i;
    }
    return KIND_NONE;
}
