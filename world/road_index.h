/* The index of roads: which stretches lie in each cell of a grid over the world. A stretch leads
 * from a point of a road to the next and has the number of the point where it begins. Used at
 * creation and by the renderer. Pure; any number of threads may walk. */
#ifndef JOLON_WORLD_ROAD_INDEX_H
#define JOLON_WORLD_ROAD_INDEX_H

#include <stdbool.h>
#include <stdint.h>

struct road_point;

struct road_index {
    const struct road_point *points;
    uint32_t side; /* cells in a row and in a column */
    double cells_a_m;
    uint32_t *first;     /* [side * side + 1] of each cell in stretches */
    uint32_t *stretches; /* ascending within a cell */
};

/* The stretches near a rectangle, one after the other. */
struct road_walk {
    const struct road_index *index;
    double x0, z0, x1, z1;
    uint32_t column0, row0, column1, row1;
    uint32_t column, row, at;
};

/* Returns true if a stretch begins with point i of points [count]: the next one is of its road. */
bool road_index_is_stretch(const struct road_point *points, uint32_t count, uint32_t i);

/* Makes the index of points [count] in a world of this side, which must stay where they are. The
 * caller frees it. Returns 0, or -1 with errno ENOMEM and nothing to free. */
int road_index_make(struct road_index *index, const struct road_point *points, uint32_t count,
                    double side_m);
void road_index_free(struct road_index *index);

/* Begins a walk over the stretches whose bounds touch the rectangle from (x0, z0) to (x1, z1) [m].
 */
struct road_walk road_index_walk(const struct road_index *index, double x0, double z0, double x1,
                                 double z1);

/* Finds the next stretch of a walk. Each comes once, in no particular order. Returns false at the
 * end. */
bool road_walk_next(struct road_walk *walk, uint32_t *stretch);

#endif
