/* The verbs info and check. */
#include "supervisor/ground/describe.h"

#include "ipc/json/world_json.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/projection.h"
#include "world/terrain/terrain.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* From half a side of this on, the projection's error is told as a warning [m]. */
#define WARN_M 100000.0

static bool json;

static const struct option_row json_rows[] = {
    {"json", NULL, "print one JSON object", .flag = &json}, OPTION_ROWS_END};
static const struct option_row no_rows[] = {OPTION_ROWS_END};

static void open_file(struct ground_file *file, const struct option_table *table, int argc,
                      char **argv)
{
    struct error_text error;
    if (option_table_read(table, argc, argv) != 1)
        die_usage("%s: needs the name of a ground file", table->program + strlen("jolon-"));
    if (ground_file_open(file, argv[argc - 1], &error) != 0)
        die_refused("%s", error.text);
}

static char *read_text(const struct ground_file *file)
{
    struct error_text error;
    char *text = malloc(file->text_bytes + 1);
    if (!text)
        die_refused("%s: no memory for its text", file->path);
    if (ground_file_text(file, text, &error) != 0)
        die_refused("%s", error.text);
    return text;
}

static bool runs(const struct ground_header *header)
{
    double offset_m;
    uint32_t posts_side;
    return ground_file_fits_world(header, ground_file_world_side(header), &offset_m, &posts_side);
}

static void print_json(const struct ground_file *file, const char *text)
{
    const struct ground_header *h = &file->header;
    cJSON *object = cJSON_CreateObject();
    char hash[24];
    snprintf(hash, sizeof hash, "%016" PRIx64, h->hash);
    json_text(object, "hash", hash);
    json_number(object, "latitude_deg", h->latitude_deg);
    json_number(object, "longitude_deg", h->longitude_deg);
    json_number(object, "side_m", h->side_m);
    json_number(object, "spacing_m", h->spacing_m);
    json_whole(object, "posts", h->posts_side);
    json_number(object, "lowest_m", (double)h->lowest_m);
    json_number(object, "highest_m", (double)h->highest_m);
    json_number(object, "undulation_m", h->undulation_m);
    json_bool(object, "cover_guessed", h->flags & GROUND_COVER_GUESSED);
    json_number(object, "stretch_edge", projection_stretch(0.5 * h->side_m));
    json_bool(object, "runs", runs(h));
    json_number(object, "world_side_m", runs(h) ? ground_file_world_side(h) : 0.0);
    json_whole(object, "bytes", h->bytes);
    json_whole(object, "road_points", file->road_points);
    json_whole(object, "buildings", file->buildings);
    json_whole(object, "objects", file->objects);
    json_text(object, "sources", text);
    json_print(object);
}

static void print(const struct ground_file *file, const char *text)
{
    const struct ground_header *h = &file->header;
    double half = 0.5 * h->side_m;
    printf("ground       %s, %.1f MB, version %u\n", file->path, (double)h->bytes / 1e6,
           h->version);
    printf("hash         %016" PRIx64 "\n", h->hash);
    printf("middle       latitude %.6f, longitude %.6f (WGS 84)\n", h->latitude_deg,
           h->longitude_deg);
    if (runs(h))
        printf("side         %g km, in the middle of a world of %g km\n", h->side_m / 1000.0,
               ground_file_world_side(h) / 1000.0);
    else
        printf("side         %g km; worlds do not run on it\n", h->side_m / 1000.0);
    printf("posts        %u x %u, %g m apart\n", h->posts_side, h->posts_side, h->spacing_m);
    printf("heights      %g to %g m above the sea level\n", (double)h->lowest_m,
           (double)h->highest_m);
    printf("cover        %s\n", h->flags & GROUND_COVER_GUESSED
                                    ? "guessed from slope and height, at least in part"
                                    : "from a map");
    printf("roads        %u points\n", file->road_points);
    printf("objects      %u buildings, %u plants and poles\n", file->buildings, file->objects);
    if (h->undulation_m != 0.0)
        printf("undulation   the sea level is %g m above the ellipsoid\n", h->undulation_m);
    else
        printf("undulation   not known\n");
    printf("projection   transverse Mercator about the middle, k = 1; lengths at the west and east "
           "edge are %.3g mm a km too long\n",
           1e6 * projection_stretch(half));
    if (half > WARN_M)
        printf("warning      past %g km from the middle they are more than %.0f mm a km too long\n",
               WARN_M / 1000.0, 1e6 * projection_stretch(WARN_M));
    fputs(text, stdout);
}

int describe_info(int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-ground info",
        .usage = "[--json] FILE\nSays what a ground file holds, and what it was made from.",
        .rows = json_rows,
        .plain = 1};
    struct ground_file file;
    open_file(&file, &table, argc, argv);
    char *text = read_text(&file);
    if (json)
        print_json(&file, text);
    else
        print(&file, text);
    free(text);
    ground_file_close(&file);
    return EXIT_OK;
}

/* Checks roads, objects and buildings. */
static void check_lists(const struct ground_file *file)
{
    struct error_text error;
    struct ground_road_point *roads = malloc((file->road_points + 1) * sizeof *roads);
    struct ground_object *objects = malloc((file->objects + 1) * sizeof *objects);
    struct ground_building *buildings = malloc((file->buildings + 1) * sizeof *buildings);
    struct ground_corner *corners = malloc((file->corners + 1) * sizeof *corners);
    if (!roads || !objects || !buildings || !corners)
        die_refused("%s: no memory for its roads and objects", file->path);
    if (ground_file_roads(file, roads, &error) != 0 ||
        ground_file_objects(file, objects, &error) != 0 ||
        ground_file_buildings(file, buildings, corners, &error) != 0)
        die_refused("%s", error.text);
    free(roads);
    free(objects);
    free(buildings);
    free(corners);
}

int describe_check(int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-ground check",
        .usage = "FILE\nReads every block of a ground file and checks hashes and values.",
        .rows = no_rows,
        .plain = 1};
    static float posts[GROUND_TILE_POSTS * GROUND_TILE_POSTS];
    static uint8_t cover[GROUND_TILE_POSTS * GROUND_TILE_POSTS];
    static const char *const names[COVER_COUNT] = {"grass", "chaparral", "forest", "rock",
                                                   "sand",  "road",      "sea",    "lake"};
    uint64_t count[COVER_COUNT] = {0}, all = 0;
    struct ground_file file;
    struct error_text error;
    open_file(&file, &table, argc, argv);
    free(read_text(&file));
    check_lists(&file);
    for (uint32_t i = 0; i < file.tiles; i++) {
        if (ground_file_tile(&file, i, posts, cover, GROUND_TILE_POSTS, &error) != 0)
            die_refused("%s", error.text);
        struct ground_tile tile = ground_tile_of(file.header.posts_side, i);
        for (uint32_t k = 0; k < tile.columns * tile.rows; k++)
            count[cover[k / tile.columns * GROUND_TILE_POSTS + k % tile.columns]]++;
        all += (uint64_t)tile.columns * tile.rows;
    }
    printf("%s: good, %016" PRIx64 ", %u tiles", file.path, file.header.hash, file.tiles);
    for (uint32_t i = 0; i < COVER_COUNT; i++) {
        if (count[i] > 0)
            printf(", %s %.1f %%", names[i], 100.0 * (double)count[i] / (double)all);
    }
    puts("");
    ground_file_close(&file);
    return EXIT_OK;
}
