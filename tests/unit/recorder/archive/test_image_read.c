/* Damaged and forged images: each is refused in one line that says why, without another effect. */
#include "recorder/archive/image_read.h"

#include "ipc/frame/command_ring.h"
#include "tests/support/bare_view.h"
#include "tests/support/image_file.h"

#include "world/entity/persistent_contact.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include <cmocka.h>

static char good_path[PATH_MAX], path[PATH_MAX];
static unsigned char *good;
static size_t good_bytes;
static struct view view;

/* A minimal image that has every part: 3 frames, rows, damage, commands. */
static int make_image(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 8, .fixed = 5, .event_slots = 64, .events_per_frame = 8, .command_slots = 4};
    (void)state;
    bare_view_make(&view, &sizes);
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    for (int i = 0; i < 3; i++) {
        struct state *next = bare_view_begin(&collider);
        next->head->used = 3;
        next->head->event_end += 2;
        next->head->crater_count++;
        next->entities.row[i].x = 3.25 * i;
        next->contacts[0] =
            (struct persistent_contact){1, 2, 0, 1, 1, 2, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
        next->head->contact_count = 1;
        next->fixed_damage[i] = 2;
        bare_view_end(&collider);
    }
    const struct command command = {.source = 1, .source_sequence = 1};
    assert_int_equal(command_put(&view, RING_CLIENTS, &command), 0);
    image_file_path(good_path, "good.image");
    image_file_path(path, "bad.image");
    image_file_save(&view, good_path, false);
    good = image_file_bytes(good_path, &good_bytes);
    return 0;
}

static int drop_image(void **state)
{
    (void)state;
    free(good);
    segment_abandon(&view);
    return 0;
}

/* Opens and loads the image at path. Returns 0, or -1 with the reason. */
static int load(struct error_text *error)
{
    struct view again;
    struct image image;
    error->text[0] = '\0';
    if (image_open(&image, path, error) != 0)
        return -1;
    struct segment_header header = image_segment(&image);
    int result = segment_private(&again, &header, error);
    if (result == 0) {
        result = image_load(&again, &image, error);
        if (result == 0)
            assert_int_equal(image_file_digest(&again), image_file_digest(&view));
        segment_abandon(&again);
    }
    image_close(&image);
    return result;
}

/* Checks that the image is refused in one line that begins with the path and has this text. */
static void assert_refused(const void *bytes, size_t count, const char *says)
{
    struct error_text error;
    image_file_put(path, bytes, count);
    if (load(&error) == 0)
        fail_msg("not refused; wanted: %s", says);
    if (strncmp(error.text, path, strlen(path)) != 0 || strchr(error.text, '\n') ||
        !strstr(error.text, says))
        fail_msg("\"%s\" does not say \"%s\"", error.text, says);
}

static void test_good_image_is_loaded(void **state)
{
    struct error_text error;
    (void)state;
    print_message("%zu bytes\n", good_bytes);
    image_file_put(path, good, good_bytes);
    assert_int_equal(load(&error), 0);
}

static void test_every_flipped_byte_is_found(void **state)
{
    (void)state;
    for (size_t i = 0; i < good_bytes; i++) {
        unsigned char before = good[i];
        good[i] ^=
            (unsigned char)(1u << (i % 8)); /* over the file, every bit of a byte gets its turn */
        assert_refused(good, good_bytes, ": ");
        good[i] = (unsigned char)~before;
        assert_refused(good, good_bytes, ": ");
        good[i] = before;
    }
}

