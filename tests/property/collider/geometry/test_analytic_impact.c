/* Times of impact against slow oracles: bisection on the distance of spheres, fine sampling of the
 * ground. SEED=n runs another set. */
#include "collider/geometry/analytic_impact.h"

#include "tests/support/fixture.h"
#include "tests/support/works.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <unistd.h>

#include <cmocka.h>

/* --- spheres -----------------------------------------------------------------------------------*/

#define PAIRS 100000

enum sort {
    GENERIC,
    OVERLAPPING,
    TOUCHING,
    GRAZING,
    PARALLEL,
    STILL,
    HUGE_REACH,
    TINY_REACH,
    SORTS
};

struct trial {
    struct path a, b;
    double reach, from;
};

static struct vec3 across(struct vec3 along, uint64_t *random)
{
    struct vec3 v = fixture_direction(random);
    v = vec3_sub(v, vec3_scale(along, vec3_dot(v, along)));
    double length = vec3_length(v);
    return length > 1e-3 ? vec3_scale(v, 1.0 / length) : across(along, random);
}

/* Two paths of which b is at `gap` from a along a random direction, at time 0. */
static struct trial draw(enum sort sort, uint64_t *random)
{
    struct vec3 to = fixture_direction(random);
    double reach = fixture_uniform(random, 0.2, 40.0);
    double speed = fixture_uniform(random, 0.0, 300.0);
    double gap = fixture_uniform(random, 0.0, 300.0);
    struct trial t = {.reach = reach};
    t.a.at = (struct vec3){fixture_uniform(random, 0, 50000), fixture_uniform(random, 0, 2000),
                           fixture_uniform(random, 0, 50000)};
    t.a.along = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, 300.0));
    t.b.along = vec3_scale(fixture_direction(random), speed);
    switch (sort) {
    case OVERLAPPING:
        gap = reach * fixture_uniform(random, 0.0, 1.0);
        break;
    case TOUCHING:
        gap = reach;
        break;
    case PARALLEL:
        t.b.along = vec3_scale(t.a.along, fixture_uniform(random, -2.0, 2.0));
        break;
    case STILL:
        t.b.along = t.a.along;
        break;
    case HUGE_REACH:
        t.reach = fixture_uniform(random, 200.0, 1000.0);
        gap = t.reach + fixture_uniform(random, -50.0, 300.0);
        break;
    case TINY_REACH:
        t.reach = fixture_uniform(random, 0.01, 0.1);
        break;
    default:
        break;
    }
    t.b.at = vec3_add(t.a.at, vec3_scale(to, gap));
    if (sort == GRAZING || sort == TINY_REACH || sort == GENERIC) { /* aimed to pass by near */
        struct vec3 on = fixture_direction(random);
        double beside = sort == GRAZING ? t.reach * (1.0 + fixture_uniform(random, -1e-6, 1e-6))
                                        : t.reach * fixture_uniform(random, 0.0, 1.3);
        double before = fixture_uniform(random, 0.0, 300.0);
        t.b.at = vec3_add(vec3_add(t.a.at, vec3_scale(on, before)),
                          vec3_scale(across(on, random), beside));
        t.b.along = vec3_sub(t.a.along, vec3_scale(on, fixture_uniform(random, 1.0, 600.0)));
    }
    if (fixture_random(random) & 1) { /* b's path began later in the frame, and a's before it */
        t.b.since = fixture_uniform(random, 0.0, 0.5);
        t.a.at = vec3_add(t.a.at, vec3_scale(t.a.along, t.b.since));
        t.a.since = t.b.since;
        t.from = t.b.since;
    }
    return t;
}

static double distance(const struct trial *t, double time)
{
    return vec3_length(vec3_sub(path_at(&t->b, time), path_at(&t->a, time)));
}

/* The distance falls to one lowest point and rises again. */
static double nearest_time(const struct trial *t)
{
    double low = t->from, high = 1.0;
    for (int i = 0; i < 200; i++) {
        double p = low + (high - low) / 3.0, q = high - (high - low) / 3.0;
        if (distance(t, p) <= distance(t, q))
            high = q;
        else
            low = p;
    }
    return 0.5 * (low + high);
}

