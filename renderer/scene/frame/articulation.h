/* Gear: what of vehicles turns, and some of it cannot be told from one moment alone: how far they
 * have come, for wheels and tracks, and how far the guns of wrecks have sunk. Kept from picture to
 * picture and begun anew by a renderer that starts: nothing of it is the world's. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_ARTICULATION_H
#define JOLON_RENDERER_SCENE_FRAME_ARTICULATION_H

#include <stdint.h>

struct frame_view;

#define ARTICULATION_SLOTS_MAX 16384u /* vehicles in higher slots keep nothing */
#define ARTICULATION_WRAP_M                                                                        \
    4096.0                         /* ways are taken modulo this, for a float to hold them finely  \
                                    */
#define ARTICULATION_JUMP_S    2.0 /* seen longer ago than this it is seen anew */
#define ARTICULATION_STEER_MAX 0.6 /* [rad] */

struct articulation_state {
    uint32_t id;        /* whose; 0: nobody's yet */
    double time_s;      /* of simulation, when it was noted */
    double x, y, z;     /* [m] there and then */
    double heading;     /* [rad] */
    double travel_m[2]; /* left and right wheels and tracks, 0 .. ARTICULATION_WRAP_M */
    float turret_rad, gun_rad, steer_rad;
};

struct articulation {
    struct articulation_state *state; /* by slot; owned */
    uint32_t slots;
};

/* 0, or -1 with errno ENOMEM. */
int articulation_init(struct articulation *articulation, uint32_t capacity);
void articulation_free(struct articulation *articulation);

/* Goes on to this moment, which is to be drawn next. Noting a moment twice changes nothing. */
void articulation_note(struct articulation *articulation, const struct frame_view *frame_view);

/* As noted last; of what was never noted, or with no gear, as on first sight: no way, a wreck's
 * gun down. */
struct articulation_state articulation_of(const struct articulation *articulation,
                                          const struct frame_view *frame_view, uint32_t slot);

#endif
