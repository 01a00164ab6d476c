/* The response "impulse": all contacts of a group are solved together. */
#include "collider/response/island.h"
#include "collider/response/response.h"

static void solve(struct response_context *context, uint32_t first, uint32_t bodies)
{
    struct island *island = context->island;
    uint32_t contacts = 0;
    for (uint32_t i = first; i != 0; i = island->met[i - 1].next)
        contacts++;
    contact_solver_island(island->solve, bodies, island->contact, contacts);
}

const struct response_functions response_impulse = {.joint = solve};
