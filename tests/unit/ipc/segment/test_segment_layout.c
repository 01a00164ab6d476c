/* The regions of a world: where the contacts of a world buffer lie. */
#include "ipc/segment/layout.h"

#include "tests/support/bare_view.h"
#include "world/entity/persistent_contact.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct segment_header header_of(uint32_t fixed, uint32_t contacts)
{
    return (struct segment_header){.counts = {.posts_side = 2, .fixed = fixed, .side_m = 50000},
                                   .capacity = 16,
                                   .event_slots = 64,
                                   .command_slots = 4,
                                   .input_slots = 4,
                                   .contact_slots = contacts};
}

/* The contacts follow the fixed damage on the next border, and end with their region. */
static void test_contacts_follow_the_fixed_damage(void **state)
{
    struct layout layout;
    (void)state;
    for (uint32_t fixed = 0; fixed <= 2 * TABLE_ALIGN; fixed++) {
        const struct segment_header header = header_of(fixed, 7);
        size_t offset = layout_contacts_offset(16, fixed), end = layout_table_bytes(16) + fixed;
        assert_int_equal(offset % TABLE_ALIGN, 0);
        assert_true(offset >= end && offset < end + TABLE_ALIGN);
        assert_int_equal(layout_compute(&layout, &header), 0);
        assert_int_equal(layout.bytes[REGION_WORLD_A],
                         offset + 7 * sizeof(struct persistent_contact));
        assert_int_equal(layout.bytes[REGION_WORLD_B], layout.bytes[REGION_WORLD_A]);
    }
}

static void test_each_buffer_has_its_own_contacts(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 8, .fixed = 5, .event_slots = 64, .events_per_frame = 8, .command_slots = 4};
    struct view view;
    (void)state;
    bare_view_make(&view, &sizes);
    for (int i = 0; i < 2; i++) {
        size_t at = view.layout.offset[REGION_WORLD_A + i] + layout_contacts_offset(8, 5);
        assert_ptr_equal(view.w[i].contacts, (unsigned char *)view.base + at);
    }
    segment_abandon(&view);
}

static void test_too_many_contacts_are_refused(void **state)
{
    struct segment_header header = header_of(0, PERSISTENT_CONTACT_SLOTS_MAX);
    struct layout layout;
    (void)state;
    assert_int_equal(layout_compute(&layout, &header), 0);
    header.contact_slots++;
    errno = 0;
    assert_int_equal(layout_compute(&layout, &header), -1);
    assert_int_equal(errno, EOVERFLOW);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contacts_follow_the_fixed_damage),
        cmocka_unit_test(test_each_buffer_has_its_own_contacts),
        cmocka_unit_test(test_too_many_contacts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
