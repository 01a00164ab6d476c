/* Times of impact of hulls against slow oracles that look only at the gap: bisection where bodies
 * do not turn, small sure steps where they do. Tanks at every speed, and what must hold of any
 * pair. SEED=n runs another set. */
#include "collider/geometry/time_of_impact.h"

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

/* Planes through three points of the hull that have all others on one side. */
static void add_planes(struct solid *s, struct hull *hull)
{
    const struct vec3 *p = s->point + hull->first_vertex;
    uint32_t count = hull->vertex_count;
    hull->first_plane = s->planes;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            for (uint32_t k = 0; k < count; k++) {
                struct vec3 n = vec3_cross(vec3_sub(p[j], p[i]), vec3_sub(p[k], p[i]));
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
        struct vec3 arm = vec3_sub(s->point[i], hull->centre);
        hull->half = (struct vec3){maths_max(hull->half.x, fabs(arm.x)),
                                   maths_max(hull->half.y, fabs(arm.y)),
                                   maths_max(hull->half.z, fabs(arm.z))};
        hull->radius_m = maths_max(hull->radius_m, vec3_length(arm));
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

static void add_stone(struct solid *s, struct vec3 centre, double size, uint64_t *random)
{
    uint32_t first = s->points, count = 5 + (uint32_t)(fixture_random(random) % 4);
    for (uint32_t i = 0; i < count; i++)
        s->point[s->points++] = vec3_add(centre, vec3_scale(fixture_direction(random), size));
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

enum sort { STONE, BOX, TANK, POLE, TREE, ARM, SORTS };

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
    case ARM: /* all of it beside the axis */
        add_box(s, (struct vec3){4, 0, 0}, (struct vec3){2.0, 0.2, 0.3});
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
    return rotation_spun(from, fixture_direction(random), fixture_uniform(random, 0.0, most));
}

/* --- oracles -----------------------------------------------------------------------------------*/

static double bisect(const struct swept_body *a, const struct swept_body *b, double above,
                     double below, double gap)
{
    for (int i = 0; i < 60 && below - above > 1e-16; i++) {
        double middle = 0.5 * (above + below);
        if (time_of_impact_gap(a, b, middle) <= gap)
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
        if (time_of_impact_gap(a, b, p) <= time_of_impact_gap(a, b, q))
            high = q;
        else
            low = p;
    }
    if (time_of_impact_gap(a, b, high) > gap)
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
        double over = time_of_impact_gap(a, b, time) - gap;
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

/* Bodies that were apart touch where the gap is SKIN_M, and never after an oracle's time. */
static void check(const struct swept_body *a, const struct swept_body *b, bool rotates, int n,
                  struct score *score)
{
    struct hull_contact impact;
    double from = a->path.since;
    bool hit = time_of_impact_find(a, b, from, &impact);
    assert_false(hit && time_of_impact_excluded(a, b, from));
    double oracle = rotates ? stepped(a, b, SKIN_M - SLACK_M) : straight(a, b, SKIN_M - SLACK_M);
    *(hit ? &score->hits : &score->misses) += 1;
    if (!hit) {
        if (oracle < 1.0)
            fail_msg("pair %d: missed a touch at %.17g", n, oracle);
        return;
    }
    double gap = time_of_impact_gap(a, b, impact.toi);
    if (!(impact.toi >= from && impact.toi <= 1.0 && impact.toi <= oracle + SLACK_M &&
          fabs(gap - SKIN_M) <= SLACK_M && impact.depth_m == 0.0))
        fail_msg("pair %d: touch at %.17g, oracle %.17g, gap there %.17g, depth %g", n, impact.toi,
                 oracle, gap, impact.depth_m);
    assert_true(fabs(vec3_length(impact.normal) - 1.0) < 1e-12);
    double before = maths_max(from, impact.toi - 1e-6);
    assert_true(impact.toi - from < 1e-6 || time_of_impact_gap(a, b, before) >= gap - SLACK_M);
}

/* Puts b where it meets a, or nearly, at a time within the frame. */
static void draw(struct solid *solid_a, struct solid *solid_b, double most_turn,
                 struct swept_body *a, struct swept_body *b, uint64_t *random)
{
    struct quat from_a = any_turn(random), from_b = any_turn(random);
    struct vec3 at = {fixture_uniform(random, 0, 50000), fixture_uniform(random, 0, 2000),
                      fixture_uniform(random, 0, 50000)};
    double fast = fixture_random(random) % 4 ? 30.0 : 300.0;
    struct vec3 along_a = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, fast));
    struct vec3 along_b = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, fast));
    double meet = fixture_uniform(random, 0.0, 1.2);
    double reach = solid_a->bound + solid_b->bound;
    struct vec3 beside = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, reach));
    *a = body(solid_a, at, along_a, from_a, turned(from_a, most_turn, random));
    *b = body(solid_b, vec3_add(vec3_add(at, beside), vec3_scale(vec3_sub(along_a, along_b), meet)),
              along_b, from_b, turned(from_b, most_turn, random));
    if (fixture_random(random) % 4 == 0) { /* from the middle of the frame on */
        a->path.since = b->path.since = fixture_uniform(random, 0.0, 0.7);
        a->path.at = path_at(&(struct path){.at = at, .along = along_a}, a->path.since);
        b->path.at = path_at(&(struct path){.at = b->path.at, .along = along_b}, a->path.since);
    }
}

