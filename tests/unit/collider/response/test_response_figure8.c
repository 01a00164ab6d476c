/* Figure 8 of the thesis, branch by branch and at its borders (rows 26 to 30). */
#include "collider/response/response.h"

#include "tests/support/steps.h"
#include "world/params.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define FIGURE8 "collision = { shape = \"sphere\"; response = \"figure8\"; };\n"

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, FIGURE8 "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; },\n"
                             "            { kind = \"building\"; at = [26000.0, 25000.0]; } );\n");
    struct kind *tank = steps_kind(&f, "tank"), *jeep = steps_kind(&f, "jeep");
    tank->severe_rad = jeep->severe_rad = 5.0 * RAD_PER_DEG;
    tank->bounce_keep = jeep->bounce_keep = 0.6;
    return 0;
}

static uint32_t put(const char *kind, double x, double z, struct vec3 velocity)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, 100.0, z}, .velocity = velocity});
}

/* --- two that move: row 29 ---------------------------------------------------------------------*/

/* The response of two tanks that meet at this angle, nose to nose along x, at these speeds. */
static enum response meet(double angle_deg, double speed_a, double speed_b)
{
    struct response_context context;
    struct outcome outcome = {RESPONSE_NONE, 0.0};
    steps_empty(&f);
    uint32_t a = put("tank", 20000.0, 20000.0, (struct vec3){speed_a, 0, 0});
    uint32_t b = put("tank", 20006.0, 20000.0, (struct vec3){-speed_b, 0, 0});
    steps_kind(&f, "tank")->explosive_kg = 0.0;
    steps_respond(&f, &context);
    const struct impact impact = {.a = a,
                                  .b = b,
                                  .time = 0.5,
                                  .point = {20003.0, 100.0, 20000.0},
                                  .normal = {1.0, 0.0, 0.0},
                                  .closing_mps = speed_a + speed_b,
                                  .angle_rad = angle_deg * RAD_PER_DEG};
    response_figure8.moving(&context, &impact, &outcome);
    const struct entities *e = &context.next->entities;
    struct vec3 va = entities_velocity(e, a), vb = entities_velocity(e, b);
    bool wrecks = e->row[a].state == ENTITY_WRECK && e->row[b].state == ENTITY_WRECK;
    switch (outcome.response) {
    case RESPONSE_DESTROYED:
        assert_true(wrecks && vec3_length(va) == 0.0 && vec3_length(vb) == 0.0);
        break;
    case RESPONSE_STOP:
        assert_true(!wrecks && vec3_length(va) == 0.0 && vec3_length(vb) == 0.0);
        break;
    default: /* off each other, both slower */
        assert_int_equal(outcome.response, RESPONSE_BOUNCE);
        assert_true(va.x <= 0.0 && vb.x >= 0.0);
        assert_true(vec3_length(va) < speed_a && vec3_length(vb) < speed_b);
    }
    steps_respond_end(&context);
    return outcome.response;
}

static void test_row_29_within_five_degrees_of_a_quarter_turn_is_severe(void **state)
{
    static const double borders[] = {5, 85, 95, 175, 185, 265, 275, 355};
    (void)state;
    for (int quarter = 0; quarter < 360; quarter += 90) {
        assert_int_equal(meet(quarter, 4.0, 4.0), RESPONSE_STOP);
        assert_int_equal(meet(quarter, 10.0, 10.0), RESPONSE_DESTROYED);
        assert_int_equal(meet(quarter + 45.0, 10.0, 10.0), RESPONSE_BOUNCE);
    }
    for (size_t n = 0; n < sizeof borders / sizeof borders[0]; n++) {
        /* Even ones lie above their quarter turn, odd ones below. */
        double outwards = n % 2 == 0 ? 1.0 : -1.0;
        assert_int_equal(meet(borders[n], 4.0, 4.0), RESPONSE_STOP);
        assert_int_equal(meet(borders[n] - 0.01 * outwards, 4.0, 4.0), RESPONSE_STOP);
        assert_int_equal(meet(borders[n] + 0.01 * outwards, 4.0, 4.0), RESPONSE_BOUNCE);
        assert_int_equal(meet(borders[n], 10.0, 10.0), RESPONSE_DESTROYED);
        assert_int_equal(meet(borders[n] + 0.01 * outwards, 10.0, 10.0), RESPONSE_BOUNCE);
    }
}

