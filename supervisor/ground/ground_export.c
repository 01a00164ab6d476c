/* The verb export: a ground file, or the present ground of a world, as a GeoTIFF. */
#include "supervisor/ground/ground_export.h"

#include "ipc/frame/snapshot.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/world_names.h"
#include "supervisor/ground/out_file.h"
#include "supervisor/ground/picture.h"
#include "supervisor/ground/progress.h"
#include "world/maths/maths.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/location.h"
#include "world/terrain/terrain.h"

#include <ogr_srs_api.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels along an edge. */
#define SIDE_MAX 20001.0

#define TRIES 1000

static struct {
    bool cover;
    const char *world, *area;
    double step_m;
} given;

/* Where the pixels are: each lies around its point. */
struct placing {
    const char *what;                   /* for messages */
    double latitude_deg, longitude_deg; /* of the middle of the projection */
    double east_m, north_m;             /* of the north-west point from there */
    double step_m;
    int columns, rows;
};

static GDALDatasetH make_raster(const struct placing *p)
{
    GDALDataType type = given.cover ? GDT_Byte : GDT_Float32;
    GDALDatasetH raster =
        GDALCreate(GDALGetDriverByName("MEM"), "", p->columns, p->rows, 1, type, NULL);
    OGRSpatialReferenceH place = OSRNewSpatialReference(NULL);
    double transform[6] = {p->east_m - 0.5 * p->step_m,  p->step_m, 0.0,
                           p->north_m + 0.5 * p->step_m, 0.0,       -p->step_m};
    if (!raster || OSRSetWellKnownGeogCS(place, "WGS84") != OGRERR_NONE ||
        OSRSetTM(place, p->latitude_deg, p->longitude_deg, 1.0, 0.0, 0.0) != OGRERR_NONE)
        die_refused("%s: no memory for a raster of it", p->what);
    GDALSetSpatialRef(raster, place);
    OSRDestroySpatialReference(place);
    GDALSetGeoTransform(raster, transform);
    GDALSetMetadataItem(raster, "AREA_OR_POINT", "Point", NULL);
    if (!given.cover)
        GDALSetRasterUnitType(GDALGetRasterBand(raster, 1), "metre");
    return raster;
}

/* Writes rows of heights, floats, or of covers, bytes. */
static void put_rows(GDALDatasetH raster, const struct placing *p, int first, int rows, void *from)
{
    GDALDataType type = given.cover ? GDT_Byte : GDT_Float32;
    if (GDALRasterIO(GDALGetRasterBand(raster, 1), GF_Write, 0, first, p->columns, rows, from,
                     p->columns, rows, type, 0, 0) != CE_None)
        die_refused("%s: no memory for a raster of it", p->what);
}

static void write_raster(GDALDatasetH raster, const char *path)
{
    char *options[] = {(char[]){"COMPRESS=DEFLATE"}, (char[]){"TILED=YES"},
                       (char[]){"BIGTIFF=IF_SAFER"}, NULL};
    progress_end();
    picture_save(raster, "GTiff", path, options);
    GDALClose(raster);
}

static void export_file(const char *path, const char *to)
{
    struct ground_file file;
    struct error_text error;
    if (ground_file_open(&file, path, &error) != 0)
        die_refused("%s", error.text);
    const struct ground_header *h = &file.header;
    size_t count = (size_t)h->posts_side * h->posts_side;
    float *posts = malloc(count * sizeof *posts);
    uint8_t *cover = malloc(count);
    if (!posts || !cover)
        die_refused("%s: no memory for its posts", path);
    if (ground_file_posts(&file, posts, cover, &error) != 0)
        die_refused("%s", error.text);
    const struct placing placing = {
        path,         h->latitude_deg,    h->longitude_deg,  -0.5 * h->side_m, 0.5 * h->side_m,
        h->spacing_m, (int)h->posts_side, (int)h->posts_side};
    GDALDatasetH raster = make_raster(&placing);
    put_rows(raster, &placing, 0, placing.rows, given.cover ? (void *)cover : (void *)posts);
    write_raster(raster, to);
    free(posts);
    free(cover);
    ground_file_close(&file);
}

/* Reads two corners of an area [m]: west, north, east, south. Four numbers have three commas, as
 * have two places in degrees; two of the MGRS have one. */
static int read_area(const char *text, const struct location_frame *frame, double area[4],
                     struct error_text *error)
{
    char first[2 * LOCATION_TEXT_MAX];
    struct location place[2];
    double x[2], z[2];
    const char *split = strchr(text, ',');
    if (split && strchr(split + 1, ','))
        split = strchr(split + 1, ',');
    if (!split || (size_t)(split - text) >= sizeof first)
        return error_text_set(error, "has one corner");
    (void)snprintf(first, sizeof first, "%.*s", (int)(split - text), text);
    if (location_read(&place[0], first, error) != 0 ||
        location_read(&place[1], split + 1, error) != 0)
        return -1;
    for (int i = 0; i < 2; i++) {
        if (location_world(&place[i], frame, &x[i], &z[i], error) != 0)
            return -1;
    }
    area[0] = maths_min(x[0], x[1]);
    area[1] = maths_min(z[0], z[1]);
    area[2] = maths_max(x[0], x[1]);
    area[3] = maths_max(z[0], z[1]);
    return 0;
}

