/* Rows that rest are not moved, and bodies that rest keep their records, and no bit of the world
 * differs from one in which every row is moved and boxed in every frame: with shots, bombs,
 * craters, commands, restarts and any number of threads. SEED=n chooses others. */
#include "tests/support/fixture.h"
#include "tests/support/remotes.h"
#include "tests/support/steps.h"
#include "world/maths/dead_reckoning.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define FRAMES 700u

/* Vehicles that stand, alone and in the way of others; some of them look for enemies, hover, have
 * no rounds, or a course that they do not follow. */
#define GROUP(kind, n, more)                                                                       \
    "{ kind = \"" kind "\"; count = " #n "; area = [24600.0, 24600.0, 25400.0, 25400.0]; " more    \
    " },"
#define HERD(kind, n, more)                                                                        \
    "{ kind = \"" kind "\"; count = " #n "; area = [24000.0, 24000.0, 26000.0, 26000.0]; " more    \
    " },"
#define IDLE   "behaviour = \"idle\";"
#define PATROL "behaviour = \"patrol\";"
#define FAR    "{ kind = \"jeep\"; behaviour = \"idle\"; at = [2000.0, 2000.0]; }"
#define STANDING                                                                                   \
    GROUP("tank", 200, IDLE)                                                                       \
    GROUP("truck", 200, IDLE)                                                                      \
    GROUP("jeep", 60, IDLE "force = \"red\"; fire_at_will = true;")                                \
    GROUP("tank", 20, IDLE "force = \"blue\";")                                                    \
    GROUP("helicopter", 40, IDLE)                                                                  \
    GROUP("howitzer", 10, IDLE "force = \"blue\";")
#define OTHERS                                                                                     \
    GROUP("tank", 12, "force = \"blue\"; fire_at_will = true;")                                    \
    GROUP("jeep", 30, "behaviour = \"hold\"; speed_mps = 0.0;")                                    \
    GROUP("jeep", 10, "behaviour = \"hold\"; speed_mps = 9.0;")                                    \
    GROUP("truck", 30, PATROL)                                                                     \
    GROUP("helicopter", 16, PATROL)
#define WORLD(shape, ground)                                                                       \
    "world = { seed = 5; capacity = 4096; }; collision = { shape = \"" shape "\"; };"              \
    "terrain = { " ground " }; vehicles = (" STANDING OTHERS FAR " );"

static const char flat[] = WORLD("sphere", "source = \"flat\"; height_m = 100.0;");
#define REMOTES 60u
static const char strangers[] =
    "world = { seed = 5; capacity = 4096; remotes_max = 60; }; collision = { shape = \"model\"; };"
    "terrain = { source = \"flat\"; height_m = 100.0; }; vehicles = (" STANDING OTHERS FAR " );";
static const char shaped[] = WORLD("model", "source = \"flat\"; height_m = 100.0;");

/* Blocks of 1,024 rows in which all rest, and others that drive and fly through them and fight. */
#define FIGHTERS                                                                                   \
    GROUP("jeep", 30, PATROL)                                                                      \
    GROUP("tank", 12, "force = \"blue\"; fire_at_will = true;")                                    \
    GROUP("tank", 12, "force = \"red\"; fire_at_will = true;")                                     \
    GROUP("tank", 30, "behaviour = \"hold\"; speed_mps = 12.0;")
static const char herds[] =
    "world = { seed = 6; capacity = 8192; }; collision = { shape = \"model\"; };"
    "terrain = { source = \"flat\"; height_m = 100.0; };"
    "vehicles = (" HERD("truck", 1500, IDLE) FIGHTERS HERD("jeep", 1000, IDLE)
        HERD("helicopter", 1200, IDLE) HERD("helicopter", 20, PATROL) FAR " );";

/* Two forces that stand and fire at each other, among others that stand. */
static const char duels[] =
    "world = { seed = 7; capacity = 4096; }; collision = { shape = \"model\"; };"
    "terrain = { source = \"flat\"; height_m = 100.0; }; vehicles = (" STANDING HERD(
        "tank", 60, IDLE "force = \"red\"; fire_at_will = true;")
        HERD("tank", 60, IDLE "force = \"blue\"; fire_at_will = true;")
            HERD("helicopter", 16, PATROL) FAR " );";

#define ROWS 629u

