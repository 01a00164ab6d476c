/* What moving one entity needs, and the motions by domain. Each function reads the committed world
 * and writes row i of the moved table only, so rows may be moved in any order, by any thread. */
#ifndef JOLON_MOVER_MOVE_H
#define JOLON_MOVER_MOVE_H

#include "mover/near.h"
#include "mover/outlook.h"
#include "world/world.h"

struct avoid;
struct company;
struct easy;
struct scars;
struct footing;
union lanes;

struct move {
    const struct world *world;
    const struct crater_index *craters;
    const struct near *near;       /* of the committed world */
    const struct outlook *outlook; /* likewise */
    const struct avoid *avoid;
    const struct company *company; /* of this frame */
    const struct state *committed;
    const struct scars *scars; /* likewise */
    const struct easy *easy;
    struct entities *m;
    struct footing_patch *patches;       /* [capacity] row i's is its own as its row is */
    struct footing_patch *patches_ahead; /* [capacity] likewise: where an aircraft soon will be */
    uint64_t tick;                       /* that this frame reaches */
    uint32_t think;                      /* [frame] between two thoughts of one agent */
    uint32_t turn; /* [frame] between two of its looks, a whole number of thoughts */
    uint32_t aim;  /* [frame] between two shots that it tries */
    double dt_s;
};

/* Is it row i's turn to think? */
static inline bool move_thinks(const struct move *move, uint32_t i)
{
    return near_divides(move->near->thoughts, (uint32_t)move->tick + move->m->id[i]);
}

/* What an agent, or a player, wants of a vehicle this frame. */
struct wish {
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

/* sea.c (land.h and air.h have the others): true when the way is blocked: land, the world's edge.
 */
bool move_sea(const struct move *move, uint32_t i, const struct wish *wish);

/* flight.c: munitions. */
void move_flight(const struct move *move, uint32_t i);

/* spin.c: turns a body by its spin columns for the frame, and slows them: on the ground and on the
 * water about the vertical alone, in the air about the centre of mass. */
void spin_turn(const struct move *move, uint32_t i);

/* The same where there may be no spin; true when there was. */
static inline bool spin_row(const struct move *move, uint32_t i)
{
    const struct entities *m = move->m;
    if (m->spin_x[i] == 0.0 && m->spin_y[i] == 0.0 && m->spin_z[i] == 0.0)
        return false;
    spin_turn(move, i);
    return true;
}

/* driven.c: what the controls of row i ask of it; takes them from whoever drives it. */
void driven_wish(const struct move *move, uint32_t i, struct wish *wish);
void move_let_go(const struct entities *m, uint32_t i);

/* agent.c: row i's agent thinks and sets its controls, where they are its own. The wish is a
 * script's or a driver's. */
void agent_think(const struct move *move, uint32_t i, struct wish *wish);

/* Row i moves by a wish of its own: on a script or driven, or on its way back to a script. Thinks
 * and tries to fire, if it is its turn. */
void agent_alone(const struct move *move, uint32_t i, struct wish *wish);

/* What row i's controls, as its agent set them, ask of its body. */
void agent_hold(const struct move *move, uint32_t i, struct wish *wish);

/* Do scripts and drivers have the controls for themselves, and so think in every frame? */
static inline bool agent_at_once(enum behaviour behaviour)
{
    return behaviour == BEHAVIOUR_DRIVEN || behaviour == BEHAVIOUR_SCRIPT;
}

/* The agent hears that its way is blocked. */
void agent_blocked(const struct move *move, uint32_t i);

/* pose.c: shared by the motions. */
double pose_ground(const struct move *move, double x, double z);
void pose_ground_lanes(const struct move *move, struct footing *footing, const union lanes *x,
                       const union lanes *z, union lanes *ground);
/* Height over a body's position to aim at [m]: the middle of what can be hit. */
double pose_aim_height(const struct move *move, uint16_t kind);
/* Heading turned towards wanted by at most rate_rps * dt. */
double pose_turn(double heading, double wanted, double rate_rps, double dt_s);
/* Turns row i as the wish asks, at most at rate_rps. */
void pose_steer(const struct move *move, uint32_t i, const struct wish *wish, double rate_rps);
/* How hard a vehicle slows [m/s2] that goes at forward and wants another speed: an agent, and a
 * driver who brakes or reverses, as hard as its kind can; one who lets the throttle go, drag_mps2.
 */
double pose_slowing(const struct kind *kind, const struct wish *wish, double forward,
                    double drag_mps2);
/* Speed [m/s] along the heading, and to its right, by the heading's sine and cosine. */
void pose_along(const struct entities *m, uint32_t i, double sine, double cosine, double *forward,
                double *rightward);
/* Value moved towards wanted by at most step. */
double pose_approach(double value, double wanted, double step);
/* Moves a coordinate of the map by its speed; at the world's edge both end. */
void pose_advance(double *metres, double *speed_mps, double dt_s);
/* Burns fuel at a share of full throttle; false when the tank is empty. A kind without a tank
 * (fuel_l 0) never runs dry. */
bool pose_burn(const struct move *move, uint32_t i, double share);

#endif
