/* The reader of ground files. */
#include "world/terrain/ground_file.h"

#include "world/maths/hash.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/projection.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

/* What the hash of a ground covers of its header. */
struct hashed {
    double latitude_deg, longitude_deg, side_m, spacing_m, undulation_m;
    uint64_t flags;
};

uint64_t ground_file_hash(const struct ground_header *header, const struct ground_block *blocks)
{
    const struct hashed place = {header->latitude_deg, header->longitude_deg, header->side_m,
                                 header->spacing_m,    header->undulation_m,  header->flags};
    uint64_t hash = XXH3_64bits(&place, sizeof place);
    for (uint32_t i = 0; i < header->block_count; i++) {
        if (blocks[i].kind != GROUND_BLOCK_TEXT)
            hash =
                XXH3_64bits_withSeed(&blocks[i].content_hash, sizeof blocks[i].content_hash, hash);
    }
    return hash;
}

bool ground_file_fits_world(const struct ground_header *header, double side_m, double *offset_m,
                            uint32_t *posts_side)
{
    double cells = side_m / header->spacing_m;
    *offset_m = 0.5 * (side_m - header->side_m);
    if (!(*offset_m >= 0.0) || cells != floor(cells) ||
        cells > (*offset_m > 0.0 ? GROUND_WORLD_POSTS_MAX : GROUND_POSTS_SIDE_MAX) - 1 ||
        fmod(*offset_m, header->spacing_m) != 0.0)
        return false;
    *posts_side = (uint32_t)cells + 1;
    return true;
}

double ground_file_world_side(const struct ground_header *header)
{
    double offset_m;
    uint32_t posts_side;
    return ground_file_fits_world(header, WORLD_SIDE_DEFAULT_M, &offset_m, &posts_side)
               ? WORLD_SIDE_DEFAULT_M
               : header->side_m;
}

static int refuse(const struct ground_file *file, struct error_text *error, const char *what)
{
    return error_text_set(error, "%s: %s; make it again by: jolon ground make", file->path, what);
}

/* Returns true if the sides fit each other. NaN fits nothing. */
static bool sides_fit(const struct ground_header *h)
{
    return h->side_m >= GROUND_SIDE_MIN_M && h->side_m <= GROUND_SIDE_MAX_M &&
           fmod(h->side_m, GROUND_SIDE_OF_M) == 0.0 && h->posts_side >= GROUND_POSTS_SIDE_MIN &&
           h->posts_side <= GROUND_POSTS_SIDE_MAX &&
           h->spacing_m == h->side_m / (h->posts_side - 1);
}

static int check_header(const struct ground_file *file, uint64_t bytes, struct error_text *error)
{
    const struct ground_header *h = &file->header;
    uint64_t tiles = ground_tiles_side(h->posts_side);
    if (h->header_hash != XXH3_64bits(h, offsetof(struct ground_header, header_hash)))
        return refuse(file, error, "its header is damaged");
    if (h->bytes != bytes)
        return error_text_set(error,
                              "%s: has %" PRIu64 " bytes, and its header says %" PRIu64
                              ": it is cut off or has something behind its end",
                              file->path, bytes, h->bytes);
    if (!sides_fit(h))
        return refuse(file, error, "its header has a side or a number of posts that cannot be");
    if (!(fabs(h->latitude_deg) <= PROJECTION_LATITUDE_MAX_DEG) ||
        !(fabs(h->longitude_deg) <= 180.0) || !(fabs(h->undulation_m) <= 200.0))
        return refuse(file, error, "its header has a place that cannot be");
    if (h->block_count < tiles * tiles || h->block_count > tiles * tiles + GROUND_BLOCK_KINDS - 1)
        return refuse(file, error, "its header has a number of blocks that cannot be");
    if (bytes < sizeof *h + h->block_count * sizeof(struct ground_block))
        return refuse(file, error, "its directory is cut off");
    return 0;
}

/* Of the blocks behind the tiles: bytes of a row, and most rows. */
static const struct {
    uint32_t bytes, most;
} rows[GROUND_BLOCK_KINDS] = {
    [GROUND_BLOCK_TEXT] = {1, GROUND_TEXT_BYTES_MAX},
    [GROUND_BLOCK_ROADS] = {sizeof(struct ground_road_point), GROUND_ROAD_POINTS_MAX},
    [GROUND_BLOCK_OBJECTS] = {sizeof(struct ground_object), GROUND_OBJECTS_MAX},
    [GROUND_BLOCK_BUILDINGS] = {sizeof(struct ground_building), GROUND_BUILDINGS_MAX},
    [GROUND_BLOCK_CORNERS] = {sizeof(struct ground_corner), GROUND_CORNERS_MAX},
};

