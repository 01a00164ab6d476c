/* The index of neighbours, against a search of all rows. */
#include "mover/query/neighbour_index.h"
#include "tests/support/steps.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROWS_MAX 6000u

static struct entities rows;
static void *memory;
static struct neighbour_index neighbours;
static bool met[ROWS_MAX];

static int open_table(void **state)
{
    (void)state;
    memory = aligned_alloc(TABLE_ALIGN, entities_bytes(ROWS_MAX));
    assert_non_null(memory);
    memset(memory, 0, entities_bytes(ROWS_MAX));
    entities_bind(&rows, ROWS_MAX, memory);
    return neighbour_index_init(&neighbours, ROWS_MAX);
}

static int close_table(void **state)
{
    (void)state;
    neighbour_index_free(&neighbours);
    free(memory);
    return 0;
}

static void put(uint32_t row, double x, double z, enum force force)
{
    rows.row[row].x = x;
    rows.row[row].z = z;
    rows.row[row].id = row + 1;
    rows.row[row].force = (uint8_t)force;
    rows.row[row].state = ENTITY_ACTIVE;
    rows.row[row].behaviour = BEHAVIOUR_PATROL;
}

/* Everybody of all sorts, some of them where squares and the world end. */
static void scatter(uint64_t *random, uint32_t count, double side_m)
{
    for (uint32_t i = 0; i < count; i++) {
        double x = fixture_uniform(random, 0.0, side_m), z = fixture_uniform(random, 0.0, side_m);
        if (i % 7 == 0)
            x = 781.25 * (double)(fixture_random(random) % 65);
        put(i, x, i % 11 == 0 ? WORLD_SIDE_DEFAULT_M : z, (enum force)(fixture_random(random) % 3));
        uint64_t sort = fixture_random(random) % 8;
        rows.row[i].state = (uint8_t)(sort == 0   ? ENTITY_FREE
                                      : sort == 1 ? ENTITY_WRECK
                                                  : ENTITY_ACTIVE);
        if (sort == 2)
            rows.row[i].behaviour = BEHAVIOUR_FLIGHT;
    }
}

/* Indexes the first rows, of which none rests. */
static struct neighbour_index_frame frame_of(uint32_t count, uint32_t tick, uint32_t think)
{
    return (struct neighbour_index_frame){.committed = &rows,
                                          .side_m = WORLD_SIDE_DEFAULT_M,
                                          .used = count,
                                          .tick = tick,
                                          .think_frames = think};
}

static void build(uint32_t count, uint32_t tick, uint32_t think, struct thread_pool *workers)
{
    const struct neighbour_index_frame frame = frame_of(count, tick, think);
    neighbour_index_build(&neighbours, &frame, true, workers);
}

static bool belongs(uint32_t i, uint32_t layers, double x, double z, double radius)
{
    double dx = (double)(float)rows.row[i].x - x, dz = (double)(float)rows.row[i].z - z;
    if (rows.row[i].state == ENTITY_FREE || rows.row[i].behaviour == BEHAVIOUR_FLIGHT ||
        dx * dx + dz * dz > radius * radius)
        return false;
    return rows.row[i].state == ENTITY_WRECK
               ? (layers & NEIGHBOUR_INDEX_LAYER(NEIGHBOUR_INDEX_WRECKS)) != 0
               : (layers >> rows.row[i].force & 1u) != 0;
}

static void agrees(uint32_t count, uint32_t layers, double x, double z, double radius)
{
    const struct neighbour_index_entry *entry;
    memset(met, 0, sizeof met);
    struct neighbour_query query = neighbour_query_begin(&neighbours, layers, x, z, radius);
    while ((entry = neighbour_query_next(&query))) {
        assert_true(entry->row < count && !met[entry->row]);
        met[entry->row] = true;
    }
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(met[i], belongs(i, layers, x, z, radius));
}

static void test_a_query_finds_exactly_the_rows_within_the_radius(void **state)
{
    uint64_t random = fixture_seed(9);
    (void)state;
    for (int trial = 0; trial < 60; trial++) {
        uint32_t count = (uint32_t)(fixture_random(&random) % ROWS_MAX);
        scatter(&random, count, trial % 2 ? WORLD_SIDE_DEFAULT_M : 3000.0);
        build(count, 0, 1, NULL);
        for (int n = 0; n < 6; n++)
            agrees(count, (uint32_t)(fixture_random(&random) % (NEIGHBOUR_INDEX_ALL + 1)),
                   fixture_uniform(&random, -100.0, 6000.0), fixture_uniform(&random, 0.0, 6000.0),
                   fixture_uniform(&random, 0.0, n % 2 ? 60.0 : 9000.0));
    }
}

