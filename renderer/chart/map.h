/* The map (thesis row 12): every vehicle's position, direction and track over the base map, what
 * burns and explodes, and what the driven vehicle's camera sees. Pure; drawn in software. Words are
 * added by annotated_picture.c. Everything is clipped by the image, not by the view: a view that is
 * not all of its image needs an image of its own. */
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

/* A piece of the world in a rectangle of a picture. */
struct map_view {
    double x, z;       /* [m, world] at the rectangle's top left corner */
    double metres;     /* a pixel */
    int32_t left, top; /* [pixel] of the rectangle in the picture */
    uint32_t width, height;
};

/* The whole square, as large as fits. */
struct map_view map_whole(int32_t left, int32_t top, uint32_t side);

/* The ground around a place, at a scale. */
struct map_view map_around(double x, double z, double metres, int32_t left, int32_t top,
                           uint32_t width, uint32_t height);

/* Moves a view by less than a pixel, so that its pixels are those of the world's raster. */
void map_align(struct map_view *view);

/* Where a place of the world is in the picture. */
struct point map_point(const struct map_view *view, double x, double z);

/* Is it within the rectangle, or at most margin pixels outside? */
bool map_contains(const struct map_view *view, struct point point, double margin);

/* The longest of 1, 2 and 5 times a power of ten that is at most metres. */
double map_round_down(double metres);

void map_grid(struct image *image, const struct map_view *view, double step_m);
void map_craters(struct image *image, const struct map_view *view,
                 const struct crater_index *craters, double pixels);

/* Tracks of all vehicles: a dot where each was every TRACK_INTERVAL_S, fading with age from this
 * opacity; pixels is the length of symbols. */
void map_tracks(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct tracks *tracks, double pixels,
                uint8_t opacity);

/* Symbols of length pixels (symbol.h); the followed vehicle (SLOT_NONE: none) on top of all. */
void map_vehicles(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels);

/* Detonations of the last seconds. */
void map_blasts(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct effects *effects, double pixels);

/* The triangle that a camera sees, from its eye in its direction with its field of view; nothing
 * for one that looks nearly straight down. */
void map_camera(struct image *image, const struct map_view *view, const struct camera *camera,
                double length);

/* The followed vehicle's ring and direction. */
void map_followed(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels, double length);

#endif
