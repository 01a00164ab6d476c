/* The lists of system calls. Each rule is one system call, some only with certain arguments. A call
 * without a rule is trapped in a role, and allowed in the keeper. */
#include "ipc/sandbox/syscall_filter.h"

#include "world/runtime/checked_alloc.h"

#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#define TESTS_MAX 2

struct rule {
    int call;
    uint32_t tests; /* all must hold */
    struct scmp_arg_cmp test[TESTS_MAX];
};

struct list {
    const struct rule *rule;
    size_t count;
    uint32_t action; /* the action for these calls */
};

#define ANY(call)                                                                                  \
    {                                                                                              \
        SCMP_SYS(call), 0,                                                                         \
        {                                                                                          \
            {                                                                                      \
                0                                                                                  \
            }                                                                                      \
        }                                                                                          \
    }
/* Argument number equals value. */
#define WITH(call, number, value)                                                                  \
    {                                                                                              \
        SCMP_SYS(call), 1,                                                                         \
        {                                                                                          \
            {                                                                                      \
                number, SCMP_CMP_EQ, value, 0                                                      \
            }                                                                                      \
        }                                                                                          \
    }
/* The bits of mask in the argument equal value. */
#define BITS(number, mask, value)                                                                  \
    {                                                                                              \
        number, SCMP_CMP_MASKED_EQ, mask, value                                                    \
    }

/* An ioctl number contains the kind of device that it is for. */
#define IOCTL_KIND      0xff00u
#define IOCTL_DRM       0x6400u /* 'd' */
#define IOCTL_NVIDIA    0x4600u /* 'F' */
#define MAP_WHICH       ((uint64_t)(MAP_TYPE | MAP_ANONYMOUS))
#define MAP_MEMORY_ONLY ((uint64_t)(MAP_PRIVATE | MAP_ANONYMOUS))

/* Computing, sleeping, logging, ending and aborting. */
static const struct rule computing[] = {
    ANY(futex),                     /* doorbells, locks, workers, the readers' wait */
    ANY(sched_yield),               /* workers, where the processor may be needed */
    ANY(clock_nanosleep),           /* waits by the clock */
    ANY(clock_gettime),             /* where the clock cannot be read without a call */
    ANY(restart_syscall),           /* a wait continues after SIGSTOP and SIGCONT */
    ANY(rt_sigreturn),              /* the return from the handler of SIGTERM or SIGSYS */
    ANY(rt_sigprocmask),            /* abort, and a thread's start and end */
    WITH(rt_sigaction, 0, SIGABRT), /* abort; not SIGSYS, whose handler must stay */
    ANY(getpid),                    /* abort, names of temporary files */
    ANY(gettid),
    WITH(write, 0, STDERR_FILENO),  /* the log */
    WITH(writev, 0, STDERR_FILENO), /* the C library's fatal messages */
    ANY(close),
    ANY(exit),
    ANY(exit_group),
    ANY(set_robust_list), /* a thread that was made earlier and starts only now */
    ANY(rseq),
    /* Private memory without the right to execute. */
    ANY(brk),
    ANY(munmap),
    ANY(madvise),
    {SCMP_SYS(mmap), 2, {BITS(2, PROT_EXEC, 0), BITS(3, MAP_WHICH, MAP_MEMORY_ONLY)}},
};

/* Processes that allocate while they run. Mover and collider have all their memory before they
 * enter the sandbox: they only give it back, and the C library maps a little for its fatal
 * messages. */
static const struct rule growing[] = {
    ANY(mremap),
    {SCMP_SYS(mprotect), 1, {BITS(2, PROT_EXEC, 0)}},
};

/* The address sanitizer, also for its report. */
#ifdef SANDBOX_SANITIZED
static const struct rule sanitizing[] = {
    ANY(openat),     ANY(read),   ANY(lseek),    ANY(readlink),    ANY(fstat),
    ANY(newfstatat), ANY(mremap), ANY(mprotect), ANY(sigaltstack), ANY(prlimit64),
};
#endif

/* A stand-by process waits for the role's lock until the holder has died. */
static const struct rule standing_by[] = {
    WITH(fcntl, 1, F_OFD_SETLKW),
};

/* Threads, which are confined like the process; no new processes. */
static const struct rule threads[] = {
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_THREAD, CLONE_THREAD)}},
    WITH(prctl, 0, PR_SET_NAME),
    WITH(prctl, 0, PR_GET_NAME), /* Cyclone DDS logs the thread's name */
    ANY(sched_getaffinity),
};

