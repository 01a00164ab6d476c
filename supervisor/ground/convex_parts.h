/* Splits the outline of a building into convex parts, exactly: in whole millimetres. Pure. */
#ifndef JOLON_SUPERVISOR_GROUND_CONVEX_PARTS_H
#define JOLON_SUPERVISOR_GROUND_CONVEX_PARTS_H

#include "world/terrain/ground_format.h"

#include <stdbool.h>
#include <stdint.h>

/* An outline with more corners, courtyards included, is not split. */
#define CONVEX_PARTS_CORNERS_MAX 4000u

/* A polygon on the map; x goes east and z south [mm]. */
struct convex_parts_ring {
    int32_t (*corner)[2];
    uint32_t count;
};

struct convex_parts {
    struct convex_parts_ring *part; /* clockwise, strictly convex */
    uint32_t count;
    double area_m2;
};

/* Returns the area of a ring that goes around clockwise [m2]. */
double convex_parts_ring_area(const struct convex_parts_ring *ring);

enum convex_parts_result {
    CONVEX_PARTS_GOOD,
    CONVEX_PARTS_EMPTY,   /* the outline encloses nothing */
    CONVEX_PARTS_TANGLED, /* it crosses itself, or has too many corners */
    CONVEX_PARTS_NO_MEMORY
};

/* Splits an outline: ring[0] is around ring[1] ..., its courtyards. Rings may go either way around
 * and may repeat points; they are cleaned in place. Parts have GROUND_PART_CORNERS_MAX corners at
 * most. The caller frees the parts in any case. */
enum convex_parts_result convex_parts_split(struct convex_parts *parts,
                                            struct convex_parts_ring *ring, uint32_t rings);
void convex_parts_free(struct convex_parts *parts);

/* Finds the smallest rectangle around an outline that has the direction of one of its sides: its
 * middle, half its length and its width, and the heading of its length, 65536 for a full turn.
 * Returns false if it has no width. */
struct convex_parts_box {
    double x_mm, z_mm, half_length_mm, half_width_mm;
    double along_x, along_z; /* unit */
    uint16_t turn;
};
bool convex_parts_box_of(struct convex_parts_box *box, int32_t (*corner)[2], uint32_t count);

#endif
