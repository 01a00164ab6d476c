/* Small worlds for tests of collision detection. */
#include "tests/support/small_world.h"

#include "world/params.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void small_world_begin(struct small_world *w, uint32_t rows, uint32_t fixed)
{
    static const double radii[SMALL_KINDS] = {0.01, 1.6, 3.0, 20.0, 400.0, 7.0, 0.1, 2.0};
    memset(w, 0, sizeof *w);
    for (int i = 0; i < SMALL_KINDS; i++) {
        double r = radii[i];
        w->kinds[i] = (struct kind){.domain = DOMAIN_LAND,
                                    .radius_m = r,
                                    .bound_m = 1.1 * r,
                                    .reach_m = 1.1 * r,
                                    .level_m = 0.9 * r,
                                    .low_m = -0.2 * r,
                                    .high_m = 0.7 * r};
    }
    w->kinds[SMALL_JET].domain = DOMAIN_AIR;
    w->kinds[SMALL_ROUND].domain = DOMAIN_MUNITION;
    w->kinds[SMALL_TREE].domain = DOMAIN_FIXED;
    w->params = calloc(1, sizeof *w->params);
    assert_non_null(w->params);
    w->params->capacity = rows;
    w->params->hz = 60.0;
    w->params->dt_s = 1.0 / 60.0;
    w->params->collision.threshold_height_m = 60.0;
    w->fixed_most = fixed;
    w->fixed = calloc(fixed + 1, sizeof *w->fixed);
    w->damage = calloc(fixed + 1, sizeof *w->damage);
    w->path = calloc(rows, sizeof *w->path);
    w->memory = aligned_alloc(TABLE_ALIGN, entities_bytes(rows));
    assert_true(w->fixed && w->damage && w->path && w->memory);
    entities_bind(&w->e, rows, w->memory);
    w->world = (struct world){.params = w->params,
                              .counts = {.kinds = SMALL_KINDS},
                              .terrain = {w->posts, w->cover, 2, WORLD_SIDE_DEFAULT_M,
                                          .squares = GRIDSQUARES_DEFAULT_INIT},
                              .kinds = w->kinds,
                              .fixed = w->fixed};
}

void small_world_empty(struct small_world *w)
{
    w->rows = 0;
    w->world.counts.fixed = 0;
    free(w->reach_start);
    free(w->reach);
    w->reach_start = w->reach = NULL;
}

void small_world_end(struct small_world *w)
{
    small_world_empty(w);
    free(w->fixed);
    free(w->damage);
    free(w->path);
    free(w->memory);
    free(w->params);
}

void small_world_move(struct small_world *w, uint32_t row, struct vec3 at, struct vec3 along)
{
    w->path[row] = (struct path){.at = at, .along = along};
    entities_set_position(&w->e, row, path_at(&w->path[row], 1.0));
}

uint32_t small_world_row(struct small_world *w, enum small_kind kind, struct vec3 at,
                         struct vec3 along)
{
    uint32_t row = w->rows++;
    assert_true(row < w->params->capacity);
    entities_clear(&w->e, row);
    w->e.row[row].id = row + 1;
    w->e.row[row].kind = (uint16_t)kind;
    w->e.row[row].state = ENTITY_ACTIVE;
    w->e.row[row].behaviour = kind == SMALL_ROUND ? BEHAVIOUR_FLIGHT : BEHAVIOUR_HOLD;
    small_world_move(w, row, at, along);
    return row;
}

uint32_t small_world_tree(struct small_world *w, struct vec3 at, double radius_m)
{
    uint32_t object = w->world.counts.fixed++;
    assert_true(object < w->fixed_most);
    w->fixed[object] = (struct fixed_object){
        .x = at.x, .z = at.z, .y = (float)at.y, .radius_m = (float)radius_m, .kind = SMALL_TREE};
    w->damage[object] = DAMAGE_NONE;
    return object;
}

void small_world_index(struct small_world *w)
{
    free(w->reach_start);
    free(w->reach);
    assert_int_equal(fixed_index_build(&GRIDSQUARES_DEFAULT, w->fixed, w->world.counts.fixed,
                                       w->kinds, &w->reach_start, &w->reach),
                     0);
    w->world.reach_start = w->reach_start;
    w->world.reach = w->reach;
}

struct method_input small_world_input(const struct small_world *w)
{
    return (struct method_input){.world = &w->world,
                                 .entities = &w->e,
                                 .path = w->path,
                                 .fixed_damage = w->damage,
                                 .rows = w->rows};
}
