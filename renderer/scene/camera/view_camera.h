/* Where each view is taken from. A camera follows its vehicle softly: what it remembers from
 * picture to picture is here, and without a memory it is where it would come to rest. Pure: the
 * same moments in the same order give the same cameras. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_VIEW_CAMERA_H
#define JOLON_RENDERER_SCENE_CAMERA_VIEW_CAMERA_H

#include "renderer/scene/camera/camera.h"
#include "renderer/scene/frame/frame_view.h"
#include "world/param_values.h"

#include <stdbool.h>
#include <stdint.h>

#define VIEW_CAMERA_CLEARANCE_M 2.5  /* cameras are at least so high above the ground ... */
#define VIEW_CAMERA_EYE_M       1.2  /* ... but those that stand or sit where people do */
#define VIEW_CAMERA_ORBIT_S     45.0 /* of simulation, once around */

/* A place for the free camera. */
struct view_camera_pose {
    bool given;
    double x, z, above_m; /* [m, world; above the ground] */
    double heading_rad, pitch_rad;
};

/* What is asked for; the same for all pictures of a view. */
struct view_camera_options {
    enum view_mode view; /* not VIEW_MAP */
    double field_rad;    /* of view, from left to right of a 16:9 picture */
    uint32_t width, height;
    struct view_camera_pose
        pose; /* of VIEW_FREE; not given: beside where the vehicle is seen first */
};

/* What a camera remembers; all zero to begin with. */
struct view_camera {
    uint32_t id;          /* of the vehicle that it hangs on; 0: it has seen none */
    double time_s;        /* of simulation, of its last picture ... */
    struct vec3 position; /* ... and where the vehicle was then */
    double heading_rad, tilt_rad, lift_m;
    bool placed; /* VIEW_FREE has found its place */
    struct vec3 eye, target;
};

/* The camera for a moment, and what to remember for the next. slot: the vehicle; SLOT_NONE: there
 * is none, and all views but a placed free one look over the middle of the world.
 *
 * VIEW_CHASE: behind and above, looking slightly beyond: 25 m back and 9 m up for a tank, more for
 * larger bodies, turning after the vehicle within about a second. VIEW_ORBIT: around it, once in
 * VIEW_CAMERA_ORBIT_S. VIEW_OVERHEAD: straight down, north up. VIEW_INSIDE: from crew_eye_seat(),
 * turned as the vehicle and its turret are. VIEW_FREE: a place that does not move. None is ever
 * under the ground. */
void view_camera_camera(struct view_camera *state, const struct view_camera_options *options,
                        const struct frame_view *frame_view, uint32_t slot, struct camera *camera);

#endif
