/* The index of the list of dents, and the part of a dent that is left (thesis rows 33 and 47: dents
 * at the point of impact; an elastic part that recovers). */
#include "renderer/scene/frame/dent_index.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#define DENTS 64u
#define DT_S  0.1

static struct dent list[DENTS];
static uint32_t count;
static struct dent_index dents;

static int open_index(void **context)
{
    (void)context;
    count = 0;
    return dent_index_init(&dents, list, DENTS);
}

static int close_index(void **context)
{
    (void)context;
    dent_index_free(&dents);
    return 0;
}

static void dent(uint32_t id, uint32_t tick, float plastic_m, float elastic_m)
{
    list[count++] = (struct dent){.id = id,
                                  .tick = tick,
                                  .point = {3.0f, 1.0f, plastic_m},
                                  .direction = {-1.0f, 0.0f, 0.0f},
                                  .plastic_m = plastic_m,
                                  .elastic_m = elastic_m};
    dent_index_update(&dents, count);
}

static void test_row_33_dents_are_found_by_body(void **context)
{
    struct dented of[DENT_INDEX_PER_BODY];
    (void)context;
    assert_false(dent_index_any(&dents, 1));
    /* Dents of three bodies with the same hash, alternately. */
    for (uint32_t i = 0; i < DENTS; i++)
        dent(1 + (i % 3 << 31 | i % 3 << 30), 0, 0.01f * (float)(1 + i), 0.0f);
    for (uint32_t body = 0; body < 3; body++) {
        uint32_t id = 1 + (body << 31 | body << 30), deepest = DENTS - 1;
        assert_true(dent_index_any(&dents, id));
        assert_int_equal(dent_index_of(&dents, id, 10, DT_S, of), DENT_INDEX_PER_BODY);
        while (deepest % 3 != body)
            deepest--;
        for (uint32_t i = 0; i < DENT_INDEX_PER_BODY;
             i++) { /* the deepest of its own dents, in order */
            float depth = 0.01f * (float)(1 + deepest - 3 * i);
            assert_true(of[i].depth_m == depth && of[i].point[2] == depth);
        }
    }
    assert_false(dent_index_any(&dents, 2));
    assert_int_equal(dent_index_of(&dents, 2, 10, DT_S, of), 0);
}

static void test_uncommitted_dents_are_not_shown(void **context)
{
    struct dented of[DENT_INDEX_PER_BODY];
    (void)context;
    dent(7, 0, 0.2f, 0.0f);
    list[1] = list[0];
    assert_int_equal(dent_index_of(&dents, 7, 0, DT_S, of), 1);
    dent_index_update(&dents, 2);
    assert_int_equal(dent_index_of(&dents, 7, 0, DT_S, of), 2);
}

static void test_row_47_the_elastic_part_comes_back_and_the_plastic_stays(void **context)
{
    struct dented of[DENT_INDEX_PER_BODY];
    float before = 0.51f;
    (void)context;
    dent(5, 100, 0.2f, 0.3f);
    dent(6, 100, 0.0f, 0.3f);
    for (uint64_t tick = 100; tick < 110; tick++) {
        assert_int_equal(dent_index_of(&dents, 5, tick, DT_S, of), 1);
        double left = exp(-(double)(tick - 100) * DT_S / DENT_RETURN_S); /* nearly */
        assert_true(fabs((double)of[0].depth_m - (0.2 + 0.3 * left)) < 0.01);
        assert_true(of[0].depth_m < before);
        before = of[0].depth_m;
    }
    assert_int_equal(dent_index_of(&dents, 5, 100000, DT_S, of), 1);
    assert_true(fabs((double)of[0].depth_m - 0.2) < 1e-4);
    assert_int_equal(dent_index_of(&dents, 6, 100, DT_S, of), 1);
    assert_int_equal(dent_index_of(&dents, 6, 100000, DT_S, of), 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_index, close_index)
    const struct CMUnitTest tests[] = {
        TEST(test_row_33_dents_are_found_by_body),
        TEST(test_uncommitted_dents_are_not_shown),
        TEST(test_row_47_the_elastic_part_comes_back_and_the_plastic_stays),
    };
    return cmocka_run_group_tests_name("dents", tests, NULL, NULL);
}
