/* Union-find; the sums of a group are kept at its first body, and then copied. */
#include "supervisor/physics/joined_bodies.h"

static uint32_t root_of(struct body_look *body, uint32_t index)
{
    while (body[index].together.first != index)
        index = body[index].together.first = body[body[index].together.first].together.first;
    return index;
}

static void begin(struct body_look *body, uint32_t index)
{
    double before = body->known ? vec3_length(body->was->velocity) : 0.0;
    body->together = (struct joined_bodies){
        .first = index,
        .impacts = body->struck > body->hits ? body->struck : body->hits,
        .presses = body->presses,
        .fastest_mps = body->finite ? maths_max(before, vec3_length(body->now.velocity)) : 0.0,
        .parts = body->parts > 0 || body->parted > 0};
}

/* The lower root becomes that of both. */
static void join(struct body_look *body, const struct neighbour_pair *pair)
{
    uint32_t a = root_of(body, pair->a), b = root_of(body, pair->b);
    if (a == b)
        return;
    struct joined_bodies *of = &body[a < b ? a : b].together,
                         *other = &body[a < b ? b : a].together;
    other->first = a < b ? a : b;
    of->impacts += other->impacts;
    of->presses += other->presses;
    of->fastest_mps = maths_max(of->fastest_mps, other->fastest_mps);
    of->parts |= other->parts;
}

void joined_bodies_find(struct body_looks *looks, const struct neighbour_pairs *touching)
{
    for (uint32_t i = 0; i < looks->count; i++)
        begin(&looks->body[i], i);
    for (uint32_t i = 0; i < touching->count; i++)
        join(looks->body, &touching->pair[i]);
    for (uint32_t i = 0; i < looks->count; i++) {
        const struct joined_bodies group = looks->body[root_of(looks->body, i)].together;
        looks->body[i].together = group;
    }
}
