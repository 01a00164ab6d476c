/* Captures: what is written is read again; packets that are damaged or of other kinds are stepped
 * over; recordings of other simulators, where there are some, have the right PDUs. */
#include "gateway/tool/capture.h"

#include "gateway/pdu/pdu_read.h"
#include "gateway/udp/udp_address.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char path[64];
static struct error_text error;

static int make_path(void **state)
{
    (void)state;
    snprintf(path, sizeof path, "/tmp/jolon-capture.%d", (int)getpid());
    unlink(path);
    return 0;
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

static struct udp_address address(const char *text)
{
    struct udp_address made;
    assert_int_equal(udp_address_parse(&made, text, 3000, &error), 0);
    return made;
}

/* Writes one datagram from one address to another with size octets of content. */
static void write_one(struct capture_writer *writer, const char *from, const char *to,
                      const uint8_t *bytes, size_t size, uint64_t time_us)
{
    struct capture_datagram datagram = {address(from), address(to), time_us, bytes, size};
    assert_int_equal(capture_write(writer, &datagram), 0);
}

static void assert_text(const struct udp_address *is, const char *right)
{
    char text[UDP_ADDRESS_TEXT];
    assert_string_equal(udp_address_text(is, text, sizeof text), right);
}

static void test_what_is_written_is_read(void **state)
{
    static uint8_t bytes[65000];
    static const size_t sizes[] = {0, 1, 144, 1400, 65000};
    uint64_t others = 0, random = fixture_seed(21);
    struct capture_datagram datagram;
    (void)state;
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)fixture_random(&random);
    struct capture_writer *writer = capture_create(path, &error);
    assert_non_null(writer);
    for (unsigned i = 0; i < 5; i++)
        write_one(writer, i % 2 == 0 ? "127.0.0.1:4000" : "[::1]:4000",
                  i % 2 == 0 ? "239.1.2.3:3000" : "[ff02::1]:3001", bytes, sizes[i],
                  1700000000123456u + i);
    assert_int_equal(capture_finish(writer), 0);
    assert_null(capture_create(path, &error)); /* no file is overwritten */
    struct capture_reader *reader = capture_open(path, &error);
    assert_non_null(reader);
    for (unsigned i = 0; i < 5; i++) {
        assert_int_equal(capture_read(reader, &datagram, &others, &error), 1);
        assert_int_equal(datagram.size, sizes[i]);
        assert_memory_equal(datagram.bytes, bytes, sizes[i]);
        assert_int_equal(datagram.time_us, 1700000000123456u + i);
        assert_text(&datagram.from, i % 2 == 0 ? "127.0.0.1:4000" : "[::1]:4000");
        assert_text(&datagram.to, i % 2 == 0 ? "239.1.2.3:3000" : "[ff02::1]:3001");
    }
    assert_int_equal(capture_read(reader, &datagram, &others, &error), 0);
    assert_int_equal(others, 0);
    capture_close(reader);
}

static void test_what_is_no_capture(void **state)
{
    (void)state;
    assert_null(capture_open("/nonexistent/file", &error));
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("this is no capture of packets at all", file);
    fclose(file);
    assert_null(capture_open(path, &error));
    assert_non_null(strstr(error.text, path));
    assert_null(capture_create("/nonexistent/file", &error));
}

/* Changes octets of a good capture, and cuts it. Reading must end, within the memory. */
static void test_damaged_captures(void **state)
{
    static uint8_t whole[4096], bytes[144];
    uint64_t random = fixture_seed(22);
    (void)state;
    struct capture_writer *writer = capture_create(path, &error);
    for (unsigned i = 0; i < 6; i++)
        write_one(writer, i < 3 ? "1.2.3.4" : "1::2", i < 3 ? "5.6.7.8" : "3::4", bytes,
                  sizeof bytes, i);
    assert_int_equal(capture_finish(writer), 0);
    FILE *file = fopen(path, "rb");
    size_t size = fread(whole, 1, sizeof whole, file), volume = 0;
    fclose(file);
    for (int i = 0; i < 500; i++) {
        static uint8_t damaged[sizeof whole];
        memcpy(damaged, whole, size);
        for (uint64_t n = 1 + fixture_random(&random) % 4; n > 0; n--)
            damaged[24 + fixture_random(&random) % (size - 24)] = (uint8_t)fixture_random(&random);
        file = fopen(path, "wb");
        fwrite(damaged, 1, i % 3 == 0 ? fixture_random(&random) % size : size, file);
        fclose(file);
        struct capture_reader *reader = capture_open(path, &error);
        struct capture_datagram datagram;
        uint64_t others = 0;
        while (reader && capture_read(reader, &datagram, &others, &error) == 1) {
            for (size_t k = 0; k < datagram.size; k++)
                volume += datagram.bytes[k]; /* a sanitizer sees a read beyond the packet */
        }
        if (reader)
            capture_close(reader);
    }
    assert_true(volume < SIZE_MAX);
}

