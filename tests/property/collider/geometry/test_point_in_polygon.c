/* Haines's crossings (rows 22, 48) against winding numbers in whole numbers, and on tilings, where
 * each point must be in exactly one tile. SEED=n runs another set. */
#include "collider/geometry/point_in_polygon.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define POLYGONS     20000
#define POINTS       50 /* of each: 10^6 */
#define CORNERS_MAX  16
#define TILINGS      200
#define SIDE         32
#define TILES_MAX    128
#define SPLITS       60
#define ROUGH_POINTS 20000

struct grid_point {
    int64_t u, v;
};

static int64_t whole(uint64_t *random, int64_t low, int64_t high)
{
    return low + (int64_t)(fixture_random(random) % (uint64_t)(high - low + 1));
}

/* > 0: p is left of the line from a to b. */
static int64_t left_of(struct grid_point a, struct grid_point b, struct grid_point p)
{
    return (b.u - a.u) * (p.v - a.v) - (p.u - a.u) * (b.v - a.v);
}

/* The plane of a polygon: which coordinate is left out, and how it depends on the others. Its
 * slopes are below 1, so that it is the dominant one. */
struct plane {
    int axis;
    double slope_u, slope_v, height;
    struct vec3 normal;
};

static struct vec3 axes(int axis, double u, double v, double w)
{
    return axis == 0   ? (struct vec3){w, u, v}
           : axis == 1 ? (struct vec3){v, w, u}
                       : (struct vec3){u, v, w};
}

static struct plane draw_plane(uint64_t *random)
{
    struct plane p = {.axis = (int)(fixture_random(random) % 3),
                      .slope_u = fixture_uniform(random, -0.99, 0.99),
                      .slope_v = fixture_uniform(random, -0.99, 0.99),
                      .height = fixture_uniform(random, -100.0, 100.0)};
    p.normal = axes(p.axis, -p.slope_u, -p.slope_v, 1.0);
    if (fixture_random(random) & 1)
        p.normal = vec3_scale(p.normal, -1.0);
    return p;
}

static struct vec3 lift(const struct plane *plane, struct grid_point p)
{
    double u = (double)p.u, v = (double)p.v;
    return axes(plane->axis, u, v, plane->height + plane->slope_u * u + plane->slope_v * v);
}

/* --- winding numbers ---------------------------------------------------------------------------*/

/* How often the polygon winds about the point; *on: it goes through it. */
static int winding(const struct grid_point *corner, uint32_t count, struct grid_point p, bool *on)
{
    int turns = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct grid_point a = corner[i], b = corner[(i + 1) % count];
        int64_t left = left_of(a, b, p);
        if (a.v <= p.v && b.v > p.v && left > 0)
            turns++;
        if (a.v > p.v && b.v <= p.v && left < 0)
            turns--;
        if (left == 0 && (a.u - p.u) * (b.u - p.u) <= 0 && (a.v - p.v) * (b.v - p.v) <= 0)
            *on = true;
    }
    return turns;
}

/* Corners all round the origin, near and far: any shape without crossings, convex or not. */
static uint32_t draw_polygon(struct grid_point *corner, uint64_t *random)
{
    uint32_t count = 3 + (uint32_t)(fixture_random(random) % (CORNERS_MAX - 2));
    double start = fixture_uniform(random, 0.0, TWO_PI);
    double size = (double)whole(random, 0, 1) ? 20.0 : 1e6;
    for (uint32_t i = 0; i < count; i++) {
        double sine, cosine, reach = fixture_uniform(random, 0.1, 1.0) * size;
        maths_sincos(start + TWO_PI * i / count, &sine, &cosine);
        corner[i] = (struct grid_point){(int64_t)(reach * cosine), (int64_t)(reach * sine)};
    }
    return count;
}

static void test_row_22_it_agrees_with_the_winding_number(void **state)
{
    uint64_t random = fixture_seed(22);
    struct grid_point corner[CORNERS_MAX];
    struct vec3 lifted[CORNERS_MAX];
    uint32_t inside = 0, on_border = 0;
    (void)state;
    for (int n = 0; n < POLYGONS; n++) {
        uint32_t count = draw_polygon(corner, &random);
        struct plane plane = draw_plane(&random);
        for (uint32_t i = 0; i < count; i++)
            lifted[i] = lift(&plane, corner[i]);
        for (int k = 0; k < POINTS; k++) {
            struct grid_point at = corner[fixture_random(&random) % count];
            int64_t reach = 2 + (at.u < 0 ? -at.u : at.u) + (at.v < 0 ? -at.v : at.v);
            struct grid_point p = {whole(&random, -reach, reach), whole(&random, -reach, reach)};
            if (k % 4 == 0) /* level with a corner: the axis goes through it */
                p.v = at.v;
            bool on = false;
            int turns = winding(corner, count, p, &on);
            on_border += on;
            if (on)
                continue;
            inside += turns & 1;
            if (point_in_polygon_inside(lifted, count, plane.normal, lift(&plane, p)) !=
                (turns & 1))
                fail_msg("polygon %d, point %d: winds %d times", n, k, turns);
        }
    }
    assert_in_range(inside, POLYGONS * POINTS / 10, POLYGONS * POINTS / 2);
    assert_in_range(on_border, 1000, POLYGONS * POINTS / 10);
}

