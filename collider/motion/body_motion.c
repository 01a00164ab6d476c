/* Paths and rotations of the frame's rows. */
#include "collider/motion/body_motion.h"

#include "collider/motion/pair_filter.h"
#include "world/entity/kind.h"
#include "world/maths/maths.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

int body_motion_init(struct body_motion *motion, const struct world *world)
{
    uint32_t capacity = world->params->capacity;
    *motion = (struct body_motion){.world = world};
    motion->path = malloc(capacity * sizeof *motion->path);
    motion->computed = calloc(capacity, sizeof *motion->computed);
    motion->change = calloc(capacity, sizeof *motion->change);
    motion->changed = reserve_take(capacity, sizeof *motion->changed);
    motion->row = reserve_take(capacity, sizeof *motion->row);
    if (!motion->path || !motion->computed || !motion->change || !motion->changed || !motion->row) {
        body_motion_free(motion);
        return -1;
    }
    return 0;
}

void body_motion_free(struct body_motion *motion)
{
    free(motion->path);
    free(motion->computed);
    reserve_free(motion->changed);
    free(motion->change);
    reserve_free(motion->row);
    *motion = (struct body_motion){0};
}

void body_motion_begin(struct body_motion *motion, const struct state *committed,
                       const struct state *next)
{
    for (uint32_t i = 0; i < motion->changes; i++)
        motion->change[motion->row[i]] = 0;
    motion->changes = 0;
    memset(motion->computed, 0, motion->world->params->capacity * sizeof *motion->computed);
    motion->committed = committed;
    motion->next = next;
    motion->models = motion->world->params->collision.shape == SHAPE_MODEL;
}

struct path body_motion_path(const struct body_motion *motion, uint32_t row)
{
    struct vec3 to = entities_position(&motion->next->entities, row);
    struct vec3 from =
        body_motion_old(motion, row) ? entities_position(&motion->committed->entities, row) : to;
    struct path path = {.at = from, .along = vec3_sub(to, from)};
    if (pair_filter_rests(&path))
        path.rotates = body_motion_rotates(motion, row);
    return path;
}

void body_motion_compute(struct body_motion *motion, uint32_t row)
{
    motion->path[row] = body_motion_path(motion, row);
    motion->computed[row] = 1;
}

static struct quat pose(const struct entities *e, uint32_t row)
{
    return rotation_of(e->heading[row], e->pitch[row], e->roll[row]);
}

struct rotation_path body_motion_rotation(const struct body_motion *motion, uint32_t row)
{
    if (motion->change[row] != 0)
        return motion->changed[motion->change[row] - 1];
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    struct quat to = pose(n, row);
    if (!body_motion_rotated(motion, row))
        return (struct rotation_path){.from = to, .to = to};
    return (struct rotation_path){.from = pose(w, row), .to = to};
}

struct quat body_motion_orientation(const struct body_motion *motion, uint32_t row, double time)
{
    struct rotation_path rotation = body_motion_rotation(motion, row);
    double since = motion->path[row].since;
    double left = 1.0 - since;
    return left > 0.0 ? rotation_between(rotation.from, rotation.to, (time - since) / left)
                      : rotation.to;
}

void body_motion_change(struct body_motion *motion, uint32_t row, const struct path *path,
                        const struct rotation_path *rotation)
{
    if (motion->change[row] == 0) {
        motion->row[motion->changes] = row;
        motion->change[row] = ++motion->changes;
    }
    motion->changed[motion->change[row] - 1] = *rotation;
    motion->path[row] = *path;
}

static struct swept_body shape_of(const struct world *world, uint16_t kind, double scale)
{
    const struct kind *k = &world->kinds[kind];
    return (struct swept_body){
        .hull = world->hulls + k->first_hull,
        .hull_count = k->hull_count,
        .vertices = world->hull_vertices,
        .planes = world->hull_planes,
        .scale = scale,
        .bound_m = scale * k->bound_m,
    };
}

struct swept_body body_motion_body(const struct body_motion *motion, uint32_t row)
{
    struct swept_body body = shape_of(motion->world, motion->next->entities.kind[row], 1.0);
    struct rotation_path rotation = body_motion_rotation(motion, row);
    body.path = motion->path[row];
    body.from = rotation.from;
    body.to = rotation.to;
    return body;
}

struct swept_body body_motion_fixed(const struct world *world, uint32_t object)
{
    const struct fixed_object *fixed = &world->fixed[object];
    double scale = fixed_scale(fixed, &world->kinds[fixed->kind]);
    struct swept_body body = shape_of(world, fixed->kind, scale);
    body.path.at = fixed_position(fixed);
    body.from = body.to = rotation_of(fixed_heading(fixed), 0.0, 0.0);
    return body;
}
