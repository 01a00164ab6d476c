/* The recorder's logs of events and commands, on a world in this process: recorders that are
 * replaced, a ring that overwrites events, and the replay of a log. */
#include "recorder/log/command_log.h"
#include "recorder/log/event_log.h"
#include "recorder/replay/log_replay.h"
#include "tests/support/child.h"
#include "tests/support/remotes.h"
#include "world/params.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define SLOTS  256u /* slots of the event ring */
#define FRAMES 300

static struct fixture f;
static char folder[] = "/tmp/jolon-test-recorder-XXXXXX";
static char events_path[64], commands_path[64], old_path[64];

static int open_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(events_path, sizeof events_path, "%s/events", folder);
    snprintf(commands_path, sizeof commands_path, "%s/commands", folder);
    snprintf(old_path, sizeof old_path, "%s/commands.old", folder);
    return 0;
}

static void remove_files(void)
{
    (void)unlink(events_path);
    (void)unlink(commands_path);
    (void)unlink(old_path);
}

static int close_folder(void **state)
{
    (void)state;
    remove_files();
    return rmdir(folder);
}

static void begin_world(struct fixture *fixture)
{
    fixture_open(fixture, "world = { seed = 1; capacity = 64; remotes_max = 6; };");
    fixture_put(fixture, (struct fixture_entity){.kind = "tank",
                                                 .at = {25000.0, FIXTURE_GROUND_M, 25000.0}});
    fixture_put(fixture, (struct fixture_entity){.kind = "truck",
                                                 .at = {25030.0, FIXTURE_GROUND_M, 25000.0},
                                                 .velocity = {-8.0, 0.0, 0.0}});
}

static int open_world(void **state)
{
    (void)state;
    remove_files();
    begin_world(&f);
    return 0;
}

static int open_small_ring(void **state)
{
    open_world(state);
    steps_small_ring(&f, SLOTS);
    return 0;
}

/* Draws a command, or a record of another simulator, that is possible often, but not always. */
static void send_any(uint64_t *random, uint64_t number)
{
    struct command command = {.source = 7, .source_sequence = number};
    if (fixture_random(random) % 2 == 0) {
        remotes_send(&f, remotes_any(&f, random));
        return;
    }
    switch (fixture_random(random) % 6) {
    case 0:
        command.type = COMMAND_DRIVE;
        command.entity = 1;
        command.value[0] = fixture_uniform(random, -1.1, 1.1);
        command.value[1] = fixture_uniform(random, -1.0, 1.0);
        break;
    case 1:
        command.type = COMMAND_FIRE;
        command.entity = 1;
        break;
    case 2:
        command.type = COMMAND_SPAWN;
        command.kind = fixture_kind(&f, "jeep");
        command.value[0] = fixture_uniform(random, 24000.0, 26000.0);
        command.value[1] = fixture_uniform(random, 24000.0, 26000.0);
        break;
    case 3:
        command.type = 77777; /* an unknown type */
        command.value[3] = (double)NAN;
        break;
    case 4:
        command.type = COMMAND_RELEASE;
        command.entity = 1;
        break;
    default:
        command.type = COMMAND_REMOVE;
        command.entity = 3 + (uint32_t)(fixture_random(random) % 20);
        break;
    }
    steps_send(&f, (enum command_ring)(fixture_random(random) % COMMAND_RING_COUNT), command);
}

static void run_with_commands(uint64_t *random, int frames)
{
    static uint64_t number;
    for (int i = 0; i < frames; i++) {
        for (uint64_t n = fixture_random(random) % 8; n > 5; n--)
            send_any(random, ++number);
        fixture_run(&f, 1);
    }
}

static const struct state_head *head(void)
{
    return fixture_state(&f).head;
}

/* --- files -------------------------------------------------------------------------------------*/

static char *text_of(const char *path, size_t *length)
{
    struct stat status;
    int fd = open(path, O_RDONLY);
    assert_true(fd >= 0 && fstat(fd, &status) == 0);
    char *text = calloc((size_t)status.st_size + 1, 1);
    assert_non_null(text);
    assert_int_equal(read(fd, text, (size_t)status.st_size), status.st_size);
    close(fd);
    *length = (size_t)status.st_size;
    return text;
}

