/* The layout of a ground file, as docs/ground.md describes it: a header, a directory of blocks, and
 * the blocks. All numbers are little-endian. Each block is a zstd frame of its own, so that a tile
 * can be read without the others. The file is written once and renamed; nothing changes it. */
#ifndef JOLON_WORLD_TERRAIN_GROUND_FORMAT_H
#define JOLON_WORLD_TERRAIN_GROUND_FORMAT_H

#include <stdint.h>

#define GROUND_MAGIC   "JOLONGRD"
#define GROUND_VERSION 2u

/* Files of this version are read as well: they have no objects. */
#define GROUND_VERSION_OLDEST 1u

/* Sides of squares, and what they are a multiple of [m]. */
#define GROUND_SIDE_MIN_M 1000.0
#define GROUND_SIDE_MAX_M 500000.0
#define GROUND_SIDE_OF_M  125.0

#define GROUND_POSTS_SIDE_MIN 9u
#define GROUND_POSTS_SIDE_MAX 20001u

/* A world has room for so many along an edge; more are in a file beside the ground file
 * (world/terrain/posts_file.h). */
#define GROUND_WORLD_POSTS_MAX 4097u

/* Posts along one edge of a tile; the last tiles of a row or column have fewer. */
#define GROUND_TILE_POSTS 256u

/* Heights are whole numbers of this, so that they are the same floats everywhere [m]. */
#define GROUND_STEP_M (1.0 / 64.0)

/* Heights of the ground above the sea level [m]. */
#define GROUND_LOWEST_M  (-1000.0)
#define GROUND_HIGHEST_M 9000.0

enum ground_block_kind {
    GROUND_BLOCK_TEXT,      /* sources and licences: UTF-8, lines */
    GROUND_BLOCK_TILE,      /* posts and their cover */
    GROUND_BLOCK_ROADS,     /* struct ground_road_point */
    GROUND_BLOCK_OBJECTS,   /* struct ground_object */
    GROUND_BLOCK_BUILDINGS, /* struct ground_building */
    GROUND_BLOCK_CORNERS,   /* struct ground_corner */
    GROUND_BLOCK_KINDS
};

/* What the file says of itself. */
enum ground_flag {
    GROUND_COVER_GUESSED = 1 /* cover follows from slope and height: no map of cover was given */
};

struct ground_header {
    char magic[8];
    uint32_t version;
    uint32_t flags;                     /* enum ground_flag */
    uint64_t hash;                      /* of the ground: ground_file_hash() */
    double latitude_deg, longitude_deg; /* of the middle; WGS 84 */
    double side_m, spacing_m;
    double undulation_m; /* of the sea level above the ellipsoid at the middle; 0: not known */
    float lowest_m, highest_m;
    uint32_t posts_side;  /* side_m / spacing_m + 1 */
    uint32_t block_count; /* the directory follows the header */
    uint64_t bytes;       /* of the file */
    uint64_t directory_hash;
    uint64_t header_hash; /* of everything before */
};

struct ground_block {
    uint32_t kind;   /* enum ground_block_kind */
    uint32_t number; /* of tiles: row by row from the north-west */
    uint64_t offset; /* in the file */
    uint32_t packed_bytes, content_bytes;
    uint64_t content_hash; /* of the unpacked bytes */
};

_Static_assert(sizeof(struct ground_header) == 104 && sizeof(struct ground_block) == 32,
               "no padding");
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the file has the machine's own order");

#define GROUND_TEXT_BYTES_MAX (1u << 20)

/* A point of a road, within the square. The points of a road follow each other, two or more; roads
 * are numbered from 0. */
struct ground_road_point {
    int32_t x_mm, z_mm;
    uint32_t road;
};

#define GROUND_ROAD_POINTS_MAX 262144u

enum ground_object_type {
    GROUND_TREE,
    GROUND_PINE,
    GROUND_BUSH,
    GROUND_POLE,
    GROUND_WATERTOWER,
    GROUND_OBJECT_TYPES
};

/* A fixed object that is no building, within the square. Objects stand at different places, in the
 * order of x_mm, then z_mm. */
struct ground_object {
    int32_t x_mm, z_mm;
    uint8_t type;         /* enum ground_object_type */
    uint8_t size_percent; /* of its kind's, GROUND_SIZE_MIN or more */
    uint16_t turn;        /* heading, 65536 for a full turn */
};

#define GROUND_SIZE_MIN 25u

/* A building, or a piece of a large one: prisms over convex parts of its outline. Heights are over
 * the ground at its middle. */
struct ground_building {
    int32_t x_mm, z_mm; /* its middle, within the square */
    int32_t foot_mm;    /* lower end of its walls, 0 or below */
    int32_t eaves_mm;   /* upper end of its walls */
    int32_t top_mm;     /* of its roof; above the eaves: a ridge along its length */
    uint16_t turn;      /* heading of its length, 65536 for a full turn */
    uint16_t parts;     /* 1..GROUND_BUILDING_PARTS_MAX; only one of four corners has a ridge */
};

/* A corner of a part, relative to the middle of its building. The corners of a part follow each
 * other, three or more, clockwise on the map and strictly convex; parts are numbered from 0,
 * building by building. */
struct ground_corner {
    int32_t x_mm, z_mm;
    uint32_t part;
};

/* Objects and buildings together. */
#define GROUND_OBJECTS_MAX        1048576u
#define GROUND_BUILDINGS_MAX      65000u
#define GROUND_BUILDING_PARTS_MAX 8u
#define GROUND_PART_CORNERS_MAX   32u
#define GROUND_CORNERS_MAX        (1u << 22)

/* From the middle of a building to its farthest corner, and heights [mm]. */
#define GROUND_BUILDING_REACH_MM 500000
#define GROUND_BUILDING_FOOT_MM  (-200000)
#define GROUND_BUILDING_EAVES_MM 500
#define GROUND_BUILDING_TOP_MM   900000

/* No part is narrower, so that each takes up space [mm]. */
#define GROUND_PART_WIDTH_MM 10

_Static_assert(sizeof(struct ground_object) == 12 && sizeof(struct ground_building) == 24 &&
                   sizeof(struct ground_corner) == 12,
               "no padding");

static inline uint32_t ground_tiles_side(uint32_t posts_side)
{
    return (posts_side + GROUND_TILE_POSTS - 1) / GROUND_TILE_POSTS;
}

#endif
