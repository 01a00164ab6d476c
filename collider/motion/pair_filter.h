/* What all methods of finding collisions share: lists of pairs, boxes, and which pairs can never
 * collide. Pure; any thread. */
#ifndef JOLON_COLLIDER_MOTION_PAIR_FILTER_H
#define JOLON_COLLIDER_MOTION_PAIR_FILTER_H

#include "collider/geometry/analytic_impact.h"
#include "world/entity/entity.h"
#include "world/maths/maths.h"
#include "world/param_values.h"
#include "world/terrain/square_bounds.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct crater_index;
struct fixed_object;
struct kind;
struct world;

/* What a pair's second side is. */
#define PAIR_FIXED 0x80000000u /* flag: the rest is a fixed object's index */

struct pair {
    uint32_t a; /* a row, the lower of two */
    uint32_t b; /* a row, or a fixed object with PAIR_FIXED */
};

struct pair_list {
    struct pair *pair;
    uint32_t count, capacity;
};

/* More pairs than this are not found in one frame: it would take minutes, and a role that works on
 * one frame for so long is ended before (supervisor/watchdog.h). Numbers of links and of contacts
 * stay below 2^32. */
#define PAIRS_MAX (1u << 29)

/* How many pairs are set aside for a frame of this world: PAIRS_FIRST and PAIRS_A_ROW for each of
 * its rows, but no more than the world can have. A frame with more makes arrays grow. */
#define PAIRS_FIRST (1u << 18)
#define PAIRS_A_ROW 1u
uint32_t pair_filter_pairs_first(const struct world *world);

/* Takes the address space of this many pairs. 0, or -1 with errno ENOMEM. */
int pair_list_init(struct pair_list *list, uint64_t count);
void pair_list_free(struct pair_list *list);

/* A full list grows. PAIRS_MAX pairs end the process. */
void pair_list_add(struct pair_list *list, uint32_t a, uint32_t b);
void pair_list_append(struct pair_list *list, const struct pair_list *from);

/* Half a float's step at 50 km is 2 mm; 1 cm keeps every box outside [m]. */
#define BOX_SLACK_M 0.01

/* Box around the sweep of a row: of its sphere, or of its hulls. */
struct path_box {
    float min_x, min_y, min_z, max_x, max_y, max_z; /* rounded outwards */
};

/* What detection looks at. */
struct method_input {
    const struct world *world;
    const struct entities *entities; /* at the end of the frame */
    const struct path *path;         /* [rows] */
    const uint8_t *fixed_damage;
    const struct crater_index *craters;
    const struct square_bounds *heights; /* NULL: each path is tested against the ground itself */
    uint32_t rows;
};

/* How far from its position a row, or a fixed object, reaches: its sphere's radius, or its hulls'
 * bound, by collision.shape [m]. */
double pair_filter_row_reach(const struct method_input *input, uint32_t row);
double pair_filter_fixed_reach(const struct world *world, const struct fixed_object *object);

/* How far a kind's box reaches beyond its way [m]. */
double pair_filter_grow(const struct world *world, const struct kind *kind);

/* The box around a way. */
static inline struct path_box pair_filter_way_box(const struct path *path, double grow)
{
    struct vec3 p = path->at, q = path_at(path, 1.0);
    return (struct path_box){
        (float)(maths_min(p.x, q.x) - grow), (float)(maths_min(p.y, q.y) - grow),
        (float)(maths_min(p.z, q.z) - grow), (float)(maths_max(p.x, q.x) + grow),
        (float)(maths_max(p.y, q.y) + grow), (float)(maths_max(p.z, q.z) + grow),
    };
}

/* The row's box. */
struct path_box pair_filter_box(const struct method_input *input, uint32_t row);

/* Does nothing of it move? */
static inline bool pair_filter_rests(const struct path *path)
{
    return path->along.x == 0.0 && path->along.y == 0.0 && path->along.z == 0.0 && !path->turns;
}

/* Does the row meet anything at all? Not a free one. */
static inline bool pair_filter_there(const struct method_input *input, uint32_t row)
{
    return input->entities->state[row] != ENTITY_FREE;
}

/* pair_filter.c: does the way reach the ground? Then *toi is when. */
bool pair_filter_ground(const struct method_input *input, const struct path *path, double *toi);

/* Does the row test fixed objects? Not when it rests, nor as an aircraft above the threshold height
 * all the way (thesis row 17). */
bool pair_filter_tests_fixed(const struct method_input *input, uint32_t row);

/* Can this fixed object still be hit? Not when it is down. */
static inline bool pair_filter_stands(const struct method_input *input, uint32_t object)
{
    return input->fixed_damage[object] < DAMAGE_HIGH;
}

/* A round and who fired it, or two rounds of one shooter? They never collide. */
bool pair_same_shooter(const struct entities *entities, uint32_t a, uint32_t b);

/* Can these two rows never collide? Kin, and two that rest. */
bool pair_excluded(const struct method_input *input, uint32_t a, uint32_t b);

static inline bool pair_filter_boxes_meet(const struct path_box *a, const struct path_box *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_z <= b->max_z &&
           b->min_z <= a->max_z && a->min_y <= b->max_y && b->min_y <= a->max_y;
}

/* The box around a fixed object, rounded outwards. */
struct path_box pair_filter_fixed_box(const struct world *world, const struct fixed_object *object);

bool pair_filter_box_meets_fixed(const struct method_input *input, const struct path_box *box,
                                 const struct fixed_object *object);

#endif
