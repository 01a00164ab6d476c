/* Workers: every row once, whatever the threads, the rows and the grain. */
#include "world/runtime/thread_pool.h"

#include <dirent.h>
#include <errno.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#define ROWS_MAX 5000

struct job {
    _Atomic uint32_t done[ROWS_MAX];
    _Atomic uint32_t calls, longest, highest_worker;
};

static struct job job;

static void keep_highest(_Atomic uint32_t *most, uint32_t value)
{
    uint32_t seen = atomic_load(most);
    while (value > seen && !atomic_compare_exchange_weak(most, &seen, value))
        continue;
}

static void count_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *j = context;
    atomic_fetch_add(&j->calls, 1);
    keep_highest(&j->longest, end - first);
    keep_highest(&j->highest_worker, worker);
    for (uint32_t i = first; i < end; i++)
        atomic_fetch_add(&j->done[i], 1);
}

static void check_run(struct thread_pool *workers, uint32_t count, uint32_t grain)
{
    memset(&job, 0, sizeof job);
    thread_pool_run(workers, count_rows, &job, count, grain);
    for (uint32_t i = 0; i < ROWS_MAX; i++)
        assert_int_equal(job.done[i], i < count ? 1 : 0);
    assert_true(job.highest_worker < thread_pool_threads(workers));
}

static void test_every_row_once(void **state)
{
    static const uint32_t counts[] = {0, 1, 2, 63, 64, 65, 127, 128, 1000, ROWS_MAX};
    static const uint32_t grains[] = {1, 7, 64, 1000, ROWS_MAX, 2 * ROWS_MAX};
    (void)state;
    for (uint32_t threads = 1; threads <= THREAD_POOL_MAX; threads += 5) {
        struct thread_pool *workers = thread_pool_create(threads);
        assert_non_null(workers);
        assert_int_equal(thread_pool_threads(workers), threads);
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
            for (size_t g = 0; g < sizeof grains / sizeof grains[0]; g++)
                check_run(workers, counts[c], grains[g]);
        }
        thread_pool_destroy(workers);
    }
}

static void test_pieces_are_at_most_the_grain(void **state)
{
    (void)state;
    struct thread_pool *workers = thread_pool_create(4);
    check_run(workers, 4999, 100);
    assert_int_equal(job.longest, 100);
    assert_int_equal(job.calls, 50);
    thread_pool_destroy(workers);
}

static void test_nothing_to_do_calls_nothing(void **state)
{
    (void)state;
    struct thread_pool *workers = thread_pool_create(3);
    check_run(workers, 0, 10);
    assert_int_equal(job.calls, 0);
    check_run(NULL, 0, 10);
    assert_int_equal(job.calls, 0);
    thread_pool_destroy(workers);
}

static void test_without_workers_the_caller_does_it(void **state)
{
    (void)state;
    assert_int_equal(thread_pool_threads(NULL), 1);
    check_run(NULL, ROWS_MAX, 10);
    assert_int_equal(job.highest_worker, 0);
    thread_pool_destroy(NULL);
}

/* Two workers meet only if both work: each waits for the other, with a bound. */
static void meet(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    _Atomic uint32_t *met = context;
    (void)first, (void)end, (void)worker;
    atomic_fetch_add(met, 1);
    for (uint64_t i = 0; atomic_load(met) < 2 && i < 4000000000u; i++)
        continue;
}

static void test_work_is_shared_by_threads(void **state)
{
    _Atomic uint32_t met = 0;
    (void)state;
    struct thread_pool *workers = thread_pool_create(2);
    thread_pool_run(workers, meet, &met, 2, 1);
    assert_int_equal(met, 2);
    thread_pool_destroy(workers);
}

static void rest_us(long us)
{
    nanosleep(&(struct timespec){.tv_nsec = us * 1000}, NULL);
}

/* Whether they still look for the next job, sleep, or are about to. */
static void test_helpers_come_after_any_rest(void **state)
{
    (void)state;
    struct thread_pool *workers = thread_pool_create(2);
    for (long i = 0; i < 150; i += 3) {
        _Atomic uint32_t met = 0;
        rest_us(i);
        thread_pool_run(workers, meet, &met, 2, 1);
        assert_int_equal(met, 2);
    }
    thread_pool_destroy(workers);
}

/* Helpers that are held come from sleep and from polling, and sleep again when they are let go:
 * they use next to no processor then. */
