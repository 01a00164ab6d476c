/* Whole battles by four methods of detection: the exact contacts are the same, and so is every
 * frame's digest (thesis rows 44, 45). SEED=n runs another battle. */
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define FRAMES 300

/* 300 vehicles on 400 m x 400 m of trees, a third of which never gives way, so that there are
 * always collisions. None cruises, because only the method "swept" knows that. */
static const char battle[] =
    "world = { seed = %llu; hz = 20.0; capacity = 1024; cruise = false; };\n"
    "objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; },\n"
    "            { kind = \"tree\"; at = [24900.0, 25050.0]; },\n"
    "            { kind = \"pine\"; at = [24950.0, 24920.0]; },\n"
    "            { kind = \"bush\"; at = [25060.0, 25030.0]; },\n"
    "            { kind = \"tree\"; at = [25125.0, 25125.0]; } );\n"
    "collision = { shape = \"%s\"; method = \"%s\"; };\n"
    "vehicles = (\n"
    "  { kind = \"tank\"; count = 90; force = \"blue\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"tank\"; count = 30; force = \"red\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"jeep\"; count = 70; force = \"red\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"jet\"; count = 10; force = \"red\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"truck\"; count = 100; behaviour = \"hold\"; speed_mps = 15.0;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; } );\n"
    "fires = ( { at_s = 0.2; munition = \"artillery\"; point = [25000.0, 25000.0]; } );\n";

static uint64_t run(const char *shape, const char *method, uint64_t seed)
{
    struct fixture f;
    char text[sizeof battle + 64];
    snprintf(text, sizeof text, battle, (unsigned long long)(seed & 0xffffffff), shape, method);
    fixture_open(&f, text);
    fixture_run(&f, FRAMES);
    uint64_t digest = fixture_digest(&f);
    const struct counters *tally = &fixture_state(&f).head->tally;
    print_message("%s by %s: %llu collisions, %llu detonations\n", shape, method,
                  (unsigned long long)tally->collisions, (unsigned long long)tally->detonations);
    assert_true(tally->collisions > 50 && tally->detonations > 30); /* else it proves nothing */
    fixture_close(&f);
    return digest;
}

static void compare(const char *shape, uint64_t seed)
{
    static const char *const methods[] = {"occupancy", "hopcroft", "brute"};
    uint64_t swept = run(shape, "swept", seed);
    for (int i = 0; i < 3; i++) {
        uint64_t digest = run(shape, methods[i], seed);
        if (digest != swept)
            fail_msg("%s by %s: %016llx; by swept %016llx", shape, methods[i],
                     (unsigned long long)digest, (unsigned long long)swept);
    }
}

static void test_rows_44_45_a_battle_of_spheres_ends_alike(void **state)
{
    (void)state;
    compare("sphere", fixture_seed(441));
}

static void test_rows_44_45_a_battle_of_models_ends_alike(void **state)
{
    (void)state;
    compare("model", fixture_seed(442));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_44_45_a_battle_of_spheres_ends_alike),
        cmocka_unit_test(test_rows_44_45_a_battle_of_models_ends_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
