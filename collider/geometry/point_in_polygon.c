/* Figure 6 of Osborne 1991, step by step, with two corrections.
 *
 * The figure as printed counts every edge with a positive U'. Haines's own text counts an edge only
 * if it crosses the U' axis at all, "if SH is not equal to NSH"; without this test no polygon
 * works. The other correction is about rounding: the quotient of an edge read from its other end
 * may differ in the last bit, so that a point on an edge could be in both polygons that share it,
 * or in none. Here each edge is read from its end below the axis. There V'b - V'a > 0, and the test
 * U'a - V'a (U'b - U'a) / (V'b - V'a) > 0 is done without a division, so it is exact on grids. */
#include "collider/geometry/point_in_polygon.h"

struct uv {
    double u, v;
};

/* Drops the dominant coordinate. */
static struct uv project(struct vec3 p, struct vec3 normal)
{
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    if (x >= y && x >= z)
        return (struct uv){p.y, p.z};
    return y >= z ? (struct uv){p.z, p.x} : (struct uv){p.x, p.y};
}

/* The sign holder: V' = 0 counts as positive. */
static int sign(double v)
{
    return v < 0.0 ? -1 : 1;
}

/* Returns true if the edge, which crosses the U' axis, crosses its positive half. */
static bool crosses(struct uv a, struct uv b)
{
    if (a.u > 0.0 && b.u > 0.0)
        return true;
    if (!(a.u > 0.0 || b.u > 0.0))
        return false;
    struct uv low = a.v < b.v ? a : b, high = a.v < b.v ? b : a;
    return low.u * (high.v - low.v) - low.v * (high.u - low.u) > 0.0;
}

bool point_in_polygon_inside(const struct vec3 *corner, uint32_t count, struct vec3 normal,
                             struct vec3 point)
{
    struct vec3 first = vec3_sub(corner[0], point);
    struct uv a = project(first, normal);
    int sh = sign(a.v);
    bool inside = false;
    for (uint32_t i = 1; i <= count; i++) {
        struct uv b = project(vec3_sub(corner[i < count ? i : 0], point), normal);
        int nsh = sign(b.v);
        if (sh != nsh && crosses(a, b))
            inside = !inside;
        sh = nsh;
        a = b;
    }
    return inside;
}
