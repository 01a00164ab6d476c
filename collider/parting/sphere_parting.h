/* Bodies on the ground that collide as spheres and are deep in each other. They only have to part:
 * they have no impacts on each other and are displaced on the map, without a velocity. Bodies that
 * touch them make room. Pure; one caller. */
#ifndef JOLON_COLLIDER_PARTING_SPHERE_PARTING_H
#define JOLON_COLLIDER_PARTING_SPHERE_PARTING_H

#include "collider/parting/parting_rows.h"
#include "collider/response/response_context.h"

#include <stdbool.h>
#include <stdint.h>

/* A body that parts or makes room. */
struct sphere_body {
    struct vec3 from; /* [m] where it begins the frame */
    struct vec3 to;   /* [m] where it is to end the frame; y: as the mover has it */
    double light;     /* 1, or 0: it stands in the way */
    double share;     /* of its way, which it goes */
    bool jams;        /* it would get deeper into another one */
};

/* Two of them. */
struct sphere_pair {
    uint32_t a, b;  /* indices of bodies */
    double wish_m;  /* so far apart they are to end the frame */
    double least_m; /* and so far at least: they get no deeper */
};

/* The collider's own memory. */
struct sphere_parting {
    struct parting_rows rows; /* first those that part or make room */
    uint32_t members;         /* how many these are; the others stand in their way */
    struct sphere_body *body; /* [rows.count] */
    struct sphere_pair *pair; /* [rows.list.count] */
};

/* Returns 0, or -1 with errno ENOMEM. */
int sphere_parting_init(struct sphere_parting *parting, const struct world *world);
void sphere_parting_free(struct sphere_parting *parting);

/* Displaces the bodies that begin the frame deep in each other. Marks their pairs as CONTACT_PARTS.
 * Writes the rows that it has moved to moved, and returns how many they are. fresh: [count] bodies
 * that are new in this frame. The frame's pairs must be in the queue, and nothing must have been
 * swept. */
uint32_t sphere_parting_run(struct sphere_parting *parting, struct response_context *context,
                            const uint32_t *fresh, uint32_t count, uint32_t *moved);

#endif
