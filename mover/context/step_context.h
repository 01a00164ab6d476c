/* What moving one entity needs, and the motions by domain. Each function reads the committed world
 * and writes row i of the moved table only, so rows may be moved in any order, by any thread. */
#ifndef JOLON_MOVER_CONTEXT_STEP_CONTEXT_H
#define JOLON_MOVER_CONTEXT_STEP_CONTEXT_H

#include "mover/query/neighbour_index.h"
#include "mover/query/line_of_sight.h"
#include "world/world.h"

struct avoidance;
struct neighbour_lists;
struct slope_max_map;
struct ground_marks;
struct terrain_cache;
union simd_lanes;

struct step_context {
    const struct world *world;
    const struct crater_index *craters;
    const struct neighbour_index *near;  /* of the committed world */
    const struct line_of_sight *outlook; /* likewise */
    const struct avoidance *avoid;
    const struct neighbour_lists *company; /* of this frame */
    const struct state *committed;
    const struct ground_marks *scars; /* likewise */
    const struct slope_max_map *easy;
    struct entities *m;
    struct terrain_cache_entry *patches; /* [capacity] row i's is its own as its row is */
    struct terrain_cache_entry
        *patches_ahead; /* [capacity] likewise: where an aircraft soon will be */
    uint64_t tick;      /* that this frame reaches */
    uint32_t think;     /* [frame] between two thoughts of one agent */
    uint32_t turn;      /* [frame] between two of its looks, a whole number of thoughts */
    uint32_t aim;       /* [frame] between two shots that it tries */
    double dt_s;
};

/* Is it row i's turn to think? */
static inline bool step_context_thinks(const struct step_context *move, uint32_t i)
{
    return neighbour_index_divides(move->near->thoughts, (uint32_t)move->tick + move->m->id[i]);
}

/* What an agent, or a player, wants of a vehicle this frame. */
struct desired_motion {
    double heading_rad;
    double speed_mps;  /* negative: backwards */
    double altitude_m; /* aircraft: above the ground; not when driven */
    bool driven;       /* by a command; what follows is a driver's alone */
    enum gearing gear; /* land vehicles and ships */
    double turn;       /* -1..1 of its turn rate, instead of heading_rad */
    double climb_mps;  /* aircraft, instead of altitude_m */
    double brake;      /* 0..1 of how hard it can slow */
};

#define GRAVITY_MPS2 9.80665
#define BRAKES       2.0 /* times its acceleration: how hard a vehicle slows at most */

/* trigger column: what a row asks of the step's second, serial half. */
#define TRIGGER_FIRE         1u
#define TRIGGER_FIRE_AT      2u /* at its goal, a point on the ground */
#define TRIGGER_REASON_SHIFT 2u /* enum agent_reason + 1 above it: its behaviour changed */

/* ship.c (ground_vehicle.h and aircraft.h have the others): true when the way is blocked: land, the
 * world's edge.
 */
bool ship_move(const struct step_context *move, uint32_t i, const struct desired_motion *wish);

/* projectile.c: munitions. */
void projectile_move(const struct step_context *move, uint32_t i);

/* spin.c: turns a body by its spin columns for the frame, and slows them: on the ground and on the
 * water about the vertical alone, in the air about the centre of mass. */
void spin_turn(const struct step_context *move, uint32_t i);

/* The same where there may be no spin; true when there was. */
static inline bool spin_row(const struct step_context *move, uint32_t i)
{
    const struct entities *m = move->m;
    if (m->spin_x[i] == 0.0 && m->spin_y[i] == 0.0 && m->spin_z[i] == 0.0)
        return false;
    spin_turn(move, i);
    return true;
}

/* driver_controls.c: what the controls of row i ask of it; takes them from whoever drives it. */
void driver_controls_motion(const struct step_context *move, uint32_t i,
                            struct desired_motion *wish);
void driver_controls_let_go(const struct entities *m, uint32_t i);

/* agent.c: row i's agent thinks and sets its controls, where they are its own. The wish is a
 * script's or a driver's. */
void agent_think(const struct step_context *move, uint32_t i, struct desired_motion *wish);

/* Row i moves by a wish of its own: on a script or driven, or on its way back to a script. Thinks
 * and tries to fire, if it is its turn. */
void agent_alone(const struct step_context *move, uint32_t i, struct desired_motion *wish);

/* What row i's controls, as its agent set them, ask of its body. */
void agent_hold(const struct step_context *move, uint32_t i, struct desired_motion *wish);

/* Do scripts and drivers have the controls for themselves, and so think in every frame? */
static inline bool agent_at_once(enum behaviour behaviour)
{
    return behaviour == BEHAVIOUR_DRIVEN || behaviour == BEHAVIOUR_SCRIPT;
}

/* The agent hears that its way is blocked. */
void agent_blocked(const struct step_context *move, uint32_t i);

/* kinematics.c: shared by the motions. */
double kinematics_ground(const struct step_context *move, double x, double z);
void kinematics_ground_lanes(const struct step_context *move, struct terrain_cache *footing,
                             const union simd_lanes *x, const union simd_lanes *z,
                             union simd_lanes *ground);
/* Height over a body's position to aim at [m]: the middle of what can be hit. */
double kinematics_aim_height(const struct step_context *move, uint16_t kind);
/* Heading turned towards wanted by at most rate_rps * dt. */
double kinematics_turn(double heading, double wanted, double rate_rps, double dt_s);
/* Turns row i as the wish asks, at most at rate_rps. */
void kinematics_steer(const struct step_context *move, uint32_t i,
                      const struct desired_motion *wish, double rate_rps);
/* How hard a vehicle slows [m/s2] that goes at forward and wants another speed: an agent, and a
 * driver who brakes or reverses, as hard as its kind can; one who lets the throttle go, drag_mps2.
 */
double kinematics_slowing(const struct kind *kind, const struct desired_motion *wish,
                          double forward, double drag_mps2);
/* Speed [m/s] along the heading, and to its right, by the heading's sine and cosine. */
void kinematics_along(const struct entities *m, uint32_t i, double sine, double cosine,
                      double *forward, double *rightward);
/* Value moved towards wanted by at most step. */
double kinematics_approach(double value, double wanted, double step);
/* Moves a coordinate of the map by its speed; at the world's edge both end. */
void kinematics_advance(double *metres, double *speed_mps, double dt_s);
/* Burns fuel at a share of full throttle; false when the tank is empty. A kind without a tank
 * (fuel_l 0) never runs dry. */
bool kinematics_burn(const struct step_context *move, uint32_t i, double share);

#endif