/* --- tilings -----------------------------------------------------------------------------------*/

struct tiling {
    struct grid_point tile[TILES_MAX][3];
    uint32_t count;
};

static bool strictly_in(const struct grid_point tile[3], struct grid_point p)
{
    return left_of(tile[0], tile[1], p) > 0 && left_of(tile[1], tile[2], p) > 0 &&
           left_of(tile[2], tile[0], p) > 0;
}

/* A square in two triangles, split again and again at grid points. */
static void draw_tiling(struct tiling *t, uint64_t *random)
{
    const struct grid_point a = {0, 0}, b = {SIDE, 0}, c = {SIDE, SIDE}, d = {0, SIDE};
    *t = (struct tiling){.tile = {{a, b, c}, {c, d, a}}, .count = 2};
    for (int n = 0; n < SPLITS; n++) {
        struct grid_point p = {whole(random, 1, SIDE - 1), whole(random, 1, SIDE - 1)};
        for (uint32_t i = 0; i < t->count; i++) {
            struct grid_point *tile = t->tile[i];
            if (!strictly_in(tile, p))
                continue;
            struct grid_point last = tile[2];
            t->tile[t->count][0] = tile[1], t->tile[t->count][1] = last, t->tile[t->count][2] = p;
            t->tile[t->count + 1][0] = last, t->tile[t->count + 1][1] = tile[0];
            t->tile[t->count + 1][2] = p;
            tile[2] = p;
            t->count += 2;
            break;
        }
    }
}

static uint32_t tiles_with(const struct tiling *t, const struct plane *plane, struct vec3 p)
{
    uint32_t with = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        struct vec3 corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = lift(plane, t->tile[i][k]);
        with += point_in_polygon_inside(corner, 3, plane->normal, p);
    }
    return with;
}

/* Every grid point of the square: corners of tiles, points on their edges, and the rest. */
static void test_row_22_each_point_of_a_tiling_is_in_exactly_one_tile(void **state)
{
    uint64_t random = fixture_seed(23), on_edges = 0;
    struct tiling t;
    (void)state;
    for (int n = 0; n < TILINGS; n++) {
        struct plane plane = draw_plane(&random);
        draw_tiling(&t, &random);
        for (int64_t u = 1; u < SIDE; u++) {
            for (int64_t v = 1; v < SIDE; v++) {
                uint32_t with = tiles_with(&t, &plane, lift(&plane, (struct grid_point){u, v}));
                if (with != 1)
                    fail_msg("tiling %d: (%d, %d) is in %u tiles", n, (int)u, (int)v, with);
                uint32_t strictly = 0;
                for (uint32_t i = 0; i < t.count; i++)
                    strictly += strictly_in(t.tile[i], (struct grid_point){u, v});
                on_edges += strictly == 0;
            }
        }
    }
    assert_true(on_edges > 100 * TILINGS);
}

/* Points on edges that no double can hold exactly: rounding puts them to one side, and both tiles
 * must say the same. */
static void test_row_22_rounded_points_on_edges_are_in_exactly_one_tile(void **state)
{
    uint64_t random = fixture_seed(24);
    struct tiling t;
    (void)state;
    draw_tiling(&t, &random);
    for (int n = 0; n < ROUGH_POINTS; n++) {
        if (n % 1000 == 0)
            draw_tiling(&t, &random);
        struct plane plane = draw_plane(&random);
        const struct grid_point *tile = t.tile[2 + fixture_random(&random) % (t.count - 2)];
        struct vec3 on = vec3_lerp(lift(&plane, tile[1]), lift(&plane, tile[2]),
                                   fixture_uniform(&random, 0.0, 1.0));
        assert_int_equal(tiles_with(&t, &plane, on), 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_22_it_agrees_with_the_winding_number),
        cmocka_unit_test(test_row_22_each_point_of_a_tiling_is_in_exactly_one_tile),
        cmocka_unit_test(test_row_22_rounded_points_on_edges_are_in_exactly_one_tile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