static bool block_fits(const struct ground_file *file, const struct ground_block *block,
                       uint32_t number)
{
    uint64_t end = file->header.bytes;
    if (block->offset > end || block->packed_bytes > end - block->offset)
        return false;
    if (number < file->tiles) {
        struct ground_tile tile = ground_tile_of(file->header.posts_side, number);
        return block->kind == GROUND_BLOCK_TILE && block->number == number &&
               block->content_bytes == ground_tile_bytes(&tile);
    }
    /* The text is first, and the others follow in the order of their kinds. */
    bool first = number == file->tiles;
    if (block->kind >= GROUND_BLOCK_KINDS || block->number != 0 ||
        first != (block->kind == GROUND_BLOCK_TEXT) || (!first && block->kind <= block[-1].kind))
        return false;
    return rows[block->kind].bytes > 0 && block->content_bytes % rows[block->kind].bytes == 0 &&
           block->content_bytes / rows[block->kind].bytes <= rows[block->kind].most;
}

/* Returns how many rows the block of a kind has. */
static uint32_t rows_of(const struct ground_file *file, enum ground_block_kind kind)
{
    uint32_t block = file->block[kind];
    return block > 0 ? file->blocks[block].content_bytes / rows[kind].bytes : 0;
}

static int check_directory(struct ground_file *file, struct error_text *error)
{
    const struct ground_header *h = &file->header;
    uint32_t tiles = ground_tiles_side(h->posts_side);
    file->blocks = (const struct ground_block *)(const void *)(file->mapped + sizeof *h);
    file->tiles = tiles * tiles;
    if (h->directory_hash != XXH3_64bits(file->blocks, h->block_count * sizeof *file->blocks))
        return refuse(file, error, "its directory is damaged");
    for (uint32_t i = 0; i < h->block_count; i++) {
        if (!block_fits(file, &file->blocks[i], i))
            return error_text_set(error, "%s: block %u of its directory cannot be", file->path, i);
    }
    for (uint32_t i = file->tiles; i < h->block_count; i++)
        file->block[file->blocks[i].kind] = i;
    file->text_bytes = rows_of(file, GROUND_BLOCK_TEXT);
    file->road_points = rows_of(file, GROUND_BLOCK_ROADS);
    file->objects = rows_of(file, GROUND_BLOCK_OBJECTS);
    file->buildings = rows_of(file, GROUND_BLOCK_BUILDINGS);
    file->corners = rows_of(file, GROUND_BLOCK_CORNERS);
    if (file->objects > GROUND_OBJECTS_MAX - file->buildings)
        return refuse(file, error, "it has too many objects");
    if (h->hash != ground_file_hash(h, file->blocks))
        return refuse(file, error, "its hash is not that of its ground");
    return 0;
}

