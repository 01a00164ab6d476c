/* Which bodies have nothing near them in the first frame, beside a comparison of all boxes. */
#include "collider/narrow_phase/alone_rows.h"

#include "collider/broad_phase/broad_phase.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define GROUP(kind, n)                                                                             \
    "{ kind = \"" kind "\"; count = " #n "; behaviour = \"patrol\"; "                              \
    "area = [24800.0, 24800.0, 25300.0, 25300.0]; },"

#define STANDING_LAST(at) "{ kind = \"tank\"; behaviour = \"idle\"; at = " at "; }"
#define STANDING(at)      STANDING_LAST(at) ", "

#define TREE(at) "{ kind = \"tree\"; at = " at "; }"

#define WIDE(kind, behaviour, n)                                                                   \
    "{ kind = \"" kind "\"; count = " #n "; behaviour = \"" behaviour "\"; "                       \
    "area = [24200.0, 24200.0, 25800.0, 25800.0]; },"

#define CROWD(cruise)                                                                              \
    "world = { seed = 4; capacity = 4096; cruise = " cruise                                        \
    "; }; collision = { shape = \"model\"; };"                                                     \
    "terrain = { source = \"flat\"; height_m = 100.0; };"                                          \
    "objects = (" TREE("[24500.0, 24500.0]") ", " TREE("[25000.0, 25000.0]") ", " TREE(            \
        "[25300.0, 24750.0]") ", " TREE("[25500.0, 25625.0]") ");"                                 \
                                                              "vehicles = (" WIDE("tank",          \
                                                                                  "patrol", 1200)  \
                                                                  WIDE("jeep", "idle",             \
                                                                       1200) "{ kind = "           \
                                                                             "\"helicopter\"; "    \
                                                                             "count = 100; "       \
                                                                             "behaviour = "        \
                                                                             "\"patrol\"; "        \
                                                                             "altitude_m = 30.0; " \
                                                                             "area = [24200.0, "   \
                                                                             "24200.0, 25800.0, "  \
                                                                             "25800.0]; } );"

/* Returns true if the row's box meets that of another row, or of a fixed object. */
static bool has_company(const struct fixture *f, const struct path_box *boxes, uint32_t row)
{
    const struct state state = fixture_state(f);
    const struct world *world = &f->view.world;
    for (uint32_t other = 0; other < state.head->used; other++) {
        if (other != row && pair_filter_boxes_meet(&boxes[row], &boxes[other]))
            return true;
    }
    for (uint32_t object = 0; object < world->counts.fixed; object++) {
        const struct path_box box = pair_filter_fixed_box(world, &world->fixed[object]);
        if (pair_filter_boxes_meet(&boxes[row], &box))
            return true;
    }
    return false;
}

/* Compares all rows of a world that has begun, on so many threads. Returns how many are alone. */
static uint32_t agree(struct fixture *f, uint32_t threads)
{
    uint32_t alone = 0;
    fixture_threads(f, threads);
    fixture_continue(f, 1);
    const bool *is_alone = f->stepper.collider.contacts.alone.alone;
    const uint32_t rows = fixture_state(f).head->used;
    for (uint32_t row = 0; row < rows; row++) {
        assert_int_equal(is_alone[row], !has_company(f, f->stepper.collider.broad.box, row));
        alone += is_alone[row];
    }
    print_message("%u of %u rows are alone\n", alone, rows);
    assert_true(alone > rows / 4 && alone < rows - rows / 8);
    return rows;
}

/* Rows next to each other, next to a tree, and alone; and a crowd on any number of threads. */
static void test_they_are_those_whose_boxes_meet_no_other(void **state)
{
    (void)state;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        struct fixture f;
        fixture_open(
            &f, "world = { seed = 3; capacity = 1024; cruise = false; }; collision = { shape "
                "= \"model\"; }; terrain = { source = \"flat\"; height_m = 100.0; }; "
                "objects = ( { kind = \"tree\"; at = [21000.0, 21004.0]; } );"
                "vehicles = (" GROUP("tank", 300) GROUP("jeep", 300) STANDING("[20000.0, 20000.0]")
                    STANDING("[20000.0, 20008.0]") STANDING("[21000.0, 21000.0]")
                        STANDING_LAST("[22000.0, 22000.0]") ");");
        const uint32_t rows = agree(&f, threads);
        const bool *is_alone = f.stepper.collider.contacts.alone.alone;
        assert_false(is_alone[rows - 4] || is_alone[rows - 3] || is_alone[rows - 2]);
        assert_true(is_alone[rows - 1]);
        fixture_close(&f);
    }
}

/* So many that their records are compared at first: on the ground and in the air, near trees, over
 * several strips, standing and moving. */
static void test_so_are_those_of_a_large_crowd(void **state)
{
    (void)state;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        struct fixture f;
        fixture_open(&f, CROWD("false"));
        (void)agree(&f, threads);
        assert_true(f.stepper.collider.broad.index.built);
        fixture_close(&f);
    }
}

/* Where rows cruise, the broad phase has the boxes of their stretches, which are larger. */
static void test_nobody_is_alone_with_another_one_where_rows_cruise(void **state)
{
    static struct path_box box[4096];
    struct fixture f;
    uint32_t alone = 0;
    (void)state;
    fixture_open(&f, CROWD("true"));
    fixture_continue(&f, 1);
    const struct body_motion *motion = &f.stepper.collider.motion;
    const uint32_t rows = fixture_state(&f).head->used;
    for (uint32_t row = 0; row < rows; row++) {
        const struct kind *kind = &f.view.world.kinds[motion->next->entities.row[row].kind];
        const struct path path = body_motion_path(motion, row);
        box[row] = pair_filter_path_box(&path, pair_filter_margin(&f.view.world, kind));
    }
    for (uint32_t row = 0; row < rows; row++) {
        bool is_alone = f.stepper.collider.contacts.alone.alone[row];
        assert_false(is_alone && has_company(&f, box, row));
        alone += is_alone;
    }
    assert_true(alone > rows / 4 && alone < rows - rows / 8);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_they_are_those_whose_boxes_meet_no_other),
        cmocka_unit_test(test_so_are_those_of_a_large_crowd),
        cmocka_unit_test(test_nobody_is_alone_with_another_one_where_rows_cruise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
