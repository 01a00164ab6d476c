/* The files that a role can use in its sandbox, and its end when the world's object is made
 * shorter. */
#include "ipc/sandbox/sandbox.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "tests/support/confined.h"
#include "tests/support/named_world.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmocka.h>

static struct error_text error;

/* Tries files outside and inside the folder. Returns the number of the first wrong result. */
static int touch_files(void *context)
{
    const enum role *role = context;
    struct sandbox sandbox;
    char outside[] = "/tmp/jolon-sandbox-outside";
    int fd = open(confined_folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (sandbox_begin(&sandbox, *role, false, &error) != 0 ||
        sandbox_files(&sandbox, &fd, 1, &error) != 0 || sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    int file = openat(fd, "inside", O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, 10) != 0)
        return 1;
    if (renameat(fd, "inside", fd, "renamed") != 0 || unlinkat(fd, "renamed", 0) != 0)
        return 2;
    if (open(outside, O_RDWR | O_CREAT | O_CLOEXEC, 0600) >= 0 || errno != EACCES)
        return 3;
    if (open("/etc/passwd", O_RDWR | O_CLOEXEC) >= 0 || errno != EACCES)
        return 4;
    if (open("/dev/shm", O_RDONLY | O_CLOEXEC) >= 0 || errno != EACCES)
        return 5;
    if ((open("/usr/bin/env", O_RDONLY | O_CLOEXEC) >= 0) != (*role == ROLE_RENDERER))
        return 6;
    if (open("/proc/1/environ", O_RDONLY | O_CLOEXEC) >= 0)
        return 7;
    return 0;
}

static void test_files_only_beneath_the_folder(void **state)
{
    enum role roles[] = {ROLE_RECORDER, ROLE_RENDERER};
    (void)state;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) < 0)
        skip(); /* this kernel has no Landlock; the role says so */
    for (size_t i = 0; i < 2; i++) {
        int result = confined_run(touch_files, &roles[i]);
        if (result != 0)
            fail_msg("%s: %d: %s", role_name(roles[i]), result, confined_output);
    }
}

/* The console reads worlds, and writes and makes no file. */
static int look_at_worlds(void *context)
{
    const char *shm = context;
    struct sandbox sandbox;
    if (sandbox_begin(&sandbox, ROLE_CONSOLE, false, &error) != 0 ||
        sandbox_files(&sandbox, NULL, 0, &error) != 0 || sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    if (open(shm, O_RDONLY | O_CLOEXEC) < 0)
        return 1;
    if (open(shm, O_RDWR | O_CLOEXEC) >= 0 || errno != EACCES)
        return 2;
    if (open("/dev/shm/jolon-none", O_RDWR | O_CREAT | O_CLOEXEC, 0600) >= 0 || errno != EACCES)
        return 3;
    if (open(confined_folder, O_RDONLY | O_CLOEXEC) >= 0 || errno != EACCES)
        return 4;
    return 0;
}

static void test_a_console_only_reads_worlds(void **state)
{
    char name[SEGMENT_NAME_MAX];
    struct segment_paths paths;
    (void)state;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) < 0)
        skip(); /* this kernel has no Landlock; the console says so */
    named_world_make(name, "vehicles = ();");
    named_world_paths(&paths, name);
    int result = confined_run(look_at_worlds, paths.object);
    named_world_remove(name);
    if (result != 0)
        fail_msg("%d: %s", result, confined_output);
}

/* --- the world's memory taken away --- */

/* Makes a world, and the role that attaches to it. */
struct loss {
    enum role role;
    char name[SEGMENT_NAME_MAX];
    struct segment_paths paths;
};

static int lose_memory(void *context)
{
    const struct loss *loss = context;
    struct sandbox sandbox;
    struct view view;
    process_guard();
    if (segment_attach(&view, loss->name, loss->role, &error) != 0 ||
        sandbox_begin(&sandbox, loss->role, false, &error) != 0 ||
        truncate(loss->paths.object, 0) != 0 || sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    const volatile uint64_t *frame = &view.w[0].head->frame;
    return *frame == UINT64_MAX ? 2 : 3;
}

static void test_shortened_object_is_reported_in_the_sandbox(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        struct loss loss = {.role = (enum role)role};
        named_world_make(loss.name, "vehicles = ();");
        named_world_paths(&loss.paths, loss.name);
        int result = confined_run(lose_memory, &loss);
        named_world_remove(loss.name);
        if (result != EXIT_REFUSED || !strstr(confined_output, "memory went away"))
            fail_msg("%s: %d: %s", role_name(loss.role), result, confined_output);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_files_only_beneath_the_folder),
        cmocka_unit_test(test_a_console_only_reads_worlds),
        cmocka_unit_test(test_shortened_object_is_reported_in_the_sandbox),
    };
    if (!confined_available())
        return confined_skip();
    return cmocka_run_group_tests(tests, confined_make_folder, confined_remove_folder);
}
