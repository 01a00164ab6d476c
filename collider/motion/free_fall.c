/* Tells who falls freely by the mover's change of velocity. */
#include "collider/motion/free_fall.h"

#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/entity/wreck_drag.h"
#include "world/state.h"
#include "world/world.h"

#define ROUNDING_MPS 1e-6

/* What is known of a row in a frame. */
enum fall { FALL_UNKNOWN, FALL_FREE, FALL_NONE, FALL_AHEAD };

static struct mat3 axes_of(const struct entities *e, uint32_t row)
{
    return rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
}

static struct vec3 centre_velocity(const struct entities *e, const struct kind *kind,
                                   const struct mat3 *axes, uint32_t row)
{
    struct vec3 up = {0.0, mass_properties_of(kind).centre_m, 0.0};
    struct vec3 spin = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
    return vec3_add(entities_velocity(e, row), vec3_cross(spin, rotation_apply(axes, up)));
}

bool free_fall_only(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = &motion->before, *n = &motion->next->entities;
    const struct kind *kind = &motion->world->kinds[n->row[row].kind];
    if (!body_motion_old(motion, row) || w->row[row].state != n->row[row].state)
        return false;
    const struct mat3 from = axes_of(w, row), to = axes_of(n, row);
    struct vec3 before = centre_velocity(w, kind, &from, row);
    if (w->row[row].state == ENTITY_WRECK)
        before = wreck_drag_slow(kind, &from, before, world_dt_s(motion->world));
    struct vec3 change = vec3_sub(centre_velocity(n, kind, &to, row), before);
    change.y += GRAVITY_MPS2 * world_dt_s(motion->world);
    return vec3_length(change) < ROUNDING_MPS;
}

static bool falls(const struct body_motion *motion, uint32_t row)
{
    return motion->next->entities.row[row].state == ENTITY_WRECK && free_fall_only(motion, row);
}

static void set_fall(const struct body_motion *motion, uint32_t row, uint8_t fall)
{
    motion->fall[row] = fall;
    body_motion_note_known(motion, row);
}

double free_fall_left_mps(const struct body_motion *motion, uint32_t row, double time)
{
    const uint8_t *fall = &motion->fall[row];
    if (*fall == FALL_UNKNOWN)
        set_fall(motion, row, falls(motion, row) ? FALL_FREE : FALL_NONE);
    return *fall == FALL_FREE ? GRAVITY_MPS2 * world_dt_s(motion->world) * (1.0 - time) : 0.0;
}

void free_fall_ahead(const struct body_motion *motion, uint32_t row)
{
    set_fall(motion, row, FALL_AHEAD);
}

double free_fall_unearned_mps(const struct body_motion *motion, uint32_t row, double time)
{
    return motion->fall[row] == FALL_AHEAD ? GRAVITY_MPS2 * world_dt_s(motion->world) * (1.0 - time)
                                           : 0.0;
}
