/* Checksums that writers put together from pieces are those of the whole, in every frame of a busy
 * world, on any number of threads: shots, spawns, removals, pauses. Rows that the mover does not
 * name are as they were. SEED=n chooses others. */
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/checksum.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* A few that fire, each group in a block of its own among many that do not. So a block whose mark
 * is missing is not hashed because of another row. */
static const char scenario[] =
#define HERD                                                                                       \
    "{ kind = \"truck\"; count = 2100; behaviour = \"idle\";"                                      \
    "  area = [0.0, 30000.0, 50000.0, 49000.0]; },"
#define FIGHTERS(force)                                                                            \
    "{ kind = \"tank\"; count = 12; force = \"" force "\"; fire_at_will = true;"                   \
    "  area = [24700.0, 24700.0, 25300.0, 25300.0]; },"
    "world = { seed = 5; capacity = 16384; };"
    "collision = { shape = \"model\"; };"
    "vehicles = ("
    "{ kind = \"tank\"; name = \"A\"; behaviour = \"idle\"; at = [2000.0, 2000.0]; }," HERD
        FIGHTERS("blue") HERD FIGHTERS("red") HERD
    "{ kind = \"helicopter\"; behaviour = \"hold\"; speed_mps = 20.0; heading_deg = 90.0;"
    "  at = [12000.0, 12000.0]; },"
    "{ kind = \"helicopter\"; behaviour = \"hold\"; speed_mps = 20.0; heading_deg = 271.0;"
    "  at = [12100.0, 12001.0]; },"
    "{ kind = \"jeep\"; at = [3000.0, 2000.0]; } );"
    "fires = ( { at_s = 0.2; shooter = \"A\"; point = [2500.0, 2000.0]; },"
    "{ at_s = 0.9; munition = \"artillery\"; point = [25100.0, 25100.0]; } );";

#define FIRST_FIGHTER 2102u /* behind A and the first herd */
#define FRAMES        400

static struct command random_command(uint64_t *random, uint64_t number)
{
    static const enum command_type types[] = {
        COMMAND_SPAWN, COMMAND_SPAWN,   COMMAND_REMOVE, COMMAND_REMOVE, COMMAND_DRIVE,
        COMMAND_DRIVE, COMMAND_RELEASE, COMMAND_FIRE,   COMMAND_FIRE,   COMMAND_FIRE,
        COMMAND_PAUSE, COMMAND_RESUME,  COMMAND_RESUME};
    struct command command = {.source = 1, .source_sequence = number};
    command.type = types[fixture_random(random) % (sizeof types / sizeof types[0])];
    command.entity = (uint32_t)(fixture_random(random) % 6400);
    command.value[0] = command.value[1] = 25000.0;
    if (command.type == COMMAND_FIRE) { /* a fighter at the next one, others at none */
        bool fighter = fixture_random(random) % 4 != 0;
        command.entity = fighter ? FIRST_FIGHTER + command.entity % 11 : command.entity;
        command.target = fighter ? command.entity + 1 : 0;
    }
    if (command.type == COMMAND_DRIVE) {
        for (int i = 0; i < 6; i++)
            command.value[i] = fixture_uniform(random, 0.0, 1.0);
        command.force = (uint8_t)(fixture_random(random) % GEAR_COUNT);
        command.amount = (uint32_t)(fixture_random(random) % 60);
    }
    return command;
}

/* Asserts that rows which the mover did not name are those of the frame before, and rows which the
 * collider did not name those of the mover. Returns how many rows neither has named. */
static uint32_t check_written(const struct fixture *f, const struct state *now)
{
    const struct moved *m = &f->view.m;
    const struct state *before = &f->view.w[(now->head->frame - 1) & 1];
    uint32_t unwritten = 0;
    for (uint32_t row = 0; row < m->head->used; row++) {
        bool moved = m->written[row / 64] >> row % 64 & 1;
        bool answered = now->written[row / 64] >> row % 64 & 1;
        unwritten += !moved && !answered;
        assert_true(moved ||
                    entity_differing(&m->entities.row[row], &before->entities.row[row]) == 0);
        assert_true(answered ||
                    entity_differing(&now->entities.row[row], &m->entities.row[row]) == 0);
    }
    return unwritten;
}

static void check_frames(uint32_t threads, uint64_t seed)
{
    struct fixture f;
    uint32_t shots = 0, collisions = 0, unwritten = 0;
    fixture_open(&f, scenario);
    fixture_threads(&f, threads);
    for (uint64_t i = 0; i < FRAMES; i++) {
        for (uint64_t n = fixture_random(&seed) % 8; n > 5; n--)
            steps_send(&f, RING_CLIENTS, random_command(&seed, i * 4 + n));
        fixture_continue(&f, 1); /* it looks */
        struct state now = fixture_state(&f);
        unwritten += check_written(&f, &now);
        shots = (uint32_t)now.head->tally.fires;
        collisions = (uint32_t)now.head->tally.collisions;
    }
    assert_true(shots > 5 && collisions > 0 && unwritten > 1000); /* or the test looks at nothing */
    fixture_close(&f);
}

static void test_checksums_of_blocks_are_those_of_the_whole(void **state)
{
    uint64_t seed = fixture_seed(11);
    (void)state;
    check_frames(1, seed);
    check_frames(3, seed);
}

/* The moved table's checksum covers its head, rows and intents. */
static void test_every_part_of_the_moved_table_is_covered(void **state)
{
    struct fixture f;
    uint64_t seed = fixture_seed(12);
    (void)state;
    fixture_open(&f, scenario);
    do
        fixture_run(&f, 1);
    while (f.view.m.head->intent_count == 0);
    const struct moved *m = &f.view.m;
    uint64_t right = moved_checksum(m);
    unsigned char *head = (unsigned char *)m->head;
    head[offsetof(struct state_head, tick)] ^= 1;
    assert_int_not_equal(moved_checksum(m), right);
    head[offsetof(struct state_head, tick)] ^= 1;
    m->head->mover_ns ^= 1; /* a time is no part of a result */
    assert_int_equal(moved_checksum(m), right);
    m->intents[m->head->intent_count - 1].bytes[95] ^= 1;
    assert_int_not_equal(moved_checksum(m), right);
    m->intents[m->head->intent_count - 1].bytes[95] ^= 1;
#define X(type, name)                                                                              \
    {                                                                                              \
        unsigned char *cell =                                                                      \
            (unsigned char *)&m->entities.row[fixture_random(&seed) % m->head->used].name;         \
        cell[sizeof(type) - 1] ^= 0x80;                                                            \
        assert_int_not_equal(moved_checksum(m), right);                                            \
        cell[sizeof(type) - 1] ^= 0x80;                                                            \
    }
    ENTITY_FIELDS(X)
#undef X
    assert_int_equal(moved_checksum(m), right);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_checksums_of_blocks_are_those_of_the_whole),
        cmocka_unit_test(test_every_part_of_the_moved_table_is_covered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
