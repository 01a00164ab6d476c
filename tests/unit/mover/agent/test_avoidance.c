/* Avoidance of woods, other vehicles, water and steep ground, on any number of threads. */
#include "tests/support/steps.h"
#include "world/entity/kind.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define HZ    20
#define TREES 80

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    return 0;
}

/* A patrol that goes to a point and no other. */
static uint32_t send(const char *kind, double x, double z, double goal_x, double goal_z)
{
    double heading = maths_heading(goal_x - x, goal_z - z);
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {x, FIXTURE_GROUND_M, z},
                                                           .heading_rad = heading,
                                                           .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = goal_x;
    e.row[row].goal_z = goal_z;
    return row;
}

/* A wood of trees 14 m apart or more, over 300 m of the way from west to east. */
static void plant(uint64_t *random)
{
    static char text[TREES * 80 + 256];
    double x[TREES], z[TREES];
    int length =
        snprintf(text, sizeof text, "world = { seed = 1; capacity = 64; hz = 20.0; }; objects = (");
    for (int n = 0; n < TREES;) {
        x[n] = fixture_uniform(random, 25050.0, 25350.0);
        z[n] = fixture_uniform(random, 24900.0, 25100.0);
        bool apart = true;
        for (int o = 0; o < n; o++)
            apart &= (x[n] - x[o]) * (x[n] - x[o]) + (z[n] - z[o]) * (z[n] - z[o]) > 14.0 * 14.0;
        if (!apart)
            continue;
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "%s{ kind = \"tree\"; at = [%.2f, %.2f]; }", n ? "," : "", x[n], z[n]);
        n++;
    }
    snprintf(text + length, sizeof text - (size_t)length, ");");
    fixture_close(&f);
    fixture_open(&f, text);
}

static void test_a_wood_is_crossed(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "carrier"};
    uint64_t random = fixture_seed(12);
    int crossed = 0, hits = 0;
    (void)state;
    for (int n = 0; n < 12; n++) {
        plant(&random);
        uint32_t row = send(kinds[n % 3], 25000.0, fixture_uniform(&random, 24930.0, 25070.0),
                            25420.0, 25000.0);
        for (int frame = 0; frame < 120 * HZ && steps_rows(&f).row[row].x < 25380.0; frame++)
            fixture_run(&f, 1);
        crossed += steps_rows(&f).row[row].x >= 25380.0;
        hits += (int)fixture_event_count(&f, EVENT_COLLISION);
    }
    print_message("%d of 12 crossed, %d trees hit\n", crossed, hits);
    assert_true(crossed >= 11 && hits <= 1); /* some thickets are too narrow to turn in */
}

/* Rows of houses 16 m long on both sides of a street, their roofs 7 m from its middle, and more
 * settings. */
static void open_street(bool outlines, const char *more)
{
    char text[4096];
    int length = snprintf(text, sizeof text,
                          "world = { seed = 1; capacity = 64; hz = 20.0; };"
                          "collision = { shape = \"model\"; }; objects = (");
    for (int n = 0; n < 24; n++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "%s{ kind = \"building\"; at = [%d.0, %.1f]; heading_deg = %d.0; }",
                           n ? "," : "", 25060 + n / 2 * 18, 25000.0 + (n % 2 ? 13.0 : -13.0),
                           n % 2 ? 90 : 270);
    snprintf(text + length, sizeof text - (size_t)length, "); %s", more);
    fixture_close(&f);
    fixture_open(&f, text);
    uint16_t kind = kind_find(f.view.world.kinds, f.view.world.counts.kinds, "building");
    ((struct kind *)(uintptr_t)f.view.world.kinds)[kind].outline = outlines;
}

/* Sends a tank along the street for 40 s. Returns how far it gets from its middle, to the sides
 * [m].
 */
static double drive_along(double *gets_m)
{
    uint32_t row = send("tank", 25000.0, 25000.0, 25600.0, 25000.0);
    double aside = 0.0;
    for (int frame = 0; frame < 40 * HZ; frame++) {
        fixture_run(&f, 1);
        aside = maths_max(aside, fabs(steps_rows(&f).row[row].z - 25000.0));
    }
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    *gets_m = steps_rows(&f).row[row].x - 25000.0;
    return aside;
}

