/* Journals after a kill, damage, a foreign file or a full disk. */
#include "recorder/log/journal.h"

#include "tests/support/child.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmocka.h>

#define RECORDS 5
#define BEGINS  "{\"frame\":"

static char path[] = "/tmp/jolon-test-journal-XXXXXX";
static char whole[4096]; /* a journal of RECORDS records */
static size_t whole_length, ends[RECORDS + 1];

static cJSON *record(int number)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "frame", number);
    cJSON_AddStringToObject(object, "text", number % 2 ? "a \"b\"\n" : "");
    return object;
}

static void put_file(const char *bytes, size_t length)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, bytes, length), length);
    close(fd);
}

static size_t get_file(char *bytes, size_t room)
{
    int fd = open(path, O_RDONLY);
    ssize_t length = fd < 0 ? -1 : read(fd, bytes, room);
    if (fd >= 0)
        close(fd);
    return length < 0 ? 0 : (size_t)length;
}

/* Drops the recorder's warnings about the ends that it cuts off, of which there are thousands. */
static int quiet(void **state)
{
    (void)state;
    (void)unlink(path);
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    return null < 0 || dup2(null, STDERR_FILENO) < 0 ? -1 : close(null);
}

static int make(void **state)
{
    struct journal journal;
    (void)state;
    int fd = mkstemp(path);
    if (fd < 0)
        return -1;
    close(fd);
    (void)unlink(path);
    journal_open(&journal, "--events", path, BEGINS);
    for (int i = 0; i < RECORDS; i++) {
        journal_append(&journal, record(i));
        if (journal_flush(&journal) != 0)
            return -1;
        ends[i + 1] = get_file(whole, sizeof whole);
    }
    whole_length = ends[RECORDS];
    return journal_close(&journal);
}

static int clear(void **state)
{
    (void)state;
    (void)unlink(path);
    return 0;
}

/* Opens the journal, adds record next, and compares the file with the first next + 1 records. */
static void goes_on_with(int next)
{
    char now[sizeof whole];
    struct journal journal;
    journal_open(&journal, "--events", path, BEGINS);
    if (next == 0)
        assert_null(journal.last);
    else
        assert_memory_equal(journal.last, whole + ends[next - 1], ends[next] - ends[next - 1] - 1);
    journal_append(&journal, record(next));
    assert_int_equal(journal_close(&journal), 0);
    size_t length = get_file(now, sizeof now);
    cJSON *expected = record(next);
    assert_true(length > ends[next]);
    assert_memory_equal(now, whole, ends[next]);
    now[length - 1] = '\0';
    assert_true(journal_check(now + ends[next], length - 1 - ends[next]));
    assert_true(journal_line_equals(now + ends[next], expected));
}

static void test_every_record_is_json_and_checked(void **state)
{
    (void)state;
    for (int i = 0; i < RECORDS; i++) {
        char line[256] = {0};
        size_t length = ends[i + 1] - ends[i] - 1;
        memcpy(line, whole + ends[i], length);
        assert_true(journal_check(line, length));
        cJSON *object = cJSON_Parse(line);
        assert_int_equal(cJSON_GetObjectItem(object, "frame")->valueint, i);
        assert_int_equal(strlen(cJSON_GetObjectItem(object, "check")->valuestring), 16);
        cJSON_Delete(object);
    }
}

static void test_journal_continues_after_any_torn_end(void **state)
{
    int records = 0;
    (void)state;
    for (size_t length = 0; length <= whole_length; length++) {
        while (records < RECORDS && ends[records + 1] <= length)
            records++;
        put_file(whole, length);
        goes_on_with(records);
    }
}

static void test_any_flipped_bit_of_the_end_is_found(void **state)
{
    (void)state;
    for (size_t at = ends[2]; at < whole_length; at++) {
        for (int bit = 0; bit < 8; bit++) {
            char damaged[sizeof whole];
            int good = 2;
            while (ends[good + 1] <= at)
                good++;
            memcpy(damaged, whole, whole_length);
            damaged[at] = (char)(damaged[at] ^ 1 << bit);
            put_file(damaged, whole_length);
            goes_on_with(good);
        }
    }
}

