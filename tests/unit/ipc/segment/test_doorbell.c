/* Doorbells: a ring wakes, a lost ring costs one time-out, a spurious ring costs one look. */
#include "ipc/segment/doorbell.h"

#include "ipc/process/clock.h"
#include "tests/support/child.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#define SHORT_NS (10 * (uint64_t)NS_PER_MS)
#define LONG_NS  (15 * (uint64_t)NS_PER_S) /* a test that passes never waits so long */

struct shared {
    struct doorbells doorbells;
    _Atomic uint64_t word; /* what the doorbell is about */
};

static struct shared *shared;

static int make_doors(void **state)
{
    (void)state;
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return shared == MAP_FAILED ? -1 : doorbells_init(&shared->doorbells);
}

static int drop_doors(void **state)
{
    (void)state;
    return munmap(shared, sizeof *shared);
}

static int bell(enum role role)
{
    int value = -1;
    assert_int_equal(sem_getvalue(&shared->doorbells.role[role].bell, &value), 0);
    return value;
}

static uint64_t wait_ns(enum role role, uint64_t ns)
{
    uint64_t begin = clock_now_ns();
    doorbell_wait(&shared->doorbells, role, begin + ns);
    return clock_now_ns() - begin;
}

static void test_bells_are_silent_at_first(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++)
        assert_int_equal(bell((enum role)role), 0);
}

static void test_ringing_a_bell_that_rings_does_not_count_up(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++)
        doorbell_ring(&shared->doorbells, ROLE_COLLIDER);
    assert_int_equal(bell(ROLE_COLLIDER), 1);
    for (int role = 0; role < ROLE_COUNT; role++)
        assert_int_equal(bell((enum role)role), role == ROLE_COLLIDER);
}

static void test_a_rung_bell_wakes_at_once_and_is_silent_then(void **state)
{
    (void)state;
    doorbell_ring(&shared->doorbells, ROLE_MOVER);
    assert_true(wait_ns(ROLE_MOVER, LONG_NS) < LONG_NS / 2);
    assert_int_equal(bell(ROLE_MOVER), 0);
}

static void test_lost_ring_costs_one_time_out(void **state)
{
    (void)state;
    uint64_t waited = wait_ns(ROLE_MOVER, SHORT_NS);
    assert_true(waited >= SHORT_NS && waited < 100 * SHORT_NS);
}

static void test_time_that_is_over_does_not_wait(void **state)
{
    (void)state;
    uint64_t begin = clock_now_ns();
    doorbell_wait(&shared->doorbells, ROLE_MOVER, 0);
    doorbell_wait(&shared->doorbells, ROLE_MOVER, begin);
    assert_true(clock_now_ns() - begin < LONG_NS / 2);
}

/* A damaged count: one wait clears as many posts as a role can have rung. */
static void test_spurious_posts_are_drained_by_one_wait(void **state)
{
    (void)state;
    for (int i = 0; i < 50; i++)
        sem_post(&shared->doorbells.role[ROLE_RENDERER].bell);
    wait_ns(ROLE_RENDERER, LONG_NS);
    assert_int_equal(bell(ROLE_RENDERER), 0);
}

static int ring_later(void *context)
{
    const enum role *role = context;
    clock_sleep_until_ns(clock_now_ns() + SHORT_NS);
    atomic_store(&shared->word, 1);
    doorbell_ring(&shared->doorbells, *role);
    return 0;
}

static void test_a_ring_from_another_process_ends_the_wait(void **state)
{
    enum role role = ROLE_COLLIDER;
    (void)state;
    pid_t child = child_start(ring_later, &role);
    assert_true(wait_ns(ROLE_COLLIDER, LONG_NS) < LONG_NS / 2);
    assert_int_equal(atomic_load(&shared->word), 1);
    assert_int_equal(child_wait(child), 0);
}

static void on_alarm(int signal_number)
{
    (void)signal_number;
}

static int wait_with_alarm(void *context)
{
    const struct sigaction action = {.sa_handler = on_alarm}; /* no SA_RESTART */
    (void)context;
    sigaction(SIGALRM, &action, NULL);
    ualarm(20000, 0);
    uint64_t begin = clock_now_ns();
    doorbell_wait(&shared->doorbells, ROLE_MOVER, begin + LONG_NS);
    return clock_now_ns() - begin < LONG_NS / 2 ? 0 : 1;
}

static void test_a_signal_ends_the_wait(void **state)
{
    (void)state;
    assert_int_equal(child_run(wait_with_alarm, NULL), 0);
}

static int wait_for_ever(void *context)
{
    (void)context;
    for (int i = 0; i < 1000; i++) { /* far longer than its life */
        atomic_store(&shared->word, 7);
        doorbell_wait(&shared->doorbells, ROLE_MOVER, clock_now_ns() + LONG_NS);
    }
    return 0;
}

/* Nothing needs re-arming after a kill at any point of the wait. */
static void test_killed_waiters_leave_a_working_doorbell(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++) {
        atomic_store(&shared->word, 0);
        pid_t child = child_start(wait_for_ever, NULL);
        while (atomic_load(&shared->word) != 7)
            continue;
        child_kill(child);
    }
    doorbell_ring(&shared->doorbells, ROLE_MOVER);
    doorbell_ring(&shared->doorbells, ROLE_MOVER);
    assert_int_equal(bell(ROLE_MOVER), 1);
    assert_true(wait_ns(ROLE_MOVER, LONG_NS) < LONG_NS / 2);
    assert_true(wait_ns(ROLE_MOVER, SHORT_NS) >= SHORT_NS);
}

#define ROUNDS 2000

/* Two doorbells as in the frame loop: the condition is the word, and the bell only says look. */
static int answer(void *context)
{
    (void)context;
    for (uint64_t i = 1; i < 2 * ROUNDS; i += 2) {
        while (atomic_load(&shared->word) < i)
            doorbell_wait(&shared->doorbells, ROLE_COLLIDER, clock_now_ns() + SHORT_NS);
        atomic_store(&shared->word, i + 1);
        doorbell_ring(&shared->doorbells, ROLE_MOVER);
    }
    return 0;
}

static void test_two_processes_pass_a_word_back_and_forth(void **state)
{
    (void)state;
    pid_t child = child_start(answer, NULL);
    uint64_t begin = clock_now_ns();
    for (uint64_t i = 0; i < 2 * ROUNDS; i += 2) {
        atomic_store(&shared->word, i + 1);
        doorbell_ring(&shared->doorbells, ROLE_COLLIDER);
        while (atomic_load(&shared->word) < i + 2 && clock_now_ns() - begin < LONG_NS)
            doorbell_wait(&shared->doorbells, ROLE_MOVER, clock_now_ns() + SHORT_NS);
    }
    assert_int_equal(atomic_load(&shared->word), 2 * ROUNDS);
    assert_int_equal(child_wait(child), 0);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_doors, drop_doors)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_bells_are_silent_at_first),
        TEST(test_ringing_a_bell_that_rings_does_not_count_up),
        TEST(test_a_rung_bell_wakes_at_once_and_is_silent_then),
        TEST(test_lost_ring_costs_one_time_out),
        TEST(test_time_that_is_over_does_not_wait),
        TEST(test_spurious_posts_are_drained_by_one_wait),
        TEST(test_a_ring_from_another_process_ends_the_wait),
        TEST(test_a_signal_ends_the_wait),
        TEST(test_killed_waiters_leave_a_working_doorbell),
        TEST(test_two_processes_pass_a_word_back_and_forth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