/* A house is a rectangle, with an outline or not: a disc around it would reach over the street. */
static void test_a_street_between_houses_is_free(void **state)
{
    (void)state;
    for (int outlines = 0; outlines < 2; outlines++) {
        double gets_m;
        open_street(outlines == 1, "");
        assert_true(drive_along(&gets_m) < 2.0);
        assert_true(gets_m > 400.0);
    }
}

/* A tank that is told to face a house beside the street rolls to a stop along the street before it
 * turns. */
static void test_it_stops_in_a_street_before_it_turns(void **state)
{
    (void)state;
    open_street(true,
                "scripts = ( { name = \"s\"; steps = ( { go = [25600.0, 25000.0]; speed_mps = "
                "15.0; }, { at_s = 12.0; face_deg = 180.0; } ); } ); vehicles = ( { kind = "
                "\"tank\"; at = [25000.0, 25000.0]; heading_deg = 90.0; script = \"s\"; } );");
    fixture_run(&f, 12 * HZ - 1);
    assert_true(steps_speed(&f, 0) > 10.0);
    fixture_run(&f, 10 * HZ);
    assert_true(fabs(maths_wrap_half(steps_rows(&f).row[0].heading - PI)) < 0.05);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

/* A tank's gun reaches 1.8 m further than its hull, to wherever it points. */
static void test_the_gun_does_not_touch_a_house(void **state)
{
    (void)state;
    for (int n = 0; n < 4; n++) {
        fixture_close(&f);
        fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };"
                         "collision = { shape = \"model\"; }; objects = ("
                         "{ kind = \"building\"; at = [25080.0, 24987.6]; heading_deg = 270.0; },"
                         "{ kind = \"building\"; at = [25080.0, 25012.4]; heading_deg = 90.0; },"
                         "{ kind = \"building\"; at = [25150.0, 25000.0]; heading_deg = 0.0; });");
        uint16_t kind = kind_find(f.view.world.kinds, f.view.world.counts.kinds, "building");
        ((struct kind *)(uintptr_t)f.view.world.kinds)[kind].outline = true;
        uint32_t row = send("tank", 25000.0, 25000.0, 25400.0, 25000.0);
        steps_rows(&f).row[row].turret = (float)(0.5 * PI * n);
        for (int frame = 0; frame < 20 * HZ; frame++) {
            steps_rows(&f).row[row].turret = (float)(maths_wrap_half(0.5 * PI * n));
            fixture_run(&f, 1);
        }
        print_message("gun %d degrees off: at x = %.1f\n", 90 * n, steps_rows(&f).row[row].x);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    }
}

/* On a slope of 10 % another vehicle is further below than it is high, from 40 m on. */
static double slope(double x, double z, const void *context)
{
    (void)context;
    (void)z;
    return 100.0 - 0.1 * (x - 25000.0);
}

static void test_it_sees_one_that_stands_down_the_slope(void **state)
{
    (void)state;
    steps_ground(&f, slope, NULL);
    fixture_threads(&f, 1);
    fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {25200.0, 80.0, 25000.0}});
    uint32_t row = send("truck", 25000.0, 25000.0, 25500.0, 25000.0);
    while (steps_rows(&f).row[row].dodge == 0.0f && steps_rows(&f).row[row].x < 25190.0)
        fixture_run(&f, 1);
    print_message("goes around it from %.0f m on\n", 25200.0 - steps_rows(&f).row[row].x);
    assert_true(steps_rows(&f).row[row].x < 25140.0);
    fixture_run(&f, 20 * HZ);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

static void test_head_on_they_pass_each_other_on_the_right(void **state)
{
    (void)state;
    for (double course = 0.0; course < TWO_PI; course += 0.7) {
        double sine = maths_sin(course), cosine = -maths_cos(course);
        steps_empty(&f);
        uint32_t a = send("truck", 25000.0 - 200.0 * sine, 25000.0 - 200.0 * cosine,
                          25000.0 + 400.0 * sine, 25000.0 + 400.0 * cosine);
        uint32_t b = send("truck", 25000.0 + 200.0 * sine, 25000.0 + 200.0 * cosine,
                          25000.0 - 400.0 * sine, 25000.0 - 400.0 * cosine);
        double least = 1e9, right[2] = {0.0, 0.0};
        for (int frame = 0; frame < 30 * HZ; frame++) {
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            double dx = e.row[a].x - e.row[b].x, dz = e.row[a].z - e.row[b].z;
            if (sqrt(dx * dx + dz * dz) < least) {
                least = sqrt(dx * dx + dz * dz);
                right[0] = -(e.row[a].x - 25000.0) * cosine + (e.row[a].z - 25000.0) * sine;
                right[1] = (e.row[b].x - 25000.0) * cosine - (e.row[b].z - 25000.0) * sine;
            }
        }
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        assert_true(least > 5.0 && right[0] > 0.0 && right[1] > 0.0);
    }
}