/* All that a walk gives, in its order. */
static uint32_t walk_all(uint32_t layers, struct neighbour_index_entry *met_in_order)
{
    const struct neighbour_index_entry *entry;
    uint32_t count = 0;
    struct neighbour_query query =
        neighbour_query_begin(&neighbours, layers, 25000.0, 25000.0, 1e6);
    while ((entry = neighbour_query_next(&query)))
        met_in_order[count++] = *entry;
    return count;
}

static uint32_t cell_of(const struct neighbour_index_entry *entry)
{
    uint32_t column = (uint32_t)((double)entry->x * neighbours.cells_per_m);
    uint32_t row = (uint32_t)((double)entry->z * neighbours.cells_per_m);
    row = row < neighbours.side ? row : neighbours.side - 1;
    return row * neighbours.side + (column < neighbours.side ? column : neighbours.side - 1);
}

static void test_rows_ascend_in_a_cell_on_any_number_of_threads(void **state)
{
    static struct neighbour_index_entry one[ROWS_MAX], other[ROWS_MAX];
    uint64_t random = fixture_seed(4);
    (void)state;
    scatter(&random, ROWS_MAX, 9000.0);
    build(ROWS_MAX, 0, 1, NULL);
    for (uint32_t layers = 1; layers <= NEIGHBOUR_INDEX_ALL; layers++) {
        build(ROWS_MAX, 0, 1, NULL);
        uint32_t count = walk_all(layers, one);
        for (uint32_t n = 1; n < count && layers == NEIGHBOUR_INDEX_LAYER(FORCE_RED); n++)
            assert_true(cell_of(&one[n - 1]) < cell_of(&one[n]) ||
                        (cell_of(&one[n - 1]) == cell_of(&one[n]) && one[n - 1].row < one[n].row));
        for (uint32_t threads = 2; threads <= 3; threads++) {
            struct thread_pool *workers = thread_pool_create(threads);
            assert_non_null(workers);
            build(ROWS_MAX, 0, 1, workers);
            assert_int_equal(walk_all(layers, other), count);
            for (uint32_t n = 0; n < count; n++)
                assert_int_equal(one[n].row, other[n].row);
            thread_pool_destroy(workers);
        }
    }
}

static void test_those_are_due_whose_turn_it_is(void **state)
{
    uint64_t random = fixture_seed(8);
    (void)state;
    scatter(&random, 1000, 9000.0);
    for (uint32_t think = 1; think < 40; think += 6) {
        uint32_t tick = (uint32_t)fixture_random(&random);
        build(1000, tick, think, NULL);
        for (uint32_t i = 0; i < 1000; i++) {
            if (neighbours.key[i] == NEIGHBOUR_INDEX_NO_KEY)
                continue;
            assert_int_equal(neighbour_index_due(&neighbours, neighbours.place[i]),
                             rows.row[i].state == ENTITY_ACTIVE &&
                                 (tick + rows.row[i].id) % think == 0);
        }
    }
}

/* --- from frame to frame -----------------------------------------------------------------------*/

/* Moves, adds, removes or destroys the row, or leaves it alone. */
static void change(uint64_t *random, uint32_t i, double side_m)
{
    switch (fixture_random(random) % 16) {
    case 0:
        put(i, fixture_uniform(random, 0.0, side_m), fixture_uniform(random, 0.0, side_m),
            (enum force)(fixture_random(random) % 3));
        break;
    case 1:
        rows.row[i].state = ENTITY_FREE;
        break;
    case 2:
        rows.row[i].state = rows.row[i].state == ENTITY_FREE ? ENTITY_FREE : ENTITY_WRECK;
        break;
    default:
        rows.row[i].x = maths_clamp(rows.row[i].x + fixture_uniform(random, -9.0, 9.0), 0.0,
                                    WORLD_SIDE_DEFAULT_M);
        rows.row[i].z = maths_clamp(rows.row[i].z + fixture_uniform(random, -9.0, 9.0), 0.0,
                                    WORLD_SIDE_DEFAULT_M);
        rows.row[i].vx = fixture_uniform(random, -9.0, 9.0);
        break;
    }
}

/* Finds the rows whose agents are due. */
static void find_due(bool due[ROWS_MAX])
{
    const struct neighbour_index_entry *entry;
    memset(due, 0, ROWS_MAX * sizeof *due);
    struct neighbour_query query =
        neighbour_query_begin(&neighbours, NEIGHBOUR_INDEX_ALL, 25000.0, 25000.0, 1e6);
    while ((entry = neighbour_query_next(&query)))
        due[entry->row] = neighbour_index_due(&neighbours, (uint32_t)(entry - neighbours.entries));
}

/* Compares the index with one that is built: all entries in their order, and the agents that are
 * due. */
