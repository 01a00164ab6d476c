/* The entity table: where its columns lie, and copies, clears and finds of rows. */
#include "world/entity/entity.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const uint32_t capacities[] = {1, 2, 15, 16, 17, 63, 64, 65, 1000, 4096};

struct table {
    struct entities entities;
    unsigned char *memory;
    size_t bytes;
};

static struct table make(uint32_t capacity, int fill)
{
    struct table table = {.bytes = entities_bytes(capacity)};
    table.memory = aligned_alloc(TABLE_ALIGN, table.bytes);
    assert_non_null(table.memory);
    memset(table.memory, fill, table.bytes);
    entities_bind(&table.entities, capacity, table.memory);
    return table;
}

static void test_a_table_has_room_for_its_rows(void **state)
{
    (void)state;
    for (size_t c = 0; c < sizeof capacities / sizeof capacities[0]; c++) {
        struct table t = make(capacities[c], 0);
        size_t rows = capacities[c] * sizeof(struct entity);
        assert_int_equal(t.entities.capacity, capacities[c]);
        assert_ptr_equal(t.entities.row, t.memory);
        assert_true(t.bytes >= rows && t.bytes < rows + TABLE_ALIGN);
        assert_int_equal(t.bytes % TABLE_ALIGN, 0);
        free(t.memory);
    }
    assert_true(entities_bytes(CAPACITY_MAX) == (size_t)CAPACITY_MAX * sizeof(struct entity));
}

/* Rows are compared and hashed as they lie in memory, so all bytes but the last belong to a field.
 */
static void test_a_row_has_one_byte_that_is_no_field(void **state)
{
    size_t bytes = 0;
    (void)state;
#define X(type, name)                                                                              \
    assert_int_equal(offsetof(struct entity, name), bytes);                                        \
    bytes += sizeof(type);
    ENTITY_FIELDS(X)
#undef X
    assert_int_equal(bytes + 1, sizeof(struct entity));
}

static void test_copy_takes_its_rows_of_every_field_and_no_other(void **state)
{
    const uint32_t capacity = 65, first = 7, count = 31;
    struct table from = make(capacity, 0xaa), to = make(capacity, 0x55);
    unsigned char old[8], new[8];
    (void)state;
    memset(old, 0x55, sizeof old);
    memset(new, 0xaa, sizeof new);
    entities_copy(&to.entities, &from.entities, first, count);
    for (uint32_t i = 0; i < capacity; i++) {
        const unsigned char *wanted = i >= first && i < first + count ? new : old;
#define X(type, name) assert_memory_equal(&to.entities.row[i].name, wanted, sizeof(type));
        ENTITY_FIELDS(X)
#undef X
    }
    entities_copy(&to.entities, &from.entities, capacity, 0); /* nothing, at the end */
    free(from.memory);
    free(to.memory);
}

static void test_clear_empties_one_row_of_every_field(void **state)
{
    const uint32_t capacity = 20, row = 19;
    struct table t = make(capacity, 0xff);
    unsigned char ones[8], zeros[8] = {0};
    (void)state;
    memset(ones, 0xff, sizeof ones);
    entities_clear(&t.entities, row);
    for (uint32_t i = 0; i < capacity; i++) {
#define X(type, name)                                                                              \
    assert_memory_equal(&t.entities.row[i].name, i == row ? zeros : ones, sizeof(type));
        ENTITY_FIELDS(X)
#undef X
    }
    assert_int_equal(t.entities.row[row].state, ENTITY_FREE);
    free(t.memory);
}

static void test_find_looks_at_used_rows_that_are_not_free(void **state)
{
    struct table t = make(16, 0);
    const struct entities *e = &t.entities;
    (void)state;
    for (uint32_t i = 0; i < 16; i++) {
        e->row[i].id = 100 + i;
        e->row[i].state = i % 3 == 0 ? ENTITY_FREE : i % 3 == 1 ? ENTITY_ACTIVE : ENTITY_WRECK;
    }
    assert_int_equal(entities_find(e, 16, 101), 1);
    assert_int_equal(entities_find(e, 16, 102), 2);         /* a wreck is there */
    assert_int_equal(entities_find(e, 16, 103), SLOT_NONE); /* free */
    assert_int_equal(entities_find(e, 10, 110), SLOT_NONE); /* past used */
    assert_int_equal(entities_find(e, 11, 110), 10);
    assert_int_equal(entities_find(e, 16, 999), SLOT_NONE);
    e->row[4].id = 0;
    assert_int_equal(entities_find(e, 16, 0), SLOT_NONE); /* 0 is no entity */
    free(t.memory);
}

static void test_a_reference_is_dead_when_the_id_differs(void **state)
{
    struct table t = make(16, 0);
    const struct entities *e = &t.entities;
    (void)state;
    e->row[5].id = 42;
    e->row[5].state = ENTITY_WRECK;
    assert_true(entities_alive(e, 5, 42));
    assert_false(entities_alive(e, 5, 41));
    assert_false(entities_alive(e, 6, 42));
    assert_false(entities_alive(e, SLOT_NONE, 42));
    assert_false(entities_alive(e, 16, 42));
    assert_false(entities_alive(e, 6, 0));
    e->row[5].state = ENTITY_FREE;
    assert_false(entities_alive(e, 5, 42));
    free(t.memory);
}

static void test_position_and_velocity_go_in_and_out(void **state)
{
    struct table t = make(16, 0);
    (void)state;
    entities_set_position(&t.entities, 3, (struct vec3){1.0, 2.0, 3.0});
    entities_set_velocity(&t.entities, 3, (struct vec3){4.0, 5.0, 6.0});
    struct vec3 p = entities_position(&t.entities, 3), v = entities_velocity(&t.entities, 3);
    assert_true(p.x == 1.0 && p.y == 2.0 && p.z == 3.0);
    assert_true(v.x == 4.0 && v.y == 5.0 && v.z == 6.0);
    assert_true(t.entities.row[3].y == 2.0 && t.entities.row[3].vz == 6.0);
    free(t.memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_table_has_room_for_its_rows),
        cmocka_unit_test(test_a_row_has_one_byte_that_is_no_field),
        cmocka_unit_test(test_copy_takes_its_rows_of_every_field_and_no_other),
        cmocka_unit_test(test_clear_empties_one_row_of_every_field),
        cmocka_unit_test(test_find_looks_at_used_rows_that_are_not_free),
        cmocka_unit_test(test_a_reference_is_dead_when_the_id_differs),
        cmocka_unit_test(test_position_and_velocity_go_in_and_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