static void test_row_29_fast_kills_both_and_slow_stops_both(void **state)
{
    double fast = steps_params(&f)->collision.fast_vehicle_mps;
    (void)state;
    assert_int_equal(meet(180.0, fast, fast), RESPONSE_STOP);
    assert_int_equal(meet(180.0, fast + 1e-9, 1.0), RESPONSE_DESTROYED); /* either's speed */
    assert_int_equal(meet(180.0, 1.0, fast + 1e-9), RESPONSE_DESTROYED);
}

/* The angle is the difference of headings, in whole frames as well as in the function. */
static void test_row_29_headings_give_the_angle(void **state)
{
    static const struct {
        double angle_deg;
        enum response response;
    } cases[] = {{5.0, RESPONSE_STOP},   {5.1, RESPONSE_BOUNCE},   {84.9, RESPONSE_BOUNCE},
                 {85.0, RESPONSE_STOP},  {95.0, RESPONSE_STOP},    {95.1, RESPONSE_BOUNCE},
                 {180.0, RESPONSE_STOP}, {264.9, RESPONSE_BOUNCE}, {265.0, RESPONSE_STOP},
                 {275.0, RESPONSE_STOP}, {354.9, RESPONSE_BOUNCE}, {355.0, RESPONSE_STOP}};
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        double angle = cases[n].angle_deg * RAD_PER_DEG, sine = maths_sin(angle);
        steps_empty(&f);
        /* a drives north; b, in its path, slower, at the angle to the right of it. */
        put("tank", 20000.0, 20000.0, (struct vec3){0, 0, -7.0});
        put("tank", 20000.0 - 0.01 * sine, 19993.98,
            (struct vec3){2.0 * sine, 0, -2.0 * maths_cos(angle)});
        fixture_run(&f, 1);
        const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
        assert_non_null(event);
        assert_true(fabs((double)event->collision.angle_deg - cases[n].angle_deg) < 1e-3);
        assert_int_equal(event->collision.response, cases[n].response);
    }
}

/* --- the kinds' constants ----------------------------------------------------------------------*/

struct meeting {
    enum response response;
    double speed_tank, speed_jeep;
    double harm_jeep;
    enum damage damage_jeep;
};

/* A tank and a jeep meet at this angle, nose to nose along x. */
static struct meeting mixed(double angle_deg, double speed_tank, double speed_jeep, bool swapped)
{
    struct response_context context;
    struct outcome outcome = {RESPONSE_NONE, 0.0};
    steps_empty(&f);
    uint32_t tank = put("tank", 20000.0, 20000.0, (struct vec3){speed_tank, 0, 0});
    uint32_t jeep = put("jeep", 20006.0, 20000.0, (struct vec3){-speed_jeep, 0, 0});
    steps_respond(&f, &context);
    const struct impact impact = {.a = swapped ? jeep : tank,
                                  .b = swapped ? tank : jeep,
                                  .time = 0.5,
                                  .normal = {swapped ? -1.0 : 1.0, 0.0, 0.0},
                                  .closing_mps = speed_tank + speed_jeep,
                                  .angle_rad = angle_deg * RAD_PER_DEG};
    response_figure8.moving(&context, &impact, &outcome);
    const struct entities *e = &context.next->entities;
    struct meeting met = {.response = outcome.response,
                          .speed_tank = vec3_length(entities_velocity(e, tank)),
                          .speed_jeep = vec3_length(entities_velocity(e, jeep)),
                          .harm_jeep = e->row[jeep].harm_j,
                          .damage_jeep = (enum damage)e->row[jeep].damage};
    steps_respond_end(&context);
    return met;
}

static void test_row_29_the_wider_angle_of_the_two_kinds_is_severe(void **state)
{
    (void)state;
    for (int swapped = 0; swapped < 2; swapped++) {
        steps_kind(&f, "tank")->severe_rad = 0.0;
        steps_kind(&f, "jeep")->severe_rad = 10.0 * RAD_PER_DEG;
        assert_int_equal(mixed(190.0, 4.0, 4.0, swapped).response, RESPONSE_STOP);
        assert_int_equal(mixed(190.1, 4.0, 4.0, swapped).response, RESPONSE_BOUNCE);
        steps_kind(&f, "jeep")->severe_rad = 0.0; /* exactly a quarter turn and nothing else */
        assert_int_equal(mixed(180.0, 4.0, 4.0, swapped).response, RESPONSE_STOP);
        assert_int_equal(mixed(180.1, 4.0, 4.0, swapped).response, RESPONSE_BOUNCE);
    }
}