static void put_text(const char *path, const char *text, size_t length)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, length), length);
    close(fd);
}

/* Checks the event log: every sequence number once, in order; a gap counts for the events that it
 * lost. */
static void check_events(uint64_t total, uint64_t lost)
{
    size_t length;
    char *text = text_of(events_path, &length);
    uint64_t next = 0, gaps = 0;
    for (char *line = text, *stop; line < text + length; line = stop + 1) {
        stop = strchr(line, '\n');
        assert_non_null(stop);
        assert_true(journal_check(line, (size_t)(stop - line)));
        *stop = '\0';
        cJSON *object = cJSON_Parse(line);
        uint64_t sequence = (uint64_t)cJSON_GetObjectItem(object, "sequence")->valuedouble;
        const cJSON *gap = cJSON_GetObjectItem(object, "lost");
        uint64_t stands_for = gap ? (uint64_t)gap->valuedouble : 1;
        assert_int_equal(sequence + 1, next + stands_for);
        gaps += gap ? stands_for : 0;
        next = sequence + 1;
        cJSON_Delete(object);
    }
    assert_int_equal(next, total);
    assert_int_equal(gaps, lost);
    free(text);
}

static void turn_all(struct event_log *events, struct command_log *commands)
{
    while (event_log_append(events, &f.view))
        ;
    while (command_log_append(commands, &f.view))
        ;
}

/* --- logs of events ----------------------------------------------------------------------------*/

static void test_events_are_logged_once_over_several_recorders(void **state)
{
    uint64_t random = fixture_seed(11);
    struct event_log log;
    (void)state;
    for (int i = 0; i < 60; i++) {
        run_with_commands(&random, 5);
        event_log_open(&log, &f.view, events_path);
        for (uint64_t turns = fixture_random(&random) % 3; turns > 0; turns--)
            event_log_append(&log, &f.view);
        assert_true(event_log_close(&log, &f.view) <= head()->event_end);
    }
    event_log_open(&log, &f.view, events_path);
    while (event_log_append(&log, &f.view))
        ;
    assert_int_equal(event_log_close(&log, &f.view), 0);
    assert_true(head()->event_end > 100);
    check_events(head()->event_end, 0);
}

static void test_overwritten_events_are_a_gap(void **state)
{
    uint64_t random = fixture_seed(12);
    struct event_log log;
    (void)state;
    run_with_commands(&random, 10);
    event_log_open(&log, &f.view, events_path);
    event_log_append(&log, &f.view);
    while (head()->event_end < 2 * SLOTS)
        run_with_commands(&random, 10);
    while (event_log_append(&log, &f.view))
        ;
    uint64_t lost = log.gaps;
    assert_true(lost > 0 && lost >= head()->event_end - log.written);
    assert_int_equal(event_log_close(&log, &f.view), 0);
    check_events(head()->event_end, lost);
}

static int open_events(void *context)
{
    struct event_log log;
    (void)context;
    event_log_open(&log, &f.view, events_path);
    return 77;
}

static void test_another_runs_events_are_refused(void **state)
{
    uint64_t random = fixture_seed(13);
    struct event_log log;
    (void)state;
    run_with_commands(&random, FRAMES);
    event_log_open(&log, &f.view, events_path);
    while (event_log_append(&log, &f.view))
        ;
    uint64_t end = head()->event_end;
    assert_int_equal(event_log_close(&log, &f.view), 0);
    assert_int_equal(child_run(open_events, NULL), 77);
    fixture_close(&f);
    begin_world(&f);
    fixture_run(&f, 1);
    assert_int_equal(child_run(open_events, NULL), 1); /* the log holds more than the world */
    while (head()->event_end < end + 10)
        run_with_commands(&random, 10);
    assert_int_equal(child_run(open_events, NULL), 1); /* its last event is not this world's */
}

/* --- logs of commands --------------------------------------------------------------------------*/

