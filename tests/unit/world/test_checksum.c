/* Hashes by piece and column, and tables that take from each other what differs. */
#include "world/checksum.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROWS (2 * CHECKSUM_ROWS + 100) /* two whole pieces and a short one */

struct own_table {
    struct entities rows;
    struct block_hashes hashes[3];
    unsigned char *memory;
};

static struct own_table a, b;

static struct table table_of(struct own_table *own)
{
    return (struct table){&own->rows, own->hashes};
}

static void make_table(struct own_table *own)
{
    size_t bytes = entities_bytes(ROWS);
    own->memory = aligned_alloc(COLUMN_ALIGN, bytes);
    assert_non_null(own->memory);
    entities_bind(&own->rows, ROWS, own->memory);
}

static int make_tables(void **state)
{
    uint64_t seed = fixture_seed(1);
    (void)state;
    make_table(&a);
    make_table(&b);
    for (size_t i = 0; i < entities_bytes(ROWS); i++)
        a.memory[i] = (unsigned char)fixture_random(&seed);
    memcpy(b.memory, a.memory, entities_bytes(ROWS));
    table_hash(table_of(&a), ROWS, NULL);
    table_hash(table_of(&b), ROWS, NULL);
    return 0;
}

static int free_tables(void **state)
{
    (void)state;
    free(a.memory);
    free(b.memory);
    return 0;
}

static void take_all(bool known)
{
    for (uint32_t block = 0; block < block_count(ROWS); block++)
        table_take(table_of(&b), table_of(&a), block, ROWS, known);
}

static bool same(void)
{
    return memcmp(a.memory, b.memory, entities_bytes(ROWS)) == 0 &&
           memcmp(a.hashes, b.hashes, sizeof a.hashes) == 0;
}

static void test_a_table_takes_differing_columns(void **state)
{
    (void)state;
    a.rows.x[0] += 1.0;
    a.rows.rounds[CHECKSUM_ROWS - 1]++;
    a.rows.kind[CHECKSUM_ROWS]++;
    a.rows.trigger[ROWS - 1]++;
    table_hash(table_of(&a), ROWS, NULL);
    take_all(true);
    assert_true(same());
}

static void test_differing_rows_are_found_by_columns(void **state)
{
    uint64_t rows[CHECKSUM_ROWS / 64] = {0};
    (void)state;
    a.rows.x[CHECKSUM_ROWS + 3] += 1.0;
    a.rows.kind[CHECKSUM_ROWS + 70]++;
    a.rows.trigger[CHECKSUM_ROWS + 900]++;
    a.rows.x[5] += 1.0; /* another block */
    table_hash(table_of(&a), ROWS, NULL);
    assert_true(table_differing(table_of(&a), table_of(&b), 1, ROWS,
                                COLUMN_BIT(x) | COLUMN_BIT(kind), CHECKSUM_ROWS, rows));
    for (uint32_t w = 0; w < CHECKSUM_ROWS / 64; w++)
        assert_int_equal(rows[w], w == 0 ? 1u << 3 : w == 1 ? 1u << 6 : 0u);
    assert_false(table_differing(table_of(&a), table_of(&b), 1, ROWS, COLUMNS_ALL, 1, rows));
}

static void test_what_is_known_to_be_the_same_is_not_copied(void **state)
{
    (void)state;
    b.rows.kind[7] ^= 1; /* behind its hash's back: who copied it would put it right */
    take_all(true);
    assert_false(same());
    take_all(false);
    assert_true(same());
}

/* Only columns that were written are hashed, by a few rows or whole. */
static void check_written(uint32_t known)
{
    const uint64_t columns[3] = {0, COLUMN_BIT(kind) | COLUMN_BIT(x), COLUMN_BIT(kind)};
    uint64_t rows[3 * ROW_BLOCK_WORDS] = {0};
    const struct written written = {columns, rows};
    struct own_table whole = b;
    const uint32_t few[] = {7, CHECKSUM_ROWS + 8, CHECKSUM_ROWS + 9, ROWS - 1};
    for (size_t n = 0; n < sizeof few / sizeof few[0]; n++) {
        rows[few[n] / 64] |= (uint64_t)1 << few[n] % 64;
        b.rows.kind[few[n]] ^= 1;
        b.rows.x[few[n]] = n == 1 ? 0.0 : (double)n;
    }
    table_hash_written(table_of(&b), table_of(&a), ROWS, known, &written, NULL);
    table_hash(table_of(&whole), ROWS, NULL);
    for (int block = 0; block < 3; block++) {
        for (int column = 0; column < ENTITY_COLUMN_COUNT; column++) {
            bool named = columns[block] >> column & 1;
            assert_true(b.hashes[block].column[column] ==
                        (named ? whole : a).hashes[block].column[column]);
        }
    }
}