static void test_row_29_fast_is_each_kinds_own_or_the_scenarios(void **state)
{
    double scenario = steps_params(&f)->collision.fast_vehicle_mps;
    (void)state;
    for (int swapped = 0; swapped < 2; swapped++) {
        steps_kind(&f, "tank")->fast_mps = 3.0;
        steps_kind(&f, "jeep")->fast_mps = 0.0;
        assert_int_equal(mixed(180.0, 3.0, scenario, swapped).response, RESPONSE_STOP);
        assert_int_equal(mixed(180.0, 3.01, 0.0, swapped).response, RESPONSE_DESTROYED);
        assert_int_equal(mixed(180.0, 0.0, scenario + 0.01, swapped).response, RESPONSE_DESTROYED);
        steps_kind(&f, "tank")->fast_mps = 2.0 * scenario;
        assert_int_equal(mixed(180.0, 2.0 * scenario, 0.0, swapped).response, RESPONSE_STOP);
    }
}

static void test_row_29_a_bounce_leaves_each_kind_its_share(void **state)
{
    (void)state;
    steps_kind(&f, "tank")->bounce_keep = 0.25;
    steps_kind(&f, "jeep")->bounce_keep = 1.0;
    steps_kind(&f, "jeep")->resistance_j = 1e12;
    for (int swapped = 0; swapped < 2; swapped++) {
        struct meeting met = mixed(135.0, 8.0, 6.0, swapped);
        assert_int_equal(met.response, RESPONSE_BOUNCE);
        assert_true(fabs(met.speed_tank - 2.0) < 1e-12);
        assert_true(fabs(met.speed_jeep - 6.0) < 1e-12);
    }
}

static void test_row_26_rigidity_and_moldability_decide_the_harm(void **state)
{
    static const struct {
        double rigidity, moldability, share;
    } skins[] = {{1.0, 0.0, 1.0}, {0.5, 0.0, 0.5}, {0.5, 0.5, 0.75}, {0.0, 0.0, 0.0}};
    (void)state;
    struct kind *jeep = steps_kind(&f, "jeep"), *tank = steps_kind(&f, "tank");
    jeep->resistance_j = tank->resistance_j = 1e12;
    double lost = 0.5 * 16.0 * (jeep->mass_kg + tank->mass_kg);
    double share_jeep = tank->mass_kg / (jeep->mass_kg + tank->mass_kg);
    for (size_t n = 0; n < sizeof skins / sizeof skins[0]; n++) {
        jeep->rigidity = skins[n].rigidity;
        jeep->moldability = skins[n].moldability;
        double harm = mixed(180.0, 4.0, 4.0, false).harm_jeep;
        assert_true(fabs(harm - lost * share_jeep * skins[n].share) < 1e-6);
    }
}

static void test_row_30_the_larger_mass_hurts_the_smaller_more(void **state)
{
    double before = 0.0;
    (void)state;
    for (double mass = 100.0; mass <= 1e6; mass *= 10.0) {
        struct response_context context;
        struct outcome outcome;
        steps_empty(&f);
        steps_kind(&f, "tank")->mass_kg = mass;
        steps_kind(&f, "jeep")->mass_kg = 1000.0;
        steps_kind(&f, "tank")->resistance_j = steps_kind(&f, "jeep")->resistance_j = 1e12;
        uint32_t tank = put("tank", 20000.0, 20000.0, (struct vec3){5.0, 0, 0});
        uint32_t jeep = put("jeep", 20004.6, 20000.0, (struct vec3){-5.0, 0, 0});
        steps_respond(&f, &context);
        const struct impact impact = {
            .a = tank, .b = jeep, .normal = {1, 0, 0}, .closing_mps = 10.0, .angle_rad = PI};
        response_figure8.moving(&context, &impact, &outcome);
        const struct entities *e = &context.next->entities;
        if (mass > 1000.0)
            assert_true(e->row[jeep].harm_j > e->row[tank].harm_j);
        if (mass < 1000.0)
            assert_true(e->row[jeep].harm_j < e->row[tank].harm_j);
        assert_true(e->row[jeep].harm_j > before);
        before = e->row[jeep].harm_j;
        steps_respond_end(&context);
    }
}

/* --- against fixed objects: rows 27, 28 --------------------------------------------------------*/

struct aftermath {
    enum response response;
    enum damage damage;
    enum entity_state state;
    double speed_mps, harm_j;
};

