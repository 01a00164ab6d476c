/* Integrates the movement of wheels and steering. Turrets and guns are copied from the world. */
#include "renderer/scene/frame/articulation.h"

#include "renderer/scene/frame/frame_view.h"
#include "renderer/scene/frame/body_axes.h"
#include "world/entity/kind.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>

#define GUN_HANGS_RAD  (-0.12f)
#define GUN_SINKS_RADS 0.35 /* [rad/s] a wreck's gun sinks until it hangs */
#define WHEELBASE      0.6  /* share of the length */
#define TRACK_APART    0.38 /* share of the width, from the middle to each side */
#define STEER_MIN_M    0.02 /* smaller movements do not change the steering angle */
#define STEER_FOLLOWS  0.35 /* share of the difference, each update */

int articulation_init(struct articulation *articulation, uint32_t capacity)
{
    articulation->slots = capacity < ARTICULATION_SLOTS_MAX ? capacity : ARTICULATION_SLOTS_MAX;
    articulation->state = calloc(articulation->slots + 1, sizeof *articulation->state);
    return articulation->state == NULL ? -1 : 0;
}

void articulation_free(struct articulation *articulation)
{
    free(articulation->state);
    *articulation = (struct articulation){NULL, 0};
}

static struct articulation_state initial_state(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    bool wreck = e->row[slot].state == ENTITY_WRECK;
    return (struct articulation_state){.id = e->row[slot].id,
                                       .time_s = frame_view_time_s(frame_view),
                                       .x = e->row[slot].x,
                                       .y = e->row[slot].y,
                                       .z = e->row[slot].z,
                                       .heading = e->row[slot].heading,
                                       .turret_rad = e->row[slot].turret,
                                       .gun_rad = wreck ? GUN_HANGS_RAD : e->row[slot].gun};
}

static double wrapped(double distance)
{
    return distance - ARTICULATION_WRAP_M * floor(distance / ARTICULATION_WRAP_M);
}

/* Adds the distance rolled along the body's own axis. In a turn the outer side rolls farther. */
static void roll(struct articulation_state *state, const struct frame_view *frame_view,
                 uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
    struct body_axes axes =
        body_axes_of(e->row[slot].heading, e->row[slot].pitch, e->row[slot].roll);
    struct vec3 moved = {e->row[slot].x - state->x, e->row[slot].y - state->y,
                         e->row[slot].z - state->z};
    double distance = vec3_dot(moved, axes.forward);
    double turned = maths_wrap_half(e->row[slot].heading - state->heading);
    double more = turned * TRACK_APART * kind->width_m;
    state->travel_m[0] = wrapped(state->travel_m[0] + distance + more);
    state->travel_m[1] = wrapped(state->travel_m[1] + distance - more);
    if (fabs(distance) > STEER_MIN_M) {
        double steer = maths_atan2(turned * WHEELBASE * kind->length_m, distance);
        if (distance < 0.0)
            steer = maths_atan2(-turned * WHEELBASE * kind->length_m, -distance);
        steer = maths_clamp(steer, -ARTICULATION_STEER_MAX, ARTICULATION_STEER_MAX);
        state->steer_rad += (float)(STEER_FOLLOWS * (steer - (double)state->steer_rad));
    }
}

static void advance(struct articulation_state *state, const struct frame_view *frame_view,
                    uint32_t slot, double dt_s)
{
    const struct entities *e = frame_view->entities;
    state->turret_rad = e->row[slot].turret;
    if (e->row[slot].state == ENTITY_WRECK) { /* a wreck does not roll, and its gun sinks */
        float most = (float)(GUN_SINKS_RADS * dt_s);
        state->gun_rad = fmaxf(fminf(state->gun_rad, GUN_HANGS_RAD), state->gun_rad - most);
    } else {
        state->gun_rad = e->row[slot].gun;
        roll(state, frame_view, slot);
    }
    state->time_s += dt_s;
    state->x = e->row[slot].x;
    state->y = e->row[slot].y;
    state->z = e->row[slot].z;
    state->heading = e->row[slot].heading;
}

void articulation_note(struct articulation *articulation, const struct frame_view *frame_view)
{
    const struct entities *e = frame_view->entities;
    double now_s = frame_view_time_s(frame_view);
    for (uint32_t i = 0; i < frame_view->head->used && i < articulation->slots; i++) {
        struct articulation_state *state = &articulation->state[i];
        if (e->row[i].state == ENTITY_FREE || e->row[i].kind >= frame_view->world->counts.kinds ||
            frame_view->world->kinds[e->row[i].kind].domain == DOMAIN_MUNITION)
            continue;
        double dt_s = now_s - state->time_s;
        if (state->id != e->row[i].id || dt_s < 0.0 || dt_s > ARTICULATION_JUMP_S)
            *state = initial_state(frame_view, i);
        else
            advance(state, frame_view, i, dt_s);
    }
}

struct articulation_state articulation_of(const struct articulation *articulation,
                                          const struct frame_view *frame_view, uint32_t slot)
{
    if (articulation == NULL || slot >= articulation->slots ||
        articulation->state[slot].id != frame_view->entities->row[slot].id)
        return initial_state(frame_view, slot);
    return articulation->state[slot];
}
