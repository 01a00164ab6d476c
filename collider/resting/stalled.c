/* Compares what the contacts leave of a body's motion with what the ground resists. */
#include "collider/resting/stalled.h"

#include "collider/resting/ground_placement.h"
#include "collider/resting/held_rest.h"
#include "world/entity/mass_properties.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/world.h"

/* The ground resists a vehicle that begins to move with this share of its weight: that of tracks on
 * firm soil, and of tyres on earth. */
#define RESISTS_MPS2 (0.04 * GRAVITY_MPS2)
/* A vehicle that moves faster has begun to move [m/s]. */
#define STARTED_MPS 0.02
/* Contacts press on a vehicle if their impulses together give it more than this: a tenth of its
 * weight. One on which nothing presses starts as its driver wants. */
#define PRESSED_MPS2 (0.1 * GRAVITY_MPS2)
/* Springs that contacts keep from lifting or lowering a side tilt a body no faster. */
#define TILTED_RPS2 3.0

/* Returns the greatest speed of a body's ends by this motion on the map, at most [m/s]. */
static double speed_of(double x, double z, double spin, double half_m)
{
    return sqrt(x * x + z * z) + half_m * fabs(spin);
}

/* Returns true if the row is a vehicle that can stand, and neither falls nor tips over. */
static bool can_stand(const struct response_context *context, uint32_t row)
{
    const struct entities *w = body_motion_before(context->motion, row),
                          *e = &context->next->entities;
    double dt_s = world_dt_s(context->world);
    return body_motion_old(context->motion, row) && e->row[row].state == ENTITY_ACTIVE &&
           e->row[row].behaviour != BEHAVIOUR_HOLD && !remote_is(e, row) &&
           context->world->kinds[e->row[row].kind].domain == DOMAIN_LAND &&
           fabs(w->row[row].vy) <= STARTED_MPS && fabs(e->row[row].vy) <= STARTED_MPS &&
           fabs(e->row[row].spin_x) + fabs(e->row[row].spin_z) <= TILTED_RPS2 * dt_s;
}

/* Returns true if the body has not begun to move, and what the contacts leave of its motion is less
 * than the ground resists. */
static bool stands(const struct response_context *context, const struct resting *resting,
                   uint32_t index)
{
    const struct level_body *body = &resting->body[index];
    uint32_t row = resting->row[index];
    if (row == SLOT_NONE || !can_stand(context, row))
        return false;
    const struct entities *w = body_motion_before(context->motion, row);
    double dt_s = world_dt_s(context->world);
    double half = 0.5 * context->world->kinds[w->row[row].kind].length_m;
    return resting->pressed_ns[index] * body->inverse_mass > PRESSED_MPS2 * dt_s &&
           speed_of(w->row[row].vx, w->row[row].vz, w->row[row].spin_y, half) <= STARTED_MPS &&
           speed_of(body->moved.x - w->row[row].vx, body->moved.z - w->row[row].vz,
                    body->moved.spin - w->row[row].spin_y, half) <= RESISTS_MPS2 * dt_s &&
           speed_of(body->pushed.x, body->pushed.z, body->pushed.spin, half) <= STARTED_MPS;
}

void stalled_find(struct resting *resting, const struct response_context *context)
{
    for (uint32_t i = 0; i < resting->bodies; i++)
        resting->pressed_ns[i] = 0.0;
    for (uint32_t i = 0; i < resting->points; i++) {
        const struct level_contact *point = &resting->point[i];
        resting->pressed_ns[point->a] += point->normal_ns;
        resting->pressed_ns[point->b] += point->normal_ns;
    }
    for (uint32_t i = 0; i < resting->bodies; i++) {
        resting->stands[i] = stands(context, resting, i);
        if (resting->stands[i])
            resting->body[i].moved = resting->body[i].pushed = (struct level_motion){0.0, 0.0, 0.0};
    }
}

void stalled_stop(struct response_context *context, uint32_t row)
{
    const struct entities *w = body_motion_before(context->motion, row);
    const struct vec3 rest = {0.0, 0.0, 0.0};
    held_rest_put_back(context, row);
    if (!(w->row[row].flags &
          ENTITY_FLAG_CHASSIS)) /* it stands on the ground, which may have changed */
        ground_placement_put(context, row, entities_position(w, row), w->row[row].heading);
    table_set_velocity(&context->writer, row, rest);
    table_set_spin(&context->writer, row, rest);
}
