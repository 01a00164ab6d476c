/* The steps of mover and collider take no memory and ask the kernel for nothing but to wake and to
 * wait for their threads (futex, sched_yield), however heavy the frame is. Each world runs in a
 * process of its own, under a filter that lets nothing else through; malloc() and its like end it
 * too. */
#include "tests/support/child.h"
#include "tests/support/steps.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmocka.h>

#define ALLOCATES  99 /* exit code: it took memory */
#define NO_FILTER  98
#define TEXT_BYTES 300000u

static _Atomic bool stepping;

/* At once: a sanitizer's own _exit() looks for leaks. */
static void leave(int code)
{
    syscall(SYS_exit_group, code);
}

/* --- the C library's allocation, watched -------------------------------------------------------*/

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): glibc's own names */
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *memory, size_t bytes);
void *__libc_memalign(size_t align, size_t bytes);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

static void watch(void)
{
    if (stepping)
        leave(ALLOCATES);
}

void *malloc(size_t bytes)
{
    watch();
    return __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
    watch();
    return __libc_calloc(count, bytes);
}

void *realloc(void *memory, size_t bytes)
{
    watch();
    return __libc_realloc(memory, bytes);
}

void *aligned_alloc(size_t align, size_t bytes)
{
    watch();
    return __libc_memalign(align, bytes);
}
#endif

/* --- the filter --------------------------------------------------------------------------------*/

static void on_forbidden(int signal_number, siginfo_t *info, void *context)
{
    (void)signal_number;
    (void)context;
    leave(100 + info->si_syscall % 100);
}

#define ALLOW(number)                                                                              \
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)

/* For all threads of the process. */
static int forbid_all_but_waiting(void)
{
    struct sock_filter rules[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        ALLOW(SYS_futex),
        ALLOW(SYS_sched_yield),
        ALLOW(SYS_exit_group),
        /* A thread that was made before, and begins only now. */
        ALLOW(SYS_set_robust_list),
        ALLOW(SYS_rseq),
        ALLOW(SYS_rt_sigprocmask),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
    };
    struct sock_fprog program = {sizeof rules / sizeof rules[0], rules};
    struct sigaction action = {.sa_sigaction = on_forbidden, .sa_flags = SA_SIGINFO};
    sigaction(SIGSYS, &action, NULL);
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                   syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC,
                           &program) == 0
               ? 0
               : -1;
}

/* --- worlds ------------------------------------------------------------------------------------*/

struct trial {
    const char *name, *text;
    uint32_t threads, frames, commands;
};

static int run_steps(void *context)
{
    const struct trial *trial = context;
    struct fixture f;
    fixture_open(&f, trial->text);
    fixture_threads(&f, trial->threads);
    for (uint32_t i = 0; i < trial->commands; i++)
        steps_send(&f, (enum command_ring)(i % COMMAND_RING_COUNT),
                   (struct command){.type = COMMAND_DRIVE,
                                    .source = 77,
                                    .source_sequence = i + 1,
                                    .entity = 1 + i % 20,
                                    .value = {1.0, (double)(i % 7) / 7.0 - 0.5, 0.0}});
    fixture_forget_copies(&f);
    if (forbid_all_but_waiting() != 0)
        return NO_FILTER;
    stepping = true;
    for (uint32_t i = 0; i < trial->frames; i++)
        frame_stepper_step(&f.stepper, NULL);
    leave(0); /* ending threads and world takes more */
    return NO_FILTER;
}

static void check(const struct trial *trial)
{
#if defined(__SANITIZE_THREAD__)
    skip(); /* it notes each store in memory that it takes as it goes */
#endif
    int result = child_run(run_steps, (void *)(uintptr_t)trial);
    if (result == ALLOCATES)
        fail_msg("%s, %u threads: a step takes memory", trial->name, trial->threads);
    if (result >= 100)
        fail_msg("%s, %u threads: a step makes system call %d, or one some hundreds on",
                 trial->name, trial->threads, result - 100);
    assert_int_equal(result, 0);
}

/* Appends to a scenario's text. */
__attribute__((format(printf, 2, 3))) static void put(char *text, const char *format, ...)
{
    size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, TEXT_BYTES - length, format, arguments);
    va_end(arguments);
}

static void put_grid(char *text, const char *kind, double step, int side)
{
    put(text, "objects = (\n");
    for (int i = 0; i < side * side; i++)
        put(text, "%s{ kind = \"%s\"; at = [%.1f, %.1f]; }\n", i > 0 ? "," : "", kind,
            25000.0 + step * (i % side), 25000.0 + step * (i / side));
    put(text, ");\n");
}

