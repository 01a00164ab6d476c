/* Fires smoke grenades, and asks for the smoke between two vehicles. */
#include "mover/agent/smoke_screen.h"

#include "world/entity/smoke.h"
#include "world/state.h"
#include "world/world.h"

void smoke_screen_fire(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    bool launchers = kind->doctrine == DOCTRINE_ARMOUR || kind->doctrine == DOCTRINE_FLAK;
    if (launchers && kind->domain == DOMAIN_LAND &&
        smoke_age_s(m, kind, i, context->tick, context->dt_s) >= SMOKE_AGAIN_S)
        m->row[i].owner_slot = (uint32_t)context->tick;
}

bool smoke_screen_between(const struct step_context *context, uint32_t a, uint32_t b)
{
    const struct entities *w = &context->committed->entities;
    const struct kind *kinds = context->world->kinds;
    struct vec3 to =
        vec3_sub(step_context_position(context, w, b), step_context_position(context, w, a));
    return smoke_hides(w, &kinds[w->row[a].kind], a, to, context->tick, context->dt_s) ||
           smoke_hides(w, &kinds[w->row[b].kind], b, vec3_scale(to, -1.0), context->tick,
                       context->dt_s);
}