static void test_crossing_traffic_does_not_meet(void **state)
{
    uint64_t random = fixture_seed(3);
    int collisions = 0, crossings = 0;
    (void)state;
    for (int n = 0; n < 40; n++) {
        double course = fixture_uniform(&random, 0.3, PI),
               late = fixture_uniform(&random, -20.0, 20.0);
        double sine = maths_sin(course), cosine = -maths_cos(course);
        steps_empty(&f);
        send("tank", 25000.0, 25150.0 + late, 25000.0, 24400.0);
        send("tank", 25000.0 - 150.0 * sine, 25000.0 - 150.0 * cosine, 25000.0 + 600.0 * sine,
             25000.0 + 600.0 * cosine);
        fixture_run(&f, 30 * HZ);
        collisions += (int)fixture_event_count(&f, EVENT_COLLISION);
        crossings++;
    }
    print_message("%d collisions in %d crossings\n", collisions, crossings);
    assert_true(collisions <= 1);
}

/* Digs a crater with the shape of those of explosions. */
static void dig(double x, double z, double radius_m)
{
    struct state now = fixture_state(&f);
    struct crater *craters = (struct crater *)(uintptr_t)now.craters;
    struct state_head *head = (struct state_head *)(uintptr_t)now.head;
    craters[head->crater_count++] = (struct crater){.x = x,
                                                    .z = z,
                                                    .radius_m = (float)radius_m,
                                                    .depth_m = (float)(0.4 * radius_m),
                                                    .frame = 1};
}

/* Sends a vehicle 200 m to the east. Returns how near its middle comes to a place there [m]. */
static double passes_at(const char *kind, double x, double z)
{
    uint32_t row = send(kind, 25000.0, 25000.0, 25260.0, 25000.0);
    double least = INFINITY;
    for (int frame = 0; frame < 60 * HZ && steps_rows(&f).row[row].x < 25200.0; frame++) {
        fixture_run(&f, 1);
        const struct entities e = steps_rows(&f);
        const double dx = e.row[row].x - x, dz = e.row[row].z - z;
        least = maths_min(least, sqrt(dx * dx + dz * dz));
    }
    assert_true(steps_rows(&f).row[row].x >= 25200.0);
    return least;
}

static void test_a_crater_is_crossed_or_gone_around(void **state)
{
    static const struct {
        const char *kind;
        double radius_m;
        bool crosses;
    } cases[] = {{"jeep", 1.1, true},  {"jeep", 2.1, false},  {"jeep", 4.9, false},
                 {"truck", 1.1, true}, {"truck", 3.0, false}, {"tank", 2.1, true},
                 {"tank", 4.9, false}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        fixture_close(&f);
        open_world(state);
        dig(25100.0, 25000.5, cases[n].radius_m);
        double least = passes_at(cases[n].kind, 25100.0, 25000.5);
        print_message("%s, crater of %.1f m: %.1f m from its middle\n", cases[n].kind,
                      cases[n].radius_m, least);
        assert_true(cases[n].crosses ? least < 1.0 : least > cases[n].radius_m + 0.7);
    }
}

/* Jeeps crossed fields of craters at full speed, fell into them and turned over. */
static void test_nobody_turns_over_in_a_field_of_craters(void **state)
{
    enum { JEEPS = 6, ROUNDS = 4, CRATERS = 40 };
    uint64_t random = fixture_seed(15);
    int through = 0;
    for (int round = 0; round < ROUNDS; round++) {
        uint32_t row[JEEPS];
        double farthest[JEEPS] = {0.0};
        fixture_close(&f);
        open_world(state);
        for (int n = 0; n < CRATERS; n++)
            dig(fixture_uniform(&random, 25050.0, 25250.0),
                fixture_uniform(&random, 24900.0, 25100.0), fixture_uniform(&random, 2.0, 3.2));
        for (int n = 0; n < JEEPS; n++)
            row[n] = send("jeep", 25000.0, 24925.0 + 30.0 * n, 25420.0, 24925.0 + 30.0 * n);
        for (int second = 0; second < 60; second++) {
            fixture_run(&f, HZ);
            for (int n = 0; n < JEEPS; n++)
                farthest[n] = maths_max(farthest[n], steps_rows(&f).row[row[n]].x);
        }
        for (int n = 0; n < JEEPS; n++) {
            assert_int_equal(steps_rows(&f).row[row[n]].state, ENTITY_ACTIVE);
            through += farthest[n] > 25300.0;
        }
    }
    print_message("%d of %d through\n", through, ROUNDS * JEEPS);
    assert_true(through >= ROUNDS * JEEPS - 1);
}

