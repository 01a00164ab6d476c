/* Opens, checks and orders rasters. raster_sample.c reads and samples them. */
#include "supervisor/ground/raster.h"

#include "ipc/process/log.h"
#include "supervisor/ground/raster_internal.h"
#include "world/maths/maths.h"

#include <cpl_error.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define METRES_PER_FOOT        0.3048
#define METRES_PER_SURVEY_FOOT (1200.0 / 3937.0)

static const char *last_error(void)
{
    const char *text = CPLGetLastErrorMsg();
    return text[0] != '\0' ? text : "GDAL gives no reason";
}

/* GDAL is silent about files that no driver takes. */
const char *raster_open_reason(const char *path)
{
    const char *text = CPLGetLastErrorMsg();
    struct stat status;
    if (text[0] != '\0')
        return text;
    if (stat(path, &status) != 0)
        return strerror(errno);
    if (S_ISDIR(status.st_mode))
        return "it is a folder";
    return status.st_size == 0 ? "it is empty" : "it has no format that GDAL knows";
}

/* Says why a file is no raster. GDAL is silent about a tile of SRTM that is cut off. */
static int refuse_file(const char *path, struct error_text *error)
{
    const char *ending = strrchr(path, '.'), *reason = CPLGetLastErrorMsg();
    struct stat status;
    if (reason[0] == '\0' && ending && strcasecmp(ending, ".hgt") == 0 &&
        stat(path, &status) == 0) {
        long long bytes = (long long)status.st_size;
        if (bytes == 2884802 || bytes == 12970802 || bytes == 25934402)
            return error_text_set(error,
                                  "%s: is as long as a tile of heights, but its name does not say "
                                  "where it lies; right would be the latitude and longitude of its "
                                  "south-west corner, as N44W072.hgt",
                                  path);
        return error_text_set(
            error,
            "%s: has %lld bytes; a tile of heights has 2884802 (1,201 x 1,201), "
            "12970802 or 25934402 (1,801 or 3,601 x 3,601), and a name like N44W072.hgt",
            path, bytes);
    }
    return error_text_set(error, "%s: GDAL cannot read it as a raster: %s", path,
                          raster_open_reason(path));
}

/* Refuses a raw raster that is shorter than its header says, of which GDAL's driver ENVI takes the
 * end as zeros. Packed ones begin as gzip does. */
static int check_length(const struct raster *r, struct error_text *error)
{
    struct stat status;
    unsigned char begin[2] = {0};
    GDALDataType type = GDALGetRasterDataType(r->band);
    long long least = (long long)r->columns * r->rows * GDALGetDataTypeSizeBytes(type);
    if (strcmp(GDALGetDriverShortName(GDALGetDatasetDriver(r->dataset)), "ENVI") != 0 ||
        stat(r->path, &status) != 0 || (long long)status.st_size >= least)
        return 0;
    FILE *file = fopen(r->path, "re");
    bool packed = file && fread(begin, 1, sizeof begin, file) == sizeof begin && begin[0] == 0x1f &&
                  begin[1] == 0x8b;
    if (file)
        fclose(file);
    return packed ? 0
                  : error_text_set(error,
                                   "%s: has %lld bytes; its %d x %d pixels take %lld at least: it "
                                   "is cut off, or its header is wrong",
                                   r->path, (long long)status.st_size, r->columns, r->rows, least);
}

/* Refuses a TIFF without compression whose first block is shorter than its header says: GDAL reads
 * what follows in the file instead. */
static int check_block(const struct raster *r, struct error_text *error)
{
    int width = 0, height = 0;
    const char *bytes = GDALGetMetadataItem(r->band, "BLOCK_SIZE_0_0", "TIFF");
    if (!bytes || GDALGetMetadataItem(r->dataset, "COMPRESSION", "IMAGE_STRUCTURE") != NULL ||
        GDALGetMetadataItem(r->band, "NBITS", "IMAGE_STRUCTURE") != NULL)
        return 0;
    GDALGetBlockSize(r->band, &width, &height);
    long long least = (long long)width * (height < r->rows ? height : r->rows) *
                      GDALGetDataTypeSizeBytes(GDALGetRasterDataType(r->band));
    if (strtoll(bytes, NULL, 10) >= least)
        return 0;
    return error_text_set(error,
                          "%s: its first block has %s bytes; %d columns take %lld at least: its "
                          "header is wrong",
                          r->path, bytes, r->columns, least);
}

