/* Times of impact of hulls against slow oracles that look only at the gap: bisection where bodies
 * do not turn, small sure steps where they do. Tanks at every speed, and what must hold of any
 * pair. SEED=n runs another set. */
#include "collider/advance.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define SLACK_M 1e-9

/* --- bodies ------------------------------------------------------------------------------------*/

#define SOLID_HULLS  3
#define SOLID_POINTS 64
#define SOLID_PLANES 256

struct solid {
    struct hull hull[SOLID_HULLS];
    struct vec3 point[SOLID_POINTS];
    struct hull_plane plane[SOLID_PLANES];
    uint32_t hulls, points, planes;
    double bound;
};

static struct vec3 cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Planes through three points of the hull that have all others on one side. */
static void add_planes(struct solid *s, struct hull *hull)
{
    const struct vec3 *p = s->point + hull->first_vertex;
    uint32_t count = hull->vertex_count;
    hull->first_plane = s->planes;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            for (uint32_t k = 0; k < count; k++) {
                struct vec3 n = cross(vec3_sub(p[j], p[i]), vec3_sub(p[k], p[i]));
                double length = vec3_length(n), most = -INFINITY;
                if (j <= i || k <= i || length < 1e-9)
                    continue;
                n = vec3_scale(n, 1.0 / length);
                for (uint32_t m = 0; m < count; m++)
                    most = maths_max(most, vec3_dot(n, p[m]));
                double offset = vec3_dot(n, p[i]);
                bool known = most > offset + 1e-9;
                for (uint32_t m = hull->first_plane; m < s->planes && !known; m++)
                    known = vec3_dot(s->plane[m].normal, n) > 1.0 - 1e-12;
                if (!known)
                    s->plane[s->planes++] = (struct hull_plane){n, offset};
            }
        }
    }
    hull->plane_count = s->planes - hull->first_plane;
    assert_true(s->planes <= SOLID_PLANES && s->points <= SOLID_POINTS);
}

/* Closes the hull of the points added since the last one. */
static void add_hull(struct solid *s, uint32_t first)
{
    struct hull *hull = &s->hull[s->hulls++];
    struct vec3 low = s->point[first], high = low;
    for (uint32_t i = first; i < s->points; i++) {
        struct vec3 p = s->point[i];
        low = (struct vec3){maths_min(low.x, p.x), maths_min(low.y, p.y), maths_min(low.z, p.z)};
        high =
            (struct vec3){maths_max(high.x, p.x), maths_max(high.y, p.y), maths_max(high.z, p.z)};
    }
    *hull = (struct hull){.first_vertex = first,
                          .vertex_count = s->points - first,
                          .centre = vec3_lerp(low, high, 0.5)};
    for (uint32_t i = first; i < s->points; i++) {
        hull->radius_m =
            maths_max(hull->radius_m, vec3_length(vec3_sub(s->point[i], hull->centre)));
        s->bound = maths_max(s->bound, vec3_length(s->point[i]));
    }
    add_planes(s, hull);
}

static void add_box(struct solid *s, struct vec3 centre, struct vec3 half)
{
    uint32_t first = s->points;
    for (int i = 0; i < 8; i++)
        s->point[s->points++] =
            vec3_add(centre, (struct vec3){i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                           i & 4 ? half.z : -half.z});
    add_hull(s, first);
}

static struct vec3 direction(uint64_t *random)
{
    for (;;) {
        struct vec3 v = {fixture_uniform(random, -1, 1), fixture_uniform(random, -1, 1),
                         fixture_uniform(random, -1, 1)};
        double length = vec3_length(v);
        if (length > 0.1 && length < 1.0)
            return vec3_scale(v, 1.0 / length);
    }
}

static void add_stone(struct solid *s, struct vec3 centre, double size, uint64_t *random)
{
    uint32_t first = s->points, count = 5 + (uint32_t)(fixture_random(random) % 4);
    for (uint32_t i = 0; i < count; i++)
        s->point[s->points++] = vec3_add(centre, vec3_scale(direction(random), size));
    add_hull(s, first);
}

/* 7.4 m long, 3.6 m wide; its turret is a hull of its own. */
static struct vec3 tank_half = {3.7, 0.7, 1.8};
static void form_tank(struct solid *s)
{
    *s = (struct solid){.hulls = 0};
    add_box(s, (struct vec3){0, 0, 0}, tank_half);
    add_box(s, (struct vec3){0.2, 1.1, 0}, (struct vec3){1.5, 0.4, 1.4});
}

