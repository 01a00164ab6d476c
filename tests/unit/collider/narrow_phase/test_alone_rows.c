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

/* Returns true if the row's box meets that of another row, or of a fixed object. */
static bool has_company(const struct fixture *f, uint32_t row)
{
    const struct state state = fixture_state(f);
    const struct broad_phase *broad = &f->stepper.collider.broad;
    const struct world *world = &f->view.world;
    for (uint32_t other = 0; other < state.head->used; other++) {
        if (other != row && pair_filter_boxes_meet(&broad->box[row], &broad->box[other]))
            return true;
    }
    for (uint32_t object = 0; object < world->counts.fixed; object++) {
        const struct path_box box = pair_filter_fixed_box(world, &world->fixed[object]);
        if (pair_filter_boxes_meet(&broad->box[row], &box))
            return true;
    }
    return false;
}

/* Rows next to each other, next to a tree, and alone; and a crowd on any number of threads. */
static void agree(uint32_t threads)
{
    struct fixture f;
    uint32_t alone = 0, rows = 0;
    fixture_open(
        &f, "world = { seed = 3; capacity = 1024; cruise = false; }; collision = { shape "
            "= \"model\"; }; terrain = { source = \"flat\"; height_m = 100.0; }; "
            "objects = ( { kind = \"tree\"; at = [21000.0, 21004.0]; } );"
            "vehicles = (" GROUP("tank", 300)
                GROUP("jeep",
                      300) "{ kind = \"tank\"; behaviour = \"idle\"; at = [20000.0, 20000.0]; },"
                           "{ kind = \"tank\"; behaviour = \"idle\"; at = [20000.0, 20008.0]; },"
                           "{ kind = \"tank\"; behaviour = \"idle\"; at = [21000.0, 21000.0]; },"
                           "{ kind = \"tank\"; behaviour = \"idle\"; at = [22000.0, 22000.0]; });");
    fixture_threads(&f, threads);
    fixture_continue(&f, 1);
    const bool *is_alone = f.stepper.collider.contacts.alone.alone;
    rows = fixture_state(&f).head->used;
    for (uint32_t row = 0; row < rows; row++) {
        assert_int_equal(is_alone[row], !has_company(&f, row));
        alone += is_alone[row];
    }
    print_message("%u of %u rows are alone\n", alone, rows);
    assert_true(alone > rows / 4 && alone < rows - rows / 8);
    assert_false(is_alone[rows - 4] || is_alone[rows - 3] || is_alone[rows - 2]);
    assert_true(is_alone[rows - 1]);
    fixture_close(&f);
}

static void test_they_are_those_whose_boxes_meet_no_other(void **state)
{
    (void)state;
    for (uint32_t threads = 1; threads <= 3; threads++)
        agree(threads);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_they_are_those_whose_boxes_meet_no_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