/* A body of this mass runs into the tree (0) or the building (1) at this speed. */
static struct aftermath strike(uint32_t object, double mass_kg, double speed_mps)
{
    struct response_context context;
    struct outcome outcome = {RESPONSE_NONE, 0.0};
    const struct fixed_object *fixed = &f.view.world.fixed[object];
    steps_empty(&f);
    steps_kind(&f, "tank")->mass_kg = mass_kg;
    steps_kind(&f, "tank")->resistance_j = 1e12;
    uint32_t row = put("tank", fixed->x - 3.0 - (double)fixed->radius_m, fixed->z,
                       (struct vec3){speed_mps, 0, 0});
    steps_respond(&f, &context);
    const struct impact impact = {
        .a = row, .b = object | PAIR_FIXED, .normal = {1, 0, 0}, .closing_mps = speed_mps};
    response_figure8.fixed(&context, &impact, &outcome);
    const struct entities *e = &context.next->entities;
    struct aftermath struck = {outcome.response, (enum damage)context.next->fixed_damage[object],
                               (enum entity_state)e->row[row].state,
                               vec3_length(entities_velocity(e, row)), e->row[row].harm_j};
    steps_respond_end(&context);
    return struck;
}

static void test_row_27_damage_goes_by_energy_over_resistance(void **state)
{
    const double mass = 2000.0;
    const struct collision_params *limits = &steps_params(&f)->collision;
    double resistance = steps_kind(&f, "tree")->resistance_j;
    const struct {
        double share;
        enum damage from, below;
    } borders[] = {{limits->damage_high, DAMAGE_HIGH, DAMAGE_MED},
                   {limits->damage_med, DAMAGE_MED, DAMAGE_LOW},
                   {limits->damage_low, DAMAGE_LOW, DAMAGE_NONE}};
    (void)state;
    for (int n = 0; n < 3; n++) {
        double energy = borders[n].share * resistance;
        double speed = sqrt(2.0 * energy / mass);
        assert_int_equal(strike(0, mass, speed * (1.0 + 1e-9)).damage, borders[n].from);
        assert_int_equal(strike(0, mass, speed * (1.0 - 1e-9)).damage, borders[n].below);
        /* The same energy from another mass is the same damage. */
        speed = sqrt(2.0 * energy / (8.0 * mass));
        assert_int_equal(strike(0, 8.0 * mass, speed * (1.0 + 1e-9)).damage, borders[n].from);
        assert_int_equal(strike(0, 8.0 * mass, speed * (1.0 - 1e-9)).damage, borders[n].below);
    }
}

static void test_row_27_damage_is_monotone_in_mass_and_speed(void **state)
{
    (void)state;
    for (double speed = 1.0; speed < 40.0; speed *= 1.7) {
        enum damage before = DAMAGE_NONE;
        for (double mass = 100.0; mass < 1e6; mass *= 3.0) {
            enum damage damage = strike(0, mass, speed).damage;
            assert_true(damage >= before);
            assert_true(strike(0, mass, speed * 1.3).damage >= damage);
            before = damage;
        }
    }
}

static void test_row_27_damage_by_mass_alone_as_printed(void **state)
{
    struct collision_params *limits = &steps_params(&f)->collision;
    (void)state;
    limits->measure = MEASURE_MASS;
    limits->mass_c1_kg = 40000.0;
    limits->mass_c2_kg = 10000.0;
    limits->mass_c3_kg = 2000.0;
    static const struct {
        double mass_kg;
        enum damage damage;
    } cases[] = {{57000.0, DAMAGE_HIGH}, {40000.0, DAMAGE_HIGH}, {39999.0, DAMAGE_MED},
                 {10000.0, DAMAGE_MED},  {9999.0, DAMAGE_LOW},   {2000.0, DAMAGE_LOW},
                 {1999.0, DAMAGE_NONE},  {1.0, DAMAGE_NONE}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        for (double speed = 0.5; speed < 40.0; speed *= 2.0) /* at any speed */
            assert_int_equal(strike(0, cases[n].mass_kg, speed).damage, cases[n].damage);
    }
}

/* Two of the same mass and resistance, one of them fixed, are struck by the same tank; the tree has
 * the levels of damage that bodies have. */
