/* The reader of PDUs: vectors that another program wrote, each fault of the table of bad input, and
 * datagrams that were cut or changed at random (SEED=n draws others). */
#include "gateway/pdu/pdu_read.h"

#include "gateway/pdu/octets.h"
#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/pdu_write.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char ENTITY_STATE_7[] =
    "0709010157c962fd00b006000015001600170202010100de01020100010100de01020107"
    "41080000bfa0000040a00000c1446fcbfa62456fc150d930e66da87a414c73f1f64fb118"
    "be800000bf000000c010000000408018040000000000000000000000000000003f000000"
    "3f800000be8000003d4ccccdbdcccccd3e99999a0154414e4b2037205245440000000011"
    "000300000000100b3fc00000000000000101000000000258020200e101010300";

static const char FIRE_6[] =
    "0609020257c962fd00600000000100020003000400050006000700080009000a000b000c"
    "0000004d414e848000000000c15312d0000000004136e36000000000020900e1020e0200"
    "03e807d00004003c3f8000004000000040400000458ca000";

static const char DETONATION_6[] =
    "0609030257c962fd00680000000100020003000400050006000700080009000a000b000c"
    "3f8000004000000040400000414e848000000000c15312d0000000004136e36000000000"
    "020200e1020d0100138803e8000100003f0000003e800000be00000001000000";

static const char STOP_FREEZE_5[] =
    "05090e0557c962fd00280000000100010000ffffffffffff000789b01234567803020000"
    "00000063";

static uint8_t bytes[PDU_BYTES_MAX];
static struct pdu pdu;

/* Writes the octets of a text of hexadecimal digits at an offset of bytes. Returns the offset
 * behind them. */
static size_t put(const char *hex, size_t at)
{
    for (; *hex != '\0'; hex += 2) {
        unsigned octet;
        assert_int_equal(sscanf(hex, "%2x", &octet), 1);
        bytes[at++] = (uint8_t)octet;
    }
    return at;
}

/* Reads the only PDU of a datagram. */
static enum pdu_result read_one(size_t size)
{
    struct pdu_cursor cursor = {bytes, size, 0};
    enum pdu_result result = pdu_read(&cursor, &pdu);
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_END);
    return result;
}

static void assert_id(struct pdu_id id, unsigned site, unsigned application, unsigned entity)
{
    assert_int_equal(id.site, site);
    assert_int_equal(id.application, application);
    assert_int_equal(id.entity, entity);
}

static void assert_type(struct pdu_entity_type type, const char *dotted)
{
    char text[64];
    snprintf(text, sizeof text, "%u.%u.%u.%u.%u.%u.%u", type.kind, type.domain, type.country,
             type.category, type.subcategory, type.specific, type.extra);
    assert_string_equal(text, dotted);
}

static void assert_floats(const float *value, double x, double y, double z)
{
    assert_true(value[0] == (float)x && value[1] == (float)y && value[2] == (float)z);
}

/* --- what is good ------------------------------------------------------------------------------*/

static void test_entity_state(void **state)
{
    (void)state;
    assert_int_equal(read_one(put(ENTITY_STATE_7, 0)), PDU_GOOD);
    const struct pdu_entity_state *entity = &pdu.entity_state;
    assert_int_equal(pdu.header.version, 7);
    assert_int_equal(pdu.header.exercise, 9);
    assert_int_equal(pdu.header.timestamp, 0x57c962fd);
    assert_int_equal(pdu.header.status, 6);
    assert_id(entity->id, 21, 22, 23);
    assert_int_equal(entity->force, PDU_FORCE_OPPOSING);
    assert_type(entity->type, "1.1.222.1.2.1.0");
    assert_type(entity->alternative_type, "1.1.222.1.2.1.7");
    assert_floats(entity->velocity, 8.5, -1.25, 5.0);
    assert_true(entity->location[0] == -2678679.956124 && entity->location[2] == 3729379.924307);
    assert_floats(entity->orientation, -0.25, -0.5, -2.25);
    assert_int_equal(entity->appearance,
                     PDU_APPEARANCE_ENGINE | PDU_APPEARANCE_FLAMES | PDU_APPEARANCE_DAMAGE(3));
    assert_int_equal(entity->dead_reckoning, 4);
    assert_floats(entity->acceleration, 0.5, 1.0, -0.25);
    assert_floats(entity->angular_velocity, 0.05, -0.1, 0.3);
    assert_string_equal(entity->marking, "TANK 7 RED");
    assert_int_equal(entity->capabilities, 0x11);
    assert_int_equal(pdu.parts, 2);
    assert_int_equal(pdu.part[0].type, PDU_TURRET_AZIMUTH);
    assert_true(pdu.part[0].value == 1.5f && pdu.part[0].change == 3);
    assert_int_equal(pdu.part[1].kind, PDU_PART_ATTACHED);
    assert_int_equal(pdu.part[1].type, 600);
    assert_type(pdu.part[1].carried, "2.2.225.1.1.3.0");
}

