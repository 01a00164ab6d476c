/* Drawing the map. */
#include "renderer/chart/map.h"

#include "renderer/scene/camera.h"
#include "renderer/scene/paint.h"
#include "world/square.h"

#include <math.h>
#include <stdlib.h>

#define RELIEF          2.2 /* slopes look so much steeper than they are */
#define INDEX_CONTOUR   5
#define TRIANGLE_PIXELS 70.0 /* the viewing triangle's length */

static const struct rgba outline = {12, 14, 18, 220};

struct map_view map_whole(int32_t left, int32_t top, uint32_t side)
{
    return (struct map_view){0.0, 0.0, WORLD_SIDE_M / side, left, top, side, side};
}

struct map_view map_around(double x, double z, double side_m, int32_t left, int32_t top,
                           uint32_t width, uint32_t height)
{
    double metres = side_m / width;
    return (struct map_view){
        x - 0.5 * metres * width, z - 0.5 * metres * height, metres, left, top, width, height};
}

struct point map_point(const struct map_view *view, double x, double z)
{
    return (struct point){view->left + (x - view->x) / view->metres,
                          view->top + (z - view->z) / view->metres};
}

bool map_holds(const struct map_view *view, struct point point, double margin)
{
    return point.x >= view->left - margin && point.y >= view->top - margin &&
           point.x < view->left + (double)view->width + margin &&
           point.y < view->top + (double)view->height + margin;
}

/* --- ground ----------------------------------------------------------------------------------- */

static int32_t contour_at(const struct map_view *view, const struct terrain *terrain,
                          uint32_t column, uint32_t row, double contour_m)
{
    double x = view->x + (column + 0.5) * view->metres, z = view->z + (row + 0.5) * view->metres;
    return (int32_t)floor(terrain_base_height(terrain, x, z) / contour_m);
}

static void darken(uint8_t *pixel, int32_t share)
{
    for (uint32_t i = 0; i < 3; i++)
        pixel[i] = (uint8_t)(pixel[i] * (256 - share) / 256);
}

/* A pixel whose right or lower neighbour lies in another band of height is on a contour. */
static void draw_contours(struct image *image, const struct map_view *view,
                          const struct terrain *terrain, double contour_m)
{
    for (uint32_t row = 0; row < view->height; row++) {
        int32_t right = contour_at(view, terrain, 0, row, contour_m);
        for (uint32_t column = 0; column < view->width; column++) {
            int32_t here = right;
            right = contour_at(view, terrain, column + 1, row, contour_m);
            int32_t below = contour_at(view, terrain, column, row + 1, contour_m);
            int32_t top = here > right ? here : right;
            top = top > below ? top : below;
            if (here == right && here == below)
                continue;
            darken(image->pixels + ((size_t)row * image->width + column) * 4,
                   top % INDEX_CONTOUR == 0 ? 92 : 44);
        }
    }
}

int map_ground(struct image *image, const struct map_view *view, const struct world *world,
               const struct crater_index *craters, double contour_m)
{
    float *light = malloc((size_t)view->width * view->height * sizeof *light);
    if (light == NULL)
        return -1;
    struct paint_tile tile = {
        .x = view->x + 0.5 * view->metres,
        .z = view->z + 0.5 * view->metres,
        .step_m = view->metres,
        .columns = view->width,
        .rows = view->height,
        .sun = {-0.52, 0.68, -0.52}, /* from the north-west, as on all maps */
        .relief = RELIEF,
        .rgba = image->pixels,
        .light = light,
    };
    paint_ground(world, craters, &tile);
    free(light);
    for (size_t i = 0; i < (size_t)view->width * view->height; i++)
        image->pixels[i * 4 + 3] = 255;
    draw_contours(image, view, &world->terrain, contour_m);
    return 0;
}

void map_roads(struct image *image, const struct map_view *view, const struct world *world,
               double pixels)
{
    const struct rgba line = {112, 58, 34, 190};
    for (uint32_t i = 0; i + 1 < world->counts.road_points; i++) {
        const struct road_point *a = &world->road_points[i], *b = a + 1;
        struct point from = map_point(view, (double)a->x, (double)a->z);
        struct point to = map_point(view, (double)b->x, (double)b->z);
        if (a->road == b->road && map_holds(view, from, -pixels) && map_holds(view, to, -pixels))
            image_line(image, from, to, pixels, line);
    }
}

