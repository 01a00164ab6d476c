/* The writer of a table's cells: each function writes its own cells and marks their columns in the
 * row's block alone. */
#include "world/entity/table_write.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROWS (2 * CHECKSUM_ROWS)
#define ROW  (CHECKSUM_ROWS + 7) /* in the second block */

static struct entities rows;
static uint64_t changed[2], resting[ROWS / 64], written[ROWS / 64];
static const struct table_writer writer = {&rows, changed, resting, written};

static int make(void **state)
{
    (void)state;
    void *memory = aligned_alloc(COLUMN_ALIGN, entities_bytes(ROWS));
    assert_non_null(memory);
    memset(memory, 0, entities_bytes(ROWS));
    entities_bind(&rows, ROWS, memory);
    memset(resting, 0xff, sizeof resting);
    return 0;
}

static int release(void **state)
{
    (void)state;
    free(rows.x);
    return 0;
}

/* Returns the columns marked since the last call; those of the other block must be none. The row
 * that was written rests no more, and all others do; it is noted, and no other is. */
static uint64_t marked(void)
{
    uint64_t columns = changed[1];
    assert_true(changed[0] == 0);
    for (uint32_t word = 0; word < ROWS / 64; word++) {
        assert_true(written[word] == (word == ROW / 64 ? (uint64_t)1 << ROW % 64 : 0));
        assert_true(resting[word] == ~written[word]);
    }
    memset(resting, 0xff, sizeof resting);
    memset(written, 0, sizeof written);
    changed[1] = 0;
    return columns;
}

static void test_a_setter_writes_one_cell_and_marks_one_column(void **state)
{
    (void)state;
#define X(type, name)                                                                              \
    table_set_##name(&writer, ROW, (type)3);                                                       \
    assert_true(rows.name[ROW] == (type)3);                                                        \
    assert_true(rows.name[ROW - 1] == (type)0 && rows.name[ROW + 1] == (type)0);                   \
    assert_true(marked() == COLUMN_BIT(name));
    ENTITY_COLUMNS(X)
#undef X
}

static void test_sets_of_columns_are_written_together(void **state)
{
    (void)state;
    table_set_position(&writer, ROW, (struct vec3){1.0, 2.0, 3.0});
    assert_true(marked() == (COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z)));
    table_set_velocity(&writer, ROW, (struct vec3){4.0, 5.0, 6.0});
    assert_true(marked() == (COLUMN_BIT(vx) | COLUMN_BIT(vy) | COLUMN_BIT(vz)));
    table_set_spin(&writer, ROW, (struct vec3){7.0, 8.0, 9.0});
    assert_true(marked() == (COLUMN_BIT(spin_x) | COLUMN_BIT(spin_y) | COLUMN_BIT(spin_z)));
    table_set_target(&writer, ROW, 10, 11);
    assert_true(marked() == (COLUMN_BIT(target_slot) | COLUMN_BIT(target_id)));
    table_set_threat(&writer, ROW, 12, 13);
    assert_true(marked() == (COLUMN_BIT(threat_slot) | COLUMN_BIT(threat_id)));
    assert_true(rows.x[ROW] == 1.0 && rows.y[ROW] == 2.0 && rows.z[ROW] == 3.0);
    assert_true(rows.vx[ROW] == 4.0 && rows.vy[ROW] == 5.0 && rows.vz[ROW] == 6.0);
    assert_true(rows.spin_x[ROW] == 7.0 && rows.spin_y[ROW] == 8.0 && rows.spin_z[ROW] == 9.0);
    assert_true(rows.target_slot[ROW] == 10 && rows.target_id[ROW] == 11);
    assert_true(rows.threat_slot[ROW] == 12 && rows.threat_id[ROW] == 13);
}

static void test_a_cleared_row_is_zero_and_marked_in_every_column(void **state)
{
    (void)state;
    table_set_rounds(&writer, ROW, 5);
    table_clear_row(&writer, ROW);
    assert_int_equal(rows.rounds[ROW], 0);
    assert_true(marked() == COLUMNS_ALL);
    table_row_changes(&writer, ROW);
    assert_true(marked() == COLUMNS_ALL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_setter_writes_one_cell_and_marks_one_column, make,
                                        release),
        cmocka_unit_test_setup_teardown(test_sets_of_columns_are_written_together, make, release),
        cmocka_unit_test_setup_teardown(test_a_cleared_row_is_zero_and_marked_in_every_column, make,
                                        release),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
