/* Whom the keeper's watch kills, and whom it must not: supervisor/watchdog.h. The watch is given
 * its own time, so that hours pass at once; the processes are real. */
#include "supervisor/watchdog.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

#include <cmocka.h>

#define MS (uint64_t) NS_PER_MS

struct scene {
    struct fixture fixture;
    struct plan plan;
    struct process_set set;
    struct watchdog watch;
    uint64_t now_ns;
};

static int loop(void *context)
{
    volatile const uint64_t *forever = context;
    while (*forever == 0)
        continue;
    return 0;
}

static int block(void *context)
{
    while (context != &context)
        pause();
    return 0;
}

static struct child *take_role(struct scene *scene, enum role role, int (*body)(void *))
{
    static uint64_t never;
    struct role_slot *slot = scene->set.view.slot[role];
    struct child *child = &scene->set.service[role].child[0];
    child->pid = child_start(body, &never);
    while (body == block && process_state(child->pid) != 'S')
        clock_sleep_until_ns(clock_now_ns() + MS);
    atomic_store(&slot->pid, (uint32_t)child->pid);
    atomic_store(&slot->state, ROLE_READY);
    atomic_store(&slot->frame, 10);
    atomic_store(&slot->beat_ns, scene->now_ns);
    return child;
}

static void open_scene(struct scene *scene)
{
    *scene = (struct scene){.plan = {.hang_ms = 100, .background = true}};
    fixture_open(&scene->fixture, "");
    scene->set = (struct process_set){
        .plan = &scene->plan, .view = scene->fixture.view, .log_fd = STDERR_FILENO};
    for (int i = 0; i < ROLE_COUNT; i++)
        scene->set.service[i].role = (enum role)i;
    scene->now_ns = clock_now_ns();
    scene->watch = (struct watchdog){scene->now_ns, scene->now_ns};
}

/* Looks every tick until the child is found hanging, at most limit_ms. How long it took [ms]. */
static uint64_t look(struct scene *scene, const struct child *child, uint64_t limit_ms)
{
    uint64_t begun = scene->now_ns;
    while (!child->hung && scene->now_ns < begun + limit_ms * MS) {
        scene->now_ns += WATCHDOG_TICK_NS;
        watchdog_check(&scene->watch, &scene->set, scene->now_ns);
    }
    return (scene->now_ns - begun) / MS;
}

/* Processor time that a process has had [ns]. */
static uint64_t used_ns(int pid)
{
    char path[64];
    unsigned long long used = 0;
    snprintf(path, sizeof path, "/proc/%d/schedstat", pid);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%llu", &used), 1);
    fclose(file);
    return used;
}

/* The watch's time goes as fast as the child's own: a busy machine only makes the test longer. */
static void test_who_runs_in_circles_is_killed(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    uint64_t begun = scene.now_ns;
    struct child *child = take_role(&scene, ROLE_COLLIDER, loop);
    while (!child->hung) {
        uint64_t used = used_ns(child->pid);
        while (used_ns(child->pid) < used + WATCHDOG_TICK_NS)
            clock_sleep_until_ns(clock_now_ns() + MS);
        look(&scene, child, WATCHDOG_TICK_NS / MS);
        assert_true(scene.now_ns < begun + 200 * MS);
    }
    assert_int_equal(child_wait(child->pid) & 0x7f, SIGKILL);
    fixture_close(&scene.fixture);
}

