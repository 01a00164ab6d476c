/* Aircraft keep apart: head on, in a crowd, over their base; and from the ground. */
#include "mover/agent/aircraft_separation.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 20

#define BESIDE_M 20.0 /* two that pass so far from each other need not be above each other */

static struct fixture f;

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static uint32_t send(const char *kind, struct vec3 from, double heading)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind, .at = from, .heading_rad = heading});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = from.x + 6000.0 * maths_sin(heading);
    e.row[row].goal_z = from.z - 6000.0 * maths_cos(heading);
    double speed = 0.75 * steps_kind(&f, kind)->max_speed_mps;
    e.row[row].vx = speed * maths_sin(heading);
    e.row[row].vz = -speed * maths_cos(heading);
    return row;
}

/* Two aircraft of a kind whose courses cross at an angle meet at one point, at one height. */
static void cross(const char *kind, double angle)
{
    double usual = steps_kind(&f, kind)->cruise_altitude_m;
    double way = 10.0 * 0.75 * steps_kind(&f, kind)->max_speed_mps, least = 1e9, apart = 0.0;
    steps_empty(&f);
    uint32_t a = send(kind, (struct vec3){25000.0, FIXTURE_GROUND_M + usual, 25000.0 + way}, 0.0);
    uint32_t b = send(kind,
                      (struct vec3){25000.0 - way * maths_sin(angle), FIXTURE_GROUND_M + usual,
                                    25000.0 + way * maths_cos(angle)},
                      angle);
    for (int frame = 0; frame < 20 * HZ; frame++) {
        fixture_run(&f, 1);
        struct vec3 off = vec3_sub(steps_position(&f, a), steps_position(&f, b));
        if (vec3_length(off) < least) {
            least = vec3_length(off);
            apart = fabs(off.y);
        }
    }
    double size = steps_kind(&f, kind)->radius_m;
    bool beside = least > 2.0 * size + BESIDE_M;
    if (!(least > 2.0 * size && (beside || apart > 0.5 * steps_kind(&f, kind)->height_m + 4.0)))
        fail_msg(
            "two of the kind %s that cross at %.1f rad pass at %.1f m, %.1f m above each other",
            kind, angle, least, apart);
}

static void test_two_that_meet_pass_above_and_below(void **state)
{
    static const char *const kinds[] = {"jet", "helicopter", "wishbone", "helo-cow"};
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    for (int n = 0; n < 4; n++) {
        for (double angle = 0.4; angle <= PI + 1e-6; angle += (PI - 0.4) / 4.0)
            cross(kinds[n], angle);
    }
}

static void test_a_crowd_on_patrol_does_not_collide(void **state)
{
    (void)state;
    fixture_open(
        &f,
        "world = { seed = 1; capacity = 64; hz = 20.0; }; vehicles = (\n"
        "{ kind = \"wishbone\"; count = 15; area = [25000.0, 25000.0, 25500.0, 25500.0]; },\n"
        "{ kind = \"jet\"; count = 8; area = [20000.0, 20000.0, 24000.0, 24000.0]; },\n"
        "{ kind = \"helicopter\"; count = 12; area = [25600.0, 25000.0, 26300.0, 25700.0]; } );");
    fixture_run(&f, 300 * HZ);
    assert_in_range(fixture_state(&f).head->tally.collisions, 0, 1);
}

/* Where three are above each other, the middle one has the other two in its way. */
static void test_a_dense_herd_does_not_collide(void **state)
{
    (void)state;
    unsigned long long collisions = 0;
    for (int seed = 1; seed <= 6; seed++) {
        char text[512];
        snprintf(
            text, sizeof text,
            "world = { seed = %d; capacity = 64; hz = 20.0; }; vehicles = (\n"
            "{ kind = \"helo-cow\"; count = 25; area = [25000.0, 25000.0, 25700.0, 25700.0]; },\n"
            "{ kind = \"wishbone\"; count = 15; area = [26000.0, 25000.0, 26500.0, 25500.0]; } );",
            seed);
        fixture_open(&f, text);
        fixture_run(&f, 300 * HZ);
        unsigned long long found = fixture_state(&f).head->tally.collisions;
        print_message("seed %d: %llu collisions\n", seed, found);
        collisions += found;
        fixture_close(&f);
    }
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    assert_int_equal(collisions, 0);
}

