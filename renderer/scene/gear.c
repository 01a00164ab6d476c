/* Ways along the body's own axis, angles that follow at a turret's rate. */
#include "renderer/scene/gear.h"

#include "renderer/scene/grain.h"
#include "renderer/scene/moment.h"
#include "renderer/scene/pose.h"

#include <math.h>
#include <stdlib.h>

#define GUN_LEAST_RAD  (-0.10)
#define GUN_MOST_RAD   0.30
#define GUN_HANGS_RAD  (-0.12)
#define WHEELBASE      0.6  /* of the length */
#define TRACK_APART    0.38 /* of the width, from the middle to each side */
#define STEER_LEAST_M  0.02 /* that it must have moved for its wheels to show which way */
#define STEER_FOLLOWS  0.35 /* of the difference, a note */
#define WRECK_TURN_RAD 1.0  /* either way, of the turret of one whose end was not seen */

int gear_init(struct gear *gear, uint32_t capacity)
{
    gear->slots = capacity < GEAR_SLOTS_MAX ? capacity : GEAR_SLOTS_MAX;
    gear->state = calloc(gear->slots + 1, sizeof *gear->state);
    return gear->state == NULL ? -1 : 0;
}

void gear_free(struct gear *gear)
{
    free(gear->state);
    *gear = (struct gear){NULL, 0};
}

/* The turret to the right, the gun up, to point at what is attacked; ahead when nothing is. */
static void aim(const struct moment *moment, uint32_t slot, double *turret, double *gun)
{
    const struct entities *e = moment->entities;
    uint32_t target = e->target_slot[slot];
    *turret = *gun = 0.0;
    if (e->behaviour[slot] != BEHAVIOUR_ATTACK || !entities_alive(e, target, e->target_id[slot]))
        return;
    double x = e->x[target] - e->x[slot], y = e->y[target] - e->y[slot];
    double z = e->z[target] - e->z[slot];
    *turret = maths_wrap_half(maths_heading(x, z) - e->heading[slot]);
    double up = maths_atan2(y, sqrt(x * x + z * z)) - e->pitch[slot] * maths_cos(*turret);
    *gun = maths_clamp(up, GUN_LEAST_RAD, GUN_MOST_RAD);
}

static struct gear_state first_sight(const struct moment *moment, uint32_t slot)
{
    const struct entities *e = moment->entities;
    double turret = 0.0, gun = GUN_HANGS_RAD;
    struct gear_state state = {.id = e->id[slot],
                               .time_s = moment_time_s(moment),
                               .x = e->x[slot],
                               .y = e->y[slot],
                               .z = e->z[slot],
                               .heading = e->heading[slot]};
    if (e->state[slot] == ENTITY_WRECK)
        turret = WRECK_TURN_RAD * ((double)grain_unit((int32_t)state.id, 0, 41) * 2.0 - 1.0);
    else
        aim(moment, slot, &turret, &gun);
    state.turret_rad = (float)turret;
    state.gun_rad = (float)gun;
    return state;
}

/* From one angle towards another, by no more than so much, the short way around. */
static float follow(float from, double to, double most)
{
    double way = maths_wrap_half(to - (double)from);
    return (float)maths_wrap_half((double)from + maths_clamp(way, -most, most));
}

static double wrapped(double way)
{
    return way - GEAR_WRAP_M * floor(way / GEAR_WRAP_M);
}

/* What it has rolled since: along its own axis; the outer side of a bend further. */
static void roll(struct gear_state *state, const struct moment *moment, uint32_t slot)
{
    const struct entities *e = moment->entities;
    const struct kind *kind = &moment->world->kinds[e->kind[slot]];
    struct pose pose = pose_of(e->heading[slot], e->pitch[slot], e->roll[slot]);
    struct vec3 moved = {e->x[slot] - state->x, e->y[slot] - state->y, e->z[slot] - state->z};
    double way = vec3_dot(moved, pose.forward);
    double turned = maths_wrap_half(e->heading[slot] - state->heading);
    double more = turned * TRACK_APART * kind->width_m;
    state->way_m[0] = wrapped(state->way_m[0] + way + more);
    state->way_m[1] = wrapped(state->way_m[1] + way - more);
    if (fabs(way) > STEER_LEAST_M) {
        double steer = maths_atan2(turned * WHEELBASE * kind->length_m, way);
        if (way < 0.0)
            steer = maths_atan2(-turned * WHEELBASE * kind->length_m, -way);
        steer = maths_clamp(steer, -GEAR_STEER_MAX, GEAR_STEER_MAX);
        state->steer_rad += (float)(STEER_FOLLOWS * (steer - (double)state->steer_rad));
    }
}

static void go_on(struct gear_state *state, const struct moment *moment, uint32_t slot, double dt_s)
{
    const struct entities *e = moment->entities;
    double turret, gun;
    if (e->state[slot] == ENTITY_WRECK) { /* it stands as it was hit, and the gun sinks */
        turret = (double)state->turret_rad;
        gun = GUN_HANGS_RAD;
    } else {
        aim(moment, slot, &turret, &gun);
        roll(state, moment, slot);
    }
    state->turret_rad = follow(state->turret_rad, turret, GEAR_TURRET_RADS * dt_s);
    state->gun_rad = follow(state->gun_rad, gun, GEAR_GUN_RADS * dt_s);
    state->time_s += dt_s;
    state->x = e->x[slot];
    state->y = e->y[slot];
    state->z = e->z[slot];
    state->heading = e->heading[slot];
}

void gear_note(struct gear *gear, const struct moment *moment)
{
    const struct entities *e = moment->entities;
    double now_s = moment_time_s(moment);
    for (uint32_t i = 0; i < moment->head->used && i < gear->slots; i++) {
        struct gear_state *state = &gear->state[i];
        if (e->state[i] == ENTITY_FREE || e->kind[i] >= moment->world->counts.kinds ||
            moment->world->kinds[e->kind[i]].domain == DOMAIN_MUNITION)
            continue;
        double dt_s = now_s - state->time_s;
        if (state->id != e->id[i] || dt_s < 0.0 || dt_s > GEAR_JUMP_S)
            *state = first_sight(moment, i);
        else
            go_on(state, moment, i, dt_s);
    }
}

struct gear_state gear_of(const struct gear *gear, const struct moment *moment, uint32_t slot)
{
    if (gear == NULL || slot >= gear->slots || gear->state[slot].id != moment->entities->id[slot])
        return first_sight(moment, slot);
    return gear->state[slot];
}