static int open_it(void *context)
{
    struct journal journal;
    (void)context;
    journal_open(&journal, "--events", path, BEGINS);
    return 77;
}

static void left_as_it_is(const char *bytes, size_t length)
{
    char now[sizeof whole];
    put_file(bytes, length);
    assert_int_equal(child_run(open_it, NULL), 1);
    assert_int_equal(get_file(now, sizeof now), length);
    assert_memory_equal(now, bytes, length);
}

static void test_another_file_is_refused_and_left_as_it_is(void **state)
{
    static const char text[] = "a letter\nof mine", json[] = "{\"fram\":1}";
    char damaged[sizeof whole];
    (void)state;
    left_as_it_is(text, sizeof text - 1);
    left_as_it_is(json, sizeof json - 1);
    memcpy(damaged, whole, ends[1]);
    damaged[3] ^= 1; /* even its only record begins differently */
    left_as_it_is(damaged, ends[1]);
}

static void test_other_than_plain_file_is_refused(void **state)
{
    (void)state;
    (void)unlink(path);
    assert_int_equal(symlink("/dev/null", path), 0);
    assert_int_equal(child_run(open_it, NULL), 1);
    (void)unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(child_run(open_it, NULL), 1);
    (void)unlink(path);
}

static void test_two_writers_are_refused(void **state)
{
    struct journal journal;
    (void)state;
    journal_open(&journal, "--events", path, BEGINS);
    assert_int_equal(child_run(open_it, NULL), 1);
    assert_int_equal(journal_close(&journal), 0);
    assert_int_equal(child_run(open_it, NULL), 77);
}

/* Runs in a child process, so that the limit holds only there. */
static int fill_up(void *context)
{
    struct journal journal;
    struct rlimit limit;
    const size_t room = *(const size_t *)context;
    signal(SIGXFSZ, SIG_IGN);
    if (getrlimit(RLIMIT_FSIZE, &limit) != 0)
        return 2;
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = room;
    journal_open(&journal, "--events", path, BEGINS);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
        return 3;
    int failed = 0;
    for (int i = 0; i < RECORDS; i++) {
        journal_append(&journal, record(i));
        failed += journal_flush(&journal) != 0;
    }
    if (failed > 0 && (journal.error != EFBIG || journal_flush(&journal) == 0))
        return 4;
    limit.rlim_cur = before;
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0 || journal_close(&journal) != 0)
        return 5;
    return failed > 0 ? 10 : 0;
}

static void test_a_file_system_without_room_loses_nothing(void **state)
{
    char now[sizeof whole];
    (void)state;
    for (size_t room = 1; room <= whole_length; room += 7) {
        (void)unlink(path);
        assert_int_equal(child_run(fill_up, &room), room < whole_length ? 10 : 0);
        assert_int_equal(get_file(now, sizeof now), whole_length);
        assert_memory_equal(now, whole, whole_length);
    }
}