/* Finds the area of the world and the distance of its points. */
static struct placing place_world(const struct view *view)
{
    const struct gateway_params *gateway = &view->world.params->gateway;
    const double side_m = view->world.terrain.squares.world_m;
    double a[4] = {0.0, 0.0, side_m, side_m};
    double step = given.step_m > 0.0 ? given.step_m : view->world.terrain.spacing_m;
    struct location_frame frame;
    struct error_text error;
    location_frame_make(&frame, gateway->latitude_deg, gateway->longitude_deg, side_m);
    if (given.area && read_area(given.area, &frame, a, &error) != 0)
        die_usage("ground export: --area %s: must be X0,Z0,X1,Z1 in metres, 0 to %g, or two places "
                  "in degrees or by the MGRS: %s",
                  given.area, side_m, error.text);
    double columns = floor((a[2] - a[0]) / step) + 1.0, rows = floor((a[3] - a[1]) / step) + 1.0;
    if (columns > SIDE_MAX || rows > SIDE_MAX)
        die_usage("ground export: --step %g: makes %.0f x %.0f points; at most %.0f along an edge "
                  "are allowed: give a smaller --area",
                  step, columns, rows, SIDE_MAX);
    return (struct placing){given.world,
                            gateway->latitude_deg,
                            gateway->longitude_deg,
                            a[0] - 0.5 * side_m,
                            0.5 * side_m - a[1],
                            step,
                            (int)columns,
                            (int)rows};
}

static void take_head(const struct view *view, struct state_head *head)
{
    for (int tries = 0; snapshot_head(head, view) != 0; tries++) {
        if (errno == EBADMSG)
            die_refused("world \"%s\" is damaged: its last frame fails its checksum", given.world);
        if (tries == TRIES)
            die_refused("world \"%s\" goes on faster than it can be copied; pause it with `jolon "
                        "ctl pause`",
                        given.world);
    }
}

static void export_world(const char *to)
{
    struct view view;
    struct error_text error;
    struct crater_index craters;
    static struct state_head head;
    if (segment_attach(&view, given.world, ROLE_NONE, &error) != 0)
        die_refused("%s", error.text);
    const struct placing placing = place_world(&view);
    const struct terrain *terrain = &view.world.terrain;
    float *heights = malloc((size_t)placing.columns * sizeof *heights);
    uint8_t *cover = malloc((size_t)placing.columns);
    if (!heights || !cover ||
        crater_index_init(&craters, &view.world.terrain.squares, view.w[0].craters) != 0)
        die_refused("%s: no memory for its craters", given.world);
    take_head(&view, &head);
    crater_index_update(&craters, head.crater_count);
    GDALDatasetH raster = make_raster(&placing);
    for (int row = 0; row < placing.rows; row++) {
        double z = 0.5 * terrain->squares.world_m - placing.north_m + row * placing.step_m;
        for (int column = 0; column < placing.columns; column++) {
            double x = placing.east_m + 0.5 * terrain->squares.world_m + column * placing.step_m;
            if (given.cover)
                cover[column] = (uint8_t)terrain_cover(terrain, x, z);
            else
                heights[column] = (float)terrain_height(terrain, &craters, x, z);
        }
        put_rows(raster, &placing, row, 1, given.cover ? (void *)cover : (void *)heights);
        progress_show("rows", (uint32_t)row + 1, (uint32_t)placing.rows);
    }
    write_raster(raster, to);
    crater_index_free(&craters);
    free(heights);
    free(cover);
    segment_detach(&view);
}

int ground_export_run(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"cover", NULL,
         "the cover: 0 grass, 1 chaparral, 2 forest, 3 rock, 4 sand, 5 road, 6 sea, 7 lake",
         .flag = &given.cover},
        {"world", "NAME", "the present ground of a world, with its craters and earthworks",
         .text = &given.world, .take = segment_name_option, .letter = 'w'},
        {"area", "PLACE,PLACE",
         "two corners in the world: X0,Z0,X1,Z1 in metres, degrees with letters, or MGRS (default: "
         "all of it)",
         .text = &given.area},
        {"step", "METRES", "between points of the world (default: as its posts)",
         .real = &given.step_m, .low = 0.05, .high = 10000.0},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-ground export",
        .usage = "[--cover] FILE OUT.tif\n"
                 "       jolon-ground export --world NAME [options] OUT.tif\n"
                 "Writes the heights of a ground file, or of a world with its craters, as a "
                 "GeoTIFF: a pixel around each post or point.",
        .rows = rows,
        .plain = 2};
    struct error_text error;
    int plain = option_table_read(&table, argc, argv);
    if (plain != (given.world ? 1 : 2))
        die_usage("ground export: needs a ground file and the name of a GeoTIFF, as in: jolon "
                  "ground export x.ground x.tif; with --world the name alone");
    if (!given.world && (given.area || given.step_m > 0.0))
        die_usage("ground export: --area and --step go with --world");
    if (out_file_check(argv[argc - 1], argv + argc - plain, (uint32_t)plain - 1, &error) != 0)
        die_refused("%s", error.text);
    if (given.world)
        export_world(argv[argc - 1]);
    else
        export_file(argv[argc - 2], argv[argc - 1]);
    return EXIT_OK;
}
