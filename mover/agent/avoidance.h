/* Agents steer around obstacles, slow down for them, and stop before them.
 *
 * When an agent decides, it looks along a fan of directions about the desired one for how far each
 * is free of obstacles: fixed objects that would damage its kind, the future paths of other
 * vehicles, water or land, steep slopes, earthworks and craters that it cannot cross, and the edge
 * of the world. It takes a direction that is free far and needs little turning, and a speed at
 * which it can stop in time. The fields dodge and ease keep the result until the next decision. Of
 * two vehicles that meet head on, both turn right. */
#ifndef JOLON_MOVER_AGENT_AVOIDANCE_H
#define JOLON_MOVER_AGENT_AVOIDANCE_H

#include "mover/context/step_context.h"
#include "world/terrain/gridsquare.h"

#define AVOIDANCE_ROUNDED_M 0.01 /* more than the index's rounding of positions */

struct crater;
struct fixed_object;

/* A rectangle about the middle of a model, along its axes [m]. */
struct avoidance_box {
    double x, z; /* its middle */
    double half_x, half_z;
};

/* The same of an object of the world. */
struct avoidance_box_placed {
    double x, z;               /* its middle */
    double ux, uz;             /* the direction of its length, unit */
    double half_m, half_width; /* half its length and half its width */
};

/* What follows from the kinds and the fixed objects. */
struct avoidance {
    /* [m] Radius of the obstacle that a body of a kind is; of a fixed object, at the height of land
     * vehicles: a tree's trunk, not its crown. */
    double reach_m[KIND_COUNT_MAX];
    /* Of fixed kinds: the rectangle around what a land vehicle meets of the model. One of a kind
     * that is not so large, or of any where spheres collide, is empty: its objects are discs. */
    struct avoidance_box box[KIND_COUNT_MAX];
    /* Of vehicle kinds [m]: how far the model reaches ahead of its middle, with its gun. */
    double nose_m[KIND_COUNT_MAX];
    /* Of vehicle kinds: a bit for each fixed kind that does not damage it. Kinds with an outline
     * are looked at one by one. */
    uint64_t harmless[KIND_COUNT_MAX];
    /* Of vehicle kinds: the tangent of the slope that is too steep. */
    double slope[KIND_COUNT_MAX];
    /* Of vehicle kinds [m], rounded up: half the height, and the vertical gap beyond which others
     * do not matter. On a slope other land vehicles matter that are far above or below. */
    float high_m[KIND_COUNT_MAX], gap_m[KIND_COUNT_MAX];
    /* Of vehicle kinds [m]: the radius in which one at full speed looks for other vehicles. */
    double around_m[KIND_COUNT_MAX];
    double fastest_mps; /* the top speed of all land vehicles */
    /* A bit for each gridsquare that a fixed object reaches into. */
    uint64_t *occupied;
};

/* Returns 0, or -1 with errno ENOMEM; must be freed in either case. */
int avoidance_init(struct avoidance *avoidance, const struct world *world);
void avoidance_free(struct avoidance *avoidance);

/* Returns how far on its way an entry of the neighbour index may be, beyond what half a second is:
 * it is where its stretch ends (world/entity/cruise.h) [m]. */
double avoidance_ahead(const struct step_context *context);

/* Return how many rectangles a fixed object is for a land vehicle, 0 if it is a disc; the radius of
 * the disc; and one of the rectangles [m, world]. */
uint32_t avoidance_boxes(const struct step_context *context, const struct fixed_object *object);
double avoidance_disc(const struct step_context *context, const struct fixed_object *object);
struct avoidance_box_placed avoidance_box_of(const struct step_context *context,
                                             const struct fixed_object *object, uint32_t n);

/* Returns true if fixed object n stands and would harm row i. */
bool avoidance_harms(const struct step_context *context, uint32_t i, uint32_t n);

/* Returns true if row i goes around a crater: its kind may not get out of the bowl, or turns over
 * in it. One that is in the bowl has to get out of it, and a script may lead there. One that is
 * stuck again and again drives through. */
bool avoidance_goes_around(const struct step_context *context, uint32_t i,
                           const struct crater *crater);

/* Looks if row i is due, and changes the desired motion by dodge and ease. */
void avoidance_steer(const struct step_context *context, uint32_t i,
                     struct desired_motion *desired);

#endif
