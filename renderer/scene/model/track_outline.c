/* Computes the convex hull by Andrew's monotone chain. */
#include "renderer/scene/model/track_outline.h"

#include "world/model.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct point {
    float x, y;
};

static int by_x(const void *left, const void *right)
{
    const struct point *a = left, *b = right;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

static double turn(const struct point *a, const struct point *b, const struct point *c)
{
    return ((double)b->x - (double)a->x) * ((double)c->y - (double)a->y) -
           ((double)b->y - (double)a->y) * ((double)c->x - (double)a->x);
}

/* Adds a point to one side of the hull, which begins after `least` points. */
static uint32_t chain(struct point *line, uint32_t least, uint32_t count, const struct point *next)
{
    while (count >= least + 2 && turn(&line[count - 2], &line[count - 1], next) <= 0.0)
        count--;
    line[count] = *next;
    return count + 1;
}

static uint32_t wrap(struct point *line, const struct point *points, uint32_t count)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++)
        n = chain(line, 0, n, &points[i]);
    uint32_t lower = n > 0 ? n - 1 : 0;
    for (uint32_t i = count; i-- > 1;)
        n = chain(line, lower, n, &points[i - 1]);
    return n > 1 ? n - 1 : n; /* the last point is the first one */
}

static uint32_t collect(const struct world *world, uint32_t model, uint32_t joint,
                        struct point *points)
{
    const struct model *m = &world->models[model];
    uint32_t count = 0;
    for (uint32_t t = m->solid_triangles; t < m->triangle_count; t++) {
        const struct model_triangle *triangle = &world->model_triangles[m->first_triangle + t];
        for (uint32_t i = 0; triangle->joint == joint && i < 3; i++) {
            const struct model_vertex *v =
                &world->model_vertices[m->first_vertex + triangle->vertex[i]];
            points[count++] = (struct point){v->x, v->y};
        }
    }
    return count;
}

static void measure(struct track_outline *outline, const struct point *line)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < outline->count; i++) {
        const struct point *next = &line[i + 1 < outline->count ? i + 1 : 0];
        outline->corner[i][0] = line[i].x;
        outline->corner[i][1] = line[i].y;
        outline->along[i] = (float)sum;
        double dx = (double)next->x - (double)line[i].x, dy = (double)next->y - (double)line[i].y;
        sum += sqrt(dx * dx + dy * dy);
    }
    outline->along[outline->count] = (float)sum;
    double links = 2.0 * floor(sum / (2.0 * TRACK_OUTLINE_LINK_M) +
                               0.5); /* an even number: links are light and dark alternately */
    outline->link_m = links > 0.0 ? (float)(sum / links) : 0.0f;
}

int track_outline_find(struct track_outline *outline, const struct world *world, uint32_t model,
                       uint32_t joint)
{
    uint32_t most = 3 * world->models[model].triangle_count;
    struct point *points = malloc((most + 1) * sizeof *points);
    struct point *line = malloc((2 * (size_t)most + 2) * sizeof *line);
    *outline = (struct track_outline){.corner = malloc((most + 1) * sizeof *outline->corner),
                                      .along = malloc((most + 2) * sizeof *outline->along)};
    int result = -1;
    if (points != NULL && line != NULL && outline->corner != NULL && outline->along != NULL) {
        uint32_t count = collect(world, model, joint, points);
        qsort(points, count, sizeof *points, by_x);
        outline->count = wrap(line, points, count);
        measure(outline, line);
        result = 0;
    }
    free(points);
    free(line);
    if (result != 0)
        track_outline_free(outline);
    return result;
}

void track_outline_free(struct track_outline *outline)
{
    free(outline->corner);
    free(outline->along);
    *outline = (struct track_outline){.corner = NULL};
}

float track_outline_along(const struct track_outline *outline, const float place[3], float near)
{
    double best = INFINITY, along = 0.0;
    if (!(outline->link_m > 0.0f))
        return 0.0f;
    for (uint32_t i = 0; i < outline->count; i++) {
        const float *a = outline->corner[i],
                    *b = outline->corner[i + 1 < outline->count ? i + 1 : 0];
        double ux = (double)b[0] - (double)a[0], uy = (double)b[1] - (double)a[1];
        double px = (double)place[0] - (double)a[0], py = (double)place[1] - (double)a[1];
        double length2 = ux * ux + uy * uy;
        double t = length2 > 0.0 ? maths_clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0.0;
        double dx = px - t * ux, dy = py - t * uy, off = dx * dx + dy * dy;
        if (off < best) {
            best = off;
            along = (double)outline->along[i] + t * sqrt(length2);
        }
    }
    double around = (double)outline->along[outline->count];
    double apart = along - (double)near * (double)outline->link_m;
    along -= around * floor(apart / around + 0.5);
    return (float)(along / (double)outline->link_m);
}
