/* The last shots. */
#include "gateway/shot_memory.h"

struct shot shot_memory_of(const struct remote_record *record, uint64_t now_ns)
{
    return (struct shot){.event = record->event,
                         .firer = record->remote,
                         .type = record->type,
                         .entity = record->entity,
                         .kind = record->kind,
                         .heard_ns = now_ns};
}

void shot_memory_note(struct shot_memory *memory, const struct shot *shot)
{
    if (shot->event != 0)
        memory->shot[memory->count++ & (SHOT_MEMORY_EVENTS - 1)] = *shot;
}

/* Returns the number of shots that are remembered. */
static uint32_t remembered(const struct shot_memory *memory)
{
    return memory->count < SHOT_MEMORY_EVENTS ? memory->count : SHOT_MEMORY_EVENTS;
}

/* Returns a shot by its age, 0 for the last. */
static const struct shot *aged(const struct shot_memory *memory, uint32_t age)
{
    return &memory->shot[(memory->count - 1 - age) & (SHOT_MEMORY_EVENTS - 1)];
}

static bool within(const struct shot *shot, double seconds, uint64_t now_ns)
{
    return now_ns - shot->heard_ns <= (uint64_t)(seconds * 1e9);
}

static bool same_place(const struct shot *a, const struct shot *b)
{
    return !a->placed || !b->placed ||
           vec3_length(vec3_sub(a->place, b->place)) <= SHOT_MEMORY_COPY_M;
}

bool shot_memory_has(const struct shot_memory *memory, const struct shot *shot)
{
    for (uint32_t age = 0; shot->event != 0 && age < remembered(memory); age++) {
        const struct shot *old = aged(memory, age);
        if (!within(old, SHOT_MEMORY_COPY_S, shot->heard_ns))
            return false; /* and so are all that are older */
        if (old->event == shot->event && old->type == shot->type && old->firer == shot->firer &&
            old->entity == shot->entity && old->kind == shot->kind && same_place(old, shot))
            return true;
    }
    return false;
}

const struct shot *shot_memory_fire(const struct shot_memory *memory, uint64_t event,
                                    uint64_t firer, uint64_t now_ns)
{
    for (uint32_t age = 0; event != 0 && age < remembered(memory); age++) {
        const struct shot *old = aged(memory, age);
        if (!within(old, SHOT_MEMORY_FLIGHT_S, now_ns))
            return NULL;
        if (old->event == event && old->type == REMOTE_FIRE && old->firer == firer)
            return old;
    }
    return NULL;
}
