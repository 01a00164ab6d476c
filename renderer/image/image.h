/* Pictures in memory and the few antialiased shapes that maps and instruments need. Pure. */
#ifndef JOLON_RENDERER_IMAGE_IMAGE_H
#define JOLON_RENDERER_IMAGE_IMAGE_H

#include <stdint.h>

#define IMAGE_CORNERS_MAX 8u

struct image {
    uint32_t width, height;
    uint8_t *pixels; /* RGBA, rows from the top; owned */
};

struct rgba {
    uint8_t r, g, b, a;
};

struct point {
    double x, y; /* [pixel] from the top left corner; pixel centres lie at halves */
};

/* A black picture. 0, or -1 with errno ENOMEM. */
int image_init(struct image *image, uint32_t width, uint32_t height);
void image_free(struct image *image);

/* Everything below clips to the picture and blends by the colour's alpha. */
void image_rectangle(struct image *image, int32_t x, int32_t y, int32_t width, int32_t height,
                     struct rgba colour);
/* A small square: the cheapest shape, for drawing thousands. */
void image_dot(struct image *image, struct point centre, double side, struct rgba colour);
void image_line(struct image *image, struct point from, struct point to, double width,
                struct rgba colour);
void image_disc(struct image *image, struct point centre, double radius, struct rgba colour);
void image_ring(struct image *image, struct point centre, double radius, double width,
                struct rgba colour);
/* A convex polygon of 3 to IMAGE_CORNERS_MAX corners, in either sense of turn. */
void image_polygon(struct image *image, const struct point *corners, uint32_t count,
                   struct rgba colour);

/* Blends one pixel of the picture. a: 0..255, used instead of the colour's own alpha. */
static inline void image_blend(uint8_t *pixel, struct rgba colour, int32_t a)
{
    pixel[0] = (uint8_t)(pixel[0] + ((colour.r - pixel[0]) * a) / 255);
    pixel[1] = (uint8_t)(pixel[1] + ((colour.g - pixel[1]) * a) / 255);
    pixel[2] = (uint8_t)(pixel[2] + ((colour.b - pixel[2]) * a) / 255);
    pixel[3] = 255;
}

/* Copies the whole picture to (x, y) of another. */
void image_copy(struct image *to, const struct image *from, int32_t x, int32_t y);

#endif
