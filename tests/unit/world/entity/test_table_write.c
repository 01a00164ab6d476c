/* The writer of a table's rows: each function writes its own fields and notes its row alone. */
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
static uint64_t resting[ROWS / 64], written[ROWS / 64];
static const struct table_writer writer = {&rows, resting, written};

static int make(void **state)
{
    (void)state;
    void *memory = aligned_alloc(TABLE_ALIGN, entities_bytes(ROWS));
    assert_non_null(memory);
    memset(memory, 0, entities_bytes(ROWS));
    entities_bind(&rows, ROWS, memory);
    memset(resting, 0xff, sizeof resting);
    return 0;
}

static int release(void **state)
{
    (void)state;
    free(rows.row);
    return 0;
}

/* The row that was written since the last call rests no more, and all others do; it is noted, and
 * no other is. */
static void check_noted(void)
{
    for (uint32_t word = 0; word < ROWS / 64; word++) {
        assert_true(written[word] == (word == ROW / 64 ? (uint64_t)1 << ROW % 64 : 0));
        assert_true(resting[word] == ~written[word]);
    }
    memset(resting, 0xff, sizeof resting);
    memset(written, 0, sizeof written);
}

static void test_a_setter_writes_one_field_and_notes_its_row(void **state)
{
    static const struct entity none;
    struct entity expected = none;
    (void)state;
#define X(type, name)                                                                              \
    expected.name = (type)3;                                                                       \
    table_set_##name(&writer, ROW, (type)3);                                                       \
    assert_memory_equal(&rows.row[ROW], &expected, sizeof expected);                               \
    assert_memory_equal(&rows.row[ROW - 1], &none, sizeof none);                                   \
    assert_memory_equal(&rows.row[ROW + 1], &none, sizeof none);                                   \
    check_noted();
    ENTITY_FIELDS(X)
#undef X
}

static void test_sets_of_fields_are_written_together(void **state)
{
    const struct entity *row = &rows.row[ROW];
    (void)state;
    table_set_position(&writer, ROW, (struct vec3){1.0, 2.0, 3.0});
    table_set_velocity(&writer, ROW, (struct vec3){4.0, 5.0, 6.0});
    table_set_spin(&writer, ROW, (struct vec3){7.0, 8.0, 9.0});
    table_set_target(&writer, ROW, 10, 11);
    table_set_threat(&writer, ROW, 12, 13);
    check_noted();
    assert_true(row->x == 1.0 && row->y == 2.0 && row->z == 3.0);
    assert_true(row->vx == 4.0 && row->vy == 5.0 && row->vz == 6.0);
    assert_true(row->spin_x == 7.0 && row->spin_y == 8.0 && row->spin_z == 9.0);
    assert_true(row->target_slot == 10 && row->target_id == 11);
    assert_true(row->threat_slot == 12 && row->threat_id == 13);
}

static void test_a_cleared_row_is_zero_and_noted(void **state)
{
    static const struct entity none;
    (void)state;
    table_set_rounds(&writer, ROW, 5);
    check_noted();
    table_clear_row(&writer, ROW);
    check_noted();
    assert_memory_equal(&rows.row[ROW], &none, sizeof none);
    table_note(&writer, ROW);
    check_noted();
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, make, release)
    const struct CMUnitTest tests[] = {
        TEST(test_a_setter_writes_one_field_and_notes_its_row),
        TEST(test_sets_of_fields_are_written_together),
        TEST(test_a_cleared_row_is_zero_and_noted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
