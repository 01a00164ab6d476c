/* Crash points: counting, dying, and finding stores by page faults. */
#include "ipc/process/crash_point.h"

#include "ipc/process/log.h"
#include "world/runtime/check.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

/* The linker defines these names for the ends of the section. */
extern struct crash_point __start_crash_points[], __stop_crash_points[];

static struct {
    char role[32], point[64];
    uint64_t crossing; /* 0: no process dies */
    int signal_number;
} request = {.signal_number = SIGKILL};

static const char *own_role = "?";
static const char *count_path;

static struct {
    unsigned char *first;
    size_t bytes;
    bool each_store; /* false: only the first store to each page */
} guard;

__attribute__((constructor)) static void begin(void)
{
    const char *text = getenv("JOLON_CRASH");
    count_path = getenv("JOLON_CRASH_COUNT");
    if (text && sscanf(text, "%31[^:]:%63[^:]:%" SCNu64 ":%d", request.role, request.point,
                       &request.crossing, &request.signal_number) < 3)
        die_usage("JOLON_CRASH=%s: must be ROLE:NAME:N[:SIGNAL], for example mover:moved:2", text);
}

__attribute__((destructor)) static void end(void)
{
    if (!count_path)
        return;
    FILE *file = fopen(count_path, "a");
    CHECK(file);
    for (const struct crash_point *point = __start_crash_points; point < __stop_crash_points;
         point++)
        fprintf(file, "%s\t%s\t%" PRIu64 "\n", own_role, point->name,
                atomic_load(&point->crossings));
    fclose(file);
}

void crash_point_role(const char *role)
{
    own_role = role;
}

void crash_point_cross(struct crash_point *point)
{
    uint64_t crossing = atomic_fetch_add(&point->crossings, 1) + 1;
    if (crossing != request.crossing || strcmp(point->name, request.point) != 0 ||
        strcmp(own_role, request.role) != 0)
        return;
    kill(getpid(), request.signal_number);
    for (;;)
        pause();
}

/* --- stores found by their faults --------------------------------------------------------------*/

static void protect(unsigned char *first, size_t bytes, int protection)
{
    CHECK(mprotect(first, bytes, protection) == 0);
}

/* Single steps: the process stops after the one store, and the pages are protected again. Only the
 * trap flag of x86-64 is known here. */
#if defined(__x86_64__)
#define TRAP_FLAG 0x100
static void single_step(ucontext_t *context, bool on)
{
    greg_t *flags = &context->uc_mcontext.gregs[REG_EFL];
    *flags = on ? *flags | TRAP_FLAG : *flags & ~(greg_t)TRAP_FLAG;
}
static const bool can_step = true;
#else
static void single_step(ucontext_t *context, bool on)
{
    (void)context, (void)on;
}
static const bool can_step = false;
#endif

static void on_fault(int number, siginfo_t *info, void *context)
{
    unsigned char *at = info->si_addr;
    if (at < guard.first || at >= guard.first + guard.bytes) { /* a real fault ends the process */
        signal(number, SIG_DFL);
        return;
    }
    if (guard.each_store)
        CRASH_POINT("store in a step");
    if (!guard.each_store)
        CRASH_POINT("page of a new world");
    if (guard.each_store && can_step) {
        protect(guard.first, guard.bytes, PROT_READ | PROT_WRITE);
        single_step(context, true);
        return;
    }
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    protect(guard.first + (size_t)(at - guard.first) / page * page, page, PROT_READ | PROT_WRITE);
}

static void on_step(int number, siginfo_t *info, void *context)
{
    (void)number, (void)info;
    single_step(context, false);
    protect(guard.first, guard.bytes, PROT_READ);
}

static void guard_begin(void *first, size_t bytes, bool each_store, const char *point)
{
    struct sigaction fault = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO};
    struct sigaction step = {.sa_sigaction = on_step, .sa_flags = SA_SIGINFO};
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    if (!count_path && strcmp(request.point, point) != 0)
        return; /* faults are slow, and no point needs them */
    sigemptyset(&fault.sa_mask);
    sigemptyset(&step.sa_mask);
    sigaction(SIGSEGV, &fault, NULL);
    sigaction(SIGTRAP, &step, NULL);
    guard.first = first;
    guard.bytes = (bytes + page - 1) / page * page;
    guard.each_store = each_store;
    protect(guard.first, guard.bytes, PROT_READ);
}

void crash_point_guard_stores(void *first, size_t bytes)
{
    guard_begin(first, bytes, true, "store in a step");
}

void crash_point_guard_pages(void *first, size_t bytes)
{
    guard_begin(first, bytes, false, "page of a new world");
}

void crash_point_unguard(void)
{
    if (!guard.first)
        return;
    protect(guard.first, guard.bytes, PROT_READ | PROT_WRITE);
    guard.first = NULL;
    signal(SIGSEGV, SIG_DFL);
    signal(SIGTRAP, SIG_DFL);
}