/* --- recordings --------------------------------------------------------------------------------*/

/* Counts the PDUs of a recording, which lies beside the source tree. Skips the test without it. */
static struct pdu_counts read_recording(const char *name)
{
    static const char *const places[] = {"../*/data/dis/", "../../*/data/dis/"};
    struct pdu_counts counts = {0};
    struct capture_datagram datagram;
    static struct pdu pdu;
    glob_t found = {0};
    uint64_t others = 0;
    for (unsigned i = 0; i < 2 && found.gl_pathc == 0; i++) {
        char pattern[128];
        if (i > 0)
            globfree(&found);
        snprintf(pattern, sizeof pattern, "%s%s", places[i], name);
        glob(pattern, 0, NULL, &found);
    }
    if (found.gl_pathc == 0) {
        print_message("there is no recording %s\n", name);
        globfree(&found);
        skip();
    }
    struct capture_reader *reader = capture_open(found.gl_pathv[0], &error);
    globfree(&found);
    assert_non_null(reader);
    while (capture_read(reader, &datagram, &others, &error) == 1) {
        struct pdu_cursor cursor = {datagram.bytes, datagram.size, 0};
        enum pdu_result result;
        counts.datagrams++;
        while ((result = pdu_read(&cursor, &pdu)) != PDU_END)
            pdu_read_count(&counts, result, &pdu);
    }
    capture_close(reader);
    assert_int_equal(others, 0);
    return counts;
}

static void assert_types(const struct pdu_counts *counts, const uint64_t (*right)[2], size_t rows)
{
    uint64_t total = 0, all = 0;
    for (size_t i = 0; i < rows; i++) {
        assert_int_equal(counts->type[right[i][0]], right[i][1]);
        total += right[i][1];
    }
    for (unsigned type = 0; type < 256; type++)
        all += counts->type[type];
    assert_int_equal(all, total);
}

static void test_the_hand_built_recording(void **state)
{
    static const uint64_t right[][2] = {{1, 7},  {2, 2},  {3, 3},  {4, 2},  {11, 2},
                                        {12, 2}, {13, 2}, {14, 2}, {15, 2}, {21, 2},
                                        {41, 1}, {43, 1}, {66, 2}};
    (void)state;
    struct pdu_counts counts = read_recording("hand-built.pcap");
    assert_int_equal(counts.datagrams, 30);
    assert_int_equal(counts.result[PDU_GOOD], 26);
    assert_int_equal(counts.result[PDU_SKIPPED], 4);
    assert_types(&counts, right, sizeof right / sizeof right[0]);
}

static void test_the_recorded_exercise(void **state)
{
    static const uint64_t right[][2] = {{1, 191}, {20, 24}, {25, 16}, {41, 89}, {72, 211}};
    (void)state;
    struct pdu_counts counts = read_recording("recorded-gaz69-block.pcap");
    assert_int_equal(counts.datagrams, 320);
    assert_int_equal(counts.result[PDU_GOOD], 191);
    assert_int_equal(counts.result[PDU_SKIPPED], 340);
    assert_types(&counts, right, sizeof right / sizeof right[0]);
}

static void test_the_recorded_single_pdus(void **state)
{
    static const uint64_t right[][2] = {{1, 6},  {2, 2},  {3, 1},  {19, 2}, {20, 1},
                                        {23, 1}, {25, 8}, {26, 3}, {27, 2}, {28, 2},
                                        {29, 2}, {33, 3}, {137, 1}};
    (void)state;
    struct pdu_counts counts = read_recording("recorded-single-pdus.pcap");
    assert_int_equal(counts.datagrams, 35);
    assert_int_equal(counts.result[PDU_GOOD], 9);
    assert_int_equal(counts.result[PDU_SKIPPED], 25);
    assert_int_equal(counts.result[PDU_BAD_LENGTH], 1); /* one that is no PDU */
    assert_types(&counts, right, sizeof right / sizeof right[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_what_is_written_is_read, make_path, remove_file),
        cmocka_unit_test_setup_teardown(test_what_is_no_capture, make_path, remove_file),
        cmocka_unit_test_setup_teardown(test_damaged_captures, make_path, remove_file),
        cmocka_unit_test(test_the_hand_built_recording),
        cmocka_unit_test(test_the_recorded_exercise),
        cmocka_unit_test(test_the_recorded_single_pdus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
