/* Walls, windows and roofs over outlines. */
#include "config/mesh/outline_model.h"

#include "config/syntax/table.h"
#include "world/making/scenario.h"
#include "world/maths/maths.h"
#include "world/model.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define STOREY_M      3.0
#define WINDOW_APART  3.2 /* [m] along a wall, from middle to middle at least */
#define WINDOW_WIDE_M 1.2
#define WINDOW_HIGH_M 1.3
#define WINDOW_SILL_M 1.0  /* over the floor */
#define WINDOW_OUT_M  0.03 /* in front of the wall, which hides it otherwise */
#define WINDOWS_MAX   240u /* of a building */

/* Most triangles: two a wall, fewer than two a corner of roofs, two a window. */
#define QUADS_MAX (HULLS_A_MODEL * OUTLINE_CORNERS_MAX * 2u + WINDOWS_MAX)

struct colour {
    uint8_t red, green, blue, tint;
};

/* As adobe, tile, concrete and glass of config/models/palette.mtl. */
static const struct colour wall = {219, 199, 163, MODEL_TINT_WASH}, tiles = {163, 79, 51, 0},
                           flat_roof = {138, 132, 124, 0}, glass = {52, 62, 72, 0};

struct drawing {
    struct model_vertex vertex[4 * QUADS_MAX];
    struct model_triangle triangle[2 * QUADS_MAX];
    uint32_t vertices, triangles, windows;
};

static uint32_t put_vertex(struct drawing *d, double x, double y, double z)
{
    d->vertex[d->vertices] = (struct model_vertex){(float)x, (float)y, (float)z};
    return d->vertices++;
}

static void put_triangle(struct drawing *d, uint32_t a, uint32_t b, uint32_t c,
                         struct colour colour)
{
    d->triangle[d->triangles++] = (struct model_triangle){.vertex = {a, b, c},
                                                          .red = colour.red,
                                                          .green = colour.green,
                                                          .blue = colour.blue,
                                                          .force_tint = colour.tint,
                                                          .part = PART_BODY};
}

/* Puts an upright quad from (ax, az) to (bx, bz), which is clockwise as seen from above. */
static void put_upright(struct drawing *d, const double a[2], const double b[2], double low,
                        double high, struct colour colour)
{
    uint32_t first = put_vertex(d, a[0], low, a[1]);
    put_vertex(d, a[0], high, a[1]);
    put_vertex(d, b[0], high, b[1]);
    put_vertex(d, b[0], low, b[1]);
    put_triangle(d, first, first + 1, first + 2, colour);
    put_triangle(d, first, first + 2, first + 3, colour);
}

static void put_windows(struct drawing *d, const struct outline *outline, const double a[2],
                        const double b[2])
{
    double along[2] = {b[0] - a[0], b[1] - a[1]};
    double length = sqrt(along[0] * along[0] + along[1] * along[1]);
    uint32_t storeys = (uint32_t)((outline->eaves_m + 0.5) / STOREY_M);
    uint32_t columns = (uint32_t)(length / WINDOW_APART);
    if (storeys == 0 && outline->eaves_m > WINDOW_SILL_M + WINDOW_HIGH_M)
        storeys = 1;
    /* Outwards is to the left of a clockwise walk. */
    double out[2] = {along[1] / length * WINDOW_OUT_M, -along[0] / length * WINDOW_OUT_M};
    for (uint32_t i = 0; i < storeys * columns && d->windows < WINDOWS_MAX; i++, d->windows++) {
        double middle = (i % columns + 0.5) / columns, half = 0.5 * WINDOW_WIDE_M / length;
        double sill = i / columns * STOREY_M + WINDOW_SILL_M, from[2], to[2];
        for (int k = 0; k < 2; k++) {
            from[k] = a[k] + along[k] * (middle - half) + out[k];
            to[k] = a[k] + along[k] * (middle + half) + out[k];
        }
        put_upright(d, from, to, sill, sill + WINDOW_HIGH_M, glass);
    }
}

/* Returns true if another part has the same side the other way around: a wall inside. */
static bool is_inside(const struct outline *outline, uint32_t part, const double a[2],
                      const double b[2])
{
    for (uint32_t p = 0; p < outline->parts; p++) {
        const struct outline_part *other = &outline->part[p];
        for (uint32_t i = 0; i < other->corners && p != part; i++) {
            uint32_t next = i + 1 < other->corners ? i + 1 : 0;
            if (other->x[i] == b[0] && other->z[i] == b[1] && other->x[next] == a[0] &&
                other->z[next] == a[1])
                return true;
        }
    }
    return false;
}

static void put_walls(struct drawing *d, const struct outline *outline, uint32_t part, bool windows)
{
    const struct outline_part *p = &outline->part[part];
    for (uint32_t i = 0; i < p->corners; i++) {
        uint32_t next = i + 1 < p->corners ? i + 1 : 0;
        const double a[2] = {p->x[i], p->z[i]}, b[2] = {p->x[next], p->z[next]};
        if (is_inside(outline, part, a, b))
            continue;
        put_upright(d, a, b, outline->foot_m, outline->eaves_m, wall);
        if (windows)
            put_windows(d, outline, a, b);
    }
}