static void test_the_written_columns_are_hashed_whole(void **state)
{
    (void)state;
    check_written(0);
}

static void test_the_written_columns_are_hashed_by_a_few_rows(void **state)
{
    (void)state;
    check_written(3);
}

static void test_rows_are_listed_up_to_a_number(void **state)
{
    uint64_t bits[ROW_BLOCK_WORDS] = {[0] = UINT64_MAX, [2] = UINT64_MAX};
    struct row_list list;
    (void)state;
    assert_true(row_list_gather(&list, 1, ROWS, bits));
    assert_int_equal(list.count, 128);
    assert_int_equal(list.row[64], CHECKSUM_ROWS + 128);
    assert_true(row_list_gather(&list, 2, 2 * CHECKSUM_ROWS + 65, bits));
    assert_int_equal(list.count, 64);
    bits[ROW_BLOCK_WORDS - 1] = 1;
    assert_false(row_list_gather(&list, 1, ROWS, bits));
}

static void test_words_at_other_places_have_other_hashes(void **state)
{
    (void)state;
    memset(a.rows.x, 0, ROWS * sizeof *a.rows.x);
    memset(b.rows.x, 0, ROWS * sizeof *b.rows.x);
    a.rows.x[0] = a.rows.x[3] = 1.0;
    b.rows.x[1] = b.rows.x[2] = 1.0;
    table_hash(table_of(&a), ROWS, NULL);
    table_hash(table_of(&b), ROWS, NULL);
    assert_true(a.hashes[0].column[COLUMN_x] != b.hashes[0].column[COLUMN_x]);
    assert_true(a.hashes[0].column[COLUMN_x] != COLUMN_HASH_BLANK);
    assert_true(a.hashes[1].column[COLUMN_x] == COLUMN_HASH_BLANK);
}

/* Rows behind the last one that is used count for nothing. */
static void test_the_hash_ends_with_the_rows_in_use(void **state)
{
    uint64_t whole = rows_hash(a.hashes, ROWS);
    (void)state;
    assert_true(rows_hash_again(&a.rows, ROWS) == whole);
    uint64_t part = rows_hash_again(&a.rows, ROWS - 1);
    assert_true(part != whole);
    a.rows.id[ROWS - 1] ^= 1;
    assert_true(rows_hash_again(&a.rows, ROWS - 1) == part);
    assert_true(rows_hash_again(&a.rows, ROWS) != whole);
}

static void test_threads_make_the_same_hashes(void **state)
{
    struct thread_pool *workers = thread_pool_create(3);
    (void)state;
    assert_non_null(workers);
    memset(b.hashes, 0, sizeof b.hashes);
    table_hash(table_of(&b), ROWS, workers);
    assert_true(same());
    thread_pool_destroy(workers);
}

/* --- worlds ------------------------------------------------------------------------------------*/

/* Does every flipped bit of the bytes make it fail? */
static bool each_bit_counts(struct fixture *f, void *at, size_t bytes)
{
    unsigned char *byte = at;
    struct state now = fixture_state(f);
    for (size_t i = 0; i < bytes * 8; i++) {
        byte[i / 8] ^= (unsigned char)(1u << i % 8);
        bool whole = state_whole(&now, f->view.world.counts.fixed) && moved_whole(&f->view.m);
        byte[i / 8] ^= (unsigned char)(1u << i % 8);
        if (whole)
            return false;
    }
    return true;
}

static void test_a_flipped_bit_of_the_hashes_is_found(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 20; } );");
    fixture_run(&f, 3);
    assert_true(each_bit_counts(&f, fixture_state(&f).hashes, sizeof(struct block_hashes)));
    assert_true(each_bit_counts(&f, f.view.m.hashes, sizeof(struct block_hashes)));
    assert_true(each_bit_counts(&f, fixture_state(&f).entities.x, 8));
    assert_true(each_bit_counts(&f, f.view.m.entities.flags, 8));
    fixture_close(&f);
}