static void test_row_39_straight_paths_touch_when_bisection_says(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    struct score score = {0, 0};
    uint64_t random = fixture_seed(330);
    (void)state;
    for (int n = 0; n < 5000; n++) {
        form(&solid_a, n % 3 ? STONE : BOX, &random);
        form(&solid_b, n % 2 ? n % 5 ? BOX : POLE : STONE, &random);
        draw(&solid_a, &solid_b, 0.0, &a, &b, &random);
        if (time_of_impact_gap(&a, &b, a.path.since) <= 2.0 * SKIN_M)
            continue;
        check(&a, &b, false, n, &score);
        struct hull_contact impact;
        if (!time_of_impact_find(&a, &b, a.path.since, &impact))
            continue;
        double steep = vec3_dot(vec3_sub(a.path.along, b.path.along), impact.normal);
        if (steep > 0.01)
            assert_true(fabs(impact.toi - straight(&a, &b, SKIN_M)) < SLACK_M);
    }
    assert_in_range(score.hits, 1000, 4000);
    assert_in_range(score.misses, 500, 4000);
}

static void test_row_39_rotating_bodies_touch_when_small_steps_say(void **state)
{
    static struct solid solid_a, solid_b;
    const double most_turn[] = {0.01, 0.3, PI};
    struct swept_body a, b;
    struct score score = {0, 0};
    uint64_t random = fixture_seed(331);
    (void)state;
    for (int n = 0; n < 5000; n++) {
        form(&solid_a, (enum sort)(n % SORTS), &random);
        form(&solid_b, (enum sort)(n / SORTS % SORTS), &random);
        draw(&solid_a, &solid_b, most_turn[n % 3], &a, &b, &random);
        if (time_of_impact_gap(&a, &b, a.path.since) > 2.0 * SKIN_M)
            check(&a, &b, true, n, &score);
    }
    assert_in_range(score.hits, 1000, 4000);
    assert_in_range(score.misses, 500, 4000);
}

/* --- tanks -------------------------------------------------------------------------------------*/

#define MEETINGS 200 /* of each sort at each speed and rate */
#define LONG     3.7 /* half of a tank */
#define WIDE     1.8
#define THIN     0.12 /* half of a pole */