/* Sets the band, and its mask. One that GDAL makes of the mark of voids alone is not needed. */
static int find_band(struct raster *r, struct error_text *error)
{
    int bands = GDALGetRasterCount(r->dataset);
    bool alpha = bands == 2 && GDALGetRasterColorInterpretation(GDALGetRasterBand(r->dataset, 2)) ==
                                   GCI_AlphaBand;
    r->band = bands > 0 ? GDALGetRasterBand(r->dataset, 1) : NULL;
    int flags = r->band ? GDALGetMaskFlags(r->band) : 0;
    if (bands != 1 && !(alpha && (flags & GMF_ALPHA)))
        return error_text_set(error,
                              "%s: has %d bands; a raster of heights or classes has one%s. Right "
                              "would be: gdal_translate -b 1%s %s ONE.tif, if band 1 has them",
                              r->path, bands, alpha ? ", or a second of transparency as bytes" : "",
                              alpha ? " -mask 2" : "", r->path);
    if (!(flags & GMF_ALL_VALID) && flags != GMF_NODATA)
        r->mask = GDALGetMaskBand(r->band);
    return 0;
}

static int check_band(struct raster *r, enum raster_use use, struct error_text *error)
{
    if (find_band(r, error) != 0)
        return -1;
    if (use == RASTER_OF_HEIGHTS && GDALGetRasterColorTable(r->band) != NULL)
        return error_text_set(error, "%s: is a picture with a table of colours, not heights",
                              r->path);
    if (r->columns < 2 || r->rows < 2)
        return error_text_set(error, "%s: has %d x %d pixels; at least 2 x 2 are needed", r->path,
                              r->columns, r->rows);
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(r->band)))
        return error_text_set(error, "%s: has complex numbers", r->path);
    return check_length(r, error) == 0 ? check_block(r, error) : -1;
}

/* Returns the unit of heights that the file's place on the earth has with a vertical datum [m]. */
static double unit_of_place(const struct raster *r)
{
    OGRSpatialReferenceH given = GDALGetSpatialRef(r->dataset);
    bool vertical = given != NULL && OSRIsCompound(given);
    return vertical ? OSRGetTargetLinearUnits(given, "VERT_CS", NULL) : 1.0;
}

/* Sets how heights become metres. */
static int read_unit(struct raster *r, double to_metres, struct error_text *error)
{
    int given;
    const char *unit = GDALGetRasterUnitType(r->band);
    double scale = GDALGetRasterScale(r->band, &given);
    r->nodata = GDALGetRasterNoDataValue(r->band, &r->has_nodata);
    r->factor = given ? scale : 1.0;
    r->offset = GDALGetRasterOffset(r->band, &given);
    r->offset = given ? r->offset : 0.0;
    if (to_metres == 0.0) {
        to_metres = unit[0] == '\0' ? unit_of_place(r) : 1.0;
        if (strcasecmp(unit, "ft") == 0 || strcasecmp(unit, "feet") == 0 ||
            strcasecmp(unit, "foot") == 0)
            to_metres = METRES_PER_FOOT;
        else if (strcasecmp(unit, "US survey foot") == 0 || strcasecmp(unit, "us-ft") == 0)
            to_metres = METRES_PER_SURVEY_FOOT;
        else if (unit[0] != '\0' && strcasecmp(unit, "m") != 0 && strcasecmp(unit, "metre") != 0 &&
                 strcasecmp(unit, "meter") != 0 && strcasecmp(unit, "metres") != 0 &&
                 strcasecmp(unit, "meters") != 0)
            return error_text_set(error, "%s: has heights in \"%s\"; metres and feet are known",
                                  r->path, unit);
    }
    r->factor *= to_metres;
    r->offset *= to_metres;
    return 0;
}

