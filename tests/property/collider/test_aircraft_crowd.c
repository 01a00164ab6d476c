/* Aircraft that begin in each other, as a crowd, part without impacts: the impacts of 4,950 pairs
 * took 2 s in each frame (thesis row 46). SEED=n puts them elsewhere. */
#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define BODIES    60u
#define REACH_M   4.0
#define SPEED_MPS 20.0
#define FRAMES    300u
#define LEFT      8u /* pairs that may still overlap then, of 1,770 */
#define SAME      30u

static struct fixture f;

static void open_crowd(enum behaviour behaviour)
{
    uint64_t random = fixture_seed(1);
    fixture_open(&f, "world = { capacity = 512; }; collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = fixture_uniform(&random, -REACH_M, REACH_M), sine, cosine;
        double z = fixture_uniform(&random, -REACH_M, REACH_M);
        maths_sincos(fixture_uniform(&random, 0.0, TWO_PI), &sine, &cosine);
        fixture_put(
            &f, (struct fixture_entity){.kind = "helicopter",
                                        .behaviour = behaviour,
                                        .at = {25000.0 + x, 150.0, 25000.0 + z},
                                        .velocity = {SPEED_MPS * sine, 0.0, -SPEED_MPS * cosine}});
    }
}

/* Returns how many contacts overlap. Adds their impacts. */
static uint32_t overlapping(uint32_t *impacts)
{
    const struct state now = fixture_state(&f);
    uint32_t count = 0;
    for (uint32_t i = 0; i < now.head->contact_count; i++) {
        count += now.contacts[i].flags & PERSISTENT_CONTACT_OVERLAPS;
        *impacts += now.contacts[i].impacts;
    }
    return count;
}

/* Returns the sum of all velocities [m/s]: they are of one kind. */
static struct vec3 momentum(void)
{
    const struct entities e = steps_rows(&f);
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < BODIES; i++)
        sum = vec3_add(sum, entities_velocity(&e, i));
    return sum;
}

static void test_row_46_a_crowd_of_aircraft_parts_without_impacts(void **state)
{
    uint32_t impacts = 0;
    (void)state;
    open_crowd(BEHAVIOUR_HOLD);
    const struct vec3 before = momentum();
    fixture_continue(&f, 1);
    uint32_t began = overlapping(&impacts);
    assert_int_equal(impacts, 0);
    assert_true(vec3_length(vec3_sub(momentum(), before)) < 1e-9 * BODIES * SPEED_MPS);
    fixture_continue(&f, FRAMES - 1);
    uint32_t left = overlapping(&impacts);
    print_message("%u pairs overlapped, %u are left\n", began, left);
    assert_true(began > BODIES * (BODIES - 1) / 4);
    assert_true(left <= LEFT);
    fixture_close(&f);
}

static void test_row_46_threads_do_not_change_how_they_part(void **state)
{
    uint64_t digest[2];
    (void)state;
    for (uint32_t n = 0; n < 2; n++) {
        open_crowd(BEHAVIOUR_PATROL);
        fixture_threads(&f, 1 + 2 * n);
        fixture_continue(&f, SAME);
        digest[n] = fixture_digest(&f);
        fixture_close(&f);
    }
    assert_int_equal(digest[0], digest[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_a_crowd_of_aircraft_parts_without_impacts),
        cmocka_unit_test(test_row_46_threads_do_not_change_how_they_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
