/* Swept spheres by the quadratic, swept points against triangles by their edges. */
#include "collider/sweep.h"

#include "world/square.h"

#include <stdint.h>

#define CRATER_STEP_M 0.5 /* finer than any crater is wide */
#define BISECTIONS    24

bool sweep_spheres(const struct path *a, const struct path *b, double reach, double from,
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
    /* The smaller root in the form that loses no digits: gap over the sum of two positives. */
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

static bool craters_near(const struct crater_index *craters, struct vec3 p, struct vec3 q)
{
    if (!craters || craters->count == 0)
        return false;
    struct square_box box = square_box_of(maths_min(p.x, q.x), maths_min(p.z, q.z),
                                          maths_max(p.x, q.x), maths_max(p.z, q.z));
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            if (craters->head[square_index(column, row)] != 0)
                return true;
        }
    }
    return false;
}

/* Next time after now at which value + rate * t crosses a multiple of spacing. */
static double next_line(double value, double rate, double spacing, double now)
{
    if (rate == 0.0)
        return 2.0;
    double cells = (value + rate * now) / spacing;
    double line = rate > 0.0 ? floor(cells) + 1.0 : -(floor(-cells) + 1.0);
    double time = (line * spacing - value) / rate;
    return time > now ? time : now + 1e-9;
}

/* Next edge of the terrain's triangles after now: grid lines in x and z, diagonals in x - z. */
static double next_edge(const struct terrain *terrain, const struct path *path, double now)
{
    double local = now - path->since;
    double x = next_line(path->at.x, path->along.x, terrain->spacing_m, local);
    double z = next_line(path->at.z, path->along.z, terrain->spacing_m, local);
    double d = next_line(path->at.x - path->at.z, path->along.x - path->along.z, terrain->spacing_m,
                         local);
    return path->since + maths_min(x, maths_min(z, d));
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

bool sweep_ground(const struct terrain *terrain, const struct crater_index *craters,
                  const struct path *path, double *toi)
{
    double now = path->since;
    double here = clearance(terrain, craters, path, now);
    bool cratered = craters_near(craters, path->at, path_at(path, 1.0));
    double crater_step = CRATER_STEP_M / maths_max(vec3_length(path->along), CRATER_STEP_M);
    if (here < 0.0) {
        *toi = now;
        return true;
    }
    while (now < 1.0) {
        double next = next_edge(terrain, path, now);
        if (cratered)
            next = maths_min(next, now + crater_step);
        next = maths_min(next, 1.0);
        double there = clearance(terrain, craters, path, next);
        if (there < 0.0) {
            /* Between edges the clearance is a straight line; on craters it is not. */
            *toi = cratered ? bisect(terrain, craters, path, now, next)
                            : now + (next - now) * here / (here - there);
            return true;
        }
        now = next;
        here = there;
    }
    return false;
}