/* Sets the way from places on WGS 84 to the raster's coordinates. */
static int find_place(struct raster *r, struct error_text *error)
{
    OGRSpatialReferenceH earth = OSRNewSpatialReference(NULL);
    OGRSpatialReferenceH given = GDALGetSpatialRef(r->dataset), own = NULL;
    OGRCoordinateTransformationOptionsH options = OCTNewCoordinateTransformationOptions();
    int result = 0;
    if (given == NULL) {
        result = error_text_set(error,
                                "%s: does not say its projection; right would be: gdal_translate "
                                "-a_srs EPSG:4326 %s PLACED.tif, if it has degrees of WGS 84",
                                r->path, r->path);
    } else {
        OSRImportFromEPSG(earth, 4326);
        own = OSRClone(given);
        if (OSRGetAxesCount(given) == 3 && !OSRIsCompound(given))
            log_warn("%s: says that its heights are above the ellipsoid, which lies up to 106 m "
                     "from the sea level; they are taken as heights above the sea level",
                     r->path);
        OSRStripVertical(own);
        OSRSetAxisMappingStrategy(earth, OAMS_TRADITIONAL_GIS_ORDER);
        OSRSetAxisMappingStrategy(own, OAMS_TRADITIONAL_GIS_ORDER);
        r->geographic = OSRIsGeographic(own) != 0;
        OCTCoordinateTransformationOptionsSetBallparkAllowed(options, 0);
        r->from_earth = OCTNewCoordinateTransformationEx(earth, own, options);
        r->to_earth = OCTNewCoordinateTransformationEx(own, earth, options);
        if (r->from_earth == NULL || r->to_earth == NULL)
            result = error_text_set(error,
                                    "%s: its projection cannot be converted to WGS 84: %s; right "
                                    "would be: gdalwarp -t_srs EPSG:4326 %s WARPED.tif",
                                    r->path, last_error(), r->path);
    }
    OCTDestroyCoordinateTransformationOptions(options);
    OSRDestroySpatialReference(earth);
    if (own != NULL)
        OSRDestroySpatialReference(own);
    return result;
}

/* Of a projected raster around a pole, the pole and all longitudes lie within its edge. */
static void extend_to_poles(struct raster *r)
{
    for (int south = 0; south < 2 && !r->geographic; south++) {
        double x = 0.0, y = south ? -90.0 : 90.0;
        bool found = OCTTransform(r->from_earth, 1, &x, &y, NULL) != 0;
        double c = r->inverse[0] + x * r->inverse[1] + y * r->inverse[2];
        double w = r->inverse[3] + x * r->inverse[4] + y * r->inverse[5];
        if (!found || !(c >= 0.0 && c <= r->columns && w >= 0.0 && w <= r->rows))
            continue;
        r->extent[south ? 0 : 2] = south ? -90.0 : 90.0;
        r->extent[1] = -180.0;
        r->extent[3] = 180.0;
    }
    CPLErrorReset(); /* of projections without a pole */
}

static int check_place(struct raster *r, struct error_text *error)
{
    if (GDALGetGeoTransform(r->dataset, r->transform) != CE_None ||
        !GDALInvGeoTransform(r->transform, r->inverse))
        return error_text_set(error,
                              "%s: does not say where on the earth it lies; right would be a file "
                              "with a geotransform, as a GeoTIFF or a name like N44W072.hgt",
                              r->path);
    if (find_place(r, error) != 0)
        return -1;
    /* Around the edge, since a rotated raster has its extremes at any corner. */
    double *e = r->extent;
    e[0] = e[1] = HUGE_VAL;
    e[2] = e[3] = -HUGE_VAL;
    for (int i = 0; i < 64; i++) {
        double share = (i & 15) / 15.0, columns = r->columns, rows = r->rows;
        double c = i < 32 ? share * columns : i < 48 ? 0.0 : columns;
        double w = i < 16 ? 0.0 : i < 32 ? rows : share * rows;
        double x = r->transform[0] + c * r->transform[1] + w * r->transform[2];
        double y = r->transform[3] + c * r->transform[4] + w * r->transform[5];
        if (!OCTTransform(r->to_earth, 1, &x, &y, NULL) || !(fabs(y) <= 90.5) ||
            !(fabs(x) <= 540.5))
            return error_text_set(error,
                                  "%s: its corner (%g, %g) lies nowhere on the earth: its "
                                  "projection is not that of its numbers",
                                  r->path, r->transform[0], r->transform[3]);
        e[0] = fmin(e[0], y);
        e[1] = fmin(e[1], x);
        e[2] = fmax(e[2], y);
        e[3] = fmax(e[3], x);
    }
    extend_to_poles(r);
    return 0;
}

/* Finds whether the raster goes round the earth, with half a pixel or less missing. */
static void find_turn(struct raster *r)
{
    double turn = floor(360.0 / fabs(r->transform[1]) + 0.5);
    if (r->geographic && r->transform[2] == 0.0 && r->transform[4] == 0.0 && turn <= r->columns)
        r->turn = (int)turn;
}

