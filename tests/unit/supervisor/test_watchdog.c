/* Which processes the watchdog kills, and which it must not: supervisor/watchdog.h. The test sets
 * the watchdog's clock, so that hours pass at once; the processes are real. */
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
    struct watchdog watchdog;
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
    scene->watchdog = (struct watchdog){scene->now_ns, scene->now_ns};
}

/* Checks every tick until the child is found hanging, at most limit_ms. Returns the time that took
 * [ms]. */
static uint64_t check_until_hung(struct scene *scene, const struct child *child, uint64_t limit_ms)
{
    uint64_t begun = scene->now_ns;
    while (!child->hung && scene->now_ns < begun + limit_ms * MS) {
        scene->now_ns += WATCHDOG_TICK_NS;
        watchdog_check(&scene->watchdog, &scene->set, scene->now_ns);
    }
    return (scene->now_ns - begun) / MS;
}

/* The processor time of a process [ns]. */
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

/* The watchdog's clock follows the child's processor time, so that a busy machine only makes the
 * test longer. */
static void test_endless_loop_is_killed(void **state)
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
        check_until_hung(&scene, child, WATCHDOG_TICK_NS / MS);
        assert_true(scene.now_ns < begun + 200 * MS);
    }
    assert_int_equal(child_wait(child->pid) & 0x7f, SIGKILL);
    fixture_close(&scene.fixture);
}

static void test_process_without_processor_time_is_left_alone(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, loop);
    check_until_hung(&scene, child,
                     100000); /* much of the watchdog's time, hardly any processor time */
    assert_false(child->hung);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_blocked_process_is_killed_within_the_limit(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_MOVER, block);
    uint64_t took = check_until_hung(&scene, child, 10000);
    assert_true(child->hung);
    assert_in_range(took, 100, 130);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_process_with_heartbeat_is_left_alone(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_MOVER, block);
    for (int i = 0; i < 1000; i++) {
        atomic_store(&scene.set.view.slot[ROLE_MOVER]->beat_ns, scene.now_ns);
        check_until_hung(&scene, child, 50);
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
    assert_in_range(check_until_hung(&scene, child, 10000), 100, 120);
    assert_true(child->hung);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

/* The machine, or the watchdog, stood still for 30 s: every process gets a whole limit from then
 * on. */
static void test_late_watchdog_kills_no_process(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *mover = take_role(&scene, ROLE_MOVER, block);
    struct child *stopped = &scene.set.service[ROLE_COLLIDER].child[1];
    stopped->pid = child_start(block, NULL);
    stopped->stopped_ns = scene.now_ns;
    check_until_hung(&scene, mover, 50);
    scene.now_ns += 30 * (uint64_t)NS_PER_S;
    check_until_hung(&scene, mover, 90);
    assert_false(mover->hung);
    assert_false(stopped->hung);
    atomic_store(&scene.set.view.slot[ROLE_MOVER]->beat_ns, scene.now_ns);
    stopped->stopped_ns = 0; /* both were continued in time */
    check_until_hung(&scene, mover, 90);
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
    assert_in_range(check_until_hung(&scene, child, 100000), 2000, 2050);
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
    assert_in_range(check_until_hung(&scene, child, 100000), 4000, 4050);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

/* Checks every tick while the slot's work goes up, until the child is found hanging. */
static uint64_t check_while_working(struct scene *scene, const struct child *child, uint64_t ms)
{
    uint64_t begun = scene->now_ns;
    while (!child->hung && scene->now_ns < begun + ms * MS) {
        atomic_fetch_add(&scene->set.view.slot[ROLE_COLLIDER]->work, 1);
        check_until_hung(scene, child, WATCHDOG_TICK_NS / MS);
    }
    return (scene->now_ns - begun) / MS;
}

static void test_long_frame_with_progress_is_logged_once(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, block);
    check_while_working(&scene, child, 3000);
    assert_false(child->hung);
    assert_int_equal(scene.set.service[ROLE_COLLIDER].long_frames, 1);
    atomic_store(&scene.set.view.slot[ROLE_COLLIDER]->beat_ns, scene.now_ns);
    check_while_working(&scene, child, 3000); /* the next frame is long, too */
    assert_int_equal(scene.set.service[ROLE_COLLIDER].long_frames, 2);
    uint64_t took = check_until_hung(&scene, child, 10000); /* then it hangs within that frame */
    assert_true(child->hung);
    assert_in_range(took, 90, 130);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

static void test_endless_frame_is_killed(void **state)
{
    struct scene scene;
    (void)state;
    open_scene(&scene);
    struct child *child = take_role(&scene, ROLE_COLLIDER, block);
    uint64_t took = check_while_working(&scene, child, 400000);
    assert_true(child->hung);
    assert_in_range(took, WATCHDOG_FRAME_MAX_NS / MS, WATCHDOG_FRAME_MAX_NS / MS + 50);
    child_kill(child->pid);
    fixture_close(&scene.fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_long_frame_with_progress_is_logged_once),
        cmocka_unit_test(test_endless_frame_is_killed),
        cmocka_unit_test(test_endless_loop_is_killed),
        cmocka_unit_test(test_process_without_processor_time_is_left_alone),
        cmocka_unit_test(test_blocked_process_is_killed_within_the_limit),
        cmocka_unit_test(test_process_with_heartbeat_is_left_alone),
        cmocka_unit_test(test_a_stopped_standby_is_killed_within_the_limit),
        cmocka_unit_test(test_late_watchdog_kills_no_process),
        cmocka_unit_test(test_roles_outside_the_frame_loop_have_more_time),
        cmocka_unit_test(test_long_frames_give_more_time),
    };
    return cmocka_run_group_tests_name("watch", tests, NULL, NULL);
}
