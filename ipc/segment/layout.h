/* Layout of a world's segment: its regions, their sizes and offsets, and their writers.
 *
 * Offsets follow from struct params and struct counts only, so every process computes them from the
 * checked header and reads none from memory. Regions begin on page borders of every kernel, so that
 * a process maps for writing only the regions that its role writes. */
#ifndef JOLON_IPC_SEGMENT_LAYOUT_H
#define JOLON_IPC_SEGMENT_LAYOUT_H

#include "ipc/segment/role.h"
#include "world/entity/command.h"
#include "world/world.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SEGMENT_MAGIC   0x314e4f4c4f4a0a1au /* "\x1a\nJOLON1": also no text file's first bytes */
#define SEGMENT_VERSION 12u

/* Every region begins at a multiple of this [byte]. A mapping begins on a page border, and pages
 * are 4, 16 or 64 KiB, depending on the kernel (aarch64 has all three). */
#define REGION_ALIGN 65536u

/* Room for a table's head before its rows [byte]. */
#define LAYOUT_HEAD_BYTES 8192u

enum region {
    REGION_HEADER, /* struct segment_header; never changes, like all regions before COMMIT */
    REGION_PARAMS,
    REGION_KINDS,
    REGION_MODELS,
    REGION_MODEL_VERTICES,
    REGION_MODEL_TRIANGLES,
    REGION_HULLS,
    REGION_HULL_VERTICES,
    REGION_HULL_PLANES,
    REGION_POSTS,
    REGION_COVER,
    REGION_EARTHWORKS,
    REGION_EARTHWORK_INDEX,
    REGION_FIXED,
    REGION_REACH_START,
    REGION_REACH,
    REGION_AREAS,
    REGION_ROUTES,
    REGION_ROUTE_POINTS,
    REGION_FIRES,
    REGION_ROAD_POINTS,
    REGION_FORMATIONS,
    REGION_SCRIPTS,
    REGION_SCRIPT_STEPS,
    REGION_MISSIONS,
    REGION_MISSION_PHASES,
    REGION_MISSION_MEMBERS,
    REGION_OBJECTIVES,
    REGION_NAMES,
    REGION_RECIPE,
    REGION_COMMIT,  /* struct commit_words: collider */
    REGION_WORLD_A, /* head, rows, their hashes and bits, fixed damage, contacts: collider */
    REGION_WORLD_B,
    REGION_CRATERS,    /* collider */
    REGION_DENTS,      /* collider */
    REGION_EVENTS,     /* collider */
    REGION_MOVED_WORD, /* struct moved_word: mover */
    REGION_MOVED,      /* head, rows, their hashes and bits, intents: mover */
    REGION_COMMANDS,   /* a struct command_ring_words and its slots, one for each ring */
    REGION_COMMANDS_LAST = REGION_COMMANDS + COMMAND_RING_COUNT - 1,
    REGION_DOORS, /* doorbell semaphores: every role */
    REGION_SLOTS, /* a struct role_slot each: that role */
    REGION_SLOTS_LAST = REGION_SLOTS + ROLE_COUNT - 1,
    REGION_COUNT
};

struct segment_header {
    uint64_t magic; /* written last */
    uint32_t version;
    uint32_t header_bytes;
    uint64_t layout_hash; /* of compiled sizes and offsets: other builds refuse the world */
    uint64_t total_bytes;
    uint64_t static_hash[REGION_COMMIT]; /* XXH3 of each region that never changes; [0] is 0 */
    struct counts counts;
    uint32_t capacity, event_slots, intents_per_frame, command_slots, crater_slots;
    uint32_t dent_slots, contact_slots;
    uint32_t input_slots; /* of the gateway's ring */
    uint64_t made;        /* random number of this creation, also in its images */
    uint64_t origin;      /* hash of the image it was made from (image_segment()); 0: none */
    uint64_t first_event; /* the first event of the ring: 0, or the image's next event */
    uint64_t head_hash;   /* XXH3 over the words above but magic */
};

/* Returns the number of slots of a command ring, a power of two. */
static inline uint32_t layout_ring_slots(const struct segment_header *header, int ring)
{
    return ring == RING_GATEWAY ? header->input_slots : header->command_slots;
}

/* Returns how many slots the gateway's ring has in a world for so many remote entities: records of
 * some seconds. */
uint32_t layout_input_slots(uint32_t command_slots, uint32_t remotes_max);

struct layout {
    size_t offset[REGION_COUNT];
    size_t bytes[REGION_COUNT];
    size_t total;
};

/* Returns the bytes of a table: head, rows, their hashes and the bits of those that were written
 * (world/checksum.h). */
size_t layout_table_bytes(uint32_t capacity);

/* Returns the place of the contacts in a world buffer [byte], a multiple of TABLE_ALIGN. */
size_t layout_contacts_offset(uint32_t capacity, uint32_t fixed);

/* Computes layout from the header's counts and sizes. Returns 0, or -1 with errno EOVERFLOW when a
 * size exceeds its bound, as a forged header's may. */
int layout_compute(struct layout *layout, const struct segment_header *header);

/* Returns a hash of all compiled-in sizes and offsets on which attached processes must agree. */
uint64_t layout_hash(void);

/* Returns true if the holder of this role writes this region. ROLE_NONE writes none. */
bool layout_writable(enum role role, enum region region);

const char *region_name(enum region region);

#endif