static void test_row_30_a_fixed_object_suffers_more_than_a_free_one(void **state)
{
    struct kind *tree = steps_kind(&f, "tree"), *jeep = steps_kind(&f, "jeep");
    int more = 0;
    (void)state;
    tree->damage_high = 0.6;
    tree->damage_med = 0.3;
    tree->damage_low = 0.1;
    jeep->rigidity = 1.0;
    jeep->explosive_kg = 0.0;
    for (double mass = 1000.0; mass < 1e6; mass *= 4.0) {
        for (double resistance = 1e3; resistance < 1e8; resistance *= 1.5) {
            tree->mass_kg = jeep->mass_kg = mass;
            tree->resistance_j = jeep->resistance_j = resistance;
            enum damage fixed = strike(0, 20000.0, 7.0).damage;
            struct meeting stop = mixed(180.0, 7.0, 0.0, false);
            struct meeting bounce = mixed(135.0, 7.0, 0.0, false);
            assert_int_equal(stop.response, RESPONSE_STOP);
            assert_int_equal(bounce.response, RESPONSE_BOUNCE);
            for (int level = DAMAGE_LOW; level <= DAMAGE_HIGH; level++)
                assert_true((int)fixed >= level || (int)stop.damage_jeep < level);
            assert_true(bounce.damage_jeep <= stop.damage_jeep);
            more += fixed > stop.damage_jeep;
        }
    }
    assert_true(more > 0);
}

static void test_row_28_large_and_fast_kills_else_it_goes_on_slowed(void **state)
{
    double fast = steps_params(&f)->collision.fast_fixed_mps;
    (void)state;
    struct aftermath struck = strike(1, 57000.0, fast + 1e-9); /* a building is large */
    assert_int_equal(struck.response, RESPONSE_DESTROYED);
    assert_int_equal(struck.state, ENTITY_WRECK);
    assert_true(struck.speed_mps == 0.0);
    struck = strike(1, 57000.0, fast);
    assert_int_equal(struck.response, RESPONSE_SLOW);
    assert_int_equal(struck.state, ENTITY_ACTIVE);
    assert_true(struck.speed_mps > 0.0 && struck.speed_mps < fast);
    struck = strike(0, 57000.0, 3.0 * fast); /* a tree is not large */
    assert_int_equal(struck.response, RESPONSE_SLOW);
    assert_int_equal(struck.state, ENTITY_ACTIVE);
    assert_true(struck.speed_mps > 0.0 && struck.speed_mps < 3.0 * fast);
}

static void test_row_28_the_heavier_the_vehicle_the_less_it_is_slowed(void **state)
{
    double kept = 0.0;
    (void)state;
    for (double mass = 100.0; mass < 1e6; mass *= 10.0) {
        double speed = strike(0, mass, 5.0).speed_mps;
        assert_true(speed > kept && speed < 5.0);
        kept = speed;
    }
}

static void test_row_32_a_vehicle_passes_through_the_tree_that_it_struck(void **state)
{
    uint32_t row = put("tank", 24980.0, 25000.0, (struct vec3){6.0, 0, 0});
    (void)state;
    fixture_run(&f, 500);
    assert_true(steps_rows(&f).row[row].x > 25010.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1); /* reported once */
    assert_int_equal(fixture_event(&f, EVENT_COLLISION, 0)->collision.response, RESPONSE_SLOW);
    assert_int_equal(fixture_event(&f, EVENT_COLLISION, 0)->collision.b.fixed, 1);
}

/* Of a long tank the gun comes first and the hull later: one passing is one collision. */
static void test_one_passing_of_a_tree_is_told_once(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "collision = { response = \"figure8\"; shape = \"model\"; };\n"
                     "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );");
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .at = {24990.0, FIXTURE_GROUND_M, 25000.3},
                                            .velocity = {3.5, 0.0, 0.0}});
    fixture_run(&f, 600);
    assert_true(steps_rows(&f).row[0].x > 25010.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_29_within_five_degrees_of_a_quarter_turn_is_severe),
        TEST(test_row_29_fast_kills_both_and_slow_stops_both),
        TEST(test_row_29_headings_give_the_angle),
        TEST(test_row_29_the_wider_angle_of_the_two_kinds_is_severe),
        TEST(test_row_29_fast_is_each_kinds_own_or_the_scenarios),
        TEST(test_row_29_a_bounce_leaves_each_kind_its_share),
        TEST(test_row_26_rigidity_and_moldability_decide_the_harm),
        TEST(test_row_30_the_larger_mass_hurts_the_smaller_more),
        TEST(test_row_27_damage_goes_by_energy_over_resistance),
        TEST(test_row_27_damage_is_monotone_in_mass_and_speed),
        TEST(test_row_27_damage_by_mass_alone_as_printed),
        TEST(test_row_30_a_fixed_object_suffers_more_than_a_free_one),
        TEST(test_row_28_large_and_fast_kills_else_it_goes_on_slowed),
        TEST(test_row_28_the_heavier_the_vehicle_the_less_it_is_slowed),
        TEST(test_row_32_a_vehicle_passes_through_the_tree_that_it_struck),
        TEST(test_one_passing_of_a_tree_is_told_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
