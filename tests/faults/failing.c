/* Preloaded into a program, makes calls of a class fail. FAIL_CALL=CLASS:N: the Nth call fails.
 * FAIL_CALL=CLASS:N+: the Nth and all later calls fail. Classes:
 *
 *     malloc     malloc and related functions, operator new included: ENOMEM
 *     mmap       ENOMEM
 *     open       open, openat, fopen, opendir: EMFILE (FAIL_ERRNO=ENFILE: the system's own limit)
 *     fallocate  posix_fallocate: ENOSPC
 *     write      write to anything but standard output and error: ENOSPC
 *     read       read, pread: EIO
 *     lock       fcntl: ENOLCK
 *     thread     pthread_create: EAGAIN
 *     semaphore  sem_init: ENOSPC
 *     rename     renameat2: ENOMEM
 *
 * Calls are counted from main() on, because before it the program cannot report anything.
 * FAIL_MARK=FILE: the file receives the place of the failed call, or zeros when none failed. */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

/* glibc's own names of malloc, because dlsym() may itself allocate. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

enum { MARK_BYTES = 256 };

static _Atomic uint64_t calls;
static bool begun;
static int (*main_of_the_program)(int, char **, char **);

/* Reads the environment without getenv(), because malloc is called before getenv() is ready. */
static const char *setting(const char *name)
{
    size_t length = strlen(name);
    for (char **at = environ; at && *at; at++) {
        if (strncmp(*at, name, length) == 0 && (*at)[length] == '=')
            return *at + length + 1;
    }
    return NULL;
}

/* Where a failed call is recorded: the file of FAIL_MARK. It is mapped before the program enters
 * its sandbox, which prevents opening files. */
static char *noted;

static void open_mark(void)
{
    const char *path = setting("FAIL_MARK");
    if (!path)
        return;
    long fd = syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    syscall(SYS_ftruncate, fd, MARK_BYTES);
    long page = syscall(SYS_mmap, NULL, MARK_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0L);
    syscall(SYS_close, fd);
    if (page == -1)
        abort();
    noted = (char *)page;
}

static void mark(const void *caller)
{
    Dl_info info = {0};
    if (!noted)
        return;
    dladdr(caller, &info);
    snprintf(noted, MARK_BYTES, "%s+0x%zx %s", info.dli_fname ? info.dli_fname : "?",
             (size_t)((const char *)caller - (const char *)info.dli_fbase),
             info.dli_sname ? info.dli_sname : "?");
}

static int begin(int argc, char **argv, char **environment)
{
    open_mark();
    begun = true;
    return main_of_the_program(argc, argv, environment);
}

int __libc_start_main(int (*program)(int, char **, char **), int argc, char **argv,
                      void (*init)(void), void (*fini)(void), void (*loader_fini)(void),
                      void *stack_end);
int __libc_start_main(int (*program)(int, char **, char **), int argc, char **argv,
                      void (*init)(void), void (*fini)(void), void (*loader_fini)(void),
                      void *stack_end)
{
    __typeof__(__libc_start_main) *next;
    *(void **)(void *)&next = dlsym(RTLD_NEXT, "__libc_start_main");
    main_of_the_program = program;
    return next(begin, argc, argv, init, fini, loader_fini, stack_end);
}

/* Is this call of the class the one that fails? */
static bool fails(const char *class, const void *caller)
{
    const char *wanted = begun ? setting("FAIL_CALL") : NULL;
    size_t length = strlen(class);
    if (!wanted || strncmp(wanted, class, length) != 0 || wanted[length] != ':')
        return false;
    char *end;
    int error = errno;
    uint64_t number = strtoull(wanted + length + 1, &end, 10);
    uint64_t call = atomic_fetch_add(&calls, 1) + 1;
    errno = error;
    if (call < number || (call > number && *end != '+'))
        return false;
    if (call == number)
        mark(caller);
    return true;
}