/* A step that has taken over does not believe what it finds in the table that it writes. */
static void test_who_takes_over_copies_everything(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 20; } );");
    fixture_run(&f, 4);
    uint8_t *moved = &f.view.m.entities.force[3];
    uint64_t commit = fixture_state(&f).head->frame;
    uint8_t *next = &f.view.w[(commit + 1) & 1].entities.force[3];
    uint8_t right = *moved;
    *moved = *next = (uint8_t)(right ^ 1);
    fixture_threads(&f, 1); /* other processes */
    fixture_continue(&f, 1);
    assert_int_equal(*moved, right);
    assert_int_equal(*next, right);
    fixture_close(&f);
}

#define TABLES(function) cmocka_unit_test_setup_teardown(function, make_tables, free_tables)

static void test_a_blank_column_is_known_by_its_hash(void **state)
{
    const uint32_t few[] = {CHECKSUM_ROWS, 2 * CHECKSUM_ROWS - 1};
    const uint64_t both = COLUMN_BIT(spin_y) | COLUMN_BIT(target_id);
    (void)state;
    memset(a.rows.spin_y, 0, ROWS * sizeof *a.rows.spin_y);
    memset(a.rows.target_id, 0, ROWS * sizeof *a.rows.target_id);
    memset(a.rows.bumped, 0, ROWS * sizeof *a.rows.bumped);
    a.rows.target_id[few[1]] = 1u << 31;
    table_hash(table_of(&a), ROWS, NULL);
    assert_true(table_blank(table_of(&a), 0) == (both | COLUMN_BIT(bumped)));
    assert_true(table_blank(table_of(&a), 1) == (COLUMN_BIT(spin_y) | COLUMN_BIT(bumped)));
    assert_true(table_blank(table_of(&a), 2) == (both | COLUMN_BIT(bumped))); /* a short one */
    assert_true(table_zero(table_of(&a), both | COLUMN_BIT(kind), few, 1) == both);
    assert_true(table_zero(table_of(&a), both, few, 2) == COLUMN_BIT(spin_y));
}

static void test_rows_that_differ_are_taken_and_found(void **state)
{
    const struct row_list list = {3,
                                  {CHECKSUM_ROWS + 5, CHECKSUM_ROWS + 70, 2 * CHECKSUM_ROWS - 1}};
    const uint64_t some = COLUMN_BIT(spin_y) | COLUMN_BIT(bumped) | COLUMN_BIT(roll);
    uint64_t bits[ROW_BLOCK_WORDS] = {0};
    (void)state;
    a.rows.spin_y[list.row[0]] = -0.0;
    b.rows.spin_y[list.row[0]] = 0.0; /* bit by bit */
    a.rows.x[list.row[1]] += 1.0;     /* not asked for */
    a.rows.bumped[list.row[2]] ^= 1;
    table_hash(table_of(&a), ROWS, NULL);
    table_hash(table_of(&b), ROWS, NULL);
    table_differing_rows(table_of(&a), table_of(&b), 1, some, &list, bits);
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++)
        assert_true(bits[w] == (w == 0                     ? (uint64_t)1 << 5
                                : w == ROW_BLOCK_WORDS - 1 ? (uint64_t)1 << 63
                                                           : 0));
    table_take_rows(table_of(&b), table_of(&a), 1, &list);
    assert_true(same());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TABLES(test_rows_that_differ_are_taken_and_found),
        TABLES(test_a_table_takes_differing_columns),
        TABLES(test_differing_rows_are_found_by_columns),
        TABLES(test_what_is_known_to_be_the_same_is_not_copied),
        TABLES(test_the_written_columns_are_hashed_whole),
        TABLES(test_the_written_columns_are_hashed_by_a_few_rows),
        TABLES(test_rows_are_listed_up_to_a_number),
        TABLES(test_words_at_other_places_have_other_hashes),
        TABLES(test_the_hash_ends_with_the_rows_in_use),
        TABLES(test_threads_make_the_same_hashes),
        cmocka_unit_test(test_a_flipped_bit_of_the_hashes_is_found),
        cmocka_unit_test(test_who_takes_over_copies_everything),
        TABLES(test_a_blank_column_is_known_by_its_hash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
