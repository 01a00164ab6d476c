/* Parts of motion shared by the domains, for one body. kinematics_simd.h has them for four
 * bodies. */
#ifndef JOLON_MOVER_MOTION_KINEMATICS_H
#define JOLON_MOVER_MOTION_KINEMATICS_H

#include "mover/context/step_context.h"

struct terrain_cache;
union simd_lanes;

/* Height of the ground [m], craters included; and of eight points. */
double kinematics_ground(const struct step_context *context, double x, double z);
void kinematics_ground_lanes(const struct step_context *context, struct terrain_cache *cache,
                             const union simd_lanes *x, const union simd_lanes *z,
                             union simd_lanes *ground);

/* Height of the aim point above a body's position [m]: the middle of what can be hit. */
double kinematics_aim_height(const struct step_context *context, uint16_t kind);

/* The heading turned towards wanted by at most rate_rps * dt_s. */
double kinematics_turn(double heading, double wanted, double rate_rps, double dt_s);

/* Sets what row i asks of the serial part of this frame: TRIGGER_* of mover/context/step_context.h.
 */
void kinematics_tell(const struct step_context *context, uint32_t i, uint8_t trigger);

/* Turns row i as desired, by at most rate_rps. */
void kinematics_steer(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired, double rate_rps);

/* Speed [m/s] along the heading and to its right. */
void kinematics_along(const struct entities *m, uint32_t i, double sine, double cosine,
                      double *forward, double *rightward);

/* The value moved towards wanted by at most step. */
double kinematics_approach(double value, double wanted, double step);

/* Advances a map coordinate by its speed over a step. At the edge of the world the coordinate and
 * the speed stop. */
void kinematics_advance(const struct step_context *context, double *metres, double *speed_mps);

/* Returns true if row i has the order to stand, and stands. The engine of a land vehicle is then
 * off. */
static inline bool kinematics_parked(const struct entities *m, uint32_t i)
{
    return m->row[i].behaviour == BEHAVIOUR_IDLE && m->row[i].order == BEHAVIOUR_IDLE &&
           m->row[i].throttle == 0.0f && m->row[i].vx == 0.0 && m->row[i].vz == 0.0;
}

/* Returns how many frames' fuel the engine of row i, a land vehicle with an agent, burns in this
 * one. Where it stands, it burns in its turn to decide that of the frames to the next one, so that
 * nothing changes between. */
static inline uint32_t kinematics_burn_frames(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (kinematics_parked(m, i))
        return 0;
    if (m->row[i].throttle != 0.0f || m->row[i].vx != 0.0 || m->row[i].vz != 0.0)
        return 1;
    return step_context_thinks(context, i) ? context->think_frames : 0;
}

/* Helicopters with the order to stand burn the fuel of so many seconds at once while they hover. */
#define KINEMATICS_HOVER_S    10.0
#define KINEMATICS_HOVER_ROWS 1024u

/* Frames from one such time to the next. */
static inline uint32_t kinematics_hover_frames(const struct step_context *context)
{
    return (uint32_t)maths_max(1.0, KINEMATICS_HOVER_S / context->dt_s);
}

/* Returns true if row i burns that fuel in this frame. KINEMATICS_HOVER_ROWS rows, beginning with a
 * multiple of this number, burn it in the same frame. */
static inline bool kinematics_hover_burns(const struct step_context *context, uint32_t i)
{
    uint32_t block = i / KINEMATICS_HOVER_ROWS;
    return ((uint32_t)context->tick + block) % kinematics_hover_frames(context) == 0;
}

/* Burns fuel at a share of full throttle. False when the tank is empty. A kind without a tank
 * (fuel_l 0) always has fuel. */
bool kinematics_burn(const struct step_context *context, uint32_t i, double share);

/* What a row changes by while it cruises (world/entity/cruise.h). */
struct cruise_changes {
    uint32_t frames;                             /* of the stretch */
    double turned_rad, gain_mps2;                /* in all; a second */
    double climbed_mps, pitched_rad, rolled_rad; /* in all, of aircraft; else 0 */
};

/* Notes in row i that its stretch begins in this frame, and what changes in it. */
void kinematics_cruise(const struct step_context *context, uint32_t i,
                       const struct cruise_changes *changes);

#endif
