/* Hashes of blocks of rows, and tables that take from each other what differs. */
#include "world/checksum.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROWS (2 * CHECKSUM_ROWS + 100) /* two whole blocks and a short one */

struct own_table {
    struct entities rows;
    uint64_t hashes[3];
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
    own->memory = aligned_alloc(TABLE_ALIGN, bytes);
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
    table_hash(table_of(&a), 0, ROWS, NULL);
    table_hash(table_of(&b), 0, ROWS, NULL);
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

static void test_a_table_takes_blocks_that_differ(void **state)
{
    (void)state;
    a.rows.row[0].x += 1.0;
    a.rows.row[CHECKSUM_ROWS - 1].rounds++;
    a.rows.row[CHECKSUM_ROWS].kind++;
    a.rows.row[ROWS - 1].trigger++;
    table_hash(table_of(&a), 0, ROWS, NULL);
    take_all(true);
    assert_true(same());
}

static void test_fields_that_differ_are_named(void **state)
{
    struct entity one = a.rows.row[5], other = one;
    (void)state;
    assert_true(entity_differing(&one, &other) == 0);
    one.spin_y = -0.0;
    other.spin_y = 0.0; /* bit by bit */
    other.bumped ^= 1;
    assert_true(entity_differing(&one, &other) == (FIELD_BIT(spin_y) | FIELD_BIT(bumped)));
}

static void test_what_is_known_to_be_the_same_is_not_copied(void **state)
{
    (void)state;
    b.rows.row[7].kind ^= 1; /* behind its hash's back: who copied it would put it right */
    take_all(true);
    assert_false(same());
    take_all(false);
    assert_true(same());
}

static void test_rows_that_were_written_are_added_to_the_hashes(void **state)
{
    const uint32_t few[] = {7, CHECKSUM_ROWS + 8, CHECKSUM_ROWS + 9, ROWS - 1};
    uint64_t rows[3 * ROW_BLOCK_WORDS] = {0};
    struct own_table whole = b;
    (void)state;
    for (size_t n = 0; n < sizeof few / sizeof few[0]; n++) {
        rows[few[n] / 64] |= (uint64_t)1 << few[n] % 64;
        b.rows.row[few[n]].kind ^= 1;
        b.rows.row[few[n]].x = n == 1 ? 0.0 : (double)n;
    }
    rows[2] |= 1; /* noted, but as it was */
    table_hash_written(table_of(&b), &a.rows, ROWS, rows);
    table_hash(table_of(&whole), 0, ROWS, NULL);
    assert_memory_equal(b.hashes, whole.hashes, sizeof b.hashes);
    assert_true(b.hashes[0] != a.hashes[0] && b.hashes[2] != a.hashes[2]);
}

static void test_blocks_are_hashed_from_one_on(void **state)
{
    uint64_t right[3];
    (void)state;
    memcpy(right, b.hashes, sizeof right);
    memset(b.hashes, 0, sizeof b.hashes);
    table_hash(table_of(&b), 1, ROWS, NULL);
    assert_true(b.hashes[0] == 0 && b.hashes[1] == right[1] && b.hashes[2] == right[2]);
    table_hash(table_of(&b), 3, ROWS, NULL); /* none */
    assert_true(b.hashes[0] == 0);
}

static void test_a_row_that_is_not_noted_is_missed(void **state)
{
    static const uint64_t none[3 * ROW_BLOCK_WORDS];
    (void)state;
    b.rows.row[7].kind ^= 1;
    table_hash_written(table_of(&b), &a.rows, ROWS, none);
    assert_memory_equal(b.hashes, a.hashes, sizeof b.hashes);
    assert_true(rows_hash_again(&b.rows, ROWS) != rows_hash(b.hashes, ROWS));
}

static void test_words_at_other_places_have_other_hashes(void **state)
{
    (void)state;
    memset(a.rows.row, 0, ROWS * sizeof *a.rows.row);
    memset(b.rows.row, 0, ROWS * sizeof *b.rows.row);
    a.rows.row[0].x = a.rows.row[3].x = 1.0;
    b.rows.row[1].x = b.rows.row[2].x = 1.0;
    table_hash(table_of(&a), 0, ROWS, NULL);
    table_hash(table_of(&b), 0, ROWS, NULL);
    assert_true(a.hashes[0] != b.hashes[0]);
    assert_true(a.hashes[0] != WORD_HASH_BLANK);
    assert_true(a.hashes[1] == WORD_HASH_BLANK);
}

/* Rows behind the last one that is used count for nothing. */
static void test_the_hash_ends_with_the_rows_in_use(void **state)
{
    uint64_t whole = rows_hash(a.hashes, ROWS);
    (void)state;
    assert_true(rows_hash_again(&a.rows, ROWS) == whole);
    uint64_t part = rows_hash_again(&a.rows, ROWS - 1);
    assert_true(part != whole);
    a.rows.row[ROWS - 1].id ^= 1;
    assert_true(rows_hash_again(&a.rows, ROWS - 1) == part);
    assert_true(rows_hash_again(&a.rows, ROWS) != whole);
}

static void test_threads_make_the_same_hashes(void **state)
{
    struct thread_pool *workers = thread_pool_create(3);
    (void)state;
    assert_non_null(workers);
    memset(b.hashes, 0, sizeof b.hashes);
    table_hash(table_of(&b), 0, ROWS, workers);
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
    assert_true(each_bit_counts(&f, fixture_state(&f).hashes, sizeof(uint64_t)));
    assert_true(each_bit_counts(&f, f.view.m.hashes, sizeof(uint64_t)));
    assert_true(each_bit_counts(&f, &fixture_state(&f).entities.row[0].x, 8));
    assert_true(each_bit_counts(&f, &f.view.m.entities.row[0].flags, 1));
    fixture_close(&f);
}

/* A step that has taken over does not believe what it finds in the table that it writes. */
static void test_who_takes_over_copies_everything(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 20; } );");
    fixture_run(&f, 4);
    uint8_t *moved = &f.view.m.entities.row[3].force;
    uint64_t commit = fixture_state(&f).head->frame;
    uint8_t *next = &f.view.w[(commit + 1) & 1].entities.row[3].force;
    uint8_t right = *moved;
    *moved = *next = (uint8_t)(right ^ 1);
    fixture_threads(&f, 1); /* other processes */
    fixture_continue(&f, 1);
    assert_int_equal(*moved, right);
    assert_int_equal(*next, right);
    fixture_close(&f);
}

