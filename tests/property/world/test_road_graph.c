/* Paths along roads: as short as those of an oracle that tries every path over every node, on
 * random graphs; and made of roads and junctions only. */
#include "world/making/road_graph.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define POINTS_MAX 64
#define NODES_MAX  1024

static struct road_point points[POINTS_MAX];
static double table[NODES_MAX][NODES_MAX];

static double apart(double ax, double az, double bx, double bz)
{
    return sqrt((ax - bx) * (ax - bx) + (az - bz) * (az - bz));
}

/* Roads of random bends on a small map, so that they cross, meet and miss each other. */
static uint32_t some_roads(uint64_t *seed)
{
    uint32_t count = 0, roads = 2 + (uint32_t)fixture_uniform(seed, 0.0, 5.0);
    for (uint32_t road = 0; road < roads; road++) {
        double x = fixture_uniform(seed, 0.0, 1500.0), z = fixture_uniform(seed, 0.0, 1500.0);
        double heading = fixture_uniform(seed, 0.0, TWO_PI);
        uint32_t length = 2 + (uint32_t)fixture_uniform(seed, 0.0, 8.0);
        for (uint32_t i = 0; i < length; i++) {
            double sine, cosine, metres = fixture_uniform(seed, 20.0, 200.0);
            points[count++] = (struct road_point){(float)x, (float)z, road, 0};
            heading += fixture_uniform(seed, -1.0, 1.0);
            maths_sincos(heading, &sine, &cosine);
            x += metres * sine;
            z -= metres * cosine;
        }
    }
    return count;
}

/* Nearest of many samples along the line a-b to (x, z). */
static double off_line(double ax, double az, double bx, double bz, double x, double z)
{
    double least = INFINITY;
    for (int i = 0; i <= 400; i++) {
        double t = (double)i / 400.0;
        least = fmin(least, apart(ax + (bx - ax) * t, az + (bz - az) * t, x, z));
    }
    return least;
}

static double off_roads(uint32_t count, double x, double z)
{
    double least = INFINITY;
    for (uint32_t i = 0; i + 1 < count; i++) {
        const struct road_point *a = &points[i], *b = a + 1;
        if (a->road == b->road)
            least =
                fmin(least, off_line((double)a->x, (double)a->z, (double)b->x, (double)b->z, x, z));
    }
    return least;
}

/* Distance between every two nodes, by trying each third node between. */
static void fill_table(const struct road_graph *net)
{
    uint32_t n = net->node_count;
    assert_true(n <= NODES_MAX);
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++)
            table[i][j] = i == j ? 0.0 : INFINITY;
        const struct road_node *node = &net->nodes[i];
        for (uint32_t e = 0; e < node->edge_count; e++) {
            const struct road_edge *edge = &net->edges[node->first_edge + e];
            table[i][edge->to] = fmin(table[i][edge->to], edge->length_m);
        }
    }
    for (uint32_t k = 0; k < n; k++) {
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t j = 0; j < n && table[i][k] < INFINITY; j++)
                table[i][j] = fmin(table[i][j], table[i][k] + table[k][j]);
        }
    }
}

/* From any place to any other: over either end of its segment, or along the segment of both. */
static double shortest(const struct road_graph *net, const struct road_place *a,
                       const struct road_place *b)
{
    uint32_t ends[2][2] = {{a->node, net->nodes[a->node].next},
                           {b->node, net->nodes[b->node].next}};
    double least = a->node == b->node ? apart(a->x, a->z, b->x, b->z) : INFINITY;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            const struct road_node *p = &net->nodes[ends[0][i]], *q = &net->nodes[ends[1][j]];
            least = fmin(least, apart(a->x, a->z, p->x, p->z) + table[ends[0][i]][ends[1][j]] +
                                    apart(b->x, b->z, q->x, q->z));
        }
    }
    return least;
}

static void check_way(const struct road_graph *net, uint32_t count, uint64_t *seed)
{
    struct road_place from, to;
    struct route_point *way = NULL;
    uint32_t length = 0;
    double metres = 0.0, sum = 0.0;
    assert_true(road_graph_place(net, fixture_uniform(seed, 0.0, 1500.0),
                                 fixture_uniform(seed, 0.0, 1500.0), &from));
    assert_true(road_graph_place(net, fixture_uniform(seed, 0.0, 1500.0),
                                 fixture_uniform(seed, 0.0, 1500.0), &to));
    double wanted = shortest(net, &from, &to);
    if (road_graph_way(net, &from, &to, &way, &length, &metres) != 0) {
        assert_true(isinf(wanted));
        return;
    }
    if (!(fabs(metres - wanted) < 1e-6))
        fail_msg("a way of %.6f m, the shortest has %.6f", metres, wanted);
    assert_true(way[0].x == from.x && way[0].z == from.z);
    assert_true(way[length - 1].x == to.x && way[length - 1].z == to.z);
    for (uint32_t i = 0; i + 1 < length; i++) {
        double mid_x = 0.5 * (way[i].x + way[i + 1].x), mid_z = 0.5 * (way[i].z + way[i + 1].z);
        sum += apart(way[i].x, way[i].z, way[i + 1].x, way[i + 1].z);
        if (!(off_roads(count, mid_x, mid_z) <= 0.5 * ROAD_GRAPH_END_M + 1.0))
            fail_msg("the way leaves the roads at (%.1f, %.1f)", mid_x, mid_z);
    }
    assert_true(fabs(sum - metres) < 1e-6);
    free(way);
}

