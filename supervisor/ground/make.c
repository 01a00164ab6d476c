/* The verb make: rasters in, a ground file out. */
#include "supervisor/ground/make.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "supervisor/ground/features.h"
#include "supervisor/ground/ground_write.h"
#include "supervisor/ground/heights.h"
#include "supervisor/ground/cover_map.h"
#include "supervisor/ground/map_cover.h"
#include "supervisor/ground/out_file.h"
#include "supervisor/ground/progress.h"
#include "supervisor/ground/road_map.h"
#include "supervisor/ground/vector_map.h"
#include "world/runtime/parse_number.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/location.h"
#include "world/terrain/terrain.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define COVERS_MAX    64
#define INPUTS_MAX    4096
#define METRES_A_FOOT 0.3048
#define TREES_MAX     10000.0 /* a hectare */
#define TREES_PER_HA  25.0
#define SEED          1991u
#define NOT_GIVEN     (-1.0) /* of the trees; of the seed UINT64_MAX */

static struct {
    double latitude_deg, longitude_deg, side_m, spacing_m, undulation_m, trees_per_ha;
    bool placed, feet;
    const char *out, *classes, *licence;
    char *covers[COVERS_MAX], *roads[COVERS_MAX], *features[COVERS_MAX];
    uint32_t cover_count, road_count, feature_count, threads;
    uint64_t seed;
} given = {.spacing_m = 31.25, .trees_per_ha = NOT_GIVEN, .seed = UINT64_MAX};

/* What is made. */
struct making {
    struct post_grid grid;
    struct raster **rasters; /* of heights */
    uint32_t count;
    struct raster *covers[COVERS_MAX];
    struct cover_map_table *table;
    struct thread_pool *pool;
    float *posts;
    uint8_t *cover;
    char *text; /* sources and licences */
    size_t text_used;
    struct heights_counts counts;
    struct road_map roads;
    struct features features;
    struct vector_map_gaps gaps;
    struct map_cover_plants plants;
    struct map_cover_sea sea;
    uint64_t guessed;
};

static int take_center(const char *value, struct error_text *error)
{
    char latitude[64];
    const char *comma = strchr(value, ',');
    snprintf(latitude, sizeof latitude, "%.*s", comma ? (int)(comma - value) : 0, value);
    if (!comma || !parse_real(latitude, -90.0, 90.0, &given.latitude_deg) ||
        !parse_real(comma + 1, -180.0, 180.0, &given.longitude_deg)) {
        struct location place;
        struct error_text reason;
        if (location_read(&place, value, &reason) != 0 || !place.on_earth)
            return error_text_set(error, "must be LATITUDE,LONGITUDE in degrees, south and west "
                                         "negative, as 44.27,-71.30, or with letters, as "
                                         "44.27N,71.30W, or a reference of the MGRS");
        given.latitude_deg = place.latitude_deg;
        given.longitude_deg = place.longitude_deg;
    }
    if (fabs(given.latitude_deg) > PROJECTION_LATITUDE_MAX_DEG)
        return error_text_set(error, "is too near the pole; allowed: latitudes up to %g degrees",
                              PROJECTION_LATITUDE_MAX_DEG);
    /* One meridian has two names, as zero has, and a place one hash. */
    if (given.longitude_deg == -180.0)
        given.longitude_deg = 180.0;
    given.latitude_deg += 0.0;
    given.longitude_deg += 0.0;
    given.placed = true;
    return 0;
}

static int take_map(char **maps, uint32_t *count, const char *value, struct error_text *error)
{
    if (*count == COVERS_MAX)
        return error_text_set(error, "is one too many; at most %d are allowed", COVERS_MAX);
    maps[(*count)++] = (char *)(uintptr_t)value;
    return 0;
}

static int take_cover(const char *value, struct error_text *error)
{
    return take_map(given.covers, &given.cover_count, value, error);
}

static int take_roads(const char *value, struct error_text *error)
{
    return take_map(given.roads, &given.road_count, value, error);
}

static int take_features(const char *value, struct error_text *error)
{
    return take_map(given.features, &given.feature_count, value, error);
}

static void check_sides(void)
{
    double posts = given.side_m / given.spacing_m;
    if (fmod(given.side_m, GROUND_SIDE_OF_M) != 0.0)
        die_usage("ground make: --side %g: must be a multiple of %g m", given.side_m,
                  GROUND_SIDE_OF_M);
    if (posts != floor(posts) || posts < GROUND_POSTS_SIDE_MIN - 1 ||
        posts > GROUND_POSTS_SIDE_MAX - 1)
        die_usage("ground make: --posts %g: the side, %g m, must be %u to %u times that, a whole "
                  "number of times",
                  given.spacing_m, given.side_m, GROUND_POSTS_SIDE_MIN - 1,
                  GROUND_POSTS_SIDE_MAX - 1);
}

