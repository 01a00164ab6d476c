/* The image file, byte by byte. Little-endian, as the machine has it:
 *
 *     struct image_header        sizes, hashes, the segment's header, the world's parameters
 *     one zstd frame             the parts, one after the other, as image_parts() lists them
 *
 * The header's hash is over the header; the header holds the zstd frame's length and hash, so that
 * nothing is unpacked that was not written so, and the length and hash of what it unpacks to. */
#ifndef JOLON_RECORDER_ARCHIVE_FORMAT_H
#define JOLON_RECORDER_ARCHIVE_FORMAT_H

#include "ipc/segment/segment.h"
#include "world/params.h"

#include <stddef.h>
#include <stdint.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "images are little-endian");

#define IMAGE_MAGIC   0x314d494c4f4a0a1au /* "\x1a\nJOLIM1" */
#define IMAGE_VERSION 1u

struct image_header {
    uint64_t magic;
    uint32_t version;
    uint32_t header_bytes;
    uint64_t layout_hash;                    /* as the segment's: another build refuses */
    uint64_t packed_bytes, packed_hash;      /* of the zstd frame; XXH3 */
    uint64_t content_bytes, content_hash;    /* of what it unpacks to; XXH3 */
    uint64_t frame;                          /* committed */
    uint64_t event_end;                      /* events of the run until then */
    uint64_t ring_first[COMMAND_RING_COUNT]; /* commands first .. end - 1 are in the image */
    uint64_t ring_end[COMMAND_RING_COUNT];
    uint32_t used, craters, dents;
    uint32_t inputs; /* 1: with the moved table of frame + 1 */
    uint32_t moved_used, intents;
    struct segment_header segment;
    struct params params;
    uint64_t header_hash; /* XXH3 over the header, this word being 0 */
};

/* Where the parts lie in memory, for a writer or a reader. */
struct image_tables {
    const struct view *view;                  /* its static regions, craters and dents */
    struct state state;                       /* the committed frame */
    struct moved moved;                       /* read only with inputs */
    struct command *ring[COMMAND_RING_COUNT]; /* [command_slots]: command n at n & (slots - 1) */
};

struct image_part {
    void *at;
    size_t bytes;
};

#define IMAGE_PARTS_MAX 192

/* Lists the parts in the order of the file; how many. Sizes follow from the header, which must be
 * checked. */
uint32_t image_parts(const struct image_header *header, const struct image_tables *tables,
                     struct image_part parts[IMAGE_PARTS_MAX]);

/* Bytes of all parts, from the header's counts alone. */
uint64_t image_content_bytes(const struct image_header *header, const struct layout *layout);

uint64_t image_header_hash(const struct image_header *header);

#endif
