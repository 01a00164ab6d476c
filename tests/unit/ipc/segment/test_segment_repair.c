/* A damaged world goes back to its newest whole frame and computes the lost frame again: the same
 * digest, events and commands. Worse damage is refused, with the names of the fields. */
#include "ipc/frame/command_ring.h"
#include "ipc/frame/frame_protocol.h"

#include "ipc/frame/snapshot.h"
#include "ipc/segment/frame_check.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_locks.h"
#include "ipc/segment/segment_repair.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"
#include "world/checksum.h"
#include "world/entity/dent.h"
#include "world/entity/persistent_contact.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#define SCENARIO                                                                                   \
    "world = { seed = 3; capacity = 128; pace = \"max\"; };"                                       \
    "vehicles = ( { kind = \"tank\"; count = 8; force = \"blue\"; fire_at_will = true; area = "    \
    "[25000.0, 25000.0, 25150.0, 25150.0]; }, { kind = \"jeep\"; count = 8; force = \"red\"; "     \
    "fire_at_will = true; area = [25100.0, 25100.0, 25300.0, 25300.0]; } );"                       \
    "objects = ( { kind = \"tree\"; at = [25120.0, 25120.0]; }, { kind = \"building\"; at = "      \
    "[25060.0, 25170.0]; } );"                                                                     \
    "fires = ( { at_s = 0.1; munition = \"artillery\"; point = [25100.0, 25100.0]; }, { at_s = "   \
    "0.3; munition = \"bomb\"; point = [25110.0, 25110.0]; } );"

#define CONTACTS 7u

static char name[SEGMENT_NAME_MAX];
static struct error_text error;

/* The set in one process: each stage in its role, attached anew with every start. */
struct set {
    struct view mover_view, collider_view;
    struct mover mover;
    struct collider collider;
};

static void start(struct set *set)
{
    if (segment_attach(&set->mover_view, name, ROLE_MOVER, &error) != 0 ||
        segment_attach(&set->collider_view, name, ROLE_COLLIDER, &error) != 0)
        fail_msg("%s", error.text);
    const struct crater *craters = set->mover_view.w[0].craters;
    assert_int_equal(mover_init(&set->mover, &set->mover_view.world, craters, NULL), 0);
    assert_int_equal(collider_init(&set->collider, &set->collider_view.world, craters, NULL), 0);
}

static void stop(struct set *set)
{
    mover_free(&set->mover);
    collider_free(&set->collider);
    segment_detach(&set->mover_view);
    segment_detach(&set->collider_view);
}

static void move(struct set *set)
{
    struct view *view = &set->mover_view;
    struct command_source sources[COMMAND_RING_COUNT];
    struct frame_protocol frame;
    assert_int_equal(frame_protocol_mover_begin(&frame, view), 0);
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        sources[i] = (struct command_source){view->commands[i]->slot, view->header->command_slots,
                                             frame.command_head[i]};
    mover_step(&set->mover, &view->w[(frame.number - 1) & 1], &view->m, sources);
    frame_protocol_mover_end(&frame, view);
}

static void collide(struct set *set)
{
    struct view *view = &set->collider_view;
    const struct event_ring ring = {view->events, view->header->event_slots};
    struct frame_protocol frame;
    assert_int_equal(frame_protocol_collider_begin(&frame, view), 0);
    collider_step(&set->collider, &view->w[(frame.number - 1) & 1], &view->m,
                  &view->w[frame.number & 1], &ring);
    frame_protocol_collider_end(&frame, view);
}

static uint64_t commit_of(const struct view *view)
{
    return atomic_load(&view->commit->commit);
}

static uint64_t moved_of(const struct view *view)
{
    return atomic_load(&view->moved_word->moved);
}

/* Runs until frame is committed; begins in the middle of one when the mover is ahead. */
static void run_to(uint64_t frame)
{
    struct set set;
    start(&set);
    while (commit_of(&set.mover_view) < frame) {
        if (moved_of(&set.mover_view) == commit_of(&set.mover_view))
            move(&set);
        collide(&set);
    }
    stop(&set);
}

static void move_one(void)
{
    struct set set;
    start(&set);
    move(&set);
    stop(&set);
}

/* --- a look at the object, and at all of it for writing ----------------------------------------*/

static struct view look;      /* a reader's */
static unsigned char *memory; /* the whole object, mapped writable */

/* Returns the writable address of the data that a reader sees at address. */
static unsigned char *place(const void *address)
{
    return memory + ((const unsigned char *)address - (const unsigned char *)look.base);
}

