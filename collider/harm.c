/* Energy into damage (thesis rows 26, 27, 30). A body takes harm until its kind's resistance_j is
 * reached; a fixed object is damaged by the single hardest blow, as in figure 8. */
#include "collider/respond.h"

static enum damage level(double share)
{
    if (share >= 1.0)
        return DAMAGE_DESTROYED;
    if (share >= 0.6)
        return DAMAGE_HIGH;
    if (share >= 0.3)
        return DAMAGE_MED;
    return share >= 0.1 ? DAMAGE_LOW : DAMAGE_NONE;
}

int harm_destroy(struct respond *respond, uint32_t row, double time)
{
    struct entities *e = &respond->next->entities;
    const struct kind *kind = &respond->world->kinds[e->kind[row]];
    if (e->state[row] != ENTITY_ACTIVE)
        return 0;
    e->state[row] = ENTITY_WRECK;
    e->behaviour[row] = e->order[row] = BEHAVIOUR_IDLE;
    e->damage[row] = DAMAGE_DESTROYED;
    e->harm_j[row] = maths_max(e->harm_j[row], kind->resistance_j);
    e->changed_tick[row] = (uint32_t)respond->next->head->tick;
    respond->next->head->tally.destroyed++;
    struct charge charge = {.point = path_at(&respond->path[row], time),
                            .time = time,
                            .explosive_kg = kind->explosive_kg};
    return kind->explosive_kg > 0.0 ? blast_charge(respond, &charge) : 0;
}

int harm_row(struct respond *respond, uint32_t row, double joules, double time)
{
    struct entities *e = &respond->next->entities;
    const struct kind *kind = &respond->world->kinds[e->kind[row]];
    if (e->state[row] != ENTITY_ACTIVE || !(joules > 0.0))
        return 0;
    e->harm_j[row] += joules;
    enum damage damage = level(e->harm_j[row] / kind->resistance_j);
    if (damage == DAMAGE_DESTROYED)
        return harm_destroy(respond, row, time);
    if (damage > e->damage[row]) {
        e->damage[row] = (uint8_t)damage;
        e->changed_tick[row] = (uint32_t)respond->next->head->tick;
    }
    return 0;
}

enum damage harm_fixed(struct respond *respond, uint32_t object, double joules)
{
    const struct world *world = respond->world;
    const struct collision_params *limits = &world->params->collision;
    double share = joules / world->kinds[world->fixed[object].kind].resistance_j;
    enum damage damage = share >= limits->damage_high  ? DAMAGE_HIGH
                         : share >= limits->damage_med ? DAMAGE_MED
                         : share >= limits->damage_low ? DAMAGE_LOW
                                                       : DAMAGE_NONE;
    uint8_t *now = &respond->next->fixed_damage[object];
    if (damage > *now) {
        *now = (uint8_t)damage;
        respond->next->head->tally.fixed_damaged++;
    }
    return (enum damage) * now;
}
