/* The frame protocol with real processes: its invariants, kills at any moment, pauses, pacing. */
#include "ipc/frame/command_ring.h"
#include "ipc/frame/frame_protocol.h"

#include "ipc/process/clock.h"
#include "ipc/frame/snapshot.h"
#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"
#include "tests/support/stage.h"
#include "world/checksum.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define LONG_NS (15 * (uint64_t)NS_PER_S)

/* Patrols in a small area, a collision, shots and craters: enough to notice a frame that is
 * wrong. */
#define BATTLE                                                                                     \
    "vehicles = ( { kind = \"tank\"; count = 12; force = \"blue\"; fire_at_will = true; area = "   \
    "[25000.0, 25000.0, 25150.0, 25150.0]; }, { kind = \"jeep\"; count = 12; force = \"red\"; "    \
    "fire_at_will = true; area = [25100.0, 25100.0, 25300.0, 25300.0]; }, { kind = \"jet\"; "      \
    "count = 4; area = [24000.0, 24000.0, 26000.0, 26000.0]; } );"                                 \
    "objects = ( { kind = \"tree\"; at = [25120.0, 25120.0]; }, { kind = \"building\"; at = "      \
    "[25060.0, 25170.0]; } );"                                                                     \
    "fires = ( { at_s = 0.5; munition = \"artillery\"; point = [25100.0, 25100.0]; }, { at_s = "   \
    "2.0; munition = \"bomb\"; point = [25200.0, 25150.0]; }, { at_s = 4.0; munition = "           \
    "\"artillery\"; point = [25110.0, 25105.0]; } );"

#define FRAMES 2500

static const char *world_of(const char *text, const char *pace, int frames)
{
    static char scenario[2048];
    snprintf(scenario, sizeof scenario,
             "world = { seed = 3; capacity = 256; pace = \"%s\"; frames = %d; };\n%s", pace, frames,
             text);
    return scenario;
}

static uint64_t commit_of(const struct view *view)
{
    return atomic_load(&view->commit->commit);
}

/* Rule 1 as a third process sees it: each word is read between two reads of the other. */
static void check_words(const struct view *view)
{
    uint64_t before = commit_of(view);
    uint64_t moved = atomic_load(&view->moved_word->moved);
    uint64_t after = commit_of(view);
    if (moved < before || moved > after + 1)
        fail_msg("commit %llu, moved %llu, commit %llu", (unsigned long long)before,
                 (unsigned long long)moved, (unsigned long long)after);
}

struct ending {
    uint64_t digest, event_digest, events;
};

static struct ending ending_of(const struct fixture *f)
{
    struct state last = fixture_state(f);
    assert_int_equal(last.head->frame, FRAMES);
    assert_int_equal(last.head->checksum, state_checksum(&last, f->view.world.counts.fixed));
    return (struct ending){fixture_digest(f), last.head->event_digest, last.head->event_end};
}

/* The same world by the steps only, in one process. */
static struct ending undisturbed(void)
{
    struct fixture f;
    fixture_open(&f, world_of(BATTLE, "max", FRAMES));
    fixture_run(&f, FRAMES);
    struct ending ending = ending_of(&f);
    assert_true(ending.events > 20);
    assert_true(fixture_state(&f).head->crater_count >= 2);
    fixture_close(&f);
    return ending;
}

static void check_ending(const struct fixture *f, struct ending right)
{
    struct ending got = ending_of(f);
    assert_int_equal(got.events, right.events);
    assert_int_equal(got.event_digest, right.event_digest);
    assert_int_equal(got.digest, right.digest);
}

static void test_two_processes_make_the_frames_that_one_makes(void **state)
{
    struct ending right = undisturbed();
    struct fixture f;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "max", FRAMES));
    pid_t mover = stage_start(&f.view, ROLE_MOVER, false);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, false);
    while (!frame_protocol_finished(&f.view))
        check_words(&f.view);
    assert_int_equal(child_wait(mover), 0); /* both end after the last frame */
    assert_int_equal(child_wait(collider), 0);
    assert_int_equal(atomic_load(&f.view.moved_word->moved), FRAMES);
    check_ending(&f, right);
    fixture_close(&f);
}

