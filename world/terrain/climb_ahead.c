/* Walks along the way and looks at the ground, and at what stands on it. */
#include "world/terrain/climb_ahead.h"

#include "world/terrain/fallen.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/square_bounds.h"

#include <stddef.h>

#define STEP_M     6.0  /* between the first places, at least */
#define STEP_CLEAR 0.5  /* of the height that it wants, the same */
#define STEP_SHARE 0.15 /* of their distance, between later ones */
#define SOONEST_S  1.25 /* in which it comes to a height that it should have now */
#define SLOW_MPS   1.0  /* a slower one is as late as with this speed */
#define BESIDE_M   2.0  /* gap to an object beside the way */
#define STRAYS     0.05 /* and so much more, as a share of the distance, as ways are not held */
#define OVER_SHARE                                                                                 \
    1.5 /* of the height that it must have: so high it wants to be over an object                  \
         */

/* With a change c and t seconds of pull p, c - c^2 / 2p = even - up. */
double climb_ahead_change(double up_mps, double even_mps, double pull_mps2, double t)
{
    double pulled = pull_mps2 * t, change = even_mps - up_mps;
    if (change <= 0.0)
        return change;
    if (change >= 0.5 * pulled)
        return 2.0 * change;
    return pulled - sqrt(pulled * (pulled - 2.0 * change));
}

/* Returns the time [s] after which it stays above a height over its own: at once, or when it has
 * climbed to it. */
static double time_to_climb(const struct climb_ahead *ahead, double height_m)
{
    double up = ahead->up_mps, pull = ahead->pull_mps2, most = ahead->climb_mps;
    double root = up * up + 2.0 * pull * height_m;
    double pulling = maths_max(most - up, 0.0) / pull;
    double pulled = pulling * (up + 0.5 * pull * pulling);
    if (height_m > pulled)
        return pulling + (height_m - pulled) / most;
    return root > 0.0 ? maths_max((sqrt(root) - up) / pull, 0.0) : 0.0;
}

/* Returns the greatest speed from which it covers no more than metres in so many seconds if it
 * brakes all the way. */
static double late_speed(double brake_mps2, double metres, double seconds)
{
    if (seconds <= 0.0)
        return INFINITY;
    if (2.0 * metres >= brake_mps2 * seconds * seconds)
        return metres / seconds + 0.5 * brake_mps2 * seconds;
    return sqrt(2.0 * brake_mps2 * metres);
}

/* Returns the height below which it does not come if it pulls up now. */
static double lowest(const struct climb_ahead *ahead)
{
    double sink = maths_max(-ahead->up_mps, 0.0);
    return ahead->at.y - ahead->late_s * sink - sink * sink / (2.0 * ahead->pull_mps2);
}

/* Limits the result by a height that it has to pass at a distance, so high over it. Mostly the
 * ground is so far below the aircraft that it does not. */
static inline void pass(const struct climb_ahead *ahead, double lowest_m, double ground_m,
                        double clear_m, double distance_m, struct climb_need *need)
{
    if (ground_m + clear_m <= lowest_m)
        return;
    double to_go = maths_max(distance_m - ahead->half_length_m, 0.0);
    double speed = maths_max(ahead->speed_mps, SLOW_MPS);
    double y = ahead->at.y + ahead->late_s * maths_min(ahead->up_mps, 0.0);
    double over = ground_m - y, t = maths_max(to_go / speed, SOONEST_S);
    double even = (over + clear_m) / t;
    double change = climb_ahead_change(ahead->up_mps, even, ahead->pull_mps2, t);
    need->climb_mps = maths_max(need->climb_mps, ahead->up_mps + change);
    double later = time_to_climb(ahead, over + ahead->least_m);
    double braking = maths_max(to_go - ahead->late_s * ahead->speed_mps, 0.0);
    need->speed_mps = maths_min(need->speed_mps, late_speed(ahead->brake_mps2, braking, later));
}

/* Returns true if it stays over all that stands in a gridsquare. */
static bool is_far_below(const struct climb_ahead *ahead, double lowest_m, uint32_t square)
{
    if (!ahead->tops)
        return false;
    uint16_t top = square_bounds_of(ahead->tops, square);
    double height = SQUARE_BOUNDS_LOWEST_M + SQUARE_BOUNDS_HEIGHT_M * top;
    return height + ahead->clear_m <= lowest_m;
}

/* A straight part of the way. */
struct leg {
    double x, z, sine, cosine, length_m;
    double distance_m; /* of its beginning */
    double lowest_m;
};

/* A rectangle on the map [m]. */
struct extent {
    double x0, z0, x1, z1;
};

/* Returns the rectangle around all that is beside the leg. */
static struct extent extent_of(const struct climb_ahead *ahead, const struct leg *leg)
{
    double to_x = leg->x + leg->length_m * leg->sine, to_z = leg->z - leg->length_m * leg->cosine;
    double beside = maths_max(ahead->half_length_m, ahead->half_width_m) + BESIDE_M +
                    STRAYS * (leg->distance_m + leg->length_m);
    return (struct extent){maths_min(leg->x, to_x) - beside, maths_min(leg->z, to_z) - beside,
                           maths_max(leg->x, to_x) + beside, maths_max(leg->z, to_z) + beside};
}

/* Passes the top of an object if it is beside the leg, or if the body touches it where the way
 * begins. */
