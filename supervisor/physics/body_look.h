/* What the physics check sees of a vehicle or a wreck in a frame and in the frame before. One
 * thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_BODY_LOOK_H
#define JOLON_SUPERVISOR_PHYSICS_BODY_LOOK_H

#include "supervisor/physics/measure.h"
#include "supervisor/physics/rigid_pose.h"
#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

struct event;
struct kind;
struct persistent_contact;
struct state;
struct world;

#define NO_LOOK UINT32_MAX

/* Of a vehicle on its springs. */
struct sprung_look {
    double wheel_m;     /* its lowest wheel over the ground, as if without load; below 0: pressed */
    double shell_m;     /* the lowest point of its shell over the ground */
    double rim_m;       /* the lowest of the fronts of its outer wheels over the ground */
    double water_m;     /* depth of the ford under it */
    double spring_jpkg; /* energy that its springs give back over its mass, at least */
    double spring_most_jpkg; /* and at most: edges touch a wheel at any place of its rim */
};

/* A frame in a body's life. */
struct motion_look {
    struct rigid_pose pose;
    double heading, pitch, roll; /* [rad] */
    double turret, gun;          /* [rad] */
    struct vec3 velocity;        /* [m/s] */
    struct vec3 spin;            /* [rad/s, world axes] */
    double height_m;             /* over the ground */
    double lowest_m;             /* of a wreck: its lowest corner over the ground there, or if it is
                                    high over all ground near: height_m */
    double begun_m;              /* of a wreck: the highest that this has been since the vehicle
                                    was destroyed, at most 0 */
    bool wreck;
    struct sprung_look springs; /* of a vehicle on its springs */
    bool sprung;                /* a vehicle on its springs, which need not be on the ground */
    bool courses;               /* a land vehicle that holds its course, and is not on them */
    bool grounded;              /* an aircraft or a wreck that may touch the ground */
    bool stood;                 /* a wreck that has not moved since the frame before */
    bool at_rest;               /* a wreck that the mover leaves as it is, or that has not moved: in
                                   two frames, if it was in the ground, which lifts it out */
};

/* Bodies that touch each other, directly or not (supervisor/physics/joined_bodies.h). */
struct joined_bodies {
    uint32_t first;     /* index of its first body */
    uint32_t impacts;   /* of each of them, in this frame: an impact of two counts twice */
    uint32_t presses;   /* contacts of each of them that bore a load in this frame, as many times */
    double fastest_mps; /* of all before and after the frame */
    bool parts;         /* one of them overlaps another or a wall since one of the two was placed */
};

struct body_look {
    uint32_t row;
    struct measured_body named;
    const struct kind *kind;
    struct motion_look now;
    const struct motion_look *was; /* in the frame before, if known; until body_looks_end() */
    bool known;                    /* it was there in the frame before */
    bool still;                    /* known, and its pose and its turret are the same to the bit */
    bool finite;                   /* all its numbers are */
    bool foreign;                  /* another simulator moves it: it is not judged, and explains
                                      what happens to bodies that it touches */
    /* What may explain a change of its velocity. */
    bool commanded;   /* a command named it */
    uint32_t blasts;  /* explosions near */
    uint32_t struck;  /* collisions in this frame */
    uint32_t hits;    /* impacts in this frame of contacts that the table of contacts has */
    uint32_t presses; /* contacts of the table that bore a load in this frame */
    bool touches;     /* it touches a body or a wall */
    bool touched;     /* the same in the frame before */
    uint32_t parts;   /* bodies and walls that it overlaps since one of the two was placed */
    uint32_t parted;  /* the same in the frame before */
    bool thrown;      /* an explosion, another body or a fall made it faster than an engine does */
    bool spun;        /* the same of its spin, by an explosion, an impact of a fast body, or by
                         what one has thrown */
    double buried_s;  /* left of the time in which its shell gets out of the ground after an
                         explosion or an impact */
    struct joined_bodies together;
};

/* What is kept of a row from frame to frame. */
struct row_memory {
    uint32_t id;     /* 0: nothing */
    bool touched;    /* a body or a wall */
    uint32_t parted; /* bodies and walls that it overlapped since it was placed */
    bool thrown;     /* as in struct body_look */
    bool spun;
    double buried_s;
    struct motion_look look;
};

struct body_looks {
    struct body_look *body; /* in the order of their rows */
    uint32_t count, rows;
    uint32_t foreign;                   /* of the bodies */
    uint32_t *of_row;                   /* [capacity] index into body, or NO_LOOK */
    struct row_memory *memory;          /* [capacity] */
    const struct crater_index *craters; /* of the frame: for vehicles that cruise */
};

/* Returns the centre of mass, from the position [m, world axes]: a land vehicle's is above it. */
struct vec3 motion_look_centre(const struct motion_look *look, const struct kind *kind);

/* Returns the velocity of the centre of mass [m/s]. */
struct vec3 motion_look_centre_velocity(const struct motion_look *look, const struct kind *kind);

/* Returns the squares of the radii of gyration about the forward, up and right axes [m2]: kinds are
 * boxes of uniform density. */
struct vec3 motion_look_gyration(const struct kind *kind);

/* Returns how fast the points of the body go about its centre of mass: the root of their mean
 * square [m/s], so that the energy of rotation is half of its square times the mass. */
double motion_look_turning(const struct motion_look *look, const struct kind *kind);

/* Takes memory for the rows of a world. Returns 0, or -1 with errno ENOMEM. */
int body_looks_make(struct body_looks *looks, uint32_t capacity);
void body_looks_free(struct body_looks *looks);

/* Begins and ends the look at a frame: the bodies of its rows with what is kept of the frame
 * before. Heights, and what follows from them, are the caller's. */
void body_looks_begin(struct body_looks *looks, const struct world *world,
                      const struct state *state);
void body_looks_end(struct body_looks *looks);

/* Returns the index of the body with this id, or NO_LOOK. */
uint32_t body_looks_find(const struct body_looks *looks, uint32_t id);

/* Marks what an event explains. Explosions explain changes within their reach. */
void body_looks_explain(struct body_looks *looks, const struct event *event);

/* Marks the contacts that bore a load in this frame, and the impacts that contacts have had since
 * the frame before, told or not: those of a contact that has begun, too. before: [count] the
 * contacts of that frame, sorted by their keys. */
void body_looks_hits(struct body_looks *looks, const struct state *state,
                     const struct persistent_contact *before, uint32_t count);

/* Marks the bodies near charges that exploded with their vehicles. */
void body_looks_wrecked(struct body_looks *looks);

#endif
