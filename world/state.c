/* The time of a state, and its digest. */
#include "world/state.h"

#include "world/entity/dent.h"
#include "world/entity/persistent_contact.h"
#include "world/maths/hash.h"
#include "world/params.h"
#include "world/terrain/crater.h"
#include "world/world.h"

#include <string.h>

double state_time_s(const struct world *world, const struct state_head *head)
{
    return (double)head->tick * world->params->dt_s;
}

uint64_t state_digest(const struct world *world, const struct state *state)
{
    struct state_head head = *state->head;
    head.checksum = 0;
    head.mover_ns = 0;
    head.time_scale = 0.0; /* pacing: not a property of the frame */
    head.quit = 0;
    /* A world that never had an input of the gateway has the digest that it had before there was a
     * ring for them. */
    const size_t bytes = state_head_bytes(&head), at = offsetof(struct state_head, time_scale);
    const uint64_t inputs = head.command_cursor[RING_GATEWAY];
    memmove(&head.command_cursor[RING_GATEWAY], &head.time_scale, sizeof head - at);
    uint64_t hash = XXH3_64bits(&head, bytes - sizeof inputs);
    if (inputs > 0)
        hash = XXH3_64bits_withSeed(&inputs, sizeof inputs, hash);
    hash = XXH3_64bits_withSeed(&world->params->seed, sizeof world->params->seed, hash);
    hash = XXH3_64bits_withSeed(state->entities.row,
                                state->head->used * sizeof *state->entities.row, hash);
    hash = XXH3_64bits_withSeed(state->fixed_damage, world->counts.fixed, hash);
    hash = XXH3_64bits_withSeed(
        state->contacts, state->head->contact_count * sizeof(struct persistent_contact), hash);
    hash = XXH3_64bits_withSeed(state->craters, state->head->crater_count * sizeof(struct crater),
                                hash);
    return XXH3_64bits_withSeed(state->dents, state->head->dent_count * sizeof(struct dent), hash);
}
