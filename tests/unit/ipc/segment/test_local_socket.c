/* Sockets in the runtime folder: their file, the file of a dead listener, and the peer's
 * process. */
#include "ipc/segment/local_socket.h"

#include "ipc/segment/segment.h"
#include "tests/support/child.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cmocka.h>

/* Longer than a socket's address may be. */
static char folder[180];
static struct error_text error;

static int make_folder(void **state)
{
    (void)state;
    char parent[] = "/tmp/jolon-sockets-XXXXXX";
    if (!mkdtemp(parent))
        return -1;
    memset(folder, 'x', sizeof folder - 1);
    memcpy(folder, parent, strlen(parent));
    folder[strlen(parent)] = '/';
    return setenv("JOLON_RUNTIME_DIR", folder, 1);
}

static int drop_folder(void **state)
{
    (void)state;
    char *name = strrchr(folder, '/');
    rmdir(folder);
    *name = '\0';
    return rmdir(folder);
}

static void remove_socket(const char *name)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(unlink(path), 0);
}

static void test_messages_pass_and_the_file_is_private(void **state)
{
    struct stat status;
    char path[300], text[8];
    (void)state;
    int listener = local_socket_listen("field", "commands", SOCK_SEQPACKET, 4, &error);
    assert_true(listener >= 0);
    snprintf(path, sizeof path, "%s/field.commands", folder);
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISSOCK(status.st_mode) && (status.st_mode & 0077) == 0);
    int client = local_socket_connect("field", "commands", SOCK_SEQPACKET, &error);
    int served = accept(listener, NULL, NULL);
    assert_true(client >= 0 && served >= 0);
    assert_true(local_socket_peer_is(served, geteuid()));
    assert_false(local_socket_peer_is(served, geteuid() + 1));
    assert_int_equal(send(client, "one", 3, 0), 3);
    assert_int_equal(send(client, "two", 3, 0), 3);
    assert_int_equal(recv(served, text, sizeof text, 0), 3); /* messages are not joined */
    close(served);
    close(client);
    close(listener);
    remove_socket("field.commands");
}

static int listens_and_dies(void *context)
{
    return local_socket_listen("field", "pictures", SOCK_STREAM, 4, context) >= 0 ? 0 : 1;
}

static void test_socket_of_a_dead_listener_is_replaced(void **state)
{
    (void)state;
    assert_int_equal(local_socket_connect("field", "pictures", SOCK_STREAM, &error), -1);
    assert_int_equal(errno, ENOENT);
    assert_int_equal(child_run(listens_and_dies, &error), 0);
    assert_int_equal(local_socket_connect("field", "pictures", SOCK_STREAM, &error), -1);
    assert_int_equal(errno, ECONNREFUSED);
    assert_non_null(strstr(error.text, "field.pictures"));
    int listener = local_socket_listen("field", "pictures", SOCK_STREAM, 4, &error);
    int client = local_socket_connect("field", "pictures", SOCK_STREAM, &error);
    assert_true(listener >= 0 && client >= 0);
    close(client);
    close(listener);
    remove_socket("field.pictures");
}

static void test_what_cannot_be_removed_is_refused(void **state)
{
    char path[300];
    (void)state;
    snprintf(path, sizeof path, "%s/field.pictures", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(local_socket_listen("field", "pictures", SOCK_STREAM, 4, &error), -1);
    assert_non_null(strstr(error.text, "field.pictures: cannot remove"));
    assert_int_equal(rmdir(path), 0);
}

/* A process that changed its user before it listened. The kernel keeps the user of that moment. */
static int listens_as_nobody(void *context)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX, .sun_path = "field.pictures"};
    int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    (void)context;
    if (listener < 0 || chdir(folder) != 0 ||
        bind(listener, (const struct sockaddr *)&address, sizeof address) != 0 ||
        setuid(65534) != 0 || listen(listener, 4) != 0)
        return 1;
    return accept(listener, NULL, NULL) >= 0 ? 0 : 2;
}

static void test_process_of_another_user_is_refused(void **state)
{
    (void)state;
    if (geteuid() != 0)
        return;
    pid_t child = child_start(listens_as_nobody, NULL);
    int client = -1, cause = ENOENT;
    for (int tries = 0; tries < 400 && client < 0 && cause != EACCES; tries++) {
        usleep(5000);
        client = local_socket_connect("field", "pictures", SOCK_STREAM, &error);
        cause = errno;
    }
    assert_int_equal(client, -1);
    assert_int_equal(cause, EACCES);
    assert_int_equal(child_wait(child), 0);
    remove_socket("field.pictures");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_messages_pass_and_the_file_is_private),
        cmocka_unit_test(test_socket_of_a_dead_listener_is_replaced),
        cmocka_unit_test(test_what_cannot_be_removed_is_refused),
        cmocka_unit_test(test_process_of_another_user_is_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
