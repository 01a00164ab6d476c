/* Answers to contacts: figure 8 of the thesis, impulses, blasts, craters. All of it works on the
 * frame being made and on nothing else. */
#ifndef JOLON_COLLIDER_RESPOND_H
#define JOLON_COLLIDER_RESPOND_H

#include "collider/broad.h"
#include "collider/contact.h"
#include "collider/motion.h"
#include "collider/sink.h"
#include "collider/solve.h"
#include "world/checksum.h"

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

/* blast.c. 0, or -1 with errno ENOMEM. */
int charges_init(struct charges *charges, const struct world *world);
void charges_free(struct charges *charges);

struct island;

struct respond {
    const struct world *world;
    struct broad *broad;
    struct contacts *contacts;
    struct motion *motion;
    struct contact_input input;
    struct state *next;
    struct path *path; /* motion's */
    struct sink sink;
    struct charges *charges;
    struct island *island; /* island.h */
    uint64_t *changed;     /* [CHECKSUM_PIECES] columns of next's pieces that answers changed */
};

/* The rows, for an answer that changes these columns (COLUMN_BIT) of one: every write to next's
 * rows goes by this, so that what was changed is hashed again at the step's end. */
static inline struct entities *respond_change(struct respond *respond, uint32_t row,
                                              uint64_t columns)
{
    respond->changed[row / CHECKSUM_ROWS] |= columns;
    return &respond->next->entities;
}

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

/* --- respond.c: who met whom -------------------------------------------------------------------*/

/* Answers the earliest contact, and with it those of the same moment that it must be solved
 * together with. */
void respond_contact(struct respond *respond, const struct contact *contact);

struct impact respond_impact(const struct respond *respond, const struct contact *contact);

/* Is the row still on its way through an object that lets it in? What of it comes in later, a hull
 * after the gun, is no new collision. Remembers the touch. */
bool respond_passes(struct respond *respond, const struct impact *impact);

/* Is this a press that goes on, no new collision? Remembers the touch in any case. */
bool respond_leans(struct respond *respond, const struct impact *impact);

/* The event's place is taken before the answer, so that what follows from it comes after it. */
struct report respond_report(struct respond *respond, const struct impact *impact);
void respond_tell(struct respond *respond, const struct report *report, const struct impact *impact,
                  const struct outcome *outcome);

/* --- way.c: another way from a time on ---------------------------------------------------------*/

/* Stays where it is for the rest of the frame and leaves with this velocity. */
void respond_stay(struct respond *respond, uint32_t row, double time, struct vec3 velocity);

/* Goes on along its way at a share of its speed. respond_swept must follow. */
void respond_slow(struct respond *respond, uint32_t row, double time, double share);

/* Goes on from `at` with this velocity and spin (respond_spin's: the driver's steering in it does
 * not become the row's own), or stays there for the rest of the frame and takes
 * them with it. respond_swept must follow, for every row that leaves at this time, once all of them
 * have left. */
void respond_leave(struct respond *respond, uint32_t row, double time, struct vec3 at,
                   struct vec3 velocity, struct vec3 spin_rps, bool stays);
void respond_swept(struct respond *respond, const uint32_t *rows, uint32_t count, double time);

/* How the row turns [rad/s, world axes]: what collisions gave it; on the ground what its driver
 * steers, too. */
struct vec3 respond_spin(const struct respond *respond, uint32_t row);

/* Does the ground hold the row: a land vehicle, a ship, a wreck that lies? */
bool respond_grounded(const struct respond *respond, uint32_t row);

/* --- island.c: impulses, all contacts of one moment together -----------------------------------*/

/* contact was just taken; takes those of the same moment that are answered by impulses too. */
void island_answer(struct respond *respond, const struct contact *contact);

/* --- harm.c: energy becomes damage. harm_row destroys at the kind's resistance_j. --------------*/
void harm_row(struct respond *respond, uint32_t row, double joules, double time);
void harm_destroy(struct respond *respond, uint32_t row, double time);
enum damage harm_fixed(struct respond *respond, uint32_t object, double joules);
/* Energy over a fixed kind's resistance_j from which its damage is high. */
double harm_high_share(const struct respond *respond, const struct kind *kind);

/* --- blow.c: harm and a dent -------------------------------------------------------------------*/

/* The row takes this energy, struck at the impact's point; side 1: inwards is along the normal, -1:
 * against it. spring: by which it was struck, else NULL. */
struct spring_blow;
void blow_row(struct respond *respond, uint32_t row, const struct impact *impact, double side,
              double joules, const struct spring_blow *spring);

/* --- figure8.c: the thesis's own answers -------------------------------------------------------*/
void figure8_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome);
void figure8_fixed(struct respond *respond, const struct impact *impact, struct outcome *outcome);

/* --- blast.c: a munition ends, and what explodes with it ---------------------------------------*/
void blast_munition(struct respond *respond, uint32_t row, uint32_t struck, double time);
void blast_charge(struct respond *respond, const struct charge *charge);
void blast_all(struct respond *respond);

#endif