static int read_options(int argc, char **argv)
{
    static const char *center, *cover, *roads, *features;
    static const struct option_row rows[] = {
        {"center", "LAT,LON", "the middle of the square, in degrees of WGS 84, or by the MGRS",
         .text = &center, .take = take_center},
        {"side", "METRES", "the side of the square: 1000 to 500000, a multiple of 125",
         .real = &given.side_m, .low = GROUND_SIDE_MIN_M, .high = GROUND_SIDE_MAX_M},
        {"posts", "METRES", "between neighbouring posts (default 31.25)", .real = &given.spacing_m,
         .low = 0.5, .high = 10000.0},
        {"out", "FILE", "the ground file", .text = &given.out},
        {"cover", "FILE", "a raster of classes of cover; repeat it for more, the finest counts",
         .text = &cover, .take = take_cover},
        {"classes", "TABLE",
         "what these classes become: worldcover (default), nlcd, corine, or a file",
         .text = &given.classes},
        {"roads", "FILE", "a map of lines of which roads are made; repeat it for more",
         .text = &roads, .take = take_roads},
        {"features", "FILE", "a map of buildings, woods, water and poles; repeat it for more",
         .text = &features, .take = take_features},
        {"trees", "N", "of a hectare of wood, and bushes of one of scrub (default 25)",
         .real = &given.trees_per_ha, .low = 0.0, .high = TREES_MAX},
        {"seed", "N", "of the places of trees (default 1991)", .u64 = &given.seed,
         .most = INT64_MAX},
        {"feet", NULL, "heights are in feet", .flag = &given.feet},
        {"undulation", "METRES", "of the sea level above the ellipsoid at the middle",
         .real = &given.undulation_m, .low = -200.0, .high = 200.0},
        {"licence", "TEXT", "a line about the licence, which the file keeps",
         .text = &given.licence},
        {"threads", "N", "threads (default: processors)", .u32 = &given.threads, .least = 1,
         .most = THREAD_POOL_MAX},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-ground make",
        .usage = "--center LAT,LON --side METRES --out FILE INPUT...\n"
                 "Makes a ground file. INPUT: rasters of heights that GDAL reads, in any order.",
        .rows = rows,
        .plain = INPUTS_MAX};
    int inputs = option_table_read(&table, argc, argv);
    if (!given.placed || given.side_m == 0.0 || !given.out || inputs == 0)
        die_usage(
            "ground make: needs --center, --side, --out and a raster of heights, as in: jolon "
            "ground make --center 44.27,-71.30 --side 50000 --out x.ground N44W072.hgt");
    if (given.classes && given.cover_count == 0)
        die_usage("ground make: --classes goes with --cover, whose classes it explains");
    if (!given.classes)
        given.classes = "worldcover";
    if ((given.trees_per_ha != NOT_GIVEN || given.seed != UINT64_MAX) && given.feature_count == 0)
        die_usage("ground make: --trees and --seed go with --features, in whose woods and scrub "
                  "plants stand");
    if (given.trees_per_ha == NOT_GIVEN)
        given.trees_per_ha = TREES_PER_HA;
    if (given.seed == UINT64_MAX)
        given.seed = SEED;
    check_sides();
    return inputs;
}

static void __attribute__((format(printf, 2, 3))) note(struct making *m, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int more =
        vsnprintf(m->text + m->text_used, GROUND_TEXT_BYTES_MAX - m->text_used, format, arguments);
    va_end(arguments);
    /* A list that is too long is cut. */
    m->text_used += more > 0 ? (size_t)more : 0;
    if (m->text_used >= GROUND_TEXT_BYTES_MAX)
        m->text_used = GROUND_TEXT_BYTES_MAX - 1;
}