#define FAILS(class) fails(class, __builtin_return_address(0))
#define NEXT(function)                                                                             \
    static __typeof__(function) *next;                                                             \
    if (!next)                                                                                     \
    *(void **)(void *)&next = dlsym(RTLD_NEXT, #function)

/* --- memory ------------------------------------------------------------------------------------*/

static void *no_memory(void)
{
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size)
{
    return FAILS("malloc") ? no_memory() : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return FAILS("malloc") ? no_memory() : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    return FAILS("malloc") ? no_memory() : __libc_realloc(memory, size);
}

void *memalign(size_t alignment, size_t size);
void *memalign(size_t alignment, size_t size)
{
    return FAILS("malloc") ? no_memory() : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return FAILS("malloc") ? no_memory() : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    if (FAILS("malloc"))
        return ENOMEM;
    *memory = __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}

void *mmap(void *address, size_t bytes, int protection, int flags, int fd, off_t offset)
{
    if (FAILS("mmap")) {
        errno = ENOMEM;
        return MAP_FAILED;
    }
    return (void *)syscall(SYS_mmap, address, bytes, protection, flags, fd, offset);
}

/* --- files -------------------------------------------------------------------------------------*/

static int no_descriptor(void)
{
    const char *wanted = setting("FAIL_ERRNO");
    errno = wanted && strcmp(wanted, "ENFILE") == 0 ? ENFILE : EMFILE;
    return -1;
}

int open(const char *path, int flags, ...)
{
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(args, mode_t) : 0;
    va_end(args);
    return FAILS("open") ? no_descriptor() : (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}

int openat(int directory, const char *path, int flags, ...)
{
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(args, mode_t) : 0;
    va_end(args);
    return FAILS("open") ? no_descriptor() : (int)syscall(SYS_openat, directory, path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    NEXT(fopen);
    if (FAILS("open")) {
        no_descriptor();
        return NULL;
    }
    return next(path, mode);
}

DIR *opendir(const char *path)
{
    NEXT(opendir);
    if (FAILS("open")) {
        no_descriptor();
        return NULL;
    }
    return next(path);
}

int posix_fallocate(int fd, off_t offset, off_t bytes)
{
    NEXT(posix_fallocate);
    return FAILS("fallocate") ? ENOSPC : next(fd, offset, bytes);
}

ssize_t write(int fd, const void *bytes, size_t count)
{
    if (fd > STDERR_FILENO && FAILS("write")) {
        errno = ENOSPC;
        return -1;
    }
    return syscall(SYS_write, fd, bytes, count);
}

ssize_t read(int fd, void *bytes, size_t count)
{
    if (FAILS("read")) {
        errno = EIO;
        return -1;
    }
    return syscall(SYS_read, fd, bytes, count);
}

ssize_t pread(int fd, void *bytes, size_t count, off_t offset)
{
    if (FAILS("read")) {
        errno = EIO;
        return -1;
    }
    return syscall(SYS_pread64, fd, bytes, count, offset);
}

int fcntl(int fd, int command, ...)
{
    va_list args;
    va_start(args, command);
    void *argument = va_arg(args, void *);
    va_end(args);
    if (FAILS("lock")) {
        errno = ENOLCK;
        return -1;
    }
    return (int)syscall(SYS_fcntl, fd, command, argument);
}

int renameat2(int from_directory, const char *from, int to_directory, const char *to,
              unsigned flags)
{
    if (FAILS("rename")) {
        errno = ENOMEM;
        return -1;
    }
    return (int)syscall(SYS_renameat2, from_directory, from, to_directory, to, flags);
}

/* --- threads -----------------------------------------------------------------------------------*/

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *),
                   void *argument)
{
    NEXT(pthread_create);
    return FAILS("thread") ? EAGAIN : next(thread, attributes, body, argument);
}

int sem_init(sem_t *semaphore, int shared, unsigned value)
{
    NEXT(sem_init);
    if (FAILS("semaphore")) {
        errno = ENOSPC;
        return -1;
    }
    return next(semaphore, shared, value);
}