static void test_fire_and_detonation(void **state)
{
    (void)state;
    assert_int_equal(read_one(put(FIRE_6, 0)), PDU_GOOD);
    assert_id(pdu.fire.munition, 7, 8, 9);
    assert_id(pdu.fire.event, 10, 11, 12);
    assert_int_equal(pdu.fire.fire_mission, 77);
    assert_type(pdu.fire.munition_type, "2.9.225.2.14.2.0");
    assert_int_equal(pdu.fire.quantity, 4);
    assert_int_equal(pdu.fire.rate, 60);
    assert_true(pdu.fire.range == 4500.0f && pdu.fire.location[1] == -5e6);
    assert_int_equal(pdu.header.status, 0);
    assert_int_equal(read_one(put(DETONATION_6, 0)), PDU_GOOD);
    assert_id(pdu.detonation.target, 4, 5, 6);
    assert_int_equal(pdu.detonation.result, PDU_RESULT_ENTITY_IMPACT);
    assert_int_equal(pdu.detonation.warhead, 5000);
    assert_int_equal(pdu.detonation.fuse, 1000);
    assert_floats(pdu.detonation.point, 0.5, 0.25, -0.125);
}

static void test_version_5(void **state)
{
    (void)state;
    assert_int_equal(read_one(put(STOP_FREEZE_5, 0)), PDU_GOOD);
    assert_id(pdu.management.receiver, 0xffff, 0xffff, 0xffff);
    assert_int_equal(pdu.management.real_time.hours, 494000);
    assert_int_equal(pdu.management.reason, 3);
    assert_int_equal(pdu.management.frozen, 2);
    assert_int_equal(pdu.management.request, 99);
}

/* Writes a PDU of zeroes of a layout with a good identifier into bytes. */
static void put_empty(const struct pdu_layout *layout, uint8_t version)
{
    memset(bytes, 0, layout->bytes);
    bytes[0] = version;
    bytes[2] = layout->type;
    bytes[3] = layout->family;
    octets_put_u16(bytes + 8, layout->bytes);
    for (unsigned at = 12; at < 18; at += 2) /* a good id */
        octets_put_u16(bytes + at, 1);
}

/* Each type has the same octets in each version. The status is that of version 7 alone. */
static void test_versions_of_every_type(void **state)
{
    static struct pdu first;
    const struct pdu_layout *layout;
    (void)state;
    for (unsigned i = 0; (layout = pdu_layout_at(i)) != NULL; i++) {
        for (uint8_t version = PDU_VERSION_LEAST; version <= PDU_VERSION_MOST; version++) {
            memset(&pdu, 0, sizeof pdu);
            put_empty(layout, version);
            for (size_t at = 20; at < layout->bytes; at++)
                bytes[at] = (uint8_t)(at % 61); /* small numbers, whatever their kind */
            bytes[10] = 6;
            if (layout->parts_at > 0)
                bytes[layout->parts_at] = 0;
            assert_int_equal(read_one(layout->bytes), PDU_GOOD);
            assert_int_equal(pdu.header.version, version);
            assert_int_equal(pdu.header.status, version == 7 ? 6 : 0);
            if (version == PDU_VERSION_LEAST)
                first = pdu;
            first.header = pdu.header;
            assert_memory_equal(&first, &pdu, sizeof pdu);
        }
    }
}