/* Makes a system call of this process fail from now on. */
static int let_fail(uint32_t call, uint32_t error)
{
    struct sock_filter code[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog program = {sizeof code / sizeof code[0], code};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0
               ? -1
               : prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

static int write_in_vain(void *context)
{
    struct journal journal;
    const int error = *(const int *)context;
    journal_open(&journal, "--events", path, BEGINS);
    journal_append(&journal, record(RECORDS));
    if (let_fail(SYS_write, (uint32_t)error) != 0)
        return 2;
    return journal_flush(&journal) == -1 && journal.error == error && journal.used > 0 ? 10 : 3;
}

static void test_failing_device_is_tried_again(void **state)
{
    static const int passing[] = {ENOSPC, EDQUOT, EIO, EROFS, ESTALE, ENXIO};
    int never = EBADF;
    (void)state;
    put_file(whole, whole_length);
    for (size_t i = 0; i < sizeof passing / sizeof passing[0]; i++) {
        int error = passing[i];
        assert_int_equal(child_run(write_in_vain, &error), 10);
    }
    assert_int_equal(child_run(write_in_vain, &never), 1);
}

static bool from_third(const char *line, void *context)
{
    (void)context;
    return strstr(line, "{\"frame\":2,") == line;
}

static void test_a_journal_is_cut_and_its_end_kept(void **state)
{
    struct journal journal;
    char old[sizeof path + 8], now[sizeof whole];
    (void)state;
    put_file(whole, whole_length);
    journal_open(&journal, "--events", path, BEGINS);
    journal_truncate(&journal, from_third, NULL);
    assert_memory_equal(journal.last, whole + ends[1], ends[2] - ends[1] - 1);
    journal_append(&journal, record(2));
    assert_int_equal(journal_close(&journal), 0);
    assert_int_equal(get_file(now, sizeof now), ends[3]);
    assert_memory_equal(now, whole, ends[3]);
    snprintf(old, sizeof old, "%s.old", path);
    assert_int_equal(rename(old, path), 0);
    assert_int_equal(get_file(now, sizeof now), whole_length - ends[2]);
    assert_memory_equal(now, whole + ends[2], whole_length - ends[2]);
}

/* The open file is read and cut, not the file that has its name by now. */
static void test_the_open_file_is_cut_not_a_link_of_its_name(void **state)
{
    struct journal journal;
    struct stat status;
    char old[sizeof path + 8];
    (void)state;
    put_file(whole, whole_length);
    journal_open(&journal, "--events", path, BEGINS);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(symlink("/dev/null", path), 0);
    journal_truncate(&journal, from_third, NULL);
    assert_non_null(journal.last);
    assert_memory_equal(journal.last, whole + ends[1], ends[2] - ends[1] - 1);
    assert_int_equal(fstat(journal.fd, &status), 0);
    assert_int_equal(status.st_size, ends[2]);
    assert_int_equal(journal_close(&journal), 0);
    snprintf(old, sizeof old, "%s.old", path);
    assert_int_equal(unlink(old), 0);
}

static int cut_while_failing(void *context)
{
    struct journal journal;
    const uint32_t call = *(const uint32_t *)context;
    journal_open(&journal, "--events", path, BEGINS);
    if (let_fail(call, EIO) != 0)
        return 2;
    journal_truncate(&journal, from_third, NULL);
    return 77;
}

static void test_unreadable_end_is_not_cut(void **state)
{
    static const uint32_t calls[] = {SYS_read, SYS_write};
    char old[sizeof path + 8], now[sizeof whole];
    (void)state;
    snprintf(old, sizeof old, "%s.old", path);
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
        uint32_t call = calls[i];
        put_file(whole, whole_length);
        assert_int_equal(child_run(cut_while_failing, &call), 1);
        assert_int_equal(get_file(now, sizeof now), whole_length);
        assert_memory_equal(now, whole, whole_length);
        (void)unlink(old);
    }
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup(function, quiet)
    const struct CMUnitTest tests[] = {
        TEST(test_every_record_is_json_and_checked),
        TEST(test_journal_continues_after_any_torn_end),
        TEST(test_any_flipped_bit_of_the_end_is_found),
        TEST(test_another_file_is_refused_and_left_as_it_is),
        TEST(test_other_than_plain_file_is_refused),
        TEST(test_two_writers_are_refused),
        TEST(test_a_file_system_without_room_loses_nothing),
        TEST(test_failing_device_is_tried_again),
        TEST(test_a_journal_is_cut_and_its_end_kept),
        TEST(test_the_open_file_is_cut_not_a_link_of_its_name),
        TEST(test_unreadable_end_is_not_cut),
    };
    return cmocka_run_group_tests(tests, make, clear);
}
