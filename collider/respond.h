/* Answers to contacts: figure 8 of the thesis, impulses, blasts, craters. All of it works on the
 * frame being made and on nothing else. */
#ifndef JOLON_COLLIDER_RESPOND_H
#define JOLON_COLLIDER_RESPOND_H

#include "collider/broad.h"
#include "collider/contact.h"
#include "collider/sink.h"

/* A charge that goes off in this frame. */
struct charge {
    struct vec3 point;
    double time; /* 0..1 */
    double explosive_kg;
    uint32_t owner_slot, owner_id; /* who fired it; 0 for nobody */
};

struct respond {
    const struct world *world;
    const struct broad *broad;
    struct contacts *contacts;
    struct contact_input input;
    struct state *next;
    struct path *path;
    struct sink sink;
    struct charge *charge; /* waiting; grows as blasts destroy what explodes in turn */
    uint32_t charges, charge_capacity;
};

/* What a collision's answer works with. */
struct impact {
    uint32_t a, b;      /* rows; b has PAIR_FIXED for a fixed object */
    double time;        /* 0..1 */
    struct vec3 point;  /* [m, world] where the spheres touch */
    struct vec3 normal; /* unit, from a towards b */
    double closing_mps; /* along the normal, >= 0 */
    double angle_rad;   /* b's heading off a's, 0..2 pi */
};

/* What an answer did, for the event. */
struct outcome {
    enum response response;
    double impulse_ns;
};

/* respond.c: answers one contact. 0, or -1 with errno ENOMEM. */
int respond_contact(struct respond *respond, const struct contact *contact);

/* The row's way from time on: it stays where it is and leaves with this velocity, or goes on along
 * its way at a share of its speed. 0, or -1 with errno ENOMEM. */
int respond_stay(struct respond *respond, uint32_t row, double time, struct vec3 velocity);
int respond_slow(struct respond *respond, uint32_t row, double time, double share);

/* Tells the agent which way leads away from what it ran into. */
void respond_bump(struct respond *respond, uint32_t row, double away_x, double away_z);

/* figure8.c and impulse.c: the two response models. */
int figure8_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome);
int figure8_fixed(struct respond *respond, const struct impact *impact, struct outcome *outcome);
int impulse_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome);
int impulse_fixed(struct respond *respond, const struct impact *impact, struct outcome *outcome);

/* harm.c: energy becomes damage. harm_row destroys at the kind's resistance_j. */
int harm_row(struct respond *respond, uint32_t row, double joules, double time);
int harm_destroy(struct respond *respond, uint32_t row, double time);
enum damage harm_fixed(struct respond *respond, uint32_t object, double joules);

/* blast.c: a munition ends, and what explodes with it. */
int blast_munition(struct respond *respond, uint32_t row, uint32_t struck, double time);
int blast_charge(struct respond *respond, const struct charge *charge);
int blast_all(struct respond *respond);

#endif