static void test_every_bit_of_the_header_is_found(void **state)
{
    (void)state;
    for (size_t bit = 0; bit < 8 * sizeof(struct image_header); bit++) {
        good[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        assert_refused(good, good_bytes, ": ");
        good[bit / 8] ^= (unsigned char)(1u << (bit % 8));
    }
}

static void test_every_other_length_is_refused(void **state)
{
    unsigned char *longer = calloc(1, good_bytes + 4096);
    (void)state;
    memcpy(longer, good, good_bytes);
    for (size_t bytes = 0; bytes < good_bytes; bytes++)
        assert_refused(longer, bytes, "size ");
    assert_refused(longer, good_bytes + 1, "something was added");
    assert_refused(longer, good_bytes + 4096, "something was added");
    free(longer);
}

/* --- wrong values with correct hashes
 * ---------------------------------------------------------- */

static struct image_header header_of_good(void)
{
    struct image_header header;
    memcpy(&header, good, sizeof header);
    return header;
}

static void assert_header_refused(struct image_header header, const char *says)
{
    unsigned char *bytes = malloc(good_bytes);
    assert_non_null(bytes);
    header.header_hash = image_header_hash(&header);
    memcpy(bytes, good, good_bytes);
    memcpy(bytes, &header, sizeof header);
    assert_refused(bytes, good_bytes, says);
    free(bytes);
}

#define REFUSED(field, value, says)                                                                \
    do {                                                                                           \
        struct image_header header = header_of_good();                                             \
        header.field = (value);                                                                    \
        assert_header_refused(header, says);                                                       \
    } while (0)

static void test_foreign_files_are_refused(void **state)
{
    (void)state;
    assert_refused("#!/bin/sh\n", 10, "too small");
    REFUSED(magic, SEGMENT_MAGIC, "magic");
    REFUSED(version, IMAGE_VERSION + 1, "version 7; this program knows 6");
    REFUSED(layout_hash, layout_hash() ^ 1, "another build");
    REFUSED(header_bytes, sizeof(struct image_header) + 8, "another build");
}

/* Sizes are checked against bounds before memory is allocated: none of these may allocate. */
static void test_sizes_beyond_bounds_are_refused(void **state)
{
    (void)state;
    REFUSED(segment.capacity, UINT32_MAX, "counts: out of range");
    REFUSED(segment.counts.fixed, UINT32_MAX, "counts: out of range");
    REFUSED(segment.counts.posts_side, 0, "counts: out of range");
    REFUSED(segment.command_slots, 3, "counts: out of range");
    REFUSED(used, 9, "counts: out of range");
    REFUSED(craters, 17, "counts: out of range");
    REFUSED(dents, 17, "counts: out of range");
    REFUSED(contacts, 17, "counts: out of range");
    REFUSED(segment.contact_slots, UINT32_MAX, "counts: out of range");
    REFUSED(inputs, 2, "counts: out of range");
    REFUSED(intents, UINT32_MAX, "counts: out of range");
    REFUSED(ring_end[0], UINT64_MAX, "counts: out of range");
    REFUSED(ring_first[RING_RECORDER], 1, "counts: out of range");
    REFUSED(used, 4, "sizes");
    REFUSED(craters, 4, "sizes");
    REFUSED(contacts, 2, "sizes");
    REFUSED(segment.counts.fixed, 6, "sizes");
    REFUSED(content_bytes, 0, "sizes");
    REFUSED(content_bytes, UINT64_MAX, "sizes");
    REFUSED(packed_bytes, UINT64_MAX, "sizes");
    REFUSED(packed_bytes, 0, "size ");
}

static void test_contents_must_fit_the_header(void **state)
{
    (void)state;
    REFUSED(frame, 5, "holds frame 3, not 5");
    REFUSED(event_end, 7, "does not fit");
    REFUSED(params.capacity, 9, "params");
    REFUSED(params.event_slots, 128, "params");
    REFUSED(params.events_per_frame, 0, "events_per_frame");
    REFUSED(params.dt_s, 0.0, "dt_s");
    REFUSED(content_hash, 1, "content hash");
    REFUSED(packed_hash, 1, "packed hash");
}

/* If the hash is computed anew after a flip, zstd's own checks find it, and then the content's
 * hash. */
static void test_flips_within_zstd_are_found(void **state)
{
    struct image_header header = header_of_good();
    unsigned char *bytes = malloc(good_bytes);
    struct error_text error;
    unsigned harmless = 0;
    (void)state;
    assert_non_null(bytes);
    memcpy(bytes, good, good_bytes);
    unsigned char *packed = bytes + sizeof header;
    for (size_t i = 0; i < header.packed_bytes; i++) {
        packed[i] ^= (unsigned char)(1u << (i % 8));
        header.packed_hash = XXH3_64bits(packed, header.packed_bytes);
        header.header_hash = image_header_hash(&header);
        memcpy(bytes, &header, sizeof header);
        image_file_put(path, bytes, good_bytes);
        if (load(&error) == 0) /* load() has checked that the world is the same */
            harmless++;
        packed[i] ^= (unsigned char)(1u << (i % 8));
    }
    assert_true(harmless <= 8); /* zstd ignores this bit */
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_image_is_loaded),
        cmocka_unit_test(test_every_flipped_byte_is_found),
        cmocka_unit_test(test_every_bit_of_the_header_is_found),
        cmocka_unit_test(test_every_other_length_is_refused),
        cmocka_unit_test(test_foreign_files_are_refused),
        cmocka_unit_test(test_sizes_beyond_bounds_are_refused),
        cmocka_unit_test(test_contents_must_fit_the_header),
        cmocka_unit_test(test_flips_within_zstd_are_found),
    };
    return cmocka_run_group_tests(tests, make_image, drop_image);
}