static struct command random_command(uint64_t *random, uint64_t number)
{
    static const enum command_type types[] = {
        COMMAND_SPAWN, COMMAND_REMOVE, COMMAND_DRIVE, COMMAND_DRIVE,  COMMAND_RELEASE,
        COMMAND_FIRE,  COMMAND_FIRE,   COMMAND_PAUSE, COMMAND_RESUME, COMMAND_RESUME};
    struct command command = {.source = 1, .source_sequence = number};
    command.type = types[fixture_random(random) % (sizeof types / sizeof types[0])];
    command.entity = 1 + (uint32_t)(fixture_random(random) % ROWS);
    command.target = fixture_random(random) % 2 ? 1 + (uint32_t)(fixture_random(random) % ROWS) : 0;
    command.value[0] = fixture_uniform(random, 24600.0, 25400.0);
    command.value[1] = fixture_uniform(random, 24600.0, 25400.0);
    if (command.type == COMMAND_DRIVE) {
        for (int i = 0; i < 6; i++)
            command.value[i] = fixture_uniform(random, -1.0, 1.0);
        command.force = (uint8_t)(fixture_random(random) % GEAR_COUNT);
        command.amount = (uint32_t)(fixture_random(random) % 60);
    }
    return command;
}

static uint32_t count_resting(const struct fixture *f)
{
    const struct resting_rows *rows = &f->stepper.mover.resting;
    uint32_t count = 0, used = fixture_state(f).head->used;
    for (uint32_t i = 0; i < used; i++)
        count += rows->resting[i / 64] >> i % 64 & 1;
    return count;
}

static uint32_t count_remotes_at_rest(const struct fixture *f)
{
    const struct resting_rows *rows = &f->stepper.mover.resting;
    const struct state state = fixture_state(f);
    uint32_t count = 0;
    for (uint32_t i = 0; i < state.head->used; i++)
        count += remote_is(&state.entities, i) && (rows->resting[i / 64] >> i % 64 & 1);
    return count;
}

/* Counts the rows at rest whose guns are laid on a target. */
static uint32_t count_laid(const struct fixture *f)
{
    const struct resting_rows *rows = &f->stepper.mover.resting;
    const struct state state = fixture_state(f);
    uint32_t count = 0;
    for (uint32_t i = 0; i < state.head->used; i++)
        count += state.entities.row[i].target_id != 0 && (rows->resting[i / 64] >> i % 64 & 1);
    return count;
}

static uint32_t count_hovering(const struct fixture *f)
{
    const struct resting_rows *rows = &f->stepper.mover.resting;
    uint32_t count = 0, used = fixture_state(f).head->used;
    for (uint32_t i = 0; i < used; i++)
        count += (rows->resting[i / 64] & rows->hovering.hovers[i / 64]) >> i % 64 & 1;
    return count;
}

static uint32_t count_kept(const struct fixture *f)
{
    const struct resting_records *resting = &f->stepper.collider.broad.resting;
    uint32_t count = 0, used = fixture_state(f).head->used;
    for (uint32_t i = 0; i < used; i++)
        count += resting->kept[i / 64] >> i % 64 & 1;
    return count;
}

/* Drops a bomb that bursts on the ground in the next frame. */
static void drop(struct fixture *f, double x, double z)
{
    struct command command = {
        .source = 1, .type = COMMAND_FIRE, .kind = fixture_kind(f, "artillery")};
    command.value[0] = x;
    command.value[1] = z;
    steps_send(f, RING_CLIENTS, command);
}

struct seen {
    uint32_t most, woken; /* rows at rest at once, frames in which rows woke */
    uint32_t left_hover;  /* frames in which rows woke that hovered alone */
    uint32_t kept, left;  /* frames with records that are kept, and in which some are let go */
    uint32_t craters, destroyed;
    uint32_t laid;    /* rows at rest with a laid gun, in all frames */
    uint32_t remotes; /* frames with more than ten entities of others at rest */
};

/* A record of another simulator in the middle of the vehicles; three of four entities stand. */
static struct remote_record random_record(const struct fixture *fixture, uint64_t *seed)
{
    struct remote_record record = remotes_any(fixture, seed);
    if (record.type != REMOTE_TRACK)
        return record;
    record.remote = remote_id(7, 1, (uint16_t)(1 + fixture_random(seed) % REMOTES));
    record.position[0] = fixture_uniform(seed, 24600.0, 25400.0);
    record.position[2] = fixture_uniform(seed, 24600.0, 25400.0);
    if (fixture_random(seed) % 4 != 0)
        record.model = DEAD_RECKONING_STATIC;
    return record;
}

