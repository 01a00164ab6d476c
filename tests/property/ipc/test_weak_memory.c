/* The protocol's real words and fences between processes that wait as little as possible: mover,
 * collider, a writer of commands and two readers. Every value contains its frame, so a value that
 * is seen too early is found: in a moved table, a world, a copy or a command.
 *
 * tests/model/fences.pml shows what weak memory may do without each fence. This test checks that
 * the compiled code does none of it on this machine. */
#include "ipc/frame/command_ring.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/frame/snapshot.h"
#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/numbered_frame.h"
#include "world/checksum.h"

#include <errno.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>

#include <cmocka.h>

#define CAPACITY      2048u
#define COMMAND_SLOTS 8u
#define FEW           2u /* rows of a small frame: two of them pass while a large one is copied */
#define ACCEPTED      20000u /* copies that a reader must see, of each kind */
#define LARGE         1000u
#define OVERTAKEN     200u
#define LIMIT_NS      (12 * (uint64_t)NS_PER_S) /* the copies seen by then must be enough */

/* Counters that the processes share beside the world. */
struct shared {
    _Atomic bool stop;
    _Atomic uint64_t commands; /* put */
};

/* The counts of a reader. */
struct sight {
    uint64_t accepted, large, overtaken, torn;
    uint64_t commands; /* put during its time */
};

enum outcome { GOOD, NO_MEMORY, DAMAGED, TORN, BACKWARDS, TORN_COMMAND, BAD_COMMAND };

static struct view view;
static struct shared *shared;

static uint32_t rows_of(uint64_t frame)
{
    return frame & 4 ? CAPACITY : FEW;
}

/* --- writers -----------------------------------------------------------------------------------*/

static void fill_command(struct command *command, uint64_t number)
{
    *command = (struct command){.source = 9,
                                .source_sequence = number,
                                .type = (uint32_t)number,
                                .entity = (uint32_t)(number * 3),
                                .amount = (uint32_t)(number * 5)};
    for (int i = 0; i < 6; i++)
        command->value[i] = (double)number + i;
}

static int take_commands(const struct view *mover, const struct frame_protocol *frame)
{
    struct state_head *head = mover->m.head;
    uint64_t *cursor = &head->command_cursor[RING_CLIENTS];
    for (; *cursor < frame->command_head[RING_CLIENTS]; ++*cursor) {
        struct command taken = mover->commands[RING_CLIENTS]->slot[*cursor & (COMMAND_SLOTS - 1)];
        struct command expected;
        fill_command(&expected, *cursor + 1);
        expected.sequence = *cursor;
        if (memcmp(&taken, &expected, sizeof taken) != 0)
            return TORN_COMMAND;
    }
    return GOOD;
}

static int move_frames(void *context)
{
    struct view mover = bare_view_as(&view, ROLE_MOVER);
    struct frame_protocol frame;
    (void)context;
    while (frame_protocol_mover_begin(&frame, &mover) == 0) {
        const struct state *committed = &mover.w[(frame.number - 1) & 1];
        if (!numbered_frame_head(committed->head) ||
            !numbered_frame_rows(committed->head, &committed->entities))
            return TORN;
        *mover.m.head = *committed->head;
        mover.m.head->frame = frame.number;
        numbered_frame_fill(mover.m.head, &mover.m.entities, rows_of(frame.number));
        if (take_commands(&mover, &frame) != GOOD)
            return TORN_COMMAND;
        mover.m.head->quit = atomic_load(&shared->stop);
        frame_protocol_mover_end(&frame, &mover);
    }
    return GOOD;
}

static int collide_frames(void *context)
{
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    struct frame_protocol frame;
    (void)context;
    while (frame_protocol_collider_begin(&frame, &collider) == 0) {
        const struct moved *moved = &collider.m;
        struct state *next = &collider.w[frame.number & 1];
        if (moved->head->frame != frame.number || !numbered_frame_head(moved->head) ||
            !numbered_frame_rows(moved->head, &moved->entities))
            return TORN;
        *next->head = *moved->head;
        entities_copy(&next->entities, &moved->entities, 0, moved->head->used);
        next->head->checksum = state_checksum(next, collider.header->counts.fixed);
        frame_protocol_collider_end(&frame, &collider);
    }
    return GOOD;
}

static int put_commands(void *context)
{
    struct view sender = bare_view_as(&view, ROLE_INTAKE);
    struct command command;
    uint64_t number = 0;
    (void)context;
    while (!atomic_load(&shared->stop)) {
        fill_command(&command, number + 1);
        if (command_put(&sender, RING_CLIENTS, &command) == 0)
            atomic_store(&shared->commands, ++number);
        else if (errno != ENOBUFS)
            return BAD_COMMAND;
        else
            sched_yield();
    }
    return GOOD;
}

/* --- readers -----------------------------------------------------------------------------------*/