static void open_rasters(struct making *m, char **paths, uint32_t count)
{
    struct error_text error;
    m->rasters = calloc(count, sizeof(struct raster *));
    m->counts.from = calloc(count, sizeof *m->counts.from);
    if (!m->rasters || !m->counts.from)
        die_refused("no memory for %u rasters", count);
    for (; m->count < count; m->count++) {
        m->rasters[m->count] = raster_open(paths[m->count], RASTER_OF_HEIGHTS, &m->grid,
                                           given.feet ? METRES_A_FOOT : 0.0, &error);
        if (!m->rasters[m->count])
            die_refused("%s", error.text);
    }
    qsort(m->rasters, count, sizeof(struct raster *), raster_order);
    raster_join(m->rasters, count);
    for (uint32_t i = 0; i < given.cover_count; i++) {
        m->covers[i] = raster_open(given.covers[i], RASTER_OF_CLASSES, &m->grid, 1.0, &error);
        if (!m->covers[i])
            die_refused("%s", error.text);
    }
    qsort(m->covers, given.cover_count, sizeof(struct raster *), raster_order);
    if (cover_map_table(m->table, given.classes, &error) != 0)
        die_refused("%s", error.text);
}

static void note_raster(struct making *m, const struct raster *raster, const char *use)
{
    char line[512];
    const char *licence = raster_licence(raster);
    raster_describe(raster, line, sizeof line);
    note(m, "%s: %s\n", use, line);
    if (licence)
        note(m, "licence: %s\n", licence);
}

static void tell_sources(struct making *m)
{
    uint32_t rivers = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        if (m->counts.from[i] == 0)
            log_warn(
                "%s: no post has its height from it: it lies elsewhere, or finer ones cover it",
                raster_path(m->rasters[i]));
        else
            note_raster(m, m->rasters[i], "heights");
    }
    for (uint32_t i = 0; i < given.cover_count; i++)
        note_raster(m, m->covers[i], "cover");
    for (uint32_t i = 0; i < given.road_count; i++) {
        const char *name = strrchr(given.roads[i], '/');
        note(m, "roads: %s\n", name ? name + 1 : given.roads[i]);
    }
    if (given.road_count > 0)
        note(m, "roads: %u, %.1f of %.1f km\n", m->roads.roads, m->roads.kept_m / 1000.0,
             m->roads.all_m / 1000.0);
    for (uint32_t i = 0; i < given.feature_count; i++) {
        const char *name = strrchr(given.features[i], '/');
        note(m, "features: %s\n", name ? name + 1 : given.features[i]);
    }
    for (uint32_t i = 0; i < m->features.lines; i++)
        rivers += m->features.line[i].width_m > 0.0; /* others are coastlines */
    if (given.feature_count > 0)
        note(m, "features: %u buildings, %u plants and poles, %u areas, %u rivers\n",
             m->features.buildings.count, m->plants.count, m->features.areas, rivers);
    if (m->sea.posts > 0)
        note(m, "sea: %" PRIu64 " posts beyond coastlines\n", m->sea.posts);
    if (given.licence)
        note(m, "licence: %s\n", given.licence);
    if (m->counts.filled > 0)
        note(m, "voids: %" PRIu64 " posts interpolated\n", m->counts.filled);
    if (m->guessed > 0)
        note(m, "cover: guessed from slope and height at %" PRIu64 " posts\n", m->guessed);
}

/* Water comes before roads, which cross it. */
static void shape(struct making *m)
{
    const struct terrain terrain = {.posts = m->posts,
                                    .cover = m->cover,
                                    .side = m->grid.side,
                                    .spacing_m = given.side_m / (m->grid.side - 1)};
    int result = map_cover_coasts(&m->features, &m->grid, m->posts, m->cover, &m->sea);
    if (result == 0)
        result = map_cover_areas(&m->features, &m->grid, m->posts, m->cover);
    if (result == 0)
        result = map_cover_rivers(&m->features, &m->grid, m->cover);
    if (result == 0)
        result = road_map_pave(&m->roads, &m->grid, m->posts, m->cover);
    if (result == 0)
        result = buildings_found(&m->features.buildings, &terrain);
    if (result == 0)
        result = map_cover_plant(&m->plants, &m->features, &m->grid, &terrain, m->roads.points,
                                 m->roads.count, given.trees_per_ha, given.seed);
    if (result != 0)
        die_refused("no memory for the features of the maps");
}

/* Names the place of the first post without a height, and the finest map that should have one. */
static void tell_voids(const struct making *m)
{
    double latitude, longitude, extent[4];
    const char *finest = NULL;
    uint32_t around = 0;
    size_t row = m->counts.first / m->grid.side, column = m->counts.first % m->grid.side;
    projection_place(&m->grid.projection, (double)column * m->grid.spacing_m,
                     (double)row * m->grid.spacing_m, &latitude, &longitude);
    for (uint32_t i = 0; i < m->count; i++) {
        raster_extent(m->rasters[i], extent);
        /* A map beyond the date line has its longitudes a turn further. */
        if (latitude < extent[0] || latitude > extent[2] ||
            fmod(longitude - extent[1] + 720.0, 360.0) > extent[3] - extent[1])
            continue;
        finest = around++ == 0 ? raster_path(m->rasters[i]) : finest;
    }
    log_warn("%s%s: %" PRIu64 " posts without a height were interpolated; the first at latitude "
             "%.5f, longitude %.5f",
             finest ? finest : "between the maps", around > 1 ? " and the coarser maps there" : "",
             m->counts.filled, latitude, longitude);
}

