/* One entry for each hash of a pair. */
#include "collider/narrow_phase/axis_memory.h"

#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#define ENTRIES_MIN 1024u

int axis_memory_init(struct axis_memory *memory, const struct world *world)
{
    uint32_t entries = ENTRIES_MIN;
    while (entries < world->params->contact_slots)
        entries *= 2;
    *memory = (struct axis_memory){.entry = reserve_take(entries, sizeof *memory->entry),
                                   .mask = entries - 1};
    return memory->entry ? 0 : -1;
}

void axis_memory_free(struct axis_memory *memory)
{
    reserve_free(memory->entry);
    *memory = (struct axis_memory){0};
}

static struct remembered_axis *place_of(const struct axis_memory *memory, const struct pair *pair)
{
    uint64_t hash = ((uint64_t)pair->a << 32 | pair->b) * 0x9e3779b97f4a7c15u;
    return &memory->entry[hash >> 40 & memory->mask];
}

struct remembered_axis axis_memory_recall(const struct axis_memory *memory, const struct pair *pair)
{
    const struct remembered_axis *entry = place_of(memory, pair);
    if (entry->pair.a == pair->a && entry->pair.b == pair->b)
        return *entry;
    return (struct remembered_axis){.pair = *pair};
}

void axis_memory_keep(struct axis_memory *memory, const struct remembered_axis *axis)
{
    *place_of(memory, &axis->pair) = *axis;
}