/* Files; Landlock decides which ones (ipc/sandbox/file_rules.c). */
static const struct rule files[] = {
    ANY(openat),    ANY(read),       ANY(pread64),    ANY(write),     ANY(pwrite64),
    ANY(lseek),     ANY(newfstatat), ANY(fstat),      ANY(statx),     ANY(fstatfs),
    ANY(ftruncate), ANY(fallocate),  ANY(fsync),      ANY(fdatasync), WITH(fcntl, 1, F_GETFL),
    ANY(rename),    ANY(renameat),   ANY(renameat2),  ANY(unlink),    ANY(unlinkat),
    ANY(link),      ANY(linkat),     ANY(getdents64),
};

/* Drawing. In software it compiles shaders when they are first used; in hardware it controls the
 * device and maps its memory. */
static const struct rule drawing[] = {
    ANY(mmap),
    ANY(mprotect),
    ANY(mkdir),   /* the driver's cache */
    ANY(sysinfo), /* qsort() reads the amount of memory */
    ANY(flock),
    ANY(poll),
    ANY(ppoll),
    WITH(fcntl, 1, F_DUPFD_CLOEXEC),
    {SCMP_SYS(ioctl), 1, {BITS(1, IOCTL_KIND, IOCTL_DRM)}},
    {SCMP_SYS(ioctl), 1, {BITS(1, IOCTL_KIND, IOCTL_NVIDIA)}},
};

/* Open sockets, the pipe that wakes their threads, and new internet sockets only. */
static const struct rule networking[] = {
    WITH(fcntl, 1, F_OFD_GETLK), /* whether a silent role is dead */
    ANY(write),
    ANY(sendmsg),
    ANY(recvmsg),
    ANY(sendto),
    ANY(recvfrom),
    ANY(setsockopt),
    ANY(getsockopt),
    ANY(getsockname),
    ANY(pselect6),
    ANY(sysinfo),   /* DDS sorts readers and types by qsort() */
    ANY(uname),     /* DDS Security: the host's name in repeated announcements */
    ANY(getrandom), /* its nonces and keys */
    ANY(read),
    ANY(bind),
    ANY(connect),
    ANY(listen),
    ANY(accept4),
    WITH(socket, 0, AF_INET),
    WITH(socket, 0, AF_INET6),
    /* The bounded end of dds_link_close(). */
    ANY(alarm),
    WITH(rt_sigaction, 0, SIGALRM),
};

/* Serving the clients of a listening socket. No socket is made, and none is connected. */
static const struct rule serving[] = {
    ANY(accept4),
    ANY(recvfrom),
    ANY(sendto),
    ANY(sendmsg),
    ANY(shutdown),
    WITH(setsockopt, 1, IPPROTO_TCP),
    /* The user and process of a client. */
    {SCMP_SYS(getsockopt), 2, {{1, SCMP_CMP_EQ, SOL_SOCKET, 0}, {2, SCMP_CMP_EQ, SO_PEERCRED, 0}}},
};

/* Sending by sockets that are open. */
static const struct rule sending[] = {
    ANY(sendto),
};

/* Receiving from sockets that are open, many datagrams by one call. */
static const struct rule receiving[] = {
    ANY(recvmmsg),
};

/* Waiting for sockets and for a thread's wake-up descriptor. */
static const struct rule polling[] = {
    ANY(poll),
    ANY(ppoll),
};

/* A client of the command socket, which reconnects when the intake was restarted. */
static const struct rule commanding[] = {
    WITH(socket, 0, AF_UNIX),
    ANY(geteuid),
    /* The flags of runtime_folder_open(): nothing can be read through such a descriptor. */
    WITH(openat, 2, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC),
    {SCMP_SYS(getsockopt), 2, {{1, SCMP_CMP_EQ, SOL_SOCKET, 0}, {2, SCMP_CMP_EQ, SO_PEERCRED, 0}}},
    ANY(fstat),
    WITH(newfstatat, 3, AT_EMPTY_PATH), /* the C library's fstat() */
    ANY(connect),
    ANY(sendto),
    ANY(recvfrom),
};

/* A console beside its server: it watches worlds, asks the renderer's socket for pictures, and
 * kills a role on a user's request. */
