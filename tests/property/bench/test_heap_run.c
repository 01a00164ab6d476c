/* What jolon-bench heap measures: overlaps, contacts and rest of tanks whose places are known, and
 * of a small heap in Jolon. */
#include "tests/bench/heap_overlap.h"
#include "tests/bench/heap_run.h"
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define TANKS  6
#define FRAMES 240 /* they push for 160, of which 120 are the impact */

static struct heap_scene scene;

static int open_scene(void **state)
{
    (void)state;
    setenv("JOLON_DATA", fixture_shipped_dir(), 1);
    heap_tanks_open(&scene, TANKS);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    heap_tanks_close(&scene);
    return 0;
}

/* --- an engine whose tanks 0 and 1 overlap by a known depth ------------------------------------*/

static uint32_t frame;

static void *known_open(const struct heap_tanks *tanks, uint32_t threads)
{
    (void)tanks, (void)threads;
    frame = 0;
    return &frame;
}

static void known_close(void *self)
{
    (void)self;
}

static void known_drive(void *self, bool push)
{
    (void)self;
    assert_int_equal(push, frame < 160);
}

static void known_step(void *self)
{
    (void)self;
    frame++;
}

static double known_depth_m(void)
{
    return frame == 60 ? 0.25 : frame == 150 ? 0.125 : frame == FRAMES ? 0.0625 : 0.0;
}

/* Tank i is 20 m north of the tank before it, and faces east. Contact is made in the frames 10 to
 * 19 and from frame 100 on, and listed twice. */
static void known_look(void *self, struct heap_look *look)
{
    (void)self;
    for (uint32_t i = 0; i < TANKS; i++)
        look->body[i] = (struct heap_body){.at = {0.0, 0.0, -20.0 * i},
                                           .forward = {1.0, 0.0, 0.0},
                                           .up = {0.0, 1.0, 0.0},
                                           .right = {0.0, 0.0, 1.0},
                                           .speed_mps = frame == FRAMES && i == 2 ? 0.06 : 0.01};
    look->body[1].at[2] = -2.0 * scene.tanks.half_m[2] + known_depth_m();
    for (int times = 0; times < 2 && ((frame >= 10 && frame < 20) || frame >= 100); times++)
        heap_look_add(look, 1 - (uint32_t)times, (uint32_t)times);
}

static const struct heap_engine known = {.name = "known",
                                         .threads = 1,
                                         .boxes = true,
                                         .open = known_open,
                                         .close = known_close,
                                         .drive = known_drive,
                                         .step = known_step,
                                         .look = known_look};

static void test_known_places_are_measured(void **state)
{
    (void)state;
    struct heap_result result = heap_run(&known, &scene, 4, FRAMES);
    assert_int_equal(result.threads, 1);
    assert_true(fabs(result.impact_m - 0.25) < 1e-9);
    assert_true(fabs(result.steady_m - 0.125) < 1e-9);
    assert_true(fabs(result.end_m - 0.0625) < 1e-9);
    assert_int_equal(result.pairs, 1);
    assert_int_equal(result.collisions, 2);
    assert_true(fabs(result.fastest_mps - 0.06) < 1e-12);
    assert_false(result.at_rest);
    assert_true(result.cpu_ms <= result.cpu_p99_ms && result.cpu_p99_ms <= result.cpu_worst_ms);
}

/* Tanks at the same place overlap by at least a tenth of their width, and neighbours do not. */
static void test_the_model_overlaps_itself(void **state)
{
    struct heap_look look = {0};
    struct heap_body body[TANKS];
    (void)state;
    look.body = body;
    frame = 0;
    known_look(NULL, &look);
    assert_true(heap_overlap_deepest(&scene.model, body + 2, TANKS - 2, 0.0) <= 0.0);
    memcpy(body[3].at, body[2].at, sizeof body[3].at);
    double whole = heap_overlap_deepest(&scene.model, body + 2, TANKS - 2, 0.0);
    print_message("a tank in a tank: %.3f m\n", whole);
    assert_true(whole > 0.2 * scene.tanks.half_m[2]);
}

/* --- Jolon -------------------------------------------------------------------------------------*/

static void test_jolon_runs_a_heap(void **state)
{
    (void)state;
    struct heap_result result = heap_run(&heap_jolon, &scene, 2, 300);
    print_message("%u pairs, %llu collisions, overlap %.4f, %.4f, %.4f mm, fastest %.3f m/s\n",
                  result.pairs, (unsigned long long)result.collisions, 1e3 * result.impact_m,
                  1e3 * result.steady_m, 1e3 * result.end_m, result.fastest_mps);
    assert_int_equal(result.threads, 2);
    assert_true(result.pairs >= TANKS / 2);
    assert_true(result.collisions >= result.pairs);
    assert_true(result.impact_m < 0.001 && result.steady_m < 0.001 && result.end_m < 0.001);
    assert_true(result.cpu_worst_ms > 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_places_are_measured),
        cmocka_unit_test(test_the_model_overlaps_itself),
        cmocka_unit_test(test_jolon_runs_a_heap),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
