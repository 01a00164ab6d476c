/* How a vehicle cruises: it moves for many frames at once (docs/decisions/049-cruising.md).
 *
 * A vehicle that goes on as it did is moved by a whole stretch of half a second. Its fields then
 * hold where it is at the end of the stretch, which cruise_tick names, and nothing writes to its
 * row before that. Where it is at a tick on the way follows from the row: it turns and gains speed
 * evenly, so it is on an arc. Height, pitch and roll of a land vehicle are those of the ground
 * there (world/cruise_pose.h). Those of a ship change little; the climb, the pitch and the roll of
 * an aircraft change evenly.
 *
 * The mover begins a stretch, and it ends by itself. The collider ends it in the frame in which it
 * begins if anything stands, rests or cruises where it leads, and later when a body comes there. So
 * nothing is ever in the box around what is left of a stretch but the vehicle itself.
 *
 * All functions are pure; any thread. tick: of the frame that is asked for. */
#ifndef JOLON_WORLD_ENTITY_CRUISE_H
#define JOLON_WORLD_ENTITY_CRUISE_H

#include "world/entity/entity.h"

#include <stdbool.h>

/* A stretch lasts for so long [s], in whole frames. In a world in which agents decide seldom, those
 * of land vehicles, and in a crowd those of aircraft, last for up to CRUISE_LONG_S
 * (mover/context/cruise_start.h). */
#define CRUISE_S      0.5
#define CRUISE_LONG_S 5.0

/* Returns the frames of a stretch; 1: the frames are so long that none pays. */
static inline uint32_t cruise_frames(double dt_s)
{
    double frames = CRUISE_S / dt_s;
    return frames < 2.0 ? 1u : (uint32_t)(frames + 0.5);
}

/* Returns true if the row's fields hold where it is after this tick. */
static inline bool cruise_goes(const struct entities *e, uint32_t i, uint64_t tick)
{
    return e->row[i].cruise_tick > tick;
}

/* Returns the length of the chord of an arc of this length that turns by twice half_rad, which is
 * at most 1: to 1e-6 of it, by the series of sin(x) / x. */
static inline double cruise_chord(double arc_m, double half_rad)
{
    double square = half_rad * half_rad;
    return arc_m * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)));
}

/* Returns where an arc of this length ends that begins at a place with a heading and turns by this
 * much, on the map: the height is that of its begin. */
static inline struct vec3 cruise_end(struct vec3 from, double heading_rad, double turned_rad,
                                     double arc_m)
{
    double way_m = cruise_chord(arc_m, 0.5 * turned_rad), sine, cosine;
    maths_sincos(heading_rad + 0.5 * turned_rad, &sine, &cosine);
    return (struct vec3){from.x + way_m * sine, from.y, from.z - way_m * cosine};
}

/* Returns how far at most the way of what is left of a stretch is from that of a shorter one which
 * ends on it [m]: the formula for an arc is exact only if the speed or the heading stays. */
static inline double cruise_off(double rps, double mps2, double left_s)
{
    return fabs(rps * mps2) * left_s * left_s * left_s / 12.0;
}

/* A stretch is made shorter, and a long one begins, if its way is no further off [m]. */
#define CRUISE_OFF_M 0.004

/* Returns the time from the tick to the end of the stretch [s]; 0 without one. */
static inline double cruise_left_s(const struct entities *e, uint32_t i, uint64_t tick, double dt_s)
{
    return cruise_goes(e, i, tick) ? (double)(e->row[i].cruise_tick - tick) * dt_s : 0.0;
}

/* Returns where the row is at the tick, on its arc. The height is between those of the ends: the
 * ground may be some decimetres higher or lower. */
static inline struct vec3 cruise_position(const struct entities *e, uint32_t i, uint64_t tick,
                                          double dt_s)
{
    struct vec3 at = {e->row[i].x, e->row[i].y, e->row[i].z};
    double left_s = cruise_left_s(e, i, tick, dt_s), sine, cosine;
    if (!(left_s > 0.0))
        return at;
    maths_sincos(e->row[i].heading, &sine, &cosine);
    double forward_mps = e->row[i].vx * sine - e->row[i].vz * cosine;
    double half_rad = 0.5 * e->row[i].cruise_rps * left_s, way_m;
    way_m = cruise_chord((forward_mps - 0.5 * e->row[i].cruise_mps2 * left_s) * left_s, half_rad);
    maths_sincos(e->row[i].heading - half_rad, &sine, &cosine);
    at.x -= way_m * sine;
    at.y -= (e->row[i].vy - 0.5 * (double)e->row[i].cruise_climb_mps2 * left_s) * left_s;
    at.z += way_m * cosine;
    return at;
}

/* Returns where the row heads at the tick [rad]. */
static inline double cruise_heading(const struct entities *e, uint32_t i, uint64_t tick,
                                    double dt_s)
{
    double left_s = cruise_left_s(e, i, tick, dt_s);
    return left_s > 0.0 ? maths_wrap_turn(e->row[i].heading - e->row[i].cruise_rps * left_s)
                        : e->row[i].heading;
}

/* Returns how fast the row climbs so long before the end of its stretch [m/s]. */
static inline double cruise_climb(const struct entities *e, uint32_t i, double left_s)
{
    return e->row[i].vy - (double)e->row[i].cruise_climb_mps2 * left_s;
}

/* Return how an aircraft leans at the tick [rad]. */
static inline double cruise_pitch(const struct entities *e, uint32_t i, uint64_t tick, double dt_s)
{
    return e->row[i].pitch - (double)e->row[i].cruise_pitch_rps * cruise_left_s(e, i, tick, dt_s);
}

static inline double cruise_roll(const struct entities *e, uint32_t i, uint64_t tick, double dt_s)
{
    return e->row[i].roll - (double)e->row[i].cruise_roll_rps * cruise_left_s(e, i, tick, dt_s);
}

/* Returns the velocity of the row at the tick [m/s]. */
static inline struct vec3 cruise_velocity(const struct entities *e, uint32_t i, uint64_t tick,
                                          double dt_s)
{
    struct vec3 velocity = entities_velocity(e, i);
    double left_s = cruise_left_s(e, i, tick, dt_s), sine, cosine;
    if (!(left_s > 0.0))
        return velocity;
    maths_sincos(e->row[i].heading, &sine, &cosine);
    double forward_mps = velocity.x * sine - velocity.z * cosine - e->row[i].cruise_mps2 * left_s;
    maths_sincos(e->row[i].heading - e->row[i].cruise_rps * left_s, &sine, &cosine);
    return (struct vec3){forward_mps * sine, cruise_climb(e, i, left_s), -forward_mps * cosine};
}

#endif