static int read_header(struct ground_file *file, int fd, uint64_t *bytes, struct error_text *error)
{
    struct ground_header *h = &file->header;
    struct stat status;
    if (fstat(fd, &status) != 0)
        return error_text_set(error, "%s: %s", file->path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_text_set(error, "%s: is no regular file", file->path);
    *bytes = (uint64_t)status.st_size;
    if (pread(fd, h, sizeof *h, 0) != (ssize_t)sizeof *h ||
        memcmp(h->magic, GROUND_MAGIC, sizeof h->magic) != 0)
        return error_text_set(error, "%s: is no ground file; jolon ground make makes one",
                              file->path);
    if (h->version < GROUND_VERSION_OLDEST || h->version > GROUND_VERSION)
        return error_text_set(error,
                              "%s: has version %u of ground files; this build reads %u to %u",
                              file->path, h->version, GROUND_VERSION_OLDEST, GROUND_VERSION);
    return check_header(file, *bytes, error);
}

int ground_file_open(struct ground_file *file, const char *path, struct error_text *error)
{
    uint64_t bytes = 0;
    memset(file, 0, sizeof *file);
    if ((size_t)snprintf(file->path, sizeof file->path, "%s", path) >= sizeof file->path)
        return error_text_set(error, "%.60s...: is too long for a path", path);
    /* Without waiting, because the path may be that of a pipe. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    int result = read_header(file, fd, &bytes, error);
    if (result == 0) {
        void *mapped = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, fd, 0);
        file->mapped = mapped != MAP_FAILED ? mapped : NULL;
        result = file->mapped ? check_directory(file, error)
                              : error_text_set(error, "%s: %s", path, strerror(errno));
    }
    close(fd);
    if (result != 0)
        ground_file_close(file);
    return result;
}

void ground_file_close(struct ground_file *file)
{
    if (file->mapped)
        munmap((void *)(uintptr_t)file->mapped, file->header.bytes);
    file->mapped = NULL;
}

/* Unpacks a block into content [content_bytes] and checks its hash. */
static int unpack(const struct ground_file *file, uint32_t index, void *content,
                  struct error_text *error)
{
    const struct ground_block *block = &file->blocks[index];
    size_t bytes = ZSTD_decompress(content, block->content_bytes, file->mapped + block->offset,
                                   block->packed_bytes);
    if (ZSTD_isError(bytes) || bytes != block->content_bytes ||
        XXH3_64bits(content, bytes) != block->content_hash)
        return error_text_set(error, "%s: block %u is damaged; make it again by: jolon ground make",
                              file->path, index);
    return 0;
}

int ground_file_tile(const struct ground_file *file, uint32_t number, float *posts, uint8_t *cover,
                     size_t stride, struct error_text *error)
{
    struct ground_tile tile = ground_tile_of(file->header.posts_side, number);
    uint8_t *content = malloc(ground_tile_bytes(&tile));
    if (!content)
        return error_text_memory(error);
    int result = unpack(file, number, content, error);
    if (result == 0 && !ground_tile_unpack(&tile, content, posts, cover, stride))
        result = error_text_set(error, "%s: tile %u has a height or a cover that cannot be",
                                file->path, number);
    free(content);
    return result;
}

int ground_file_posts(const struct ground_file *file, float *posts, uint8_t *cover,
                      struct error_text *error)
{
    uint32_t side = file->header.posts_side;
    for (uint32_t i = 0; i < file->tiles; i++) {
        struct ground_tile tile = ground_tile_of(side, i);
        size_t first = (size_t)tile.row * side + tile.column;
        if (ground_file_tile(file, i, posts + first, cover + first, side, error) != 0)
            return -1;
    }
    return 0;
}

/* Returns true if the points lie within the square and are the roads 0, 1, 2 ... of two points or
 * more. */
static bool roads_fit(const struct ground_road_point *points, uint32_t count, double side_m)
{
    double side_mm = side_m * 1000.0;
    for (uint32_t i = 0; i < count; i++) {
        const struct ground_road_point *p = &points[i];
        bool begins = i == 0 || p->road != p[-1].road,
             ends = i + 1 == count || p->road != p[1].road;
        uint32_t expected = i == 0 ? 0 : p[-1].road + begins;
        if (p->road != expected || (begins && ends) || p->x_mm < 0 || p->z_mm < 0 ||
            p->x_mm > side_mm || p->z_mm > side_mm)
            return false;
    }
    return true;
}

int ground_file_roads(const struct ground_file *file, struct ground_road_point *points,
                      struct error_text *error)
{
    if (file->road_points == 0)
        return 0;
    if (unpack(file, file->block[GROUND_BLOCK_ROADS], points, error) != 0)
        return -1;
    return roads_fit(points, file->road_points, file->header.side_m)
               ? 0
               : error_text_set(error, "%s: has roads that cannot be", file->path);
}

static bool objects_fit(const struct ground_object *object, uint32_t count, double side_m)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct ground_object *o = &object[i], *before = i > 0 ? o - 1 : NULL;
        if (o->x_mm < 0 || o->z_mm < 0 || o->x_mm > side_m * 1000.0 || o->z_mm > side_m * 1000.0 ||
            o->type >= GROUND_OBJECT_TYPES || o->size_percent < GROUND_SIZE_MIN)
            return false;
        if (before &&
            (before->x_mm > o->x_mm || (before->x_mm == o->x_mm && before->z_mm >= o->z_mm)))
            return false;
    }
    return true;
}

int ground_file_objects(const struct ground_file *file, struct ground_object *objects,
                        struct error_text *error)
{
    if (file->objects == 0)
        return 0;
    if (unpack(file, file->block[GROUND_BLOCK_OBJECTS], objects, error) != 0)
        return -1;
    return objects_fit(objects, file->objects, file->header.side_m)
               ? 0
               : error_text_set(error, "%s: has objects that cannot be", file->path);
}

