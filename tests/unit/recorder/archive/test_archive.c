/* Images: the content is restored, and a world continues from an image like an uninterrupted
 * one. */
#include "ipc/frame/command_ring.h"
#include "ipc/frame/event_cursor.h"
#include "recorder/archive/image_read.h"
#include "recorder/archive/image_write.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"
#include "tests/support/image_file.h"
#include "tests/support/stage.h"
#include "tests/support/steps.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* A scenario with shots, craters, dents and broken trees within a second. */
static const char battle[] =
    "world = { seed = 5; capacity = 96; pace = \"max\"; };\n"
    "objects = ( { kind = \"tree\"; at = [25040.0, 25010.0]; },"
    "  { kind = \"tree\"; at = [25010.0, 25040.0]; } );\n"
    "vehicles = ( { kind = \"jeep\"; at = [24900.0, 24900.0]; heading_deg = 90.0; speed_mps = "
    "20.0; },"
    "  { kind = \"jeep\"; at = [24906.0, 24900.0]; heading_deg = 270.0; speed_mps = 20.0; },"
    "  { kind = \"tank\"; count = 10; force = \"blue\"; fire_at_will = true;"
    "    area = [25000.0, 25000.0, 25120.0, 25120.0]; behaviour = \"patrol\"; },"
    "  { kind = \"jeep\"; count = 10; force = \"red\"; fire_at_will = true;"
    "    area = [25000.0, 25000.0, 25120.0, 25120.0]; behaviour = \"patrol\"; } );\n"
    "fires = ( { at_s = 0.1; munition = \"artillery\"; point = [25050.0, 25050.0]; },"
    "  { at_s = 0.5; munition = \"artillery\"; point = [25020.0, 25020.0]; } );\n";

static char path[PATH_MAX];

static const struct state_head *head_of(const struct view *view)
{
    return view->w[atomic_load(&view->commit->commit) & 1].head;
}

#define ORDERS (750u * COMMAND_RING_COUNT) /* a ring of this world holds 1024 */

/* Sends drive commands to the first rows, each different. */
static void send_orders(struct fixture *f, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        steps_send(f, (enum command_ring)(i % COMMAND_RING_COUNT),
                   (struct command){.type = COMMAND_DRIVE,
                                    .source = 77,
                                    .source_sequence = i + 1,
                                    .entity = 1 + i % 20,
                                    .value = {1.0, (double)(i % 7) / 7.0 - 0.5, 0.0}});
}

