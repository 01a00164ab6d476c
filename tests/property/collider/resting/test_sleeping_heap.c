/* Heaps that sleep (thesis row 36): a frame leaves their contacts as they are, without a look at
 * anything but who is awake, and no bit of the world differs from one in which each contact is
 * looked at in every frame. Bombs, drivers and bodies that are removed wake them, on one and two
 * threads. SEED=n chooses others. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define FRAMES 2400u
#define QUIET  400u /* frames between two disturbances */
#define BODIES 26u

#define WORLD(response)                                                                            \
    "world = { seed = 7; capacity = 512; }; terrain = { source = \"flat\"; height_m = 100.0; };"   \
    "collision = { shape = \"model\"; response = \"" response "\"; };"                             \
    "objects = ( { kind = \"tree\"; at = [25003.0, 25001.0]; },"                                   \
    "            { kind = \"bush\"; at = [24996.0, 25002.0]; },"                                   \
    "            { kind = \"building\"; at = [25018.0, 25000.0]; } );"

/* Bodies that stand, many of them in each other. */
static void put_heap(struct fixture *f, uint64_t random)
{
    static const char *const kinds[] = {"tank", "jeep", "truck"};
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = fixture_uniform(&random, 24990.0, 25010.0);
        double z = fixture_uniform(&random, 24990.0, 25010.0);
        fixture_put(f,
                    (struct fixture_entity){.kind = kinds[i % 3],
                                            .at = {x, FIXTURE_GROUND_M, z},
                                            .heading_rad = fixture_uniform(&random, 0.0, TWO_PI)});
    }
}

static void disturb(struct fixture *rests, struct fixture *looks, uint64_t *random)
{
    static const enum command_type types[] = {COMMAND_FIRE, COMMAND_DRIVE, COMMAND_REMOVE};
    struct command command = {.source = 1, .type = types[fixture_random(random) % 3]};
    command.entity = 1 + (uint32_t)(fixture_random(random) % BODIES);
    if (command.type == COMMAND_FIRE) { /* a bomb */
        command.entity = 0;
        command.kind = fixture_kind(rests, "artillery");
        command.value[0] = fixture_uniform(random, 24985.0, 25015.0);
        command.value[1] = fixture_uniform(random, 24985.0, 25015.0);
    } else if (command.type == COMMAND_DRIVE) {
        command.value[0] = fixture_uniform(random, -1.0, 1.0);
        command.value[1] = 1.0;
        command.amount = 40;
    }
    steps_send(rests, RING_CLIENTS, command);
    steps_send(looks, RING_CLIENTS, command);
}

struct seen {
    uint32_t slept, woken; /* frames */
};

static void compare(const char *scenario, uint64_t random, struct seen *seen)
{
    struct fixture rests, looks;
    bool before = false;
    fixture_open(&rests, scenario);
    fixture_open(&looks, scenario);
    put_heap(&rests, random);
    put_heap(&looks, random);
    looks.stepper.collider.broad.resting.never = true;
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (i % QUIET == QUIET - 1)
            disturb(&rests, &looks, &random);
        if (fixture_random(&random) % 300 == 0)
            fixture_threads(&rests, 1 + (uint32_t)(fixture_random(&random) % 2));
        uint32_t known = fixture_state(&rests).head->contact_count;
        fixture_continue(&rests, 1);
        fixture_continue(&looks, 1);
        struct state a = fixture_state(&rests), b = fixture_state(&looks);
        bool now = rests.stepper.collider.slept && known > 0;
        assert_int_equal(a.head->event_digest, b.head->event_digest);
        assert_int_equal(steps_state_hash(&rests, &a), steps_state_hash(&looks, &b));
        assert_false(looks.stepper.collider.slept && known > 0);
        seen->slept += now;
        seen->woken += before && !now;
        before = now;
    }
    fixture_close(&rests);
    fixture_close(&looks);
}

static void test_row_36_a_heap_that_sleeps_is_the_same(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(36);
    struct seen seen = {0};
    compare(WORLD("impulse"), seed, &seen);
    compare(WORLD("spring"), seed + 1, &seen);
    compare(WORLD("none"), seed + 2, &seen);
    print_message("all contacts slept in %u of %u frames, and woke %u times\n", seen.slept,
                  3 * FRAMES, seen.woken);
    assert_true(seen.slept > FRAMES / 8 && seen.woken > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_36_a_heap_that_sleeps_is_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
