/* Counts the wrecks of a group. */
#include "mover/agent/losses.h"

#include "world/entity/formation.h"
#include "world/state.h"
#include "world/world.h"

#include <stddef.h>

#define LEAST_GROUP 4u
#define REACH       64u /* slots on each side */

struct losses {
    uint32_t all, lost;
};

static void count(const struct entities *w, uint32_t slot, struct losses *losses)
{
    losses->all++;
    losses->lost += w->row[slot].state != ENTITY_ACTIVE;
}

/* Counts the vehicle that the scenario put into the slot. Another entity may have its slot by now.
 */
static void count_member(const struct entities *w, uint32_t slot, struct losses *losses)
{
    losses->all++;
    losses->lost += !entities_alive(w, slot, slot + 1) || w->row[slot].state != ENTITY_ACTIVE;
}

static bool same_group(const struct entities *w, uint32_t a, uint32_t b)
{
    return w->row[b].state != ENTITY_FREE && w->row[a].kind == w->row[b].kind &&
           w->row[a].force == w->row[b].force && w->row[a].order == w->row[b].order &&
           w->row[a].order_arg == w->row[b].order_arg;
}

/* Counts the vehicles beside row i that have the same kind, force and order. */
static void count_beside(const struct step_context *context, uint32_t i, struct losses *losses)
{
    const struct entities *w = &context->committed->entities;
    uint32_t used = context->committed->head->used;
    count(w, i, losses);
    for (uint32_t n = 1; n <= REACH && n <= i && same_group(w, i, i - n); n++)
        count(w, i - n, losses);
    for (uint32_t n = 1; n <= REACH && i + n < used && same_group(w, i, i + n); n++)
        count(w, i + n, losses);
}

/* Returns the formation of row i, or NULL. A leader is known by its first follower. */
static const struct formation *formation_of(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    uint32_t used = context->committed->head->used;
    for (uint32_t slot = i; slot < used && slot <= i + 1; slot++) {
        if (w->row[slot].order != BEHAVIOUR_FOLLOW ||
            w->row[slot].order_arg >= context->world->counts.formations)
            continue;
        const struct formation *formation = &context->world->formations[w->row[slot].order_arg];
        if (i >= formation->first && i - formation->first < formation->count)
            return formation;
    }
    return NULL;
}

bool losses_half(const struct step_context *context, uint32_t i)
{
    const struct formation *formation = formation_of(context, i);
    struct losses losses = {0, 0};
    if (formation == NULL) {
        count_beside(context, i, &losses);
    } else {
        for (uint32_t n = 0; n < formation->count; n++)
            count_member(&context->committed->entities, formation->first + n, &losses);
    }
    return losses.all >= LEAST_GROUP && 2 * losses.lost >= losses.all;
}
