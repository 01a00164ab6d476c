/* The measures of one body at a time: numbers, heights, speeds and jumps. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_BODY_MEASURES_H
#define JOLON_SUPERVISOR_PHYSICS_BODY_MEASURES_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/measure.h"
#include "supervisor/physics/surface.h"

struct hull_shape;

/* Measures numbers and place. Must be called before the other two; they want finite numbers. */
void body_measures_numbers(struct measures *measures, const struct body_look *body, double side_m);

/* The ground of a frame, and what touches it. */
struct ground_look {
    const struct surface *surface;
    const struct hull_shape *shape; /* of all the world's hulls */
    double dt_s;
    bool boxes; /* the corners of boxes touch the ground, not those of hulls */
    bool fresh; /* the ground may have changed since the last frame */
};

/* Measures height and corners under the ground, and sets what the body's look says about them. */
void body_measures_ground(struct measures *measures, const struct ground_look *ground,
                          struct body_look *body);

/* Measures the clearance of wrecks at rest. It must be known which bodies touch each other: a wreck
 * that lies on another body is left out. */
void body_measures_rest(struct measures *measures, const struct ground_look *ground,
                        const struct body_look *body);

/* Measures speeds, jumps and accelerations. The body's explanations must be complete. */
void body_measures_motion(struct measures *measures, const struct ground_look *ground,
                          struct body_look *body);

/* Returns true if the ground or the water holds the body in this frame and held it before: its
 * vertical speed then only follows the ground. It holds no wrecks on land, which are rigid bodies.
 */
bool body_measures_held(const struct body_look *body);

#endif