/* Two fly past each other because one turns away. Rolls it out, they meet. */
static void test_one_that_may_roll_out_of_its_turn_is_kept_from(void **state)
{
    (void)state;
    uint32_t row[2];
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    for (int n = 0; n < 2; n++)
        row[n] = fixture_put(
            &f, (struct fixture_entity){.kind = "helicopter",
                                        .at = {25000.0 + 100.0 * n, 147.0 + n, 25000.0 + 30.0 * n},
                                        .velocity = {n == 0 ? 30.0 : -30.0, 0.0, 0.0},
                                        .heading_rad = n == 0 ? HALF_PI : 3.0 * HALF_PI,
                                        .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    for (int n = 0; n < 2; n++) {
        e.row[row[n]].behaviour = e.row[row[n]].order = BEHAVIOUR_PATROL;
        e.row[row[n]].goal_x = n == 0 ? 27000.0 : 23000.0;
        e.row[row[n]].goal_z = n == 0 ? 25000.0 : 26000.0;
    }
    e.row[row[1]].roll = -1.0f;
    fixture_run(&f, 8);
    assert_true(steps_rows(&f).row[row[1]].climb > 0.0f);
}

/* Of two that are lower than usual, the lower one does not climb towards the other to be as high as
 * usual. */
static void test_who_is_below_another_does_not_climb(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    uint32_t low =
        send("helicopter", (struct vec3){25000.0, FIXTURE_GROUND_M + 17.0, 25100.0}, 0.0);
    (void)send("helicopter", (struct vec3){25000.0, FIXTURE_GROUND_M + 28.0, 24900.0}, PI);
    double highest = 0.0;
    for (int frame = 0; frame < 2 * HZ; frame++) {
        fixture_run(&f, 1);
        highest = maths_max(highest, steps_position(&f, low).y - FIXTURE_GROUND_M);
    }
    print_message("the lower one flies up to %.1f m\n", highest);
    assert_true(highest < 19.0);
}

static double least_gap(uint32_t first, uint32_t end)
{
    struct entities e = steps_rows(&f);
    double least = INFINITY;
    for (uint32_t a = first; a < end; a++) {
        for (uint32_t b = a + 1; b < end; b++)
            least = maths_min(least, hypot(e.row[a].x - e.row[b].x, e.row[a].z - e.row[b].z));
    }
    return least;
}

/* Aircraft that are out of rounds fly home, circle or hover there until they have them, and leave.
 */
static void test_those_at_their_base_do_not_collide(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; }; vehicles = (\n"
                     "{ kind = \"jet\"; count = 8; force = \"blue\"; area = [20000.0, 20000.0, "
                     "24000.0, 24000.0]; },\n"
                     "{ kind = \"helicopter\"; count = 14; force = \"blue\"; area = [26000.0, "
                     "25000.0, 27000.0, 26000.0]; } );");
    struct entities e = steps_rows(&f);
    for (uint32_t row = 0; row < 22; row++)
        e.row[row].rounds = 0;
    fixture_run(&f, 100 * HZ);
    for (uint32_t row = 0; row < 22; row++)
        assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_RESUPPLY);
    assert_true(least_gap(8, 22) > 20.0); /* of the helicopters */
    fixture_run(&f, 240 * HZ);
    /* Setting down on the base counts as a contact with the ground. */
    for (uint32_t row = 0; row < 22; row++)
        assert_int_equal(steps_rows(&f).row[row].damage, DAMAGE_NONE);
}

#define RING 12u

static double least_goal_gap(uint32_t count)
{
    struct entities e = steps_rows(&f);
    double least = INFINITY;
    for (uint32_t a = 0; a < count; a++) {
        for (uint32_t b = 0; b < a; b++)
            least = maths_min(
                least, hypot(e.row[a].goal_x - e.row[b].goal_x, e.row[a].goal_z - e.row[b].goal_z));
    }
    return least;
}

/* Helicopters that scripts send home come from all sides at the same time. Each has a place of its
 * own from the beginning, and lands there. */
static void test_those_ordered_home_at_once_do_not_meet(void **state)
{
    static char text[4000];
    (void)state;
    int at = snprintf(text, sizeof text,
                      "world = { seed = 1; capacity = 64; hz = 20.0; };"
                      "collision = { shape = \"model\"; };"
                      "bases = ( { force = \"blue\"; at = [25000.0, 25000.0]; } );"
                      "scripts = ( { name = \"home\";"
                      " steps = ( { behaviour = \"withdraw\"; } ); } );"
                      "vehicles = (");
    for (uint32_t n = 0; n < RING; n++)
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "%s{ kind = \"helicopter\"; force = \"blue\"; script = \"home\";"
                       " at = [%.3f, %.3f]; }",
                       n ? ", " : "", 25000.0 + 1500.0 * maths_sin(TWO_PI * n / RING),
                       25000.0 - 1500.0 * maths_cos(TWO_PI * n / RING));
    (void)snprintf(text + at, sizeof text - (size_t)at, ");");
    fixture_open(&f, text);
    fixture_run(&f, HZ);
    assert_true(least_goal_gap(RING) > 30.0);
    fixture_run(&f, 89 * HZ);
    for (uint32_t row = 0; row < RING; row++) {
        assert_int_equal(steps_rows(&f).row[row].damage, DAMAGE_NONE);
        assert_true(steps_rows(&f).row[row].flags & ENTITY_FLAG_LANDED);
    }
}

