/* Shapes drawn in software. A pixel's coverage follows from its distance to the shape's edge. */
#include "renderer/image/image.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct row_span {
    int32_t x0, y0, x1, y1; /* pixels, from x0, y0 to before x1, y1 */
};

/* Unlike fmin() and fmax(), these are inlined. */
static double least(double a, double b)
{
    return a < b ? a : b;
}

static double most(double a, double b)
{
    return a > b ? a : b;
}

/* Rounding down and up, for values in an int's range. */
static int32_t floor_of(double v)
{
    int32_t whole = (int32_t)v;
    return whole - (v < whole);
}

static int32_t ceil_of(double v)
{
    int32_t whole = (int32_t)v;
    return whole + (v > whole);
}

static struct row_span span_of(const struct image *image, double x0, double y0, double x1,
                               double y1)
{
    double width = (double)image->width, height = (double)image->height;
    struct row_span span = {0, 0, 0, 0};
    if (!(x1 > 0.0 && y1 > 0.0 && x0 < width && y0 < height))
        return span;
    span.x0 = x0 > 0.0 ? floor_of(x0) : 0;
    span.y0 = y0 > 0.0 ? floor_of(y0) : 0;
    span.x1 = x1 < width ? ceil_of(x1) : (int32_t)image->width;
    span.y1 = y1 < height ? ceil_of(y1) : (int32_t)image->height;
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

static uint8_t *pixel_of(struct image *image, int32_t x, int32_t y)
{
    return image->pixels + ((size_t)y * image->width + (size_t)x) * 4;
}

static void fill(struct image *image, struct row_span span, struct rgba colour)
{
    uint8_t *first = pixel_of(image, span.x0, span.y0);
    for (int32_t column = 0; column < span.x1 - span.x0; column++)
        memcpy(first + (size_t)column * 4, &colour, 4);
    for (int32_t row = span.y0 + 1; row < span.y1; row++)
        memcpy(pixel_of(image, span.x0, row), first, (size_t)(span.x1 - span.x0) * 4);
}

void image_rectangle(struct image *image, int32_t x, int32_t y, int32_t width, int32_t height,
                     struct rgba colour)
{
    struct row_span span = span_of(image, x, y, (double)x + width, (double)y + height);
    if (colour.a == 255 && span.x0 < span.x1 && span.y0 < span.y1) {
        fill(image, span, colour);
        return;
    }
    uint8_t blended[256][4]; /* the result for each value of a channel */
    for (int32_t v = 0; v < 256; v++) {
        uint8_t pixel[4] = {(uint8_t)v, (uint8_t)v, (uint8_t)v, 255};
        image_blend(pixel, colour, colour.a);
        memcpy(blended[v], pixel, sizeof pixel);
    }
    for (int32_t row = span.y0; row < span.y1; row++) {
        uint8_t *pixel = pixel_of(image, span.x0, row);
        for (int32_t column = span.x0; column < span.x1; column++, pixel += 4) {
            pixel[0] = blended[pixel[0]][0];
            pixel[1] = blended[pixel[1]][1];
            pixel[2] = blended[pixel[2]][2];
            pixel[3] = 255;
        }
    }
}

void image_dot(struct image *image, struct point centre, double side, struct rgba colour)
{
    double left = centre.x - 0.5 * side, top = centre.y - 0.5 * side;
    struct row_span span = span_of(image, left, top, left + side, top + side);
    for (int32_t y = span.y0; y < span.y1; y++) {
        double tall = least(y + 1.0, top + side) - most(y, top);
        for (int32_t x = span.x0; x < span.x1; x++) {
            double wide = least(x + 1.0, left + side) - most(x, left);
            image_blend(pixel_of(image, x, y), colour, (int32_t)(colour.a * wide * tall + 0.5));
        }
    }
}

/* Blends a pixel of the picture that lies this deep within an edge [pixel]. */
static void blend_edge(uint8_t *pixel, struct rgba colour, double inside)
{
    if (inside > -0.5)
        image_blend(pixel, colour,
                    inside >= 0.5 ? colour.a : (int32_t)(colour.a * (inside + 0.5) + 0.5));
}

/* Narrows the columns to those where slope * x + at > -0.5, x being the middle of a pixel. */
static void narrow(struct row_span *span, double slope, double at)
{
    if (fabs(slope) < 1e-9) {
        if (at <= -0.5)
            span->x1 = span->x0;
        return;
    }
    double edge = (-0.5 - at) / slope - 0.5;
    if (slope > 0.0 && edge > span->x0)
        span->x0 = edge < span->x1 ? floor_of(edge) : span->x1;
    else if (slope < 0.0 && edge + 1.0 < span->x1)
        span->x1 = edge > span->x0 ? ceil_of(edge) + 1 : span->x0;
}

void image_line(struct image *image, struct point from, struct point to, double width,
                struct rgba colour)
{
    double half = 0.5 * width, dx = to.x - from.x, dy = to.y - from.y;
    struct row_span span =
        span_of(image, least(from.x, to.x) - half - 1.0, least(from.y, to.y) - half - 1.0,
                most(from.x, to.x) + half + 1.0, most(from.y, to.y) + half + 1.0);
    if (span.x0 >= span.x1 || span.y0 >= span.y1)
        return; /* most roads are outside of a picture */
    double length = sqrt(dx * dx + dy * dy);
    double ux = length > 0.0 ? dx / length : 1.0, uy = length > 0.0 ? dy / length : 0.0;
    /* A row meets the line around the point where it crosses the line's middle. It extends to both
     * sides as far as the line's width and slant require. */
    bool level = fabs(uy) < 1e-3;
    double run = level ? 0.0 : ux / uy, slant = level ? 0.0 : (half + 0.5) / fabs(uy) + 1.0;
    for (int32_t y = span.y0; y < span.y1; y++) {
        double py = y + 0.5 - from.y, middle = from.x + run * py;
        int32_t x0 = span.x0, x1 = span.x1;
        if (!level && middle - slant > x0)
            x0 = middle - slant < x1 ? (int32_t)(middle - slant) : x1;
        if (!level && middle + slant < x1)
            x1 = middle + slant > x0 ? (int32_t)(middle + slant) : x0;
        for (int32_t x = x0; x < x1; x++) {
            double px = x + 0.5 - from.x, along = px * ux + py * uy, off = fabs(px * uy - py * ux);
            if (off >= half + 0.5)
                continue;
            double over = along < 0.0 ? -along : along - length;
            if (over > 0.0)
                off = sqrt(off * off + over * over);
            blend_edge(pixel_of(image, x, y), colour, half - off);
        }
    }
}

void image_disc(struct image *image, struct point centre, double radius, struct rgba colour)
{
    double reach = radius + 1.0;
    struct row_span span =
        span_of(image, centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++) {
            double dx = x + 0.5 - centre.x, dy = y + 0.5 - centre.y;
            blend_edge(pixel_of(image, x, y), colour, radius - sqrt(dx * dx + dy * dy));
        }
}

void image_ring(struct image *image, struct point centre, double radius, double width,
                struct rgba colour)
{
    double reach = radius + 0.5 * width + 1.0;
    struct row_span span =
        span_of(image, centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach);
    for (int32_t y = span.y0; y < span.y1; y++)
        for (int32_t x = span.x0; x < span.x1; x++) {
            double dx = x + 0.5 - centre.x, dy = y + 0.5 - centre.y;
            double off = sqrt(dx * dx + dy * dy) - radius;
            blend_edge(pixel_of(image, x, y), colour, 0.5 * width - fabs(off));
        }
}

void image_polygon(struct image *image, const struct point *corners, uint32_t count,
                   struct rgba colour)
{
    struct {
        double x, y, at; /* x * px + y * py + at is the depth within the edge */
    } edges[IMAGE_CORNERS_MAX];
    double x0 = corners[0].x, y0 = corners[0].y, x1 = x0, y1 = y0, area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct point a = corners[i], b = corners[(i + 1) % count];
        x0 = least(x0, a.x);
        y0 = least(y0, a.y);
        x1 = most(x1, a.x);
        y1 = most(y1, a.y);
        area += a.x * b.y - b.x * a.y;
    }
    double sense = area < 0.0 ? -1.0 : 1.0;
    uint32_t held = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct point a = corners[i], b = corners[(i + 1) % count];
        double ex = b.x - a.x, ey = b.y - a.y, length = sqrt(ex * ex + ey * ey);
        if (length <= 0.0)
            continue;
        edges[held].x = -sense * ey / length;
        edges[held].y = sense * ex / length;
        edges[held].at = -(edges[held].x * a.x + edges[held].y * a.y);
        held++;
    }
    struct row_span span = span_of(image, x0 - 1.0, y0 - 1.0, x1 + 1.0, y1 + 1.0);
    for (int32_t y = span.y0; y < span.y1; y++) {
        struct row_span row = span;
        for (uint32_t i = 0; i < held; i++)
            narrow(&row, edges[i].x, edges[i].y * (y + 0.5) + edges[i].at);
        for (int32_t x = row.x0; x < row.x1; x++) {
            double inside = 1.0;
            for (uint32_t i = 0; i < held; i++) {
                double within = edges[i].x * (x + 0.5) + edges[i].y * (y + 0.5) + edges[i].at;
                inside = within < inside ? within : inside;
            }
            blend_edge(pixel_of(image, x, y), colour, inside);
        }
    }
}

void image_copy(struct image *to, const struct image *from, int32_t x, int32_t y)
{
    struct row_span span = span_of(to, x, y, (double)x + from->width, (double)y + from->height);
    if (span.x1 <= span.x0)
        return;
    for (int32_t row = span.y0; row < span.y1; row++) {
        const uint8_t *source =
            from->pixels + ((size_t)(row - y) * from->width + (size_t)(span.x0 - x)) * 4;
        uint8_t *target = to->pixels + ((size_t)row * to->width + (size_t)span.x0) * 4;
        memcpy(target, source, (size_t)(span.x1 - span.x0) * 4);
    }
}
