/* The room in which a vehicle on wheels turns: how far it gets along an arc, and by which strokes
 * to and fro it gets to a heading.
 *
 * The vehicle is a rectangle about its place. What stands around it are rectangles and discs. Of
 * what it is nearer to than the gap that it keeps, it keeps what there is. Pure; any thread, each
 * its own room. */
#ifndef JOLON_MOVER_AGENT_DRIVING_SHUNTING_ROOM_H
#define JOLON_MOVER_AGENT_DRIVING_SHUNTING_ROOM_H

#include <stdbool.h>
#include <stdint.h>

#define SHUNTING_ROOM_MOST 48 /* obstacles: the nearest ones */

/* A rectangle, whose border may be rounded. A disc has only a border. */
struct shunting_obstacle {
    double x, z;               /* [m] its middle */
    double ux, uz;             /* the direction of its length, unit */
    double half_m, half_width; /* [m] half its length and half its width */
    double border_m;           /* around the rectangle */
};

struct shunting_pose {
    double x, z; /* [m] */
    double heading_rad;
};

struct shunting_room {
    double front_m, rear_m, left_m, right_m; /* how far it reaches from its place, above 0 */
    double circle_m;                         /* radius of its tightest circle, above 0 */
    double x, z;                             /* [m] its place: the obstacles near it count */
    uint32_t count;
    struct shunting_obstacle obstacle[SHUNTING_ROOM_MOST];
};

/* One way to drive on: forwards or backwards, with the wheels full to one side or straight on. */
struct shunting_stroke {
    double ahead; /* 1: forwards; -1: backwards */
    double side;  /* 1: its heading turns to the right; -1: to the left; 0: not at all */
};

/* Adds an obstacle, unless it is there already: one reaches into several gridsquares. Of more than
 * SHUNTING_ROOM_MOST the farthest is left out. */
void shunting_room_add(struct shunting_room *room, const struct shunting_obstacle *obstacle);

/* Returns how far a vehicle in this pose gets by a stroke before it is nearer than gap_m to an
 * obstacle, 0..most_m [m]. */
double shunting_room_free(const struct shunting_room *room, const struct shunting_pose *pose,
                          struct shunting_stroke stroke, double most_m, double gap_m);

/* Finds the strokes by which the vehicle gets to a heading within exact_rad, each of longest_m at
 * most, forwards and backwards in turn and to one side. Sets *first to the first one of the
 * shortest way. Returns false if there is no such way. */
bool shunting_room_plan(const struct shunting_room *room, const struct shunting_pose *pose,
                        double heading_rad, double exact_rad, double longest_m,
                        struct shunting_stroke *first);

#endif
