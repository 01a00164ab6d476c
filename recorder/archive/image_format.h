/* The layout of an image file. It is little-endian:
 *
 *     struct image_header        sizes, hashes, the segment's header, the world's parameters
 *     one zstd frame             the parts, one after the other, as image_parts() lists them
 *
 * The header holds the length and hash of the zstd frame, so that only undamaged bytes are
 * unpacked, and the length and hash of the unpacked content. Its last member is its own hash. */
#ifndef JOLON_RECORDER_ARCHIVE_IMAGE_FORMAT_H
#define JOLON_RECORDER_ARCHIVE_IMAGE_FORMAT_H

#include "ipc/segment/segment.h"
#include "world/params.h"

#include <stddef.h>
#include <stdint.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "images are little-endian");

#define IMAGE_MAGIC   0x314d494c4f4a0a1au /* "\x1a\nJOLIM1" */
#define IMAGE_VERSION 6u

struct image_header {
    uint64_t magic;
    uint32_t version;
    uint32_t header_bytes;
    uint64_t layout_hash;                    /* the segment's; another build refuses the image */
    uint64_t packed_bytes, packed_hash;      /* of the zstd frame; XXH3 */
    uint64_t content_bytes, content_hash;    /* unpacked; XXH3 */
    uint64_t frame;                          /* committed */
    uint64_t event_end;                      /* number of events of the run up to that frame */
    uint64_t ring_first[COMMAND_RING_COUNT]; /* commands first .. end - 1 are in the image */
    uint64_t ring_end[COMMAND_RING_COUNT];
    uint32_t used, craters, dents, contacts;
    uint32_t reserved;
    uint32_t inputs; /* 1: the image holds the moved table of frame + 1 */
    uint32_t moved_used, intents;
    struct segment_header segment;
    struct params params;
    uint64_t header_hash; /* XXH3 of the header with this word set to 0 */
};

/* The memory that the parts are written from or read into. */
struct image_tables {
    const struct view *view; /* for its static regions, craters and dents */
    struct state state;      /* the committed frame */
    struct moved moved;      /* used only if the header has inputs */
    struct command
        *ring[COMMAND_RING_COUNT]; /* [layout_ring_slots()]: command n at n & (slots - 1) */
};

struct image_part {
    void *at;
    size_t bytes;
};

#define IMAGE_PARTS_MAX 192

/* Lists the parts in file order and returns their number. The header must have been checked, as its
 * counts give the sizes. */
uint32_t image_parts(const struct image_header *header, const struct image_tables *tables,
                     struct image_part parts[IMAGE_PARTS_MAX]);

/* The size of all parts, computed from the header alone. */
uint64_t image_content_bytes(const struct image_header *header, const struct layout *layout);

uint64_t image_header_hash(const struct image_header *header);

#endif
