/* The last shots. */
#include "gateway/event_memory.h"

struct told_event event_memory_of(const struct remote_record *record, uint64_t now_ns)
{
    return (struct told_event){.event = record->event,
                               .firer = record->remote,
                               .type = record->type,
                               .entity = record->entity,
                               .kind = record->kind,
                               .heard_ns = now_ns};
}

void event_memory_note(struct event_memory *memory, const struct told_event *shot)
{
    if (shot->event != 0)
        memory->shot[memory->count++ & (EVENT_MEMORY_EVENTS - 1)] = *shot;
}

/* Returns the number of shots that are remembered. */
static uint32_t remembered(const struct event_memory *memory)
{
    return memory->count < EVENT_MEMORY_EVENTS ? memory->count : EVENT_MEMORY_EVENTS;
}

/* Returns a shot by its age, 0 for the last. */
static const struct told_event *aged(const struct event_memory *memory, uint32_t age)
{
    return &memory->shot[(memory->count - 1 - age) & (EVENT_MEMORY_EVENTS - 1)];
}

static bool within(const struct told_event *shot, double seconds, uint64_t now_ns)
{
    return now_ns - shot->heard_ns <= (uint64_t)(seconds * 1e9);
}

static bool same_place(const struct told_event *a, const struct told_event *b)
{
    return !a->placed || !b->placed ||
           vec3_length(vec3_sub(a->place, b->place)) <= EVENT_MEMORY_COPY_M;
}

bool event_memory_has(const struct event_memory *memory, const struct told_event *shot)
{
    for (uint32_t age = 0; shot->event != 0 && age < remembered(memory); age++) {
        const struct told_event *old = aged(memory, age);
        if (!within(old, EVENT_MEMORY_COPY_S, shot->heard_ns))
            return false; /* and so are all that are older */
        if (old->event == shot->event && old->type == shot->type && old->firer == shot->firer &&
            old->entity == shot->entity && old->kind == shot->kind && same_place(old, shot))
            return true;
    }
    return false;
}

const struct told_event *event_memory_fire(const struct event_memory *memory, uint64_t event,
                                           uint64_t firer, uint64_t now_ns)
{
    for (uint32_t age = 0; event != 0 && age < remembered(memory); age++) {
        const struct told_event *old = aged(memory, age);
        if (!within(old, EVENT_MEMORY_FLIGHT_S, now_ns))
            return NULL;
        if (old->event == event && old->type == REMOTE_FIRE && old->firer == firer)
            return old;
    }
    return NULL;
}
