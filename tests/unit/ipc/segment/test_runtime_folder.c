/* Finds the runtime folder, and refuses or passes over others. Each search runs in a child, because
 * a process keeps the folder that it found first. */
#include "ipc/segment/runtime_folder.h"

#include "ipc/segment/segment.h"
#include "tests/support/child.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

/* Where everything happens, and what a child found. */
static char here[64];
static struct answer {
    int result;
    char path[RUNTIME_FOLDER_MAX];
    struct error_text error;
    bool kept; /* a second call and the descriptor agree */
} * answer;

static int make_here(void **state)
{
    (void)state;
    snprintf(here, sizeof here, "/tmp/jolon-runtime-XXXXXX");
    answer = mmap(NULL, sizeof *answer, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return answer != MAP_FAILED && mkdtemp(here) ? 0 : -1;
}

static int drop_here(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", here);
    munmap(answer, sizeof *answer);
    return system(command);
}

/* here/NAME, made with a mode (0: not made). */
static char *place(const char *name, mode_t mode)
{
    static char paths[4][256];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", here, name);
    if (mode != 0) {
        mkdir(path, mode);
        assert_int_equal(chmod(path, mode), 0);
    }
    return path;
}

struct names {
    const char *own, *service, *session, *home;
    bool other_user; /* the search runs as user 65534; the test must be root's */
};

static void name(const char *variable, const char *value)
{
    if (value)
        setenv(variable, value, 1);
    else
        unsetenv(variable);
}

static int search(void *context)
{
    const struct names *names = context;
    char again[RUNTIME_FOLDER_MAX];
    struct stat by_path, by_fd;
    name("JOLON_RUNTIME_DIR", names->own);
    name("RUNTIME_DIRECTORY", names->service);
    name("XDG_RUNTIME_DIR", names->session);
    name("HOME", names->home);
    if (names->other_user && setuid(65534) != 0)
        return 1;
    answer->result = runtime_folder(answer->path, &answer->error);
    if (answer->result != 0)
        return 0;
    int fd = runtime_folder_open(&answer->error);
    answer->kept = fd >= 0 && fstat(fd, &by_fd) == 0 && stat(answer->path, &by_path) == 0 &&
                   by_fd.st_ino == by_path.st_ino && (by_path.st_mode & 07777) == 0700 &&
                   (fcntl(fd, F_GETFL) & O_PATH) != 0 &&
                   runtime_folder(again, &answer->error) == 0 && strcmp(again, answer->path) == 0;
    return 0;
}

static void finds(struct names names, const char *path)
{
    assert_int_equal(child_run(search, &names), 0);
    if (answer->result != 0)
        fail_msg("%s", answer->error.text);
    assert_string_equal(answer->path, path);
    assert_true(answer->kept);
}

static void refuses(struct names names, const char *what, const char *right)
{
    assert_int_equal(child_run(search, &names), 0);
    assert_int_equal(answer->result, -1);
    if (!strstr(answer->error.text, what) || !strstr(answer->error.text, right))
        fail_msg("\"%s\" names not \"%s\" and \"%s\"", answer->error.text, what, right);
}

static void test_own_variable_comes_first_and_is_made(void **state)
{
    char *own = place("own", 0);
    (void)state;
    finds((struct names){.own = own, .session = place("session", 0700)}, own);
    finds((struct names){.own = own}, own); /* it exists now */
}

static void test_slashes_at_the_end_change_nothing(void **state)
{
    char *own = place("slashes", 0);
    (void)state;
    char with[300];
    snprintf(with, sizeof with, "%s//", own);
    finds((struct names){.own = with}, own);
}

static void test_folder_of_a_service_is_taken_as_it_is(void **state)
{
    char both[600];
    (void)state;
    snprintf(both, sizeof both, "%s:/run/another", place("service", 0700));
    finds((struct names){.service = both}, place("service", 0));
    place("service", 0750);
    refuses((struct names){.service = both}, "0750", "chmod 700");
}

/* For users other than root, whose folder is /run/jolon. */
static void test_session_and_home(void **state)
{
    (void)state;
    if (geteuid() == 0) {
        assert_int_equal(chmod(here, 0755), 0);
        assert_int_equal(chown(place("session-2", 0700), 65534, 65534), 0);
        assert_int_equal(chown(place("home", 0755), 65534, 65534), 0);
    }
    place("home", 0755);
    struct names names = {.session = place("session-2", 0700), .other_user = geteuid() == 0};
    finds(names, place("session-2/jolon", 0));
    /* A session's folder in which others may write, or of another user, is passed over. */
    place("session-2", 0777);
    if (geteuid() == 0) { /* else /run/user/UID may be there */
        names.home = place("home", 0);
        finds(names, place("home/.jolon/run", 0));
        names.session = place("session-of-root", 0700);
        finds(names, place("home/.jolon/run", 0));
    }
}

static void test_root_keeps_to_its_own(void **state)
{
    (void)state;
    if (geteuid() != 0)
        return;
    assert_int_equal(chown(place("session-3", 0700), 65534, 65534), 0);
    finds((struct names){.session = place("session-3", 0)}, "/run/jolon");
    finds((struct names){.session = place("session-4", 0700)}, "/run/jolon");
}

static void test_nowhere_names_all_places(void **state)
{
    (void)state;
    if (geteuid() != 0)
        return;
    refuses((struct names){.other_user = true, .home = "/nowhere"}, "/run/user/65534",
            "JOLON_RUNTIME_DIR");
    refuses((struct names){.other_user = true, .home = "/nowhere"}, "/nowhere",
            "JOLON_RUNTIME_DIR");
}

static void test_wrong_folders_are_refused(void **state)
{
    char *link = place("link", 0), *file = place("file", 0), with[300];
    char *folder = place("folder", 0700);
    (void)state;
    assert_int_equal(symlink(folder, link), 0);
    refuses((struct names){.own = link}, link, "symbolic link");
    snprintf(with, sizeof with, "%s/", link);
    refuses((struct names){.own = with}, link, "symbolic link");
    close(open(file, O_CREAT | O_WRONLY, 0600));
    refuses((struct names){.own = file}, file, "no folder");
    refuses((struct names){.own = place("open", 0755)}, "0755", "0700");
    refuses((struct names){.own = place("closed", 0500)}, "0500", "0700");
    refuses((struct names){.own = "run/jolon"}, "run/jolon", "absolute");
    refuses((struct names){.own = place("missing/folder", 0)}, "missing/folder",
            "make it yourself");
    if (geteuid() == 0) {
        assert_int_equal(chown(place("foreign", 0700), 65534, 65534), 0);
        refuses((struct names){.own = place("foreign", 0)}, "user 65534", "of your own");
    }
}

static void test_long_paths_are_refused_with_their_length(void **state)
{
    char path[400];
    (void)state;
    memset(path, 'x', sizeof path);
    memcpy(path, here, strlen(here));
    path[strlen(here)] = '/';
    path[RUNTIME_FOLDER_MAX] = '\0'; /* one too many */
    refuses((struct names){.own = path}, "192 bytes", "at most 191");
    path[RUNTIME_FOLDER_MAX - 1] = '\0';
    finds((struct names){.own = path}, path);
}

static int changes_the_folder(void *context)
{
    char path[RUNTIME_FOLDER_MAX];
    struct error_text error;
    setenv("JOLON_RUNTIME_DIR", context, 1);
    if (runtime_folder(path, &error) != 0)
        return 1;
    setenv("JOLON_RUNTIME_DIR", "/nowhere", 1); /* it keeps the folder that it found */
    if (runtime_folder(path, &error) != 0 || strcmp(path, context) != 0)
        return 2;
    if (chmod(path, 0755) != 0 || runtime_folder(path, &error) == 0 ||
        runtime_folder_open(&error) >= 0)
        return 3;
    return strstr(error.text, "0755") ? 0 : 4;
}

static void test_found_folder_is_kept_and_checked_again(void **state)
{
    (void)state;
    assert_int_equal(child_run(changes_the_folder, place("kept", 0700)), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_variable_comes_first_and_is_made),
        cmocka_unit_test(test_slashes_at_the_end_change_nothing),
        cmocka_unit_test(test_folder_of_a_service_is_taken_as_it_is),
        cmocka_unit_test(test_session_and_home),
        cmocka_unit_test(test_root_keeps_to_its_own),
        cmocka_unit_test(test_nowhere_names_all_places),
        cmocka_unit_test(test_wrong_folders_are_refused),
        cmocka_unit_test(test_long_paths_are_refused_with_their_length),
        cmocka_unit_test(test_found_folder_is_kept_and_checked_again),
    };
    return cmocka_run_group_tests(tests, make_here, drop_here);
}
