/* Checks of a frame: its counts and its contacts. */
#include "ipc/segment/frame_check.h"

#include "tests/support/bare_view.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define FIXED 5u

static struct view view;
static struct error_text error;

/* Frame 0 with three rows and three contacts, in order. */
static int make_view(void **state)
{
    const struct bare_sizes sizes = {.capacity = 8,
                                     .fixed = FIXED,
                                     .event_slots = 64,
                                     .events_per_frame = 8,
                                     .command_slots = 4};
    (void)state;
    bare_view_make(&view, &sizes);
    struct state *now = &view.w[0];
    now->head->used = 3;
    now->contacts[0] =
        (struct persistent_contact){1, 9, 0, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now->contacts[1] = (struct persistent_contact){
        1,           PERSISTENT_CONTACT_FIXED | (FIXED - 1), 0, SLOT_NONE, 1, 1, 0, 0, 0.0f, {{0}},
        {{{0}, {0}}}};
    now->contacts[2] =
        (struct persistent_contact){4, 9, 1, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now->head->contact_count = 3;
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    segment_abandon(&view);
    return 0;
}

static int check(void)
{
    error.text[0] = '\0';
    state_seal(&view.w[0], FIXED);
    return segment_check_state(&view, 0, &error);
}

static void test_sorted_contacts_are_good(void **state)
{
    (void)state;
    if (check() != 0)
        fail_msg("%s", error.text);
}

static void test_contacts_beyond_their_list_are_refused(void **state)
{
    struct state_head *head = view.w[0].head;
    (void)state;
    head->contact_count = 16;
    assert_int_equal(segment_check_head(&view, head, &error), 0);
    head->contact_count = 17;
    assert_int_equal(segment_check_head(&view, head, &error), -1);
    assert_string_equal(error.text, "contact_count = 17; contact_slots = 16");
    assert_int_equal(segment_check_state(&view, 0, &error), -1);
    assert_non_null(strstr(error.text, "contact_count = 17"));
}

static void test_debris_beyond_its_list_is_refused(void **state)
{
    struct state_head *head = view.w[0].head;
    uint32_t fixed = view.header->counts.fixed;
    (void)state;
    head->debris_count = DEBRIS_MAX + 1;
    assert_int_equal(segment_check_head(&view, head, &error), -1);
    assert_string_equal(error.text, "debris_count = 65; room for 64");
    head->debris_count = 1;
    head->debris[0].object = fixed;
    assert_int_equal(segment_check_head(&view, head, &error), -1);
    assert_non_null(strstr(error.text, "debris 0: object = "));
    assert_int_equal(segment_check_state(&view, 0, &error), -1);
}

static void test_batteries_beyond_their_list_are_refused(void **state)
{
    struct state_head *head = view.w[0].head;
    struct segment_header header = *view.header;
    struct view look = view;
    (void)state;
    header.counts.kinds = 1;
    look.header = &header;
    head->battery_count = 1;
    head->battery[0].guns = BATTERY_GUNS_MAX;
    assert_int_equal(segment_check_head(&look, head, &error), 0);
    head->battery[0].guns = BATTERY_GUNS_MAX + 1;
    assert_int_equal(segment_check_head(&look, head, &error), -1);
    assert_string_equal(error.text, "battery 0: guns = 9; at most 8");
    head->battery[0].guns = 0;
    head->battery[0].munition = UINT16_MAX;
    assert_int_equal(segment_check_head(&look, head, &error), -1);
    head->battery[0].munition = 0;
    head->battery_count = BATTERIES_MAX + 1;
    assert_int_equal(segment_check_head(&look, head, &error), -1);
    assert_string_equal(error.text, "battery_count = 9; at most 8");
    head->battery_count = 0;
}

static void test_changed_contact_fails_the_checksum(void **state)
{
    (void)state;
    assert_int_equal(check(), 0);
    view.w[0].contacts[2].pressed_tick++;
    assert_int_equal(segment_check_state(&view, 0, &error), -1);
    assert_non_null(strstr(error.text, "checksum"));
}

/* Each is wrong though its checksum fits. */
static void test_contacts_that_make_no_sense_are_refused(void **state)
{
#define FIXED_ID(index) (PERSISTENT_CONTACT_FIXED | (index))
    static const struct {
        uint32_t index;
        struct persistent_contact contact;
        const char *says;
    } rows[] = {
        {0,
         {1, 9, 3, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "world A: contact 0: a_row = 3; used = 3"},
        {0, {1, 9, 0, 3, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}}, "contact 0: b_row = 3; used = 3"},
        {0,
         {1, 9, 0, SLOT_NONE, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 0: b_row = 4294967295; used = 3"},
        {0, {0, 9, 0, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}}, "contact 0: a_id = 0; b_id = 9"},
        {0, {9, 9, 0, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}}, "contact 0: a_id = 9; b_id = 9"},
        {0, {9, 1, 2, 0, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}}, "contact 0: a_id = 9; b_id = 1"},
        {0,
         {FIXED_ID(1), FIXED_ID(2), 0, SLOT_NONE, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 0: a_id = 2147483649"},
        {1,
         {1, FIXED_ID(FIXED), 0, SLOT_NONE, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 1: b_id = fixed object 5; fixed objects = 5"},
        {1,
         {1, FIXED_ID(4), 0, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 1: b_row = 2; a fixed object has none"},
        {1,
         {1, 9, 0, 2, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 1: not in the order of ids"},
        {2,
         {1, FIXED_ID(3), 0, SLOT_NONE, 1, 1, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
         "contact 2: not in the order of ids"},
    };
#undef FIXED_ID
    struct persistent_contact *contacts = view.w[0].contacts;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct persistent_contact good = contacts[rows[i].index];
        contacts[rows[i].index] = rows[i].contact;
        assert_int_equal(check(), -1);
        if (!strstr(error.text, rows[i].says))
            fail_msg("\"%s\" does not say \"%s\"", error.text, rows[i].says);
        contacts[rows[i].index] = good;
    }
    assert_int_equal(check(), 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)
    const struct CMUnitTest tests[] = {
        TEST(test_sorted_contacts_are_good),
        TEST(test_contacts_beyond_their_list_are_refused),
        TEST(test_debris_beyond_its_list_is_refused),
        TEST(test_batteries_beyond_their_list_are_refused),
        TEST(test_changed_contact_fails_the_checksum),
        TEST(test_contacts_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
