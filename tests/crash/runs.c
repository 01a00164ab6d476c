/* Kinds of runs: of the roles themselves, and of programs that act on a world before or after its
 * run. */
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

void run_roles(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
               const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    trial_run(outcome, plan, name, death, count);
}

/* Runs a program, and runs it again if it dies as planned. It must end with the exit code and leave
 * this many files of worlds: an object, its name and its lock are three. Returns false on a fault.
 */
static bool run_program(struct run_outcome *outcome, const char *const argv[],
                        const struct death *death, const char *count, int code, int files)
{
    *outcome = (struct run_outcome){0};
    int status = child_wait(trial_start(argv, death, count));
    if (death && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
        outcome->died = true;
        status = child_wait(trial_start(argv, NULL, NULL));
    }
    int left = named_world_leftovers();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != code)
        snprintf(outcome->refused, sizeof outcome->refused, "jolon-world %s ends with status %d",
                 argv[1], status);
    else if (left != files)
        snprintf(outcome->refused, sizeof outcome->refused,
                 "after jolon-world %s there are %d files instead of %d", argv[1], left, files);
    return outcome->refused[0] == '\0';
}

static void finish_run(struct run_outcome *outcome, const struct plan *plan, const char *world)
{
    bool dead = outcome->died;
    trial_run(outcome, plan, world, NULL, NULL);
    outcome->died = dead;
}

static int nothing(void *context)
{
    (void)context;
    return 0;
}

/* Makes the file that a killed writer of the image leaves. Its process no longer exists. */
static void make_torn_image(void)
{
    char path[sizeof image_path + 32];
    pid_t pid = child_start(nothing, NULL);
    child_wait(pid);
    snprintf(path, sizeof path, "%s.new-%d", image_path, (int)pid);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    assert_true(fd >= 0);
    close(fd);
}

/* Makes the name that a creator leaves when it is killed before it makes the object. */
static void make_dangling_name(const char *world)
{
    struct segment_paths paths;
    struct error_text error;
    char object[SEGMENT_PATH_MAX];
    assert_int_equal(segment_paths(&paths, world, &error), 0);
    snprintf(object, sizeof object, "/dev/shm/jolon.%u.%s.%032x", (unsigned)getuid(), world, 1);
    assert_int_equal(symlink(object, paths.name), 0);
}

void run_created(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    named_world_name(name);
    const char *const argv[] = {"jolon-world", "create",      "--world", name,
                                "--adopt",     scenario_path, NULL};
    make_dangling_name(name);
    if (run_program(outcome, argv, death, count, 0, 3))
        finish_run(outcome, plan, name);
}

void run_refused(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    const char *const argv[] = {"jolon-world", "create", "--world", name, scenario_path, NULL};
    if (run_program(outcome, argv, death, count, 1, 3))
        finish_run(outcome, plan, name);
}

void run_removed(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
                 const char *count)
{
    char name[SEGMENT_NAME_MAX];
    plan_publish(plan, name);
    struct error_text error;
    const char *const argv[] = {"jolon-world", "remove", "--world", name, NULL};
    int socket = local_socket_listen(name, "pictures", SOCK_STREAM, 1, &error);
    assert_true(socket >= 0);
    close(socket);
    run_program(outcome, argv, death, count, 0, 0);
}

/* Returns true if a writer of the image that died has left its unfinished file. */
static bool image_torn(void)
{
    char pattern[sizeof image_path + 16];
    glob_t found = {0};
    snprintf(pattern, sizeof pattern, "%s.new-*", image_path);
    bool torn = glob(pattern, 0, NULL, &found) != GLOB_NOMATCH;
    globfree(&found);
    return torn;
}

void run_saved(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
               const char *count)
{
    char name[SEGMENT_NAME_MAX];
    struct error_text error;
    plan_publish(plan, name);
    const char *const save[] = {"jolon-world", "save", "--world", name, image_path, NULL};
    const char *const create[] = {"jolon-world", "create",   "--world", name,
                                  "--from",      image_path, NULL};
    unlink(image_path);
    make_torn_image();
    if (!run_program(outcome, save, death, count, 0, 3))
        return;
    bool dead = outcome->died;
    if (image_torn()) {
        snprintf(outcome->refused, sizeof outcome->refused, "a torn image is left");
        return;
    }
    assert_int_equal(segment_remove(name, false, &error), 0);
    if (run_program(outcome, create, NULL, NULL, 0, 3))
        finish_run(outcome, plan, name);
    outcome->died = dead;
}

void run_from(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
              const char *count)
{
    char name[SEGMENT_NAME_MAX];
    named_world_name(name);
    const char *const argv[] = {"jolon-world", "create", "--world",  name,
                                "--adopt",     "--from", image_path, NULL};
    if (run_program(outcome, argv, death, count, 0, 3))
        finish_run(outcome, plan, name);
}

/* Damages the first column of a table. */
static void damage_region(const char *world, enum region region)
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

/* Damages the last frame and the moved table that it was made from. Repair must go back one frame,
 * and the run must end again. */
void run_repaired(struct run_outcome *outcome, const struct plan *plan, const struct death *death,
                  const char *count)
{
    char name[SEGMENT_NAME_MAX];
    const char *const argv[] = {"jolon-world", "repair", "--world", name, NULL};
    plan_publish(plan, name);
    trial_run_to_end(outcome, plan, name, NULL, NULL);
    assert_string_equal(outcome->refused, "");
    damage_region(name, outcome->frame & 1 ? REGION_WORLD_B : REGION_WORLD_A);
    damage_region(name, REGION_MOVED);
    if (run_program(outcome, argv, death, count, 0, 3))
        finish_run(outcome, plan, name);
}