bool ground_file_part_fits(const struct ground_corner *corner, uint32_t count)
{
    int64_t area = 0;
    double longest = 0.0;
    if (count < 3 || count > GROUND_PART_CORNERS_MAX)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const struct ground_corner *a = &corner[i], *b = &corner[(i + 1) % count],
                                   *c = &corner[(i + 2) % count];
        if (a->x_mm < -GROUND_BUILDING_REACH_MM || a->x_mm > GROUND_BUILDING_REACH_MM ||
            a->z_mm < -GROUND_BUILDING_REACH_MM || a->z_mm > GROUND_BUILDING_REACH_MM)
            return false;
        int64_t abx = (int64_t)b->x_mm - a->x_mm, abz = (int64_t)b->z_mm - a->z_mm;
        int64_t bcx = (int64_t)c->x_mm - b->x_mm, bcz = (int64_t)c->z_mm - b->z_mm;
        /* Clockwise on a map whose z goes down is a positive turn. */
        if (abx * bcz - abz * bcx <= 0)
            return false;
        area += (int64_t)a->x_mm * b->z_mm - (int64_t)a->z_mm * b->x_mm;
        double length = sqrt((double)(abx * abx + abz * abz));
        longest = length > longest ? length : longest;
    }
    /* Turns of one sign alone might go around twice; then the area counts twice, and the distance
     * of a corner from the others has no meaning. The sum of the turns tells. */
    uint32_t downs = 0;
    for (uint32_t i = 0; i < count; i++) {
        int32_t now = corner[(i + 1) % count].x_mm - corner[i].x_mm;
        int32_t next = corner[(i + 2) % count].x_mm - corner[(i + 1) % count].x_mm;
        downs += now >= 0 && next < 0;
    }
    return downs == 1 && (double)area >= GROUND_PART_WIDTH_MM * longest;
}

static bool building_fits(const struct ground_building *b, double side_m)
{
    return b->x_mm >= 0 && b->z_mm >= 0 && b->x_mm <= side_m * 1000.0 &&
           b->z_mm <= side_m * 1000.0 && b->foot_mm >= GROUND_BUILDING_FOOT_MM && b->foot_mm <= 0 &&
           b->eaves_mm >= GROUND_BUILDING_EAVES_MM && b->top_mm >= b->eaves_mm &&
           b->top_mm <= GROUND_BUILDING_TOP_MM && b->parts >= 1 &&
           b->parts <= GROUND_BUILDING_PARTS_MAX;
}

/* Returns true if the corners are the parts 0, 1, 2 ... that the buildings have. */
static bool buildings_fit(const struct ground_file *file, const struct ground_building *buildings,
                          const struct ground_corner *corners)
{
    uint32_t at = 0, part = 0;
    for (uint32_t i = 0; i < file->buildings; i++) {
        const struct ground_building *b = &buildings[i];
        if (!building_fits(b, file->header.side_m))
            return false;
        for (uint32_t end = part + b->parts; part < end; part++) {
            uint32_t first = at;
            while (at < file->corners && corners[at].part == part)
                at++;
            if (!ground_file_part_fits(corners + first, at - first) ||
                (b->top_mm > b->eaves_mm && (b->parts != 1 || at - first != 4)))
                return false;
        }
    }
    return at == file->corners;
}

int ground_file_buildings(const struct ground_file *file, struct ground_building *buildings,
                          struct ground_corner *corners, struct error_text *error)
{
    if ((file->buildings > 0 &&
         unpack(file, file->block[GROUND_BLOCK_BUILDINGS], buildings, error) != 0) ||
        (file->corners > 0 && unpack(file, file->block[GROUND_BLOCK_CORNERS], corners, error) != 0))
        return -1;
    return buildings_fit(file, buildings, corners)
               ? 0
               : error_text_set(error, "%s: has buildings that cannot be", file->path);
}

int ground_file_text(const struct ground_file *file, char *text, struct error_text *error)
{
    if (file->text_bytes > 0 && unpack(file, file->block[GROUND_BLOCK_TEXT], text, error) != 0)
        return -1;
    for (uint32_t i = 0; i < file->text_bytes; i++) {
        unsigned char c = (unsigned char)text[i];
        if ((c < 0x20 && c != '\n') || c == 0x7f)
            text[i] = ' ';
    }
    text[file->text_bytes] = '\0';
    return 0;
}
