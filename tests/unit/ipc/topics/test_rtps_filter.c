/* The filter of datagrams with type information, fragments of discovery or wrong lengths, and the
 * reading of announcements. */
#include "ipc/topics/rtps_filter.h"

#include "world/maths/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LITTLE = 1, INLINE = 2, PAYLOAD = 4, KEY = 8 };

#define SPDP_WRITER      0x000100c2u
#define SEDP_WRITER      0x000003c2u
#define TYPE_REPLY       0x000301c3u
#define USER_WRITER      0x00000302u
#define TYPE_INFORMATION 0x75u
#define HIDDEN           0x8075u

struct datagram {
    uint8_t bytes[1024];
    size_t length, submessage;
    bool little;
};

static void put(struct datagram *datagram, uint32_t value, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        size_t shift = 8 * (datagram->little ? i : bytes - 1 - i);
        datagram->bytes[datagram->length++] = (uint8_t)(value >> shift);
    }
}

static void put_raw(struct datagram *datagram, uint32_t value)
{
    bool little = datagram->little;
    datagram->little = false;
    put(datagram, value, 4);
    datagram->little = little;
}

static void begin(struct datagram *datagram)
{
    memset(datagram, 0, sizeof *datagram);
    memcpy(datagram->bytes, "RTPS\2\1\1\20prefix-of-it", 20);
    datagram->length = 20;
}

/* A submessage's head; for DATA and DATA_FRAG up to the sequence number. */
static void begin_data(struct datagram *datagram, uint8_t kind, uint8_t flags, uint32_t writer)
{
    datagram->submessage = datagram->length;
    datagram->little = flags & LITTLE;
    datagram->bytes[datagram->length++] = kind;
    datagram->bytes[datagram->length++] = flags;
    put(datagram, 0, 2);
    put(datagram, 0, 2);
    put(datagram, kind == 0x16 ? 28 : 16, 2);
    put_raw(datagram, 0x000004c7);
    put_raw(datagram, writer);
    put(datagram, 0, 4);
    put(datagram, 1, 4);
    if (kind == 0x16)
        datagram->length += 12;
}

static void begin_payload(struct datagram *datagram)
{
    datagram->bytes[datagram->length + 1] = datagram->little ? 3 : 2;
    datagram->length += 4;
}

static size_t put_parameter(struct datagram *datagram, uint32_t id, uint32_t value)
{
    size_t at = datagram->length;
    put(datagram, id, 2);
    put(datagram, 4, 2);
    put(datagram, value, 4);
    return at;
}

static void put_locator(struct datagram *datagram, uint32_t id, uint32_t port, uint32_t address)
{
    put(datagram, id, 2);
    put(datagram, 24, 2);
    put(datagram, 1, 4);
    put(datagram, port, 4);
    datagram->length += 12;
    put_raw(datagram, address);
}

static void end_data(struct datagram *datagram)
{
    put(datagram, 1, 2);
    put(datagram, 0, 2);
    size_t end = datagram->length;
    datagram->length = datagram->submessage + 2;
    put(datagram, (uint32_t)(end - datagram->submessage - 4), 2);
    datagram->length = end;
}

static uint32_t id_at(const struct datagram *datagram, size_t at)
{
    uint32_t first = datagram->bytes[at], second = datagram->bytes[at + 1];
    return datagram->little ? second << 8 | first : first << 8 | second;
}

static void test_type_information_is_hidden(void **state)
{
    const uint32_t writers[] = {SEDP_WRITER, SPDP_WRITER, 0x000004c2, 0x000002c2, 0xff0003c2};
    struct rtps_announcement announcement;
    struct datagram datagram;
    (void)state;
    for (size_t i = 0; i < 5 * 2; i++) {
        begin(&datagram);
        begin_data(&datagram, 0x15, (uint8_t)(PAYLOAD | (i & 1)), writers[i / 2]);
        begin_payload(&datagram);
        size_t before = put_parameter(&datagram, 0x5a, 7);
        size_t at = put_parameter(&datagram, TYPE_INFORMATION, 7);
        end_data(&datagram);
        assert_true(rtps_filter(datagram.bytes, datagram.length, &announcement));
        assert_int_equal(id_at(&datagram, before), 0x5a);
        assert_int_equal(id_at(&datagram, at), HIDDEN);
    }
}

static void test_it_is_hidden_in_front_of_any_data_too(void **state)
{
    const uint8_t kinds[] = {0x15, 0x16};
    struct rtps_announcement announcement;
    struct datagram datagram;
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        begin(&datagram);
        begin_data(&datagram, 0x15, PAYLOAD | LITTLE, USER_WRITER);
        end_data(&datagram);
        begin_data(&datagram, kinds[i], INLINE | PAYLOAD | LITTLE, USER_WRITER);
        size_t at = put_parameter(&datagram, TYPE_INFORMATION, 7);
        end_data(&datagram);
        assert_true(rtps_filter(datagram.bytes, datagram.length, &announcement));
        assert_int_equal(id_at(&datagram, at), HIDDEN);
    }
}

static void test_user_data_is_left_alone(void **state)
{
    struct rtps_announcement announcement;
    struct datagram datagram;
    (void)state;
    begin(&datagram);
    begin_data(&datagram, 0x15, PAYLOAD | LITTLE, USER_WRITER);
    begin_payload(&datagram);
    put_parameter(&datagram, TYPE_INFORMATION, 7);
    end_data(&datagram);
    struct datagram before = datagram;
    assert_true(rtps_filter(datagram.bytes, datagram.length, &announcement));
    assert_memory_equal(datagram.bytes, before.bytes, before.length);
    assert_false(announcement.here || announcement.gone);
}

