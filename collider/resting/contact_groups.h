/* Which contacts of the committed table bear loads in this frame. Bodies that touch each other form
 * a group. A group in which nothing moves sleeps: it costs a look at its contacts, and nothing is
 * written. One motion wakes all of the group. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_CONTACT_GROUPS_H
#define JOLON_COLLIDER_RESTING_CONTACT_GROUPS_H

#include "collider/response/response_context.h"

#include <stdint.h>

struct contact_groups {
    struct pair *pair; /* found: those of the table in its order, then those of new bodies */
    uint32_t count, capacity;
    uint32_t known;    /* the first so many are in the table; the others may begin overlapped */
    uint32_t *contact; /* [known] which of the table's contacts they are */
    uint32_t *stirred; /* [contact_slots] contacts of the table whose bodies may be awake */
    uint32_t stirred_count;
    uint32_t *parent; /* [capacity of the world] union-find: row + 1, 0 for a row in no pair */
    uint8_t *awake;   /* [capacity of the world] of roots */
    uint8_t *ground; /* [capacity of the world] what is known of a row in this search; 0: nothing */
    uint32_t *asked; /* rows of which something is */
    uint32_t asked_count;
    uint32_t *begun; /* [capacity of the world] bodies that are new in this frame and near others:
                        those that the ground holds, or those in the air */
    uint32_t begun_count;
};

/* Returns 0, or -1 with errno ENOMEM. */
int contact_groups_init(struct contact_groups *groups, const struct world *world);
void contact_groups_free(struct contact_groups *groups);

/* Lists the bodies that are new in this frame and near others in groups->begun. */
void contact_groups_find_begun(struct contact_groups *groups, struct response_context *context);

/* Finds the pairs of the groups that are awake: the table's contacts between bodies that the ground
 * holds, and of those with walls. Adds the pairs of bodies that are new in this frame,
 * because they may begin overlapped. Computes the paths of their rows. */
void contact_groups_find(struct contact_groups *groups, struct response_context *context);

/* Finds the pairs of the groups that are awake of which one body is free, and the other is free, or
 * the ground holds it, or it is a wall. Wakes the wrecks that lean on something that is gone. Lists
 * the bodies in the air that are new in this frame. */
void contact_groups_find_free(struct contact_groups *groups, struct response_context *context);

/* Returns true for a piloted aircraft, for a wreck that does not lie on the ground or that tips
 * over there, and for a vehicle on its springs that does not stand on the ground. */
bool contact_groups_is_free(const struct response_context *context, uint32_t row);

/* Returns true for an aircraft that is no wreck and does not lie on the ground. */
bool contact_groups_flies(const struct response_context *context, uint32_t row);

/* Returns true for such an aircraft, and for a wreck in the air. */
bool contact_groups_in_air(const struct response_context *context, uint32_t row);

/* Returns true for an aircraft that flies and does not only hold its course. */
bool contact_groups_is_piloted(const struct response_context *context, uint32_t row);

/* Adds a pair to those found. */
void contact_groups_add(struct contact_groups *groups, const struct pair *pair);

/* Returns true if a fixed object stands and lets no body in, as bushes do. */
bool contact_groups_is_wall(const struct response_context *context, uint32_t object);

#endif
