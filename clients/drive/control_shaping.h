/* Control shaping: computes a vehicle's controls from intents. More pressure makes a faster change
 * (thesis row 11): of a stick or a puck the deflection counts, of a key the time for which it is
 * held. Pure: no clock, no devices.
 *
 * Steering, climb and aim return to the centre when they are released. The throttle is a lever that
 * keeps its position. A key that pulls the lever back stops at 0; the next press reverses. */
#ifndef JOLON_CLIENTS_DRIVE_CONTROL_SHAPING_H
#define JOLON_CLIENTS_DRIVE_CONTROL_SHAPING_H

#include "clients/drive/input.h"
#include "world/entity/entity.h"

/* Dead zone, 0..1, because devices do not rest at exactly 0; and the linear share of the curve,
 * which is flat near the centre for fine control. */
#define CONTROL_SHAPING_DEAD   0.12
#define CONTROL_SHAPING_LINEAR 0.35

#define LEVER_RATE   1.5 /* [1/s] of the lever at full deflection of a device */
#define KEY_KICK     0.2 /* change at the press itself */
#define KEY_RATE     0.8 /* [1/s] just after the press */
#define KEY_GROWTH   4.0 /* [1/s2] increase of that rate while the key is held */
#define LEVER_KICK   0.1 /* the same three for the lever */
#define LEVER_SLOW   0.3
#define LEVER_GROWTH 1.6
#define CENTRE_RATE  5.0 /* [1/s] return to the centre */

/* For a terminal that does not report releases: how long a press and a repeat count as held. A
 * press within KEY_SAME_NS of the last one continues it. Auto-repeat begins after 0.25 to 0.66 s
 * and comes 20 to 40 times a second. */
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
        double deflection; /* of the device, shaped */
        double rate;       /* of INTENT_RATE, shaped */
        double key;        /* the value that keys have built up */
        int held;          /* -1, 0, 1: direction of the key that is down */
        int direction;     /* -1, 0, 1: of the last key that was down */
        uint64_t down_ns, last_ns, until_ns;
    } axis[AXIS_COUNT];
    double lever;    /* -1..1 */
    bool lever_wait; /* the lever reached 0 under a key that is still down */
    enum gearing gear;
    uint64_t step_ns; /* time of the last step */
};

/* Returns the shaped value of a raw deflection, -1..1: 0 within the dead zone, then a curve to 1.
 */
double control_shaping_shape(double value);

/* Releases all axes and sets the lever to 0 and the gear to automatic. */
void control_shaping_reset(struct control_shaping *shaping, uint64_t now_ns);

/* Applies an intent other than INTENT_ACT. */
void control_shaping_apply(struct control_shaping *shaping, const struct intent *event,
                           uint64_t now_ns);

/* ACTION_STOP, ACTION_GEAR_UP and ACTION_GEAR_DOWN. */
void control_shaping_stop(struct control_shaping *shaping);
void control_shaping_gear(struct control_shaping *shaping, int by);

/* Advances to now_ns. Returns true while a value still changes by itself, so that the next step is
 * due within a frame. */
bool control_shaping_step(struct control_shaping *shaping, uint64_t now_ns);

/* Returns the controls. Of an aircraft the aim axes are the control stick. */
struct controls control_shaping_controls(const struct control_shaping *shaping, bool aircraft);

/* Returns true if an aim axis is deflected. */
bool control_shaping_aims(const struct control_shaping *shaping);

#endif