/* Finds the first contact by bisection, -1 for none; nearest is the least distance. */
static double oracle(const struct trial *t, double nearest_at)
{
    double low = t->from, high = nearest_at;
    if (distance(t, low) <= t->reach)
        return low;
    for (int i = 0; i < 100; i++) {
        double middle = 0.5 * (low + high);
        if (distance(t, middle) <= t->reach)
            high = middle;
        else
            low = middle;
    }
    return high;
}

static bool agrees(const struct trial *t, bool hit, double toi)
{
    /* Rounding of coordinates up to 50 km. For a grazing contact the time is as accurate as the
     * root. */
    const double slack = 1e-9;
    struct vec3 s = vec3_sub(path_at(&t->b, t->from), path_at(&t->a, t->from));
    struct vec3 w = vec3_sub(t->b.along, t->a.along);
    double nearest_at = nearest_time(t), nearest = distance(t, nearest_at);
    if (vec3_dot(s, w) >= 0.0) /* parting: no contact at any distance */
        return !hit;
    if (!hit)
        return nearest > t->reach - slack;
    if (toi < t->from || toi > 1.0 || nearest > t->reach + slack)
        return false;
    if (distance(t, t->from) <= t->reach)
        return toi - t->from <= slack;
    if (t->reach - nearest < 1e-4)
        return fabs(distance(t, toi) - t->reach) <= slack && toi <= nearest_at + 1e-6;
    return fabs(toi - oracle(t, nearest_at)) <= slack;
}

static void test_spheres_touch_when_bisection_says(void **state)
{
    uint64_t random = fixture_seed(23), hits[SORTS] = {0};
    (void)state;
    for (int n = 0; n < PAIRS; n++) {
        enum sort sort = (enum sort)(n % SORTS);
        struct trial t = draw(sort, &random);
        double toi = -1.0;
        bool hit = analytic_impact_spheres(&t.a, &t.b, t.reach, t.from, &toi);
        hits[sort] += hit;
        if (!agrees(&t, hit, toi))
            fail_msg("pair %d of sort %d: %s at %.17g, oracle %.17g, nearest %.17g, reach %.17g", n,
                     (int)sort, hit ? "touch" : "no touch", toi, oracle(&t, nearest_time(&t)),
                     distance(&t, nearest_time(&t)), t.reach);
    }
    for (int sort = 0; sort < SORTS; sort++) /* each sort has both answers, but the still ones */
        assert_in_range(hits[sort], sort == STILL ? 0 : 100,
                        sort == STILL ? 0 : PAIRS / SORTS - 100);
}

/* --- the ground --------------------------------------------------------------------------------*/

#define SIDE    41
#define SPACING 125.0
#define PATHS   2000
#define SAMPLES 3000
#define HANG_S  30

struct ground {
    struct terrain terrain;
    struct crater_index craters;
    struct crater list[400];
    float posts[SIDE * SIDE];
    uint8_t cover[SIDE * SIDE];
};

/* Steep, sharp ground: what a step that is too long would tunnel through. */
static void raise_ground(struct ground *g, uint64_t *random)
{
    for (int i = 0; i < SIDE * SIDE; i++)
        g->posts[i] = (float)(fixture_random(random) % 4 == 0 ? fixture_uniform(random, 60, 120)
                                                              : fixture_uniform(random, 0, 20));
    g->terrain = (struct terrain){.posts = g->posts,
                                  .cover = g->cover,
                                  .side = SIDE,
                                  .spacing_m = SPACING,
                                  .squares = GRIDSQUARES_DEFAULT_INIT};
}

static void dig_ground(struct ground *g, uint64_t *random)
{
    for (int i = 0; i < 400; i++)
        g->list[i] = (struct crater){fixture_uniform(random, 0, (SIDE - 1) * SPACING),
                                     fixture_uniform(random, 0, (SIDE - 1) * SPACING),
                                     (float)fixture_uniform(random, 2, 6),
                                     (float)fixture_uniform(random, 0.5, 2), 1};
    assert_int_equal(crater_index_init(&g->craters, &GRIDSQUARES_DEFAULT, g->list), 0);
    crater_index_update(&g->craters, 400);
}

static double clearance(const struct ground *g, const struct path *path, double time)
{
    struct vec3 p = path_at(path, time);
    return p.y - terrain_height(&g->terrain, g->craters.head ? &g->craters : NULL, p.x, p.z);
}

