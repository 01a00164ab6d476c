/* The camera of each view. A camera follows its vehicle smoothly. Its state is kept from picture to
 * picture; a new camera starts where it would come to rest. Pure: the same frames in the same order
 * give the same cameras. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_VIEW_CAMERA_H
#define JOLON_RENDERER_SCENE_CAMERA_VIEW_CAMERA_H

#include "renderer/scene/camera/camera.h"
#include "renderer/scene/frame/frame_view.h"
#include "world/view_mode.h"

#include <stdbool.h>
#include <stdint.h>

#define VIEW_CAMERA_CLEARANCE_M 2.5  /* cameras are at least this high above the ground ... */
#define VIEW_CAMERA_EYE_M       1.2  /* ... except those at the height of a person's eyes */
#define VIEW_CAMERA_ORBIT_S     45.0 /* simulation time of one turn */

/* The pose of the free camera. */
struct view_camera_pose {
    bool given;
    double x, z, above_m; /* [m, world; above the ground] */
    double heading_rad, pitch_rad;
};

/* The options of a view's camera, which are the same for all its pictures. */
struct view_camera_options {
    enum view_mode view; /* not VIEW_MAP */
    double field_rad;    /* field of view, from left to right of a 16:9 picture */
    uint32_t width, height;
    struct view_camera_pose
        pose; /* of VIEW_FREE; if not given, beside the place where the vehicle is first seen */
};

/* The state of a camera; initially all zero. */
struct view_camera {
    uint32_t id;          /* vehicle that the camera follows; 0: none yet */
    double time_s;        /* simulation time of the last picture ... */
    struct vec3 position; /* ... and the vehicle's position then */
    double heading_rad, tilt_rad, lift_m;
    bool watches;              /* the next picture is taken in this direction ... */
    double watch_rad, watch_m; /* ... of what is so far from the vehicle; 0: of nothing */
    double away;               /* how many times as far away the camera is as usual */
    bool placed;               /* eye and target of VIEW_FREE are set */
    struct vec3 eye, target;
};

/* Lets VIEW_CHASE look in a direction [rad, heading] in the next picture, instead of along the
 * hull, and from further away through a longer lens: the vehicle is as large, and what happens
 * beyond it, far_m from it (0: nothing), is larger. The further away it is, the longer is the lens.
 * The camera turns there within about three seconds. */
void view_camera_watch(struct view_camera *state, double heading_rad, double far_m);

/* Computes the camera for a frame and updates the state. slot: the vehicle; SLOT_NONE if there is
 * none, and then all views except a free one with a given pose look at the middle of the world.
 *
 * VIEW_CHASE is behind and above and looks slightly ahead of the vehicle: 25 m back and 9 m up for
 * a tank, more for larger bodies; it turns after the vehicle within about a second. VIEW_ORBIT goes
 * around the vehicle once in VIEW_CAMERA_ORBIT_S. VIEW_OVERHEAD looks straight down, north up.
 * VIEW_INSIDE looks from crew_eye_seat() and turns with vehicle and turret. VIEW_FREE does not
 * move. No camera is under the ground. */
void view_camera_update(struct view_camera *state, const struct view_camera_options *options,
                        const struct frame_view *frame_view, uint32_t slot, struct camera *camera);

#endif