/* It is ordered into a lake. Where it turns towards the water too fast for its brakes, it stops in
 * it as far out as it can ford. */
static void test_it_stops_before_obstacles_that_it_cannot_pass(void **state)
{
    const double fords_m = steps_kind(&f, "jeep")->ford_m / 0.05;
    (void)state;
    steps_cover(&f, COVER_LAKE, 25125.0, 0.0, 50000.0, 50000.0); /* from x = 25062.5 on */
    uint32_t row = send("jeep", 24900.0, 25000.0, 25400.0, 25000.0);
    for (int frame = 0; frame < 30 * HZ; frame++) {
        struct entities e = steps_rows(&f);
        e.row[row].goal_x = 25400.0;
        e.row[row].goal_z = 25000.0;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_true(e.row[row].x < 25062.5 + fords_m);
        assert_true(e.row[row].ease >= 0.0f && e.row[row].ease <= 1.0f);
    }
}

/* A row of parked tanks stands across the way of two that go around it, one of which may cross the
 * way of the other. */
static void test_nobody_rams_a_row_of_parked_friends(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "carrier", "truck"};
    uint64_t random = fixture_seed(14);
    int hits = 0;
    double hardest = 0.0;
    (void)state;
    for (int round = 0; round < 48; round++) {
        steps_empty(&f);
        for (int n = 0; n < 9; n++)
            fixture_put(
                &f, (struct fixture_entity){.kind = "tank",
                                            .at = {25200.0, FIXTURE_GROUND_M, 24960.0 + 9.0 * n}});
        double z = fixture_uniform(&random, 24950.0, 25045.0);
        send(kinds[round % 4], 25000.0, z, 25400.0, z);
        z = fixture_uniform(&random, 24950.0, 25045.0);
        send(kinds[round / 4 % 4], 24960.0, z, 25400.0, z);
        for (int frame = 0; frame < 45 * HZ; frame++) {
            fixture_run(&f, 1);
            for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++) {
                const struct event *event = fixture_event(&f, EVENT_COLLISION, n);
                hits++;
                hardest = maths_max(hardest, (double)event->collision.closing_mps);
            }
        }
    }
    print_message("48 rounds: %d collisions, the hardest at %.1f m/s\n", hits, hardest);
    assert_true(hardest < 1.0);
}

/* Two on routes go around the same end of the row, and the first crosses the way of the second. */
static void test_who_must_give_way_does_not_turn_into_a_parked_friend(void **state)
{
    static char text[1600];
    int length = snprintf(text, sizeof text,
                          "world = { seed = 77; capacity = 64; hz = 60.0; };\n"
                          "terrain = { source = \"flat\"; height_m = 100.0; }; vehicles = (");
    (void)state;
    for (int n = 0; n < 9; n++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "{ kind = \"tank\"; at = [31200.0, %d.0]; behaviour = \"idle\"; },\n",
                           24960 + 9 * n);
    for (int n = 0; n < 2; n++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "{ kind = \"%s\"; at = [31000.0, %d.0]; heading_deg = 90.0;"
                           " route = ([31000.0, %d.0], [31400.0, %d.0]); }%s\n",
                           n ? "tank" : "jeep", 24996 + 9 * n, 24996 + 9 * n, 24996 + 9 * n,
                           n ? ");" : ",");
    fixture_close(&f);
    fixture_open(&f, text);
    fixture_run(&f, 60 * 60);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

/* A plateau whose eastern side falls by 50 degrees. */
static double plateau(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 400.0 - 1.2 * maths_clamp(x - 25000.0, 0.0, 300.0);
}

static void test_nobody_drives_down_a_mountain_side(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "truck", "carrier"};
    uint32_t row[4];
    (void)state;
    steps_ground(&f, plateau, NULL);
    fixture_threads(&f, 1);
    for (int n = 0; n < 4; n++) {
        row[n] = send(kinds[n], 24800.0, 24700.0 + 200.0 * n, 25600.0, 24700.0 + 200.0 * n);
        steps_rows(&f).row[row[n]].y = 400.0;
    }
    for (int frame = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        for (int n = 0; n < 4; n++)
            assert_true(steps_rows(&f).row[row[n]].x < 25005.0);
    }
}

