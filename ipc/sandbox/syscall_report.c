/* The handler of SIGSYS. The names of the system calls are looked up beforehand, because libseccomp
 * may allocate for that, and a process may be trapped while it allocates. */
#include "ipc/sandbox/syscall_report.h"

#include <errno.h>
#include <seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#define CALLS_MAX  512 /* higher numbers are reported without a name */
#define NAME_BYTES 32

#define KERNEL_SET_BYTES 8 /* of the kernel's signal set, one bit for each of 64 */

static char names[CALLS_MAX][NAME_BYTES];
static char beginning[96];

static size_t put_text(char *line, size_t at, const char *text)
{
    return (size_t)(stpcpy(line + at, text) - line);
}

static size_t put_number(char *line, size_t at, unsigned number)
{
    char digits[12];
    size_t count = 0;
    do {
        digits[count++] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    while (count > 0)
        line[at++] = digits[--count];
    return at;
}

/* Async-signal-safe. SIGSYS has its default action again (SA_RESETHAND) and is blocked until the
 * handler returns. Then the second SIGSYS, sent here, ends the process. */
static void on_trap(int signal_number, siginfo_t *info, void *context)
{
    char line[sizeof beginning + NAME_BYTES + 32];
    unsigned number = (unsigned)info->si_syscall;
    size_t length = put_text(line, 0, beginning);
    (void)context;
    length = put_number(line, length, number);
    if (number < CALLS_MAX && names[number][0] != '\0') {
        length = put_text(line, length, " (");
        length = put_text(line, length, names[number]);
        length = put_text(line, length, ")");
    }
    line[length++] = '\n';
    ssize_t written = write(STDERR_FILENO, line, length);
    (void)written; /* an error could not be reported anywhere */
    syscall(SYS_tgkill, getpid(), (pid_t)syscall(SYS_gettid), signal_number);
}

/* Threads of libraries start with every signal blocked, and the kernel ends a process that blocks
 * SIGSYS without calling its handler. These two functions replace the C library's, for this program
 * and its shared libraries, and never block SIGSYS. */
int pthread_sigmask(int how, const sigset_t *wanted, sigset_t *before)
{
    sigset_t set;
    if (wanted) {
        set = *wanted;
        if (how != SIG_UNBLOCK)
            sigdelset(&set, SIGSYS);
        wanted = &set;
    }
    return syscall(SYS_rt_sigprocmask, how, wanted, before, (size_t)KERNEL_SET_BYTES) == 0 ? 0
                                                                                           : errno;
}

int sigprocmask(int how, const sigset_t *wanted, sigset_t *before)
{
    int error = pthread_sigmask(how, wanted, before);
    if (error != 0)
        errno = error;
    return error == 0 ? 0 : -1;
}

static void look_up_names(void)
{
    for (int number = 0; number < CALLS_MAX; number++) {
        char *name = seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, number);
        if (name)
            snprintf(names[number], NAME_BYTES, "%s", name);
        free(name);
    }
}

int syscall_report_install(enum role role)
{
    struct sigaction action = {.sa_sigaction = on_trap, .sa_flags = SA_SIGINFO | (int)SA_RESETHAND};
    look_up_names();
    snprintf(beginning, sizeof beginning, "jolon-%s: the sandbox forbids system call ",
             role_name(role));
    sigemptyset(&action.sa_mask);
    return sigaction(SIGSYS, &action, NULL) == 0 ? 0 : -errno;
}
