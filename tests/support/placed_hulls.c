/* Vertices turned about the pivots of gun and turret, and then with the body. */
#include "tests/support/placed_hulls.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct vec3 turned(struct vec3 p, struct vec3 pivot, double angle)
{
    double x = p.x - pivot.x, z = p.z - pivot.z;
    return (struct vec3){pivot.x + x * cos(angle) - z * sin(angle), p.y,
                         pivot.z + z * cos(angle) + x * sin(angle)};
}

static struct vec3 raised(struct vec3 p, struct vec3 pivot, double angle)
{
    double x = p.x - pivot.x, y = p.y - pivot.y;
    return (struct vec3){pivot.x + x * cos(angle) - y * sin(angle),
                         pivot.y + y * cos(angle) + x * sin(angle), p.z};
}

static struct vec3 part_point(const struct turret_path *path, uint32_t part, struct vec3 p,
                              double time)
{
    if (part == HULL_PART_GUN)
        p = raised(p, path->gun_pivot, path->gun + path->gun_turn * time);
    if (part != HULL_PART_BODY)
        p = turned(p, path->turret_pivot, path->turret + path->turret_turn * time);
    return p;
}

void placed_hulls_put(const struct swept_body *body, double time, struct vec3 near,
                      struct placed_hulls *to)
{
    struct mat3 turn = rotation_matrix(rotation_between(body->from, body->to, time));
    struct vec3 at = vec3_sub(path_at(&body->path, time), near);
    uint32_t used = 0;
    to->hulls = body->hull_count;
    for (uint32_t h = 0; h < body->hull_count; h++) {
        const struct hull *hull = &body->hull[h];
        assert_true(used + hull->vertex_count <= PLACED_HULLS_VERTICES);
        to->hull[h] = (struct convex){.vertex = &to->vertex[used],
                                      .count = hull->vertex_count,
                                      .scale = 1.0,
                                      .turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        for (uint32_t v = 0; v < hull->vertex_count; v++) {
            struct vec3 p = body->vertices[hull->first_vertex + v];
            p = part_point(&body->turret, hull->part, p, time);
            to->vertex[used++] = vec3_add(at, rotation_apply(&turn, p));
        }
    }
}