static void is_as_built(const struct neighbour_index_frame *frame)
{
    static struct neighbour_index_entry kept[ROWS_MAX], built[ROWS_MAX];
    static bool due[ROWS_MAX], due_built[ROWS_MAX];
    uint32_t present = neighbours.present;
    find_due(due);
    for (uint32_t layers = 1; layers <= NEIGHBOUR_INDEX_ALL; layers += 7) {
        struct neighbour_index other;
        uint32_t count = walk_all(layers, kept);
        const struct neighbour_index mine = neighbours;
        assert_int_equal(neighbour_index_init(&other, ROWS_MAX), 0);
        neighbour_index_build(&other, frame, layers == 1, NULL);
        neighbours = other;
        assert_int_equal(walk_all(layers, built), count);
        assert_memory_equal(kept, built, count * sizeof *kept);
        assert_int_equal(present, neighbours.present);
        find_due(due_built);
        assert_memory_equal(due, due_built, sizeof due);
        neighbours = mine;
        neighbour_index_free(&other);
    }
}

static void test_an_index_that_is_kept_is_one_that_is_built(void **state)
{
    static uint64_t resting[ROWS_MAX / 64 + 1];
    uint64_t random = fixture_seed(10);
    struct thread_pool *workers = thread_pool_create(3);
    uint32_t kept = 0;
    (void)state;
    assert_non_null(workers);
    for (int trial = 0; trial < 12; trial++) {
        double side_m = trial % 2 ? WORLD_SIDE_DEFAULT_M : 2000.0;
        uint32_t used = 3000 + (uint32_t)(fixture_random(&random) % 1000), most = 1u << trial;
        memset(resting, 0, sizeof resting);
        memset(rows.row, 0, ROWS_MAX * sizeof *rows.row);
        scatter(&random, used, side_m);
        build(used, 0, 5, NULL);
        for (uint32_t tick = 1; tick < 12; tick++) {
            for (uint32_t i = 0; i < ROWS_MAX / 64; i++)
                resting[i] = fixture_random(&random) | fixture_random(&random) |
                             (tick % 4 ? fixture_random(&random) : 0);
            for (uint32_t n = 0; n < most; n++) {
                uint32_t i = (uint32_t)(fixture_random(&random) % used);
                change(&random, i, side_m);
                resting[i / 64] &= ~((uint64_t)1 << i % 64);
            }
            for (uint32_t i = 0; i < used; i++) { /* rows that begin to rest */
                if (resting[i / 64] >> i % 64 & 1)
                    neighbour_index_rests(&neighbours, i);
            }
            used += (uint32_t)(fixture_random(&random) % 3);
            used -= (uint32_t)(fixture_random(&random) % 3);
            for (uint32_t i = used; i < ROWS_MAX; i++)
                rows.row[i].state = ENTITY_FREE;
            struct neighbour_index_frame frame = frame_of(used, tick, 5);
            frame.resting = resting;
            neighbour_index_update(&neighbours, &frame, tick % 2 ? workers : NULL);
            kept += neighbours.placed;
            is_as_built(&frame);
        }
    }
    thread_pool_destroy(workers);
    assert_true(kept > 60 && kept < 132);
}

static void test_an_empty_world_and_an_empty_layer_have_no_rows(void **state)
{
    (void)state;
    build(0, 0, 1, NULL);
    agrees(0, NEIGHBOUR_INDEX_ALL, 25000.0, 25000.0, 1e6);
    put(0, 25000.0, 25000.0, FORCE_BLUE);
    build(1, 0, 1, NULL);
    agrees(1, NEIGHBOUR_INDEX_LIVING, 25000.0, 25000.0, 0.0);
    agrees(1, neighbour_index_enemies(FORCE_BLUE), 25000.0, 25000.0, 1e6);
    agrees(1, neighbour_index_enemies(FORCE_NEUTRAL), 25000.0, 25000.0, 1e6);
    assert_int_equal(neighbours.present, NEIGHBOUR_INDEX_LAYER(FORCE_BLUE));
}

static void test_the_neutral_are_nobodys_enemies(void **state)
{
    (void)state;
    assert_int_equal(neighbour_index_enemies(FORCE_BLUE), NEIGHBOUR_INDEX_LAYER(FORCE_RED));
    assert_int_equal(neighbour_index_enemies(FORCE_RED), NEIGHBOUR_INDEX_LAYER(FORCE_BLUE));
    assert_int_equal(neighbour_index_enemies(FORCE_NEUTRAL), 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_table, close_table)
    const struct CMUnitTest tests[] = {
        TEST(test_a_query_finds_exactly_the_rows_within_the_radius),
        TEST(test_rows_ascend_in_a_cell_on_any_number_of_threads),
        TEST(test_those_are_due_whose_turn_it_is),
        TEST(test_an_index_that_is_kept_is_one_that_is_built),
        TEST(test_an_empty_world_and_an_empty_layer_have_no_rows),
        TEST(test_the_neutral_are_nobodys_enemies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