static void test_fragments_of_discovery_and_answers_are_dropped(void **state)
{
    const uint32_t writers[] = {SEDP_WRITER, SPDP_WRITER, TYPE_REPLY, USER_WRITER};
    struct rtps_announcement announcement;
    struct datagram datagram;
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        begin(&datagram);
        begin_data(&datagram, 0x16, PAYLOAD | LITTLE, writers[i]);
        end_data(&datagram);
        assert_int_equal(rtps_filter(datagram.bytes, datagram.length, &announcement), i == 3);
    }
    begin(&datagram);
    begin_data(&datagram, 0x15, PAYLOAD | LITTLE, TYPE_REPLY);
    end_data(&datagram);
    assert_false(rtps_filter(datagram.bytes, datagram.length, &announcement));
}

/* The announcement of a participant. flags are those of its DATA beside the byte order. */
static void announce(struct datagram *datagram, bool little, uint8_t flags, uint32_t locators)
{
    begin(datagram);
    begin_data(datagram, 0x15, (uint8_t)(flags | (little ? LITTLE : 0)), SPDP_WRITER);
    if (flags & INLINE) {
        size_t at = put_parameter(datagram, 0x71, 0);
        datagram->bytes[at + 7] = 3; /* disposed and unregistered */
        put(datagram, 1, 2);
        put(datagram, 0, 2);
    }
    begin_payload(datagram);
    put_parameter(datagram, 0x15, 0x01020000);
    for (uint32_t i = 0; i < locators; i++)
        put_locator(datagram, 0x32, 7410 + i, 0x7f000001);
    put_locator(datagram, 0x31, 9999, 0x7f000001);
    end_data(datagram);
}

static void test_an_announcement_says_where_to_answer(void **state)
{
    struct rtps_announcement said;
    struct datagram datagram;
    (void)state;
    for (uint32_t locators = 0; locators < RTPS_LOCATORS_MAX + 2; locators++) {
        announce(&datagram, locators & 1, PAYLOAD, locators);
        assert_true(rtps_announces(datagram.bytes, datagram.length));
        assert_true(rtps_filter(datagram.bytes, datagram.length, &said));
        assert_true(said.here && !said.gone);
        assert_memory_equal(said.prefix, "prefix-of-it", RTPS_PREFIX_BYTES);
        assert_int_equal(said.locator_count,
                         locators < RTPS_LOCATORS_MAX ? locators : RTPS_LOCATORS_MAX);
        for (uint32_t i = 0; i < said.locator_count; i++) {
            assert_int_equal(said.locator[i].port, 7410 + i);
            assert_memory_equal(&said.locator[i].address, "\x7f\0\0\1", 4);
        }
    }
}

static void test_a_leave_is_read(void **state)
{
    struct rtps_announcement said;
    struct datagram datagram;
    (void)state;
    announce(&datagram, true, INLINE | PAYLOAD, 1);
    assert_true(rtps_filter(datagram.bytes, datagram.length, &said));
    assert_true(said.gone && !said.here);
    announce(&datagram, true, KEY, 1);
    assert_true(rtps_filter(datagram.bytes, datagram.length, &said));
    assert_true(said.gone && !said.here);
}

static void test_an_announcement_is_known_by_its_beginning(void **state)
{
    struct datagram datagram;
    (void)state;
    announce(&datagram, true, PAYLOAD, 2);
    assert_true(rtps_announces(datagram.bytes, 20 + 24));
    begin(&datagram);
    begin_data(&datagram, 0x15, PAYLOAD | LITTLE, SEDP_WRITER);
    end_data(&datagram);
    assert_false(rtps_announces(datagram.bytes, datagram.length));
}

/* In a block of the exact length, so that a sanitizer finds each read beyond it. */
static void test_nothing_is_read_beyond_the_end(void **state)
{
    struct rtps_announcement said;
    struct datagram whole;
    (void)state;
    for (uint64_t trial = 0; trial < 20000; trial++) {
        announce(&whole, trial & 1, (uint8_t)(trial & (INLINE | PAYLOAD | KEY)),
                 (uint32_t)(trial % 3));
        begin_data(&whole, 0x15, INLINE | LITTLE, USER_WRITER);
        put_parameter(&whole, TYPE_INFORMATION, 7);
        end_data(&whole);
        for (uint64_t change = 0; change < trial % 5; change++) {
            uint64_t drawn = random_mix(trial * 8 + change);
            whole.bytes[drawn % whole.length] = (uint8_t)(drawn >> 32);
        }
        size_t length = random_mix(~trial) % (whole.length + 1);
        uint8_t *copy = malloc(length + !length);
        assert_non_null(copy);
        memcpy(copy, whole.bytes, length);
        (void)rtps_announces(copy, length);
        (void)rtps_filter(copy, length, &said);
        assert_true(said.locator_count <= RTPS_LOCATORS_MAX);
        free(copy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_type_information_is_hidden),
        cmocka_unit_test(test_it_is_hidden_in_front_of_any_data_too),
        cmocka_unit_test(test_user_data_is_left_alone),
        cmocka_unit_test(test_fragments_of_discovery_and_answers_are_dropped),
        cmocka_unit_test(test_an_announcement_says_where_to_answer),
        cmocka_unit_test(test_a_leave_is_read),
        cmocka_unit_test(test_an_announcement_is_known_by_its_beginning),
        cmocka_unit_test(test_nothing_is_read_beyond_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
