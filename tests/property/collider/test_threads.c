/* The digest of every frame is the same on 1, 2 and 4 threads (docs: determinism), on a battle that
 * is large enough for every loop to be shared out. SEED=n runs another battle. */
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define FRAMES_MAX 300

/* More rows than any loop takes in one piece (4,096), over more squares than the pairing takes in
 * one (1,024): 5,400 vehicles on 5.5 km x 5.5 km, most of them hostile neighbours. */
static const char battle[] =
    "world = { seed = %llu; hz = 20.0; capacity = 8192; };\n"
    "objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; },\n"
    "            { kind = \"tree\"; at = [24900.0, 25050.0]; },\n"
    "            { kind = \"tree\"; at = [25125.0, 25125.0]; } );\n"
    "collision = { shape = \"%s\"; response = \"%s\"; };\n"
    "vehicles = (\n"
    "  { kind = \"tank\"; count = 900; force = \"blue\"; fire_at_will = true;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"tank\"; count = 900; force = \"red\"; fire_at_will = true;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"jeep\"; count = 1600; force = \"blue\"; fire_at_will = true;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"truck\"; count = 1600; behaviour = \"hold\"; speed_mps = 22.0;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"jet\"; count = 150; force = \"red\"; fire_at_will = true;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"helicopter\"; count = 250; force = \"blue\"; fire_at_will = true;\n"
    "    area = [22500.0, 22500.0, 28000.0, 28000.0]; } );\n"
    "fires = ( { at_s = 0.2; munition = \"artillery\"; point = [25000.0, 25000.0]; },\n"
    "          { at_s = 0.5; munition = \"bomb\"; point = [24000.0, 24500.0]; } );\n";

/* FRAMES=n in the environment shortens a run under a slow sanitizer. */
static uint32_t frame_count(void)
{
    const char *text = getenv("FRAMES");
    uint32_t frames = text ? (uint32_t)strtoul(text, NULL, 10) : FRAMES_MAX;
    return frames < FRAMES_MAX ? frames : FRAMES_MAX;
}

/* On one thread the steps copy and hash everything in every frame, on more what differs. */
static void run(const char *text, uint32_t threads, uint32_t frames, uint64_t digest[FRAMES_MAX])
{
    struct fixture f;
    fixture_open(&f, text);
    fixture_threads(&f, threads);
    for (uint32_t i = 0; i < frames; i++) {
        (threads == 1 ? fixture_run : fixture_continue)(&f, 1);
        digest[i] = fixture_digest(&f);
    }
    const struct state_head *head = fixture_state(&f).head;
    /* A quiet world would prove nothing; a short run is a quieter one. */
    assert_true(head->tally.fires > frames && head->tally.detonations > frames / 2);
    assert_true(head->tally.collisions > (frames == FRAMES_MAX ? frames : 0));
    assert_true(head->tally.events_dropped == 0);
    fixture_close(&f);
}

static void compare(const char *shape, const char *response, uint64_t seed)
{
    static uint64_t digest[3][FRAMES_MAX];
    static const uint32_t threads[3] = {1, 2, 4};
    char text[sizeof battle + 64];
    uint32_t frames = frame_count();
    snprintf(text, sizeof text, battle, (unsigned long long)(seed & 0xffffffff), shape, response);
    for (int i = 0; i < 3; i++) {
        run(text, threads[i], frames, digest[i]);
        for (uint32_t frame = 0; i > 0 && frame < frames; frame++) {
            if (digest[i][frame] != digest[0][frame])
                fail_msg("frame %u differs on %u threads: %016llx, and %016llx on one", frame + 1,
                         threads[i], (unsigned long long)digest[i][frame],
                         (unsigned long long)digest[0][frame]);
        }
    }
}

static void test_digests_do_not_depend_on_threads_with_impulses(void **state)
{
    (void)state;
    compare("model", "impulse", fixture_seed(4));
}

static void test_digests_do_not_depend_on_threads_with_figure_8(void **state)
{
    (void)state;
    compare("sphere", "figure8", fixture_seed(5));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_digests_do_not_depend_on_threads_with_impulses),
        cmocka_unit_test(test_digests_do_not_depend_on_threads_with_figure_8),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
