/* Four vertices at a time reach as far, to the bit, as one after the other. */
#include "collider/geometry/vertex_reach.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define VERTICES_MAX 41u
#define ROUNDS       200

static struct vec3 vertex[VERTICES_MAX];

/* Vertices of a coarse grid, of which many reach as far as others. */
static struct vec3 draw(uint64_t *random, uint32_t count, bool coarse)
{
    for (uint32_t i = 0; i < count; i++) {
        vertex[i] =
            (struct vec3){fixture_uniform(random, -4.0, 4.0), fixture_uniform(random, -2.0, 2.0),
                          fixture_uniform(random, -1.0, 1.0)};
        if (coarse)
            vertex[i] = (struct vec3){floor(vertex[i].x), floor(vertex[i].y), floor(vertex[i].z)};
    }
    if (coarse)
        return (struct vec3){floor(fixture_uniform(random, -1.0, 2.0)), 1.0, 0.0};
    return (struct vec3){fixture_uniform(random, -1.0, 1.0), fixture_uniform(random, -1.0, 1.0),
                         fixture_uniform(random, -1.0, 1.0)};
}

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void test_reaches_are_those_of_single_vertices(void **state)
{
    uint64_t random = fixture_seed(211);
    (void)state;
    for (uint32_t round = 0; round < ROUNDS * VERTICES_MAX; round++) {
        uint32_t count = 1 + round % VERTICES_MAX, first = 0;
        double each[VERTICES_MAX + 1], most = -INFINITY;
        struct vec3 direction = draw(&random, count, round % 2 == 0);
        for (uint32_t i = 0; i < count; i++) {
            double reach = vec3_dot(vertex[i], direction);
            first = reach > most ? i : first;
            most = maths_max(most, reach);
        }
        each[count] = 7.0;
        assert_int_equal(vertex_reach_first(vertex, count, direction), first);
        assert_int_equal(vertex_reach_each(vertex, count, direction, each), first);
        for (uint32_t i = 0; i < count; i++)
            assert_true(same_bits(each[i], vec3_dot(vertex[i], direction)));
        assert_true(each[count] == 7.0);
        assert_true(vertex_reach_most(vertex, count, direction) == most);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reaches_are_those_of_single_vertices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
