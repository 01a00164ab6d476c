/* Moves aircraft: steering, speed, climb and lean. */
#include "mover/motion/aircraft.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/kinematics_simd.h"
#include "world/maths/cpu_dispatch.h"
#include "world/maths/rotation.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define LOOK_AHEAD_S   3.0
#define SIDE_DRAG_MPS2 6.0
#define BANK_LIMIT     1.0 /* [rad] */
#define BANK_RATE_RPS  1.5
#define EDGE_M         200.0 /* an aircraft turns back so far from the edge of the world */

void aircraft_begin(struct aircraft *batch)
{
    memset(batch, 0, sizeof *batch);
    for (int l = 0; l < LANE_COUNT; l++)
        batch->here.patch[l] = batch->ahead.patch[l] = &batch->idle;
}

static void take_kind(struct aircraft *batch, int l, const struct kind *kind)
{
    batch->full_mps.lane[l] = kind->max_speed_mps;
    batch->least_mps.lane[l] = kind->min_speed_mps;
    batch->acceleration.lane[l] = kind->acceleration_mps2;
    batch->turn_rate.lane[l] = kind->turn_rate_rps;
    batch->climb_rate.lane[l] = kind->climb_rate_mps;
    batch->burn_lps.lane[l] = kind->fuel_lps;
    batch->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

bool aircraft_take(const struct step_context *context, struct aircraft *batch, uint32_t i,
                   const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    int l = batch->count++;
    batch->row[l] = i;
    batch->here.patch[l] = &context->terrain_entries[i];
    batch->ahead.patch[l] = &context->terrain_entries_ahead[i];
    __builtin_prefetch(batch->ahead.patch[l]);
    batch->driven.lane[l] = -(int64_t)desired->driven;
    batch->wanted_heading.lane[l] = desired->heading_rad;
    batch->wanted_mps.lane[l] = desired->speed_mps;
    batch->altitude.lane[l] = desired->altitude_m;
    batch->turn.lane[l] = desired->turn;
    batch->climb.lane[l] = desired->climb_mps;
    batch->brake.lane[l] = desired->brake;
    batch->x.lane[l] = m->x[i];
    batch->y.lane[l] = m->y[i];
    batch->z.lane[l] = m->z[i];
    batch->vx.lane[l] = m->vx[i];
    batch->vy.lane[l] = m->vy[i];
    batch->vz.lane[l] = m->vz[i];
    batch->heading.lane[l] = m->heading[i];
    batch->pitch.lane[l] = m->pitch[i];
    batch->roll.lane[l] = m->roll[i];
    batch->fuel.lane[l] = m->fuel_l[i];
    take_kind(batch, l, &context->world->kinds[m->kind[i]]);
    return batch->count == LANE_COUNT;
}

/* The higher of the ground here and ahead. */
static inline void find_highest(const struct step_context *context, struct aircraft *batch,
                                union simd_lanes *highest)
{
    union simd_lanes x, z, ahead;
    for (int h = 0; h < LANE_FOURS; h++) {
        x.f64x4[h] = batch->x.f64x4[h] + batch->vx.f64x4[h] * LOOK_AHEAD_S;
        z.f64x4[h] = batch->z.f64x4[h] + batch->vz.f64x4[h] * LOOK_AHEAD_S;
    }
    kinematics_ground_lanes(context, &batch->here, &batch->x, &batch->z, highest);
    kinematics_ground_lanes(context, &batch->ahead, &x, &z, &ahead);
    for (int h = 0; h < LANE_FOURS; h++)
        highest->f64x4[h] = SIMD_MAX(highest->f64x4[h], ahead.f64x4[h]);
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Comments describe one aircraft. Each function treats the four of vector h. */

/* Computes the desired speed and climb, and burns fuel for them. Without fuel an aircraft glides
 * down. */
static inline void want(struct aircraft *batch, int h, const f64x4 *ground, double dt_s,
                        f64x4 *wanted, f64x4 *climb)
{
    const f64x4 none = SIMD_EVERY(0.0);
    four_masks driven = batch->driven.f64x4[h], dry;
    f64x4 full = batch->full_mps.f64x4[h], most = batch->climb_rate.f64x4[h];
    f64x4 least = SIMD_NEGATIVE(most);
    f64x4 by_agent = SIMD_CLAMP(batch->wanted_mps.f64x4[h], batch->least_mps.f64x4[h], full);
    /* A driver's speed is not clamped: helicopters also fly backwards. */
    *wanted = SIMD_CHOOSE(driven, batch->wanted_mps.f64x4[h], by_agent);
    f64x4 off = (*ground + batch->altitude.f64x4[h] - batch->y.f64x4[h]) * 0.8;
    off = SIMD_CLAMP(off, least, most);
    *climb = SIMD_CHOOSE(driven, batch->climb.f64x4[h], off);
    f64x4 share = SIMD_ABS(*wanted) / SIMD_MAX(full, SIMD_EVERY(1e-9));
    share = SIMD_CLAMP(share, SIMD_EVERY(0.2), SIMD_EVERY(1.0));
    kinematics_simd_burn(&batch->fuel.f64x4[h], &batch->burn_lps.f64x4[h], &share,
                         &batch->tank.f64x4[h], dt_s, &dry);
    *wanted = SIMD_CHOOSE(dry, none, *wanted);
    *climb = SIMD_CHOOSE(dry, least, *climb);
}

/* kinematics_advance() */
static inline void advance(f64x4 *metres, f64x4 *speed_mps, double dt_s)
{
    f64x4 to = *metres + *speed_mps * dt_s;
    *metres = SIMD_CLAMP(to, SIMD_EVERY(0.0), SIMD_EVERY(WORLD_SIDE_M));
    *speed_mps = SIMD_CHOOSE(to != *metres, SIMD_EVERY(0.0), *speed_mps);
}

/* Moves it, and notes whether it is near the edge. */
static inline void change_position(struct aircraft *batch, int h, double dt_s)
{
    const f64x4 last = SIMD_EVERY(WORLD_SIDE_M - EDGE_M);
    advance(&batch->x.f64x4[h], &batch->vx.f64x4[h], dt_s);
    advance(&batch->z.f64x4[h], &batch->vz.f64x4[h], dt_s);
    batch->y.f64x4[h] += batch->vy.f64x4[h] * dt_s;
    batch->blocked.f64x4[h] = (batch->x.f64x4[h] < EDGE_M) | (batch->z.f64x4[h] < EDGE_M) |
                              (batch->x.f64x4[h] > last) | (batch->z.f64x4[h] > last);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* What the lean follows from. A helicopter pitches with its speed and acceleration, a jet with its
 * climb. */
struct lean {
    union simd_lanes turning, weight, rising, level, hover;
};

static inline void lean(const struct step_context *context, struct aircraft *batch,
                        const struct lean *lean)
{
    const f64x4 most = SIMD_EVERY(BANK_LIMIT), least = SIMD_EVERY(-BANK_LIMIT);
    const f64x4 step = SIMD_EVERY(BANK_RATE_RPS * context->dt_s);
    union simd_lanes bank, nose;
    maths_slopes_lanes(&lean->turning, &lean->weight, &bank);
    maths_slopes_lanes(&lean->rising, &lean->level, &nose);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 to = SIMD_CLAMP(bank.f64x4[h], least, most);
        kinematics_simd_approach(&batch->roll.f64x4[h], &to, &step);
        to = SIMD_CHOOSE(batch->least_mps.f64x4[h] > 0.0, nose.f64x4[h], lean->hover.f64x4[h]);
        kinematics_simd_approach(&batch->pitch.f64x4[h], &to, &step);
    }
}

/* Steering turns the spin with the aircraft. The same spin about other axes of the body would have
 * another energy. */
static void carry_spin(struct entities *m, uint32_t i, const struct aircraft *batch, int l)
{
    const struct vec3 spin = {m->spin_x[i], m->spin_y[i], m->spin_z[i]};
    if (vec3_dot(spin, spin) == 0.0)
        return;
    struct mat3 before = rotation_matrix(rotation_of(m->heading[i], m->pitch[i], m->roll[i]));
    struct mat3 after = rotation_matrix(
        rotation_of(batch->heading.lane[l], batch->pitch.lane[l], batch->roll.lane[l]));
    struct vec3 turned = rotation_apply(&after, rotation_back(&before, spin));
    m->spin_x[i] = turned.x;
    m->spin_y[i] = turned.y;
    m->spin_z[i] = turned.z;
}

static void write_rows(const struct step_context *context, const struct aircraft *batch)
{
    struct entities *m = context->m;
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        carry_spin(m, i, batch, l);
        m->x[i] = batch->x.lane[l];
        m->y[i] = batch->y.lane[l];
        m->z[i] = batch->z.lane[l];
        m->vx[i] = batch->vx.lane[l];
        m->vy[i] = batch->vy.lane[l];
        m->vz[i] = batch->vz.lane[l];
        m->heading[i] = batch->heading.lane[l];
        m->pitch[i] = batch->pitch.lane[l];
        m->roll[i] = batch->roll.lane[l];
        m->fuel_l[i] = batch->fuel.lane[l];
    }
}

VECTOR_CLONES
void aircraft_move(const struct step_context *context, struct aircraft *batch)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-9), one = SIMD_EVERY(1.0);
    const f64x4 drag = SIMD_EVERY(SIDE_DRAG_MPS2 * context->dt_s);
    union simd_lanes ground, sine, cosine, forward, rightward, turned;
    struct lean leaning;
    find_highest(context, batch, &ground);
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 vx = batch->vx.f64x4[h], vz = batch->vz.f64x4[h], before = batch->heading.f64x4[h];
        struct kinematics_simd_helm helm = {batch->wanted_heading.f64x4[h], batch->turn.f64x4[h],
                                            batch->driven.f64x4[h]};
        forward.f64x4[h] = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        kinematics_simd_steer(&batch->heading.f64x4[h], &helm, &batch->turn_rate.f64x4[h],
                              context->dt_s);
        turned.f64x4[h] = batch->heading.f64x4[h] - before;
        kinematics_simd_wrap_half(&turned.f64x4[h]);
    }
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 wanted, climb, gain = batch->acceleration.f64x4[h] * context->dt_s;
        f64x4 speed = forward.f64x4[h], before = speed;
        want(batch, h, &ground.f64x4[h], context->dt_s, &wanted, &climb);
        f64x4 faster = gain * (1.0 + batch->brake.f64x4[h]), steeper = 2.0 * gain;
        kinematics_simd_approach(&speed, &wanted, &faster);
        kinematics_simd_approach(&rightward.f64x4[h], &none, &drag);
        batch->vx.f64x4[h] = speed * sine.f64x4[h] + rightward.f64x4[h] * cosine.f64x4[h];
        batch->vz.f64x4[h] =
            SIMD_NEGATIVE(speed) * cosine.f64x4[h] + rightward.f64x4[h] * sine.f64x4[h];
        kinematics_simd_approach(&batch->vy.f64x4[h], &climb, &steeper);
        change_position(batch, h, context->dt_s);
        f64x4 full = SIMD_MAX(batch->full_mps.f64x4[h], least);
        leaning.turning.f64x4[h] = turned.f64x4[h] / context->dt_s * speed;
        leaning.weight.f64x4[h] = SIMD_EVERY(GRAVITY_MPS2);
        leaning.rising.f64x4[h] = batch->vy.f64x4[h];
        leaning.level.f64x4[h] = SIMD_MAX(speed, one);
        leaning.hover.f64x4[h] =
            -0.12 * speed / full - 0.1 * (speed - before) / SIMD_MAX(gain, least);
    }
    lean(context, batch, &leaning);
    write_rows(context, batch);
}