/* Records a run of random commands, by recorders that come and go. */
static void record_run(uint64_t seed)
{
    uint64_t random = fixture_seed(seed);
    struct command_log log;
    for (int i = 0; i < 10; i++) {
        command_log_open(&log, &f.view, commands_path);
        run_with_commands(&random, FRAMES / 10);
        while (command_log_append(&log, &f.view))
            ;
        if (i % 2)
            assert_int_equal(command_log_close(&log, &f.view), 0);
        else
            assert_int_equal(journal_close(&log.journal), 0); /* as a kill leaves it */
    }
}

static void open_replay(struct log_replay *replay)
{
    struct error_text error;
    if (log_replay_open(replay, commands_path, &error) != 0)
        fail_msg("%s", error.text);
}

static void test_run_is_replayed_from_its_log(void **state)
{
    struct fixture again;
    struct log_replay replay;
    struct error_text error;
    (void)state;
    record_run(21);
    open_replay(&replay);
    assert_int_equal(replay.known_frame, FRAMES);
    assert_int_equal(log_replay_commands(&replay, FRAMES), head()->tally.commands);
    const struct command_record *end = log_replay_end(&replay);
    assert_non_null(end);
    assert_int_equal(end->digest, fixture_digest(&f));
    begin_world(&again);
    while (frame_stepper_frame(&again.stepper) < replay.known_frame) {
        if (log_replay_step(&replay, &again.stepper, &error) != LOG_REPLAY_STEPPED)
            fail_msg("frame %llu: %s", (unsigned long long)frame_stepper_frame(&again.stepper),
                     error.text);
    }
    assert_int_equal(fixture_digest(&again), fixture_digest(&f));
    assert_int_equal(fixture_state(&again).head->event_digest, head()->event_digest);
    log_replay_close(&replay);
    fixture_close(&again);
}

static void test_wrong_mark_is_reported(void **state)
{
    struct fixture other;
    struct log_replay replay;
    struct error_text error;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    (void)state;
    record_run(22);
    open_replay(&replay);
    begin_world(&other);
    steps_rows(&other).row[1].x += 0.5; /* the log ends a little earlier */
    while (step == LOG_REPLAY_STEPPED && frame_stepper_frame(&other.stepper) < replay.known_frame)
        step = log_replay_step(&replay, &other.stepper, &error);
    assert_int_equal(step, LOG_REPLAY_MISMATCH);
    assert_non_null(strstr(error.text, "digest"));
    log_replay_close(&replay);
    fixture_close(&other);
}

static void test_damaged_log_is_refused(void **state)
{
    struct log_replay replay;
    struct error_text error;
    size_t length;
    uint64_t random = fixture_seed(23);
    (void)state;
    record_run(23);
    char *text = text_of(commands_path, &length);
    for (int i = 0; i < 400; i++) {
        size_t at = fixture_random(&random) % length;
        char before = text[at];
        text[at] = (char)(text[at] ^ 1 << fixture_random(&random) % 8);
        put_text(commands_path, text, length);
        /* Without its last newline, the last line counts as torn. */
        if (at != length - 1) {
            assert_int_equal(log_replay_open(&replay, commands_path, &error), -1);
        }
        text[at] = before;
    }
    /* Removes a line, at any position. */
    char *second = strchr(text, '\n') + 1, *third = strchr(second, '\n') + 1;
    memmove(second, third, length - (size_t)(third - text));
    put_text(commands_path, text, length - (size_t)(third - second));
    assert_int_equal(log_replay_open(&replay, commands_path, &error), -1);
    free(text);
}

static void test_log_of_a_killed_run_is_replayed_as_far_as_known(void **state)
{
    struct log_replay replay;
    size_t length;
    uint64_t random = fixture_seed(24);
    (void)state;
    record_run(24);
    char *text = text_of(commands_path, &length);
    uint64_t known = 0;
    for (size_t cut = (size_t)(strchr(text, '\n') - text) + 1; cut < length; cut++) {
        bool border = text[cut] == '\n' || text[cut - 1] == '\n' || text[cut - 2] == '\n';
        if (!border && fixture_random(&random) % 64 != 0)
            continue;
        put_text(commands_path, text, cut);
        open_replay(&replay);
        assert_true(replay.known_frame >= known && replay.known_frame <= FRAMES);
        assert_int_equal(replay.torn, text[cut - 1] != '\n');
        known = replay.known_frame;
        log_replay_close(&replay);
    }
    free(text);
}

