/* Keeps the marks up to date, and finds those of eight points at once. */
#include "mover/query/ground_marks.h"

#include "world/entity/entity.h"
#include "world/maths/cpu_dispatch.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define STRIDE 64u /* bytes of damage compared at once */

static size_t words_of(const struct ground_marks *marks)
{
    return ((size_t)marks->squares.count * GROUND_MARKS_BITS + 63) / 64;
}

void ground_marks_free(struct ground_marks *marks)
{
    free(marks->damage);
    free(marks->square);
    marks->damage = NULL;
    marks->square = NULL;
}

static void mark(struct ground_marks *marks, double x, double z, double reach, uint64_t bits)
{
    struct gridsquare_box box =
        gridsquare_box_of(&marks->squares, x - reach, z - reach, x + reach, z + reach);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t bit = gridsquare_index(&marks->squares, column, row) * GROUND_MARKS_BITS;
            marks->square[bit / 64] |= bits << bit % 64;
        }
    }
    marks->any = true;
}

/* Earthworks never change, so their marks are the first. */
static void mark_earthworks(struct ground_marks *marks, const struct earthworks *earthworks)
{
    for (uint32_t i = 0; i < earthworks->count; i++) {
        const struct earthwork *work = &earthworks->works[i];
        double reach = maths_max(earthwork_reach_x(work), earthwork_reach_z(work));
        if (work->height_m != 0.0)
            mark(marks, work->x, work->z, reach + GROUND_MARKS_NEAR_M, GROUND_MARKS_CRATER);
    }
}

int ground_marks_init(struct ground_marks *marks, const struct world *world)
{
    memset(marks, 0, sizeof *marks);
    marks->squares = world->terrain.squares;
    marks->square = calloc(words_of(marks), sizeof *marks->square);
    marks->damage = calloc(world->counts.fixed + 1, 1);
    if (!marks->square || !marks->damage)
        return -1;
    mark_earthworks(marks, &world->terrain.earthworks);
    return 0;
}

bool ground_marks_within(const struct ground_marks *marks, struct gridsquare_box box, uint8_t any)
{
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            if (ground_marks_of(marks, gridsquare_index(&marks->squares, column, row)) & any)
                return true;
        }
    }
    return false;
}

static void forget(struct ground_marks *marks, const struct world *world)
{
    memset(marks->square, 0, words_of(marks) * sizeof *marks->square);
    memset(marks->damage, 0, world->counts.fixed);
    marks->craters = 0;
    marks->any = false;
    mark_earthworks(marks, &world->terrain.earthworks);
}

static void mark_area(struct ground_marks *marks, const struct debris_area *area)
{
    double reach = area->half_length_m + area->radius_m;
    mark(marks, area->x, area->z, reach, GROUND_MARKS_DEBRIS);
}

static void mark_fallen(struct ground_marks *marks, const struct fixed_object *object,
                        const struct kind *kind, uint8_t damage)
{
    const struct debris_area area = fallen_area(object, kind, damage);
    mark_area(marks, &area);
}

/* Returns false if a fallen object stands again: the marks must then be built again. */
static bool take_damage(struct ground_marks *marks, const struct world *world,
                        const uint8_t *damage, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        const struct fixed_object *object = &world->fixed[i];
        if (damage[i] < DAMAGE_HIGH && marks->damage[i] >= DAMAGE_HIGH)
            return false;
        if (damage[i] >= DAMAGE_HIGH && marks->damage[i] < DAMAGE_HIGH)
            mark_fallen(marks, object, &world->kinds[object->kind], damage[i]);
        marks->damage[i] = damage[i];
    }
    return true;
}

static bool take_in(struct ground_marks *marks, const struct world *world,
                    const struct state *committed)
{
    uint32_t craters = committed->head->crater_count, fixed = world->counts.fixed;
    if (craters < marks->craters)
        return false;
    for (; marks->craters < craters; marks->craters++) {
        const struct crater *crater = &committed->craters[marks->craters];
        mark(marks, crater->x, crater->z,
             (double)crater->radius_m * CRATER_RIM + GROUND_MARKS_NEAR_M, GROUND_MARKS_CRATER);
    }
    for (uint32_t i = 0; i < committed->head->debris_count; i++) {
        const struct debris_area area = debris_area(&committed->head->debris[i]);
        mark_area(marks, &area);
    }
    for (uint32_t i = 0; i < fixed; i += STRIDE) {
        uint32_t count = fixed - i < STRIDE ? fixed - i : STRIDE;
        if (memcmp(marks->damage + i, committed->fixed_damage + i, count) != 0 &&
            !take_damage(marks, world, committed->fixed_damage, i, i + count))
            return false;
    }
    return true;
}

void ground_marks_update(struct ground_marks *marks, const struct world *world,
                         const struct state *committed)
{
    if (take_in(marks, world, committed))
        return;
    forget(marks, world);
    take_in(marks, world, committed);
}

/* gridsquare_axis() of four. */
static inline void axes_of(const struct gridsquares *squares, const f64x4 *metres,
                           four_cells *square)
{
    const f64x4 none = SIMD_EVERY(0.0), last = SIMD_EVERY(squares->per_side - 1.0);
    f64x4 along = SIMD_CHOOSE(*metres > none, *metres / squares->side_m, none);
    along = SIMD_CHOOSE(*metres >= squares->world_m, last, along);
    *square = __builtin_convertvector(along, four_cells);
}

VECTOR_CLONES
void ground_marks_find(const struct ground_marks *marks, const union simd_lanes *x,
                       const union simd_lanes *z, union lane_masks *crater,
                       union lane_masks *debris)
{
    if (!marks->any) {
        memset(crater, 0, sizeof *crater);
        memset(debris, 0, sizeof *debris);
        return;
    }
    for (int h = 0; h < LANE_FOURS; h++) {
        four_cells column, row;
        axes_of(&marks->squares, &x->f64x4[h], &column);
        axes_of(&marks->squares, &z->f64x4[h], &row);
        four_cells bit = (row * marks->squares.per_side + column) * (int32_t)GROUND_MARKS_BITS;
        four_masks found = {0, 0, 0, 0};
        for (int i = 0; i < 4; i++)
            found[i] = (int64_t)(marks->square[bit[i] / 64] >> bit[i] % 64);
        crater->f64x4[h] = (found & GROUND_MARKS_CRATER) != 0;
        debris->f64x4[h] = (found & GROUND_MARKS_DEBRIS) != 0;
    }
}
