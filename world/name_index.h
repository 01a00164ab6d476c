/* Finds the initial vehicles of a world by their names. */
#ifndef JOLON_WORLD_NAME_INDEX_H
#define JOLON_WORLD_NAME_INDEX_H

#include <stdint.h>

struct entity_name;

struct name_index {
    const struct entity_name *names;   /* the caller's, of the initial slots */
    const struct entity_name **sorted; /* by name, since there may be as many lookups as vehicles */
    uint32_t count;
};

/* 0, or -1 with errno ENOMEM. */
int name_index_init(struct name_index *index, const struct entity_name *names, uint32_t count);
void name_index_free(struct name_index *index);

/* Sets the slot of the vehicle with this name, SLOT_NONE for "". 0, or -1: there is none. */
int name_index_find(const struct name_index *index, const char *name, uint32_t *slot);

#endif