/* They drive off, each in another direction. */
static void put_heap(char *text, int count, double x, double z)
{
    static const char *const kinds[] = {"tank", "jeep", "truck"};
    put(text, "vehicles = (\n");
    for (int i = 0; i < count; i++)
        put(text,
            "%s{ kind = \"%s\"; at = [%.1f, %.1f]; heading_deg = %d.0; speed_mps = 12.0; "
            "behaviour = \"hold\"; }\n",
            i > 0 ? "," : "", kinds[i % 3], x + 0.1 * (i % 10), z + 0.1 * (i / 10), i * 7 % 360);
    put(text, ");\n");
}

static void put_bombs(char *text, int count, double x, double z)
{
    put(text, "fires = (\n");
    for (int i = 0; i < count; i++)
        put(text, "%s{ at_s = 0.1; munition = \"%s\"; point = [%.1f, %.1f]; }\n", i > 0 ? "," : "",
            i % 2 ? "bomb" : "artillery", x + 3.0 * (i % 10), z + 3.0 * (i / 10));
    put(text, ");\n");
}

static char *begin(const char *collision)
{
    static char text[TEXT_BYTES];
    text[0] = '\0';
    put(text, "world = { seed = 3; capacity = 512; hz = 10.0; };\ncollision = { %s };\n",
        collision);
    return text;
}

static void test_forests_heaps_and_bursts(void **state)
{
    (void)state;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        char *text = begin("shape = \"sphere\";");
        put_grid(text, "tree", 5.0, 31);
        put_bombs(text, 100, 25060.0, 25060.0);
        check(&(struct trial){"a forest and bombs", text, threads, 60, 0});
        text = begin("shape = \"model\";");
        put_grid(text, "bush", 2.5, 31);
        put_heap(text, 40, 25040.0, 25040.0);
        put_bombs(text, 20, 25040.0, 25040.0);
        check(&(struct trial){"a heap among bushes", text, threads, 15, 0});
    }
}

static void test_agents_that_fight_and_commands(void **state)
{
    static const char fight[] =
        "world = { seed = 5; capacity = 512; hz = 10.0; };\n"
        "terrain = { source = \"generated\"; spacing_m = 125.0; };\n"
        "vehicles = ( { kind = \"tank\"; count = 60; force = \"blue\"; engage = \"free\";"
        "    area = [27000.0, 25000.0, 27800.0, 25800.0]; },"
        "  { kind = \"jeep\"; count = 60; force = \"red\"; engage = \"free\";"
        "    area = [27000.0, 25000.0, 27800.0, 25800.0]; },"
        "  { kind = \"helicopter\"; count = 20; force = \"red\"; engage = \"free\";"
        "    area = [27000.0, 25000.0, 27800.0, 25800.0]; } );\n";
    (void)state;
    for (uint32_t threads = 1; threads <= 2; threads++)
        check(&(struct trial){"a fight", fight, threads, 100, 3000});
}

static void test_every_method_and_response(void **state)
{
    static const char *const methods[] = {"swept",     "npsnet2",  "mps",
                                          "occupancy", "hopcroft", "brute"};
    static const char *const responses[] = {"impulse", "figure8", "spring", "mps", "none"};
    char collision[128];
    (void)state;
    for (size_t i = 0; i < 6 + 5; i++) {
        snprintf(collision, sizeof collision,
                 "shape = \"sphere\"; method = \"%s\"; response = \"%s\";", methods[i < 6 ? i : 0],
                 responses[i < 6 ? 0 : i - 6]);
        char *text = begin(collision);
        put_grid(text, "tree", 4.0, 12);
        put_heap(text, 40, 25020.0, 25020.0);
        put_bombs(text, 10, 25010.0, 25010.0);
        check(&(struct trial){collision, text, 2, 20, 0});
    }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
static int allocate(void *context)
{
    void *volatile memory;
    stepping = true;
    memory = malloc(16);
    (void)context;
    free(memory);
    return 0;
}
#endif

static int ask(void *context)
{
    (void)context;
    if (forbid_all_but_waiting() != 0)
        return NO_FILTER;
    return getppid() == 0;
}

static void test_the_trap_traps(void **state)
{
    (void)state;
    assert_int_equal(child_run(ask, NULL), 100 + SYS_getppid % 100);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    assert_int_equal(child_run(allocate, NULL), ALLOCATES);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_trap_traps),
        cmocka_unit_test(test_forests_heaps_and_bursts),
        cmocka_unit_test(test_agents_that_fight_and_commands),
        cmocka_unit_test(test_every_method_and_response),
    };
    return cmocka_run_group_tests_name("step memory", tests, NULL, NULL);
}