/* Either process is killed at any moment and restarted at once. The end is the same to the bit. */
static void test_kills_at_any_moment_change_nothing(void **state)
{
    struct ending right = undisturbed();
    struct fixture f;
    uint64_t random = fixture_seed(1991);
    static const enum role roles[] = {ROLE_MOVER, ROLE_COLLIDER};
    pid_t pid[2];
    int kills = 0;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "max", FRAMES));
    for (int i = 0; i < 2; i++)
        pid[i] = stage_start(&f.view, roles[i], false);
    for (; kills < 200 && !frame_protocol_finished(&f.view); kills++) {
        uint64_t until = clock_now_ns() + fixture_random(&random) % (2 * NS_PER_MS);
        while (clock_now_ns() < until)
            check_words(&f.view);
        int i = (int)(fixture_random(&random) & 1);
        child_kill(pid[i]);
        check_words(&f.view);
        pid[i] = stage_start(&f.view, roles[i], false);
    }
    uint64_t frame = commit_of(&f.view);
    for (int i = 0; i < 2; i++)
        assert_int_equal(child_wait(pid[i]), 0);
    print_message("%d kills by frame %llu\n", kills, (unsigned long long)frame);
    assert_true(kills >= 50);
    check_ending(&f, right);
    fixture_close(&f);
}

static int commit_slowly(void *context)
{
    struct view *view = context;
    struct frame_protocol frame;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        usleep(15000);
        *view->w[frame.number & 1].head = *view->m.head;
        frame_protocol_collider_end(&frame, view);
    }
    return 0;
}

static int commit_at_once(void *context)
{
    struct view *view = context;
    struct frame_protocol frame;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        *view->w[frame.number & 1].head = *view->m.head;
        frame_protocol_collider_end(&frame, view);
    }
    return 0;
}

/* A mover that moves nothing. */
static void move_by_hand(struct frame_protocol *frame, struct view *mover)
{
    assert_int_equal(frame_protocol_mover_begin(frame, mover), 0);
    *mover->m.head = *mover->w[(frame->number - 1) & 1].head;
    mover->m.head->frame = frame->number;
    frame_protocol_mover_end(frame, mover);
}

static void make_paced(struct view *view, double hz)
{
    const struct bare_sizes sizes = {
        .capacity = 16, .event_slots = 64, .events_per_frame = 8, .command_slots = 8, .hz = hz};
    bare_view_make(view, &sizes);
}

static void test_frames_are_not_made_before_they_are_due(void **state)
{
    struct view view;
    struct frame_protocol frame;
    (void)state;
    make_paced(&view, 200.0);
    struct view mover = bare_view_as(&view, ROLE_MOVER);
    struct view other = bare_view_as(&view, ROLE_COLLIDER);
    pid_t collider = child_start(commit_at_once, &other);
    move_by_hand(&frame, &mover);
    uint64_t begin = clock_now_ns();
    for (int i = 0; i < 30; i++)
        move_by_hand(&frame, &mover);
    assert_true(clock_now_ns() - begin > 29 * 5 * (uint64_t)NS_PER_MS);
    child_kill(collider);
    segment_abandon(&view);
}

/* Time scale 2 makes two seconds of simulation a second, 0.5 half a second. */
static void test_time_scale_changes_the_pace(void **state)
{
    struct view view;
    struct frame_protocol frame;
    uint64_t took[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        make_paced(&view, 200.0);
        struct view mover = bare_view_as(&view, ROLE_MOVER);
        struct view other = bare_view_as(&view, ROLE_COLLIDER);
        for (int w = 0; w < 2; w++) {
            struct state_head *head = view.w[w].head;
            head->time_scale = i == 0 ? 0.5 : 4.0;
            head->checksum = state_checksum(&view.w[w], view.header->counts.fixed);
        }
        pid_t collider = child_start(commit_at_once, &other);
        move_by_hand(&frame, &mover);
        uint64_t begin = clock_now_ns();
        for (int n = 0; n < 12; n++)
            move_by_hand(&frame, &mover);
        took[i] = clock_now_ns() - begin;
        child_kill(collider);
        segment_abandon(&view);
    }
    assert_true(took[0] > 11 * 10 * (uint64_t)NS_PER_MS);
    assert_true(took[1] > 11 * 1250000u);
    assert_true(took[1] < took[0]);
}

