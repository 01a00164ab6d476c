/* Aircraft that begin in each other, and wrecks in the air with them. They only have to part: like
 * bodies on the ground (collider/resting/parting.h) they have no impacts on each other and are
 * displaced, without a velocity. They do so horizontally, and no displacement brings one into
 * another that it is not in. Pure; one caller, and its workers. */
#ifndef JOLON_COLLIDER_PARTING_AIRCRAFT_PARTING_H
#define JOLON_COLLIDER_PARTING_AIRCRAFT_PARTING_H

#include "collider/geometry/level_exit.h"
#include "collider/geometry/level_gap.h"
#include "collider/parting/parting_rows.h"
#include "collider/response/response_context.h"
#include "collider/resting/free_bodies.h"
#include "collider/resting/resting.h"

#include <stdbool.h>
#include <stdint.h>

/* A pair of two that may be in each other, or in each other's way. */
struct aircraft_pair {
    bool overlaps;
    uint32_t count;                         /* of near hulls */
    struct level_gap gap[RESTING_GAPS_MAX]; /* smallest first; of two that part only one */
};

/* An aircraft as it stands when the frame begins, and then when it ends. */
struct aircraft_body {
    struct swept_body body;
    struct mat3 turn;
    uint32_t in;               /* so many others it is in when the frame begins */
    uint32_t level;            /* index + 1 into level and level_row, else 0 */
    uint32_t parent;           /* union-find of those that are in each other */
    double kg;                 /* of a root: of all of them */
    struct vec3 way, momentum; /* [kg m], [N s] the same */
    bool struck;               /* of a root: one of them has had an impact */
    struct vec3 home; /* [m, world] of one that makes way: where it would be without its step */
};

/* The collider's own memory. */
struct aircraft_parting {
    struct thread_pool *workers;
    struct parting_rows rows;   /* first those that are new, then those that part from them */
    uint32_t fresh;             /* so many are new */
    uint32_t members;           /* then the first ones are in each other */
    struct aircraft_body *body; /* [rows.count] */
    struct aircraft_pair *pair; /* [rows.list.count] */
    struct pair_list deep;      /* those that begin the frame in each other */
    struct level_exit exit;
    struct crowds crowds;
    struct parting steps; /* and what it is given */
    struct level_body *level;
    uint32_t *level_row;
    struct resting_pair *parted;
    struct level_contact *point;
    uint32_t levels, parteds, points;
    uint64_t parted_capacity, point_capacity;
};

/* Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int aircraft_parting_init(struct aircraft_parting *parting, const struct world *world,
                          struct thread_pool *workers);
void aircraft_parting_free(struct aircraft_parting *parting);

/* Finds the aircraft that are deep in each other: those that are new in this frame, and those that
 * have not parted yet. Marks their pairs as CONTACT_PARTS, lets them go together, and displaces
 * them with all that make room. bodies: which are new; adds the rows that it moves. All bodies must
 * have their motion, and nothing must have been swept. */
void aircraft_parting_run(struct aircraft_parting *parting, struct response_context *context,
                          struct free_bodies *bodies);

/* Lets those that part share the impacts that one of them has had: they go on together. */
void aircraft_parting_share(struct aircraft_parting *parting, struct response_context *context,
                            struct free_bodies *bodies);

/* Returns how far the row at an index of level goes in the frame to make way [m]. */
struct vec3 aircraft_parting_step(const struct aircraft_parting *parting,
                                  const struct response_context *context, uint32_t index);

/* Returns what is known of a row that is listed. */
struct aircraft_body *aircraft_parting_body(const struct aircraft_parting *parting, uint32_t row);

/* Returns true if two rows, as they are in the table, may be so near to each other. */
bool aircraft_parting_is_near(const struct response_context *context, uint32_t row, uint32_t other,
                              double margin_m);

/* Finds how all listed rows stand: when the frame begins, or as they are when it ends. */
void aircraft_parting_stand(struct aircraft_parting *parting,
                            const struct response_context *context, bool ends);

/* Returns a listed row as it was found to stand. */
struct turned_body aircraft_parting_turned(const struct aircraft_parting *parting, uint32_t row);

#endif