static void pass_object(const struct climb_ahead *ahead, const struct leg *leg,
                        const struct fixed_object *object, struct climb_need *need)
{
    const double top = (double)object->y + (double)object->height_m;
    const double clear = maths_min(ahead->clear_m, OVER_SHARE * ahead->least_m);
    if (top + clear <= leg->lowest_m)
        return;
    double radius = fixed_index_of_fixed(object, ahead->objects->kinds);
    double dx = object->x - leg->x, dz = object->z - leg->z;
    double along = dx * leg->sine - dz * leg->cosine, past = along;
    along = maths_clamp(along, 0.0, leg->length_m);
    past -= along;
    double across = dx * leg->cosine + dz * leg->sine;
    double beside = radius + ahead->half_width_m + BESIDE_M + STRAYS * (leg->distance_m + along);
    double around = radius + ahead->half_length_m + BESIDE_M;
    if (leg->distance_m == 0.0 && dx * dx + dz * dz < around * around)
        pass(ahead, leg->lowest_m, top, clear, 0.0, need);
    else if (past * past + across * across < beside * beside)
        pass(ahead, leg->lowest_m, top, clear, maths_max(leg->distance_m + along - radius, 0.0),
             need);
}

static void pass_objects(const struct climb_ahead *ahead, const struct leg *leg, uint32_t square,
                         struct climb_need *need)
{
    const struct climb_objects *objects = ahead->objects;
    for (uint32_t n = objects->reach_start[square]; n < objects->reach_start[square + 1]; n++) {
        uint32_t index = objects->reach[n];
        if (fallen_damage(objects->damage[index]) < DAMAGE_HIGH)
            pass_object(ahead, leg, &objects->fixed[index], need);
    }
}

/* Passes the ground where the leg begins, as high as the body reaches to its sides. */
static void pass_ground(const struct terrain *terrain, const struct climb_ahead *ahead,
                        const struct leg *leg, struct climb_need *need)
{
    double east, south;
    if (is_far_below(ahead, leg->lowest_m, gridsquare_of(&terrain->squares, leg->x, leg->z)))
        return;
    double ground = terrain_base_plane(terrain, leg->x, leg->z, &east, &south);
    ground += ahead->half_width_m * fabs(east * leg->cosine + south * leg->sine);
    pass(ahead, leg->lowest_m, ground, ahead->clear_m, leg->distance_m, need);
}

/* Passes the ground under its tail. */
static void pass_tail(const struct terrain *terrain, const struct climb_ahead *ahead,
                      const struct leg *leg, struct climb_need *need)
{
    double x = leg->x - ahead->half_length_m * leg->sine;
    double z = leg->z + ahead->half_length_m * leg->cosine;
    if (!is_far_below(ahead, leg->lowest_m, gridsquare_of(&terrain->squares, x, z)))
        pass(ahead, leg->lowest_m, terrain_base_height(terrain, x, z), ahead->clear_m, 0.0, need);
}

/* Passes what stands beside the leg in all gridsquares that it is not far above. Most legs are far
 * above all: below is what is known to be so, and most are within that of the leg before. */
static void pass_leg(const struct terrain *terrain, const struct climb_ahead *ahead,
                     const struct leg *leg, struct extent *below, struct climb_need *need)
{
    const struct gridsquares *squares = &terrain->squares;
    const struct extent at = extent_of(ahead, leg);
    bool all = true;
    if (at.x0 >= below->x0 && at.z0 >= below->z0 && at.x1 <= below->x1 && at.z1 <= below->z1)
        return;
    struct gridsquare_box box = gridsquare_box_of(squares, at.x0, at.z0, at.x1, at.z1);
    for (int32_t row = box.z0; row <= box.z1; row++)
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t square = gridsquare_index(squares, column, row);
            if (is_far_below(ahead, leg->lowest_m, square))
                continue;
            all = false;
            if (ahead->objects)
                pass_objects(ahead, leg, square, need);
        }
    if (all)
        *below = (struct extent){box.x0 * squares->side_m, box.z0 * squares->side_m,
                                 (box.x1 + 1) * squares->side_m, (box.z1 + 1) * squares->side_m};
    else
        pass_ground(terrain, ahead, leg, need);
}

struct climb_need climb_ahead_need(const struct terrain *terrain, const struct climb_ahead *ahead)
{
    struct climb_need need = {.climb_mps = -INFINITY, .speed_mps = INFINITY};
    struct extent below = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    const double least = maths_max(STEP_M, STEP_CLEAR * ahead->clear_m);
    struct leg leg = {.x = ahead->at.x, .z = ahead->at.z, .lowest_m = lowest(ahead)};
    double turned = 0.0;
    maths_sincos(ahead->heading_rad, &leg.sine, &leg.cosine);
    pass_tail(terrain, ahead, &leg, &need);
    while (leg.distance_m <= ahead->length_m) {
        leg.length_m = maths_max(least, STEP_SHARE * leg.distance_m);
        if (turned < fabs(ahead->off_rad)) {
            turned = maths_min(turned + leg.length_m / ahead->radius_m, fabs(ahead->off_rad));
            maths_sincos(ahead->heading_rad + (ahead->off_rad < 0.0 ? -turned : turned), &leg.sine,
                         &leg.cosine);
        }
        pass_leg(terrain, ahead, &leg, &below, &need);
        leg.x += leg.length_m * leg.sine;
        leg.z -= leg.length_m * leg.cosine;
        leg.distance_m += leg.length_m;
    }
    return need;
}
