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
#define ROWS   270u
/* Vehicles in a square of 400 m. */
#define GROUP(kind, n, more)                                                                       \
    "{ kind = \"" kind "\"; count = " #n "; area = [24800.0, 24800.0, 25200.0, 25200.0]; " more    \
    " },"
#define PATROL "behaviour = \"patrol\";"
#define IDLE   "behaviour = \"idle\";"
/* Aircraft that have room to fly evenly, some of them over the others. */
#define WIDE(kind, n)                                                                              \
    "{ kind = \"" kind "\"; count = " #n "; area = [23800.0, 23800.0, 26200.0, 26200.0]; " PATROL  \
    "}, "
/* Ships and aircraft before a coast. */
#define COAST(kind, n)                                                                             \
    "{ kind = \"" kind "\"; count = " #n "; area = [2600.0, 33000.0, 3600.0, 34000.0]; " PATROL    \
    "}, "

struct setting {
    const char *hz, *ground, *vehicles;
    double low_x_m, low_z_m, side_m; /* where bombs fall */
    uint32_t decides_every;          /* [frame] as agents do in a large world; 0: in this one */
};

static const char on_land[] = GROUP("tank", 60, PATROL) GROUP("jeep", 60, PATROL)
    GROUP("truck", 50, PATROL) GROUP("carrier", 30, PATROL "force = \"blue\";")
        GROUP("helicopter", 10, PATROL) GROUP("truck", 20, IDLE) GROUP("helicopter", 4, IDLE)
            WIDE("helicopter", 16) WIDE("helo-cow", 10) WIDE("jet", 9);
static const char far_apart[] =
    WIDE("tank", 80) WIDE("jeep", 60) WIDE("truck", 60) WIDE("carrier", 20) WIDE("helicopter", 20);
static const char at_sea[] = COAST("ship", 70) COAST("helicopter", 10) COAST("jet", 4);

#define LEVEL "source = \"flat\"; height_m = 100.0;"
#define HILLY "source = \"generated\";"

struct seen {
    uint32_t cruising; /* rows that cruise, in all frames */
    uint32_t others;   /* of these, aircraft and ships */
    uint32_t ended;    /* stretches that ended before their time */
    uint32_t collisions, craters;
};

static void send(struct fixture *a, struct fixture *b, struct command command)
{
    steps_send(a, RING_CLIENTS, command);
    steps_send(b, RING_CLIENTS, command);
}

static void send_any(struct fixture *a, struct fixture *b, const struct setting *setting,
                     uint64_t *seed)
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
        command.value[0] = setting->low_x_m + fixture_uniform(seed, 0.0, setting->side_m);
        command.value[1] = setting->low_z_m + fixture_uniform(seed, 0.0, setting->side_m);
    }
    for (int i = 0; command.type == COMMAND_DRIVE && i < 6; i++) /* throttle first */
        command.value[i] = i == 0 ? 1.0 : fixture_uniform(seed, 0.0, 0.3);
    command.amount =
        command.type == COMMAND_DRIVE ? 60 + (uint32_t)(fixture_random(seed) % 240) : 0;
    send(a, b, command);
}

/* Counts the rows that cruise, and those that did and have not come to the end of their stretch. */
static void look(const struct fixture *f, uint32_t until[ROWS], struct seen *seen)
{
    const struct state state = fixture_state(f);
    const struct entities *e = &state.entities;
    for (uint32_t i = 0; i < ROWS && i < state.head->used; i++) {
        bool other = f->view.world.kinds[e->row[i].kind].domain != DOMAIN_LAND;
        seen->cruising += cruise_goes(e, i, state.head->tick);
        seen->others += other && cruise_goes(e, i, state.head->tick);
        seen->ended += until[i] > state.head->tick && !cruise_goes(e, i, state.head->tick);
        until[i] = e->row[i].cruise_tick;
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
    if (a.entities.row[i].name != b.entities.row[i].name)                                          \
        print_message("frame %llu, row %u: " #name " %.17g, %.17g\n",                              \
                      (unsigned long long)a.head->frame, i, (double)a.entities.row[i].name,        \
                      (double)b.entities.row[i].name);
        ENTITY_FIELDS(X)
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
        print_message("%s: %g in frame %llu, entities %u and %u\n",
                      measure_word((enum measure_kind)i), check->measures.of[i].worst,
                      (unsigned long long)check->measures.of[i].frame,
                      check->measures.of[i].body[0].id, check->measures.of[i].body[1].id);
    }
    return bad;
}

