/* Gear: what of vehicles turns, and some of it cannot be told from one moment alone: how far they
 * have come, for wheels and tracks, and how far the guns of wrecks have sunk. Kept from picture to
 * picture and begun anew by a renderer that starts: nothing of it is the world's. Pure. */
#ifndef JOLON_RENDERER_GEAR_H
#define JOLON_RENDERER_GEAR_H

#include <stdint.h>

struct moment;

#define GEAR_SLOTS_MAX 16384u /* vehicles in higher slots keep nothing */
#define GEAR_WRAP_M    4096.0 /* ways are taken modulo this, for a float to hold them finely */
#define GEAR_JUMP_S    2.0    /* seen longer ago than this it is seen anew */
#define GEAR_STEER_MAX 0.6    /* [rad] */

struct gear_state {
    uint32_t id;     /* whose; 0: nobody's yet */
    double time_s;   /* of simulation, when it was noted */
    double x, y, z;  /* [m] there and then */
    double heading;  /* [rad] */
    double way_m[2]; /* left and right wheels and tracks, 0 .. GEAR_WRAP_M */
    float turret_rad, gun_rad, steer_rad;
};

struct gear {
    struct gear_state *state; /* by slot; owned */
    uint32_t slots;
};

/* 0, or -1 with errno ENOMEM. */
int gear_init(struct gear *gear, uint32_t capacity);
void gear_free(struct gear *gear);

/* Goes on to this moment, which is to be drawn next. Noting a moment twice changes nothing. */
void gear_note(struct gear *gear, const struct moment *moment);

/* As noted last; of what was never noted, or with no gear, as on first sight: no way, a wreck's
 * gun down. */
struct gear_state gear_of(const struct gear *gear, const struct moment *moment, uint32_t slot);

#endif