#define HILL_SLOPE  0.55  /* a tangent: 29 degrees, which a tank climbs */
#define RIDGE_SLOPE 0.5   /* 27 degrees */
#define HILL_M      200.0 /* from its foot to its top */
#define FOOT_M      100.0 /* on which it becomes as steep */

/* Returns how high a hill with this slope is there, so far from its foot. */
static double hill_of(double slope, double in_m)
{
    double foot_m = maths_clamp(in_m, 0.0, FOOT_M);
    return slope * (0.5 * foot_m * foot_m / FOOT_M + maths_max(0.0, in_m - FOOT_M));
}

/* A round hill at 25400, 25010, and a kilometre further a ridge across the map. */
static double hill_and_ridge(double x, double z, const void *context)
{
    double away_m = sqrt((x - 25400.0) * (x - 25400.0) + (z - 25010.0) * (z - 25010.0));
    (void)context;
    return 100.0 + hill_of(HILL_SLOPE, HILL_M - away_m) +
           hill_of(RIDGE_SLOPE, HILL_M - fabs(x - 26400.0));
}

static void test_a_patrol_goes_around_a_steep_hill_and_over_a_steep_ridge(void **state)
{
    double highest_m = 0.0;
    (void)state;
    steps_ground(&f, hill_and_ridge, NULL);
    fixture_threads(&f, 1);
    uint32_t row = send("tank", 25000.0, 25000.0, 27000.0, 25000.0);
    for (int frame = 0; frame < 300 * HZ && steps_rows(&f).row[row].x < 26800.0; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        if (e.row[row].x < 25800.0)
            highest_m = maths_max(highest_m, e.row[row].y - 100.0);
    }
    print_message("it was %.1f m high on a hill of %.0f m\n", highest_m,
                  hill_of(HILL_SLOPE, HILL_M));
    assert_true(highest_m < 0.5 * hill_of(HILL_SLOPE, HILL_M));
    assert_true(steps_rows(&f).row[row].x > 26800.0);
}

/* Trucks and two others drive up a valley in the White Mountains to a bank of 36 degrees, 10 m
 * wide. They looked at the ground half of their horizon away, which is 44 m; when all of that was
 * too steep, they crept on, onto the bank, and turned over. */
static void test_a_patrol_turns_aside_before_a_bank(void **state)
{
    static const char *const kinds[] = {"truck", "hamburger", "attack-tomato"};
    static char text[512];
    (void)state;
    snprintf(text, sizeof text,
             "world = { seed = 1; capacity = 64; hz = 20.0; };"
             "terrain = { source = \"file\"; file = \"%s/grounds/white-mountains.ground\"; };",
             fixture_shipped_dir());
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        fixture_close(&f);
        fixture_open(&f, text);
        uint32_t row = send(kinds[n], 22695.0, 24402.0, 21710.0, 24228.0);
        struct entities e = steps_rows(&f);
        double most = 0.0;
        e.row[row].y = steps_ground_at(&f, e.row[row].x, e.row[row].z);
        for (int frame = 0; frame < 60 * HZ; frame++) {
            fixture_run(&f, 1);
            e = steps_rows(&f);
            most = maths_max(most, maths_max(fabs(e.row[row].pitch), fabs(e.row[row].roll)));
        }
        print_message("%s leans by up to %.0f degrees\n", kinds[n], most * DEG_PER_RAD);
        assert_int_equal(e.row[row].state, ENTITY_ACTIVE);
        assert_true(most < 33.0 * RAD_PER_DEG);
    }
}

/* Two ridges across the way to the east, as steep as 60 degrees. */
static double ridges(double x, double z, const void *context)
{
    double at = maths_min(fabs(x - 25750.0), fabs(x - 26750.0 - 0.5 * (z - 25000.0)));
    (void)context;
    return 100.0 + maths_max(0.0, 430.0 - 1.7 * at);
}

