/* Answers to contacts: figure 8 of the thesis, impulses, blasts, craters. All of it works on the
 * frame being made and on nothing else. */
#ifndef JOLON_COLLIDER_RESPONSE_RESPONSE_H
#define JOLON_COLLIDER_RESPONSE_RESPONSE_H

#include "collider/broad_phase/broad_phase.h"
#include "collider/narrow_phase/contact_queue.h"
#include "collider/motion/body_motion.h"
#include "collider/response/event_writer.h"
#include "collider/response/contact_solver.h"
#include "world/checksum.h"
#include "world/entity/table_write.h"
#include "world/state.h"

/* A charge that goes off in this frame. */
struct charge {
    struct vec3 point;
    double time; /* 0..1 */
    double explosive_kg;
    uint32_t owner_slot, owner_id; /* who fired it; 0 for nobody */
};

/* Charges that wait, more of them as blasts destroy what explodes in turn; the collider's own
 * memory. */
struct charges {
    struct charge *charge;
    uint32_t count, capacity;
    struct pair_list near; /* what a blast reaches */
};

/* explosion.c. 0, or -1 with errno ENOMEM. */
int charges_init(struct charges *charges, const struct world *world);
void charges_free(struct charges *charges);

struct island;

struct response_context {
    const struct world *world;
    struct broad_phase *broad;
    struct contact_queue *contacts;
    struct body_motion *motion;
    struct contact_input input;
    struct state *next;
    struct path *path; /* motion's */
    struct event_writer sink;
    struct charges *charges;
    struct island *island;      /* island.h */
    struct table_writer writer; /* by which every answer changes next's rows */
};

/* What a collision's answer works with. */
struct impact {
    uint32_t a, b;      /* rows; b has PAIR_FIXED for a fixed object */
    double time;        /* 0..1 */
    struct vec3 point;  /* [m, world] where the bodies touch */
    struct vec3 normal; /* unit, from a towards b; level between what the ground holds */
    double depth_m;     /* how far they overlap along the touch's own normal */
    double closing_mps; /* at the point, along the normal, >= 0 */
    double angle_rad;   /* b's heading off a's, 0..2 pi */
};

/* What an answer did, for the event. */
struct outcome {
    enum response response;
    double impulse_ns;
};

/* A collision on its way into the ring. */
struct report {
    struct event *event; /* NULL: the frame's events are full */
    struct vec3 direction_a;
};

/* --- response.c: who met whom
 * -------------------------------------------------------------------*/

/* Answers the earliest contact, and with it those of the same moment that it must be solved
 * together with. */
void response_contact(struct response_context *respond, const struct contact *contact);

struct impact response_impact(const struct response_context *respond,
                              const struct contact *contact);

/* Is the row still on its way through an object that lets it in? What of it comes in later, a hull
 * after the gun, is no new collision. Remembers the touch. */
bool passes_through(struct response_context *respond, const struct impact *impact);

/* Is this a press that goes on, no new collision? Remembers the touch in any case. */
bool contact_persists(struct response_context *respond, const struct impact *impact);

/* The event's place is taken before the answer, so that what follows from it comes after it. */
struct report response_report(struct response_context *respond, const struct impact *impact);
void write_collision_event(struct response_context *respond, const struct report *report,
                           const struct impact *impact, const struct outcome *outcome);

/* --- path_change.c: another way from a time on
 * ---------------------------------------------------------*/

/* Stays where it is for the rest of the frame and leaves with this velocity. */
void path_change_stay(struct response_context *respond, uint32_t row, double time,
                      struct vec3 velocity);

/* Goes on along its way at a share of its speed. path_change_swept must follow. */
void path_change_slow(struct response_context *respond, uint32_t row, double time, double share);

/* Goes on from `at` with this velocity and spin (path_change_spin's: the driver's steering in it
 * does not become the row's own), or stays there for the rest of the frame and takes them with it.
 * path_change_swept must follow, for every row that leaves at this time, once all of them have
 * left. */
void path_change_leave(struct response_context *respond, uint32_t row, double time, struct vec3 at,
                       struct vec3 velocity, struct vec3 spin_rps, bool stays);
void path_change_swept(struct response_context *respond, const uint32_t *rows, uint32_t count,
                       double time);

/* How the row turns [rad/s, world axes]: what collisions gave it; on the ground what its driver
 * steers, too. */
struct vec3 path_change_spin(const struct response_context *respond, uint32_t row);

/* Does the ground hold the row: a land vehicle, a ship, a wreck that lies? */
bool path_change_grounded(const struct response_context *respond, uint32_t row);

/* --- island.c: impulses, all contacts of one moment together -----------------------------------*/

/* contact was just taken; takes those of the same moment that are answered by impulses too. */
void island_answer(struct response_context *respond, const struct contact *contact);

/* --- damage.c: energy becomes damage. damage_row destroys at the kind's resistance_j.
 * --------------*/
void damage_row(struct response_context *respond, uint32_t row, double joules, double time);
void damage_destroy(struct response_context *respond, uint32_t row, double time);
enum damage damage_fixed_object(struct response_context *respond, uint32_t object, double joules);
/* Energy over a fixed kind's resistance_j from which its damage is high. */
double damage_high_share(const struct response_context *respond, const struct kind *kind);

/* --- impact_damage.c: harm and a dent
 * -------------------------------------------------------------------*/

/* The row takes this energy, struck at the impact's point; side 1: inwards is along the normal, -1:
 * against it. spring: by which it was struck, else NULL. */
struct spring_impact;
void impact_damage_row(struct response_context *respond, uint32_t row, const struct impact *impact,
                       double side, double joules, const struct spring_impact *spring);

/* --- response_figure8.c: the thesis's own answers
 * -------------------------------------------------------*/
void response_figure8_moving(struct response_context *respond, const struct impact *impact,
                             struct outcome *outcome);
void response_figure8_fixed(struct response_context *respond, const struct impact *impact,
                            struct outcome *outcome);

/* --- explosion.c: a munition ends, and what explodes with it
 * ---------------------------------------*/
void explosion_munition(struct response_context *respond, uint32_t row, uint32_t struck,
                        double time);
void explosion_charge(struct response_context *respond, const struct charge *charge);
void explosion_all(struct response_context *respond);

#endif
