/* A picture in memory over a square of ground, and shapes in it whose edges are smoothed. Pure. */
#ifndef JOLON_SUPERVISOR_GROUND_CANVAS_H
#define JOLON_SUPERVISOR_GROUND_CANVAS_H

#include <stddef.h>
#include <stdint.h>

struct canvas {
    uint8_t *pixels; /* [size * size * 3] red, green, blue, row by row from the north-west */
    uint32_t size;   /* width and height */
    double x0, z0;   /* of the first pixel's middle [m] */
    double step_m;   /* between pixels */
};

struct canvas_colour {
    uint8_t red, green, blue;
};

/* Fills the inside of a polygon of corners [count][x, z] [m], as far as it covers each pixel. */
void canvas_polygon(const struct canvas *canvas, const double (*corner)[2], size_t count,
                    struct canvas_colour colour);

/* Draws a line of a width [m], at least `least` pixels. */
void canvas_line(const struct canvas *canvas, const double from[2], const double to[2],
                 double width_m, double least, struct canvas_colour colour);

/* Draws a disc of a radius [m], at least `least` pixels. */
void canvas_disc(const struct canvas *canvas, const double at[2], double radius_m, double least,
                 struct canvas_colour colour);

#endif
