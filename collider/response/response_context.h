/* What the functions of a response read and change: the frame being made. */
#ifndef JOLON_COLLIDER_RESPONSE_RESPONSE_CONTEXT_H
#define JOLON_COLLIDER_RESPONSE_RESPONSE_CONTEXT_H

#include "collider/motion/body_motion.h"
#include "collider/narrow_phase/contact_queue.h"
#include "collider/response/event_writer.h"
#include "world/entity/table_write.h"
#include "world/state.h"

struct charges;
struct island;
struct response_functions;

struct response_context {
    const struct world *world;
    const struct response_functions *functions; /* of the scenario's response */
    struct broad_phase *broad;
    struct contact_queue *contacts;
    struct body_motion *motion;
    struct contact_input input;
    struct state *next;
    struct path *path; /* of motion */
    struct event_writer events;
    struct charges *charges;
    struct island *island;
    /* A bit for each row that the mover wrote in this frame, for each of these that is on its
     * springs, and that holds another body than in the committed frame. */
    const uint64_t *moved, *sprung, *fresh;
    struct table_writer writer; /* every change of next's rows goes through this */
    bool contacts_sleep;        /* of sleeping_contacts_all() */
    uint32_t begun;             /* contacts that began in this frame */
    uint32_t without_room;      /* index + 1 of a pair that is told to have no room, or 0 */
};

/* A collision to resolve. */
struct impact {
    uint32_t a, b;      /* rows; b has PAIR_FIXED for a fixed object */
    uint32_t pair;      /* index + 1 in the queue */
    double time;        /* 0..1 */
    struct vec3 point;  /* [m, world] where the bodies touch */
    struct vec3 normal; /* unit, from a towards b; horizontal between bodies on the ground */
    double depth_m;     /* overlap along the hulls' own normal */
    double closing_mps; /* at the point, along the normal, >= 0 */
    double angle_rad;   /* b's heading relative to a's, 0..2 pi */
};

/* What a response did, for the event. */
struct outcome {
    enum response response;
    double impulse_ns;
};

#endif