static void test_helpers_are_held(void **state)
{
    struct timespec before, after;
    (void)state;
    struct thread_pool *workers = thread_pool_create(2);
    for (long i = 0; i < 20; i++) {
        _Atomic uint32_t met = 0;
        rest_us(200);
        assert_false(thread_pool_is_held(workers));
        thread_pool_hold(workers);
        rest_us(10 * i);
        thread_pool_run(workers, meet, &met, 2, 1);
        assert_int_equal(met, 2);
        thread_pool_let_go(workers);
    }
    rest_us(1000);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    rest_us(50000);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    long used_us =
        (after.tv_sec - before.tv_sec) * 1000000 + (after.tv_nsec - before.tv_nsec) / 1000;
    assert_true(used_us < 20000);
    thread_pool_hold(workers); /* a pool may end while it is held */
    thread_pool_destroy(workers);
    thread_pool_hold(NULL);
    thread_pool_let_go(NULL);
}

static double used_s(clockid_t clock)
{
    struct timespec used;
    clock_gettime(clock, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

/* Lets all threads of the process run on the given processors only. */
static void run_on(const cpu_set_t *processors)
{
    DIR *tasks = opendir("/proc/self/task");
    assert_non_null(tasks);
    for (struct dirent *task; (task = readdir(tasks)) != NULL;) {
        if (task->d_name[0] != '.')
            sched_setaffinity((pid_t)strtol(task->d_name, NULL, 10), sizeof *processors,
                              processors);
    }
    closedir(tasks);
}

/* Beside other programs the caller and a helper that is held may be on the same processor. */
static void test_a_held_helper_gives_way_to_the_caller(void **state)
{
    cpu_set_t all, one;
    (void)state;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    if (CPU_COUNT(&all) < 2)
        skip();
    struct thread_pool *workers = thread_pool_create(2);
    CPU_ZERO(&one);
    for (size_t i = 0; CPU_COUNT(&one) == 0; i++) {
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    }
    run_on(&one);
    thread_pool_hold(workers);
    double own = used_s(CLOCK_THREAD_CPUTIME_ID), both = used_s(CLOCK_PROCESS_CPUTIME_ID);
    while (used_s(CLOCK_THREAD_CPUTIME_ID) - own < 0.05)
        continue;
    own = used_s(CLOCK_THREAD_CPUTIME_ID) - own;
    both = used_s(CLOCK_PROCESS_CPUTIME_ID) - both;
    thread_pool_destroy(workers);
    run_on(&all);
    assert_true(both - own < 0.3 * own);
}

struct delay {
    _Atomic uint32_t met;
    long us;
    uint32_t done; /* by the helper */
};

static void meet_and_take_long(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct delay *delay = context;
    meet(&delay->met, first, end, worker);
    if (worker == 0)
        return;
    rest_us(delay->us);
    delay->done = 1;
}

static void test_the_caller_waits_for_who_is_in(void **state)
{
    (void)state;
    struct thread_pool *workers = thread_pool_create(2);
    for (long us = 0; us < 1000; us += 100) {
        struct delay delay = {.us = us};
        thread_pool_run(workers, meet_and_take_long, &delay, 2, 1);
        assert_int_equal(delay.met, 2);
        assert_int_equal(delay.done, 1);
    }
    thread_pool_destroy(workers);
}

static void test_thousands_of_jobs_follow_each_other(void **state)
{
    (void)state;
    struct thread_pool *workers = thread_pool_create(4);
    memset(&job, 0, sizeof job);
    for (int i = 0; i < 3000; i++)
        thread_pool_run(workers, count_rows, &job, 64, 4);
    for (int i = 0; i < 64; i++)
        assert_int_equal(job.done[i], 3000);
    thread_pool_destroy(workers);
}

static void test_idle_workers_end(void **state)
{
    (void)state;
    for (int i = 0; i < 50; i++)
        thread_pool_destroy(thread_pool_create(THREAD_POOL_MAX));
}

static void test_thread_counts_out_of_range_are_refused(void **state)
{
    (void)state;
    errno = 0;
    assert_null(thread_pool_create(0));
    assert_int_equal(errno, EINVAL);
    errno = 0;
    assert_null(thread_pool_create(THREAD_POOL_MAX + 1));
    assert_int_equal(errno, EINVAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_row_once),
        cmocka_unit_test(test_pieces_are_at_most_the_grain),
        cmocka_unit_test(test_nothing_to_do_calls_nothing),
        cmocka_unit_test(test_without_workers_the_caller_does_it),
        cmocka_unit_test(test_work_is_shared_by_threads),
        cmocka_unit_test(test_helpers_come_after_any_rest),
        cmocka_unit_test(test_helpers_are_held),
        cmocka_unit_test(test_a_held_helper_gives_way_to_the_caller),
        cmocka_unit_test(test_the_caller_waits_for_who_is_in),
        cmocka_unit_test(test_thousands_of_jobs_follow_each_other),
        cmocka_unit_test(test_idle_workers_end),
        cmocka_unit_test(test_thread_counts_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