static void test_a_bundle(void **state)
{
    (void)state;
    size_t size = put(STOP_FREEZE_5, put(ENTITY_STATE_7, put(FIRE_6, 0)));
    struct pdu_cursor cursor = {bytes, size, 0};
    static const uint8_t types[] = {PDU_FIRE, PDU_ENTITY_STATE, PDU_STOP_FREEZE};
    for (unsigned i = 0; i < 3; i++) {
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
        assert_int_equal(pdu.header.type, types[i]);
    }
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_END);
    memset(bytes + size, 0, PDU_HEADER_BYTES); /* a length of 0 behind the last */
    cursor = (struct pdu_cursor){bytes, size + PDU_HEADER_BYTES, 0};
    for (unsigned i = 0; i < 3; i++)
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_END);
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_END);
}

static void test_a_length_larger_than_needed(void **state)
{
    (void)state;
    size_t size = put(FIRE_6, 0);
    memset(bytes + size, 0xab, 20);
    octets_put_u16(bytes + 8, (uint16_t)(size + 20));
    size = put(STOP_FREEZE_5, size + 20);
    struct pdu_cursor cursor = {bytes, size, 0};
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
    assert_true(pdu.fire.range == 4500.0f);
    assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
    assert_int_equal(pdu.header.type, PDU_STOP_FREEZE);
}

static void test_unknown_types_are_stepped_over_and_counted(void **state)
{
    static const uint8_t types[] = {20, 25, 27, 41, 72, 137, 255};
    struct pdu_counts counts = {0};
    (void)state;
    for (unsigned i = 0; i < sizeof types; i++) {
        size_t size = put(STOP_FREEZE_5, put(FIRE_6, 0));
        bytes[2] = types[i];
        struct pdu_cursor cursor = {bytes, size, 0};
        enum pdu_result result = pdu_read(&cursor, &pdu);
        assert_int_equal(result, PDU_SKIPPED);
        assert_int_equal(pdu.header.type, types[i]);
        pdu_read_count(&counts, result, &pdu);
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
    }
    assert_int_equal(counts.result[PDU_SKIPPED], sizeof types);
    assert_int_equal(counts.type[41], 1);
}

static void test_unknown_variable_parameters_are_skipped(void **state)
{
    (void)state;
    size_t size = put(ENTITY_STATE_7, 0);
    bytes[144] = 4;
    octets_put_u32(bytes + 152, 0x7fc00000); /* no number there, but no number is read there */
    assert_int_equal(read_one(size), PDU_GOOD);
    assert_int_equal(pdu.parts, 1);
    assert_int_equal(pdu.parts_skipped, 1);
    assert_int_equal(pdu.part[0].kind, PDU_PART_ATTACHED);
}

static void test_a_marking_is_printable(void **state)
{
    (void)state;
    size_t size = put(ENTITY_STATE_7, 0);
    memcpy(bytes + 129, "a\n%n\x1b[2J\xff\x7f!", PDU_MARKING_MAX); /* without a NUL */
    assert_int_equal(read_one(size), PDU_GOOD);
    assert_string_equal(pdu.entity_state.marking, "a?%n?[2J?\?!");
}

/* --- what is bad -------------------------------------------------------------------------------*/

static void test_headers(void **state)
{
    (void)state;
    for (size_t size = 0; size < PDU_HEADER_BYTES; size++) {
        put(ENTITY_STATE_7, 0);
        assert_int_equal(read_one(size), PDU_BAD_HEADER);
    }
    struct pdu_cursor none = {NULL, 0, 0};
    assert_int_equal(pdu_read(&none, &pdu), PDU_BAD_HEADER);
    assert_int_equal(pdu_read(&none, &pdu), PDU_END);
    static const uint16_t lengths[] = {0, 1, 11, 177, 65535};
    for (unsigned i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        size_t size = put(ENTITY_STATE_7, 0);
        octets_put_u16(bytes + 8, lengths[i]);
        assert_int_equal(read_one(size), PDU_BAD_LENGTH);
    }
}

static void test_versions_and_families(void **state)
{
    (void)state;
    for (unsigned version = 0; version < 256; version++) {
        size_t size = put(FIRE_6, 0);
        bytes[0] = (uint8_t)version;
        assert_int_equal(read_one(size), version >= 5 && version <= 7 ? PDU_GOOD : PDU_BAD_VERSION);
    }
    for (unsigned family = 0; family < 256; family++) {
        size_t size = put(FIRE_6, 0);
        bytes[3] = (uint8_t)family;
        assert_int_equal(read_one(size), family == PDU_FAMILY_WARFARE ? PDU_GOOD : PDU_BAD_FAMILY);
    }
}