/* A long stall is one late frame, and the later frames keep their intervals. */
static void test_stall_is_one_late_frame(void **state)
{
    struct view view;
    struct frame_protocol frame;
    (void)state;
    make_paced(&view, 100.0);
    struct view mover = bare_view_as(&view, ROLE_MOVER);
    struct view other = bare_view_as(&view, ROLE_COLLIDER);
    const struct role_slot *slot = view.slot[ROLE_MOVER];
    pid_t collider = child_start(commit_at_once, &other);
    for (int i = 0; i < 3; i++)
        move_by_hand(&frame, &mover);
    uint64_t late = atomic_load(&slot->late_frames);
    usleep(200000); /* 20 frames long */
    move_by_hand(&frame, &mover);
    uint64_t begin = clock_now_ns();
    for (int i = 0; i < 6; i++)
        move_by_hand(&frame, &mover);
    uint64_t took = clock_now_ns() - begin;
    assert_true(atomic_load(&slot->late_frames) > late);
    assert_true(atomic_load(&slot->late_frames) <= late + 3); /* not 20, even on a busy machine */
    assert_true(took > 5 * 10 * (uint64_t)NS_PER_MS);
    child_kill(collider);
    segment_abandon(&view);
}

/* A frame that is not committed when the next is due is late (role.h): so is each frame that takes
 * one and a half times its time. */
static void test_every_frame_that_overruns_is_late(void **state)
{
    struct view view;
    struct frame_protocol frame;
    (void)state;
    make_paced(&view, 100.0);
    struct view mover = bare_view_as(&view, ROLE_MOVER);
    struct view other = bare_view_as(&view, ROLE_COLLIDER);
    pid_t collider = child_start(commit_slowly, &other);
    for (int i = 0; i < 13; i++)
        move_by_hand(&frame, &mover);
    uint64_t late = atomic_load(&view.slot[ROLE_MOVER]->late_frames);
    child_kill(collider);
    segment_abandon(&view);
    if (late < 10)
        fail_msg("12 frames of 15 ms each at 100 Hz, %llu of them late", (unsigned long long)late);
}

/* A lost ring would only cost time and would not be seen in the frames, so it is checked here. */
static bool rings(const struct view *view, int role)
{
    int value = -1;
    assert_int_equal(sem_getvalue(&view->doorbells->role[role].bell, &value), 0);
    return value > 0;
}

static void test_each_stage_rings_the_waiting_roles(void **state)
{
    struct view view;
    struct frame_protocol frame;
    (void)state;
    make_paced(&view, 1000.0);
    struct view mover = bare_view_as(&view, ROLE_MOVER);
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    move_by_hand(&frame, &mover);
    for (int role = 0; role < ROLE_COUNT; role++)
        assert_int_equal(rings(&view, role), role == ROLE_COLLIDER);
    sem_trywait(&view.doorbells->role[ROLE_COLLIDER].bell);
    assert_int_equal(frame_protocol_collider_begin(&frame, &collider), 0);
    *view.w[1].head = *view.m.head;
    frame_protocol_collider_end(&frame, &collider);
    for (int role = 0; role < ROLE_COUNT; role++) {
        bool renderer = role >= ROLE_RENDERER && role <= ROLE_RENDERER_4;
        assert_int_equal(rings(&view, role), role == ROLE_MOVER || renderer);
    }
    segment_abandon(&view);
}

/* --- pausing and commands ----------------------------------------------------------------------*/

static void send(const struct view *view, enum command_type type, uint32_t amount)
{
    static uint64_t sequence;
    struct view reporter = *view;
    struct command command = {
        .source = 1, .source_sequence = ++sequence, .type = type, .amount = amount};
    reporter.role = ROLE_INTAKE;
    assert_int_equal(command_put(&reporter, RING_CLIENTS, &command), 0);
}

/* Waits until the committed head says so. */
static struct state_head wait_head(const struct view *view, bool (*says)(const struct state_head *))
{
    struct state_head head;
    uint64_t until = clock_now_ns() + LONG_NS;
    do {
        assert_true(clock_now_ns() < until);
        assert_int_equal(snapshot_head(&head, view), 0);
    } while (!says(&head));
    return head;
}

static bool is_paused(const struct state_head *head)
{
    return head->paused != 0;
}
static bool is_running(const struct state_head *head)
{
    return head->paused == 0;
}
static bool has_stepped(const struct state_head *head)
{
    return head->tally.commands == 2 && head->steps_left == 0;
}