static struct seen judge(const struct setting *setting, uint64_t seed)
{
    struct fixture kept, begun;
    struct physics_check check;
    struct seen seen = {0};
    uint32_t until[ROWS] = {0};
    char text[4096];
    snprintf(text, sizeof text,
             "world = { seed = %llu; hz = %s; capacity = 1024; cruise = true; }; "
             "collision = { shape = \"model\"; }; terrain = { %s }; vehicles = (%s "
             "{ kind = \"jeep\"; behaviour = \"idle\"; at = [25000.0, 20000.0]; });",
             (unsigned long long)(1 + seed % 1000), setting->hz, setting->ground,
             setting->vehicles);
    fixture_open(&kept, text);
    fixture_open(&begun, text);
    begun.stepper.mover.resting.never = true;
    begun.stepper.collider.broad.resting.never = true;
    kept.stepper.mover.decides_every = setting->decides_every;
    struct state state = fixture_state(&kept);
    assert_int_equal(physics_check_begin(&check, &kept.view.world, &state), 0);
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (i > 60 && fixture_random(&seed) % 3 == 0)
            send_any(&kept, &begun, setting, &seed);
        if (fixture_random(&seed) % 30 == 0)
            fixture_threads(&begun, 1 + (uint32_t)(fixture_random(&seed) % 3));
        begun.stepper.mover.decides_every = setting->decides_every;
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

static void judge_seeds(const struct setting *setting, uint64_t seed)
{
    const char *seeds = getenv("SEEDS");
    uint32_t collisions = 0, count = seeds ? (uint32_t)strtoul(seeds, NULL, 10) : 1;
    for (uint32_t n = 0; n < count; n++) {
        struct seen seen = judge(setting, seed + n);
        print_message("seed %llu: %u rows cruised, %u not on land, %u stretches ended early, %u "
                      "collisions, %u "
                      "craters\n",
                      (unsigned long long)(seed + n), seen.cruising, seen.others, seen.ended,
                      seen.collisions, seen.craters);
        assert_true(seen.cruising > FRAMES && seen.others > FRAMES);
        assert_true(seen.ended > 5);
        assert_true(seen.craters > 0 || setting->vehicles == at_sea); /* water has none */
        collisions += seen.collisions;
    }
    assert_true(collisions > 0 || setting->vehicles == at_sea);
}

static void test_level_ground(void **state)
{
    (void)state;
    const struct setting setting = {"60.0", LEVEL, on_land, 24800.0, 24800.0, 400.0, 0};
    judge_seeds(&setting, fixture_seed(1));
}

static void test_long_frames(void **state)
{
    (void)state;
    const struct setting setting = {"10.0", LEVEL, on_land, 24800.0, 24800.0, 400.0, 0};
    judge_seeds(&setting, fixture_seed(2));
}

static void test_hills(void **state)
{
    (void)state;
    const struct setting setting = {"60.0", HILLY, on_land, 24800.0, 24800.0, 400.0, 0};
    judge_seeds(&setting, fixture_seed(3));
}

/* In a large world agents decide seldom, and stretches are as long as two seconds. */
static void test_long_stretches(void **state)
{
    (void)state;
    const struct setting setting = {"60.0", HILLY, far_apart, 24000.0, 24000.0, 2000.0, 33};
    judge_seeds(&setting, fixture_seed(6));
}

static void test_sea(void **state)
{
    (void)state;
    const struct setting setting = {"60.0", HILLY, at_sea, 2600.0, 33000.0, 1000.0, 0};
    judge_seeds(&setting, fixture_seed(4));
}

/* Agents decide at the beginning of a stretch. When they did not look ahead there, these collided
 * 61 times. */
static void test_agents_look_ahead(void **state)
{
    struct fixture f;
    char text[512];
    (void)state;
    snprintf(text, sizeof text,
             "world = { seed = %llu; capacity = 1024; cruise = true; }; terrain = { %s }; "
             "vehicles = ({ kind = \"hamburger\"; count = 120; behaviour = \"patrol\"; "
             "area = [31000.0, 21900.0, 31700.0, 22600.0]; });",
             (unsigned long long)(1 + fixture_seed(5) % 1000), LEVEL);
    fixture_open(&f, text);
    fixture_continue(&f, 6000);
    print_message("%llu collisions\n",
                  (unsigned long long)fixture_state(&f).head->tally.collisions);
    assert_true(fixture_state(&f).head->tally.collisions <= 6);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_ground), cmocka_unit_test(test_long_frames),
        cmocka_unit_test(test_hills),        cmocka_unit_test(test_long_stretches),
        cmocka_unit_test(test_sea),          cmocka_unit_test(test_agents_look_ahead),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
