/* Rectangles as a driver sees them in a direction. Pure; any thread. */
#ifndef JOLON_MOVER_AGENT_DRIVING_SEEN_BOX_H
#define JOLON_MOVER_AGENT_DRIVING_SEEN_BOX_H

/* [m] The place of its middle and its axes, along the direction and to the right of it. */
struct seen_box {
    double along, right;
    double length_along, length_right; /* half its length */
    double width_along, width_right;   /* half its width */
};

/* Returns how far ahead the nearest part of the rectangle is that lies between two lines along the
 * direction, which are low_m and high_m to the right: at least 0. INFINITY: no part does, or it is
 * behind. */
double seen_box_nearest(const struct seen_box *box, double low_m, double high_m);

#endif
