/* Swept spheres by the quadratic equation, swept points against the terrain's triangles edge by
 * edge. */
#include "collider/geometry/analytic_impact.h"

#include "world/terrain/gridsquare.h"

#include <stdint.h>

#define UNEVEN_STEP_M 0.5 /* finer than the width of any crater, and of most works */
#define BISECTIONS    24

bool analytic_impact_spheres(const struct path *a, const struct path *b, double reach, double from,
                             double *toi)
{
    struct vec3 s = vec3_sub(path_at(b, from), path_at(a, from));
    struct vec3 w = vec3_sub(b->along, a->along);
    double nearing = vec3_dot(s, w);
    if (!(nearing < 0.0))
        return false;
    double gap = vec3_dot(s, s) - reach * reach;
    if (gap <= 0.0) {
        *toi = from;
        return true;
    }
    double discriminant = nearing * nearing - vec3_dot(w, w) * gap;
    if (discriminant < 0.0)
        return false;
    /* The smaller root in the form without cancellation: gap over the sum of two positive
     * numbers. */
    double time = from + gap / (sqrt(discriminant) - nearing);
    if (time > 1.0)
        return false;
    *toi = time;
    return true;
}

static double clearance(const struct terrain *terrain, const struct crater_index *craters,
                        const struct path *path, double time)
{
    struct vec3 p = path_at(path, time);
    return p.y - terrain_height(terrain, craters, p.x, p.z);
}

/* Returns true if craters or earthworks may be under the path. */
static bool uneven_near(const struct terrain *terrain, const struct crater_index *craters,
                        struct vec3 p, struct vec3 q)
{
    bool cratered = craters && craters->count > 0;
    double highest, lowest;
    if (!cratered && terrain->earthworks.count == 0)
        return false;
    struct gridsquare_box box =
        gridsquare_box_of(&terrain->squares, maths_min(p.x, q.x), maths_min(p.z, q.z),
                          maths_max(p.x, q.x), maths_max(p.z, q.z));
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            if (cratered && craters->head[gridsquare_index(&terrain->squares, column, row)] != 0)
                return true;
        }
    }
    return earthwork_range(&terrain->earthworks, &box, &highest, &lowest);
}

/* Lines that a straight path crosses one after the other: value + rate * t = line * spacing. */
struct lines {
    double value, rate, spacing;
    double line, step; /* the next line, and +1 or -1 to the line after it */
};

static struct lines lines_along(double value, double rate, double spacing)
{
    double cells = value / spacing;
    double line = rate > 0.0 ? floor(cells) + 1.0 : -floor(-cells) - 1.0;
    return (struct lines){value, rate, spacing, line, rate > 0.0 ? 1.0 : -1.0};
}

/* Time of the next crossing; INFINITY if the path runs along the lines. */
static double lines_next(const struct lines *lines)
{
    return lines->rate != 0.0 ? (lines->line * lines->spacing - lines->value) / lines->rate
                              : INFINITY;
}

/* The edges of the terrain's triangles: grid lines in x and in z, diagonals in x - z. */
struct edges {
    struct lines lines[3];
};

static struct edges edges_along(const struct terrain *terrain, const struct path *path)
{
    double spacing = terrain->spacing_m;
    return (struct edges){{
        lines_along(path->at.x, path->along.x, spacing),
        lines_along(path->at.z, path->along.z, spacing),
        lines_along(path->at.x - path->at.z, path->along.x - path->along.z, spacing),
    }};
}

/* Advances past the next edge and returns when, since its start, the path crosses it. */
static double edges_cross(struct edges *edges)
{
    double time = lines_next(&edges->lines[0]);
    for (int i = 1; i < 3; i++)
        time = maths_min(time, lines_next(&edges->lines[i]));
    for (int i = 0; i < 3; i++) {
        if (lines_next(&edges->lines[i]) <= time)
            edges->lines[i].line += edges->lines[i].step;
    }
    return time;
}

static double bisect(const struct terrain *terrain, const struct crater_index *craters,
                     const struct path *path, double above, double below)
{
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = 0.5 * (above + below);
        if (clearance(terrain, craters, path, middle) < 0.0)
            below = middle;
        else
            above = middle;
    }
    return below;
}

bool analytic_impact_ground(const struct terrain *terrain, const struct crater_index *craters,
                            const struct path *path, double *toi)
{
    double now = path->since;
    double here = clearance(terrain, craters, path, now);
    bool uneven = uneven_near(terrain, craters, path->at, path_at(path, 1.0));
    double uneven_step = UNEVEN_STEP_M / maths_max(vec3_length(path->along), UNEVEN_STEP_M);
    struct edges edges = edges_along(terrain, path);
    double edge = path->since + edges_cross(&edges);
    if (here < 0.0) {
        *toi = now;
        return true;
    }
    while (now < 1.0) {
        double next = maths_min(edge, 1.0);
        if (uneven)
            next = maths_min(next, now + uneven_step);
        if (next >= edge)
            edge = path->since + edges_cross(&edges);
        double there = clearance(terrain, craters, path, next);
        if (there < 0.0) {
            /* Between edges the clearance is linear in time, except on craters and
             * earthworks. */
            *toi = uneven ? bisect(terrain, craters, path, now, next)
                          : now + (next - now) * here / (here - there);
            return true;
        }
        now = next;
        here = there;
    }
    return false;
}
