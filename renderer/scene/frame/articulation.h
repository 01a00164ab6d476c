/* The movable parts of vehicles. Some of their positions do not follow from one frame alone: how
 * far the wheels and tracks have rolled, and how far the guns of wrecks have sunk. They are kept
 * from picture to picture, belong to the renderer and start anew with it. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_ARTICULATION_H
#define JOLON_RENDERER_SCENE_FRAME_ARTICULATION_H

#include <stdint.h>

struct frame_view;

#define ARTICULATION_SLOTS_MAX 16384u /* vehicles in higher slots keep no state */
#define ARTICULATION_WRAP_M    4096.0 /* travel is taken modulo this, for precision in float */
#define ARTICULATION_JUMP_S    2.0    /* after a longer gap [s] the state starts anew */
#define ARTICULATION_STEER_MAX 0.6    /* [rad] */

struct articulation_state {
    uint32_t id;        /* entity id; 0: none yet */
    double time_s;      /* simulation time of the last update */
    double x, y, z;     /* [m] position at that time */
    double heading;     /* [rad] */
    double travel_m[2]; /* distance rolled on the left and on the right, 0 .. ARTICULATION_WRAP_M */
    float turret_rad, gun_rad, steer_rad;
};

struct articulation {
    struct articulation_state *state; /* by slot; owned */
    uint32_t slots;
};

/* Returns 0, or -1 with errno ENOMEM. */
int articulation_init(struct articulation *articulation, uint32_t capacity);
void articulation_free(struct articulation *articulation);

/* Advances the state to the frame, which is drawn next. Calling it twice with one frame changes
 * nothing. */
void articulation_note(struct articulation *articulation, const struct frame_view *frame_view);

/* Returns the state at the last update. For an unknown vehicle, or if articulation is NULL, returns
 * the initial state: no travel, and the gun of a wreck down. */
struct articulation_state articulation_of(const struct articulation *articulation,
                                          const struct frame_view *frame_view, uint32_t slot);

#endif