static void form_pole(struct solid *s)
{
    *s = (struct solid){.hulls = 0};
    add_box(s, (struct vec3){0, 0, 0}, (struct vec3){0.12, 4.0, 0.12});
}

enum sort { STONE, BOX, TANK, POLE, TREE, SORTS };

static void form(struct solid *s, enum sort sort, uint64_t *random)
{
    *s = (struct solid){.hulls = 0};
    switch (sort) {
    case STONE:
        add_stone(s, (struct vec3){0, 0, 0}, fixture_uniform(random, 0.2, 6.0), random);
        break;
    case BOX:
        add_box(s, (struct vec3){0, 0, 0},
                (struct vec3){fixture_uniform(random, 0.1, 5), fixture_uniform(random, 0.1, 5),
                              fixture_uniform(random, 0.1, 5)});
        break;
    case TANK:
        form_tank(s);
        break;
    case POLE:
        form_pole(s);
        break;
    default: /* a trunk and a crown */
        add_box(s, (struct vec3){0, 0, 0}, (struct vec3){0.2, 2.0, 0.2});
        add_stone(s, (struct vec3){0, 4, 0}, 2.0, random);
        break;
    }
}

static struct swept_body body(const struct solid *s, struct vec3 at, struct vec3 along,
                              struct quat from, struct quat to)
{
    return (struct swept_body){.hull = s->hull,
                               .hull_count = s->hulls,
                               .vertices = s->point,
                               .planes = s->plane,
                               .scale = 1.0,
                               .bound_m = s->bound,
                               .path = {.at = at, .along = along},
                               .from = from,
                               .to = to};
}

static struct quat any_turn(uint64_t *random)
{
    return rotation_of(fixture_uniform(random, 0.0, TWO_PI), fixture_uniform(random, -1.5, 1.5),
                       fixture_uniform(random, -PI, PI));
}

static struct quat turned(struct quat from, double most, uint64_t *random)
{
    return rotation_spun(from, direction(random), fixture_uniform(random, 0.0, most));
}

/* --- oracles -----------------------------------------------------------------------------------*/

static double bisect(const struct swept_body *a, const struct swept_body *b, double above,
                     double below, double gap)
{
    for (int i = 0; i < 60 && below - above > 1e-16; i++) {
        double middle = 0.5 * (above + below);
        if (advance_gap(a, b, middle) <= gap)
            below = middle;
        else
            above = middle;
    }
    return below;
}

/* First time the gap is that small, INFINITY for never. Convex bodies that do not turn: the gap
 * falls to one lowest point and rises again. */
static double straight(const struct swept_body *a, const struct swept_body *b, double gap)
{
    double low = a->path.since, high = 1.0;
    for (int i = 0; i < 90; i++) {
        double p = low + (high - low) * 0.382, q = high - (high - low) * 0.382;
        if (advance_gap(a, b, p) <= advance_gap(a, b, q))
            high = q;
        else
            low = p;
    }
    if (advance_gap(a, b, high) > gap)
        return INFINITY;
    return bisect(a, b, a->path.since, high, gap);
}

/* The same for any bodies: steps that the gap cannot close in, or a hundred-thousandth. */
static double stepped(const struct swept_body *a, const struct swept_body *b, double gap)
{
    double fastest =
        vec3_length(vec3_sub(b->path.along, a->path.along)) +
        (rotation_rate(a->from, a->to) * a->bound_m + rotation_rate(b->from, b->to) * b->bound_m) /
            (1.0 - a->path.since);
    double before = a->path.since, time = before;
    for (;;) {
        double over = advance_gap(a, b, time) - gap;
        if (over <= 0.0)
            return time == a->path.since ? time : bisect(a, b, before, time, gap);
        if (time >= 1.0)
            return INFINITY;
        before = time;
        time = maths_min(1.0, time + maths_max(over / fastest, 1e-5));
    }
}

/* --- what must hold of every answer ------------------------------------------------------------*/

struct score {
    int hits, misses;
};

