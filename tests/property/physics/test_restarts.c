/* A mover or collider that is killed forgets what it remembers to compute less. The frames after
 * that are the same: each world here is computed twice, once by roles that begin anew again and
 * again. SEED=n runs other worlds; SCENARIO=path FRAMES=n another scenario. */
#include "tests/support/fixture.h"
#include "world/state.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROWS_SHOWN 4u

/* Prints where two worlds differ. */
static void show_difference(const struct fixture *kept, const struct fixture *begun)
{
    struct state a = fixture_state(kept), b = fixture_state(begun);
    uint32_t shown = 0;
    for (uint32_t i = 0; i < a.head->used && shown < ROWS_SHOWN; i++) {
        bool differs = false;
#define X(type, name)                                                                              \
    if (a.entities.row[i].name != b.entities.row[i].name) {                                        \
        differs = true;                                                                            \
        print_message("row %u: " #name " %.17g, %.17g\n", i, (double)a.entities.row[i].name,       \
                      (double)b.entities.row[i].name);                                             \
    }
        ENTITY_FIELDS(X)
#undef X
        shown += differs;
    }
}

static void compare(const char *text, uint32_t frames, uint64_t seed)
{
    struct fixture kept, begun;
    fixture_open(&kept, text);
    fixture_open(&begun, text);
    fixture_forget_copies(&kept);
    for (uint32_t frame = 1; frame <= frames; frame++) {
        if (fixture_random(&seed) % 4 == 0)
            fixture_threads(&begun, 1);
        fixture_continue(&kept, 1);
        fixture_continue(&begun, 1);
        if (fixture_digest(&kept) == fixture_digest(&begun))
            continue;
        show_difference(&kept, &begun);
        fail_msg("frame %u differs", frame);
    }
    fixture_close(&kept);
    fixture_close(&begun);
}

static void test_heaps_and_wrecks_go_on_alike(void **state)
{
    uint64_t seed = fixture_seed(91);
    char text[1024];
    (void)state;
    snprintf(text, sizeof text,
             "world = { seed = %u; capacity = 256; hz = 20.0; };\n"
             "collision = { shape = \"model\"; };\n"
             "vehicles = (\n"
             "  { kind = \"tank\"; count = 12; force = \"blue\"; fire_at_will = true;\n"
             "    area = [24960.0, 24960.0, 25040.0, 25040.0]; },\n"
             "  { kind = \"truck\"; count = 14; force = \"red\";\n"
             "    area = [24960.0, 24960.0, 25040.0, 25040.0]; },\n"
             "  { kind = \"helicopter\"; count = 4; force = \"red\"; fire_at_will = true;\n"
             "    area = [24900.0, 24900.0, 25100.0, 25100.0]; } );\n"
             "fires = ( { at_s = 1.0; munition = \"bomb\"; point = [25000.0, 25000.0]; } );\n",
             (unsigned)(seed & 0xffff));
    compare(text, 240, seed);
}

/* For searches: a scenario of a file. */
static void test_another_scenario_goes_on_alike(void **state)
{
    const char *path = getenv("SCENARIO"), *frames = getenv("FRAMES");
    static char text[1 << 20];
    (void)state;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    compare(text, frames ? (uint32_t)strtoul(frames, NULL, 10) : 600, fixture_seed(92));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_heaps_and_wrecks_go_on_alike),
    };
    const struct CMUnitTest search[] = {
        cmocka_unit_test(test_another_scenario_goes_on_alike),
    };
    if (getenv("SCENARIO"))
        return cmocka_run_group_tests(search, NULL, NULL);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