enum meeting {
    HEAD_ON,
    GLANCING,      /* head on, sides overlapping by a millimetre to 5 cm */
    PASSING,       /* sides 1 cm apart: no contact */
    CROSSING,      /* at right angles, into the side */
    CUTTING,       /* at right angles, a corner cut by a millimetre to 5 cm */
    CROSSING_PAST, /* at right angles, corners 1 cm apart: no contact */
    INTO_POLE,
    PAST_POLE, /* 1 cm beside it: no contact */
    MEETINGS_SORTS
};

/* b's position relative to a and its motion relative to a, in a's axes (forward and right), and
 * when they touch: -1 for never. */
struct plan {
    double along, across, go_along, go_across, toi;
};

static struct plan plan_meeting(enum meeting sort, double step, uint64_t *random)
{
    double toi = fixture_uniform(random, 0.001, 0.999), side = fixture_random(random) & 1 ? 1 : -1;
    double wide = sort >= INTO_POLE ? WIDE + THIN : 2.0 * WIDE;
    double reach = (sort >= INTO_POLE ? LONG + THIN : 2.0 * LONG) + SKIN_M;
    double cut = fixture_uniform(random, 0.001, 0.05), free = fixture_uniform(random, 0, 1);
    struct plan plan = {.go_along = -2.0 * step, .toi = toi, .along = reach + 2.0 * step * toi};
    double corner = LONG + WIDE; /* of the square that crossing tanks make */
    switch (sort) {
    case GLANCING:
        plan.across = side * (wide - cut);
        return plan;
    case PASSING:
    case PAST_POLE:
        plan.across = side * (wide + 0.01);
        plan.toi = -1.0;
        return plan;
    case CROSSING:
    case CUTTING:
    case CROSSING_PAST:
        plan.go_along = -step;
        plan.go_across = side * step;
        plan.along = corner + SKIN_M + step * toi;
        plan.across = side * (corner * (1.98 * free - 0.99) - step * toi);
        if (sort == CUTTING)
            plan.across = side * (corner - cut - step * toi);
        if (sort == CROSSING_PAST) { /* the gap at the corner is 1 cm across the path */
            plan.across = side * (corner + 0.01 * sqrt(2.0) - SKIN_M - step * toi);
            plan.toi = -1.0;
        }
        return plan;
    default:
        plan.across = side * free * (wide - 0.001);
        return plan;
    }
}

static void meet(const struct solid *tank, const struct solid *other, enum meeting sort,
                 double step, uint64_t *random)
{
    struct plan plan = plan_meeting(sort, step, random);
    double heading = fixture_uniform(random, 0.0, TWO_PI);
    struct vec3 forward = {maths_sin(heading), 0.0, -maths_cos(heading)};
    struct vec3 right = {-forward.z, 0.0, forward.x};
    double turn = sort < CROSSING ? PI : sort < INTO_POLE ? HALF_PI : 0.0;
    struct quat face = rotation_of(heading, 0.0, 0.0), face_b = rotation_of(heading + turn, 0, 0);
    struct vec3 at = {fixture_uniform(random, 0, 50000), 100.0, fixture_uniform(random, 0, 50000)};
    struct vec3 along = vec3_scale(forward, step), touch_point;
    struct vec3 along_b = vec3_add(
        along, vec3_add(vec3_scale(forward, plan.go_along), vec3_scale(right, plan.go_across)));
    struct vec3 at_b =
        vec3_add(at, vec3_add(vec3_scale(forward, plan.along), vec3_scale(right, plan.across)));
    if (sort >= INTO_POLE)
        at_b.y += 3.5;
    struct swept_body a = body(tank, at, along, face, face);
    struct swept_body b = body(other, at_b, along_b, face_b, face_b);
    struct hull_contact impact;
    bool hit = time_of_impact_find(&a, &b, 0.0, &impact);
    if (hit != (plan.toi >= 0.0))
        fail_msg("sort %d, %g m a frame: %s", (int)sort, step, hit ? "touches" : "does not touch");
    if (!hit)
        return;
    touch_point = vec3_sub(impact.point, path_at(&a.path, impact.toi));
    if (!(fabs(impact.toi - plan.toi) * step < SLACK_M && fabs(impact.toi - plan.toi) < SLACK_M))
        fail_msg("sort %d, %g m a frame: touches at %.17g, not at %.17g", (int)sort, step,
                 impact.toi, plan.toi);
    assert_true(vec3_dot(impact.normal, forward) > 1.0 - 1e-9);
    assert_true(fabs(vec3_dot(touch_point, forward) - LONG) < 0.01);
    assert_true(fabs(vec3_dot(touch_point, right)) < WIDE + 0.01);
}