/* Bodies that were apart: touch where the gap is TOUCH_M, and never after an oracle's time. */
static void check(const struct swept_body *a, const struct swept_body *b, bool turns, int n,
                  struct score *score)
{
    struct touch touch;
    double from = a->path.since;
    bool hit = advance_touch(a, b, from, &touch);
    double oracle = turns ? stepped(a, b, TOUCH_M - SLACK_M) : straight(a, b, TOUCH_M - SLACK_M);
    *(hit ? &score->hits : &score->misses) += 1;
    if (!hit) {
        if (oracle < 1.0)
            fail_msg("pair %d: missed a touch at %.17g", n, oracle);
        return;
    }
    double gap = advance_gap(a, b, touch.toi);
    if (!(touch.toi >= from && touch.toi <= 1.0 && touch.toi <= oracle + SLACK_M &&
          fabs(gap - TOUCH_M) <= SLACK_M && touch.depth_m == 0.0))
        fail_msg("pair %d: touch at %.17g, oracle %.17g, gap there %.17g, depth %g", n, touch.toi,
                 oracle, gap, touch.depth_m);
    assert_true(fabs(vec3_length(touch.normal) - 1.0) < 1e-12);
    double before = maths_max(from, touch.toi - 1e-6);
    assert_true(touch.toi - from < 1e-6 || advance_gap(a, b, before) >= gap - SLACK_M);
}

/* Puts b where it meets a, or nearly, at a time within the frame. */
static void draw(struct solid *solid_a, struct solid *solid_b, double most_turn,
                 struct swept_body *a, struct swept_body *b, uint64_t *random)
{
    struct quat from_a = any_turn(random), from_b = any_turn(random);
    struct vec3 at = {fixture_uniform(random, 0, 50000), fixture_uniform(random, 0, 2000),
                      fixture_uniform(random, 0, 50000)};
    double fast = fixture_random(random) % 4 ? 30.0 : 300.0;
    struct vec3 along_a = vec3_scale(direction(random), fixture_uniform(random, 0.0, fast));
    struct vec3 along_b = vec3_scale(direction(random), fixture_uniform(random, 0.0, fast));
    double meet = fixture_uniform(random, 0.0, 1.2);
    double reach = solid_a->bound + solid_b->bound;
    struct vec3 beside = vec3_scale(direction(random), fixture_uniform(random, 0.0, reach));
    *a = body(solid_a, at, along_a, from_a, turned(from_a, most_turn, random));
    *b = body(solid_b, vec3_add(vec3_add(at, beside), vec3_scale(vec3_sub(along_a, along_b), meet)),
              along_b, from_b, turned(from_b, most_turn, random));
    if (fixture_random(random) % 4 == 0) { /* from the middle of the frame on */
        a->path.since = b->path.since = fixture_uniform(random, 0.0, 0.7);
        a->path.at = path_at(&(struct path){at, along_a, 0.0}, a->path.since);
        b->path.at = path_at(&(struct path){b->path.at, along_b, 0.0}, a->path.since);
    }
}

static void test_row_39_straight_ways_touch_when_bisection_says(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    struct score score = {0, 0};
    uint64_t random = fixture_seed(330);
    (void)state;
    for (int n = 0; n < 6000; n++) {
        form(&solid_a, n % 3 ? STONE : BOX, &random);
        form(&solid_b, n % 2 ? n % 5 ? BOX : POLE : STONE, &random);
        draw(&solid_a, &solid_b, 0.0, &a, &b, &random);
        if (advance_gap(&a, &b, a.path.since) <= 2.0 * TOUCH_M)
            continue;
        check(&a, &b, false, n, &score);
        struct touch touch;
        if (!advance_touch(&a, &b, a.path.since, &touch))
            continue;
        double steep = vec3_dot(vec3_sub(a.path.along, b.path.along), touch.normal);
        if (steep > 0.01)
            assert_true(fabs(touch.toi - straight(&a, &b, TOUCH_M)) < SLACK_M);
    }
    assert_in_range(score.hits, 1500, 4500);
    assert_in_range(score.misses, 500, 4500);
}

static void test_row_39_turning_bodies_touch_when_small_steps_say(void **state)
{
    static struct solid solid_a, solid_b;
    const double most_turn[] = {0.01, 0.3, PI};
    struct swept_body a, b;
    struct score score = {0, 0};
    uint64_t random = fixture_seed(331);
    (void)state;
    for (int n = 0; n < 6000; n++) {
        form(&solid_a, (enum sort)(n % SORTS), &random);
        form(&solid_b, (enum sort)(n / SORTS % SORTS), &random);
        draw(&solid_a, &solid_b, most_turn[n % 3], &a, &b, &random);
        if (advance_gap(&a, &b, a.path.since) > 2.0 * TOUCH_M)
            check(&a, &b, true, n, &score);
    }
    assert_in_range(score.hits, 1500, 4500);
    assert_in_range(score.misses, 500, 4500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_39_straight_ways_touch_when_bisection_says),
        cmocka_unit_test(test_row_39_turning_bodies_touch_when_small_steps_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
