/* The map (thesis row 12): every vehicle's position, direction and track over the base map, fires
 * and detonations, and the triangle that the camera sees. Pure. Everything is clipped by the image,
 * not by the view. */
#ifndef JOLON_RENDERER_CHART_MAP_H
#define JOLON_RENDERER_CHART_MAP_H

#include "renderer/chart/symbol.h"
#include "renderer/chart/track.h"
#include "renderer/image/image.h"
#include "renderer/scene/camera/camera.h"
#include "renderer/scene/frame/effects.h"
#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

/* A part of the world in a rectangle of a picture. */
struct map_view {
    double x, z;       /* [m, world] of the rectangle's top left corner */
    double metres;     /* [m] a pixel */
    int32_t left, top; /* [pixel] of the rectangle in the picture */
    uint32_t width, height;
};

/* The whole world, side_m across, in a square of side pixels. */
struct map_view map_whole(double side_m, int32_t left, int32_t top, uint32_t side);

/* The surroundings of (x, z) [m, world] at so many metres a pixel. */
struct map_view map_around(double x, double z, double metres, int32_t left, int32_t top,
                           uint32_t width, uint32_t height);

/* Moves a view by at most half a pixel, so that its pixels are those of the world's raster. */
void map_align(struct map_view *view);

/* Returns where a place of the world is in the picture [pixel]. */
struct point map_point(const struct map_view *view, double x, double z);

/* Returns true if a point is in the rectangle, or at most margin pixels outside. */
bool map_contains(const struct map_view *view, struct point point, double margin);

/* Returns the largest number up to metres that is 1, 2 or 5 times a power of ten. */
double map_round_down(double metres);

void map_grid(struct image *image, const struct map_view *view, double side_m, double step_m);
void map_craters(struct image *image, const struct map_view *view,
                 const struct crater_index *craters, double pixels);

/* Draws each earthwork as a rectangle in the colour of its shape. Works far smaller than a pixel do
 * not show. */
void map_earthworks(struct image *image, const struct map_view *view,
                    const struct earthworks *earthworks);

/* Draws the objectives of the battle: the area of each in the colour of the force that holds it. */
void map_objectives(struct image *image, const struct map_view *view,
                    const struct frame_view *frame_view);

/* Draws every vehicle's track: a dot for each TRACK_INTERVAL_S, which fades with age from this
 * opacity. pixels: length of symbols. */
void map_tracks(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct tracks *tracks, double pixels,
                uint8_t opacity);

/* Draws symbols of this length (symbol.h). The vehicle in slot (SLOT_NONE: none) is the topmost. */
void map_vehicles(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels);

/* Draws the detonations of the last seconds. */
void map_blasts(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct effects *effects, double pixels);

/* Draws the triangle that a camera sees, unless it looks nearly straight down. length: [pixel] */
void map_camera(struct image *image, const struct map_view *view, const struct camera *camera,
                double length);

/* Draws the followed vehicle's ring and a line of this length [pixel] in its direction. */
void map_followed(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels, double length);

#endif