static void tell_gaps(const struct making *m)
{
    bool any = false;
    for (int i = 0; i < VECTOR_MAP_GAPS; i++) {
        const struct vector_map_gap_count *gap = &m->gaps.gap[i];
        const char *text = vector_map_gap_text((enum vector_map_gap)i);
        any |= gap->count > 0;
        if (gap->count > 0 && isfinite(gap->latitude_deg))
            log_warn("%s: %u %s; the first at latitude %.5f, longitude %.5f is number %lld",
                     gap->map, gap->count, text, gap->latitude_deg, gap->longitude_deg, gap->id);
        else if (gap->count > 0)
            log_warn("%s: %u %s; the first is number %lld", gap->map, gap->count, text, gap->id);
    }
    if (any)
        log_warn(
            "right would be a map with whole ways and areas, as osmium extract --strategy smart "
            "makes it");
}

static void tell_features(const struct making *m)
{
    const struct buildings *b = &m->features.buildings;
    double latitude, longitude;
    if (m->sea.coast && m->sea.posts == 0) {
        projection_place(&m->grid.projection, m->sea.coast_x, m->sea.coast_z, &latitude,
                         &longitude);
        log_warn("coastlines make no post sea, the first at latitude %.5f, longitude %.5f: what "
                 "lies between posts is lost; closer posts are given by --posts",
                 latitude, longitude);
    }
    if (m->sea.torn > 0) {
        projection_place(&m->grid.projection, m->sea.torn_x, m->sea.torn_z, &latitude, &longitude);
        log_warn("coastlines contradict each other at %u places along rows of posts or their "
                 "first column, and are torn or turned: the first at latitude %.5f, longitude %.5f",
                 m->sea.torn, latitude, longitude);
    }
    for (int i = 0; i < FEATURE_TROUBLES; i++) {
        const struct feature_trouble_count *t = &m->features.trouble[i];
        if (t->count > 0 && isfinite(t->latitude_deg))
            log_warn("%s: %u %s; the first at latitude %.5f, longitude %.5f is number %lld", t->map,
                     t->count, features_trouble_text((enum feature_trouble)i), t->latitude_deg,
                     t->longitude_deg, t->feature);
        else if (t->count > 0)
            log_warn("%s: %u %s; the first is number %lld", t->map, t->count,
                     features_trouble_text((enum feature_trouble)i), t->feature);
    }
    for (uint32_t i = 0; i < m->gaps.outsides; i++)
        log_warn("%s: nothing of it is used: within the square it has no %s",
                 m->gaps.outside[i].map, m->gaps.outside[i].what);
    tell_gaps(m);
    if (b->lost_m2 > 0.0)
        log_warn("%.3f of %.0f m2 of buildings are left out: parts narrower than %d mm", b->lost_m2,
                 b->area_m2, GROUND_PART_WIDTH_MM);
    if (b->left_out > 0)
        log_warn("a ground has room for %u buildings: the %u smallest are left out",
                 GROUND_BUILDINGS_MAX, b->left_out);
    if (m->plants.left_out > 0)
        log_warn("a ground has room for %u objects: woods and scrub have %.2f plants a hectare, "
                 "not %g",
                 GROUND_OBJECTS_MAX,
                 m->plants.planted_per_ha * m->plants.count /
                     ((double)m->plants.count + m->plants.left_out),
                 given.trees_per_ha);
}

static void fill(struct making *m)
{
    struct error_text error;
    if (heights_fill(m->posts, &m->grid, m->rasters, m->count, m->pool, &m->counts, &error) != 0 ||
        cover_map_fill(m->cover, m->posts, &m->grid, m->covers, given.cover_count, m->table,
                       &m->guessed, &error) != 0 ||
        road_map_read(&m->roads, given.roads, given.road_count, &m->grid, &m->gaps, &error) != 0 ||
        features_read(&m->features, given.features, given.feature_count, &m->grid, &m->gaps,
                      &error) != 0) {
        progress_end();
        die_refused("%s", error.text);
    }
    shape(m);
    tell_features(m);
    if (m->roads.bad > 0)
        log_warn("%s: %u lines of one point or none, or with a place that is none, are no roads; "
                 "the first is number %lld",
                 m->roads.bad_map, m->roads.bad, m->roads.bad_feature);
    if (m->roads.left_out > 0)
        log_warn("a ground has room for %u points of roads: %u less important roads are left out, "
                 "%.1f of %.1f km",
                 GROUND_ROAD_POINTS_MAX, m->roads.left_out,
                 (m->roads.all_m - m->roads.kept_m) / 1000.0, m->roads.all_m / 1000.0);
    tell_sources(m);
}