static struct seen compare(const char *scenario, uint64_t seed)
{
    struct fixture rests, moves;
    struct seen seen = {0};
    uint32_t before = 0, kept_before = 0, hovering_before = 0;
    fixture_open(&rests, scenario);
    fixture_open(&moves, scenario);
    moves.stepper.mover.resting.never = true;
    moves.stepper.collider.broad.resting.never = true;
    for (uint64_t i = 0; i < FRAMES; i++) {
        if (i > 120 && fixture_random(&seed) % 4 == 0) {
            struct command command = random_command(&seed, i);
            steps_send(&rests, RING_CLIENTS, command);
            steps_send(&moves, RING_CLIENTS, command);
        }
        if (i > 120 && fixture_random(&seed) % 40 == 0) {
            double x = fixture_uniform(&seed, 24600.0, 25400.0);
            drop(&rests, x, 25000.0);
            drop(&moves, x, 25000.0);
        }
        if (fixture_state(&rests).head->frame > 60 && rests.view.world.params->remotes_max > 0 &&
            fixture_random(&seed) % 3 != 0) {
            struct remote_record record = random_record(&rests, &seed);
            remotes_send(&rests, record);
            remotes_send(&moves, record);
        }
        if (fixture_random(&seed) % 150 == 0)
            fixture_threads(&rests, 1 + (uint32_t)(fixture_random(&seed) % 3));
        fixture_continue(&rests, 1);
        fixture_continue(&moves, 1);
        struct state a = fixture_state(&rests), b = fixture_state(&moves);
        assert_int_equal(a.head->event_digest, b.head->event_digest);
        assert_int_equal(steps_state_hash(&rests, &a), steps_state_hash(&moves, &b));
        seen.laid += count_laid(&rests);
        seen.remotes += count_remotes_at_rest(&rests) > 10;
        uint32_t count = count_resting(&rests), kept = count_kept(&rests);
        uint32_t hovering = count_hovering(&rests);
        seen.left_hover += hovering < hovering_before;
        hovering_before = hovering;
        seen.woken += count < before;
        seen.most = count > seen.most ? count : seen.most;
        seen.kept += kept > 0;
        seen.left += kept < kept_before;
        before = count;
        kept_before = kept;
        assert_int_equal(count_resting(&moves) + count_kept(&moves), 0);
    }
    const struct state_head *head = fixture_state(&rests).head;
    seen.craters = head->crater_count;
    seen.destroyed = (uint32_t)head->tally.destroyed;
    printf("most at rest %u, frames: %u in which rows woke, %u in which rows that hovered did, %u "
           "with kept records, %u in which some "
           "left; craters %u, destroyed %u\n",
           seen.most, seen.woken, seen.left_hover, seen.kept, seen.left, seen.craters,
           seen.destroyed);
    assert_true(seen.most > 400 && seen.woken > 50 && seen.left_hover > 5 && seen.craters > 3 &&
                seen.destroyed > 3);
    fixture_close(&rests);
    fixture_close(&moves);
    return seen;
}

static void test_rows_that_rest_change_no_bit(void **state)
{
    uint64_t seed = fixture_seed(14);
    (void)state;
    compare(flat, seed);
}

static void test_entities_of_others_that_rest_change_no_bit(void **state)
{
    uint64_t seed = fixture_seed(17);
    (void)state;
    struct seen seen = compare(strangers, seed);
    assert_true(seen.remotes > 300);
}

static void test_bodies_that_rest_change_no_bit(void **state)
{
    uint64_t seed = fixture_seed(15);
    (void)state;
    compare(shaped, seed);
}

static void test_guns_that_are_laid_change_no_bit(void **state)
{
    uint64_t seed = fixture_seed(18);
    (void)state;
    struct seen seen = compare(duels, seed);
    print_message("rows at rest with a laid gun, in all frames: %u\n", seen.laid);
    assert_true(seen.laid > 2000);
}

static void test_herds_that_rest_change_no_bit(void **state)
{
    uint64_t seed = fixture_seed(16);
    (void)state;
    struct seen seen = compare(herds, seed);
    assert_true(seen.kept > 60 && seen.left > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_that_rest_change_no_bit),
        cmocka_unit_test(test_entities_of_others_that_rest_change_no_bit),
        cmocka_unit_test(test_bodies_that_rest_change_no_bit),
        cmocka_unit_test(test_guns_that_are_laid_change_no_bit),
        cmocka_unit_test(test_herds_that_rest_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
