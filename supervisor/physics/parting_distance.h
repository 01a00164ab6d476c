/* How far a body has to move over the ground to be out of another: out of all pieces of it, so that
 * the way does not lead from one piece into the next. Of bodies of several pieces the deepest
 * overlap of two pieces says little: a gun that leaves a hull through its length gets deeper into
 * it before it is out. Shares no code with the collider. Pure; any thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_PARTING_DISTANCE_H
#define JOLON_SUPERVISOR_PHYSICS_PARTING_DISTANCE_H

#include "supervisor/physics/hull_shape.h"
#include "supervisor/physics/rigid_pose.h"

/* The pieces of a body, each with the pose of its part. */
struct parting_pieces {
    const struct hull_shape *shape; /* [count] */
    const struct rigid_pose *pose;  /* [count] */
    uint32_t count;
    double scale;
};

#define PARTING_PIECES_MAX 64u /* pairs of pieces */

/* Returns the length of the shortest level way [m], 0 if no pieces overlap. It is a straight line
 * along the normal of a face, made level, or to a place in which the edges of two pieces cross. The
 * faces of both bodies tell where two pieces overlap, so that pieces which only axes across two
 * edges separate count as overlapping. a has the scale 1. */
double parting_distance_find(const struct parting_pieces *a, const struct parting_pieces *b);

#endif