/* Rows 23 and 25: at any speed and rate none is missed, and none is found that is not there. */
static void test_row_23_tanks_meet_at_any_speed(void **state)
{
    static struct solid tank, other, pole;
    const double speed_mps[] = {10.0, 60.0, 277.0, 1000.0, 3000.0}, hz[] = {10.0, 60.0};
    uint64_t random = fixture_seed(332);
    (void)state;
    form_tank(&tank);
    form_tank(&other);
    form_pole(&pole);
    for (int speed = 0; speed < 5; speed++) {
        for (int rate = 0; rate < 2; rate++) {
            for (int n = 0; n < MEETINGS * MEETINGS_SORTS; n++) {
                enum meeting sort = (enum meeting)(n % MEETINGS_SORTS);
                meet(&tank, sort >= INTO_POLE ? &pole : &other, sort, speed_mps[speed] / hz[rate],
                     &random);
            }
        }
    }
}

/* --- bodies that touch from the start ----------------------------------------------------------*/

/* How far b is beyond a along n: below 0 they overlap by that. */
static double apart_along(const struct swept_body *a, const struct swept_body *b, double time,
                          struct vec3 n)
{
    const struct swept_body *const of[2] = {a, b};
    double reach[2];
    for (int side = 0; side < 2; side++) {
        struct mat3 turn = rotation_matrix(rotation_between(of[side]->from, of[side]->to, time));
        reach[side] = -INFINITY;
        for (uint32_t i = 0; i < of[side]->hull->vertex_count; i++) {
            double along = vec3_dot(n, rotation_apply(&turn, of[side]->vertices[i]));
            reach[side] = maths_max(reach[side], side ? -along : along);
        }
    }
    return vec3_dot(n, vec3_sub(path_at(&b->path, time), path_at(&a->path, time))) - reach[0] -
           reach[1];
}

static void widest(const struct swept_body *a, const struct swept_body *b, double time,
                   struct vec3 n, double *apart, struct vec3 *normal)
{
    double along = apart_along(a, b, time, n);
    if (along > *apart) {
        *apart = along;
        *normal = n;
    }
}

/* The most apart they are across a face of either or the line of their centres. */
static double across_faces(const struct swept_body *a, const struct swept_body *b, double time,
                           struct vec3 *normal)
{
    const struct swept_body *const of[2] = {a, b};
    struct vec3 centre[2];
    double apart = -INFINITY;
    for (int side = 0; side < 2; side++) {
        struct mat3 turn = rotation_matrix(rotation_between(of[side]->from, of[side]->to, time));
        centre[side] =
            vec3_add(path_at(&of[side]->path, time), rotation_apply(&turn, of[side]->hull->centre));
        for (uint32_t i = 0; i < of[side]->hull->plane_count; i++) {
            struct vec3 n = rotation_apply(&turn, of[side]->planes[i].normal);
            widest(a, b, time, side ? vec3_scale(n, -1.0) : n, &apart, normal);
        }
    }
    struct vec3 line = vec3_sub(centre[1], centre[0]);
    widest(a, b, time, vec3_scale(line, 1.0 / vec3_length(line)), &apart, normal);
    return apart;
}