static const struct rule world_watching[] = {
    ANY(read), /* the command queue's eventfd, the server thread's pipe */
    ANY(write),
    WITH(fcntl, 1, F_OFD_GETLK), /* whether a silent role is dead */
    ANY(openat),                 /* to read alone, and not everything: ipc/sandbox/file_rules.c */
    ANY(access),
    ANY(readlink),
    ANY(readlinkat),
    ANY(newfstatat),
    ANY(getuid),
    ANY(shutdown),
    ANY(getrandom), /* players' keys */
    ANY(pidfd_open),
    WITH(pidfd_send_signal, 1, SIGTERM),
    WITH(pidfd_send_signal, 1, SIGKILL),
    WITH(socket, 0, AF_UNIX),
    {SCMP_SYS(mmap), 1, {BITS(2, PROT_WRITE | PROT_EXEC, 0)}},
};

/* The C library tries clone3 first, whose flags a filter cannot see. When clone3 does not exist, it
 * uses clone. */
static const struct rule missing[] = {ANY(clone3)};

/* Drivers try these on threads that they start under load, and can do without. They are refused
 * because they could be used on any process of the user. */
static const struct rule optional[] = {
    ANY(sched_setscheduler),
    ANY(sched_setaffinity),
    ANY(setpriority),
};

/* Calls that neither the keeper needs nor any process that it starts, which inherits this list.
 * These look into other processes, ... */
static const struct rule process_access[] = {
    ANY(ptrace),      ANY(process_vm_readv),   ANY(process_vm_writev),
    ANY(pidfd_getfd), ANY(perf_event_open),    ANY(userfaultfd),
    ANY(kcmp),        WITH(ioctl, 1, TIOCSTI), /* types into the terminal */
};

/* ... these change the user, or a file's owner, ... */
static const struct rule user_changes[] = {
    ANY(setuid),    ANY(setgid),   ANY(setreuid), ANY(setregid),  ANY(setresuid),
    ANY(setresgid), ANY(setfsuid), ANY(setfsgid), ANY(setgroups), ANY(chown),
    ANY(fchown),    ANY(lchown),   ANY(fchownat),
};

/* ... these change the file system's mounts, or make new namespaces, ... */
static const struct rule namespaces[] = {
    ANY(mount),
    ANY(umount2),
    ANY(pivot_root),
    ANY(move_mount),
    ANY(open_tree),
    ANY(fsopen),
    ANY(fsconfig),
    ANY(fsmount),
    ANY(fspick),
    ANY(mount_setattr),
    ANY(chroot),
    ANY(unshare),
    ANY(setns),
    ANY(mknod),
    ANY(mknodat),
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWNS, CLONE_NEWNS)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWUSER, CLONE_NEWUSER)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWPID, CLONE_NEWPID)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWNET, CLONE_NEWNET)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWIPC, CLONE_NEWIPC)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWUTS, CLONE_NEWUTS)}},
    {SCMP_SYS(clone), 1, {BITS(0, CLONE_NEWCGROUP, CLONE_NEWCGROUP)}},
};

/* ... and these administer the kernel, or belong to large parts of it with a history of security
 * holes. */
static const struct rule administration[] = {
    ANY(bpf),
    ANY(io_uring_setup),
    ANY(io_uring_enter),
    ANY(io_uring_register),
    ANY(keyctl),
    ANY(add_key),
    ANY(request_key),
    ANY(kexec_load),
    ANY(kexec_file_load),
    ANY(init_module),
    ANY(finit_module),
    ANY(delete_module),
    ANY(reboot),
    ANY(swapon),
    ANY(swapoff),
    ANY(acct),
    ANY(quotactl),
    ANY(settimeofday),
    ANY(clock_settime),
    ANY(clock_adjtime),
    ANY(adjtimex),
    ANY(sethostname),
    ANY(setdomainname),
    ANY(syslog),
    ANY(vhangup),
    ANY(iopl),
    ANY(ioperm),
    ANY(modify_ldt),
    ANY(personality),
    ANY(name_to_handle_at),
    ANY(open_by_handle_at),
};

#define LIST(rules, action)                                                                        \
    {                                                                                              \
        rules, sizeof(rules) / sizeof(rules)[0], action                                            \
    }
#define ALLOW(rules) LIST(rules, SCMP_ACT_ALLOW)
#define END                                                                                        \
    {                                                                                              \
        NULL, 0, 0                                                                                 \
    }
