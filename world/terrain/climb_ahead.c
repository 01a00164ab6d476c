/* Walks along the way and looks at the ground. */
#include "world/terrain/climb_ahead.h"

#include "world/terrain/square_bounds.h"

#include <stddef.h>

#define STEP_M     6.0  /* between the first places, at least */
#define STEP_CLEAR 0.5  /* of the height that it wants, the same */
#define STEP_SHARE 0.15 /* of their distance, between later ones */
#define SOONEST_S  1.25 /* in which it comes to a height that it should have now */
#define SLOW_MPS   1.0  /* a slower one is as late as with this speed */

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

/* Limits the result by the ground at a place. Mostly it is so far below the aircraft that it does
 * not. */
static inline void pass(const struct climb_ahead *ahead, double lowest_m, double ground_m,
                        double distance_m, struct climb_need *need)
{
    if (ground_m + ahead->clear_m <= lowest_m)
        return;
    double to_go = maths_max(distance_m - ahead->half_length_m, 0.0);
    double speed = maths_max(ahead->speed_mps, SLOW_MPS);
    double y = ahead->at.y + ahead->late_s * maths_min(ahead->up_mps, 0.0);
    double over = ground_m - y, t = maths_max(to_go / speed, SOONEST_S);
    double even = (over + ahead->clear_m) / t;
    double change = climb_ahead_change(ahead->up_mps, even, ahead->pull_mps2, t);
    need->climb_mps = maths_max(need->climb_mps, ahead->up_mps + change);
    double later = time_to_climb(ahead, over + ahead->least_m);
    double braking = maths_max(to_go - ahead->late_s * ahead->speed_mps, 0.0);
    need->speed_mps = maths_min(need->speed_mps, late_speed(ahead->brake_mps2, braking, later));
}

/* Returns true if it stays over all that stands in the gridsquare of a place. */
static bool is_far_below(const struct climb_ahead *ahead, double lowest_m, double x, double z)
{
    if (!ahead->tops)
        return false;
    uint16_t top = square_bounds_of(ahead->tops, gridsquare_of(&ahead->tops->squares, x, z));
    double height = SQUARE_BOUNDS_LOWEST_M + SQUARE_BOUNDS_HEIGHT_M * top;
    return height + ahead->clear_m <= lowest_m;
}

struct climb_need climb_ahead_need(const struct terrain *terrain, const struct climb_ahead *ahead)
{
    struct climb_need need = {.climb_mps = -INFINITY, .speed_mps = INFINITY};
    const double least = maths_max(STEP_M, STEP_CLEAR * ahead->clear_m);
    const double lowest_m = lowest(ahead);
    double east, south, sine, cosine, turned = 0.0, distance = 0.0;
    maths_sincos(ahead->heading_rad, &sine, &cosine);
    double x = ahead->at.x - ahead->half_length_m * sine;
    double z = ahead->at.z + ahead->half_length_m * cosine;
    if (!is_far_below(ahead, lowest_m, x, z))
        pass(ahead, lowest_m, terrain_base_height(terrain, x, z), 0.0, &need);
    x = ahead->at.x;
    z = ahead->at.z;
    while (distance <= ahead->length_m) {
        if (!is_far_below(ahead, lowest_m, x, z)) {
            double ground = terrain_base_plane(terrain, x, z, &east, &south);
            ground += ahead->half_width_m * fabs(east * cosine + south * sine);
            pass(ahead, lowest_m, ground, distance, &need);
        }
        const double step = maths_max(least, STEP_SHARE * distance);
        if (turned < fabs(ahead->off_rad)) {
            turned = maths_min(turned + step / ahead->radius_m, fabs(ahead->off_rad));
            maths_sincos(ahead->heading_rad + (ahead->off_rad < 0.0 ? -turned : turned), &sine,
                         &cosine);
        }
        x += step * sine;
        z -= step * cosine;
        distance += step;
    }
    return need;
}
