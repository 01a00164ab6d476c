/* Shapes with smooth edges. */
#include "supervisor/ground/canvas.h"

#include "world/maths/maths.h"

#include <math.h>
#include <stdbool.h>

#define SAMPLES 4 /* of a polygon in a pixel, in a row and in a column */

/* The pixels of a bounding box within the picture; x1 and y1 are beyond the last. */
struct box {
    int64_t x0, y0, x1, y1;
};

static struct box box_of(const struct canvas *canvas, double low_x, double low_y, double high_x,
                         double high_y)
{
    double last = canvas->size - 1.0;
    return (struct box){(int64_t)maths_clamp(floor(low_x), 0.0, last + 1.0),
                        (int64_t)maths_clamp(floor(low_y), 0.0, last + 1.0),
                        (int64_t)maths_clamp(ceil(high_x), -1.0, last) + 1,
                        (int64_t)maths_clamp(ceil(high_y), -1.0, last) + 1};
}

static void blend(const struct canvas *canvas, int64_t x, int64_t y, double share,
                  struct canvas_colour colour)
{
    uint8_t *pixel = canvas->pixels + 3 * ((size_t)y * canvas->size + (size_t)x);
    const uint8_t to[3] = {colour.red, colour.green, colour.blue};
    for (int k = 0; k < 3; k++)
        pixel[k] = (uint8_t)(pixel[k] + share * (to[k] - pixel[k]) + 0.5);
}

/* A place in pixels. */
static void pixel_of(const struct canvas *canvas, const double at[2], double pixel[2])
{
    pixel[0] = (at[0] - canvas->x0) / canvas->step_m;
    pixel[1] = (at[1] - canvas->z0) / canvas->step_m;
}

/* Returns true if a place [m] is inside, by the number of edges to the east of it. */
static bool is_inside(const double (*corner)[2], size_t count, double x, double z)
{
    bool inside = false;
    for (size_t i = 0, j = count - 1; i < count; j = i++) {
        const double *a = corner[i], *b = corner[j];
        if ((a[1] > z) != (b[1] > z) && x < a[0] + (z - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

void canvas_polygon(const struct canvas *canvas, const double (*corner)[2], size_t count,
                    struct canvas_colour colour)
{
    double low[2] = {1e18, 1e18}, high[2] = {-1e18, -1e18};
    for (size_t i = 0; i < count; i++) {
        double pixel[2];
        pixel_of(canvas, corner[i], pixel);
        for (int k = 0; k < 2; k++) {
            low[k] = maths_min(low[k], pixel[k]);
            high[k] = maths_max(high[k], pixel[k]);
        }
    }
    const struct box box = box_of(canvas, low[0], low[1], high[0], high[1]);
    for (int64_t y = box.y0; y < box.y1; y++) {
        for (int64_t x = box.x0; x < box.x1; x++) {
            int covered = 0;
            for (int s = 0; s < SAMPLES * SAMPLES; s++) {
                double off_x = (s % SAMPLES + 0.5) / SAMPLES - 0.5;
                double off_z = (s / SAMPLES + 0.5) / SAMPLES - 0.5;
                covered +=
                    is_inside(corner, count, canvas->x0 + ((double)x + off_x) * canvas->step_m,
                              canvas->z0 + ((double)y + off_z) * canvas->step_m);
            }
            if (covered)
                blend(canvas, x, y, (double)covered / (SAMPLES * SAMPLES), colour);
        }
    }
}

/* Draws what is nearer to a stretch of pixels than half a width. A disc is a stretch of length 0.
 */
static void draw_stretch(const struct canvas *canvas, const double a[2], const double b[2],
                         double half, struct canvas_colour colour)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], squared = dx * dx + dy * dy;
    const struct box box =
        box_of(canvas, maths_min(a[0], b[0]) - half, maths_min(a[1], b[1]) - half,
               maths_max(a[0], b[0]) + half, maths_max(a[1], b[1]) + half);
    for (int64_t y = box.y0; y < box.y1; y++) {
        for (int64_t x = box.x0; x < box.x1; x++) {
            double to_x = (double)x - a[0], to_y = (double)y - a[1];
            double along =
                squared > 0.0 ? maths_clamp((to_x * dx + to_y * dy) / squared, 0.0, 1.0) : 0.0;
            double off = hypot(to_x - along * dx, to_y - along * dy);
            double share = maths_clamp(half + 0.5 - off, 0.0, 1.0);
            if (share > 0.0)
                blend(canvas, x, y, share, colour);
        }
    }
}

void canvas_line(const struct canvas *canvas, const double from[2], const double to[2],
                 double width_m, double least, struct canvas_colour colour)
{
    double a[2], b[2];
    pixel_of(canvas, from, a);
    pixel_of(canvas, to, b);
    draw_stretch(canvas, a, b, 0.5 * maths_max(width_m / canvas->step_m, least), colour);
}

void canvas_disc(const struct canvas *canvas, const double at[2], double radius_m, double least,
                 struct canvas_colour colour)
{
    double middle[2];
    pixel_of(canvas, at, middle);
    draw_stretch(canvas, middle, middle, maths_max(radius_m / canvas->step_m, least), colour);
}
