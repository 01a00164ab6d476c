/* The writer of PDUs: what it writes is read as the same, field by field, for each type. */
#include "gateway/pdu/pdu_write.h"

#include "gateway/pdu/octets.h"
#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/pdu_read.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static uint8_t bytes[PDU_BYTES_MAX], again[PDU_BYTES_MAX];
static struct pdu pdu, back;

/* Octets of the wire that are finite in each kind of number, drawn at random. */
static void draw_bytes(const struct pdu_layout *layout, uint8_t parts, uint64_t *random)
{
    size_t length = layout->bytes + (size_t)PDU_PART_BYTES * parts;
    memset(bytes, 0, sizeof bytes);
    for (unsigned i = 0; i < layout->field_count; i++) {
        const struct pdu_field *field = &layout->fields[i];
        static const uint8_t size_of[] = {1, 2, 4, 4, 8, 6, 8, 8, 11};
        unsigned size = (unsigned)(size_of[field->kind] * field->count);
        for (unsigned k = 0; k < size; k++) {
            uint8_t octet = (uint8_t)fixture_random(random);
            bool number = field->kind == PDU_FIELD_F32 || field->kind == PDU_FIELD_F64;
            if (number && k % size_of[field->kind] == 0)
                octet = 0x41;
            if (field->kind == PDU_FIELD_MARKING)
                octet = (uint8_t)('A' + octet % 26);
            bytes[field->at + k] = octet;
        }
    }
    bytes[0] = 6 + (uint8_t)(fixture_random(random) % 2);
    bytes[1] = 7;
    bytes[2] = layout->type;
    bytes[3] = layout->family;
    octets_put_u32(bytes + 4, (uint32_t)fixture_random(random));
    octets_put_u16(bytes + 8, (uint16_t)length);
    bytes[10] = bytes[0] == 7 ? 6 : 0;
    bytes[17] = bytes[16] = 1; /* an id that is not reserved */
    if (layout->parts_at > 0)
        bytes[layout->parts_at] = parts;
    for (uint8_t *at = bytes + layout->bytes; at < bytes + length; at += PDU_PART_BYTES) {
        at[0] = (uint8_t)(fixture_random(random) % 2);
        octets_put_u32(at + 4, (uint32_t)fixture_random(random));
        octets_put_u16(at + 8, 0x4123);
        octets_put_u16(at + 10, (uint16_t)fixture_random(random));
    }
}

/* The writer writes each octet that the reader has read. So both have every field in its place. */
static void test_every_type_is_written_as_it_was_read(void **state)
{
    uint64_t random = fixture_seed(7);
    const struct pdu_layout *layout;
    (void)state;
    for (int round = 0; round < 200; round++) {
        for (unsigned i = 0; (layout = pdu_layout_at(i)) != NULL; i++) {
            draw_bytes(layout, layout->parts_at > 0 ? (uint8_t)(round % 5) : 0, &random);
            size_t length = octets_u16(bytes + 8);
            struct pdu_cursor cursor = {bytes, length, 0};
            assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
            memset(again, 0xee, sizeof again);
            assert_int_equal(pdu_write(&pdu, again, sizeof again), length);
            assert_memory_equal(again, bytes, length);
        }
    }
}

static void test_layouts_do_not_overlap(void **state)
{
    const struct pdu_layout *layout;
    (void)state;
    for (unsigned i = 0; (layout = pdu_layout_at(i)) != NULL; i++) {
        static const uint8_t size_of[] = {1, 2, 4, 4, 8, 6, 8, 8, 11};
        unsigned end = PDU_HEADER_BYTES;
        for (unsigned k = 0; k < layout->field_count; k++) {
            const struct pdu_field *field = &layout->fields[k];
            assert_true(field->at >= end);
            end = (unsigned)(field->at + size_of[field->kind] * field->count);
            assert_ptr_equal(pdu_layout_field(layout, field->name), field);
        }
        assert_true(end <= layout->bytes);
        assert_ptr_equal(pdu_layout_of(layout->type), layout);
        assert_ptr_equal(pdu_layout_named(layout->name), layout);
    }
    assert_null(pdu_layout_of(20));
    assert_null(pdu_layout_named("radio"));
}

static void test_what_is_not_written(void **state)
{
    (void)state;
    pdu = (struct pdu){.header = {.version = 7, .type = PDU_ENTITY_STATE}, .parts = 2};
    assert_int_equal(pdu_write(&pdu, bytes, 176), 176);
    assert_int_equal(pdu_write(&pdu, bytes, 175), 0);
    pdu.header.version = 5;
    assert_int_equal(pdu_write(&pdu, bytes, sizeof bytes), 0);
    pdu.header = (struct pdu_header){.version = 7, .type = 20};
    assert_int_equal(pdu_write(&pdu, bytes, sizeof bytes), 0);
}

/* Version 6 has zeros where version 7 has the status. */
static void test_the_status_of_versions(void **state)
{
    (void)state;
    for (uint8_t version = 6; version <= 7; version++) {
        pdu = (struct pdu){.header = {.version = version, .type = PDU_FIRE, .status = 6}};
        size_t size = pdu_write(&pdu, bytes, sizeof bytes);
        assert_int_equal(bytes[10], version == 7 ? 6 : 0);
        struct pdu_cursor cursor = {bytes, size, 0};
        assert_int_equal(pdu_read(&cursor, &back), PDU_GOOD);
        assert_int_equal(back.header.length, 96);
        assert_int_equal(back.header.family, PDU_FAMILY_WARFARE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_type_is_written_as_it_was_read),
        cmocka_unit_test(test_layouts_do_not_overlap),
        cmocka_unit_test(test_what_is_not_written),
        cmocka_unit_test(test_the_status_of_versions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