#define EVERY_ROLE ALLOW(computing), LIST(missing, SCMP_ACT_ERRNO(ENOSYS))
#ifdef SANDBOX_SANITIZED
static const struct list frame_lists[] = {EVERY_ROLE, ALLOW(standing_by), ALLOW(sanitizing), END};
#else
static const struct list frame_lists[] = {EVERY_ROLE, ALLOW(standing_by), END};
#endif
static const struct list renderer_lists[] = {EVERY_ROLE,
                                             ALLOW(growing),
                                             ALLOW(threads),
                                             ALLOW(files),
                                             ALLOW(drawing),
                                             ALLOW(serving),
                                             LIST(optional, SCMP_ACT_ERRNO(EPERM)),
                                             END};
static const struct list intake_lists[] = {EVERY_ROLE, ALLOW(growing), ALLOW(serving),
                                           ALLOW(polling), END};
static const struct list reporter_lists[] = {EVERY_ROLE,        ALLOW(growing),    ALLOW(threads),
                                             ALLOW(networking), ALLOW(commanding), END};
static const struct list console_lists[] = {
    EVERY_ROLE,     ALLOW(growing),    ALLOW(threads),        ALLOW(serving),
    ALLOW(polling), ALLOW(commanding), ALLOW(world_watching), END};
static const struct list gateway_lists[] = {
    EVERY_ROLE, ALLOW(growing), ALLOW(sending), ALLOW(receiving), ALLOW(polling), ALLOW(commanding),
    END};
static const struct list recorder_lists[] = {EVERY_ROLE, ALLOW(growing), ALLOW(files), END};

/* Refused with EPERM instead of a trap, because libraries of a role that starts may try calls that
 * they can do without. */
#define DENY(rules) LIST(rules, SCMP_ACT_ERRNO(EPERM))
static const struct list keeper_lists[] = {DENY(process_access),
                                           DENY(user_changes),
                                           DENY(namespaces),
                                           DENY(administration),
                                           LIST(missing, SCMP_ACT_ERRNO(ENOSYS)),
                                           END};

static const struct list *const role_lists[ROLE_COUNT + 1] = {
#define X(tag, name, calls, ...) calls##_lists,
    ROLES(X)
#undef X
        [ROLE_NONE] = keeper_lists,
};

static int add_lists(scmp_filter_ctx filter, const struct list *list)
{
    for (; list->rule; list++) {
        for (size_t i = 0; i < list->count; i++) {
            const struct rule *rule = &list->rule[i];
            int result =
                seccomp_rule_add_array(filter, list->action, rule->call, rule->tests, rule->test);
            if (result != 0 && result != -EEXIST)
                return result;
        }
    }
    return 0;
}

/* Signals to the process itself: abort, and the end of the trap's handler. */
static int add_own_signals(scmp_filter_ctx filter)
{
    const uint64_t self = (uint64_t)getpid();
    static const int signals[] = {SIGABRT, SIGSYS};
    int result = 0;
    for (size_t i = 0; i < sizeof signals / sizeof signals[0] && result == 0; i++)
        result = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 2,
                                  SCMP_A0(SCMP_CMP_EQ, self, 0),
                                  SCMP_A2(SCMP_CMP_EQ, (uint64_t)signals[i], 0));
    return result;
}

static int set_attributes(scmp_filter_ctx filter)
{
    int result = seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC, 1);
    /* Calls of another architecture have other numbers, which the rules do not contain. */
    if (result == 0)
        result = seccomp_attr_set(filter, SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS);
    /* Kernels before 5.16 slow down every process with a filter, against speculation, unless told
     * not to. */
    if (result == 0)
        result = seccomp_attr_set(filter, SCMP_FLTATR_CTL_SSB, 1);
    return result;
}

struct loading {
    enum role role;
    int result;
};

static void load(void *context)
{
    struct loading *loading = context;
    bool keeper = loading->role == ROLE_NONE;
    scmp_filter_ctx filter = seccomp_init(keeper ? SCMP_ACT_ALLOW : SCMP_ACT_TRAP);
    if (!filter)
        return;
    int result = set_attributes(filter);
    if (result == 0)
        result = add_lists(filter, role_lists[loading->role]);
    if (result == 0 && !keeper)
        result = add_own_signals(filter);
    if (result == 0)
        result = seccomp_load(filter);
    seccomp_release(filter);
    loading->result = result;
}

int syscall_filter_load(enum role role)
{
    struct loading loading = {role, -ENOMEM};
    if (role > ROLE_NONE)
        return -EINVAL;
    return memory_guarded(load, &loading) ? loading.result : -ENOMEM;
}
