/* Worlds of random missions: the same digest and the same events on 1, 2 and 4 threads, with
 * restarts of both processes, and from an image of any frame. */
#include "ipc/segment/segment_attach.h"
#include "tests/support/fixture.h"
#include "tests/support/image_file.h"
#include "tests/support/scenario_text.h"
#include "world/enum_names.h"
#include "world/state.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define ROUNDS 6
#define FRAMES 1800u /* 60 s at 30 Hz */
#define PARTS  3u    /* of a run; between two of them the processes start again */
#define GROUPS 6

static void add_condition(struct scenario_text *text, uint64_t *seed, const char *when)
{
    switch (fixture_random(seed) % 5) {
    case 0:
        scenario_text_add(text, "%staken = \"%c\"; ", when, (int)('x' + fixture_random(seed) % 2));
        break;
    case 1:
        scenario_text_add(text, "%slost = \"%c\"; ", when, (int)('x' + fixture_random(seed) % 2));
        break;
    case 2:
        scenario_text_add(text, "%sbelow = %.2f; ", when, fixture_uniform(seed, 0.3, 1.0));
        break;
    case 3:
        scenario_text_add(text, "%senemy_in = \"%c\"; ", when,
                          (int)('x' + fixture_random(seed) % 2));
        break;
    default:
        scenario_text_add(text, "%safter = \"g%d.p0\"; ", when,
                          (int)(fixture_random(seed) % GROUPS));
        break;
    }
}

static void add_phase(struct scenario_text *text, uint64_t *seed, int number)
{
    enum mission_order order = (enum mission_order)(fixture_random(seed) % MISSION_ORDER_COUNT);
    scenario_text_add(text, "{ name = \"p%d\"; order = \"%s\"; ", number,
                      mission_order_name(order));
    if (order != MISSION_HOLD && order != MISSION_RESERVE)
        scenario_text_add(text, "objective = \"%c\"; ", (int)('x' + fixture_random(seed) % 2));
    if (fixture_random(seed) % 2)
        scenario_text_add(text, "arrived = 0.5; ");
    if (fixture_random(seed) % 2)
        add_condition(text, seed, "");
    scenario_text_add(text, "for_s = %.1f; },", fixture_uniform(seed, 1.0, 20.0));
}

static void write_world(struct scenario_text *text, uint64_t *seed)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "helicopter"};
    text->used = 0;
    scenario_text_add(
        text,
        "world = { hz = 30.0; seed = %d; capacity = 256; };"
        "battle = { end_s = 30.0; again_s = 40.0; };"
        "objectives = ( { name = \"x\"; area = [24800.0, 24800.0, 25100.0, 25200.0]; force = "
        "\"blue\"; }, { name = \"y\"; area = [25100.0, 24800.0, 25400.0, 25200.0]; } );"
        "vehicles = (",
        (int)(fixture_random(seed) % 1000));
    for (int g = 0; g < GROUPS; g++)
        scenario_text_add(
            text,
            "{ group = \"g%d\"; kind = \"%s\"; count = 5; force = \"%s\"; area = [%d, 24600, "
            "%d, 25400]; },",
            g, kinds[fixture_random(seed) % 4], g % 2 ? "red" : "blue", g % 2 ? 25200 : 24500,
            g % 2 ? 25700 : 25000);
    text->used--;
    scenario_text_add(text, "); missions = (");
    for (int g = 0; g < GROUPS; g++) {
        scenario_text_add(text, "{ name = \"g%d\"; phases = (", g);
        for (int p = 0; p < 3; p++)
            add_phase(text, seed, p);
        text->used--;
        scenario_text_add(text, "); reactions = ( { name = \"r\"; order = \"hold\"; for_s = 4.0; ");
        add_condition(text, seed, "when_");
        scenario_text_add(text, "} ); },");
    }
    text->used--;
    scenario_text_add(text, ");");
}

struct course {
    uint64_t digest, events;
    struct battle_state battle;
};

static struct course run(const char *text, const uint32_t threads[PARTS])
{
    struct fixture f;
    fixture_open(&f, text);
    for (uint32_t part = 0; part < PARTS; part++) {
        fixture_threads(&f, threads[part]);
        fixture_continue(&f, FRAMES / PARTS);
    }
    const struct state_head *head = fixture_state(&f).head;
    struct course outcome = {fixture_digest(&f), head->event_digest, head->battle};
    fixture_close(&f);
    return outcome;
}

static void check_same(const struct course *a, const struct course *b)
{
    assert_int_equal(a->digest, b->digest);
    assert_int_equal(a->events, b->events);
    assert_memory_equal(&a->battle, &b->battle, sizeof a->battle);
}

static void test_threads_and_restarts_change_nothing(void **state)
{
    static const uint32_t threads[][PARTS] = {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {1, 4, 2}};
    static struct scenario_text text;
    uint64_t seed = fixture_seed(39);
    uint32_t phases = 0;
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        write_world(&text, &seed);
        struct course first = run(text.at, threads[0]);
        for (int n = 1; n < 4; n++) {
            struct course other = run(text.at, threads[n]);
            check_same(&first, &other);
        }
        assert_int_equal(first.battle.round, 2);
        for (int g = 0; g < GROUPS; g++)
            phases += first.battle.mission[g].phase > 0;
    }
    assert_true(phases > ROUNDS); /* something has happened */
}

/* A world that continues from an image of a frame in mid-phase goes the same way. */
static void test_an_image_holds_the_missions(void **state)
{
    static struct scenario_text text;
    uint64_t seed = fixture_seed(40);
    (void)state;
    for (int round = 0; round < 2; round++) {
        struct fixture f;
        struct view view;
        char path[PATH_MAX];
        write_world(&text, &seed);
        fixture_open(&f, text.at);
        fixture_run(&f, 400 + (uint32_t)(fixture_random(&seed) % 300));
        image_file_save(&f.view, image_file_path(path, "missions.image"), true);
        image_file_load(&view, path);
        fixture_run(&f, 600);
        image_file_run(&view, fixture_state(&f).head->frame);
        assert_int_equal(image_file_digest(&view), fixture_digest(&f));
        segment_detach(&view);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_and_restarts_change_nothing),
        cmocka_unit_test(test_an_image_holds_the_missions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
