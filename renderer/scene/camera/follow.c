/* The choice of the followed vehicle. */
#include "renderer/scene/camera/follow.h"

#include "world/entity/kind.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define CELL_M         250.0 /* neighbours are counted in cells of this size */
#define CELLS          200   /* cells a side */
#define AHEAD_M        160.0 /* neighbours count where the camera looks */
#define NEIGHBOURS_MAX 10
#define ACTION_LIFE_S  20.0
#define ACTION_NEAR_M  450.0
#define ACTION_MAX     12.0
#define OBJECTS_MAX    10 /* most fixed objects nearby that count */

static int32_t cell_axis(double metres)
{
    int32_t cell = (int32_t)(maths_clamp(metres, 0.0, WORLD_SIDE_M) / CELL_M);
    return cell < CELLS ? cell : CELLS - 1;
}

static bool is_vehicle(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    return e->state[slot] == ENTITY_ACTIVE && e->kind[slot] < frame_view->world->counts.kinds &&
           frame_view->world->kinds[e->kind[slot]].domain != DOMAIN_MUNITION;
}

static double action_near(const struct effects *effects, struct vec3 position, double now_s)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < effects->count; i++) {
        const struct effect *effect = &effects->effect[i];
        double age = now_s - effect->time_s;
        double off = vec3_length(vec3_sub(effect->point, position));
        if (age < ACTION_LIFE_S && off < ACTION_NEAR_M)
            sum += 2.0 * (1.0 - off / ACTION_NEAR_M);
    }
    return maths_min(sum, ACTION_MAX);
}

static double liveliness(const struct frame_view *frame_view, const struct effects *effects,
                         uint32_t slot, uint32_t neighbours)
{
    const struct entities *e = frame_view->entities;
    const struct kind *kind = &frame_view->world->kinds[e->kind[slot]];
    struct vec3 position = entities_position(e, slot);
    double speed = vec3_length(entities_velocity(e, slot));
    double score = 0.8 * (neighbours < NEIGHBOURS_MAX ? neighbours : NEIGHBOURS_MAX);
    score += kind->domain == DOMAIN_LAND ? 5.0 : kind->domain == DOMAIN_AIR ? 0.5 : 0.0;
    score += speed > 3.0 ? 5.0 : 0.0;
    score += e->behaviour[slot] == BEHAVIOUR_ATTACK ? 2.0 : 0.0;
    score -= e->damage[slot];
    const uint32_t *around;
    uint32_t objects =
        world_reach(frame_view->world, gridsquare_of(position.x, position.z), &around);
    score += 0.25 * (objects < OBJECTS_MAX ? objects : OBJECTS_MAX);
    return score +
           action_near(effects, position, state_time_s(frame_view->world, frame_view->head));
}

static uint16_t *cell_of(uint16_t *cells, double x, double z)
{
    return &cells[cell_axis(z) * CELLS + cell_axis(x)];
}

static uint32_t liveliest(const struct frame_view *frame_view, const struct effects *effects)
{
    uint16_t neighbours[CELLS * CELLS];
    const struct entities *e = frame_view->entities;
    memset(neighbours, 0, sizeof neighbours);
    for (uint32_t i = 0; i < frame_view->head->used; i++)
        if (is_vehicle(frame_view, i)) {
            uint16_t *here = cell_of(neighbours, e->x[i], e->z[i]);
            *here = (uint16_t)(*here + (*here < UINT16_MAX));
        }
    uint32_t best = SLOT_NONE;
    double most = -INFINITY;
    for (uint32_t i = 0; i < frame_view->head->used; i++) {
        if (!is_vehicle(frame_view, i))
            continue;
        double ahead_x = e->x[i] + AHEAD_M * maths_sin(e->heading[i]);
        double ahead_z = e->z[i] - AHEAD_M * maths_cos(e->heading[i]);
        double score = liveliness(frame_view, effects, i, *cell_of(neighbours, ahead_x, ahead_z));
        if (score > most) {
            most = score;
            best = i;
        }
    }
    return best;
}

/* Returns true if the vehicle is active, or was destroyed only recently. */
static bool worth_following(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    double dead_s =
        (double)(frame_view->head->tick - e->changed_tick[slot]) * world_dt_s(frame_view->world);
    return e->state[slot] == ENTITY_ACTIVE || dead_s < FOLLOW_WRECK_S;
}

uint32_t follow_choose(struct follow *follow, const struct frame_view *frame_view,
                       const struct effects *effects, uint32_t first_id, bool only)
{
    const struct entities *e = frame_view->entities;
    uint32_t used = frame_view->head->used;
    double now = state_time_s(frame_view->world, frame_view->head);
    uint32_t first = first_id != 0 ? entities_find(e, used, first_id) : SLOT_NONE;
    if (first != SLOT_NONE && (only || worth_following(frame_view, first))) {
        *follow = (struct follow){.id = first_id, .since_s = now};
        return first;
    }
    uint32_t slot = follow->id != 0 ? entities_find(e, used, follow->id) : SLOT_NONE;
    if (slot != SLOT_NONE && worth_following(frame_view, slot) &&
        (e->state[slot] == ENTITY_WRECK || now - follow->since_s < FOLLOW_KEEP_S))
        return slot;
    uint32_t next = liveliest(frame_view, effects);
    if (next == SLOT_NONE)
        return slot;
    *follow = (struct follow){.id = e->id[next], .since_s = now};
    return next;
}