/* Gives frame 0 contacts of neighbouring ids, which the frames after it keep. */
static void put_contacts(void)
{
    struct state first = look.w[0];
    first.head = (void *)place(first.head);
    first.hashes = (void *)place(first.hashes);
    first.written = (void *)place(first.written);
    first.contacts = (void *)place(first.contacts);
    for (uint32_t i = 0; i < CONTACTS; i++)
        first.contacts[i] = (struct persistent_contact){i + 1, i + 2, i,    i + 1, 1,           2,
                                                        0,     0,     0.0f, {{0}}, {{{0}, {0}}}};
    first.head->contact_count = CONTACTS;
    state_seal(&first, look.header->counts.fixed);
}

static int make_world(void **state)
{
    struct segment_paths paths;
    (void)state;
    named_world_make(name, SCENARIO);
    named_world_paths(&paths, name);
    if (segment_attach(&look, name, ROLE_NONE, &error) != 0)
        return -1;
    int fd = open(paths.object, O_RDWR | O_CLOEXEC);
    memory = mmap(NULL, look.layout.total, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (memory == MAP_FAILED)
        return -1;
    put_contacts();
    return 0;
}

static int remove_world(void **state)
{
    (void)state;
    munmap(memory, look.layout.total);
    segment_detach(&look);
    named_world_remove(name);
    return 0;
}

struct ending {
    uint64_t digest, event_digest, events, commands;
};

static struct ending ending_at(uint64_t frame)
{
    const struct state *last = &look.w[frame & 1];
    assert_int_equal(commit_of(&look), frame);
    if (segment_check_state(&look, frame, &error) != 0)
        fail_msg("%s", error.text);
    return (struct ending){state_digest(&look.world, last), last->head->event_digest,
                           last->head->event_end, last->head->tally.commands};
}

static void check_ending(struct ending got, struct ending right)
{
    assert_int_equal(got.events, right.events);
    assert_int_equal(got.event_digest, right.event_digest);
    assert_int_equal(got.commands, right.commands);
    assert_int_equal(got.digest, right.digest);
}

static struct ending undisturbed(uint64_t frame)
{
    void *none = NULL;
    make_world(&none);
    run_to(frame);
    struct ending ending = ending_at(frame);
    assert_true(ending.events > 20);
    assert_true(look.w[frame & 1].head->crater_count >= 2);
    remove_world(&none);
    return ending;
}

static void repaired(int wanted, const char *words)
{
    int result = segment_repair(name, &error);
    if (result != wanted || !strstr(error.text, words))
        fail_msg("%d, not %d with \"%s\": %s", result, wanted, words, error.text);
}

/* --- the committed world -----------------------------------------------------------------------*/

static void test_good_world_is_left_alone(void **state)
{
    (void)state;
    run_to(9);
    repaired(0, "good at frame 9");
    move_one();
    repaired(0, "good at frame 9");
    assert_int_equal(moved_of(&look), 10); /* the moved table stays */
}

static void test_every_bit_of_the_head_is_found(void **state)
{
    (void)state;
    run_to(30);
    unsigned char *head = place(look.w[0].head);
    for (size_t bit = 0; bit < offsetof(struct state_head, debris) * 8; bit++) {
        head[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        if (segment_check_state(&look, 30, &error) == 0)
            fail_msg("bit %zu of byte %zu", bit % 8, bit / 8);
        head[bit / 8] ^= (unsigned char)(1u << (bit % 8));
    }
    assert_int_equal(segment_check_state(&look, 30, &error), 0);
}

static unsigned char *random_cell(const struct entities *entities, uint32_t used, uint64_t *random)
{
    unsigned char *cells[64];
    size_t sizes[64];
    uint32_t columns = 0;
    uint64_t row = fixture_random(random) % used;
#define X(type, column)                                                                            \
    cells[columns] = place(&entities->row[row].column);                                            \
    sizes[columns++] = sizeof(type);
    ENTITY_FIELDS(X)
#undef X
    uint64_t column = fixture_random(random) % columns;
    return cells[column] + fixture_random(random) % sizes[column];
}

/* Returns a byte of the last frame: its head, a row of a column, damage, contacts, its own
 * craters. */
static unsigned char *random_byte(const struct state *last, const struct state *before,
                                  uint64_t *random)
{
    uint64_t where = fixture_random(random) % 8, at = fixture_random(random);
    if (where == 0)
        return place(last->head) + at % offsetof(struct state_head, debris);
    if (where == 1)
        return place(last->fixed_damage) + at % look.header->counts.fixed;
    if (where == 2 && last->head->crater_count > before->head->crater_count)
        return place(&last->craters[before->head->crater_count]) + at % sizeof *last->craters;
    if (where == 3 && last->head->dent_count > before->head->dent_count)
        return place(&last->dents[before->head->dent_count]) + at % sizeof *last->dents;
    if (where == 4 && last->head->contact_count > 0)
        return place(last->contacts) + at % (last->head->contact_count * sizeof *last->contacts);
    return random_cell(&last->entities, last->head->used, random);
}

static void test_flipped_bits_of_the_last_frame_change_nothing_in_the_end(void **state)
{
    enum { FRAMES = 160 };
    struct ending right = undisturbed(FRAMES);
    uint64_t random = fixture_seed(21);
    void *none = NULL;
    (void)state;
    make_world(&none);
    for (uint64_t frame = 2; frame < FRAMES; frame += 2) {
        run_to(frame);
        if (fixture_random(&random) % 2)
            move_one(); /* the moved table is the next frame's: the commands are taken again */
        unsigned char *byte = random_byte(&look.w[frame & 1], &look.w[~frame & 1], &random);
        *byte ^= (unsigned char)(1u << (fixture_random(&random) % 8));
        if (segment_check_state(&look, frame, &error) == 0)
            fail_msg("not found in frame %d", (int)frame);
        repaired(1, "the newest whole one");
        assert_int_equal(commit_of(&look), frame - 1);
    }
    run_to(FRAMES);
    check_ending(ending_at(FRAMES), right);
    remove_world(&none);
}

static void test_damage_in_both_buffers_is_refused_and_named(void **state)
{
    (void)state;
    run_to(12);
    unsigned char *a = place(&look.w[0].entities.row[3].x),
                  *b = place(&look.w[1].entities.row[5].y);
    *a ^= 4;
    *b ^= 8;
    repaired(-1, "both buffers: frame 12 fails its checksum (world A");
    assert_non_null(strstr(error.text, "frame 11 fails its checksum (world B"));
    assert_int_equal(commit_of(&look), 12); /* nothing has changed */
    *a ^= 4;
    *b ^= 8;
    repaired(0, "good at frame 12");
}

static void test_damaged_crater_of_long_ago_is_refused(void **state)
{
    (void)state;
    run_to(150);
    assert_true(look.w[0].head->crater_count >= 2);
    unsigned char *crater = place(&look.w[0].craters[0]);
    *crater ^= 1;
    repaired(-1, "both buffers");
    assert_non_null(strstr(error.text, "craters"));
    *crater ^= 1;
}

static void test_damaged_ground_is_refused(void **state)
{
    (void)state;
    *place(look.world.terrain.posts) ^= 1;
    repaired(-1, "posts");
    *place(look.world.terrain.posts) ^= 1;
    repaired(0, "good");
}

/* --- the moved table ---------------------------------------------------------------------------*/

static void test_flipped_bits_of_the_moved_table_are_moved_again(void **state)
{
    enum { FRAMES = 120 };
    struct ending right = undisturbed(FRAMES);
    uint64_t random = fixture_seed(22);
    void *none = NULL;
    (void)state;
    make_world(&none);
    for (uint64_t frame = 1; frame < FRAMES; frame++) {
        run_to(frame);
        move_one();
        unsigned char *byte = random_cell(&look.m.entities, look.m.head->used, &random);
        uint64_t where = fixture_random(&random) % 4;
        if (where == 0)
            byte = place(look.m.head) + offsetof(struct state_head, tick);
        if (where == 1 && look.m.head->intent_count > 0)
            byte = place(look.m.intents) + fixture_random(&random) % sizeof *look.m.intents;
        *byte ^= (unsigned char)(1u << (fixture_random(&random) % 8));
        if (segment_check_moved(&look, frame + 1, &error) == 0)
            fail_msg("not found in frame %d", (int)frame);
        repaired(1, "is moved again");
        assert_int_equal(commit_of(&look), frame);
        assert_int_equal(moved_of(&look), frame);
    }
    run_to(FRAMES);
    check_ending(ending_at(FRAMES), right);
    remove_world(&none);
}

/* --- the words ---------------------------------------------------------------------------------*/

static void test_flipped_bits_of_the_words(void **state)
{
    enum { FRAMES = 70 };
    struct ending right = undisturbed(FRAMES + 64);
    void *none = NULL;
    (void)state;
    for (int word = 0; word < 2; word++) {
        make_world(&none);
        for (uint64_t bit = 0; bit < 64; bit++) {
            const _Atomic uint64_t *at = word == 0 ? &look.commit->commit : &look.moved_word->moved;
            run_to(FRAMES + bit);
            *(uint64_t *)(void *)place(at) ^= (uint64_t)1 << bit;
            assert_true(segment_repair(name, &error) >= 0); /* one bit may look right */
            repaired(0, "good");
            assert_true(commit_of(&look) + 1 >= FRAMES + bit);
        }
        run_to(FRAMES + 64);
        check_ending(ending_at(FRAMES + 64), right);
        remove_world(&none);
    }
}

/* --- commands ----------------------------------------------------------------------------------*/

/* Sends commands first .. end - 1: shells without a shooter. */
static void send(uint64_t first, uint64_t end)
{
    struct view sender;
    if (segment_attach(&sender, name, ROLE_INTAKE, &error) != 0)
        fail_msg("%s", error.text);
    for (uint64_t i = first; i < end; i++) {
        struct command command = {
            .source = 7,
            .source_sequence = i,
            .type = COMMAND_FIRE,
            .kind = kind_find(look.world.kinds, look.world.counts.kinds, "artillery"),
            .value = {25100.0, 25100.0}};
        assert_int_equal(command_put(&sender, RING_CLIENTS, &command), 0);
    }
    segment_detach(&sender);
}

/* Command 1 is applied in frame 11 and command 2, which came after it, in frame 12: also when frame
 * 11 is made again while both lie in the ring. */
static void test_frame_made_again_takes_the_commands_that_it_took(void **state)
{
    struct ending right = {0};
    (void)state;
    for (int variant = 0; variant < 3; variant++) {
        void *none = NULL;
        make_world(&none);
        run_to(10);
        send(1, 2);
        run_to(11);
        send(2, 3);
        if (variant == 2)
            move_one(); /* frame 11 must take its commands again */
        if (variant > 0) {
            *place(&look.w[1].entities.row[2].x) ^= 1;
            repaired(1, "goes on from frame 10");
            assert_int_equal(moved_of(&look), variant == 1 ? 11 : 10);
        }
        run_to(20);
        if (variant == 0)
            right = ending_at(20);
        check_ending(ending_at(20), right);
        assert_int_equal(right.commands, 2);
        remove_world(&none);
    }
}

static void test_overwritten_commands_prevent_the_repair(void **state)
{
    (void)state;
    run_to(10);
    send(1, 2);
    run_to(11);
    send(2, 2 + look.header->command_slots); /* as many as fit: the first is overwritten */
    unsigned char *byte = place(&look.w[1].entities.row[2].x);
    *byte ^= 1;
    repaired(-1, "frame 10 is whole, but ring 0 holds the last");
    *byte ^= 1;
}

/* --- who may repair ----------------------------------------------------------------------------*/

static void test_running_world_is_not_repaired(void **state)
{
    static const enum role writers[] = {ROLE_MOVER, ROLE_COLLIDER};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct view view;
        assert_int_equal(segment_attach(&view, name, writers[i], &error), 0);
        repaired(-1, "is running already");
        assert_false(error.damaged);
        segment_detach(&view);
    }
    repaired(0, "good at frame 0"); /* the refused repair holds no lock */
    assert_int_equal(segment_holder(name, ROLE_MOVER), 0);
    assert_int_equal(atomic_load(&look.slot[ROLE_MOVER]->starts), 1); /* a repair is no start */
}

static void test_no_world_and_no_name(void **state)
{
    (void)state;
    assert_int_equal(segment_repair("no-such-world", &error), -1);
    assert_non_null(strstr(error.text, "there is no world"));
    assert_int_equal(segment_repair("a/b", &error), -1);
    assert_non_null(strstr(error.text, "is no name"));
}

/* A reader copies during a repair, and finds one of the frames whole. */
static void test_snapshots_after_a_repair(void **state)
{
    struct snapshot snapshot;
    (void)state;
    run_to(9);
    assert_int_equal(snapshot_init(&snapshot, &look), 0);
    assert_int_equal(snapshot_take(&snapshot, &look), 0);
    *place(&look.w[1].entities.row[2].x) ^= 1;
    assert_int_equal(snapshot_take(&snapshot, &look), -1);
    repaired(1, "goes on from frame 8");
    assert_int_equal(snapshot_take(&snapshot, &look), 0);
    assert_int_equal(snapshot.head.frame, 8);
    snapshot_free(&snapshot);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_world, remove_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_good_world_is_left_alone),
        TEST(test_every_bit_of_the_head_is_found),
        cmocka_unit_test(test_flipped_bits_of_the_last_frame_change_nothing_in_the_end),
        TEST(test_damage_in_both_buffers_is_refused_and_named),
        TEST(test_damaged_crater_of_long_ago_is_refused),
        TEST(test_damaged_ground_is_refused),
        cmocka_unit_test(test_flipped_bits_of_the_moved_table_are_moved_again),
        cmocka_unit_test(test_flipped_bits_of_the_words),
        cmocka_unit_test(test_frame_made_again_takes_the_commands_that_it_took),
        TEST(test_overwritten_commands_prevent_the_repair),
        TEST(test_running_world_is_not_repaired),
        TEST(test_no_world_and_no_name),
        TEST(test_snapshots_after_a_repair),
    };
    return cmocka_run_group_tests(tests, NULL, named_world_check_left);
}