/* As hulls: the box with which a sphere's world touches the ground reaches further. */
static void test_aircraft_slow_down_for_ridges_that_they_have_to_climb(void **state)
{
    static const char *const kinds[] = {"helicopter", "helo-cow", "wishbone", "helicopter"};
    uint32_t row[4];
    bool over[4] = {false};
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };"
                     "collision = { shape = \"model\"; };");
    steps_ground(&f, ridges, NULL);
    fixture_threads(&f, 1);
    for (int n = 0; n < 4; n++)
        row[n] = send(kinds[n], 25000.0, 24700.0 + 200.0 * n, 28000.0, 24000.0 + 700.0 * n);
    for (int n = 0; n < 4; n++)
        steps_rows(&f).row[row[n]].y = 130.0;
    for (int frame = 0; frame < 240 * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (int n = 0; n < 4; n++) {
            assert_true(e.row[row[n]].state == ENTITY_ACTIVE);
            over[n] |= e.row[row[n]].x > 27400.0;
        }
    }
    assert_true(over[0] && over[1] && over[2] && over[3]);
}

/* It rises to the west as steeply as a helicopter climbs, and to the north more so. */
static double corner(double x, double z, const void *context)
{
    (void)context;
    return 100.0 + maths_clamp(0.2 * (25300.0 - x), 0.0, 300.0) +
           maths_clamp(0.7 * (25000.0 - z), 0.0, 400.0);
}

/* Its goal is behind it, and the shorter turn leads over the steep side. */
static void test_a_helicopter_slows_down_before_it_turns_over_a_slope(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };"
                     "collision = { shape = \"model\"; };");
    steps_ground(&f, corner, NULL);
    fixture_threads(&f, 1);
    uint32_t row = send("helicopter", 25000.0, 25000.0, 28000.0, 24950.0);
    struct entities e = steps_rows(&f);
    e.row[row].y = 160.0 + 45.0;
    e.row[row].vx = -56.0;
    e.row[row].vy = 11.0;
    e.row[row].heading = 1.5 * PI;
    for (int frame = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        if (steps_rows(&f).row[row].damage != DAMAGE_NONE)
            fail_msg("it strikes the ground after %.1f s", frame / (double)HZ);
    }
    assert_true(steps_rows(&f).row[row].x > 26000.0); /* on its way */
}

static void test_a_driver_is_left_alone(void **state)
{
    uint32_t row = send("tank", 25000.0, 25000.0, 25500.0, 25000.0);
    (void)state;
    fixture_put(
        &f, (struct fixture_entity){.kind = "truck", .at = {25060.0, FIXTURE_GROUND_M, 25000.0}});
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    fixture_run(&f, 10 * HZ);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
    assert_true(steps_rows(&f).row[row].dodge == 0.0f && steps_rows(&f).row[row].ease == 0.0f);
}

static uint64_t crowd(uint32_t threads)
{
    uint64_t random = 99;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    fixture_threads(&f, threads);
    for (int n = 0; n < 40; n++)
        send(n % 2 ? "jeep" : "helicopter", fixture_uniform(&random, 24900.0, 25100.0),
             fixture_uniform(&random, 24900.0, 25100.0), 25000.0, 25000.0);
    fixture_run(&f, 20 * HZ);
    return fixture_digest(&f);
}

static void test_the_same_on_any_number_of_threads(void **state)
{
    uint64_t one = crowd(1);
    (void)state;
    assert_true(crowd(2) == one && crowd(3) == one);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_wood_is_crossed),
        TEST(test_a_street_between_houses_is_free),
        TEST(test_it_stops_in_a_street_before_it_turns),
        TEST(test_the_gun_does_not_touch_a_house),
        TEST(test_it_sees_one_that_stands_down_the_slope),
        TEST(test_head_on_they_pass_each_other_on_the_right),
        TEST(test_crossing_traffic_does_not_meet),
        TEST(test_a_crater_is_crossed_or_gone_around),
        TEST(test_nobody_turns_over_in_a_field_of_craters),
        TEST(test_it_stops_before_obstacles_that_it_cannot_pass),
        TEST(test_nobody_rams_a_row_of_parked_friends),
        TEST(test_who_must_give_way_does_not_turn_into_a_parked_friend),
        TEST(test_nobody_drives_down_a_mountain_side),
        TEST(test_a_patrol_goes_around_a_steep_hill_and_over_a_steep_ridge),
        TEST(test_a_patrol_turns_aside_before_a_bank),
        TEST(test_aircraft_slow_down_for_ridges_that_they_have_to_climb),
        TEST(test_a_helicopter_slows_down_before_it_turns_over_a_slope),
        TEST(test_a_driver_is_left_alone),
        TEST(test_the_same_on_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
