/* Where the crew of a vehicle looks out from. Pure. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_CREW_EYE_H
#define JOLON_RENDERER_SCENE_CAMERA_CREW_EYE_H

#include "world/maths/maths.h"

#include <stdbool.h>

struct kind;
struct world;

#define CREW_EYE_CLEARANCE_M 0.5 /* the eye is so far above the polygons beneath it */

struct crew_eye_seat {
    struct vec3 eye; /* [m, body axes] */
    double down;     /* it looks ahead, and down so much over distance */
    bool turns;      /* it is the turret's, and looks where that points */
};

/* The seat of who looks out of a vehicle: in the turret's hatch where there is a turret, else over
 * the cab or the cockpit; so far back, and looking down so much, that what is ahead of it, its gun,
 * its deck, its nose, is in view where that can be. None of its own polygons but rotors is near the
 * eye. */
struct crew_eye_seat crew_eye_seat(const struct world *world, const struct kind *kind);

#endif