/* Across faces and across any two edges: as far as they really are apart, when they overlap. */
static double across_edges(const struct swept_body *a, const struct swept_body *b, double time)
{
    struct vec3 way_out;
    double apart = across_faces(a, b, time, &way_out);
    struct mat3 turn_a = rotation_matrix(rotation_between(a->from, a->to, time));
    struct mat3 turn_b = rotation_matrix(rotation_between(b->from, b->to, time));
    uint32_t count_a = a->hull->vertex_count, count_b = b->hull->vertex_count;
    for (uint32_t i = 1; i < count_a * count_a; i++) {
        if (i / count_a >= i % count_a)
            continue;
        struct vec3 e =
            rotation_apply(&turn_a, vec3_sub(a->vertices[i / count_a], a->vertices[i % count_a]));
        for (uint32_t k = 1; k < count_b * count_b; k++) {
            struct vec3 f = rotation_apply(
                &turn_b, vec3_sub(b->vertices[k / count_b], b->vertices[k % count_b]));
            struct vec3 n = vec3_cross(e, f);
            double length = vec3_length(n);
            if (length > 1e-9) /* k takes both signs along b's edges: n on both sides */
                widest(a, b, time, vec3_scale(n, 1.0 / length), &apart, &way_out);
        }
    }
    return apart;
}

/* Puts two boxes or stones within the skin of each other, or in each other. */
static void draw_touching(struct solid *solid_a, struct solid *solid_b, double deepest,
                          double most_turn, struct swept_body *a, struct swept_body *b,
                          uint64_t *random)
{
    bool boxes = fixture_random(random) & 1;
    form(solid_a, BOX, random);
    form(solid_b, boxes ? BOX : STONE, random);
    struct quat from_a = any_turn(random);
    struct quat from_b = fixture_random(random) & 1 ? from_a : any_turn(random);
    struct vec3 at = {fixture_uniform(random, 0, 50000), 100, fixture_uniform(random, 0, 50000)};
    double reach = solid_a->bound + solid_b->bound + 1.0;
    struct hull_contact impact;
    for (bool met = false; !met;) { /* moves them together without rotation; stones may miss */
        struct vec3 to = fixture_direction(random), still = {0, 0, 0};
        *a = body(solid_a, at, still, from_a, from_a);
        *b = body(solid_b, vec3_add(at, vec3_scale(to, reach)), vec3_scale(to, -reach), from_b,
                  from_b);
        met = time_of_impact_find(a, b, 0.0, &impact);
    }
    a->to = turned(from_a, most_turn, random);
    b->to = turned(from_b, most_turn, random);
    double nearer = fixture_random(random) & 1 ? fixture_uniform(random, 0.0, 0.9 * SKIN_M)
                                               : fixture_uniform(random, 0.0, deepest);
    b->path.at = vec3_add(path_at(&b->path, impact.toi), vec3_scale(impact.normal, -nearer));
    b->path.along = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, 2.0));
}

/* Bodies that do not rotate and part along the direction of least overlap never approach again;
 * bodies that approach are found at once, with their depth. */
static void test_straight_bodies_in_each_other_touch_at_once_or_never(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    uint64_t random = fixture_seed(333), hits = 0;
    (void)state;
    for (int n = 0; n < 3000; n++) {
        struct hull_contact impact;
        draw_touching(&solid_a, &solid_b, 0.5, 0.0, &a, &b, &random);
        struct vec3 way_out = {0, 0, 0}, along = vec3_sub(b.path.along, a.path.along);
        double first = time_of_impact_gap(&a, &b, 0.0), apart = across_faces(&a, &b, 0.0, &way_out);
        bool hit = time_of_impact_find(&a, &b, 0.0, &impact);
        hits += hit;
        if (!hit) {
            assert_true(first > 0.0 ? time_of_impact_gap(&a, &b, 1.0) >= first - 1e-6
                                    : vec3_dot(along, way_out) >= -1e-6);
            continue;
        }
        assert_true(impact.toi == 0.0 && vec3_dot(along, impact.normal) < -NEARING_M);
        assert_true(fabs(impact.depth_m - (first > 0.0 ? 0.0 : -apart)) < SLACK_M);
        /* Pushed out by its depth, it is out. */
        a.path.at = vec3_sub(a.path.at, vec3_scale(impact.normal, impact.depth_m + 1e-6));
        assert_true(time_of_impact_gap(&a, &b, 0.0) > 0.0);
    }
    assert_in_range(hits, 1000, 2500);
}