static void test_pause_step_resume_and_quit(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "max", 0));
    pid_t mover = stage_start(&f.view, ROLE_MOVER, false);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, false);
    while (commit_of(&f.view) < 10)
        usleep(200);
    send(&f.view, COMMAND_PAUSE, 0);
    struct state_head paused = wait_head(&f.view, is_paused);
    usleep(60000); /* a paused world has no frames */
    assert_int_equal(commit_of(&f.view), paused.frame);
    assert_int_equal(atomic_load(&f.view.moved_word->moved), paused.frame);
    for (int role = ROLE_MOVER; role <= ROLE_COLLIDER; role++) { /* its heartbeat continues */
        uint64_t beat = atomic_load(&f.view.slot[role]->beat_ns);
        usleep(100000);
        assert_true(atomic_load(&f.view.slot[role]->beat_ns) > beat);
    }
    send(&f.view, COMMAND_STEP, 7);
    struct state_head stepped = wait_head(&f.view, has_stepped);
    usleep(30000);
    assert_int_equal(commit_of(&f.view), stepped.frame);
    assert_int_equal(stepped.frame, paused.frame + 7); /* 7 frames, each of which advances time */
    assert_int_equal(stepped.tick, paused.tick + 7);
    assert_int_equal(stepped.paused, 1);
    send(&f.view, COMMAND_RESUME, 0);
    wait_head(&f.view, is_running);
    while (commit_of(&f.view) < stepped.frame + 20)
        usleep(200);
    assert_false(frame_protocol_finished(&f.view));
    send(&f.view, COMMAND_QUIT, 0);
    assert_int_equal(child_wait(mover), 0);
    assert_int_equal(child_wait(collider), 0);
    assert_true(frame_protocol_finished(&f.view));
    fixture_close(&f);
}

static void test_command_is_applied_once_though_the_mover_is_killed(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "max", 0));
    pid_t mover = stage_start(&f.view, ROLE_MOVER, false);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, false);
    for (int i = 0; i < 40; i++) {
        send(&f.view, COMMAND_SCALE, 0); /* out of range, but answered */
        usleep((useconds_t)(i * 13 % 300));
        child_kill(mover);
        mover = stage_start(&f.view, ROLE_MOVER, false);
    }
    send(&f.view, COMMAND_QUIT, 0);
    assert_int_equal(child_wait(mover), 0);
    assert_int_equal(child_wait(collider), 0);
    assert_int_equal(fixture_state(&f).head->tally.commands, 41);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_CLIENTS], 41);
    assert_int_equal(fixture_event_count(&f, EVENT_COMMAND), 41);
    for (uint32_t i = 0; i < 41; i++)
        assert_int_equal(fixture_event(&f, EVENT_COMMAND, i)->command.sequence,
                         fixture_event(&f, EVENT_COMMAND, 0)->command.sequence + i);
    fixture_close(&f);
}

static void test_sigterm_ends_both_stages_cleanly(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "real", 0));
    pid_t mover = stage_start(&f.view, ROLE_MOVER, false);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, false);
    while (commit_of(&f.view) < 3)
        usleep(200);
    kill(collider, SIGTERM);
    assert_int_equal(child_wait(collider), 0);
    kill(mover, SIGTERM); /* while it waits for a collider that has ended */
    assert_int_equal(child_wait(mover), 0);
    check_words(&f.view);
    fixture_close(&f);
}

/* --- damaged worlds ----------------------------------------------------------------------------*/

static void check_refused(struct fixture *f, enum role role)
{
    int status = child_wait(stage_start(&f->view, role, true));
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
}

static void test_impossible_words_are_refused(void **state)
{
    const uint64_t words[][2] = {{5, 7}, {5, 4}, {0, 2}, {UINT64_MAX - 1, 0}}; /* commit, moved */
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        atomic_store(&f.view.commit->commit, words[i][0]);
        atomic_store(&f.view.moved_word->moved, words[i][1]);
        check_refused(&f, ROLE_MOVER);
        check_refused(&f, ROLE_COLLIDER);
    }
    fixture_close(&f);
}

static void test_damaged_buffer_is_refused(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    struct state_head *head = f.view.w[0].head;
    for (int i = 0; i < 4; i++) {
        struct state_head good = *head;
        if (i == 0)
            head->frame = 1;
        else if (i == 1)
            head->used = f.view.header->capacity + 1;
        else if (i == 2)
            head->contact_count = f.view.header->contact_slots + 1;
        else
            head->crater_count = f.view.header->crater_slots + 1;
        check_refused(&f, ROLE_MOVER);
        atomic_store(&f.view.moved_word->moved, 1);
        check_refused(&f, ROLE_COLLIDER);
        atomic_store(&f.view.moved_word->moved, 0);
        *head = good;
    }
    fixture_close(&f);
}

