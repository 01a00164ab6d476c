/* Pairs of tanks with any angles and any rates of turret and gun, against an oracle that puts each
 * vertex where it is at a time and looks only at the gap, in small sure steps. SEED=n runs another
 * set. */
#include "collider/geometry/gjk.h"
#include "collider/geometry/time_of_impact.h"

#include "tests/support/placed_hulls.h"
#include "tests/support/steps.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define PAIRS   5000
#define SLACK_M 1e-6
#define STEP    2e-4 /* of a frame, at least */

static struct fixture f;
static const struct kind *tank;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    tank = &f.view.world.kinds[fixture_kind(&f, "tank")];
    assert_int_equal(tank->part_count, HULL_PART_COUNT);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* --- the oracle --------------------------------------------------------------------------------*/

static double gap(const struct swept_body *a, const struct swept_body *b, double time)
{
    static struct placed_hulls one, other;
    struct vec3 near = path_at(&a->path, time);
    double least = INFINITY;
    placed_hulls_put(a, time, near, &one);
    placed_hulls_put(b, time, near, &other);
    for (uint32_t i = 0; i < one.hulls; i++) {
        for (uint32_t j = 0; j < other.hulls; j++)
            least = fmin(least, gjk_distance(&one.hull[i], &other.hull[j]).distance_m);
    }
    return least;
}

static double fastest(const struct swept_body *body)
{
    const struct turret_path *turret = &body->turret;
    return vec3_length(body->path.along) + rotation_rate(body->from, body->to) * body->bound_m +
           (fabs(turret->turret_turn) + fabs(turret->gun_turn)) * 2.0 * body->bound_m;
}

/* Returns a time at which the gap is surely below the skin, or INFINITY if none was found before
 * `until`. */
static double stepped(const struct swept_body *a, const struct swept_body *b, double until)
{
    double speed = fastest(a) + fastest(b), time = 0.0;
    while (time < until) {
        double over = gap(a, b, time) - (SKIN_M - SLACK_M);
        if (over <= 0.0)
            return time;
        time += fmax(over / speed, STEP);
    }
    return INFINITY;
}

/* --- pairs -------------------------------------------------------------------------------------*/

static struct swept_body any_tank(struct vec3 at, double fast, uint64_t *random)
{
    const struct world *world = &f.view.world;
    struct quat from =
        rotation_of(fixture_uniform(random, 0.0, TWO_PI), fixture_uniform(random, -0.3, 0.3),
                    fixture_uniform(random, -0.3, 0.3));
    bool moves = fixture_random(random) % 3 != 0;
    struct swept_body body = {.hull = world->hulls + tank->first_hull,
                              .hull_count = tank->hull_count,
                              .outer = world->hulls + tank->outer_hull,
                              .vertices = world->hull_vertices,
                              .planes = world->hull_planes,
                              .scale = 1.0,
                              .bound_m = tank->reach_m,
                              .path = {.at = at},
                              .from = from,
                              .to = from,
                              .turret = {.outer = world->hulls + tank->first_part_hull,
                                         .outers = tank->part_count,
                                         .turret_pivot = tank->turret_pivot,
                                         .gun_pivot = tank->gun_pivot}};
    if (moves) {
        body.path.along = vec3_scale(fixture_direction(random), fixture_uniform(random, 0.0, fast));
        body.to = rotation_spun(from, fixture_direction(random), fixture_uniform(random, 0.0, 0.5));
    }
    double low = tank->gun_low_rad, high = tank->gun_high_rad;
    double gun = fixture_uniform(random, low, high);
    turret_path_set(&body.turret, fixture_uniform(random, -PI, PI), gun,
                    fixture_uniform(random, -1.5, 1.5), fixture_uniform(random, low, high) - gun);
    return body;
}

static void check(const struct swept_body *a, const struct swept_body *b, int n, bool hit,
                  const struct hull_contact *impact)
{
    double until = hit ? impact->toi - STEP : 1.0, oracle = stepped(a, b, until);
    if (oracle < until)
        fail_msg("pair %d: missed a touch at %.17g", n, oracle);
    if (hit && fabs(gap(a, b, impact->toi) - SKIN_M) > SLACK_M)
        fail_msg("pair %d: touch at %.17g, but the gap is %g", n, impact->toi,
                 gap(a, b, impact->toi));
}

static void test_turrets_touch_when_small_steps_say(void **state)
{
    uint64_t random = fixture_seed(733);
    int hits = 0, misses = 0;
    (void)state;
    for (int n = 0; n < PAIRS; n++) {
        struct vec3 at = {25000.0, 100.0, 25000.0}, off = fixture_direction(&random);
        off.y *= 0.2;
        off = vec3_scale(off, fixture_uniform(&random, 4.0, 13.0));
        struct swept_body a = any_tank(at, 6.0, &random);
        struct swept_body b = any_tank(vec3_add(at, off), 6.0, &random);
        struct hull_contact impact, swapped;
        if (gap(&a, &b, 0.0) <= 2.0 * SKIN_M)
            continue;
        bool hit = time_of_impact_find(&a, &b, 0.0, &impact);
        check(&a, &b, n, hit, &impact);
        assert_true(time_of_impact_find(&b, &a, 0.0, &swapped) == hit);
        assert_true(!hit || swapped.toi == impact.toi);
        *(hit ? &hits : &misses) += 1;
    }
    print_message("  %d pairs touch, %d do not\n", hits, misses);
    assert_true(hits > 300 && misses > 300);
}

/* The boxes of the broad phase and the spheres around bodies hold every direction. */
static void test_no_vertex_reaches_beyond_the_bound(void **state)
{
    static struct placed_hulls placed;
    uint64_t random = fixture_seed(734);
    double most = 0.0;
    (void)state;
    for (int n = 0; n < 3000; n++) {
        struct vec3 at = {25000.0, 100.0, 25000.0};
        struct swept_body body = any_tank(at, 0.0, &random);
        placed_hulls_put(&body, fixture_uniform(&random, 0.0, 1.0), at, &placed);
        for (uint32_t h = 0; h < placed.hulls; h++) {
            for (uint32_t v = 0; v < placed.hull[h].count; v++)
                most = fmax(most, vec3_length(placed.hull[h].vertex[v]));
        }
    }
    print_message("  reach %g m, vertices up to %g m, pointing forwards %g m\n", tank->reach_m,
                  most, tank->bound_m);
    assert_true(most > tank->bound_m && most <= tank->reach_m && tank->reach_m < most + 0.6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turrets_touch_when_small_steps_say),
        cmocka_unit_test(test_no_vertex_reaches_beyond_the_bound),
    };
    return cmocka_run_group_tests(tests, open_world, close_world);
}
