/* Aircraft that begin in each other part within seconds, and the judge finds no leap, no deeper
 * overlap and no energy: two to nine that hover, fly and hold their course, of one kind and of
 * several (thesis row 46). SEED=n draws others. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"

#include <stdint.h>
#include <stdio.h>

#define KINDS_MAX 3u
#define ALTITUDE  150.0
#define TIME_S    4.0 /* after which none is in another one */

/* A crowd: aircraft within a square of twice reach_m, of these kinds in turn. */
struct crowd {
    const char *name;
    uint32_t count;
    double reach_m, hz;
    const char *kind[KINDS_MAX];
    uint32_t kinds;
    enum behaviour behaviour;
    double speed_mps;
};

static const struct crowd crowds[] = {
    {"two that hover", 2, 3.0, 60.0, {"helicopter", "helo-cow"}, 2, BEHAVIOUR_IDLE, 0.0},
    {"two that hold", 2, 3.0, 60.0, {"helicopter"}, 1, BEHAVIOUR_HOLD, 20.0},
    {"five on patrol", 5, 5.0, 60.0, {"helicopter"}, 1, BEHAVIOUR_PATROL, 20.0},
    {"nine that hover", 9, 6.0, 60.0, {"helicopter"}, 1, BEHAVIOUR_IDLE, 0.0},
    {"nine of three kinds",
     9,
     6.0,
     60.0,
     {"helicopter", "helo-cow", "wishbone"},
     3,
     BEHAVIOUR_IDLE,
     0.0},
};

static struct fixture f;
static struct physics_check check;

static void put(const struct crowd *crowd, uint64_t *random, uint32_t i)
{
    double x = fixture_uniform(random, -crowd->reach_m, crowd->reach_m), sine, cosine;
    double z = fixture_uniform(random, -crowd->reach_m, crowd->reach_m);
    double heading = fixture_uniform(random, 0.0, TWO_PI);
    maths_sincos(heading, &sine, &cosine);
    const struct vec3 at = {25000.0 + x, steps_ground_at(&f, 25000.0, 25000.0) + ALTITUDE,
                            25000.0 + z};
    const struct vec3 velocity = {crowd->speed_mps * sine, 0.0, -crowd->speed_mps * cosine};
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = crowd->kind[i % crowd->kinds],
                                                           .behaviour = crowd->behaviour,
                                                           .at = at,
                                                           .velocity = velocity});
    struct entities e = steps_rows(&f);
    e.row[row].heading = heading;
}

/* Returns how many contacts overlap. */
static uint32_t overlapping(void)
{
    const struct state now = fixture_state(&f);
    uint32_t count = 0;
    for (uint32_t i = 0; i < now.head->contact_count; i++)
        count += (now.contacts[i].flags & PERSISTENT_CONTACT_OVERLAPS) != 0;
    return count;
}

static void part(const struct crowd *crowd, uint64_t *random)
{
    char text[96];
    snprintf(text, sizeof text, "world = { hz = %.1f; }; collision = { shape = \"model\"; };",
             crowd->hz);
    fixture_open(&f, text);
    steps_plane(&f, 0.0, 0.0);
    for (uint32_t i = 0; i < crowd->count; i++)
        put(crowd, random, i);
    judged_continue(&f, &check, (uint32_t)(crowd->hz * TIME_S));
    print_message("%s: %g pairs overlapped at once, %u are left\n", crowd->name,
                  check.measures.of[MEASURE_OF_OVERLAPPING].worst, overlapping());
    assert_true(check.measures.of[MEASURE_OF_OVERLAPPING].worst > 0.0);
    assert_int_equal(overlapping(), 0);
    judged_no_other_bad(&check, MEASURE_KINDS);
    physics_check_free(&check);
    fixture_close(&f);
}

static void test_row_46_aircraft_part(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (uint32_t i = 0; i < sizeof crowds / sizeof *crowds; i++)
        part(&crowds[i], &random);
}

static void begin_by(const char *method)
{
    uint64_t random = 7;
    char text[96];
    snprintf(text, sizeof text, "collision = { shape = \"model\"; method = \"%s\"; };", method);
    fixture_open(&f, text);
    for (uint32_t n = 0; n < crowds[4].count; n++)
        put(&crowds[4], &random, n);
}

/* The parting depends on neither the order of the pairs nor the number of threads. */
static void test_all_methods_and_threads_give_the_same(void **state)
{
    (void)state;
    steps_methods_agree(&f, begin_by);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_aircraft_part),
        cmocka_unit_test(test_all_methods_and_threads_give_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