/* Rotating bodies may part and approach again: then they touch before they are half as far apart as
 * at first. */
static void test_turning_bodies_in_touch_come_nearer_by_no_more_than_the_skin(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    uint64_t random = fixture_seed(334), at_once = 0, later = 0, never = 0;
    (void)state;
    for (int n = 0; n < 3000; n++) {
        struct hull_contact impact = {.toi = 1.0};
        draw_touching(&solid_a, &solid_b, 0.0, n & 1 ? 0.2 : PI, &a, &b, &random);
        bool hit = time_of_impact_find(&a, &b, 0.0, &impact);
        *(!hit ? &never : impact.toi == 0.0 ? &at_once : &later) += 1;
        double first = time_of_impact_gap(&a, &b, 0.0);
        double floor_m = maths_min(SKIN_M, maths_max(0.5 * first, first - 0.5 * SKIN_M));
        for (int i = 1; i <= 200; i++) {
            double gap = time_of_impact_gap(&a, &b, impact.toi * i / 200.0);
            if (gap < floor_m - SLACK_M)
                fail_msg("pair %d: gap %.17g at %.17g of %.17g, at first %.17g", n, gap,
                         impact.toi * i / 200.0, impact.toi, first);
        }
        if (hit)
            assert_true(time_of_impact_gap(&a, &b, impact.toi) <= SKIN_M + SLACK_M);
    }
    assert_true(at_once > 500 && later > 100 && never > 500);
}

/* In each other, they come no deeper than by half the skin or a twentieth of the overlap. */
static void test_turning_bodies_in_each_other_come_no_deeper(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    uint64_t random = fixture_seed(337), at_once = 0, later = 0, never = 0;
    (void)state;
    for (int n = 0; n < 800; n++) {
        struct hull_contact impact = {.toi = 1.0};
        struct vec3 way_out = {0, 0, 0};
        draw_touching(&solid_a, &solid_b, 0.5, n & 1 ? 0.2 : PI, &a, &b, &random);
        double first = across_faces(&a, &b, 0.0, &way_out);
        if (first >= -0.01)
            continue;
        bool hit = time_of_impact_find(&a, &b, 0.0, &impact);
        *(!hit ? &never : impact.toi == 0.0 ? &at_once : &later) += 1;
        assert_true(impact.depth_m <= maths_max(0.5 * SKIN_M - first, -1.05 * first) + SLACK_M);
        for (int i = 1; i <= 10 && impact.toi > 0.0; i++) {
            double gap = across_edges(&a, &b, impact.toi * i / 10.0);
            if (gap < first + maths_min(-0.5 * SKIN_M, 0.05 * first) - SLACK_M)
                fail_msg("pair %d: gap %.17g at %.17g of %.17g, at first %.17g", n, gap,
                         impact.toi * i / 10.0, impact.toi, first);
        }
    }
    assert_true(at_once > 50 && later > 10 && never > 50);
}

/* --- what must not matter ----------------------------------------------------------------------*/