static double side_length(const struct outline_part *p, uint32_t i)
{
    uint32_t next = i + 1 < p->corners ? i + 1 : 0;
    double x = p->x[next] - p->x[i], z = p->z[next] - p->z[i];
    return sqrt(x * x + z * z);
}

/* Finds the ends of the ridge: over the middles of sides *gable and *gable + 2. */
static void find_ridge(const struct outline *outline, uint32_t *gable, struct vec3 ridge[2])
{
    const struct outline_part *p = &outline->part[0];
    *gable = side_length(p, 0) + side_length(p, 2) <= side_length(p, 1) + side_length(p, 3) ? 0 : 1;
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t i = *gable + 2 * k, next = (i + 1) % 4;
        ridge[k] = (struct vec3){0.5 * (p->x[i] + p->x[next]), outline->top_m,
                                 0.5 * (p->z[i] + p->z[next])};
    }
}

static bool has_ridge(const struct outline *outline)
{
    return outline->top_m > outline->eaves_m;
}

static void put_ridged_roof(struct drawing *d, const struct outline *outline)
{
    const struct outline_part *p = &outline->part[0];
    struct vec3 ridge[2];
    uint32_t gable, corner[4], end[2];
    find_ridge(outline, &gable, ridge);
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t a = (gable + 2 * k) % 4, b = (a + 1) % 4;
        uint32_t first = put_vertex(d, p->x[a], outline->eaves_m, p->z[a]);
        put_vertex(d, ridge[k].x, ridge[k].y, ridge[k].z);
        put_vertex(d, p->x[b], outline->eaves_m, p->z[b]);
        put_triangle(d, first, first + 1, first + 2, wall);
    }
    for (uint32_t i = 0; i < 4; i++)
        corner[i] = put_vertex(d, p->x[i], outline->eaves_m, p->z[i]);
    for (uint32_t k = 0; k < 2; k++)
        end[k] = put_vertex(d, ridge[k].x, ridge[k].y, ridge[k].z);
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t b = (gable + 2 * k + 1) % 4, c = (b + 1) % 4;
        put_triangle(d, corner[b], end[k], end[1 - k], tiles);
        put_triangle(d, corner[b], end[1 - k], corner[c], tiles);
    }
}

static void put_flat_roof(struct drawing *d, const struct outline *outline, uint32_t part)
{
    const struct outline_part *p = &outline->part[part];
    uint32_t first = d->vertices;
    for (uint32_t i = 0; i < p->corners; i++)
        put_vertex(d, p->x[i], outline->eaves_m, p->z[i]);
    for (uint32_t i = 1; i + 1 < p->corners; i++)
        put_triangle(d, first, first + i + 1, first + i, flat_roof);
}

static int take_drawing(struct scenario *scenario, const struct drawing *d, const char *name)
{
    void *models = scenario->models, *vertices = scenario->vertices,
         *triangles = scenario->triangles;
    struct model added = {.first_vertex = scenario->vertex_count,
                          .vertex_count = d->vertices,
                          .first_triangle = scenario->triangle_count,
                          .triangle_count = d->triangles};
    snprintf(added.name, sizeof(added.name), "%s", name);
    struct model *model = table_extend(&models, &scenario->model_count, 1, sizeof(*model));
    scenario->models = models;
    struct model_vertex *vertex =
        table_extend(&vertices, &scenario->vertex_count, d->vertices, sizeof(*vertex));
    scenario->vertices = vertices;
    struct model_triangle *triangle =
        table_extend(&triangles, &scenario->triangle_count, d->triangles, sizeof(*triangle));
    scenario->triangles = triangles;
    if (model == NULL || vertex == NULL || triangle == NULL) {
        errno = ENOMEM;
        return -1;
    }
    *model = added;
    memcpy(vertex, d->vertex, d->vertices * sizeof(*vertex));
    memcpy(triangle, d->triangle, d->triangles * sizeof(*triangle));
    return 0;
}

int outline_model_add(struct scenario *scenario, const struct outline *outline, const char *name,
                      bool windows)
{
    struct drawing *d = malloc(sizeof(*d));
    if (d == NULL)
        return -1;
    d->vertices = d->triangles = d->windows = 0;
    for (uint32_t part = 0; part < outline->parts; part++) {
        put_walls(d, outline, part, windows);
        if (!has_ridge(outline))
            put_flat_roof(d, outline, part);
    }
    if (has_ridge(outline))
        put_ridged_roof(d, outline);
    int result = take_drawing(scenario, d, name);
    free(d);
    return result;
}

int outline_model_hulls(struct hulls *hulls, struct scenario *scenario,
                        const struct outline *outline)
{
    struct vec3 point[HULLS_A_MODEL * OUTLINE_CORNERS_MAX * 2];
    uint32_t end[HULLS_A_MODEL], used = 0, gable;
    for (uint32_t part = 0; part < outline->parts; part++) {
        const struct outline_part *p = &outline->part[part];
        for (uint32_t i = 0; i < p->corners; i++) {
            point[used++] = (struct vec3){p->x[i], outline->foot_m, p->z[i]};
            point[used++] = (struct vec3){p->x[i], outline->eaves_m, p->z[i]};
        }
        if (has_ridge(outline)) {
            find_ridge(outline, &gable, &point[used]);
            used += 2;
        }
        end[part] = used;
    }
    return hulls_of_points(hulls, scenario, point, end, outline->parts);
}
