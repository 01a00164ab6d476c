/* Ground marks: no crater and no debris is missed, and other squares have no mark. */
#include "mover/query/ground_marks.h"

#include "tests/support/steps.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct ground_marks marks;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"building\"; at = [25003.0, 25060.0]; },\n"
                     "            { kind = \"tree\"; at = [30060.0, 30060.0]; } );\n");
    return ground_marks_init(&marks, &f.view.world);
}

static int close_world(void **state)
{
    (void)state;
    ground_marks_free(&marks);
    fixture_close(&f);
    return 0;
}

static struct state update(void)
{
    struct state now = fixture_state(&f);
    ground_marks_update(&marks, &f.view.world, &now);
    return now;
}

static void dig(double x, double z, float radius_m)
{
    struct state now = fixture_state(&f);
    now.craters[now.head->crater_count++] = (struct crater){x, z, radius_m, 1.0f, 1};
}

static uint32_t marked(uint8_t mark)
{
    uint32_t count = 0;
    for (int32_t row = 0; row < GRIDSQUARES_DEFAULT.per_side; row++) {
        for (int32_t column = 0; column < GRIDSQUARES_DEFAULT.per_side; column++)
            count += (ground_marks_at(&marks, (column + 0.5) * GRIDSQUARE_LEAST_M,
                                      (row + 0.5) * GRIDSQUARE_LEAST_M) &
                      mark) != 0;
    }
    return count;
}

static void test_a_quiet_world_has_none(void **state)
{
    (void)state;
    update();
    assert_int_equal(marked(GROUND_MARKS_DEBRIS | GROUND_MARKS_CRATER), 0);
}

static void test_what_fell_is_where_it_reaches(void **state)
{
    (void)state;
    struct state now = fixture_state(&f);
    bool building = f.view.world.fixed[0].x < 26000.0;
    now.fixed_damage[building ? 0 : 1] = DAMAGE_MED; /* it still stands */
    update();
    assert_int_equal(marked(GROUND_MARKS_DEBRIS), 0);
    now.fixed_damage[building ? 0 : 1] = DAMAGE_HIGH;
    update();
    assert_int_equal(ground_marks_at(&marks, 25003.0, 25060.0), GROUND_MARKS_DEBRIS);
    assert_int_equal(ground_marks_at(&marks, 24999.0, 25060.0),
                     GROUND_MARKS_DEBRIS); /* over the border */
    assert_int_equal(marked(GROUND_MARKS_DEBRIS), 2);
    now.fixed_damage[building ? 1 : 0] = DAMAGE_DESTROYED;
    update();
    assert_int_equal(ground_marks_at(&marks, 30060.0, 30060.0), GROUND_MARKS_DEBRIS);
    assert_int_equal(marked(GROUND_MARKS_DEBRIS), 3);
}

static void test_another_worlds_past_is_forgotten(void **state)
{
    (void)state;
    struct state now = fixture_state(&f);
    now.fixed_damage[0] = DAMAGE_HIGH;
    dig(20060.0, 20060.0, 3.0f);
    dig(21060.0, 21060.0, 3.0f);
    update();
    assert_int_equal(marked(GROUND_MARKS_CRATER), 2);
    now.head->crater_count = 1;
    update();
    assert_int_equal(marked(GROUND_MARKS_CRATER), 1);
    assert_true(marked(GROUND_MARKS_DEBRIS) > 0);
    now.fixed_damage[0] = DAMAGE_NONE;
    update();
    assert_int_equal(marked(GROUND_MARKS_DEBRIS), 0);
    assert_int_equal(marked(GROUND_MARKS_CRATER), 1);
}

/* Wherever the ground is another one within reach of a place, its square says so. */
static void test_no_crater_is_missed(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    for (int i = 0; i < 20; i++) {
        dig(fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M),
            fixture_uniform(&random, 0.0, WORLD_SIDE_DEFAULT_M),
            (float)fixture_uniform(&random, 0.5, 30.0));
        update();
    }
    fixture_state(&f).fixed_damage[0] = fixture_state(&f).fixed_damage[1] = DAMAGE_HIGH;
    struct state now = update();
    crater_index_update(&f.stepper.mover.craters, now.head->crater_count);
    uint32_t found = 0;
    for (int i = 0; i < 200000; i++) {
        const struct crater *crater = &now.craters[i % 20];
        double x = crater->x + fixture_uniform(&random, -80.0, 80.0);
        double z = crater->z + fixture_uniform(&random, -80.0, 80.0);
        double turn = fixture_uniform(&random, 0.0, TWO_PI);
        double there =
            crater_offset(&f.stepper.mover.craters, x + GROUND_MARKS_NEAR_M * maths_sin(turn),
                          z + GROUND_MARKS_NEAR_M * maths_cos(turn));
        if (there != 0.0) {
            assert_true(ground_marks_at(&marks, x, z) & GROUND_MARKS_CRATER);
            found++;
        }
    }
    assert_true(found > 1000);
    for (int i = 0; i < 20000; i++) { /* eight places at once are eight times one */
        union simd_lanes x, z;
        union lane_masks crater, debris;
        for (int l = 0; l < LANE_COUNT; l++) {
            const struct crater *by = &now.craters[(i + l) % 20];
            x.lane[l] = l % 3 ? by->x + fixture_uniform(&random, -200.0, 200.0)
                              : fixture_uniform(&random, -300.0, WORLD_SIDE_DEFAULT_M + 300.0);
            z.lane[l] = l % 4 ? by->z + fixture_uniform(&random, -200.0, 200.0)
                              : GRIDSQUARE_LEAST_M * (double)(fixture_random(&random) % 401);
        }
        ground_marks_find(&marks, &x, &z, &crater, &debris);
        for (int l = 0; l < LANE_COUNT; l++) {
            uint8_t there = ground_marks_at(&marks, x.lane[l], z.lane[l]);
            assert_int_equal(crater.lane[l], there & GROUND_MARKS_CRATER ? -1 : 0);
            assert_int_equal(debris.lane[l], there & GROUND_MARKS_DEBRIS ? -1 : 0);
        }
    }
    assert_true(marked(GROUND_MARKS_CRATER) < 20 * 4 + 1);
}

static void test_a_box_has_the_marks_of_its_squares(void **state)
{
    (void)state;
    struct gridsquare_box with =
        gridsquare_box_of(&GRIDSQUARES_DEFAULT, 19000.0, 20000.0, 20000.0, 20000.0);
    struct gridsquare_box without =
        gridsquare_box_of(&GRIDSQUARES_DEFAULT, 19000.0, 20000.0, 19800.0, 20000.0);
    assert_false(ground_marks_within(&marks, with, GROUND_MARKS_CRATER));
    dig(20000.0, 20000.0, 2.0f);
    update();
    assert_true(ground_marks_within(&marks, with, GROUND_MARKS_CRATER));
    assert_false(ground_marks_within(&marks, with, GROUND_MARKS_DEBRIS));
    assert_false(ground_marks_within(&marks, without, GROUND_MARKS_CRATER));
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_a_quiet_world_has_none),
        TEST(test_what_fell_is_where_it_reaches),
        TEST(test_another_worlds_past_is_forgotten),
        TEST(test_no_crater_is_missed),
        TEST(test_a_box_has_the_marks_of_its_squares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