static void test_lengths_that_are_too_short(void **state)
{
    (void)state;
    const struct pdu_layout *layout;
    for (unsigned i = 0; (layout = pdu_layout_at(i)) != NULL; i++) {
        memset(bytes, 0, sizeof bytes);
        bytes[0] = 6;
        bytes[2] = layout->type;
        bytes[3] = layout->family;
        for (unsigned at = 12; at < 18; at += 2) /* a good id */
            octets_put_u16(bytes + at, 1);
        for (uint16_t length = PDU_HEADER_BYTES; length <= layout->bytes; length++) {
            octets_put_u16(bytes + 8, length);
            assert_int_equal(read_one(sizeof bytes > length ? length : 0),
                             length < layout->bytes ? PDU_TOO_SHORT : PDU_GOOD);
        }
    }
    size_t size = put(ENTITY_STATE_7, 0);
    bytes[19] = 3; /* parts, with room for two */
    assert_int_equal(read_one(size), PDU_TOO_SHORT);
    bytes[19] = 255;
    assert_int_equal(read_one(size), PDU_TOO_SHORT);
    octets_put_u16(bytes + 8, (uint16_t)(144 + 16 * 255));
    memset(bytes + size, 0, 144 + 16 * 255 - size);
    assert_int_equal(read_one(144 + 16 * 255), PDU_GOOD);
    assert_int_equal(pdu.parts, 255);
}

static void test_numbers_that_are_not_finite(void **state)
{
    static const double values[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300};
    (void)state;
    for (unsigned i = 0; i < sizeof values / sizeof values[0]; i++) {
        for (size_t at = 36; at < 84; at += at < 48 || at >= 72 ? 4 : 8) {
            size_t size = put(ENTITY_STATE_7, 0);
            if (at >= 48 && at < 72)
                octets_put_f64(bytes + at, values[i]);
            else
                octets_put_f32(bytes + at, i < 3 ? (float)values[i] : 3e38f);
            assert_int_equal(read_one(size), PDU_NOT_FINITE);
        }
        size_t size = put(ENTITY_STATE_7, 0);
        octets_put_f32(bytes + 152, i < 3 ? (float)values[i] : 3e38f); /* of a part */
        assert_int_equal(read_one(size), PDU_NOT_FINITE);
    }
}

/* Each number of each type is checked, not only those of an Entity State. */
static void test_every_number_of_every_type(void **state)
{
    const struct pdu_layout *layout;
    unsigned numbers = 0;
    (void)state;
    for (unsigned i = 0; (layout = pdu_layout_at(i)) != NULL; i++) {
        for (unsigned j = 0; j < layout->field_count; j++) {
            const struct pdu_field *field = &layout->fields[j];
            bool wide = field->kind == PDU_FIELD_F64;
            if (field->kind != PDU_FIELD_F32 && !wide)
                continue;
            for (unsigned k = 0; k < field->count; k++, numbers++) {
                put_empty(layout, 7);
                assert_int_equal(read_one(layout->bytes), PDU_GOOD);
                if (wide)
                    octets_put_f64(bytes + field->at + 8 * k, NAN);
                else
                    octets_put_f32(bytes + field->at + 4 * k, NAN);
                assert_int_equal(read_one(layout->bytes), PDU_NOT_FINITE);
            }
        }
    }
    assert_int_equal(numbers, 55);
}