static void test_world_continues_like_an_uninterrupted_one(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    fixture_run(&f, 90);
    assert_true(head_of(&f.view)->crater_count > 0);
    assert_true(head_of(&f.view)->dent_count > 0);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    assert_memory_equal(head_of(&again), head_of(&f.view), sizeof(struct state_head));
    for (uint64_t frame = 100; frame <= 300; frame += 50) {
        image_file_run(&again, frame);
        fixture_run(&f, (uint32_t)(frame - head_of(&f.view)->frame));
        assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    }
    assert_true(head_of(&f.view)->tally.collisions > 0);
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_contacts_are_in_the_image(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    fixture_run(&f, 3);
    struct state now = fixture_state(&f);
    const struct persistent_contact contacts[] = {
        {1, 2, 0, 1, 1, 2, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
        {3, PERSISTENT_CONTACT_FIXED | 1, 2, SLOT_NONE, 2, 2, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}}};
    memcpy(now.contacts, contacts, sizeof contacts);
    now.head->contact_count = 2;
    state_seal(&now, f.view.world.counts.fixed);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    assert_memory_equal(again.w[1].contacts, contacts, sizeof contacts);
    assert_int_equal(head_of(&again)->contact_count, 2);
    image_file_run(&again, 20);
    fixture_run(&f, 17);
    assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_waiting_commands_are_applied_in_their_frames(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    send_orders(&f, ORDERS); /* a frame takes 256 of each ring */
    fixture_run(&f, 2);
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        assert_int_equal(head_of(&f.view)->command_cursor[i], 512);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    for (uint64_t frame = 3; frame <= 8; frame++) {
        image_file_run(&again, frame);
        fixture_run(&f, 1);
        assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    }
    assert_int_equal(head_of(&again)->tally.commands, ORDERS);
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_keys_of_commands_are_remembered(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    struct command command = {.type = COMMAND_PAUSE, .source = 9, .source_sequence = 1};
    assert_int_equal(command_put(&f.view, RING_CLIENTS, &command), 0);
    fixture_run(&f, 3);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    assert_int_equal(command_put(&again, RING_CLIENTS, &command), -1);
    assert_int_equal(errno, EEXIST);
    command.source_sequence = 2;
    assert_int_equal(command_put(&again, RING_CLIENTS, &command), 0);
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_wrapped_ring_keeps_its_order(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    for (int i = 0; i < 5; i++) {
        send_orders(&f, 250 * COMMAND_RING_COUNT);
        fixture_run(&f, 1);
    }
    send_orders(&f, 200 * COMMAND_RING_COUNT);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    for (int ring = 0; ring < COMMAND_RING_COUNT; ring++) {
        const struct command *slot = f.view.commands[ring]->slot;
        uint64_t end = atomic_load(&f.view.commands[ring]->head), slots = 1024;
        assert_int_equal(end, 5 * 250 + 200);
        assert_int_equal(atomic_load(&again.commands[ring]->head), end);
        for (uint64_t i = end - slots + 1; i < end; i++)
            assert_memory_equal(&again.commands[ring]->slot[i & (slots - 1)],
                                &slot[i & (slots - 1)], sizeof *slot);
    }
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_inputs_of_the_frame_under_way_are_saved(void **state)
{
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    fixture_run(&f, 20);
    image_file_save(&f.view, path, true); /* the next frame is not moved yet: no inputs */
    image_file_load(&again, path);
    assert_int_equal(atomic_load(&again.moved_word->moved), 20);
    segment_abandon(&again);

    send_orders(&f, 10);
    frame_stepper_move(&f.stepper, NULL);
    uint64_t moved = steps_moved_hash(&f);
    image_file_save(&f.view, path, true);
    image_file_load(&again, path);
    assert_int_equal(atomic_load(&again.commit->commit), 20);
    assert_int_equal(atomic_load(&again.moved_word->moved), 21);
    struct fixture other = {.view = again};
    assert_int_equal(steps_moved_hash(&other), moved);
    image_file_run(&again, 40);
    fixture_run(&f, 20);
    assert_int_equal(image_file_digest(&again), fixture_digest(&f));
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_branch_has_other_settings_and_no_inputs(void **state)
{
    struct fixture f;
    struct view again;
    struct image image;
    struct error_text error;
    (void)state;
    fixture_open(&f, battle);
    fixture_run(&f, 20);
    frame_stepper_move(&f.stepper, NULL);
    image_file_save(&f.view, path, true);
    assert_int_equal(image_open(&image, path, &error), 0);
    assert_false(image_branches(&image));
    image.params.frame_limit = 1000;
    assert_false(image_branches(&image));
    image.params.seed = 6;
    assert_true(image_branches(&image));
    struct segment_header header = image_segment(&image);
    assert_int_equal(segment_private(&again, &header, &error), 0);
    assert_int_equal(image_load(&again, &image, &error), 0);
    assert_int_equal(atomic_load(&again.moved_word->moved), 20);
    assert_int_equal(again.world.params->seed, 6);
    image_file_run(&again, 120);
    fixture_run(&f, 100);
    assert_int_equal(head_of(&again)->frame, head_of(&f.view)->frame);
    assert_int_not_equal(image_file_digest(&again), fixture_digest(&f));
    image_close(&image);
    segment_abandon(&again);
    fixture_close(&f);
}

static void test_capacities_cannot_be_changed(void **state)
{
    struct fixture f;
    struct view again;
    struct image image;
    struct error_text error;
    (void)state;
    fixture_open(&f, battle);
    image_file_save(&f.view, path, false);
    assert_int_equal(image_open(&image, path, &error), 0);
    struct segment_header header = image_segment(&image);
    assert_int_equal(segment_private(&again, &header, &error), 0);
    image.params.capacity++;
    assert_int_equal(image_load(&again, &image, &error), -1);
    assert_non_null(strstr(error.text, "params"));
    image.params.capacity--;
    image.params.contact_slots++;
    assert_int_equal(image_load(&again, &image, &error), -1);
    assert_non_null(strstr(error.text, "params"));
    image_close(&image);
    segment_abandon(&again);
    fixture_close(&f);
}

/* Events before the image are in no ring. They are skipped without a gap, and sequence numbers
 * continue. */
static void test_events_go_on_with_their_sequence(void **state)
{
    static struct event events[4096];
    struct event_cursor cursor = {0};
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    fixture_run(&f, 90);
    uint64_t end = head_of(&f.view)->event_end;
    assert_true(end > 0);
    image_file_save(&f.view, path, false);
    image_file_load(&again, path);
    assert_int_equal(again.header->first_event, end);
    assert_int_equal(events_read(&again, &cursor, events, 4096), 0);
    assert_int_equal(cursor.gap, 0);
    assert_int_equal(cursor.next, end);
    image_file_run(&again, 300);
    uint32_t count = events_read(&again, &cursor, events, 4096);
    assert_true(count > 0);
    assert_int_equal(events[0].sequence, end);
    assert_int_equal(cursor.gap, 0);
    segment_abandon(&again);
    fixture_close(&f);
}

/* --- images of a running world
 * ----------------------------------------------------------------- */

#define LAST_FRAME 300u
#define IMAGES     8

static uint64_t run_by_processes(const struct view *view)
{
    pid_t collider = stage_start(view, ROLE_COLLIDER, true);
    pid_t mover = stage_start(view, ROLE_MOVER, true);
    assert_int_equal(child_wait(mover), 0);
    assert_int_equal(child_wait(collider), 0);
    assert_int_equal(head_of(view)->frame, LAST_FRAME);
    return image_file_digest(view);
}

static void write_capture(struct view *view, const struct capture *capture, const char *file)
{
    struct image_place place;
    struct error_text error;
    assert_int_equal(image_place_open(&place, file, &error), 0);
    assert_int_equal(image_write(&place, view, capture, NULL, &error), 0);
    image_place_close(&place);
}

/* Mover and collider are processes that go on while images are taken: the first images with
 * commands waiting, every second one with the inputs of the frame under way. */
static void test_images_of_a_running_world(void **state)
{
    static const uint64_t at[IMAGES] = {0, 1, 2, 3, 20, 80, 140, 200};
    struct capture capture[IMAGES];
    struct fixture f;
    struct view again;
    (void)state;
    fixture_open(&f, battle);
    steps_params(&f)->frame_limit = LAST_FRAME;
    steps_params(&f)->pace = PACE_REAL; /* slow enough that images fall into its steps */
    steps_params(&f)->dt_s = 1.0 / (steps_params(&f)->hz = 400.0);
    send_orders(&f, ORDERS);
    for (int i = 0; i < IMAGES; i++)
        assert_int_equal(capture_init(&capture[i], &f.view), 0);
    pid_t collider = stage_start(&f.view, ROLE_COLLIDER, true);
    pid_t mover = stage_start(&f.view, ROLE_MOVER, true);
    for (int i = 0; i < IMAGES; i++) {
        while (at[i] > 0 &&
               frame_protocol_wait(&f.view, at[i] - 1, clock_now_ns() + NS_PER_S) < at[i])
            ;
        assert_int_equal(capture_take(&capture[i], &f.view, i % 2 == 1), 0);
        print_message("image %d is of frame %llu%s\n", i,
                      (unsigned long long)capture[i].snapshot.head.frame,
                      capture[i].inputs ? ", with inputs" : "");
    }
    assert_int_equal(child_wait(mover), 0);
    assert_int_equal(child_wait(collider), 0);
    assert_int_equal(head_of(&f.view)->tally.commands, ORDERS);
    for (int i = 0; i < IMAGES; i++) {
        write_capture(&f.view, &capture[i], path);
        image_file_load(&again, path);
        ((struct params *)(uintptr_t)again.world.params)->pace = PACE_MAX;
        assert_int_equal(run_by_processes(&again), fixture_digest(&f));
        segment_abandon(&again);
        capture_free(&capture[i]);
    }
    fixture_close(&f);
}

static int make_path(void **state)
{
    (void)state;
    image_file_path(path, "world.image");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_world_continues_like_an_uninterrupted_one),
        cmocka_unit_test(test_contacts_are_in_the_image),
        cmocka_unit_test(test_waiting_commands_are_applied_in_their_frames),
        cmocka_unit_test(test_keys_of_commands_are_remembered),
        cmocka_unit_test(test_wrapped_ring_keeps_its_order),
        cmocka_unit_test(test_inputs_of_the_frame_under_way_are_saved),
        cmocka_unit_test(test_branch_has_other_settings_and_no_inputs),
        cmocka_unit_test(test_capacities_cannot_be_changed),
        cmocka_unit_test(test_events_go_on_with_their_sequence),
        cmocka_unit_test(test_images_of_a_running_world),
    };
    return cmocka_run_group_tests(tests, make_path, NULL);
}
