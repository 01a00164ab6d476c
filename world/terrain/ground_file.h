/* Reads ground files. Nothing in a file is trusted: sizes, places and hashes are checked before
 * anything is used, and a file that is refused is refused in one line. The file is mapped, so only
 * the tiles that are read are in memory.
 *
 * A file that is made shorter while it is mapped ends its reader by a signal; jolon ground writes
 * another file and renames it instead. One thread may open and close; any number may read. */
#ifndef JOLON_WORLD_TERRAIN_GROUND_FILE_H
#define JOLON_WORLD_TERRAIN_GROUND_FILE_H

#include "world/runtime/error_text.h"
#include "world/terrain/ground_format.h"
#include "world/terrain/ground_tile.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct ground_file {
    struct ground_header header;
    char path[PATH_MAX];
    const unsigned char *mapped; /* [header.bytes] */
    const struct ground_block *blocks;
    uint32_t tiles;                     /* the first blocks are the tiles, in order */
    uint32_t block[GROUND_BLOCK_KINDS]; /* of each kind behind them; 0: the file has none */
    uint32_t text_bytes;
    uint32_t road_points, objects, buildings, corners;
};

/* The hash of a ground: of its place, size, roads, objects, and posts with their cover, but not of
 * its sources and licences. Equal grounds have equal hashes, whatever they were made from. blocks:
 * the directory, whose text does not count. */
uint64_t ground_file_hash(const struct ground_header *header, const struct ground_block *blocks);

/* Returns true if a world of this side [m] can have this ground: a square in its middle whose posts
 * are posts of the world, GROUND_WORLD_POSTS_MAX along an edge at most, more if the square is the
 * whole world. Sets *offset_m: x and z of
 * the square's north-west corner in the world, and *posts_side: posts of the world along an edge.
 */
bool ground_file_fits_world(const struct ground_header *header, double side_m, double *offset_m,
                            uint32_t *posts_side);

/* Returns the side of the world that a ground has unless another is asked for [m]:
 * WORLD_SIDE_DEFAULT_M if it fits into the middle of that, else its own. */
double ground_file_world_side(const struct ground_header *header);

/* Opens a file and checks its header and its directory. 0, or -1 with the reason. */
int ground_file_open(struct ground_file *file, const char *path, struct error_text *error);
void ground_file_close(struct ground_file *file);

/* Reads a tile and checks its hash and its values: ground_tile_unpack(). 0, or -1 with the
 * reason. */
int ground_file_tile(const struct ground_file *file, uint32_t number, float *posts, uint8_t *cover,
                     size_t stride, struct error_text *error);

/* Reads all posts and their cover [posts_side * posts_side]. 0, or -1 with the reason. */
int ground_file_posts(const struct ground_file *file, float *posts, uint8_t *cover,
                      struct error_text *error);

/* Reads the roads into points [road_points] and checks them. 0, or -1 with the reason. */
int ground_file_roads(const struct ground_file *file, struct ground_road_point *points,
                      struct error_text *error);

/* Reads the objects into objects [file->objects] and checks them. 0, or -1 with the reason. */
int ground_file_objects(const struct ground_file *file, struct ground_object *objects,
                        struct error_text *error);

/* Reads the buildings [file->buildings] and their corners [file->corners], and checks them. 0, or
 * -1 with the reason. */
int ground_file_buildings(const struct ground_file *file, struct ground_building *buildings,
                          struct ground_corner *corners, struct error_text *error);

/* Returns true if the corners are those of a convex part as the format asks for. */
bool ground_file_part_fits(const struct ground_corner *corner, uint32_t count);

/* Reads the text of sources and licences into text [text_bytes + 1], and ends it with a NUL.
 * Control characters but newlines become blanks. 0, or -1 with the reason. */
int ground_file_text(const struct ground_file *file, char *text, struct error_text *error);

#endif
