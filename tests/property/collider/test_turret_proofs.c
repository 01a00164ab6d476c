/* What boxes and planes rule out for bodies whose turrets point anywhere and turn, against the
 * distances of all hulls at many times of the frame. SEED=n tries other pairs. */
#include "collider/geometry/box_view.h"
#include "collider/geometry/gjk.h"
#include "collider/geometry/time_of_impact.h"
#include "collider/narrow_phase/separating_axis.h"

#include "tests/support/placed_hulls.h"
#include "tests/support/fixture.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define PAIRS 4000
#define TIMES 17 /* at which the hulls are looked at */

static const char *const kinds[] = {"tank", "carrier", "jeep"};

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static double uniform(uint64_t *random, double low, double high)
{
    return fixture_uniform(random, low, high);
}

/* Makes turret and gun point somewhere, and mostly stay there, as in the frame's first stage. */
static void aim(struct swept_body *body, const struct kind *kind, uint64_t *random)
{
    double rate = fixture_random(random) % 3 != 0 ? 0.0 : uniform(random, 0.0, 1.5);
    if (rate > 0.0)
        body->to = body->from; /* so that nothing but the turret's own turn widens its boxes */
    body->turret.outer = f.view.world.hulls + kind->first_part_hull;
    body->turret.outers = kind->part_count;
    body->turret.turret_pivot = kind->turret_pivot;
    body->turret.gun_pivot = kind->gun_pivot;
    body->bound_m = kind->reach_m;
    turret_path_set(&body->turret, uniform(random, -PI, PI),
                    uniform(random, kind->gun_low_rad, 0.5 * kind->gun_high_rad),
                    uniform(random, -rate, rate), uniform(random, 0.0, 0.2 * rate));
}

/* Returns a body of some kind, three of four with its turret turned. */
static struct swept_body any_body(struct vec3 at, uint64_t *random)
{
    const struct world *world = &f.view.world;
    const struct kind *kind = &world->kinds[fixture_kind(&f, kinds[fixture_random(random) % 3])];
    struct quat from = rotation_of(uniform(random, 0.0, TWO_PI), uniform(random, -0.3, 0.3),
                                   uniform(random, -0.3, 0.3));
    double far = fixture_random(random) % 2 ? 0.3 : 4.0, turn = 0.1 * far;
    struct vec3 spin = vec3_scale(fixture_direction(random), uniform(random, 0.0, turn));
    struct swept_body body = {
        .hull = world->hulls + kind->first_hull,
        .hull_count = kind->hull_count,
        .outer = world->hulls + kind->outer_hull,
        .vertices = world->hull_vertices,
        .planes = world->hull_planes,
        .scale = 1.0,
        .bound_m = kind->bound_m,
        .path = {.at = at,
                 .along = vec3_scale(fixture_direction(random), uniform(random, 0.0, far))},
        .from = from,
        .to = rotation_spun(from, spin, 1.0)};
    if (fixture_random(random) % 4 != 0)
        aim(&body, kind, random);
    return body;
}

/* --- the oracle --------------------------------------------------------------------------------*/

/* Returns the pairs of hulls that touch at any of the times, by bits like box_view_near(). */
static uint64_t touching(const struct swept_body *a, const struct swept_body *b)
{
    static struct placed_hulls one, other;
    uint64_t touch = 0;
    for (int n = 0; n < TIMES; n++) {
        double time = (double)n / (TIMES - 1);
        placed_hulls_put(a, time, a->path.at, &one);
        placed_hulls_put(b, time, a->path.at, &other);
        for (uint32_t i = 0; i < a->hull_count; i++) {
            for (uint32_t j = 0; j < b->hull_count; j++) {
                if (gjk_distance(&one.hull[i], &other.hull[j]).distance_m <= SKIN_M)
                    touch |= 1ull << (HULLS_A_MODEL * i + j);
            }
        }
    }
    return touch;
}

/* --- what is ruled out -------------------------------------------------------------------------*/

static uint64_t near_of(const struct swept_body *a, const struct swept_body *b)
{
    struct mat3 turn_a = rotation_matrix(a->from), turn_b = rotation_matrix(b->from);
    struct vec3 way = vec3_sub(b->path.along, a->path.along);
    double turned =
        rotation_rate(a->from, a->to) * a->bound_m + rotation_rate(b->from, b->to) * b->bound_m;
    struct box_view view =
        box_view_swept(&turn_a, &turn_b, vec3_sub(b->path.at, a->path.at), way, SKIN_M + turned);
    return box_view_near(&view, a, b);
}

static bool plane_between(const struct swept_body *a, const struct swept_body *b)
{
    struct vec3 axis = {0.0, 0.0, 0.0};
    double apart;
    struct axis_side side_a, side_b;
    axis_side_set(&side_a, a, rotation_rate(a->from, a->to), 0.0);
    axis_side_set(&side_b, b, rotation_rate(b->from, b->to), 0.0);
    return separating_axis_find(&side_a, &side_b, SKIN_M, true, &axis, &apart);
}

/* How many of the pairs of bodies, and of their hulls, are far, and how many are ruled out. */
struct figures {
    uint32_t far, excluded, proved, far_hulls, ruled_out;
};

static void check(const struct swept_body *a, const struct swept_body *b, struct figures *figures)
{
    uint64_t near = near_of(a, b), touch = touching(a, b);
    bool excluded = time_of_impact_excluded(a, b, 0.0), proved = plane_between(a, b);
    uint32_t pairs = a->hull_count * b->hull_count;
    assert_true((touch & ~near) == 0);
    assert_false(touch != 0 && (excluded || proved));
    figures->far += touch == 0;
    figures->excluded += excluded;
    figures->proved += proved;
    figures->far_hulls += pairs - (uint32_t)__builtin_popcountll(touch);
    figures->ruled_out += pairs - (uint32_t)__builtin_popcountll(near);
}

static void test_what_is_ruled_out_stays_far(void **state)
{
    uint64_t random = fixture_seed(744);
    struct figures figures = {0};
    (void)state;
    for (int n = 0; n < PAIRS; n++) {
        struct vec3 at = {25000.0, 100.0, 25000.0}, off = fixture_direction(&random);
        off.y *= 0.2;
        off = vec3_scale(off, uniform(&random, 3.0, 13.0));
        struct swept_body a = any_body(at, &random);
        struct swept_body b = any_body(vec3_add(at, off), &random);
        check(&a, &b, &figures);
    }
    print_message("  of %d pairs %u are far: boxes show %u, planes %u; of %u far hulls boxes show "
                  "%u\n",
                  PAIRS, figures.far, figures.excluded, figures.proved, figures.far_hulls,
                  figures.ruled_out);
    assert_true(figures.far > PAIRS / 4 && figures.far < 3 * PAIRS / 4);
    assert_true(figures.excluded > figures.far / 3 && figures.proved > figures.far / 3);
    assert_true(figures.ruled_out > figures.far_hulls / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_ruled_out_stays_far),
    };
    return cmocka_run_group_tests(tests, open_world, close_world);
}
