/* Software shapes: every shape is a distance to its edge, and a pixel's coverage follows from it.
 */
#include "renderer/image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct span {
    int32_t x0, y0, x1, y1; /* pixels, exclusive at the end */
};

static struct span span_of(const struct image *image, double x0, double y0, double x1, double y1)
{
    double width = (double)image->width, height = (double)image->height;
    struct span span = {0, 0, 0, 0};
    if (!(x1 > 0.0 && y1 > 0.0 && x0 < width && y0 < height))
        return span;
    span.x0 = (int32_t)fmax(0.0, floor(x0));
    span.y0 = (int32_t)fmax(0.0, floor(y0));
    span.x1 = (int32_t)fmin(width, ceil(x1));
    span.y1 = (int32_t)fmin(height, ceil(y1));
    return span;
}

int image_init(struct image *image, uint32_t width, uint32_t height)
{
    image->pixels = calloc((size_t)width * height, 4);
    if (image->pixels == NULL)
        return -1;
    image->width = width;
    image->height = height;
    return 0;
}

void image_free(struct image *image)
{
    free(image->pixels);
    image->pixels = NULL;
}

void image_blend(struct image *image, int32_t x, int32_t y, struct rgba colour, float coverage)
{
    if (x < 0 || y < 0 || (uint32_t)x >= image->width || (uint32_t)y >= image->height)
        return;
    uint8_t *pixel = image->pixels + ((size_t)y * image->width + (size_t)x) * 4;
    int32_t a = (int32_t)((float)colour.a * coverage + 0.5f);
    const uint8_t in[3] = {colour.r, colour.g, colour.b};
    for (int32_t i = 0; i < 3; i++)
        pixel[i] = (uint8_t)(pixel[i] + ((in[i] - pixel[i]) * a) / 255);
    pixel[3] = 255;
}

void image_rectangle(struct image *image, int32_t x, int32_t y, int32_t width, int32_t height,
                     struct rgba colour)
{
    struct span span = span_of(image, x, y, (double)x + width, (double)y + height);
    for (int32_t row = span.y0; row < span.y1; row++)
        for (int32_t column = span.x0; column < span.x1; column++)
            image_blend(image, column, row, colour, 1.0f);
}

static void blend_edge(struct image *image, int32_t x, int32_t y, struct rgba colour, double inside)
{
    if (inside > -0.5)
        image_blend(image, x, y, colour, (float)fmin(1.0, inside + 0.5));
}

void image_line(struct image *image, struct point from, struct point to, double width,
                struct rgba colour)
{
    double half = 0.5 * width, dx = to.x - from.x, dy = to.y - from.y;
    double squared = dx * dx + dy * dy;
    struct span span =
        span_of(image, fmin(from.x, to.x) - half - 1.0, fmin(from.y, to.y) - half - 1.0,
                fmax(from.x, to.x) + half + 1.0, fmax(from.y, to.y) + half + 1.0);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++) {
            double px = x + 0.5 - from.x, py = y + 0.5 - from.y;
            double t = squared > 0.0 ? (px * dx + py * dy) / squared : 0.0;
            t = fmin(1.0, fmax(0.0, t));
            blend_edge(image, x, y, colour, half - hypot(px - t * dx, py - t * dy));
        }
}

void image_disc(struct image *image, struct point centre, double radius, struct rgba colour)
{
    struct span span = span_of(image, centre.x - radius - 1.0, centre.y - radius - 1.0,
                               centre.x + radius + 1.0, centre.y + radius + 1.0);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++)
            blend_edge(image, x, y, colour, radius - hypot(x + 0.5 - centre.x, y + 0.5 - centre.y));
}

void image_ring(struct image *image, struct point centre, double radius, double width,
                struct rgba colour)
{
    double reach = radius + width + 1.0;
    struct span span =
        span_of(image, centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++) {
            double off = hypot(x + 0.5 - centre.x, y + 0.5 - centre.y) - radius;
            blend_edge(image, x, y, colour, 0.5 * width - fabs(off));
        }
}

void image_polygon(struct image *image, const struct point *corners, uint32_t count,
                   struct rgba colour)
{
    double x0 = corners[0].x, y0 = corners[0].y, x1 = x0, y1 = y0, area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct point a = corners[i], b = corners[(i + 1) % count];
        x0 = fmin(x0, a.x);
        y0 = fmin(y0, a.y);
        x1 = fmax(x1, a.x);
        y1 = fmax(y1, a.y);
        area += a.x * b.y - b.x * a.y;
    }
    double sense = area < 0.0 ? -1.0 : 1.0;
    struct span span = span_of(image, x0 - 1.0, y0 - 1.0, x1 + 1.0, y1 + 1.0);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++) {
            double inside = 1.0;
            for (uint32_t i = 0; i < count && inside > -0.5; i++) {
                struct point a = corners[i], b = corners[(i + 1) % count];
                double ex = b.x - a.x, ey = b.y - a.y, length = hypot(ex, ey);
                if (length > 0.0)
                    inside = fmin(inside,
                                  sense * (ex * (y + 0.5 - a.y) - ey * (x + 0.5 - a.x)) / length);
            }
            blend_edge(image, x, y, colour, inside);
        }
}

void image_copy(struct image *to, const struct image *from, int32_t x, int32_t y)
{
    struct span span = span_of(to, x, y, (double)x + from->width, (double)y + from->height);
    if (span.x1 <= span.x0)
        return;
    for (int32_t row = span.y0; row < span.y1; row++) {
        const uint8_t *source =
            from->pixels + ((size_t)(row - y) * from->width + (size_t)(span.x0 - x)) * 4;
        uint8_t *target = to->pixels + ((size_t)row * to->width + (size_t)span.x0) * 4;
        memcpy(target, source, (size_t)(span.x1 - span.x0) * 4);
    }
}
