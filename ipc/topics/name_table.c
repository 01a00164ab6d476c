/* Names of vehicles, sorted by id. */
#include "ipc/topics/name_table.h"

#include "world/entity/remote.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

void name_table_close(struct name_table *names)
{
    free(names->entry);
    *names = (struct name_table){0};
}

bool name_table_copy(struct name_table *names, const jolon_EntityNames *sample)
{
    uint32_t count = sample->names._length;
    jolon_EntityName *entry = malloc((count + 1) * sizeof *entry);
    if (!entry)
        return false;
    if (count)
        memcpy(entry, sample->names._buffer, count * sizeof *entry);
    name_table_close(names);
    names->entry = entry;
    names->count = count;
    names->run = sample->run;
    names->known = true;
    return true;
}

bool name_table_read_world(struct name_table *names, const struct world *world, uint64_t run)
{
    uint32_t named = 0;
    for (uint32_t id = 1; id <= world->counts.names && named < jolon_NAMES_MAX; id++)
        named += world_entity_name(world, id)[0] != '\0';
    jolon_EntityName *entry = calloc(named + 1, sizeof *entry);
    if (!entry)
        return false;
    name_table_close(names);
    for (uint32_t id = 1; names->count < named; id++) {
        if (!world_entity_name(world, id)[0])
            continue;
        jolon_EntityName *to = &entry[names->count++];
        to->id = id;
        (void)stpncpy(to->name, world_entity_name(world, id), sizeof to->name - 1);
    }
    names->entry = entry;
    names->run = run;
    names->known = true;
    return true;
}

static int by_id(const void *a, const void *b)
{
    const jolon_EntityName *first = a, *second = b;
    return (first->id > second->id) - (first->id < second->id);
}

bool name_table_add_markings(struct name_table *names, const struct entities *e, uint32_t used)
{
    uint32_t most = names->count;
    for (uint32_t row = 0; row < used && most < jolon_NAMES_MAX; row++)
        most += e->row[row].state != ENTITY_FREE && remote_is(e, row);
    jolon_EntityName *entry = calloc(most + 1, sizeof *entry);
    if (!entry)
        return false;
    if (names->count > 0)
        memcpy(entry, names->entry, names->count * sizeof *entry);
    free(names->entry);
    names->entry = entry;
    for (uint32_t row = 0; row < used && names->count < most; row++) {
        char marking[REMOTE_MARKING_MAX + 1];
        if (e->row[row].state == ENTITY_FREE || !remote_is(e, row))
            continue;
        remote_marking(e, row, marking);
        if (marking[0] == '\0')
            continue;
        jolon_EntityName *to = &entry[names->count++];
        to->id = e->row[row].id;
        (void)stpncpy(to->name, marking, sizeof to->name - 1);
    }
    qsort(entry, names->count, sizeof *entry, by_id);
    return true;
}

const char *name_table_of(const struct name_table *names, uint32_t id)
{
    uint32_t low = 0, high = names->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (names->entry[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < names->count && names->entry[low].id == id ? names->entry[low].name : "";
}

uint32_t name_table_find(const struct name_table *names, const char *name)
{
    for (uint32_t i = 0; i < names->count; i++) {
        if (strcmp(names->entry[i].name, name) == 0)
            return names->entry[i].id;
    }
    return 0;
}
