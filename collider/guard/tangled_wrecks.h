/* Wrecks that the guard at the end of a frame sends back because of each other. Each by itself
 * would lose its velocity, and with it momentum that nothing takes up. So they go on together, as
 * after an impact without restitution: with the velocity of their common centre of mass. Pure; one
 * thread. */
#ifndef JOLON_COLLIDER_GUARD_TANGLED_WRECKS_H
#define JOLON_COLLIDER_GUARD_TANGLED_WRECKS_H

#include "collider/response/response_context.h"

#include <stdbool.h>
#include <stdint.h>

struct tangled_wreck {
    uint32_t row;
    uint32_t parent;      /* index of another wreck of its group, or its own */
    struct vec3 velocity; /* [m/s] of its centre of mass before it went back */
    double kinetic_j;     /* before it went back */
    double height_m;      /* of its centre of mass before it went back */
    bool held; /* it lies on the ground, or is deep in a wall or in a body that is no wreck */
};

/* The collider's own memory. */
struct tangled_wrecks {
    struct tangled_wreck *wreck; /* [capacity of the world] of this frame */
    uint32_t count;
    uint32_t *of_row; /* [capacity of the world] 1 + its index in wreck, or 0 */
};

/* Returns 0, or -1 with errno ENOMEM. */
int tangled_wrecks_init(struct tangled_wrecks *tangled, const struct world *world);
void tangled_wrecks_free(struct tangled_wrecks *tangled);

/* Notes that the sides of this pair are deeper in each other than they were, before they go back.
 */
void tangled_wrecks_note(struct tangled_wrecks *tangled, const struct response_context *context,
                         uint32_t pair);

/* Gives the wrecks of each group that holds together their common velocity, and forgets the frame.
 * sent_back: [capacity of the world] how often each row has gone back; only wrecks that are where
 * they began the frame are meant. Their energy does not grow. Nothing is done with groups that
 * touch anything else, because that takes up momentum, and with slow ones, which come to rest. */
void tangled_wrecks_go_on(struct tangled_wrecks *tangled, struct response_context *context,
                          const uint8_t *sent_back);

#endif