static bool enough(const struct sight *sight)
{
    return sight->accepted >= ACCEPTED && sight->large >= LARGE && sight->overtaken >= OVERTAKEN &&
           sight->commands > COMMAND_SLOTS;
}

static int read_frames(struct sight *sight)
{
    struct snapshot snapshot;
    uint64_t last = 0, until_ns = clock_now_ns() + LIMIT_NS;
    *sight = (struct sight){0};
    if (snapshot_init(&snapshot, &view) != 0)
        return NO_MEMORY;
    while (!enough(sight) && clock_now_ns() < until_ns) {
        if (snapshot_take(&snapshot, &view) != 0) {
            if (errno != EAGAIN)
                return DAMAGED;
            continue;
        }
        if (snapshot.damaged > 0) /* torn, which only its checksum showed */
            return TORN;
        if (!numbered_frame_head(&snapshot.head) ||
            !numbered_frame_rows(&snapshot.head, &snapshot.entities))
            return TORN;
        if (snapshot.head.frame < last)
            return BACKWARDS;
        last = snapshot.head.frame;
        sight->accepted++;
        sight->large += snapshot.head.used == CAPACITY;
        sight->overtaken = snapshot.overtaken;
        sight->commands = atomic_load(&shared->commands);
    }
    snapshot_free(&snapshot);
    return GOOD;
}

static int read_as_child(void *context)
{
    struct sight sight;
    (void)context;
    return read_frames(&sight);
}

/* Uses every copy without the check of rule 6, to show what it prevents. */
static int read_without_look(struct sight *sight)
{
    struct snapshot copy;
    uint64_t until_ns = clock_now_ns() + LIMIT_NS;
    *sight = (struct sight){0};
    if (snapshot_init(&copy, &view) != 0)
        return NO_MEMORY;
    while (sight->torn == 0 && clock_now_ns() < until_ns) {
        uint64_t frame = atomic_load_explicit(&view.commit->commit, memory_order_acquire);
        const struct state *from = &view.w[frame & 1];
        copy.head = *from->head;
        uint32_t used = copy.head.used < CAPACITY ? copy.head.used : CAPACITY;
        entities_copy(&copy.entities, &from->entities, 0, used);
        sight->accepted++;
        if (copy.head.frame != frame || !numbered_frame_head(&copy.head) ||
            !numbered_frame_rows(&copy.head, &copy.entities))
            sight->torn++;
    }
    snapshot_free(&copy);
    return GOOD;
}

/* --- tests -------------------------------------------------------------------------------------*/

/* The outcome of read, here, beside all the others; theirs are checked. */
static int run_beside(int (*read)(struct sight *sight), struct sight *sight, bool second_reader)
{
    const struct bare_sizes sizes = {.capacity = CAPACITY,
                                     .event_slots = 64,
                                     .events_per_frame = 8,
                                     .command_slots = COMMAND_SLOTS};
    bare_view_make(&view, &sizes);
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(shared != MAP_FAILED);
    pid_t collider = child_start(collide_frames, NULL);
    pid_t mover = child_start(move_frames, NULL);
    pid_t sender = child_start(put_commands, NULL);
    pid_t reader = second_reader ? child_start(read_as_child, NULL) : 0;
    int here = read(sight);
    if (second_reader)
        assert_int_equal(child_wait(reader), GOOD);
    atomic_store(&shared->stop, true);
    assert_int_equal(child_wait(sender), GOOD);
    assert_int_equal(child_wait(mover), GOOD);
    assert_int_equal(child_wait(collider), GOOD);
    print_message("%llu frames, %llu commands; %llu copies, %llu of them large, %llu overtaken, "
                  "%llu torn\n",
                  (unsigned long long)atomic_load(&view.commit->commit),
                  (unsigned long long)sight->commands, (unsigned long long)sight->accepted,
                  (unsigned long long)sight->large, (unsigned long long)sight->overtaken,
                  (unsigned long long)sight->torn);
    munmap(shared, sizeof *shared);
    segment_abandon(&view);
    return here;
}

static void test_nothing_is_seen_before_its_time(void **state)
{
    struct sight sight;
    (void)state;
    assert_int_equal(run_beside(read_frames, &sight, true), GOOD);
    assert_true(sight.accepted > 0 && sight.large > 0);
    assert_true(sight.overtaken > 0);            /* there were races */
    assert_true(sight.commands > COMMAND_SLOTS); /* the ring has wrapped */
}

/* Shows that the test above can fail. */
static void test_without_the_check_copies_are_torn(void **state)
{
    struct sight sight;
    (void)state;
    assert_int_equal(run_beside(read_without_look, &sight, false), GOOD);
    assert_true(sight.torn > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_is_seen_before_its_time),
        cmocka_unit_test(test_without_the_check_copies_are_torn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
