/* What all methods of detection share: lists of pairs, boxes, and which pairs can never collide.
 * Pure; any thread. */
#ifndef JOLON_COLLIDER_MOTION_PAIR_FILTER_H
#define JOLON_COLLIDER_MOTION_PAIR_FILTER_H

#include "collider/geometry/analytic_impact.h"
#include "world/entity/entity.h"
#include "world/maths/maths.h"
#include "world/terrain/square_bounds.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct crater_index;
struct fixed_object;
struct kind;
struct world;

/* The second side of a pair is a row or a fixed object. */
#define PAIR_FIXED 0x80000000u /* flag: the other bits are a fixed object's index */

struct pair {
    uint32_t a; /* a row, the lower of two */
    uint32_t b; /* a row, or a fixed object with PAIR_FIXED */
};

struct pair_list {
    struct pair *pair;
    uint32_t count, capacity;
};

/* Most pairs of a frame. More would take minutes, and the watchdog ends a process that works on one
 * frame for so long (supervisor/watchdog.h). The numbers of links and contacts stay below 2^32. */
#define PAIRS_MAX (1u << 29)

/* Returns how many pairs are reserved for a frame of this world: PAIRS_FIRST and PAIRS_A_ROW for
 * each of its rows, but no more than the world can have. A frame with more makes arrays grow. */
#define PAIRS_FIRST (1u << 18)
#define PAIRS_A_ROW 1u
uint32_t pair_filter_pairs_first(const struct world *world);

/* Takes the address space of this many pairs. Returns 0, or -1 with errno ENOMEM. */
int pair_list_init(struct pair_list *list, uint64_t count);
void pair_list_free(struct pair_list *list);

/* Adds a pair. A full list grows; at PAIRS_MAX pairs the process ends. */
void pair_list_add(struct pair_list *list, uint32_t a, uint32_t b);
void pair_list_append(struct pair_list *list, const struct pair_list *from);

/* Returns what is added to each side of a box [m]: half a float's step at 50 km is 2 mm, so 1 cm
 * keeps the box around the body. Steps grow with the side of the world. */
double pair_filter_slack(const struct world *world);

/* The box around a row's path with its sphere or its hulls. */
struct path_box {
    float min_x, min_y, min_z, max_x, max_y, max_z; /* rounded outwards */
};

/* What detection reads. */
struct method_input {
    const struct world *world;
    const struct entities *entities; /* at the end of the frame */
    const struct path *path;         /* [rows] */
    const uint8_t *fixed_damage;
    const struct crater_index *craters;
    const struct square_bounds *heights; /* NULL: each path is tested against the ground itself */
    uint32_t rows;
};

/* Return how far a row, or a fixed object, reaches from its position: its sphere's radius or its
 * hulls' bound, by collision.shape [m]. */
double pair_filter_row_reach(const struct method_input *input, uint32_t row);
double pair_filter_fixed_reach(const struct world *world, const struct fixed_object *object);

/* Returns how far a kind's box reaches beyond its path, wherever turret and gun point [m]. */
double pair_filter_margin(const struct world *world, const struct kind *kind);

/* Returns the box around a path. */
static inline struct path_box pair_filter_path_box(const struct path *path, double margin)
{
    struct vec3 p = path->at, q = path_at(path, 1.0);
    return (struct path_box){
        (float)(maths_min(p.x, q.x) - margin), (float)(maths_min(p.y, q.y) - margin),
        (float)(maths_min(p.z, q.z) - margin), (float)(maths_max(p.x, q.x) + margin),
        (float)(maths_max(p.y, q.y) + margin), (float)(maths_max(p.z, q.z) + margin),
    };
}

/* Returns the row's box. */
struct path_box pair_filter_box(const struct method_input *input, uint32_t row);

/* Returns true if the body neither moves nor rotates. */
static inline bool pair_filter_rests(const struct path *path)
{
    return path->along.x == 0.0 && path->along.y == 0.0 && path->along.z == 0.0 && !path->rotates;
}

/* Returns true if the row is in use and so can collide. */
static inline bool pair_filter_there(const struct method_input *input, uint32_t row)
{
    return input->entities->row[row].state != ENTITY_FREE;
}

/* Returns true if the path reaches the ground; *toi is then when. */
bool pair_filter_ground(const struct method_input *input, const struct path *path, double *toi);

/* Returns true if the row tests fixed objects: not if it rests, nor if it is an aircraft that stays
 * above the threshold height (thesis row 17). */
bool pair_filter_tests_fixed(const struct method_input *input, uint32_t row);

/* Returns true unless the fixed object is destroyed and can no longer be hit. */
static inline bool pair_filter_stands(const struct method_input *input, uint32_t object)
{
    return input->fixed_damage[object] < DAMAGE_HIGH;
}

/* Returns true for a round and its shooter, or two rounds of one shooter. They never collide. */
bool pair_same_shooter(const struct entities *entities, uint32_t a, uint32_t b);

/* The same, and for two remote entities: their owners tell what becomes of them. */
bool pair_never_meets(const struct entities *entities, uint32_t a, uint32_t b);

/* Returns true for two rows that do not collide: see pair_never_meets, and two that rest. */
bool pair_excluded(const struct method_input *input, uint32_t a, uint32_t b);

static inline bool pair_filter_boxes_meet(const struct path_box *a, const struct path_box *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_z <= b->max_z &&
           b->min_z <= a->max_z && a->min_y <= b->max_y && b->min_y <= a->max_y;
}

/* Returns true if of two boxes that meet only corners do, so that their bodies cannot touch while
 * the boxes of their paths stay within these: no point of a body is farther from its position than
 * the box is from the path. margins_m: of both boxes, added up. */
static inline bool pair_filter_only_corners_meet(const struct path_box *a, const struct path_box *b,
                                                 double margins_m)
{
    double west = (double)a->min_x - (double)b->max_x, east = (double)b->min_x - (double)a->max_x;
    double north = (double)a->min_z - (double)b->max_z, south = (double)b->min_z - (double)a->max_z;
    double x = maths_max(west, east) + margins_m, z = maths_max(north, south) + margins_m;
    return x > 0.0 && z > 0.0 && x * x + z * z > margins_m * margins_m;
}

/* Returns true if no bound of the first box is beyond that of the second. */
static inline bool pair_filter_box_within(const struct path_box *inner,
                                          const struct path_box *outer)
{
    return inner->min_x >= outer->min_x && inner->max_x <= outer->max_x &&
           inner->min_y >= outer->min_y && inner->max_y <= outer->max_y &&
           inner->min_z >= outer->min_z && inner->max_z <= outer->max_z;
}

/* Returns the box around a fixed object, rounded outwards. */
struct path_box pair_filter_fixed_box(const struct world *world, const struct fixed_object *object);

bool pair_filter_box_meets_fixed(const struct method_input *input, const struct path_box *box,
                                 const struct fixed_object *object);

#endif