/* --- readers' waits ----------------------------------------------------------------------------*/

static int commit_later(void *context)
{
    struct view *collider = context;
    usleep(20000);
    bare_view_begin(collider);
    bare_view_end(collider);
    return 0;
}

static void test_readers_and_renderers_wake_with_the_commit(void **state)
{
    static const enum role waiting[] = {ROLE_NONE, ROLE_REPORTER, ROLE_RENDERER, ROLE_RENDERER_4};
    struct view view;
    (void)state;
    make_paced(&view, 60.0);
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    for (uint64_t i = 0; i < 4; i++) {
        struct view reader = bare_view_as(&view, waiting[i]);
        pid_t child = child_start(commit_later, &collider);
        uint64_t begin = clock_now_ns();
        assert_int_equal(frame_protocol_wait(&reader, i, begin + LONG_NS), i + 1);
        assert_true(clock_now_ns() - begin < LONG_NS / 2);
        assert_int_equal(child_wait(child), 0);
        assert_int_equal(frame_protocol_wait(&reader, i, 0),
                         i + 1); /* an existing frame needs no wait */
    }
    segment_abandon(&view);
}

static void test_wait_for_a_frame_ends_with_its_time(void **state)
{
    static const enum role waiting[] = {ROLE_NONE, ROLE_RENDERER};
    struct view view;
    (void)state;
    make_paced(&view, 60.0);
    for (int i = 0; i < 2; i++) {
        struct view reader = bare_view_as(&view, waiting[i]);
        uint64_t begin = clock_now_ns();
        assert_int_equal(frame_protocol_wait(&reader, 0, begin + 20 * (uint64_t)NS_PER_MS), 0);
        uint64_t waited = clock_now_ns() - begin;
        assert_true(waited >= 20 * (uint64_t)NS_PER_MS && waited < LONG_NS);
    }
    segment_abandon(&view);
}

/* --- what the loops leave in their slots -------------------------------------------------------*/

static void test_stages_keep_their_statistics(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, world_of(BATTLE, "max", 50));
    pid_t mover = stage_start(&f.view, ROLE_MOVER, false);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, false);
    assert_int_equal(child_wait(mover), 0);
    assert_int_equal(child_wait(collider), 0);
    for (int role = ROLE_MOVER; role <= ROLE_COLLIDER; role++) {
        const struct role_slot *slot = f.view.slot[role];
        assert_int_equal(slot->frame, 50);
        assert_int_equal(slot->stage.count, 50);
        assert_true(slot->stage_ns > 0 && slot->stage.max_ns >= slot->stage_ns);
        assert_true(histogram_quantile(&slot->stage, 0.5) > 0);
    }
    assert_int_equal(f.view.slot[ROLE_COLLIDER]->whole.count, 50);
    assert_true(f.view.slot[ROLE_COLLIDER]->whole.max_ns >=
                f.view.slot[ROLE_COLLIDER]->stage.max_ns);
    assert_int_equal(f.view.slot[ROLE_MOVER]->late_frames, 0); /* nothing is late at full pace */
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_processes_make_the_frames_that_one_makes),
        cmocka_unit_test(test_kills_at_any_moment_change_nothing),
        cmocka_unit_test(test_frames_are_not_made_before_they_are_due),
        cmocka_unit_test(test_time_scale_changes_the_pace),
        cmocka_unit_test(test_stall_is_one_late_frame),
        cmocka_unit_test(test_every_frame_that_overruns_is_late),
        cmocka_unit_test(test_each_stage_rings_the_waiting_roles),
        cmocka_unit_test(test_pause_step_resume_and_quit),
        cmocka_unit_test(test_command_is_applied_once_though_the_mover_is_killed),
        cmocka_unit_test(test_sigterm_ends_both_stages_cleanly),
        cmocka_unit_test(test_impossible_words_are_refused),
        cmocka_unit_test(test_damaged_buffer_is_refused),
        cmocka_unit_test(test_readers_and_renderers_wake_with_the_commit),
        cmocka_unit_test(test_wait_for_a_frame_ends_with_its_time),
        cmocka_unit_test(test_stages_keep_their_statistics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
