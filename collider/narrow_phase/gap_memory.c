/* One entry for each hash of a pair. */
#include "collider/narrow_phase/gap_memory.h"

#include "world/maths/maths.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>

#define ENTRIES_MIN 1024u
#define AGAIN       4u   /* frames after which a pair is measured again at the earliest */
#define ROUNDING_M  1e-6 /* of distances between bodies */

int gap_memory_init(struct gap_memory *memory, const struct world *world)
{
    uint32_t entries = ENTRIES_MIN;
    while (entries < world->params->contact_slots)
        entries *= 2;
    *memory = (struct gap_memory){.entry = reserve_take(entries, sizeof *memory->entry),
                                  .mask = entries - 1,
                                  .fresh = reserve_take(entries, sizeof *memory->fresh),
                                  .frame = AGAIN};
    if (memory->entry && memory->fresh)
        return 0;
    gap_memory_free(memory);
    errno = ENOMEM;
    return -1;
}

void gap_memory_free(struct gap_memory *memory)
{
    reserve_free(memory->entry);
    reserve_free(memory->fresh);
    *memory = (struct gap_memory){.mask = 0};
}

static struct remembered_gap *place_of(const struct gap_memory *memory, const struct pair *pair)
{
    uint64_t hash = ((uint64_t)pair->a << 32 | pair->b) * 0x9e3779b97f4a7c15u;
    return &memory->entry[hash >> 40 & memory->mask];
}

static const struct remembered_gap *find(const struct gap_memory *memory, const struct pair *pair)
{
    const struct remembered_gap *entry = place_of(memory, pair);
    return entry->pair.a == pair->a && entry->pair.b == pair->b && entry->frame != 0 ? entry : NULL;
}

static struct remembered_shape shape_of(const struct swept_body *body)
{
    return (struct remembered_shape){body->hull, body->scale, body->turret.turret,
                                     body->turret.gun};
}

static bool is_shape(const struct remembered_shape *shape, const struct swept_body *body)
{
    return shape->hull == body->hull && shape->scale == body->scale &&
           shape->turret == body->turret.turret && shape->gun == body->turret.gun;
}

/* Returns how far the points of two bodies have come relative to each other, at most [m]. */
static double come_of(const struct remembered_gap *gap, const struct swept_body *a,
                      const struct swept_body *b)
{
    struct vec3 between = vec3_sub(b->path.at, a->path.at);
    return vec3_length(vec3_sub(between, gap->between)) +
           rotation_rate(gap->turn_a, a->from) * a->bound_m +
           rotation_rate(gap->turn_b, b->from) * b->bound_m + ROUNDING_M;
}

struct gap_bounds gap_memory_recall(const struct gap_memory *memory, const struct pair *pair,
                                    const struct swept_body *a, const struct swept_body *b)
{
    const struct remembered_gap *gap = find(memory, pair);
    if (!gap || !is_shape(&gap->a, a) || !is_shape(&gap->b, b))
        return (struct gap_bounds){0.0, INFINITY};
    double come_m = come_of(gap, a, b);
    return (struct gap_bounds){maths_max(0.0, gap->least_m - come_m), gap->most_m + come_m};
}

bool gap_memory_wants(const struct gap_memory *memory, const struct pair *pair)
{
    const struct remembered_gap *gap = find(memory, pair);
    return !gap || gap->frame + AGAIN <= memory->frame;
}

void gap_memory_note(struct gap_memory *memory, const struct pair *pair, const struct swept_body *a,
                     const struct swept_body *b, double gap_m, double far_m)
{
    uint32_t place = atomic_fetch_add_explicit(&memory->fresh_count, 1, memory_order_relaxed);
    if (place > memory->mask)
        return;
    memory->fresh[place] = (struct remembered_gap){
        .pair = *pair,
        .frame = memory->frame,
        .a = shape_of(a),
        .b = shape_of(b),
        .turn_a = a->from,
        .turn_b = b->from,
        .between = vec3_sub(b->path.at, a->path.at),
        .least_m = maths_min(gap_m, far_m),
        .most_m = gap_m <= far_m ? gap_m : INFINITY,
    };
}

void gap_memory_settle(struct gap_memory *memory)
{
    for (uint32_t i = 0; i < memory->fresh_count && i <= memory->mask; i++)
        *place_of(memory, &memory->fresh[i].pair) = memory->fresh[i];
    memory->fresh_count = 0;
    memory->frame++;
}
