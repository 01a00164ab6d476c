/* The steps into the sandbox. */
#include "ipc/sandbox/sandbox.h"

#include "ipc/process/log.h"
#include "ipc/sandbox/file_rules.h"
#include "ipc/sandbox/syscall_filter.h"
#include "ipc/sandbox/syscall_report.h"

#include <errno.h>
#include <linux/capability.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED true
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||                         \
    __has_feature(memory_sanitizer)
#define SANITIZED true
#endif
#endif
#ifndef SANITIZED
#define SANITIZED false
#endif

/* Crash points need signals to the own process, page protection and a file at the end
 * (ipc/process/crash_point.h). */
#ifdef CRASHPOINTS
#define CRASHES true
#else
#define CRASHES false
#endif

/* Returns why this build needs more system calls than this role's list has, NULL when it does
 * not. */
static const char *needs_more(enum role role)
{
#ifdef SANDBOX_SANITIZED
    if (!role_has(role, ROLE_MAKES_FRAMES))
        return "a sanitizer";
#else
    (void)role;
    if (SANITIZED)
        return "a sanitizer";
#endif
    return CRASHES ? "a build with crash points" : NULL;
}

static int refused(struct error_text *error, const char *what, int code)
{
    return error_text_set(
        error,
        "sandbox: %s: %s; this kernel or container does not allow it: allow it, or "
        "run with --no-sandbox",
        what, strerror(code));
}

/* Drops all capabilities, so that neither this process nor a program that it runs has them. */
static int drop_capabilities(void)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    const struct __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {{0}};
    /* Dropping from the bounding set needs CAP_SETPCAP. A process without it has nothing to
     * bound. */
    for (int capability = 0; prctl(PR_CAPBSET_READ, capability) >= 0; capability++)
        (void)prctl(PR_CAPBSET_DROP, capability);
    (void)prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
    return (int)syscall(SYS_capset, &header, none);
}

static int drop_privileges(struct error_text *error)
{
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return refused(error, "no new privileges", errno);
    if (drop_capabilities() != 0)
        return refused(error, "dropping capabilities", errno);
    return 0;
}

/* Turns the result of a Landlock step into 0 or -1. Old kernels have no Landlock. */
static int files_done(int result, struct error_text *error)
{
    if (result == -ENOSYS || result == -EOPNOTSUPP) {
        log_info("this kernel has no Landlock: any file of its user's is open to it");
        return 0;
    }
    return result == 0 ? 0 : refused(error, "Landlock", -result);
}

int sandbox_begin(struct sandbox *sandbox, enum role role, bool off, struct error_text *error)
{
    *sandbox = (struct sandbox){.role = role};
    if (off) {
        log_warn("runs WITHOUT its sandbox (--no-sandbox): a fault in it can do whatever its user "
                 "can");
        return 0;
    }
    const char *what = needs_more(role);
    if (what) {
        log_info("runs without its sandbox: %s needs more system calls than that allows", what);
        return 0;
    }
    if (drop_privileges(error) != 0)
        return -1;
    /* All threads allocate from one arena. For further arenas the C library sometimes opens files,
     * to count processors and to read the kernel's overcommit mode. */
    (void)mallopt(M_ARENA_MAX, 1);
    /* The first conversion of a date, also in a library, would read the time zone's file. */
    tzset();
    sandbox->on = true;
    return 0;
}

int sandbox_files(const struct sandbox *sandbox, const int *folders, size_t count,
                  struct error_text *error)
{
    if (!sandbox->on)
        return 0;
    return files_done(file_rules_confine(sandbox->role, folders, count), error);
}

#ifdef SANDBOX_SANITIZED
/* The leak search at the process's end needs another process that reads this one, which the filter
 * forbids. */
static int entered;
int __lsan_is_turned_off(void); /* NOLINT(bugprone-reserved-identifier): the sanitizer's name */
int __lsan_is_turned_off(void)  /* NOLINT(bugprone-reserved-identifier): the sanitizer's name */
{
    return entered;
}
#endif

int sandbox_enter(const struct sandbox *sandbox, struct error_text *error)
{
    if (!sandbox->on)
        return 0;
    int result = syscall_report_install(sandbox->role);
    if (result == 0)
        result = syscall_filter_load(sandbox->role);
#ifdef SANDBOX_SANITIZED
    entered = 1;
#endif
    return result == 0 ? 0 : refused(error, "seccomp", -result);
}

int sandbox_keeper(const char *const *folders, size_t count, struct error_text *error)
{
    if (SANITIZED || CRASHES)
        return 0;
    if (drop_privileges(error) != 0 ||
        files_done(file_rules_confine_keeper(folders, count), error) != 0)
        return -1;
    int result = syscall_filter_load(ROLE_NONE);
    return result == 0 ? 0 : refused(error, "seccomp", -result);
}
