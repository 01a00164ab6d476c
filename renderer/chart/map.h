/* The map (thesis row 12): shaded ground with contours, and every vehicle's position, direction and
 * track on it. Pure; drawn in software. Words are added by chart.c. */
#ifndef JOLON_RENDERER_MAP_H
#define JOLON_RENDERER_MAP_H

#include "renderer/image/image.h"
#include "renderer/scene/moment.h"
#include "renderer/chart/track.h"

#include <stdint.h>

/* A piece of the world in a rectangle of a picture. */
struct map_view {
    double x, z;       /* [m, world] at the rectangle's top left corner */
    double metres;     /* a pixel */
    int32_t left, top; /* [pixel] of the rectangle in the picture */
    uint32_t width, height;
};

/* The whole square, as large as fits. */
struct map_view map_whole(int32_t left, int32_t top, uint32_t side);

/* side_m of ground around a place, as wide as the rectangle. */
struct map_view map_around(double x, double z, double side_m, int32_t left, int32_t top,
                           uint32_t width, uint32_t height);

/* Where a place of the world is in the picture. */
struct point map_point(const struct map_view *view, double x, double z);

/* Is it within the rectangle, or at most margin pixels outside? */
bool map_holds(const struct map_view *view, struct point point, double margin);

/* The ground, with a contour line every contour_m (every fifth stronger), into an image of its own
 * of the view's size; its corner is the view's, left and top do not matter. 0, or -1 with errno
 * ENOMEM. */
int map_ground(struct image *image, const struct map_view *view, const struct world *world,
               const struct crater_index *craters, double contour_m);

/* Roads as lines, which the ground's own dust hardly shows from so high. */
void map_roads(struct image *image, const struct map_view *view, const struct world *world,
               double pixels);
void map_grid(struct image *image, const struct map_view *view, double step_m);
void map_craters(struct image *image, const struct map_view *view,
                 const struct crater_index *craters);
void map_tracks(struct image *image, const struct map_view *view, const struct moment *moment,
                const struct tracks *tracks);

/* Symbols of length pixels: arrowheads on land, swept wings in the air, hulls at sea, dots for
 * munitions, crosses for wrecks; coloured by force. */
void map_vehicles(struct image *image, const struct map_view *view, const struct moment *moment,
                  double pixels);

/* The followed vehicle: a ring, its direction, and the triangle that it sees. */
void map_followed(struct image *image, const struct map_view *view, const struct moment *moment,
                  uint32_t slot, double pixels);

struct rgba map_force_colour(enum force force);
void map_symbol(struct image *image, struct point at, enum domain domain, double heading_rad,
                double pixels, struct rgba colour);
void map_cross(struct image *image, struct point at, double pixels);

#endif