static void test_lost_commands_end_the_known_run(void **state)
{
    uint64_t random = fixture_seed(25);
    struct command_log log;
    struct log_replay replay;
    (void)state;
    command_log_open(&log, &f.view, commands_path);
    run_with_commands(&random, 20);
    while (command_log_append(&log, &f.view))
        ;
    uint64_t logged = head()->tally.commands, known = head()->frame;
    while (head()->event_end < 2 * SLOTS)
        run_with_commands(&random, 10);
    assert_int_equal(command_log_close(&log, &f.view), 0);
    open_replay(&replay);
    assert_true(replay.gap && replay.known_frame <= known);
    assert_null(log_replay_end(&replay));
    uint64_t lost = 0;
    for (uint32_t i = 0; i < replay.count; i++)
        lost += replay.record[i].lost;
    assert_true(lost > 0 && logged + lost <= head()->tally.commands);
    assert_int_equal(replay.record[replay.count - 1].at.commands, head()->tally.commands);
    log_replay_close(&replay);
}

static void test_events_without_commands_lose_no_command(void **state)
{
    struct command_log log;
    struct log_replay replay;
    (void)state;
    command_log_open(&log, &f.view, commands_path);
    steps_drive(&f, 0, 0.5, 0.1, 0.0);
    while (command_log_append(&log, &f.view))
        ;
    struct state now = fixture_state(&f);
    now.head->event_end += 2 * SLOTS; /* as if the run had so many events, none of them a command */
    now.head->checksum = state_checksum(&now, f.view.world.counts.fixed);
    memset(f.view.events, 0, SLOTS * sizeof *f.view.events);
    assert_int_equal(command_log_close(&log, &f.view), 0);
    open_replay(&replay);
    assert_false(replay.gap);
    assert_non_null(log_replay_end(&replay));
    log_replay_close(&replay);
}

static void test_log_of_another_run_is_renamed(void **state)
{
    struct command_log log;
    size_t length, kept;
    (void)state;
    record_run(26);
    char *before = text_of(commands_path, &length);
    fixture_close(&f);
    begin_world(&f);
    command_log_open(&log, &f.view, commands_path);
    assert_int_equal(command_log_close(&log, &f.view), 0);
    char *old = text_of(old_path, &kept);
    assert_int_equal(kept, length);
    assert_memory_equal(old, before, length);
    free(before);
    free(old);
}

static void test_both_logs_agree(void **state)
{
    uint64_t random = fixture_seed(27);
    struct event_log events;
    struct command_log commands;
    (void)state;
    event_log_open(&events, &f.view, events_path);
    command_log_open(&commands, &f.view, commands_path);
    for (int i = 0; i < FRAMES; i++) {
        run_with_commands(&random, 1);
        turn_all(&events, &commands);
    }
    assert_int_equal(events.written, head()->event_end);
    assert_int_equal(commands.at.commands, head()->tally.commands);
    assert_int_equal(command_log_close(&commands, &f.view), 0);
    assert_int_equal(event_log_close(&events, &f.view), 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
#define SMALL(function)                                                                            \
    cmocka_unit_test_prestate_setup_teardown(function, open_small_ring, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_events_are_logged_once_over_several_recorders),
        SMALL(test_overwritten_events_are_a_gap),
        TEST(test_another_runs_events_are_refused),
        TEST(test_run_is_replayed_from_its_log),
        TEST(test_wrong_mark_is_reported),
        TEST(test_damaged_log_is_refused),
        TEST(test_log_of_a_killed_run_is_replayed_as_far_as_known),
        SMALL(test_lost_commands_end_the_known_run),
        SMALL(test_events_without_commands_lose_no_command),
        TEST(test_log_of_another_run_is_renamed),
        TEST(test_both_logs_agree),
    };
    return cmocka_run_group_tests(tests, open_folder, close_folder);
}
