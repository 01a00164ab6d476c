/* Kinds of runs: the roles' own, and what is done to a world before they come or after. */
#include "tests/crash/runs.h"

#include "ipc/segment/local_socket.h"
#include "ipc/segment/segment_attach.h"
#include "tests/support/child.h"
#include "tests/support/named_world.h"

#include <fcntl.h>
#include <glob.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char scenario_path[128], image_path[128];

void runs_open(const char *scenario_text)
{
    trial_path(image_path, sizeof image_path, "image");
    trial_path(scenario_path, sizeof scenario_path, "battle.cfg");
    FILE *file = fopen(scenario_path, "w");
    assert_non_null(file);
    assert_true(fputs(scenario_text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

void run_roles(struct ending *ending, const struct plan *plan, const struct death *death,
               const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    trial_run(ending, plan, name, death, count);
}

/* Runs a program, again if it dies as told; it must end with the exit code, and there must be so
 * many files of worlds then: an object, its name and its lock are three. */
static bool run_program(struct ending *ending, const char *const argv[], const struct death *death,
                        const char *count, int code, int files)
{
    *ending = (struct ending){0};
    int status = child_wait(trial_start(argv, death, count));
    if (death && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
        ending->died = true;
        status = child_wait(trial_start(argv, NULL, NULL));
    }
    int left = named_world_leftovers();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != code)
        snprintf(ending->refused, sizeof ending->refused, "jolon-world %s ends with status %d",
                 argv[1], status);
    else if (left != files)
        snprintf(ending->refused, sizeof ending->refused,
                 "after jolon-world %s there are %d files instead of %d", argv[1], left, files);
    return ending->refused[0] == '\0';
}

static void go_on(struct ending *ending, const struct plan *plan, const char *world)
{
    bool dead = ending->died;
    trial_run(ending, plan, world, NULL, NULL);
    ending->died = dead;
}

static int nothing(void *context)
{
    (void)context;
    return 0;
}

/* What a writer of the image left that was killed; its process is no more. */
static void plant_torn_image(void)
{
    char path[sizeof image_path + 32];
    pid_t pid = child_start(nothing, NULL);
    child_wait(pid);
    snprintf(path, sizeof path, "%s.new-%d", image_path, (int)pid);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    assert_true(fd >= 0);
    close(fd);
}

/* What a creator left that was killed between the name and the object. */
static void plant_name(const char *world)
{
    struct segment_paths paths;
    struct error_text error;
    char object[SEGMENT_PATH_MAX];
    assert_int_equal(segment_paths(&paths, world, &error), 0);
    snprintf(object, sizeof object, "/dev/shm/jolon.%u.%s.%032x", (unsigned)getuid(), world, 1);
    assert_int_equal(symlink(object, paths.name), 0);
}

void run_created(struct ending *ending, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    named_world_name(name);
    const char *const argv[] = {"jolon-world", "create",      "--world", name,
                                "--adopt",     scenario_path, NULL};
    plant_name(name);
    if (run_program(ending, argv, death, count, 0, 3))
        go_on(ending, plan, name);
}

void run_refused(struct ending *ending, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    const char *const argv[] = {"jolon-world", "create", "--world", name, scenario_path, NULL};
    if (run_program(ending, argv, death, count, 1, 3))
        go_on(ending, plan, name);
}

void run_removed(struct ending *ending, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    struct error_text error;
    const char *const argv[] = {"jolon-world", "remove", "--world", name, NULL};
    int socket = local_socket_listen(name, "pictures", SOCK_STREAM, 1, &error);
    assert_true(socket >= 0);
    close(socket);
    run_program(ending, argv, death, count, 0, 0);
}

/* Has a writer of the image that died left its own? */
static bool image_torn(void)
{
    char pattern[sizeof image_path + 16];
    glob_t found = {0};
    snprintf(pattern, sizeof pattern, "%s.new-*", image_path);
    bool torn = glob(pattern, 0, NULL, &found) != GLOB_NOMATCH;
    globfree(&found);
    return torn;
}

void run_saved(struct ending *ending, const struct plan *plan, const struct death *death,
               const char *count)
{
    char name[SEGMENT_NAME_MAX];
    struct error_text error;
    plan_publish(plan, name);
    const char *const save[] = {"jolon-world", "save", "--world", name, image_path, NULL};
    const char *const create[] = {"jolon-world", "create",   "--world", name,
                                  "--from",      image_path, NULL};
    unlink(image_path);
    plant_torn_image();
    if (!run_program(ending, save, death, count, 0, 3))
        return;
    bool dead = ending->died;
    if (image_torn()) {
        snprintf(ending->refused, sizeof ending->refused, "a torn image is left");
        return;
    }
    assert_int_equal(segment_remove(name, false, &error), 0);
    if (run_program(ending, create, NULL, NULL, 0, 3))
        go_on(ending, plan, name);
    ending->died = dead;
}

void run_from(struct ending *ending, const struct plan *plan, const struct death *death,
              const char *count)
{
    char name[SEGMENT_NAME_MAX];
    named_world_name(name);
    const char *const argv[] = {"jolon-world", "create", "--world",  name,
                                "--adopt",     "--from", image_path, NULL};
    if (run_program(ending, argv, death, count, 0, 3))
        go_on(ending, plan, name);
}

/* Spoils the first column of a table. */
static void spoil(const char *world, enum region region)
{
    struct segment_paths paths;
    struct view view;
    struct error_text error;
    uint8_t byte;
    assert_int_equal(segment_attach(&view, world, ROLE_NONE, &error), 0);
    off_t at = (off_t)(view.layout.offset[region] + LAYOUT_HEAD_BYTES);
    segment_detach(&view);
    named_world_paths(&paths, world);
    int fd = open(paths.object, O_RDWR);
    assert_int_equal(pread(fd, &byte, 1, at), 1);
    byte ^= 1;
    assert_int_equal(pwrite(fd, &byte, 1, at), 1);
    close(fd);
}

/* The run's end and the table that it was made of are spoilt: it goes back a frame and ends again.
 */
void run_repaired(struct ending *ending, const struct plan *plan, const struct death *death,
                  const char *count)
{
    char name[SEGMENT_NAME_MAX];
    const char *const argv[] = {"jolon-world", "repair", "--world", name, NULL};
    plan_publish(plan, name);
    trial_play(ending, plan, name, NULL, NULL);
    assert_string_equal(ending->refused, "");
    spoil(name, ending->frame & 1 ? REGION_WORLD_B : REGION_WORLD_A);
    spoil(name, REGION_MOVED);
    if (run_program(ending, argv, death, count, 0, 3))
        go_on(ending, plan, name);
}
