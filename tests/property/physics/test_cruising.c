/* Worlds in which vehicles cruise (world/entity/cruise.h) are as true as others: the judge finds no
 * overlap, no jump and no body off the ground in any frame, and every frame is the same whatever
 * the processes remember: with bombs, commands, restarts and any number of threads. SEED=n chooses
 * others, SEEDS=n judges so many. */
#include "supervisor/physics/physics_check.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

/* Vehicles on their springs jump by so much at 10 Hz, whether others cruise or not. */
#define JUMP_M 0.03

#define FRAMES 420u
#define ROWS   230u
#define LOW_M  24800.0
#define HIGH_M 25200.0

#define GROUP(kind, n, more)                                                                       \
    "{ kind = \"" kind "\"; count = " #n "; area = [24800.0, 24800.0, 25200.0, 25200.0]; " more    \
    " },"
#define PATROL "behaviour = \"patrol\";"
#define WORLD                                                                                      \
    "world = { seed = %llu; hz = %s; capacity = 1024; cruise = true; };"                           \
    "collision = { shape = \"model\"; }; terrain = { %s }; vehicles = (" GROUP("tank", 60, PATROL) \
        GROUP("jeep", 60, PATROL) GROUP("truck", 50, PATROL) GROUP(                                \
            "carrier", 30, PATROL "force = \"blue\";") GROUP("helicopter", 10, PATROL)             \
            GROUP("truck", 20, "behaviour = \"idle\";") "{ kind = \"jeep\"; behaviour = "          \
                                                        "\"idle\"; at = [2000.0, 2000.0]; } );"

#define LEVEL "source = \"flat\"; height_m = 100.0;"
#define HILLY "source = \"generated\";"

struct seen {
    uint32_t cruising; /* rows that cruise, in all frames */
    uint32_t ended;    /* stretches that ended before their time */
    uint32_t collisions, craters;
};

static void send(struct fixture *a, struct fixture *b, struct command command)
{
    steps_send(a, RING_CLIENTS, command);
    steps_send(b, RING_CLIENTS, command);
}

static void send_any(struct fixture *a, struct fixture *b, uint64_t *seed)
{
    static const enum command_type types[] = {COMMAND_DRIVE, COMMAND_DRIVE, COMMAND_RELEASE,
                                              COMMAND_REMOVE, COMMAND_FIRE};
    struct command command = {.source = 1};
    uint64_t choice = fixture_random(seed);
    command.type = types[choice % (sizeof types / sizeof types[0])];
    command.entity = 1 + (uint32_t)(fixture_random(seed) % ROWS);
    if (command.type == COMMAND_FIRE) { /* a bomb */
        command.entity = 0;
        command.kind = fixture_kind(a, "artillery");
        command.value[0] = fixture_uniform(seed, LOW_M, HIGH_M);
        command.value[1] = fixture_uniform(seed, LOW_M, HIGH_M);
    }
    for (int i = 0; command.type == COMMAND_DRIVE && i < 6; i++)
        command.value[i] = fixture_uniform(seed, 0.0, 1.0);
    command.amount = command.type == COMMAND_DRIVE ? (uint32_t)(fixture_random(seed) % 90) : 0;
    send(a, b, command);
}

/* Counts the rows that cruise, and those that did and have not come to the end of their stretch. */
static void look(const struct fixture *f, uint32_t until[ROWS], struct seen *seen)
{
    const struct state state = fixture_state(f);
    const struct entities *e = &state.entities;
    for (uint32_t i = 0; i < ROWS && i < state.head->used; i++) {
        seen->cruising += cruise_goes(e, i, state.head->tick);
        seen->ended += until[i] > state.head->tick && !cruise_goes(e, i, state.head->tick);
        until[i] = e->cruise_tick[i];
    }
    seen->collisions = (uint32_t)state.head->tally.collisions;
    seen->craters = state.head->crater_count;
}

