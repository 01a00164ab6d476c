/* Flips every bit of the data from which sizes, offsets and waits are computed. Attaching refuses
 * each and names the region. segment_verify() finds flipped bits of regions that never change. */
#include "ipc/segment/segment_check.h"

#include "ipc/segment/segment_attach.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>

#include <cmocka.h>
#include <fcntl.h>
#include <unistd.h>

#define SCENARIO                                                                                   \
    "objects = ( { kind = \"tree\"; at = [1000.0, 1000.0]; } );"                                   \
    "vehicles = ( { kind = \"tank\"; name = \"T\"; area = [3000.0, 3000.0, 4000.0, 4000.0]; },"    \
    "{ kind = \"truck\"; route = ( [1000.0, 2000.0], [2000.0, 2000.0] ); } );"                     \
    "fires = ( { at_s = 1.0; munition = \"artillery\"; point = [5000.0, 5000.0]; } );"

struct world_file {
    char name[SEGMENT_NAME_MAX];
    unsigned char *memory; /* the whole object, mapped writable */
    struct layout layout;
};

static struct world_file file;
static struct error_text error;

static int make_world(void **state)
{
    struct segment_paths paths;
    struct view view;
    (void)state;
    named_world_make(file.name, SCENARIO);
    named_world_paths(&paths, file.name);
    if (segment_attach(&view, file.name, ROLE_NONE, &error) != 0)
        return -1;
    file.layout = view.layout;
    segment_detach(&view);
    int fd = open(paths.object, O_RDWR | O_CLOEXEC);
    file.memory = mmap(NULL, file.layout.total, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    return file.memory == MAP_FAILED ? -1 : 0;
}

static int remove_world(void **state)
{
    (void)state;
    munmap(file.memory, file.layout.total);
    named_world_remove(file.name);
    return 0;
}

/* Flips every bit of bytes first .. end - 1 of the object. Each must be refused with these
 * words. */
static void check_flips(size_t first, size_t end, const char *words)
{
    for (size_t byte = first; byte < end; byte++) {
        for (int bit = 0; bit < 8; bit++) {
            struct view view;
            file.memory[byte] ^= (unsigned char)(1u << bit);
            int result = segment_attach(&view, file.name, ROLE_NONE, &error);
            file.memory[byte] ^= (unsigned char)(1u << bit);
            if (result == 0)
                fail_msg("attached with bit %d of byte %zu flipped", bit, byte);
            if (error.foreign || !strstr(error.text, words))
                fail_msg("bit %d of byte %zu: \"%s\" is not in: %s", bit, byte, words, error.text);
        }
    }
    struct view view;
    if (segment_attach(&view, file.name, ROLE_MOVER, &error) != 0)
        fail_msg("%s", error.text);
    segment_detach(&view);
}

static void test_every_bit_of_the_header(void **state)
{
    const size_t magic = sizeof(uint64_t);
    (void)state;
    check_flips(0, magic, "magic");
    check_flips(magic, sizeof(struct segment_header), "header is damaged");
}

static void test_every_bit_of_the_parameters(void **state)
{
    size_t first = file.layout.offset[REGION_PARAMS];
    (void)state;
    check_flips(first, first + sizeof(struct params), "params are damaged");
}

/* Bits between the last field and the next page have no meaning: the world attaches and is good. */
static void test_bits_behind_the_header_are_harmless(void **state)
{
    (void)state;
    for (size_t byte = sizeof(struct segment_header); byte < file.layout.offset[REGION_PARAMS];
         byte += 61) {
        struct view view;
        file.memory[byte] ^= 0xff;
        if (segment_attach(&view, file.name, ROLE_NONE, &error) != 0 ||
            segment_verify(&view, &error) != 0)
            fail_msg("%s", error.text);
        segment_detach(&view);
    }
}

/* Any bit of a region that never changes: verify names the region. */
static void test_bits_of_static_regions_are_found_by_region(void **state)
{
    uint64_t seed = fixture_seed(4);
    struct view view;
    (void)state;
    assert_int_equal(segment_attach(&view, file.name, ROLE_NONE, &error), 0);
    for (int region = REGION_KINDS; region < REGION_COMMIT; region++) {
        for (int i = 0; i < 20 && file.layout.bytes[region] > 0; i++) {
            uint64_t at = fixture_random(&seed) % (file.layout.bytes[region] * 8);
            unsigned char *byte = &file.memory[file.layout.offset[region] + at / 8];
            *byte ^= (unsigned char)(1u << (at % 8));
            assert_int_equal(segment_verify(&view, &error), -1);
            if (!strstr(error.text, region_name((enum region)region)))
                fail_msg("%s is not in: %s", region_name((enum region)region), error.text);
            *byte ^= (unsigned char)(1u << (at % 8));
        }
    }
    assert_int_equal(segment_verify(&view, &error), 0);
    segment_detach(&view);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_world, remove_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_every_bit_of_the_header),
        TEST(test_every_bit_of_the_parameters),
        TEST(test_bits_behind_the_header_are_harmless),
        TEST(test_bits_of_static_regions_are_found_by_region),
    };
    return cmocka_run_group_tests(tests, NULL, named_world_check_left);
}
