/* The benchmark's contacts on 1, 2, 3 and 5 threads against every body compared with every other,
 * in a crowd where many bodies touch several others at once. SEED=n runs another crowd. */
#include "tests/bench/workload.h"

#include "tests/support/fixture.h"
#include "world/making/geography.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define BODIES   10000 /* rows enough for several threads */
#define FIXED    300
#define FIRST_M  24000.0 /* the crowd's west and north edge */
#define SIDE_M   1500.0
#define STEPS    40
#define RUNS     4
#define SPEED    16.6 /* [m/s] */
#define COMPARED 20   /* one step in so many is compared with the brute force */

static const uint32_t threads[RUNS] = {1, 2, 3, 5};

void engine_touches_add(struct engine_touches *touches, uint32_t a, uint32_t b)
{
    if (touches->count == touches->capacity) {
        touches->capacity = touches->capacity * 2 + 1024;
        touches->touch = realloc(touches->touch, touches->capacity * sizeof *touches->touch);
        assert_non_null(touches->touch);
    }
    touches->touch[touches->count++] = (struct engine_touch){a, b};
}

static void draw(struct engine_scene *scene, uint64_t seed)
{
    uint64_t random = seed;
    *scene = (struct engine_scene){.body = calloc(BODIES, sizeof *scene->body),
                                   .bodies = BODIES,
                                   .fixed = calloc(FIXED, sizeof *scene->fixed),
                                   .fixed_count = FIXED};
    assert_true(scene->body && scene->fixed);
    for (uint32_t i = 0; i < BODIES; i++)
        scene->body[i] = (struct engine_body){FIRST_M + fixture_uniform(&random, 0.0, SIDE_M),
                                              FIRST_M + fixture_uniform(&random, 0.0, SIDE_M),
                                              fixture_uniform(&random, -SPEED, SPEED),
                                              fixture_uniform(&random, -SPEED, SPEED)};
    for (uint32_t i = 0; i < FIXED; i++)
        scene->fixed[i] = (struct engine_sphere){FIRST_M + fixture_uniform(&random, 0.0, SIDE_M),
                                                 FIRST_M + fixture_uniform(&random, 0.0, SIDE_M),
                                                 fixture_uniform(&random, 0.5, 9.0)};
}

static void drop(struct engine_scene *scene)
{
    free(scene->body);
    free(scene->fixed);
}

