/* The eye of a vehicle's crew. Pure. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_CREW_EYE_H
#define JOLON_RENDERER_SCENE_CAMERA_CREW_EYE_H

#include "world/maths/maths.h"

#include <stdbool.h>

struct kind;
struct world;

#define CREW_EYE_CLEARANCE_M 0.5 /* the eye is this far above the polygons beneath it */

struct crew_eye_seat {
    struct vec3 eye; /* [m, body axes] */
    double down;     /* slope of the view below the horizontal */
    bool turns;      /* it belongs to the turret and turns with it */
};

/* Returns the seat of a vehicle's crew: in the turret's hatch if there is a turret, else above the
 * cab or the cockpit. It is far enough back, and looks far enough down, to have the vehicle's own
 * gun, deck or nose in view where possible. No polygon of the vehicle except rotors is near the
 * eye. */
struct crew_eye_seat crew_eye_seat(const struct world *world, const struct kind *kind);

#endif
