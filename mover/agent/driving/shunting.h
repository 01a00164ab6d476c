/* Wheeled vehicles turn in little room by driving to and fro.
 *
 * Wheels turn no vehicle that stands, and none in a tighter circle than they can. An agent that has
 * to turn therefore drives forwards with its wheels turned. Where it has no room for that it turns
 * by strokes to and fro: it drives back with its wheels turned the other way, and forwards again,
 * until it heads where it wants. A plan of all strokes (driving/shunting_room.h) says if and by
 * which side that leads there. Where it does not, the vehicle backs out: it drives backwards to
 * where it wants to go, until it has room. It does so, too, when its goal is within its turning
 * circle, and when it is to turn where it is.
 *
 * The fields keep a stroke from decision to decision. The sign of the throttle says if it goes
 * forwards or backwards, also that of a throttle of 0. The dodge has a full turn more to the side
 * to which the vehicle turns, and two where it drives straight on. */
#ifndef JOLON_MOVER_AGENT_DRIVING_SHUNTING_H
#define JOLON_MOVER_AGENT_DRIVING_SHUNTING_H

#include "mover/agent/driving/shunting_room.h"
#include "mover/context/step_context.h"

/* What a vehicle does next to get to a heading. */
struct shunting_way {
    struct shunting_stroke stroke;
    double heading_rad; /* to steer for in the stroke */
    double free_m;      /* how far it may go */
    bool backs_out;     /* it drives back as far as it sees, to where heading_rad says, instead */
};

/* Returns true if row i is a land vehicle with wheels. */
bool shunting_has_wheels(const struct step_context *context, uint32_t i);

/* Returns true if the kind has to turn its hull to aim its gun, and cannot do so where it stands.
 */
bool shunting_aims_hull(const struct kind *kind);

/* Returns the speed of strokes [m/s]. faces: to turn about its place. */
double shunting_speed(const struct kind *kind, bool faces);

/* Returns the dodge of row i without the turns that say how it shunts. */
double shunting_dodge(const struct entities *m, uint32_t i);

/* Lets row i turn to a heading about where it is, and stand when it has it within exact_rad:
 * vehicles on wheels to and fro, others on the spot. Returns true if it has it. */
bool shunting_face(const struct step_context *context, uint32_t i, double heading_rad,
                   double exact_rad, struct desired_motion *desired);

/* Lets row i drive to a place near by, which is this far east and south of it: on wheels backwards
 * where the place is behind it, nearer than it could turn. */
void shunting_drive(const struct step_context *context, uint32_t i, double east_m, double south_m,
                    double speed_mps, struct desired_motion *desired);

/* Returns true if row i may have to shunt to get to a heading, so that it looks for room. */
bool shunting_looks(const struct step_context *context, uint32_t i, double heading_rad,
                    const struct desired_motion *desired);

/* Returns true if such a row shunts: it does so already, or gets to the heading by no arc in its
 * room, or its goal is within its turning circle. */
bool shunting_begins(const struct step_context *context, uint32_t i,
                     const struct shunting_room *room, double heading_rad,
                     const struct desired_motion *desired);

/* Chooses how row i gets to a heading. Returns false if it has no room to move. */
bool shunting_choose(const struct step_context *context, uint32_t i,
                     const struct shunting_room *room, double heading_rad,
                     const struct desired_motion *desired, struct shunting_way *way);

/* Writes the way that row i takes to its dodge, and changes its desired motion. */
void shunting_take(const struct step_context *context, uint32_t i, const struct shunting_way *way,
                   struct desired_motion *desired);

/* Lets row i go on with its stroke, if it has one, between two decisions. */
void shunting_keep(const struct step_context *context, uint32_t i, struct desired_motion *desired);

#endif