static int by_bodies(const void *p, const void *q)
{
    const struct engine_touch *a = p, *b = q;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

static void sort(struct engine_touches *touches)
{
    qsort(touches->touch, touches->count, sizeof *touches->touch, by_bodies);
}

/* --- the oracle --------------------------------------------------------------------------------*/

/* How near two points come to each other within a step [m]; infinite when they do not come nearer
 * than they are at its beginning. */
static double nearest(double x, double z, double vx, double vz)
{
    double nearing = x * vx + z * vz, square = vx * vx + vz * vz;
    if (!(nearing < 0.0))
        return INFINITY;
    double time = maths_min(-nearing / square, ENGINE_DT_S);
    x += vx * time;
    z += vz * time;
    return sqrt(x * x + z * z);
}

/* Every pair that is nearer than it reaches by more than a nanometre has to be there, and no pair
 * that stays further apart by more than one; within, rounding decides. */
static void check(const struct engine_touches *touches, size_t *next, uint32_t a, uint32_t b,
                  double gap)
{
    const struct engine_touch *touch = &touches->touch[*next];
    bool listed = *next < touches->count && touch->a == a && touch->b == b;
    if (listed ? gap > 1e-9 : gap < -1e-9)
        fail_msg("%u and %u come as near as %.3g m beyond their touch, and are%s listed", a, b, gap,
                 listed ? "" : " not");
    *next += listed;
}

/* The touches are in order. */
static void compare_with_all(const struct engine_scene *scene, const struct engine_touches *touches)
{
    size_t next = 0;
    for (uint32_t a = 0; a < BODIES; a++) {
        const struct engine_body *p = &scene->body[a];
        for (uint32_t b = a + 1; b < BODIES; b++) {
            const struct engine_body *q = &scene->body[b];
            check(touches, &next, a, b,
                  nearest(q->x - p->x, q->z - p->z, q->vx - p->vx, q->vz - p->vz) -
                      2.0 * ENGINE_RADIUS_M);
        }
        for (uint32_t b = 0; b < FIXED; b++) {
            const struct engine_sphere *ball = &scene->fixed[b];
            check(touches, &next, a, b | ENGINE_FIXED,
                  nearest(ball->x - p->x, ball->z - p->z, -p->vx, -p->vz) - ENGINE_RADIUS_M -
                      (double)(float)ball->radius_m);
        }
    }
    assert_int_equal(next, touches->count);
}

/* --- the tests ---------------------------------------------------------------------------------*/

struct run {
    struct workload workload;
    struct engine_touches touches;
    void *engine;
};

static void same(const struct run *run, const struct run *first, int step, uint32_t count)
{
    if (run->touches.count != first->touches.count ||
        memcmp(run->touches.touch, first->touches.touch,
               first->touches.count * sizeof *first->touches.touch) != 0)
        fail_msg("step %d: on %u threads %zu contacts, on one %zu, or others", step, count,
                 run->touches.count, first->touches.count);
}

static void test_contacts_are_the_same_on_any_number_of_threads(void **state)
{
    static struct run run[RUNS];
    uint64_t seed = fixture_seed(40), found = 0;
    (void)state;
    for (int i = 0; i < RUNS; i++) {
        draw(&run[i].workload.scene, seed);
        run[i].engine = engine_jolon.open(&run[i].workload.scene, threads[i]);
    }
    for (int step = 0; step < STEPS; step++) {
        for (int i = 0; i < RUNS; i++) {
            run[i].touches.count = 0;
            engine_jolon.place(run[i].engine);
            engine_jolon.detect(run[i].engine, &run[i].touches);
        }
        found += run[0].touches.count;
        /* The workload is given the lists as the threads made them. */
        for (int i = 0; i < RUNS; i++) {
            struct engine_scene *scene = &run[i].workload.scene;
            workload_step(&run[i].workload, &run[i].touches);
            sort(&run[i].touches);
            same(&run[i], &run[0], step, threads[i]);
            if (memcmp(scene->body, run[0].workload.scene.body, BODIES * sizeof *scene->body) != 0)
                fail_msg("step %d: on %u threads the bodies part", step, threads[i]);
        }
    }
    for (int i = 0; i < RUNS; i++) {
        assert_int_equal(run[i].workload.contacts, run[0].workload.contacts);
        engine_jolon.close(run[i].engine);
        drop(&run[i].workload.scene);
        free(run[i].touches.touch);
    }
    print_message("%llu touches, %llu contacts begun\n", (unsigned long long)found,
                  (unsigned long long)run[0].workload.contacts);
    assert_true(found > 5000 && run[0].workload.contacts > 5000);
}

static void test_contacts_are_those_of_brute_force(void **state)
{
    struct run run = {0};
    (void)state;
    draw(&run.workload.scene, fixture_seed(41));
    run.engine = engine_jolon.open(&run.workload.scene, 3);
    for (int step = 0; step < STEPS; step++) {
        run.touches.count = 0;
        engine_jolon.place(run.engine);
        engine_jolon.detect(run.engine, &run.touches);
        sort(&run.touches);
        if (step % COMPARED == 0)
            compare_with_all(&run.workload.scene, &run.touches);
        workload_step(&run.workload, &run.touches);
    }
    engine_jolon.close(run.engine);
    drop(&run.workload.scene);
    free(run.touches.touch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contacts_are_the_same_on_any_number_of_threads),
        cmocka_unit_test(test_contacts_are_those_of_brute_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
