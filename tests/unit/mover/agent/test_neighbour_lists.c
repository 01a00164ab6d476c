/* Lists of neighbours: a list has every vehicle that a look would find, in any order. */
#include "mover/agent/avoidance.h"
#include "mover/agent/neighbour_lists.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define VEHICLES 1500

static struct fixture f;
static struct avoidance avoidance;
static struct neighbour_index neighbours;
static struct neighbour_lists lists;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 2048; hz = 20.0; };");
    avoidance_init(&avoidance, &f.view.world);
    return neighbour_index_init(&neighbours, 2048) == 0 && neighbour_lists_init(&lists, 2048) == 0
               ? 0
               : -1;
}

static int close_world(void **state)
{
    (void)state;
    neighbour_index_free(&neighbours);
    neighbour_lists_free(&lists);
    fixture_close(&f);
    return 0;
}

static void scatter(uint64_t *random, double side_m)
{
    static const char *const kinds[] = {"tank", "jeep", "truck", "helicopter"};
    for (uint32_t n = 0; n < VEHICLES; n++)
        fixture_put(
            &f, (struct fixture_entity){.kind = kinds[n % 4],
                                        .at = {25000.0 + fixture_uniform(random, -side_m, side_m),
                                               fixture_uniform(random, 95.0, 120.0),
                                               25000.0 + fixture_uniform(random, -side_m, side_m)},
                                        .behaviour = BEHAVIOUR_PATROL});
}

/* By the rows themselves: near enough to be looked at, and not over or under it. */
static bool is_neighbour(const struct entities *e, uint32_t i, uint32_t j)
{
    const struct kind *kinds = f.view.world.kinds;
    double dx = e->row[j].x - e->row[i].x, dz = e->row[j].z - e->row[i].z,
           far = avoidance.around_m[e->row[i].kind];
    double apart = 0.5 * (kinds[e->row[i].kind].height_m + kinds[e->row[j].kind].height_m) + 1.0;
    return i != j && dx * dx + dz * dz <= far * far && fabs(e->row[i].y - e->row[j].y) <= apart;
}

static bool holds(const struct neighbour_list *list, uint32_t row)
{
    for (uint32_t n = 0; n < list->count; n++) {
        if (lists.entries[list->first + n].row == row)
            return true;
    }
    return false;
}

/* How many lists were made of those that are due. */
static uint32_t gather(uint32_t think, struct thread_pool *workers)
{
    struct entities e = steps_rows(&f);
    uint32_t made = 0;
    const struct neighbour_index_frame frame = {
        .committed = &e, .side_m = 50000.0, .used = VEHICLES, .tick = 0, .think_frames = think};
    neighbour_index_build(&neighbours, &frame, true, workers);
    neighbour_lists_gather(&lists, &neighbours, &f.view.world, &avoidance, 0.0, workers);
    for (uint32_t i = 0; i < VEHICLES; i++) {
        const struct neighbour_list *list = &lists.list[i];
        if (e.row[i].id % think != 0 || list->count == NEIGHBOUR_LISTS_NONE)
            continue;
        made++;
        assert_false(holds(list, i));
        for (uint32_t j = 0; j < VEHICLES; j++)
            assert_true(!is_neighbour(&e, i, j) || holds(list, j));
    }
    return made;
}

static void test_everybody_that_a_look_meets_is_listed(void **state)
{
    uint64_t random = fixture_seed(6);
    (void)state;
    scatter(&random, 3000.0);
    uint32_t made = gather(12, NULL);
    assert_true(made > VEHICLES / 24);
    struct thread_pool *workers = thread_pool_create(3);
    assert_non_null(workers);
    assert_int_equal(gather(12, workers), made);
    thread_pool_destroy(workers);
}

static void test_in_a_crowd_some_go_without_a_list(void **state)
{
    uint64_t random = fixture_seed(7);
    (void)state;
    scatter(&random, 60.0);
    assert_true(gather(1, NULL) < VEHICLES);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_everybody_that_a_look_meets_is_listed),
        TEST(test_in_a_crowd_some_go_without_a_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