static void test_who_is_not_let_run_is_left_alone(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, loop);
    look(&scene, child, 100000); /* much of the watch's time, hardly any of the child's */
    assert_false(child->hung);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_who_blocks_is_killed_within_the_limit(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_MOVER, block);
    uint64_t took = look(&scene, child, 10000);
    assert_true(child->hung);
    assert_in_range(took, 100, 130);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_who_beats_is_left_alone(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_MOVER, block);
    for (int i = 0; i < 1000; i++) {
        atomic_store(&scene.set.view.slot[ROLE_MOVER]->beat_ns, scene.now_ns);
        look(&scene, child, 50);
    }
    assert_false(child->hung);
    assert_true(child->was_ready);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_a_stopped_standby_is_killed_within_the_limit(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = &scene.set.service[ROLE_COLLIDER].child[1];
    child->pid = child_start(block, NULL);
    child->stopped_ns = scene.now_ns;
    assert_in_range(look(&scene, child, 10000), 100, 120);
    assert_true(child->hung);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

/* The machine, or the watch, stood still for 30 s: everybody gets a whole limit from then on. */
static void test_a_watch_that_slept_judges_nobody_by_it(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *mover = take_role(&scene, ROLE_MOVER, block);
    struct child *stopped = &scene.set.service[ROLE_COLLIDER].child[1];
    stopped->pid = child_start(block, NULL);
    stopped->stopped_ns = scene.now_ns;
    look(&scene, mover, 50);
    scene.now_ns += 30 * (uint64_t)NS_PER_S;
    look(&scene, mover, 90);
    assert_false(mover->hung);
    assert_false(stopped->hung);
    atomic_store(&scene.set.view.slot[ROLE_MOVER]->beat_ns, scene.now_ns);
    stopped->stopped_ns = 0; /* both woke up in time */
    look(&scene, mover, 90);
    assert_false(mover->hung);
    assert_false(stopped->hung);
    child_kill(mover->pid);
    child_kill(stopped->pid);
    fixture_close(&scene.fixture);
}

static void test_roles_outside_the_frame_loop_have_more_time(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_RENDERER, block);
    assert_in_range(look(&scene, child, 100000), 2000, 2050);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_long_frames_give_more_time(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, block);
    atomic_store(&scene.set.view.slot[ROLE_COLLIDER]->stage_ns, 500 * MS);
    assert_in_range(look(&scene, child, 100000), 4000, 4050);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

/* Looks every tick while the slot's work goes up, until the child is found hanging. */
static uint64_t look_while_it_works(struct scene *scene, const struct child *child, uint64_t ms)
{
    uint64_t begun = scene->now_ns;
    while (!child->hung && scene->now_ns < begun + ms * MS) {
        atomic_fetch_add(&scene->set.view.slot[ROLE_COLLIDER]->work, 1);
        look(scene, child, WATCHDOG_TICK_NS / MS);
    }
    return (scene->now_ns - begun) / MS;
}

static void test_who_gets_on_with_a_long_frame_is_left_alone_and_said_once(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, block);
    look_while_it_works(&scene, child, 3000);
    assert_false(child->hung);
    assert_int_equal(scene.set.service[ROLE_COLLIDER].long_frames, 1);
    atomic_store(&scene.set.view.slot[ROLE_COLLIDER]->beat_ns, scene.now_ns);
    look_while_it_works(&scene, child, 3000); /* the next one is long, too */
    assert_int_equal(scene.set.service[ROLE_COLLIDER].long_frames, 2);
    uint64_t took = look(&scene, child, 10000); /* and then it hangs in it */
    assert_true(child->hung);
    assert_in_range(took, 90, 130);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_a_frame_without_an_end_ends(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, block);
    uint64_t took = look_while_it_works(&scene, child, 400000);
    assert_true(child->hung);
    assert_in_range(took, WATCHDOG_FRAME_MAX_NS / MS, WATCHDOG_FRAME_MAX_NS / MS + 50);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_who_gets_on_with_a_long_frame_is_left_alone_and_said_once),
        cmocka_unit_test(test_a_frame_without_an_end_ends),
        cmocka_unit_test(test_who_runs_in_circles_is_killed),
        cmocka_unit_test(test_who_is_not_let_run_is_left_alone),
        cmocka_unit_test(test_who_blocks_is_killed_within_the_limit),
        cmocka_unit_test(test_who_beats_is_left_alone),
        cmocka_unit_test(test_a_stopped_standby_is_killed_within_the_limit),
        cmocka_unit_test(test_a_watch_that_slept_judges_nobody_by_it),
        cmocka_unit_test(test_roles_outside_the_frame_loop_have_more_time),
        cmocka_unit_test(test_long_frames_give_more_time),
    };
    return cmocka_run_group_tests_name("watch", tests, NULL, NULL);
}