/* Two stretches that cross: from one road to the other it is no farther than over the crossing. */
static void check_crossings(const struct road_graph *net, uint32_t count)
{
    for (uint32_t i = 0; i + 1 < count; i++) {
        for (uint32_t j = i + 2; j + 1 < count; j++) {
            const struct road_point *a = &points[i], *b = &points[j];
            if (a[0].road != a[1].road || b[0].road != b[1].road)
                continue;
            /* By sides: each stretch has the other's ends on both sides of its line. */
            double sides[4];
            for (int k = 0; k < 4; k++) {
                const struct road_point *line = k < 2 ? a : b, *p = k < 2 ? &b[k] : &a[k - 2];
                sides[k] = (double)(line[1].x - line[0].x) * (double)(p->z - line[0].z) -
                           (double)(line[1].z - line[0].z) * (double)(p->x - line[0].x);
            }
            if (!(sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0))
                continue;
            double t = sides[2] / (sides[2] - sides[3]);
            double x = (double)a[0].x + t * (double)(a[1].x - a[0].x);
            double z = (double)a[0].z + t * (double)(a[1].z - a[0].z);
            struct road_place from, to;
            assert_true(road_graph_place(net, (double)a[0].x, (double)a[0].z, &from));
            assert_true(road_graph_place(net, (double)b[1].x, (double)b[1].z, &to));
            double over = apart((double)a[0].x, (double)a[0].z, x, z) +
                          apart(x, z, (double)b[1].x, (double)b[1].z);
            if (!(shortest(net, &from, &to) <= over + 1e-2))
                fail_msg("no crossing at (%.1f, %.1f)", x, z);
        }
    }
}

static void test_ways_are_the_shortest(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(16);
    for (int round = 0; round < 60; round++) {
        struct road_graph net;
        uint32_t count = some_roads(&seed);
        assert_int_equal(road_graph_build(&net, points, count, WORLD_SIDE_DEFAULT_M), 0);
        fill_table(&net);
        check_crossings(&net, count);
        for (int i = 0; i < 20; i++)
            check_way(&net, count, &seed);
        road_graph_free(&net);
    }
}

/* The place on the roads nearest to a point is as near as any sample of them. */
static void test_places_are_the_nearest(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(17);
    for (int round = 0; round < 40; round++) {
        struct road_graph net;
        uint32_t count = some_roads(&seed);
        assert_int_equal(road_graph_build(&net, points, count, WORLD_SIDE_DEFAULT_M), 0);
        for (int i = 0; i < 20; i++) {
            double x = fixture_uniform(&seed, -200.0, 1700.0);
            double z = fixture_uniform(&seed, -200.0, 1700.0);
            struct road_place place;
            assert_true(road_graph_place(&net, x, z, &place));
            double sampled = off_roads(count, x, z);
            assert_true(place.off_m <= sampled + 1e-9 && place.off_m > sampled - 0.5);
            assert_true(fabs(apart(x, z, place.x, place.z) - place.off_m) < 1e-9);
        }
        road_graph_free(&net);
    }
}

static uint32_t put(uint32_t count, double x, double z, uint32_t road)
{
    points[count] = (struct road_point){(float)x, (float)z, road, 0};
    return count + 1;
}

/* Distance from (0, 0) to a point of a graph of two roads; -1 for none. */
static double way_to(uint32_t count, double x, double z)
{
    struct road_graph net;
    struct road_place from, to;
    struct route_point *way = NULL;
    uint32_t length;
    double metres = -1.0;
    assert_int_equal(road_graph_build(&net, points, count, WORLD_SIDE_DEFAULT_M), 0);
    assert_true(road_graph_place(&net, 0.0, 0.0, &from) && road_graph_place(&net, x, z, &to));
    if (road_graph_way(&net, &from, &to, &way, &length, &metres) != 0)
        metres = -1.0;
    free(way);
    road_graph_free(&net);
    return metres;
}

static void test_roads_meet_where_they_should(void **state)
{
    (void)state;
    /* A crossing amid both stretches. */
    uint32_t n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), 300, -400, 1), 300, 400, 1);
    assert_true(fabs(way_to(n, 300, 400) - 700.0) < 1e-9);
    /* An end just on the road, near it, and too far from it. */
    n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), 300, 0, 1), 300, 400, 1);
    assert_true(fabs(way_to(n, 300, 400) - 700.0) < 1e-9);
    n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), 300, 100, 1), 300, 400, 1);
    assert_true(fabs(way_to(n, 300, 400) - 700.0) < 1e-9);
    n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), 300, 101, 1), 300, 400, 1);
    assert_true(way_to(n, 300, 400) == -1.0);
    /* Side by side, 9 m and 11 m apart: one road to change over from, and two. */
    n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), -500, 9, 1), 1100, 9, 1);
    assert_true(way_to(n, 1100, 9) > 0.0);
    n = put(put(put(put(0, 0, 0, 0), 600, 0, 0), 200, 250, 1), 200, 11, 1);
    n = put(n, 201, 250, 1);
    assert_true(way_to(n, 201, 250) == -1.0);
}

static void test_no_roads_have_no_place(void **state)
{
    (void)state;
    struct road_graph net;
    struct road_place place;
    assert_int_equal(road_graph_build(&net, points, 0, WORLD_SIDE_DEFAULT_M), 0);
    assert_false(road_graph_place(&net, 1.0, 1.0, &place));
    road_graph_free(&net);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ways_are_the_shortest),
        cmocka_unit_test(test_places_are_the_nearest),
        cmocka_unit_test(test_roads_meet_where_they_should),
        cmocka_unit_test(test_no_roads_have_no_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