/* Prints where two worlds differ. */
static void show_difference(const struct fixture *kept, const struct fixture *begun)
{
    struct state a = fixture_state(kept), b = fixture_state(begun);
    for (uint32_t i = 0; i < a.head->used; i++) {
#define X(type, name)                                                                              \
    if (a.entities.name[i] != b.entities.name[i])                                                  \
        print_message("frame %llu, row %u: " #name " %.17g, %.17g\n",                              \
                      (unsigned long long)a.head->frame, i, (double)a.entities.name[i],            \
                      (double)b.entities.name[i]);
        ENTITY_COLUMNS(X)
#undef X
    }
}

static uint32_t count_bad(const struct physics_check *check)
{
    uint32_t bad = 0;
    for (int i = 0; i < MEASURE_KINDS; i++) {
        if (measure_good(&check->measures, (enum measure_kind)i) ||
            (i == MEASURE_OF_JUMP && check->measures.of[i].worst <= JUMP_M))
            continue;
        bad++;
        print_message("%s: %g in frame %llu\n", measure_word((enum measure_kind)i),
                      check->measures.of[i].worst, (unsigned long long)check->measures.of[i].frame);
    }
    return bad;
}

static struct seen judge(const char *hz, const char *ground, uint64_t seed)
{
    struct fixture kept, begun;
    struct physics_check check;
    struct seen seen = {0};
    uint32_t until[ROWS] = {0};
    char text[2048];
    snprintf(text, sizeof text, WORLD, (unsigned long long)(1 + seed % 1000), hz, ground);
    fixture_open(&kept, text);
    fixture_open(&begun, text);
    begun.stepper.mover.resting.never = true;
    begun.stepper.collider.broad.resting.never = true;
    struct state state = fixture_state(&kept);
    assert_int_equal(physics_check_begin(&check, &kept.view.world, &state), 0);
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (i > 60 && fixture_random(&seed) % 8 == 0)
            send_any(&kept, &begun, &seed);
        if (fixture_random(&seed) % 30 == 0)
            fixture_threads(&begun, 1 + (uint32_t)(fixture_random(&seed) % 3));
        fixture_continue(&kept, 1);
        fixture_continue(&begun, 1);
        if (fixture_digest(&kept) != fixture_digest(&begun))
            show_difference(&kept, &begun);
        assert_int_equal(fixture_digest(&kept), fixture_digest(&begun));
        const struct physics_events events = {kept.view.events, kept.view.header->event_slots};
        state = fixture_state(&kept);
        assert_int_equal(physics_check_frame(&check, &state, &events), 0);
        look(&kept, until, &seen);
    }
    assert_int_equal(count_bad(&check), 0);
    physics_check_free(&check);
    fixture_close(&kept);
    fixture_close(&begun);
    return seen;
}

static void judge_seeds(const char *hz, const char *ground, uint64_t seed)
{
    const char *seeds = getenv("SEEDS");
    uint32_t collisions = 0, count = seeds ? (uint32_t)strtoul(seeds, NULL, 10) : 1;
    for (uint32_t n = 0; n < count; n++) {
        struct seen seen = judge(hz, ground, seed + n);
        print_message("seed %llu: %u rows cruised, %u stretches ended early, %u collisions, %u "
                      "craters\n",
                      (unsigned long long)(seed + n), seen.cruising, seen.ended, seen.collisions,
                      seen.craters);
        assert_true(seen.cruising > FRAMES);
        assert_true(seen.ended > 5);
        assert_true(seen.craters > 0);
        collisions += seen.collisions;
    }
    assert_true(collisions > 0);
}

static void test_level_ground(void **state)
{
    (void)state;
    judge_seeds("60.0", LEVEL, fixture_seed(1));
}

static void test_long_frames(void **state)
{
    (void)state;
    judge_seeds("10.0", LEVEL, fixture_seed(2));
}

static void test_hills(void **state)
{
    (void)state;
    judge_seeds("60.0", HILLY, fixture_seed(3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_ground),
        cmocka_unit_test(test_long_frames),
        cmocka_unit_test(test_hills),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