/* The lower of two jets over rising ground climbs later, while the ground leaves it time: the other
 * is above it. */
static void test_a_jet_does_not_climb_into_another_for_the_ground(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    steps_plane(&f, 0.08, 0.0);
    uint32_t low = send("jet", (struct vec3){25000.0, 400.0, 25000.0}, HALF_PI);
    uint32_t high = send("jet", (struct vec3){25000.0, 418.0, 25005.0}, HALF_PI);
    double fastest = -INFINITY;
    for (int frame = 0; frame < HZ; frame++) {
        fixture_run(&f, 1);
        fastest = maths_max(fastest, steps_velocity(&f, low).y);
    }
    print_message("the lower one climbs by up to %.1f m/s, the higher one by %.1f m/s\n", fastest,
                  steps_velocity(&f, high).y);
    assert_true(fastest < 5.0);
    steps_rows(&f).row[high].state = ENTITY_FREE;
    fixture_run(&f, 2 * HZ);
    assert_true(steps_velocity(&f, low).y > 8.0);
}

#define ROUGH_JETS 40u

/* Valleys between plateaus 800 m higher, whose walls of 50 degrees are steeper than any jet climbs.
 */
static double plateaus(double x, double z, const void *context)
{
    (void)context;
    double across = fabs(fmod(x + 0.3 * z, 6000.0) - 3000.0);
    return 200.0 + maths_clamp(1.2 * (across - 1200.0), 0.0, 800.0);
}

static void put_idle(const char *kind, uint64_t *random, double low_mps, double high_mps)
{
    double x = fixture_uniform(random, 20000.0, 30000.0);
    double z = fixture_uniform(random, 20000.0, 30000.0);
    double heading = fixture_uniform(random, 0.0, TWO_PI);
    double speed = fixture_uniform(random, low_mps, high_mps);
    double over = fixture_uniform(random, 500.0, 4000.0);
    struct fixture_entity entity = {
        .kind = kind,
        .at = {x, steps_ground_at(&f, x, z) + over, z},
        .velocity = {speed * maths_sin(heading), 0.0, -speed * maths_cos(heading)},
        .heading_rad = heading};
    uint32_t row = fixture_put(&f, entity);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
}

/* Without an order jets circle, helicopters hover. None comes near the ground, wherever and however
 * fast it was when its order ended. */
static void test_idle_aircraft_fly_on_over_mountains(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    steps_ground(&f, plateaus, NULL);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        uint64_t random = fixture_seed(seed);
        double lowest[2] = {INFINITY, INFINITY}, farthest = 0.0, from_x[ROUGH_JETS],
               from_z[ROUGH_JETS];
        steps_empty(&f);
        for (uint32_t n = 0; n < ROUGH_JETS; n++) {
            put_idle(n % 5 ? "jet" : "helicopter", &random, n % 5 ? 75.0 : 0.0,
                     n % 5 ? 277.0 : 70.0);
            from_x[n] = steps_rows(&f).row[n].x;
            from_z[n] = steps_rows(&f).row[n].z;
        }
        for (int frame = 0; frame < 240 * HZ; frame++) {
            fixture_run(&f, 1);
            for (uint32_t n = 0; n < ROUGH_JETS; n++) {
                struct vec3 at = steps_position(&f, n);
                double over = at.y - steps_ground_at(&f, at.x, at.z);
                lowest[n % 5 == 0] = maths_min(lowest[n % 5 == 0], over);
                farthest = maths_max(farthest, hypot(at.x - from_x[n], at.z - from_z[n]));
            }
        }
        print_message("over the ground: jets %.0f m or more, helicopters %.0f m; %.0f m away\n",
                      lowest[0], lowest[1], farthest);
        assert_true(lowest[0] > 60.0 && lowest[1] > 20.0 && farthest < 12000.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_two_that_meet_pass_above_and_below, close_world),
        cmocka_unit_test_teardown(test_a_crowd_on_patrol_does_not_collide, close_world),
        cmocka_unit_test_teardown(test_a_dense_herd_does_not_collide, close_world),
        cmocka_unit_test_teardown(test_one_that_may_roll_out_of_its_turn_is_kept_from, close_world),
        cmocka_unit_test_teardown(test_who_is_below_another_does_not_climb, close_world),
        cmocka_unit_test_teardown(test_those_at_their_base_do_not_collide, close_world),
        cmocka_unit_test_teardown(test_those_ordered_home_at_once_do_not_meet, close_world),
        cmocka_unit_test_teardown(test_a_jet_does_not_climb_into_another_for_the_ground,
                                  close_world),
        cmocka_unit_test_teardown(test_idle_aircraft_fly_on_over_mountains, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