static struct path draw_path(bool late, uint64_t *random)
{
    struct vec3 along = vec3_scale(fixture_direction(random), fixture_uniform(random, 1.0, 300.0));
    int sort = (int)(fixture_random(random) % 4);
    double reach = (SIDE - 1) * SPACING;
    struct path path = {.at = {fixture_uniform(random, 0, reach), fixture_uniform(random, 10, 130),
                               fixture_uniform(random, 0, reach)},
                        .along = along};
    if (sort == 0) /* low and level at 3,000 m/s and 10 Hz */
        path.along =
            vec3_scale((struct vec3){path.along.x, 0.01 * path.along.y, path.along.z},
                       300.0 / maths_max(1.0, sqrt(along.x * along.x + along.z * along.z)));
    if (sort == 1) /* on the grid's lines */
        path.at.x = floor(path.at.x / SPACING) * SPACING;
    if (sort == 2) /* along them */
        path.along.z = 0.0;
    if (late)
        path.since = fixture_uniform(random, 0.0, 0.9);
    return path;
}

/* low: how far below the ground a sample may lie unnoticed; near: how exact the time is [m]. */
static int sweep_paths(const struct ground *g, bool late, uint64_t *random, double low, double near)
{
    const struct crater_index *craters = g->craters.head ? &g->craters : NULL;
    int hits = 0;
    for (int n = 0; n < PATHS; n++) {
        struct path path = draw_path(late, random);
        double toi = 2.0;
        bool hit = analytic_impact_ground(&g->terrain, craters, &path, &toi);
        double first = clearance(g, &path, path.since);
        hits += hit;
        if (first < 0.0)
            assert_true(hit && toi == path.since);
        else if (hit)
            assert_true(fabs(clearance(g, &path, toi)) <= near);
        for (int s = 0; s <= SAMPLES; s++) {
            double time = path.since + (1.0 - path.since) * s / SAMPLES;
            if (clearance(g, &path, time) < -low && !(hit && toi <= time))
                fail_msg("path %d is %.3f m under the ground at %.6f, and the sweep says %s %.6f",
                         n, -clearance(g, &path, time), time, hit ? "hit at" : "no hit", toi);
        }
    }
    return hits;
}

static void test_no_path_tunnels_through_ridges(void **state)
{
    static struct ground g;
    uint64_t random = fixture_seed(24);
    (void)state;
    raise_ground(&g, &random);
    assert_in_range(sweep_paths(&g, false, &random, 1e-6, 1e-6), PATHS / 10, PATHS * 9 / 10);
}

/* Paths as they continue after a collision in mid-frame. A sweep that never ends is ended here. */
static void test_no_path_that_began_late_tunnels(void **state)
{
    static struct ground g;
    uint64_t random = fixture_seed(26);
    (void)state;
    raise_ground(&g, &random);
    alarm(HANG_S);
    assert_in_range(sweep_paths(&g, true, &random, 1e-6, 1e-6), PATHS / 10, PATHS * 9 / 10);
    alarm(0);
}

static void test_no_path_tunnels_through_cratered_ground(void **state)
{
    static struct ground g;
    uint64_t random = fixture_seed(25);
    (void)state;
    raise_ground(&g, &random);
    dig_ground(&g, &random);
    /* A rim's crest cut on less than the half metre between two looks is at most this deep. */
    assert_in_range(sweep_paths(&g, false, &random, 0.3, 1e-3), PATHS / 10, PATHS * 9 / 10);
    crater_index_free(&g.craters);
}

static void test_no_path_tunnels_through_earthworks(void **state)
{
    static struct ground g;
    static struct earthwork works[60];
    uint64_t random = fixture_seed(27);
    (void)state;
    raise_ground(&g, &random);
    works_scatter(works, 60, 200.0, (SIDE - 1) * SPACING - 200.0, 2.0, &random);
    g.terrain.earthworks = works_index(works, 60);
    /* An edge cut on less than the half metre between two looks is at most this deep. */
    assert_in_range(sweep_paths(&g, false, &random, 0.5, 1e-3), PATHS / 10, PATHS * 9 / 10);
    works_free(&g.terrain.earthworks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres_touch_when_bisection_says),
        cmocka_unit_test(test_no_path_tunnels_through_ridges),
        cmocka_unit_test(test_no_path_tunnels_through_cratered_ground),
        cmocka_unit_test(test_no_path_tunnels_through_earthworks),
        cmocka_unit_test(test_no_path_that_began_late_tunnels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