#define TABLES(function) cmocka_unit_test_setup_teardown(function, make_tables, free_tables)

static void test_rows_that_differ_are_taken(void **state)
{
    const uint32_t few[] = {5, 70, CHECKSUM_ROWS - 1};
    uint64_t bits[ROW_BLOCK_WORDS] = {0};
    (void)state;
    for (size_t n = 0; n < sizeof few / sizeof few[0]; n++) {
        a.rows.row[CHECKSUM_ROWS + few[n]].x += 1.0;
        bits[few[n] / 64] |= (uint64_t)1 << few[n] % 64;
    }
    table_hash(table_of(&a), 0, ROWS, NULL);
    table_take_rows(table_of(&b), table_of(&a), 1, bits);
    assert_true(same());
}

/* Bits are no part of a checksum: none leads beyond the rows. */
static void test_no_row_beyond_the_table_is_taken(void **state)
{
    uint64_t bits[ROW_BLOCK_WORDS];
    (void)state;
    memset(bits, 0xff, sizeof bits);
    b.rows.capacity = ROWS - 50;
    for (uint32_t row = 2 * CHECKSUM_ROWS; row < ROWS; row++)
        a.rows.row[row].x += 1.0;
    table_take_rows(table_of(&b), table_of(&a), 2, bits);
    assert_true(b.rows.row[ROWS - 51].x == a.rows.row[ROWS - 51].x);
    assert_true(b.rows.row[ROWS - 50].x != a.rows.row[ROWS - 50].x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TABLES(test_a_table_takes_blocks_that_differ),
        TABLES(test_rows_that_differ_are_taken),
        TABLES(test_no_row_beyond_the_table_is_taken),
        TABLES(test_fields_that_differ_are_named),
        TABLES(test_what_is_known_to_be_the_same_is_not_copied),
        TABLES(test_rows_that_were_written_are_added_to_the_hashes),
        TABLES(test_blocks_are_hashed_from_one_on),
        TABLES(test_a_row_that_is_not_noted_is_missed),
        TABLES(test_words_at_other_places_have_other_hashes),
        TABLES(test_the_hash_ends_with_the_rows_in_use),
        TABLES(test_threads_make_the_same_hashes),
        cmocka_unit_test(test_a_flipped_bit_of_the_hashes_is_found),
        cmocka_unit_test(test_who_takes_over_copies_everything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
