/* The gap between two bodies that the ground holds: they can part only horizontally, so normals are
 * horizontal and depths are measured along them. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_LEVEL_GAP_H
#define JOLON_COLLIDER_GEOMETRY_LEVEL_GAP_H

#include "collider/geometry/time_of_impact.h"
#include "world/entity/persistent_contact.h"

#include <stdbool.h>
#include <stdint.h>

/* Pairs of hulls of two bodies that are considered, the nearest first. */
#define LEVEL_GAPS_MAX 4u

/* A normal with a smaller horizontal part is too steep for bodies that the ground holds. */
#define LEVEL_MIN 0.2

/* Hulls that overlap by more than this bear no load, and only have to part: they have one point
 * [m]. */
#define LEVEL_GAP_PARTS_M 0.02

/* Normals that are tried for a pair of bodies before any search. */
#define LEVEL_GAP_PLANES 2

/* Two hulls that touch or nearly do. */
struct level_gap {
    struct vec3 normal;   /* unit, horizontal, from a to b */
    double gap_m;         /* along the normal; below 0 the depth of the overlap */
    struct vec3 point[2]; /* [m, world] the ends of the contact, across the normal */
    uint32_t points;      /* 1 or 2 */
    uint32_t hulls;       /* HULLS_A_MODEL * hull of a + hull of b */
    struct vec3 plane;    /* unit, from a to b: across it the hulls are apart; 0: they overlap */
};

/* The memory of a pair of bodies: where the search for the nearest points of its near hulls ended,
 * and where it begins the next time. The first entries are those of the gaps, in their order; one
 * of them without a count names the hulls and knows no vertices. */
struct level_gap_memory {
    struct nearest_vertices nearest[PERSISTENT_CONTACT_NEAREST];
};

/* A body, and the matrix of its rotation at one time. */
struct turned_body {
    const struct swept_body *body;
    struct mat3 turn;
};

/* Finds the gaps of the pairs of hulls that are within margin_m [m, >= 0] of each other at a time
 * in [max(since), 1], smallest first. Returns how many there are; gap holds LEVEL_GAPS_MAX. The gap
 * along the normal is greater than the distance of hulls whose nearest points are not level, and so
 * may be above margin_m. Hulls that overlap part along the shallowest of the horizontal normals of
 * their faces, or of the line between the bodies' positions. memory: where searches begin, or NULL.
 */
uint32_t level_gap_find(const struct swept_body *a, const struct swept_body *b, double time,
                        double margin_m, const struct level_gap_memory *memory,
                        struct level_gap *gap);

/* Returns how the body is turned at a time in [path.since, 1]. */
struct mat3 level_gap_turn(const struct swept_body *body, double time);

/* The same at the time 0, for bodies whose turns there are known, and with another room in gap.
 * Sets *apart_m to a length [m, >= 0] by which the bodies are apart at least: their distance if it
 * is within margin_m. memory: of this pair, and updated. */
uint32_t level_gap_find_more(const struct turned_body *a, const struct turned_body *b,
                             double margin_m, struct level_gap *gap, uint32_t room, double *apart_m,
                             struct level_gap_memory *memory);

/* Adds to the count gaps that level_gap_find_more() found with a smaller margin, as many as there
 * were, and with this memory, those of the hulls that are farther apart. Returns how many there
 * are. */
uint32_t level_gap_find_wider(const struct turned_body *a, const struct turned_body *b,
                              double margin_m, struct level_gap *gap, uint32_t count, uint32_t room,
                              struct level_gap_memory *memory);

/* Returns the smallest of those gaps [m], or margin_m if all are larger. */
double level_gap_least(const struct swept_body *a, const struct swept_body *b, double time,
                       double margin_m);

/* Finds the smallest of those gaps at the time 0 if it is below -least_m [m, > 0], or one that is
 * below -enough_m [m, >= least_m], with which it ends. Returns false if none is. The gap has no
 * points. Costs less than level_gap_find_more(). */
bool level_gap_deepest(const struct turned_body *a, const struct turned_body *b, double least_m,
                       double enough_m, struct level_gap *deepest);

/* Returns the smallest of the gaps between bodies that stand still, if that is below 0, else 0: the
 * same to the bit as level_gap_least() with a margin of 0. plane: unit normals from a to b, or 0,
 * that are tried first; what a search finds is left there. Hulls that one of them separates
 * are not searched. memory: of this pair, or NULL. */
double level_gap_depth(const struct turned_body *a, const struct turned_body *b,
                       struct vec3 plane[LEVEL_GAP_PLANES], const struct level_gap_memory *memory);

/* Returns true if the planes of these gaps, which were found when the bodies were elsewhere, still
 * separate their hulls, so that none of these overlap. False says nothing. */
bool level_gap_planes_hold(const struct turned_body *a, const struct turned_body *b,
                           const struct level_gap *gap, uint32_t count);

/* Replaces the first of the gaps that level_gap_find_more() found with this room, of bodies of
 * which several pairs of hulls overlap: normal and gap become those along which the whole bodies
 * part in the shortest way. The normal is that of one of the gaps, or the line between the
 * positions. */
void level_gap_whole(const struct turned_body *a, const struct turned_body *b,
                     struct level_gap *gap, uint32_t count, uint32_t room);

#endif
