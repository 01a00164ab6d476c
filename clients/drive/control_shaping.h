/* The stick: makes controls of raw intents. More pressure, faster change (thesis row 11): a stick
 * or a puck counts by how far it is pushed, a key by how long it is held. Pure: no clock, no
 * devices.
 *
 * Steering, climbing and aiming centre themselves when they are let go. The throttle is a lever,
 * which stays; a key that pulls it back stops at nothing, and the next press goes on backwards. */
#ifndef JOLON_CLIENTS_DRIVE_CONTROL_SHAPING_H
#define JOLON_CLIENTS_DRIVE_CONTROL_SHAPING_H

#include "clients/drive/input.h"
#include "world/entity/entity.h"

#define CONTROL_SHAPING_DEAD 0.12 /* 0..1: devices do not rest at 0 */
#define CONTROL_SHAPING_LINEAR                                                                     \
    0.35                 /* share of the curve that is straight: fine near the middle              \
                          */
#define LEVER_RATE   1.5 /* [1/s] at full push */
#define KEY_KICK     0.2 /* what the press itself gives at once */
#define KEY_RATE     0.8 /* [1/s] as the key goes down ... */
#define KEY_GROWTH   4.0 /* [1/s2] ... and what it gains while it is held */
#define LEVER_KICK   0.1 /* the same of the lever */
#define LEVER_SLOW   0.3
#define LEVER_GROWTH 1.6
#define CENTRE_RATE  5.0 /* [1/s] back to the middle */

/* A terminal that does not tell releases: a press counts for so long, each repeat for so long, and
 * a press within KEY_SAME_NS of the last goes on where that was. Auto-repeat begins after 0.25 to
 * 0.66 s and comes 20 to 40 times a second. */
#define KEY_FIRST_NS  200000000u
#define KEY_REPEAT_NS 120000000u
#define KEY_SAME_NS   700000000u

struct controls {
    float throttle, steer, climb, traverse, elevate; /* -1..1 */
    float brake;                                     /* 0..1 */
    enum gearing gear;
};

struct control_shaping {
    struct control_shaping_axis {
        double deflection; /* where a device holds it, shaped */
        double rate;       /* how hard one pushes it, shaped */
        double key;        /* what keys make of it */
        int held;          /* -1, 0, 1: the key that is down */
        int direction;     /* -1, 0, 1: the last one that was */
        uint64_t down_ns, last_ns, until_ns;
    } axis[AXIS_COUNT];
    double lever;    /* -1..1 */
    bool lever_wait; /* came to nothing under a key that is still down */
    enum gearing gear;
    uint64_t step_ns; /* of the last step */
};

/* Raw deflection -1..1 to what it means: nothing within the dead zone, then a curve to 1. */
double control_shaping_shape(double value);

/* All let go; the lever at nothing, the gear automatic. */
void control_shaping_reset(struct control_shaping *shaping, uint64_t now_ns);

/* Takes an event other than INTENT_ACT. */
void control_shaping_apply(struct control_shaping *shaping, const struct intent *event,
                           uint64_t now_ns);

/* ACTION_STOP, ACTION_GEAR_UP and ACTION_GEAR_DOWN. */
void control_shaping_stop(struct control_shaping *shaping);
void control_shaping_gear(struct control_shaping *shaping, int by);

/* Moves on to now. True while something changes by itself: step again within a frame. */
bool control_shaping_step(struct control_shaping *shaping, uint64_t now_ns);

/* Of an aircraft the aim is the stick. */
struct controls control_shaping_controls(const struct control_shaping *shaping, bool aircraft);

/* Is there a hand on the turret, or on an aircraft's stick? */
bool control_shaping_aims(const struct control_shaping *shaping);

#endif
