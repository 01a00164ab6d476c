/* Every bit of what sizes, places and waits are computed from, flipped: attaching is refused by the
 * name of the field. Bits of the body: the next to take over finds them. */
#include "ipc/segment/segment.h"

#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_check.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
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
    unsigned char *memory; /* the whole object, writable as no process of a set has it */
    struct layout layout;
};

static struct world_file file;
static struct reason reason;

static int make_world(void **state)
{
    struct segment_paths paths;
    struct view view;
    (void)state;
    named_world_make(file.name, SCENARIO);
    named_world_paths(&paths, file.name);
    if (segment_attach(&view, file.name, ROLE_NONE, &reason) != 0)
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

struct place {
    size_t end; /* the field ends before this byte */
    const char *name;
};

#define END_OF(type, member)                                                                       \
    (offsetof(struct type, member) + sizeof(((const struct type *)0)->member))
#define HEADER(member)                                                                             \
    {                                                                                              \
        END_OF(segment_header, member), "header." #member                                          \
    }
#define PARAM(member)                                                                              \
    {                                                                                              \
        END_OF(params, member), "params." #member                                                  \
    }

/* Flips every bit of count bytes at a place of the object, and wants each refused by its name. */
static void check_flips(size_t at, size_t count, const struct place *place)
{
    for (size_t byte = 0; byte < count; byte++) {
        while (byte >= place->end)
            place++;
        for (int bit = 0; bit < 8; bit++) {
            struct view view;
            file.memory[at + byte] ^= (unsigned char)(1u << bit);
            int result = segment_attach(&view, file.name, ROLE_NONE, &reason);
            file.memory[at + byte] ^= (unsigned char)(1u << bit);
            if (result == 0)
                fail_msg("attached with bit %d of byte %zu flipped (%s)", bit, byte, place->name);
            if (!strstr(reason.text, place->name))
                fail_msg("\"%s\" is not in: %s", place->name, reason.text);
        }
    }
    struct view view;
    if (segment_attach(&view, file.name, ROLE_MOVER, &reason) != 0)
        fail_msg("%s", reason.text);
    segment_detach(&view);
}

static void test_every_bit_of_the_header(void **state)
{
    static const struct place places[] = {
        {END_OF(segment_header, magic), "magic"},
        HEADER(version),
        HEADER(header_bytes),
        HEADER(layout_hash),
        HEADER(total_bytes),
        HEADER(static_hash),
        HEADER(counts.kinds),
        HEADER(counts.models),
        HEADER(counts.model_vertices),
        HEADER(counts.model_triangles),
        HEADER(counts.hulls),
        HEADER(counts.hull_vertices),
        HEADER(counts.hull_planes),
        HEADER(counts.posts_side),
        HEADER(counts.fixed),
        HEADER(counts.reach),
        HEADER(counts.areas),
        HEADER(counts.routes),
        HEADER(counts.route_points),
        HEADER(counts.fires),
        HEADER(counts.road_points),
        HEADER(counts.names),
        HEADER(counts.formations),
        HEADER(counts.scripts),
        HEADER(counts.script_steps),
        HEADER(counts.recipe),
        HEADER(capacity),
        HEADER(event_slots),
        HEADER(intents_per_frame),
        HEADER(command_slots),
        HEADER(crater_slots),
        HEADER(dent_slots),
        HEADER(made),
        HEADER(origin),
        HEADER(first_event),
        HEADER(head_hash),
    };
    (void)state;
    check_flips(0, sizeof(struct segment_header), places);
}

static void test_every_bit_of_the_parameters(void **state)
{
    static const struct place places[] = {
        PARAM(name),
        PARAM(scenario),
        PARAM(seed),
        PARAM(scenario_hash),
        PARAM(frame_limit),
        PARAM(hz),
        PARAM(dt_s),
        PARAM(pace),
        PARAM(capacity),
        PARAM(event_slots),
        PARAM(events_per_frame),
        PARAM(intents_per_frame),
        PARAM(command_slots),
        PARAM(crater_slots),
        PARAM(dent_slots),
        {offsetof(struct params, initial_entities), "params"},
        PARAM(initial_entities),
        PARAM(collision),
        PARAM(base),
        PARAM(renderer),
    };
    (void)state;
    check_flips(file.layout.offset[REGION_PARAMS], sizeof(struct params), places);
}

/* A value is named with the one it had. */
static void test_the_refusal_says_what_was(void **state)
{
    struct segment_header *header = (struct segment_header *)(void *)file.memory;
    char wanted[96];
    struct view view;
    (void)state;
    uint32_t was = header->capacity;
    header->capacity ^= 8;
    snprintf(wanted, sizeof wanted, "header.capacity is damaged: it is %u and was %u", was ^ 8,
             was);
    assert_int_equal(segment_attach(&view, file.name, ROLE_NONE, &reason), -1);
    assert_non_null(strstr(reason.text, wanted));
    header->capacity ^= 8;
}

/* Bits between the fields' ends and the next page mean nothing: the world attaches and is good. */
static void test_bits_behind_the_header_are_harmless(void **state)
{
    (void)state;
    for (size_t byte = sizeof(struct segment_header); byte < file.layout.offset[REGION_PARAMS];
         byte += 61) {
        struct view view;
        file.memory[byte] ^= 0xff;
        if (segment_attach(&view, file.name, ROLE_NONE, &reason) != 0 ||
            segment_verify(&view, &reason) != 0)
            fail_msg("%s", reason.text);
        segment_detach(&view);
    }
}

/* Any bit of a region that never changes: verify names the region. */
static void test_bits_of_static_regions_are_found_by_region(void **state)
{
    uint64_t seed = fixture_seed(4);
    struct view view;
    (void)state;
    assert_int_equal(segment_attach(&view, file.name, ROLE_NONE, &reason), 0);
    for (int region = REGION_KINDS; region < REGION_COMMIT; region++) {
        for (int i = 0; i < 20 && file.layout.bytes[region] > 0; i++) {
            uint64_t at = fixture_random(&seed) % (file.layout.bytes[region] * 8);
            unsigned char *byte = &file.memory[file.layout.offset[region] + at / 8];
            *byte ^= (unsigned char)(1u << (at % 8));
            assert_int_equal(segment_verify(&view, &reason), -1);
            if (!strstr(reason.text, region_name((enum region)region)))
                fail_msg("%s is not in: %s", region_name((enum region)region), reason.text);
            *byte ^= (unsigned char)(1u << (at % 8));
        }
    }
    assert_int_equal(segment_verify(&view, &reason), 0);
    segment_detach(&view);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_world, remove_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_every_bit_of_the_header),
        TEST(test_every_bit_of_the_parameters),
        TEST(test_the_refusal_says_what_was),
        TEST(test_bits_behind_the_header_are_harmless),
        TEST(test_bits_of_static_regions_are_found_by_region),
    };
    return cmocka_run_group_tests(tests, NULL, named_world_check_left);
}
