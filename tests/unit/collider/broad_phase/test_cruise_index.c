/* Boxes by cell, against all of them. */
#include "collider/broad_phase/cruise_index.h"
#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROWS 500u

static struct path_box random_box(uint64_t *seed, float most_m)
{
    float x = (float)fixture_uniform(seed, -10.0, WORLD_SIDE_DEFAULT_M + 10.0);
    float z = (float)fixture_uniform(seed, 24000.0, 26000.0);
    return (struct path_box){.min_x = x,
                             .max_x = x + (float)fixture_uniform(seed, 0.0, (double)most_m),
                             .min_z = z,
                             .max_z = z + (float)fixture_uniform(seed, 0.0, (double)most_m)};
}

static bool meet(const struct path_box *a, const struct path_box *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_z <= b->max_z &&
           b->min_z <= a->max_z;
}

/* Every row that is held and meets the box is found once, and no other. */
static void check_query(const struct cruise_index *index, const struct path_box box[ROWS],
                        const struct path_box *query, struct pair_list *found)
{
    uint32_t seen[ROWS] = {0};
    found->count = 0;
    cruise_index_query(index, query, found);
    for (uint32_t i = 0; i < found->count; i++)
        seen[found->pair[i].a]++;
    for (uint32_t row = 0; row < ROWS; row++)
        assert_int_equal(seen[row], cruise_index_holds(index, row) && meet(&box[row], query));
}

static void test_finds_what_brute_force_finds(void **state)
{
    static struct path_box box[ROWS];
    struct cruise_index index;
    struct pair_list found;
    uint64_t seed = fixture_seed(4);
    (void)state;
    assert_int_equal(cruise_index_init(&index, ROWS, WORLD_SIDE_DEFAULT_M), 0);
    assert_int_equal(pair_list_init(&found, (uint64_t)ROWS * ROWS), 0);
    for (uint32_t n = 0; n < 4000; n++) {
        uint32_t row = (uint32_t)(fixture_random(&seed) % ROWS);
        if (cruise_index_holds(&index, row)) {
            cruise_index_remove(&index, row);
        } else {
            box[row] = random_box(&seed, n % 50 == 0 ? 400.0f : 20.0f);
            cruise_index_add(&index, row, &box[row]);
        }
        if (n % 20 == 0) {
            struct path_box query = random_box(&seed, 3000.0f);
            check_query(&index, box, &query, &found);
        }
    }
    assert_true(index.count > ROWS / 4);
    cruise_index_clear(&index);
    assert_int_equal(index.count, 0);
    struct path_box all = {.min_x = -1e6f, .max_x = 1e6f, .min_z = -1e6f, .max_z = 1e6f};
    check_query(&index, box, &all, &found);
    pair_list_free(&found);
    cruise_index_free(&index);
}

static void test_pairs_name_the_lower_row_first(void **state)
{
    const struct path_box box = {
        .min_x = 100.0f, .max_x = 110.0f, .min_z = 100.0f, .max_z = 110.0f};
    struct cruise_index index;
    struct pair_list pairs;
    (void)state;
    assert_int_equal(cruise_index_init(&index, ROWS, WORLD_SIDE_DEFAULT_M), 0);
    assert_int_equal(pair_list_init(&pairs, ROWS), 0);
    cruise_index_add(&index, 3, &box);
    cruise_index_add(&index, 9, &box);
    cruise_index_pairs(&index, 9, &box, &pairs);
    assert_int_equal(pairs.count, 1);
    assert_int_equal(pairs.pair[0].a, 3);
    assert_int_equal(pairs.pair[0].b, 9);
    pair_list_free(&pairs);
    cruise_index_free(&index);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_what_brute_force_finds),
        cmocka_unit_test(test_pairs_name_the_lower_row_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
