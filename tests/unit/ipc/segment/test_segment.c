/* Segments: creation, names, attaching in roles, detaching, removal; one live holder for each
 * role. */
#include "ipc/segment/segment.h"

#include "ipc/segment/local_socket.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_check.h"
#include "ipc/segment/segment_locks.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"

#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define SCENARIO "vehicles = ( { kind = \"tank\"; name = \"T\"; count = 3; } );"

static char name[SEGMENT_NAME_MAX];
static struct segment_paths paths;
static struct error_text error;

static int make_world(void **state)
{
    (void)state;
    named_world_make(name, SCENARIO);
    named_world_paths(&paths, name);
    return 0;
}

static int remove_world(void **state)
{
    (void)state;
    named_world_remove(name);
    return 0;
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static void attach(struct view *view, enum role role)
{
    if (segment_attach(view, name, role, &error) != 0)
        fail_msg("%s", error.text);
}

static void begin(struct view *view, struct fixture *f)
{
    fixture_open(f, SCENARIO);
    struct segment_header header =
        segment_header_for(&f->scenario->settings->params, &f->built->counts);
    assert_int_equal(segment_begin(view, name, &header, &error), 0);
    segment_fill(view, f->built);
}

static void make_again(void)
{
    struct fixture f;
    fixture_open(&f, SCENARIO);
    named_world_publish(name, f.scenario, f.built);
    fixture_close(&f);
}

/* Returns true if the test's world is among the names. */
static bool has(char names[][SEGMENT_NAME_MAX], int count)
{
    int found = 0;
    for (int i = 0; i < count; i++)
        found += strcmp(names[i], name) == 0;
    assert_true(found <= 1);
    return found == 1;
}

static void attach_refused(const char *world, enum role role, const char *word)
{
    struct view view;
    assert_int_equal(segment_attach(&view, world, role, &error), -1);
    if (!strstr(error.text, word))
        fail_msg("\"%s\" is not in: %s", word, error.text);
    assert_null(view.base);
    assert_int_equal(view.lock_fd, -1);
}

/* --- creation ----------------------------------------------------------------------------------*/

static void test_world_is_not_there_before_it_is_published(void **state)
{
    char unborn[SEGMENT_NAME_MAX];
    struct fixture f;
    struct view made, seen;
    (void)state;
    named_world_name(unborn);
    int before = named_world_leftovers();
    fixture_open(&f, SCENARIO);
    struct segment_header header =
        segment_header_for(&f.scenario->settings->params, &f.built->counts);
    assert_int_equal(segment_begin(&made, unborn, &header, &error), 0);
    segment_fill(&made, f.built);
    assert_int_equal(named_world_leftovers(), before); /* a kill here leaves nothing */
    attach_refused(unborn, ROLE_NONE, "there is no world");
    assert_int_equal(segment_publish(&made, &error), 0);
    segment_detach(&made);
    assert_int_equal(segment_attach(&seen, unborn, ROLE_NONE, &error), 0);
    assert_int_equal(state_digest(&seen.world, &seen.w[0]), fixture_digest(&f));
    segment_detach(&seen);
    fixture_close(&f);
    named_world_remove(unborn);
}

static void test_object_and_lock_are_their_owners_alone(void **state)
{
    struct stat status;
    (void)state;
    assert_int_equal(stat(paths.object, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0600);
    assert_int_equal(status.st_uid, geteuid());
    assert_true(status.st_blocks * 512 >= status.st_size); /* reserved: no SIGBUS later */
    assert_int_equal(stat(paths.lock, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0600);
}

static void test_abandoned_world_leaves_nothing(void **state)
{
    char unborn[SEGMENT_NAME_MAX];
    const struct params params = {.capacity = 16,
                                  .event_slots = 64,
                                  .intents_per_frame = 8,
                                  .command_slots = 4,
                                  .crater_slots = 4};
    const struct counts counts = {.posts_side = 2, .side_m = 50000};
    struct segment_header header = segment_header_for(&params, &counts);
    struct view view;
    (void)state;
    int before = named_world_leftovers();
    named_world_name(unborn);
    assert_int_equal(segment_begin(&view, unborn, &header, &error), 0);
    segment_abandon(&view);
    assert_null(view.base);
    segment_abandon(&view); /* a second call does nothing */
    assert_int_equal(named_world_leftovers(), before);
}

static void test_second_world_of_the_name_is_refused(void **state)
{
    struct fixture f;
    struct view second, first;
    (void)state;
    fixture_open(&f, "world = { seed = 99; capacity = 16; };");
    struct segment_header header =
        segment_header_for(&f.scenario->settings->params, &f.built->counts);
    assert_int_equal(segment_begin(&second, name, &header, &error), 0);
    segment_fill(&second, f.built);
    assert_int_equal(segment_publish(&second, &error), -1);
    assert_non_null(strstr(error.text, "exists already"));
    assert_non_null(strstr(error.text, name));
    segment_abandon(&second);
    attach(&first, ROLE_NONE); /* the first is unchanged */
    assert_int_equal(first.world.params->seed, 1);
    assert_int_equal(first.w[0].head->used, 3);
    assert_int_equal(segment_verify(&first, &error), 0);
    segment_detach(&first);
    fixture_close(&f);
}

static void test_names_that_a_world_may_have(void **state)
{
    static const char *const bad[] = {"",
                                      ".",
                                      "..",
                                      "a.b",
                                      "a/b",
                                      "/",
                                      "a b",
                                      "a\n",
                                      "ä",
                                      "a:b",
                                      "abcdefghijklmnopqrstuvwxyz012345"};
    static const char *const good[] = {"a", "A-b_9", "abcdefghijklmnopqrstuvwxyz01234", "-", "_"};
    const struct segment_header header = {0};
    struct view view;
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        assert_true(segment_name_ok(good[i]));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(segment_name_ok(bad[i]));
        attach_refused(bad[i], ROLE_NONE, "is no name for a world");
        assert_int_equal(segment_begin(&view, bad[i], &header, &error), -1);
        assert_non_null(strstr(error.text, "is no name for a world"));
        assert_int_equal(segment_remove(bad[i], true, &error), -1);
    }
}

static void test_counts_out_of_range_make_no_world(void **state)
{
    const struct segment_header header = {.capacity = 0};
    char unborn[SEGMENT_NAME_MAX];
    struct view view;
    (void)state;
    int before = named_world_leftovers();
    named_world_name(unborn);
    assert_int_equal(segment_begin(&view, unborn, &header, &error), -1);
    assert_non_null(strstr(error.text, "out of range"));
    assert_int_equal(segment_private(&view, &header, &error), -1);
    assert_int_equal(named_world_leftovers(), before);
}

/* --- names -------------------------------------------------------------------------------------*/

static void test_name_leads_to_an_object_of_random_name(void **state)
{
    struct segment_paths again;
    char prefix[128];
    (void)state;
    snprintf(prefix, sizeof prefix, "/dev/shm/jolon.%u.%s.", (unsigned)getuid(), name);
    assert_memory_equal(paths.object, prefix, strlen(prefix));
    assert_int_equal(strspn(paths.object + strlen(prefix), "0123456789abcdef"), 32);
    assert_int_equal(strlen(paths.object + strlen(prefix)), 32);
    named_world_remove(name);
    make_again();
    named_world_paths(&again, name);
    assert_string_not_equal(again.object, paths.object);
    assert_string_equal(again.name, paths.name);
}

/* The remains of a creator that was killed between making the name and the object. */
static void test_name_that_leads_nowhere_is_taken(void **state)
{
    struct segment_paths left;
    static char names[512][SEGMENT_NAME_MAX];
    (void)state;
    assert_int_equal(unlink(paths.object), 0);
    attach_refused(name, ROLE_NONE, "there is no world");
    attach_refused(name, ROLE_MOVER, "there is no world");
    assert_int_equal(segment_paths(&left, name, &error), 0);
    assert_string_equal(left.object, "");
    assert_false(has(names, segment_list(names, 512, false, &error)));
    assert_true(has(names, segment_list(names, 512, true, &error)));
    make_again();
    assert_true(has(names, segment_list(names, 512, false, &error)));
}

static void test_name_whose_object_is_gone_while_a_role_runs_is_not_taken(void **state)
{
    struct view holder, second;
    struct fixture f;
    (void)state;
    attach(&holder, ROLE_COLLIDER);
    assert_int_equal(unlink(paths.object), 0);
    begin(&second, &f);
    assert_int_equal(segment_publish(&second, &error), -1);
    assert_non_null(strstr(error.text, "its collider still runs"));
    segment_abandon(&second);
    fixture_close(&f);
    segment_detach(&holder);
    make_again();
}

static void test_sweep_removes_remains_and_no_world(void **state)
{
    struct view view;
    (void)state;
    assert_int_equal(segment_sweep(name, &error), 0);
    attach(&view, ROLE_NONE);
    segment_detach(&view);
    assert_int_equal(unlink(paths.object), 0);
    assert_int_equal(segment_sweep(name, &error), 0);
    assert_int_equal(named_world_leftovers(), 0);
}

/* Other files under a world's name are not touched. */
static void test_other_files_under_a_name_are_refused(void **state)
{
    static const char *const targets[] = {"/dev/shm/jolon.", "/etc/passwd", "elsewhere"};
    char target[SEGMENT_PATH_MAX + 8];
    (void)state;
    for (size_t i = 0; i < sizeof targets / sizeof targets[0] + 2; i++) {
        assert_int_equal(unlink(paths.name), 0);
        if (i < 3)
            snprintf(target, sizeof target, "%s", targets[i]);
        else /* too long; of another name */
            snprintf(target, sizeof target, i == 3 ? "%s0" : "%s", paths.object);
        if (i == 4)
            target[strlen(target) - 34] = 'X';
        assert_int_equal(symlink(target, paths.name), 0);
        attach_refused(name, ROLE_NONE, "is no link to a world's object");
        assert_int_equal(segment_remove(name, true, &error), -1);
        assert_non_null(strstr(error.text, paths.name));
    }
    assert_int_equal(unlink(paths.name), 0);
    assert_int_equal(mkdir(paths.name, 0700), 0);
    attach_refused(name, ROLE_NONE, "is no link to a world's object");
    assert_int_equal(rmdir(paths.name), 0);
    assert_int_equal(symlink(paths.object, paths.name), 0);
}

static int create_once(void *context)
{
    struct view view;
    struct fixture *f = context;
    struct segment_header header =
        segment_header_for(&f->scenario->settings->params, &f->built->counts);
    if (segment_begin(&view, name, &header, &error) != 0)
        return 2;
    segment_fill(&view, f->built);
    int result = segment_publish(&view, &error);
    if (result == 0)
        segment_detach(&view);
    else if (!strstr(error.text, "exists already"))
        result = 3;
    return result == -1 ? 1 : result;
}

/* One of several creators of a name succeeds, whatever has the name before. */
static void test_creators_of_one_name_race(void **state)
{
    pid_t creators[8];
    struct fixture f;
    (void)state;
    fixture_open(&f, SCENARIO);
    for (int round = 0; round < 6; round++) {
        int made = 0;
        if (round % 2 == 0) /* the name leads nowhere; else there is nothing */
            assert_int_equal(unlink(paths.object), 0);
        else
            named_world_remove(name);
        for (int i = 0; i < 8; i++)
            creators[i] = child_start(create_once, &f);
        for (int i = 0; i < 8; i++) {
            int status = child_wait(creators[i]);
            assert_true(WIFEXITED(status) && WEXITSTATUS(status) <= 1);
            made += WEXITSTATUS(status) == 0;
        }
        assert_int_equal(made, 1);
        named_world_paths(&paths, name);
        assert_int_equal(named_world_leftovers(), 3);
    }
    fixture_close(&f);
}

static void test_files_that_no_name_leads_to_are_listed(void **state)
{
    static char files[1024][SEGMENT_LOST_MAX];
    char old[SEGMENT_PATH_MAX];
    int found = 0;
    (void)state;
    snprintf(old, sizeof old, "/dev/shm/jolon.%u.%s", (unsigned)getuid(), name);
    close(open(old, O_CREAT | O_RDWR, 0600)); /* as an earlier version named its objects */
    int count = segment_list_lost(files, 1024);
    for (int i = 0; i < count; i++) {
        assert_string_not_equal(files[i], strrchr(paths.object, '/') + 1);
        found += strcmp(files[i], strrchr(old, '/') + 1) == 0;
    }
    assert_int_equal(found, 1);
    assert_int_equal(unlink(old), 0);
}

/* --- roles -------------------------------------------------------------------------------------*/

static void test_reader_sees_the_world_and_takes_no_slot(void **state)
{
    struct view view;
    (void)state;
    attach(&view, ROLE_NONE);
    assert_int_equal(view.lock_fd, -1);
    assert_string_equal(view.name, name);
    assert_int_equal(view.world.params->capacity, 64);
    assert_int_equal(view.w[0].entities.capacity, 64);
    assert_string_equal(world_entity_name(&view.world, 2), "T-2");
    assert_int_equal(atomic_load(&view.commit->commit), 0);
    for (int role = 0; role < ROLE_COUNT; role++)
        assert_int_equal(atomic_load(&view.slot[role]->state), ROLE_ABSENT);
    assert_int_equal(segment_verify(&view, &error), 0);
    segment_detach(&view);
    assert_null(view.base);
    segment_detach(&view); /* a second call does nothing */
}

static void test_slot_has_the_holder_and_its_state(void **state)
{
    struct view holder, reader;
    (void)state;
    attach(&reader, ROLE_NONE);
    const struct role_slot *slot = reader.slot[ROLE_MOVER];
    attach(&holder, ROLE_MOVER);
    assert_int_equal(slot->state, ROLE_STARTING);
    assert_int_equal(slot->pid, getpid());
    assert_int_equal(slot->starts, 1);
    assert_true(slot->started_ns != 0 && slot->beat_ns >= slot->started_ns);
    segment_ready(&holder);
    assert_int_equal(slot->state, ROLE_READY);
    assert_int_equal(segment_holder(name, ROLE_MOVER), getpid());
    assert_int_equal(segment_holder(name, ROLE_COLLIDER), 0);
    segment_detach(&holder);
    assert_int_equal(slot->state, ROLE_ABSENT);
    assert_int_equal(segment_holder(name, ROLE_MOVER), 0);
    attach(&holder, ROLE_MOVER);
    assert_int_equal(slot->starts, 2);
    segment_detach(&holder);
    segment_detach(&reader);
}

static void test_second_holder_of_a_role_is_refused_by_name_and_pid(void **state)
{
    struct view first;
    char pid[32];
    (void)state;
    snprintf(pid, sizeof pid, "(pid %d)", (int)getpid());
    for (int role = 0; role < ROLE_COUNT; role++) {
        attach(&first, (enum role)role);
        attach_refused(name, (enum role)role, role_name((enum role)role));
        assert_non_null(strstr(error.text, pid));
        assert_int_equal(atomic_load(&first.slot[role]->starts),
                         1); /* the refused process wrote nothing */
        segment_detach(&first);
    }
}

static void test_all_roles_side_by_side(void **state)
{
    struct view views[ROLE_COUNT], readers[3];
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++)
        attach(&views[role], (enum role)role);
    for (int i = 0; i < 3; i++)
        attach(&readers[i], ROLE_NONE);
    for (int role = 0; role < ROLE_COUNT; role++)
        assert_int_equal(segment_holder(name, (enum role)role), getpid());
    for (int i = 0; i < 3; i++)
        segment_detach(&readers[i]);
    for (int role = 0; role < ROLE_COUNT; role++)
        segment_detach(&views[role]);
}

static int hold_for_long(void *context)
{
    struct view view;
    const enum role *role = context;
    if (segment_attach(&view, name, *role, &error) != 0)
        return 1;
    segment_ready(&view);
    sleep(60);
    return 0;
}

static void wait_until_held(enum role role)
{
    struct view reader;
    attach(&reader, ROLE_NONE);
    while (atomic_load(&reader.slot[role]->state) != ROLE_READY)
        usleep(200);
    segment_detach(&reader);
}

static void test_kill_of_the_holder_frees_the_role(void **state)
{
    enum role role = ROLE_COLLIDER;
    struct view view;
    (void)state;
    for (int i = 0; i < 5; i++) {
        pid_t holder = child_start(hold_for_long, &role);
        wait_until_held(role);
        assert_int_equal(segment_holder(name, role), holder);
        attach_refused(name, role, "is running already");
        assert_false(error.damaged);
        assert_int_equal(segment_holder_alive(name, role, 0), holder);
        child_kill(holder);
        assert_int_equal(segment_holder_alive(name, role, UINT64_MAX), 0);
        assert_int_equal(segment_holder(name, role), 0); /* although its slot still says ready */
        attach(&view, role);
        assert_int_equal(atomic_load(&view.slot[role]->pid), getpid());
        segment_detach(&view);
    }
}

/* Between taking a lock and storing the pid the slot has no pid, or the previous holder's. */
static void test_waits_follow_the_lock_and_not_the_pid(void **state)
{
    enum role role = ROLE_MOVER;
    struct view view;
    char text[32];
    (void)state;
    pid_t dead = child_start(hold_for_long, &role);
    child_kill(dead);
    attach(&view, ROLE_COLLIDER);
    assert_int_equal(segment_wait_free(name, ROLE_MOVER, 0, &error), 0);
    assert_int_equal(segment_wait_free(name, ROLE_RENDERER, 0, &error), -1);
    snprintf(text, sizeof text, "by pid %d,", getpid());
    assert_non_null(strstr(error.text, "the collider of world"));
    assert_non_null(strstr(error.text, text));
    const int said[] = {0, dead};
    for (int i = 0; i < 2; i++) {
        atomic_store(&view.slot[ROLE_COLLIDER]->pid, (uint32_t)said[i]);
        assert_int_equal(segment_holder_alive(name, ROLE_COLLIDER, 0), 0);
        assert_int_equal(segment_wait_free(name, ROLE_COLLIDER, 0, &error), -1);
        assert_non_null(strstr(error.text, "by a process,"));
    }
    segment_detach(&view);
    assert_int_equal(segment_wait_free(name, ROLE_COLLIDER, UINT64_MAX, &error), 0);
}

/* --- removal -----------------------------------------------------------------------------------*/

static void test_removal_is_refused_while_a_role_is_held(void **state)
{
    struct view view;
    (void)state;
    attach(&view, ROLE_REPORTER);
    assert_int_equal(segment_remove(name, false, &error), -1);
    assert_non_null(strstr(error.text, "reporter"));
    assert_true(exists(paths.object) && exists(paths.lock));
    segment_detach(&view);
    attach(&view, ROLE_NONE); /* a reader prevents no removal */
    assert_int_equal(segment_remove(name, false, &error), 0);
    assert_false(exists(paths.object) || exists(paths.lock));
    assert_int_equal(view.w[0].head->used, 3); /* and it can still read its mapping */
    segment_detach(&view);
}

static void test_removal_by_force(void **state)
{
    struct view view;
    (void)state;
    attach(&view, ROLE_MOVER);
    assert_int_equal(segment_remove(name, true, &error), 0);
    assert_false(exists(paths.object) || exists(paths.lock));
    segment_detach(&view);
}

static void test_lock_file_stays_while_a_supervisor_holds_it(void **state)
{
    (void)state;
    int fd = open(paths.lock, O_RDWR | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_int_equal(flock(fd, LOCK_EX), 0);
    assert_int_equal(segment_remove(name, false, &error), 0);
    assert_false(exists(paths.object));
    assert_true(exists(paths.lock));
    close(fd);
    assert_int_equal(segment_remove(name, false, &error),
                     0); /* removing a missing world is no error */
    assert_false(exists(paths.lock));
}

static void test_removed_name_can_be_made_again(void **state)
{
    struct view old, new;
    struct fixture f;
    (void)state;
    attach(&old, ROLE_MOVER);
    assert_int_equal(segment_remove(name, true, &error), 0);
    fixture_open(&f, SCENARIO);
    struct segment_header header =
        segment_header_for(&f.scenario->settings->params, &f.built->counts);
    assert_int_equal(segment_begin(&new, name, &header, &error), 0);
    segment_fill(&new, f.built);
    assert_int_equal(segment_publish(&new, &error), 0);
    segment_detach(&new);
    fixture_close(&f);
    attach(&new, ROLE_MOVER); /* the old world's mover has another lock and another memory */
    atomic_store(&old.moved_word->moved, 1);
    assert_int_equal(atomic_load(&new.moved_word->moved), 0);
    segment_detach(&old);
    assert_int_equal(segment_holder(name, ROLE_MOVER), getpid());
    segment_detach(&new);
}

static void test_removal_removes_the_sockets(void **state)
{
    (void)state;
    close(local_socket_listen(name, "pictures", SOCK_STREAM, 1, &error));
    close(local_socket_listen(name, "commands", SOCK_SEQPACKET, 1, &error));
    assert_int_equal(named_world_leftovers(), 5);
    assert_int_equal(segment_remove(name, false, &error), 0);
    assert_int_equal(named_world_leftovers(), 0);
}

static void test_supervisor_removes_its_own_lock_file(void **state)
{
    (void)state;
    int fd = open(paths.lock, O_RDWR | O_CLOEXEC);
    assert_int_equal(flock(fd, LOCK_EX), 0);
    assert_int_equal(segment_remove_own(name, &error), 0);
    assert_int_equal(named_world_leftovers(), 0);
    close(fd);
}

static void test_list_has_worlds_and_nothing_else(void **state)
{
    static char names[512][SEGMENT_NAME_MAX];
    (void)state;
    int count = segment_list(names, 512, false, &error);
    for (int i = 0; i < count; i++)
        assert_true(segment_name_ok(names[i]));
    assert_true(has(names, count));
    assert_int_equal(segment_list(names, 0, false, &error), 0); /* writes nothing */
}

/* --- private worlds ----------------------------------------------------------------------------*/

static int write_commit(void *context)
{
    struct view *view = context;
    atomic_store(&view->commit->commit, 77);
    return 0;
}

static void test_private_world_is_shared_with_children_and_has_no_name(void **state)
{
    struct fixture f;
    (void)state;
    int before = named_world_leftovers();
    fixture_open(&f, "");
    assert_int_equal(named_world_leftovers(), before);
    assert_int_equal(child_run(write_commit, &f.view), 0);
    assert_int_equal(atomic_load(&f.view.commit->commit), 77);
    fixture_close(&f);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_world, remove_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_world_is_not_there_before_it_is_published),
        TEST(test_object_and_lock_are_their_owners_alone),
        cmocka_unit_test(test_abandoned_world_leaves_nothing),
        TEST(test_second_world_of_the_name_is_refused),
        cmocka_unit_test(test_names_that_a_world_may_have),
        cmocka_unit_test(test_counts_out_of_range_make_no_world),
        TEST(test_name_leads_to_an_object_of_random_name),
        TEST(test_name_that_leads_nowhere_is_taken),
        TEST(test_name_whose_object_is_gone_while_a_role_runs_is_not_taken),
        TEST(test_sweep_removes_remains_and_no_world),
        TEST(test_other_files_under_a_name_are_refused),
        TEST(test_creators_of_one_name_race),
        TEST(test_files_that_no_name_leads_to_are_listed),
        TEST(test_reader_sees_the_world_and_takes_no_slot),
        TEST(test_slot_has_the_holder_and_its_state),
        TEST(test_second_holder_of_a_role_is_refused_by_name_and_pid),
        TEST(test_all_roles_side_by_side),
        TEST(test_kill_of_the_holder_frees_the_role),
        TEST(test_waits_follow_the_lock_and_not_the_pid),
        TEST(test_removal_is_refused_while_a_role_is_held),
        TEST(test_removal_by_force),
        TEST(test_lock_file_stays_while_a_supervisor_holds_it),
        TEST(test_removed_name_can_be_made_again),
        TEST(test_removal_removes_the_sockets),
        TEST(test_supervisor_removes_its_own_lock_file),
        TEST(test_list_has_worlds_and_nothing_else),
        cmocka_unit_test(test_private_world_is_shared_with_children_and_has_no_name),
    };
    return cmocka_run_group_tests(tests, NULL, named_world_check_left);
}