static void test_swapping_the_bodies_changes_only_the_normals_sign(void **state)
{
    static struct solid solid_a, solid_b;
    const double most_turn[] = {0.0, 0.01, 0.3, PI};
    struct swept_body a, b;
    uint64_t random = fixture_seed(335), hits = 0;
    (void)state;
    for (int n = 0; n < 6000; n++) {
        struct hull_contact there, back;
        form(&solid_a, (enum sort)(n % SORTS), &random);
        form(&solid_b, (enum sort)(n / SORTS % SORTS), &random);
        if (n % 4 == 0)
            draw_touching(&solid_a, &solid_b, 0.5, most_turn[n / 4 % 4], &a, &b, &random);
        else
            draw(&solid_a, &solid_b, most_turn[n % 4], &a, &b, &random);
        bool hit = time_of_impact_find(&a, &b, a.path.since, &there);
        assert_false(hit && time_of_impact_excluded(&b, &a, a.path.since));
        assert_true(time_of_impact_find(&b, &a, a.path.since, &back) == hit);
        hits += hit;
        if (!hit)
            continue;
        assert_true(there.toi == back.toi && there.depth_m == back.depth_m);
        assert_true(vec3_length(vec3_sub(there.point, back.point)) == 0.0);
        assert_true(vec3_length(vec3_add(there.normal, back.normal)) == 0.0);
    }
    assert_in_range(hits, 2000, 5000);
}

/* Nor where in the world they are, nor that all of it moves. */
static void test_the_place_and_a_common_motion_change_nothing(void **state)
{
    static struct solid solid_a, solid_b;
    struct swept_body a, b;
    uint64_t random = fixture_seed(336), hits = 0, grazes = 0;
    (void)state;
    for (int n = 0; n < 4000; n++) {
        struct hull_contact here, there;
        form(&solid_a, (enum sort)(n % SORTS), &random);
        form(&solid_b, (enum sort)(n / SORTS % SORTS), &random);
        draw(&solid_a, &solid_b, n & 1 ? 0.3 : 0.0, &a, &b, &random);
        if (time_of_impact_gap(&a, &b, a.path.since) <= 2.0 * SKIN_M)
            continue;
        bool hit = time_of_impact_find(&a, &b, a.path.since, &here);
        struct swept_body c = a, d = b;
        struct vec3 aside = {fixture_uniform(&random, -9e3, 9e3), 50.0,
                             fixture_uniform(&random, -9e3, 9e3)};
        struct vec3 common = vec3_scale(fixture_direction(&random), 20.0);
        c.path.at = vec3_add(a.path.at, aside);
        d.path.at = vec3_add(b.path.at, aside);
        c.path.along = vec3_add(a.path.along, common);
        d.path.along = vec3_add(b.path.along, common);
        bool hit_there = time_of_impact_find(&c, &d, a.path.since, &there);
        hits += hit;
        if (hit != hit_there || (hit && fabs(here.toi - there.toi) > 1e-6)) {
            grazes++; /* they just touch, or just do not */
            continue;
        }
        if (!hit)
            continue;
        struct vec3 from_a = vec3_sub(here.point, path_at(&a.path, here.toi));
        struct vec3 from_c = vec3_sub(there.point, path_at(&c.path, there.toi));
        assert_true(vec3_length(vec3_sub(from_a, from_c)) < 1e-3);
        assert_true(vec3_length(vec3_sub(here.normal, there.normal)) < 1e-4);
    }
    assert_true(hits > 1200 && grazes <= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_39_straight_paths_touch_when_bisection_says),
        cmocka_unit_test(test_row_39_rotating_bodies_touch_when_small_steps_say),
        cmocka_unit_test(test_row_23_tanks_meet_at_any_speed),
        cmocka_unit_test(test_straight_bodies_in_each_other_touch_at_once_or_never),
        cmocka_unit_test(test_turning_bodies_in_touch_come_nearer_by_no_more_than_the_skin),
        cmocka_unit_test(test_turning_bodies_in_each_other_come_no_deeper),
        cmocka_unit_test(test_swapping_the_bodies_changes_only_the_normals_sign),
        cmocka_unit_test(test_the_place_and_a_common_motion_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