void map_grid(struct image *image, const struct map_view *view, double step_m)
{
    const struct rgba line = {20, 24, 30, 70};
    double width = view->width * view->metres, height = view->height * view->metres;
    for (int32_t n = (int32_t)ceil(view->x / step_m); n * step_m < view->x + width; n++)
        image_rectangle(image, (int32_t)map_point(view, n * step_m, 0.0).x, view->top, 1,
                        (int32_t)view->height, line);
    for (int32_t n = (int32_t)ceil(view->z / step_m); n * step_m < view->z + height; n++)
        image_rectangle(image, view->left, (int32_t)map_point(view, 0.0, n * step_m).y,
                        (int32_t)view->width, 1, line);
}

void map_craters(struct image *image, const struct map_view *view,
                 const struct crater_index *craters)
{
    const struct rgba soot = {30, 24, 18, 200};
    for (uint32_t i = 0; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        struct point at = map_point(view, crater->x, crater->z);
        double radius = fmax(1.0, (double)crater->radius_m / view->metres);
        if (map_holds(view, at, -radius))
            image_disc(image, at, radius, soot);
    }
}

/* --- vehicles --------------------------------------------------------------------------------- */

struct rgba map_force_colour(enum force force)
{
    switch (force) {
    case FORCE_BLUE:
        return (struct rgba){64, 140, 255, 255};
    case FORCE_RED:
        return (struct rgba){255, 70, 52, 255};
    default:
        return (struct rgba){250, 222, 110, 255};
    }
}

/* Corners in units of the symbol's length: forward, to the right. */
struct silhouette {
    double corner[6][2];
    uint32_t count;
};

static const struct silhouette arrowhead = {{{0.62, 0.0}, {-0.42, 0.42}, {-0.42, -0.42}}, 3};
static const struct silhouette hull = {
    {{0.65, 0.0}, {0.2, 0.24}, {-0.55, 0.24}, {-0.55, -0.24}, {0.2, -0.24}}, 5};
static const struct silhouette left_wing = {{{0.6, 0.0}, {-0.25, 0.0}, {-0.5, -0.55}}, 3};
static const struct silhouette right_wing = {{{0.6, 0.0}, {-0.25, 0.0}, {-0.5, 0.55}}, 3};

static void draw_shape(struct image *image, const struct silhouette *shape, struct point at,
                       double heading, double pixels, struct rgba colour)
{
    struct point corners[6];
    double s = sin(heading), c = cos(heading);
    for (uint32_t i = 0; i < shape->count; i++) {
        double forward = shape->corner[i][0] * pixels, right = shape->corner[i][1] * pixels;
        corners[i] = (struct point){at.x + s * forward + c * right, at.y - c * forward + s * right};
    }
    image_polygon(image, corners, shape->count, colour);
}

void map_symbol(struct image *image, struct point at, enum domain domain, double heading_rad,
                double pixels, struct rgba colour)
{
    double rim = pixels + 3.0;
    switch (domain) {
    case DOMAIN_AIR:
        draw_shape(image, &left_wing, at, heading_rad, rim, outline);
        draw_shape(image, &right_wing, at, heading_rad, rim, outline);
        draw_shape(image, &left_wing, at, heading_rad, pixels, colour);
        draw_shape(image, &right_wing, at, heading_rad, pixels, colour);
        break;
    case DOMAIN_SEA:
        draw_shape(image, &hull, at, heading_rad, 1.4 * rim, outline);
        draw_shape(image, &hull, at, heading_rad, 1.4 * pixels, colour);
        break;
    case DOMAIN_MUNITION:
        image_disc(image, at, 0.16 * pixels + 0.8, outline);
        image_disc(image, at, 0.16 * pixels, (struct rgba){255, 245, 200, 255});
        break;
    default:
        draw_shape(image, &arrowhead, at, heading_rad, rim, outline);
        draw_shape(image, &arrowhead, at, heading_rad, pixels, colour);
        break;
    }
}