/* A fault within a PDU costs that PDU; its neighbours in the datagram are read. */
static void test_a_fault_costs_its_own_pdu(void **state)
{
    static const struct {
        size_t at;
        uint8_t octet;
        enum pdu_result result;
    } faults[] = {{0, 4, PDU_BAD_VERSION}, {2, 27, PDU_SKIPPED},       {3, 9, PDU_BAD_FAMILY},
                  {19, 3, PDU_TOO_SHORT},  {36, 0x7f, PDU_NOT_FINITE}, {17, 0, PDU_BAD_ID}};
    (void)state;
    for (unsigned i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        size_t second = put(FIRE_6, 0);
        size_t size = put(STOP_FREEZE_5, put(ENTITY_STATE_7, second));
        struct pdu_cursor cursor = {bytes, size, 0};
        bytes[second + faults[i].at] = faults[i].octet;
        if (faults[i].at == 36)
            bytes[second + 37] = 0x80; /* infinite */
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
        assert_int_equal(pdu_read(&cursor, &pdu), faults[i].result);
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_GOOD);
        assert_int_equal(pdu.header.type, PDU_STOP_FREEZE);
        assert_int_equal(pdu_read(&cursor, &pdu), PDU_END);
    }
}

static void test_reserved_ids(void **state)
{
    static const struct {
        unsigned at;
        uint16_t number;
        enum pdu_result result;
    } rows[] = {{12, 0, PDU_BAD_ID},   {12, 0xffff, PDU_BAD_ID}, {12, 0xfffe, PDU_GOOD},
                {14, 0, PDU_BAD_ID},   {14, 0xffff, PDU_BAD_ID}, {14, 0xfffe, PDU_GOOD},
                {16, 0, PDU_BAD_ID},   {16, 0xffff, PDU_BAD_ID}, {16, 0xfffe, PDU_BAD_ID},
                {16, 0xfffd, PDU_GOOD}};
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        size_t size = put(ENTITY_STATE_7, 0);
        octets_put_u16(bytes + rows[i].at, rows[i].number);
        assert_int_equal(read_one(size), rows[i].result);
    }
}

/* Cuts and changes good datagrams. The reader must end, and a result must be one that can be
 * written again. The memory has the datagram's size, so that a sanitizer sees a read beyond it. */
static void test_damaged_datagrams(void **state)
{
    uint64_t seed = fixture_seed(1278), random = seed;
    uint64_t good = 0;
    static uint8_t written[PDU_BYTES_MAX], whole[PDU_BYTES_MAX];
    (void)state;
    size_t all = put(STOP_FREEZE_5, put(DETONATION_6, put(ENTITY_STATE_7, put(FIRE_6, 0))));
    memcpy(whole, bytes, all);
    for (int i = 0; i < 100000; i++) {
        size_t size = all;
        memcpy(bytes, whole, size);
        for (uint64_t n = fixture_random(&random) % 4; n > 0; n--)
            bytes[fixture_random(&random) % size] = (uint8_t)fixture_random(&random);
        if (i % 2 == 0)
            size = (size_t)(fixture_random(&random) % (size + 1));
        uint8_t *exact = malloc(size > 0 ? size : 1);
        assert_non_null(exact);
        memcpy(exact, bytes, size);
        struct pdu_cursor cursor = {exact, size, 0};
        enum pdu_result result;
        unsigned rounds = 0;
        while ((result = pdu_read(&cursor, &pdu)) != PDU_END) {
            assert_true(++rounds <= PDU_BYTES_MAX / PDU_HEADER_BYTES);
            if (result != PDU_GOOD)
                continue;
            good++;
            pdu.header.version = 7;
            assert_true(pdu_write(&pdu, written, sizeof written) > 0);
        }
        free(exact);
    }
    assert_true(good > 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_entity_state),
        cmocka_unit_test(test_fire_and_detonation),
        cmocka_unit_test(test_version_5),
        cmocka_unit_test(test_versions_of_every_type),
        cmocka_unit_test(test_a_bundle),
        cmocka_unit_test(test_a_length_larger_than_needed),
        cmocka_unit_test(test_unknown_types_are_stepped_over_and_counted),
        cmocka_unit_test(test_unknown_variable_parameters_are_skipped),
        cmocka_unit_test(test_a_marking_is_printable),
        cmocka_unit_test(test_headers),
        cmocka_unit_test(test_versions_and_families),
        cmocka_unit_test(test_lengths_that_are_too_short),
        cmocka_unit_test(test_numbers_that_are_not_finite),
        cmocka_unit_test(test_every_number_of_every_type),
        cmocka_unit_test(test_a_fault_costs_its_own_pdu),
        cmocka_unit_test(test_reserved_ids),
        cmocka_unit_test(test_damaged_datagrams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
