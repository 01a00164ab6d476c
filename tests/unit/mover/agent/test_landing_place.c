/* Helicopters that are rearmed set down at their base, where that is clear, and take off again. */
#include "mover/agent/landing_place.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define HZ     20
#define COUNT  4u
#define SHARED 64u /* ids that differ by this many have the same first place */

static struct fixture f;

/* objects: a group of the scenario, or "". */
static void open_with(const char *objects)
{
    static char text[42000];
    snprintf(text, sizeof text,
             "world = { seed = 5; capacity = 64; hz = 20.0; };"
             "collision = { shape = \"model\"; };"
             "bases = ( { force = \"blue\"; at = [25000.0, 25000.0]; } );%s"
             "vehicles = ( { kind = \"helicopter\"; count = 4; force = \"blue\"; engage = \"free\";"
             "  behaviour = \"patrol\"; area = [26000.0, 24500.0, 27000.0, 25500.0]; } );",
             objects);
    fixture_open(&f, text);
}

/* What the helicopters did while they were rearmed. */
struct stay {
    uint32_t landed, rearmed;
    double away_m; /* of one that stood, from the base at most */
};

/* Lets the helicopters in the rows 0, step ... fire all they have, and waits until they patrol
 * again. */
static struct stay watch(uint32_t step)
{
    struct stay stay = {0};
    bool stood[COUNT] = {false}, back[COUNT] = {false};
    for (uint32_t n = 0; n < COUNT; n++)
        steps_rows(&f).row[n * step].rounds = 0;
    for (int frame = 0; frame < 260 * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t n = 0; n < COUNT; n++) {
            uint32_t i = n * step;
            assert_int_equal(e.row[i].state, ENTITY_ACTIVE);
            assert_int_equal(e.row[i].damage, DAMAGE_NONE);
            if (e.row[i].flags & ENTITY_FLAG_LANDED && steps_speed(&f, i) == 0.0) {
                double dx = e.row[i].x - 25000.0, dz = e.row[i].z - 25000.0;
                stood[n] = true;
                stay.away_m = maths_max(stay.away_m, sqrt(dx * dx + dz * dz));
            }
            back[n] = e.row[i].behaviour == BEHAVIOUR_PATROL && e.row[i].rounds > 0 &&
                      !(e.row[i].flags & ENTITY_FLAG_LANDED) &&
                      e.row[i].y > steps_ground_at(&f, e.row[i].x, e.row[i].z) + 20.0;
        }
    }
    for (uint32_t n = 0; n < COUNT; n++) {
        stay.landed += stood[n];
        stay.rearmed += back[n];
    }
    return stay;
}

static void test_they_land_at_their_base_and_take_off(void **state)
{
    (void)state;
    open_with("");
    struct stay stay = watch(1);
    print_message("%u of %u landed, %.0f m from the base at most; %u are on patrol again\n",
                  stay.landed, COUNT, stay.away_m, stay.rearmed);
    assert_true(stay.landed == COUNT && stay.rearmed == COUNT && stay.away_m < 150.0);
}

/* Places are 40 to 80 m from the base. */
static void test_they_hover_where_trees_stand(void **state)
{
    static char objects[40000];
    int length = snprintf(objects, sizeof objects, "objects = (");
    (void)state;
    for (int n = 0; n < 20 * 20; n++)
        length += snprintf(objects + length, sizeof objects - (size_t)length,
                           "%s{ kind = \"tree\"; at = [%d.0, %d.0]; }", n ? "," : "",
                           24905 + n % 20 * 10, 24905 + n / 20 * 10);
    snprintf(objects + length, sizeof objects - (size_t)length, ");");
    open_with(objects);
    struct stay stay = watch(1);
    assert_true(stay.landed == 0 && stay.rearmed == COUNT);
}

/* Before, the first took the place, and the others were rearmed in the air over it. */
static void test_they_do_not_wait_for_a_place_that_they_share(void **state)
{
    static const char group[] =
        "%s{ kind = \"helicopter\"; force = \"blue\"; engage = \"free\"; behaviour = \"patrol\";"
        "   area = [26000.0, 24500.0, 27000.0, 25500.0]; },"
        " { kind = \"truck\"; count = 63; behaviour = \"idle\"; area = [1000.0, 1000.0, 5000.0, "
        "5000.0]; }";
    char text[1600];
    int length =
        snprintf(text, sizeof text,
                 "world = { seed = 5; capacity = 512; hz = 20.0; };"
                 "collision = { shape = \"model\"; };"
                 "bases = ( { force = \"blue\"; at = [25000.0, 25000.0]; } ); vehicles = (");
    (void)state;
    for (uint32_t n = 0; n < COUNT; n++)
        length += snprintf(text + length, sizeof text - (size_t)length, group, n ? ", " : "");
    snprintf(text + length, sizeof text - (size_t)length, ");");
    fixture_open(&f, text);
    struct stay stay = watch(SHARED);
    print_message("%u of %u landed\n", stay.landed, COUNT);
    assert_true(stay.landed == COUNT && stay.rearmed == COUNT);
}

static bool clear_at(double slope, const char *below)
{
    struct step_context step;
    struct serial_context context;
    steps_empty(&f);
    steps_plane(&f, slope, 0.0);
    uint32_t row = fixture_put(
        &f, (struct fixture_entity){.kind = "helicopter", .at = {25000.0, 160.0, 25000.0}});
    if (below)
        fixture_put(&f, (struct fixture_entity){.kind = below, .at = {25004.0, 100.0, 25000.0}});
    fixture_run(&f, 1); /* which finds the neighbours */
    steps_serial_context(&f, &step, &context);
    return landing_place_is_clear(&step, row);
}

static void test_a_place_is_level_dry_and_empty(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    assert_true(clear_at(0.0, NULL) && clear_at(0.15, NULL));
    assert_false(clear_at(0.2, NULL));
    assert_false(clear_at(-0.2, NULL));
    assert_false(clear_at(0.0, "tank"));
    steps_cover(&f, COVER_LAKE, 24800.0, 24800.0, 25200.0, 25200.0);
    assert_false(clear_at(0.0, NULL));
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, NULL, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_they_land_at_their_base_and_take_off),
        TEST(test_they_hover_where_trees_stand),
        TEST(test_they_do_not_wait_for_a_place_that_they_share),
        TEST(test_a_place_is_level_dry_and_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