static void begin(struct making *m)
{
    uint32_t side = (uint32_t)(given.side_m / given.spacing_m) + 1;
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t posts = (size_t)side * side;
    if (given.threads == 0)
        given.threads = (uint32_t)fmin(fmax((double)processors, 1.0), THREAD_POOL_MAX);
    m->grid = (struct post_grid){
        .longitude_deg = given.longitude_deg, .side = side, .spacing_m = given.spacing_m};
    projection_make(&m->grid.projection, given.latitude_deg, given.longitude_deg, given.side_m);
    m->pool = thread_pool_create(given.threads);
    m->posts = malloc(posts * sizeof *m->posts);
    m->cover = malloc(posts);
    m->text = calloc(GROUND_TEXT_BYTES_MAX, 1);
    m->table = malloc(sizeof *m->table);
    if (!m->pool || !m->posts || !m->cover || !m->text || !m->table)
        die_refused("no memory for %u x %u posts", side, side);
}

static void finish(struct making *m)
{
    for (uint32_t i = 0; i < m->count; i++)
        raster_close(m->rasters[i]);
    for (uint32_t i = 0; i < given.cover_count; i++)
        raster_close(m->covers[i]);
    thread_pool_destroy(m->pool);
    road_map_free(&m->roads);
    features_free(&m->features);
    map_cover_free(&m->plants);
    free(m->rasters);
    free(m->counts.from);
    free(m->posts);
    free(m->cover);
    free(m->text);
    free(m->table);
}

/* Refuses a file to write that is one of the maps, before anything is computed. */
static void check_out(char *const *inputs, uint32_t count)
{
    struct error_text error;
    char *classes[] = {(char *)(uintptr_t)given.classes};
    if (out_file_check(given.out, inputs, count, &error) != 0 ||
        out_file_check(given.out, given.covers, given.cover_count, &error) != 0 ||
        out_file_check(given.out, given.roads, given.road_count, &error) != 0 ||
        out_file_check(given.out, given.features, given.feature_count, &error) != 0 ||
        out_file_check(given.out, classes, 1, &error) != 0)
        die_refused("%s", error.text);
}

int make_run(int argc, char **argv)
{
    struct making m = {0};
    struct error_text error;
    int inputs = read_options(argc, argv);
    check_out(argv + argc - inputs, (uint32_t)inputs);
    begin(&m);
    open_rasters(&m, argv + argc - inputs, (uint32_t)inputs);
    fill(&m);
    struct ground_header header = {.flags = m.guessed > 0 ? GROUND_COVER_GUESSED : 0,
                                   .latitude_deg = given.latitude_deg,
                                   .longitude_deg = given.longitude_deg,
                                   .side_m = given.side_m,
                                   .spacing_m = given.side_m / (m.grid.side - 1),
                                   .undulation_m = given.undulation_m,
                                   .posts_side = m.grid.side};
    const struct ground_content content = {.posts = m.posts,
                                           .cover = m.cover,
                                           .text = m.text,
                                           .roads = m.roads.points,
                                           .road_points = m.roads.count,
                                           .objects = m.plants.object,
                                           .object_count = m.plants.count,
                                           .buildings = m.features.buildings.made,
                                           .building_count = m.features.buildings.count,
                                           .corners = m.features.buildings.corner,
                                           .corner_count = m.features.buildings.corners};
    int result = ground_write(given.out, &header, &content, m.pool, &error);
    progress_end();
    if (result != 0)
        die_refused("%s", error.text);
    if (m.counts.filled > 0)
        tell_voids(&m);
    if (m.guessed > 0)
        log_warn("no map of cover for %" PRIu64 " of %" PRIu64
                 " posts: their cover is guessed from "
                 "slope and height",
                 m.guessed, (uint64_t)m.grid.side * m.grid.side);
    printf("%s  %016" PRIx64 "  %g km, %u x %u posts, %g to %g m\n", given.out, header.hash,
           given.side_m / 1000.0, header.posts_side, header.posts_side, (double)header.lowest_m,
           (double)header.highest_m);
    finish(&m);
    return EXIT_OK;
}
