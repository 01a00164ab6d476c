/* Clips the sides of a rectangle. */
#include "mover/agent/driving/seen_box.h"

#include "world/maths/maths.h"

#define PARALLEL_M 1e-9 /* a side that goes less to the right is parallel to the direction */

double seen_box_nearest(const struct seen_box *box, double low_m, double high_m)
{
    static const double corner[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
    double nearest = INFINITY, farthest = -INFINITY;
    for (int n = 0; n < 4; n++) {
        double from = 0.0, to = 1.0;
        const double right =
            box->right + corner[n][0] * box->length_right + corner[n][1] * box->width_right;
        const double along =
            box->along + corner[n][0] * box->length_along + corner[n][1] * box->width_along;
        const double sideways = box->right + corner[n + 1][0] * box->length_right +
                                corner[n + 1][1] * box->width_right - right;
        const double onwards = box->along + corner[n + 1][0] * box->length_along +
                               corner[n + 1][1] * box->width_along - along;
        if (fabs(sideways) > PARALLEL_M) {
            const double at_low = (low_m - right) / sideways, at_high = (high_m - right) / sideways;
            from = maths_max(from, maths_min(at_low, at_high));
            to = maths_min(to, maths_max(at_low, at_high));
        } else if (right < low_m || right > high_m) {
            continue;
        }
        if (from > to)
            continue;
        nearest = maths_min(nearest, along + onwards * (onwards > 0.0 ? from : to));
        farthest = maths_max(farthest, along + onwards * (onwards > 0.0 ? to : from));
    }
    return farthest > 0.0 ? maths_max(nearest, 0.0) : INFINITY;
}