void map_cross(struct image *image, struct point at, double pixels)
{
    double half = 0.32 * pixels;
    const struct rgba pale = {235, 225, 205, 160}, black = {10, 8, 6, 255};
    for (int32_t side = -1; side <= 1; side += 2) {
        struct point a = {at.x - half, at.y - side * half}, b = {at.x + half, at.y + side * half};
        image_line(image, a, b, 3.4, pale);
    }
    for (int32_t side = -1; side <= 1; side += 2) {
        struct point a = {at.x - half, at.y - side * half}, b = {at.x + half, at.y + side * half};
        image_line(image, a, b, 1.8, black);
    }
}

static enum domain domain_of(const struct moment *moment, uint32_t slot)
{
    return (enum domain)moment->world->kinds[moment->entities->kind[slot]].domain;
}

void map_tracks(struct image *image, const struct map_view *view, const struct moment *moment,
                const struct tracks *tracks)
{
    const struct entities *e = moment->entities;
    for (uint32_t slot = 0; slot < moment->head->used; slot++) {
        const struct track *track = tracks_of(tracks, slot, e->id[slot]);
        if (track == NULL || e->state[slot] == ENTITY_FREE ||
            domain_of(moment, slot) == DOMAIN_MUNITION)
            continue;
        uint32_t held = track->count < TRACK_POINTS ? track->count : TRACK_POINTS;
        struct rgba colour = map_force_colour((enum force)e->force[slot]);
        struct point to = map_point(view, e->x[slot], e->z[slot]);
        for (uint32_t i = 1; i <= held; i++) {
            uint32_t at = (track->count - i) % TRACK_POINTS;
            struct point from = map_point(view, (double)track->x[at], (double)track->z[at]);
            colour.a = (uint8_t)(190 - 160 * i / TRACK_POINTS);
            if (map_holds(view, to, -2.0) && map_holds(view, from, -2.0))
                image_line(image, from, to, 1.3, colour);
            to = from;
        }
    }
}

void map_vehicles(struct image *image, const struct map_view *view, const struct moment *moment,
                  double pixels)
{
    const struct entities *e = moment->entities;
    /* Wrecks first, then munitions, then what lives: the most important on top. */
    for (uint32_t pass = 0; pass < 3; pass++)
        for (uint32_t slot = 0; slot < moment->head->used; slot++) {
            if (e->state[slot] == ENTITY_FREE || e->kind[slot] >= moment->world->counts.kinds)
                continue;
            enum domain domain = domain_of(moment, slot);
            uint32_t turn = e->state[slot] == ENTITY_WRECK ? 0 : domain == DOMAIN_MUNITION ? 1 : 2;
            struct point at = map_point(view, e->x[slot], e->z[slot]);
            if (turn != pass || !map_holds(view, at, -0.6 * pixels))
                continue;
            if (pass == 0)
                map_cross(image, at, pixels);
            else
                map_symbol(image, at, domain, e->heading[slot], pixels,
                           map_force_colour((enum force)e->force[slot]));
        }
}

void map_followed(struct image *image, const struct map_view *view, const struct moment *moment,
                  uint32_t slot, double pixels)
{
    const struct entities *e = moment->entities;
    struct point at = map_point(view, e->x[slot], e->z[slot]);
    if (!map_holds(view, at, 0.0))
        return;
    double half = 0.5 * CAMERA_FIELD_OF_VIEW_RAD, heading = e->heading[slot];
    double length = fmin(TRIANGLE_PIXELS, 0.25 * view->width);
    struct point corners[3] = {
        at,
        {at.x + length * sin(heading - half), at.y - length * cos(heading - half)},
        {at.x + length * sin(heading + half), at.y - length * cos(heading + half)},
    };
    image_polygon(image, corners, 3, (struct rgba){255, 240, 120, 80});
    image_line(image, corners[0], corners[1], 1.2, (struct rgba){255, 240, 120, 200});
    image_line(image, corners[0], corners[2], 1.2, (struct rgba){255, 240, 120, 200});
    struct point ahead = {at.x + 0.8 * length * sin(heading), at.y - 0.8 * length * cos(heading)};
    image_line(image, at, ahead, 1.2, (struct rgba){255, 255, 255, 220});
    image_ring(image, at, 0.9 * pixels, 2.6, (struct rgba){0, 0, 0, 160});
    image_ring(image, at, 0.9 * pixels, 1.6, (struct rgba){255, 255, 255, 255});
}