/* Sets the resolution [m], and as how many coarser pixels a fine raster is read. */
static void set_resolution(struct raster *r, enum raster_use use)
{
    double across = hypot(r->transform[1], r->transform[4]);
    double down = hypot(r->transform[2], r->transform[5]);
    double unit = 1.0, middle = 0.5 * (r->extent[0] + r->extent[2]);
    if (r->geographic)
        unit = DEGREE_M;
    r->resolution_m = down * unit;
    double width_m = across * unit * (r->geographic ? cos(middle * RAD_PER_DEG) : 1.0);
    double finer = fmin(r->resolution_m, width_m);
    r->coarser = 1;
    if (use == RASTER_OF_HEIGHTS && finer > 0.0 && r->grid.spacing_m >= 2.0 * finer)
        r->coarser =
            (int)fmin(floor(r->grid.spacing_m / finer), floor(0.5 * fmin(r->columns, r->rows)));
    /* The pixels go on behind a turn as they began. */
    while (r->turn % r->coarser != 0)
        r->coarser--;
    r->turn /= r->coarser;
    r->columns /= r->coarser;
    r->rows /= r->coarser;
}

static int fill(struct raster *r, enum raster_use use, double to_metres, struct error_text *error)
{
    r->columns = GDALGetRasterXSize(r->dataset);
    r->rows = GDALGetRasterYSize(r->dataset);
    if (check_band(r, use, error) != 0 || check_place(r, error) != 0 ||
        read_unit(r, to_metres, error) != 0)
        return -1;
    find_turn(r);
    set_resolution(r, use);
    return 0;
}

struct raster *raster_open(const char *path, enum raster_use use, const struct post_grid *grid,
                           double to_metres, struct error_text *error)
{
    struct raster *r = calloc(1, sizeof *r);
    if (!r) {
        error_text_memory(error);
        return NULL;
    }
    r->grid = *grid;
    r->path = path;
    CPLErrorReset();
    r->dataset = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (r->dataset == NULL)
        refuse_file(path, error);
    else if (fill(r, use, to_metres, error) == 0)
        return r;
    raster_close(r);
    return NULL;
}

void raster_close(struct raster *r)
{
    if (r->from_earth != NULL)
        OCTDestroyCoordinateTransformation(r->from_earth);
    if (r->to_earth != NULL)
        OCTDestroyCoordinateTransformation(r->to_earth);
    if (r->dataset != NULL)
        GDALClose(r->dataset);
    free(r->neighbours);
    free(r->window);
    free(r->nodes);
    free(r);
}

const char *raster_path(const struct raster *r)
{
    return r->path;
}

void raster_describe(const struct raster *r, char *text, uint32_t bytes)
{
    const char *name = strrchr(r->path, '/');
    snprintf(text, bytes, "%s: %s, %d x %d pixels of %.4g m", name ? name + 1 : r->path,
             GDALGetDriverLongName(GDALGetDatasetDriver(r->dataset)),
             GDALGetRasterXSize(r->dataset), GDALGetRasterYSize(r->dataset), r->resolution_m);
}

const char *raster_licence(const struct raster *r)
{
    const char *tiff = GDALGetMetadataItem(r->dataset, "TIFFTAG_COPYRIGHT", NULL);
    return tiff ? tiff : GDALGetMetadataItem(r->dataset, "COPYRIGHT", NULL);
}

void raster_extent(const struct raster *r, double extent[4])
{
    memcpy(extent, r->extent, sizeof r->extent);
}

int raster_order(const void *a, const void *b)
{
    const struct raster *p = *(struct raster *const *)a, *q = *(struct raster *const *)b;
    /* Tiles of one product differ in the last digits. */
    double finer = p->resolution_m / q->resolution_m;
    if (finer < 0.999 || finer > 1.001)
        return finer < 1.0 ? -1 : 1;
    for (int i = 0; i < 4; i++) {
        if (p->extent[i] != q->extent[i])
            return p->extent[i] < q->extent[i] ? -1 : 1;
    }
    return strcmp(p->path, q->path);
}

/* Returns true if both have one grid of pixels: the same projection, and pixels of the same size.
 */
static bool same_pixels(const struct raster *p, const struct raster *q)
{
    if (p->coarser != q->coarser ||
        !OSRIsSame(GDALGetSpatialRef(p->dataset), GDALGetSpatialRef(q->dataset)))
        return false;
    for (int i = 1; i < 6; i++) {
        double pixel = fabs(p->transform[1]) + fabs(p->transform[2]);
        if (i != 3 && fabs(p->transform[i] - q->transform[i]) > 1e-6 * pixel)
            return false;
    }
    return true;
}

void raster_join(struct raster **rasters, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        struct raster *r = rasters[i];
        r->neighbours = calloc(count, sizeof *r->neighbours);
        for (uint32_t k = 0; r->neighbours && k < count; k++) {
            if (k != i && same_pixels(r, rasters[k]))
                r->neighbours[r->neighbour_count++] = rasters[k];
        }
    }
}
