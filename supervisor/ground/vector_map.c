/* Reads features of maps layer by layer. */
#include "supervisor/ground/vector_map.h"
#include "supervisor/ground/grown_list.h"

#include "supervisor/ground/progress.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* OpenStreetMap's layers. Each is read alone, because the others would fill the memory. Relations
 * of lines are the same lines once more. Areas come before the lines that are their outlines. */
static const struct {
    const char *name;
    enum vector_map_shapes shape;
} osm_layers[] = {{"points", VECTOR_MAP_POINTS},
                  {"multipolygons", VECTOR_MAP_AREAS},
                  {"lines", VECTOR_MAP_LINES}};
#define OSM_LAYERS (sizeof osm_layers / sizeof osm_layers[0])

/* How GDAL's driver reads OpenStreetMap, instead of its osmconf.ini. A closed way is a line, never
 * an area, because of lines alone the driver tells missing nodes. Parts of relations have no words
 * and are told, too. Other keys than those that are asked for would only cost time. */
#define OSM_KEYS                                                                                   \
    "osm_id=yes\nother_tags=no\nattributes=highway,building,power,man_made,natural,landuse,"       \
    "waterway,water,area,width,height,building:levels,roof:shape\n"
#define OSM_LAYERS_KEYS                                                                            \
    "report_all_ways=yes\nattribute_name_laundering=no\n"                                          \
    "[points]\n" OSM_KEYS "[lines]\n" OSM_KEYS "[multipolygons]\n" OSM_KEYS
static char osm_settings[] = "closed_ways_are_polygons=\n" OSM_LAYERS_KEYS;
/* For relations closed ways are areas, so that one without words has those of its outer way. To
 * keep all houses for it would take half as long again. */
static char osm_relations[] = "closed_ways_are_polygons=natural,landuse,waterway\n" OSM_LAYERS_KEYS;

static unsigned shapes_of(OGRwkbGeometryType type)
{
    switch ((int)wkbFlatten(type)) {
    case wkbPoint:
    case wkbMultiPoint:
        return VECTOR_MAP_POINTS;
    case wkbLineString:
    case wkbMultiLineString:
        return VECTOR_MAP_LINES;
    case wkbPolygon:
    case wkbMultiPolygon:
        return VECTOR_MAP_AREAS;
    case wkbUnknown:
    case wkbGeometryCollection:
        return VECTOR_MAP_POINTS | VECTOR_MAP_LINES | VECTOR_MAP_AREAS;
    default:
        return 0;
    }
}

static OGRCoordinateTransformationH make_to_earth(OGRLayerH layer)
{
    OGRSpatialReferenceH given = OGR_L_GetSpatialRef(layer);
    OGRCoordinateTransformationH made = NULL;
    if (!given)
        return NULL;
    OGRSpatialReferenceH earth = OSRNewSpatialReference(NULL), own = OSRClone(given);
    OSRImportFromEPSG(earth, 4326);
    OSRSetAxisMappingStrategy(earth, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(own, OAMS_TRADITIONAL_GIS_ORDER);
    made = OCTNewCoordinateTransformation(own, earth);
    OSRDestroySpatialReference(own);
    OSRDestroySpatialReference(earth);
    return made;
}

static const char osm_way_id[] = "osm_way_id";

/* Numbers of the fields of the layer that is read: GDAL compares the names of all fields with a
 * key, which took a seventh of the time of an extract of OpenStreetMap. */
#define FIELDS_MAX 16u
static struct {
    const char *key;
    int field;
} fields[FIELDS_MAX];
static uint32_t fields_used;

/* GDAL alone takes "Building" for "building", where a map has both. */
static int find_field(OGRFeatureH feature, const char *key)
{
    for (int i = 0; i < OGR_F_GetFieldCount(feature); i++) {
        if (strcmp(OGR_Fld_GetNameRef(OGR_F_GetFieldDefnRef(feature, i)), key) == 0)
            return i;
    }
    return OGR_F_GetFieldIndex(feature, key);
}

/* Returns the number of a field, -1 without one. key: a text that stays where it is. */
static int field_of(OGRFeatureH feature, const char *key)
{
    for (uint32_t i = 0; i < fields_used; i++) {
        if (fields[i].key == key)
            return fields[i].field;
    }
    int field = find_field(feature, key);
    if (fields_used < FIELDS_MAX) {
        fields[fields_used].key = key;
        fields[fields_used++].field = field;
    }
    return field;
}

/* Notes where the way is that has the first gap: GDAL tells the gap before it gives the way. */
static void place_gap(struct vector_map *map, OGRFeatureH feature, OGRGeometryH geometry)
{
    if (vector_map_number(feature) != map->unplaced->id)
        return;
    if (geometry && OGR_G_GetPointCount(geometry) > 0) {
        map->unplaced->latitude_deg = OGR_G_GetY(geometry, 0);
        map->unplaced->longitude_deg = OGR_G_GetX(geometry, 0);
    }
    map->unplaced = NULL;
}

/* Returns true for an area of OpenStreetMap that is a closed way. */
static bool is_way(OGRFeatureH feature)
{
    int field = field_of(feature, osm_way_id);
    return field >= 0 && OGR_F_IsFieldSetAndNotNull(feature, field);
}

static int read_layer(struct vector_map *map, OGRLayerH layer, vector_map_feature *feature,
                      void *context, struct error_text *error)
{
    uint32_t features = 0;
    fields_used = 0;
    progress_count(map->path, OGR_L_GetName(layer), 0);
    map->to_earth = make_to_earth(layer);
    if (!map->to_earth)
        return error_text_set(error,
                              "%s: its projection is not known; right would be: ogr2ogr -a_srs "
                              "EPSG:4326 PLACED.gpkg %s, if it has degrees of WGS 84",
                              map->path, map->path);
    for (OGRFeatureH f = OGR_L_GetNextFeature(layer); f && !map->no_memory;
         f = OGR_L_GetNextFeature(layer)) {
        if (map->unplaced)
            place_gap(map, f, OGR_F_GetGeometryRef(f));
        if (!map->relations_alone || !is_way(f))
            feature(context, map, f, OGR_F_GetGeometryRef(f));
        OGR_F_Destroy(f);
        if (++features % 1024 == 0)
            progress_count(map->path, OGR_L_GetName(layer), features);
    }
    OCTDestroyCoordinateTransformation(map->to_earth);
    map->to_earth = NULL;
    return map->no_memory ? error_text_memory(error) : 0;
}

static const char *const gap_texts[VECTOR_MAP_GAPS] = {
    [VECTOR_MAP_GAP_NODES] = "ways have nodes that the map lacks, and are made of the others",
    [VECTOR_MAP_GAP_WAY] = "ways have fewer than two nodes in the map, and are left out",
    [VECTOR_MAP_GAP_RELATION] = "areas have ways that the map lacks, and are left out"};

const char *vector_map_gap_text(enum vector_map_gap gap)
{
    return gap_texts[gap];
}

/* What is read, for the handler of GDAL's messages. */
struct gap_reading {
    struct vector_map *map;
    struct vector_map_gaps *gaps;
    enum vector_map_shapes shape;
};

static void add_gap(const struct gap_reading *reading, enum vector_map_gap which, long long id)
{
    struct vector_map_gap_count *gap = &reading->gaps->gap[which];
    if (gap->count++ > 0)
        return;
    gap->map = reading->map->path;
    gap->id = id;
    gap->latitude_deg = gap->longitude_deg = NAN;
    if (which == VECTOR_MAP_GAP_NODES)
        reading->map->unplaced = gap;
}

/* Takes what GDAL's driver tells of missing parts, which it does in words alone. */
static void CPL_STDCALL take_message(CPLErr class, CPLErrorNum number, const char *text)
{
    const struct gap_reading *reading = CPLGetErrorHandlerUserData();
    long long id;
    int end = 0;
    (void)number;
    if (class != CE_Debug)
        return;
    if (reading->shape == VECTOR_MAP_LINES) {
        if (sscanf(text, "OSM: For way %lld, got only %n", &id, &end) == 1 && end > 0)
            add_gap(reading, VECTOR_MAP_GAP_NODES, id);
        else if (sscanf(text, "OSM: Way %lld with %*d nodes%n", &id, &end) == 1 && end > 0)
            add_gap(reading, VECTOR_MAP_GAP_WAY, id);
    } else if (reading->shape == VECTOR_MAP_AREAS &&
               sscanf(text, "OSM: Relation %lld has missing ways%n", &id, &end) == 1 && end > 0) {
        add_gap(reading, VECTOR_MAP_GAP_RELATION, id);
    }
}

/* Returns true if the map was not in the list, in which it is then. */
static bool is_first_reading(const char *list[VECTOR_MAP_READS_MAX], const char *path)
{
    uint32_t i = 0;
    while (i < VECTOR_MAP_READS_MAX && list[i] && strcmp(list[i], path) != 0)
        i++;
    if (i == VECTOR_MAP_READS_MAX || list[i])
        return false;
    list[i] = path;
    return true;
}

/* Lets GDAL's driver of OpenStreetMap read as these settings say [bytes, with the NUL]. */
static void set_osm(char *settings, size_t bytes)
{
    static const char path[] = "/vsimem/jolon-osm.ini";
    VSILFILE *file = VSIFileFromMemBuffer(path, (GByte *)settings, bytes - 1, FALSE);
    if (file)
        VSIFCloseL(file);
    CPLSetConfigOption("OSM_CONFIG_FILE", path);
}

static GDALDatasetH open_map(const char *path, struct error_text *error)
{
    CPLErrorReset();
    GDALDatasetH data = GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!data)
        error_text_set(error, "%s: GDAL cannot read it as a map of points, lines and areas: %s",
                       path, raster_open_reason(path));
    return data;
}

/* Returns true for OpenStreetMap as XML: such files are small, and editors save them with nodes in
 * any order and numbers below zero, which GDAL's own index of nodes does not take. */
static bool is_xml(const char *path)
{
    char begin[4] = "";
    VSILFILE *file = VSIFOpenL(path, "rb");
    size_t read = file ? VSIFReadL(begin, 1, sizeof begin, file) : 0;
    if (file)
        VSIFCloseL(file);
    return read > 0 && (begin[0] == '<' || memcmp(begin, "\xef\xbb\xbf<", sizeof begin) == 0);
}

static int refuse_osm(const char *path, struct error_text *error)
{
    const char *reason = CPLGetLastErrorMsg();
    return error_text_set(error, "%s: cannot be read: %s%s", path, reason,
                          strstr(reason, "CUSTOM_INDEXING")
                              ? "; right would be a map with its nodes in order, as osmium sort "
                                "and, for numbers below "
                                "zero, osmium renumber make it, or the same as .osm"
                              : "");
}

/* Reads one of OpenStreetMap's layers, for which the file is read as a whole. */
static int read_osm(struct vector_map *map, uint32_t which, vector_map_feature *feature,
                    void *context, struct vector_map_gaps *gaps, struct error_text *error)
{
    char words[64];
    struct gap_reading reading = {map, gaps, osm_layers[which].shape};
    bool listens =
        (reading.shape == VECTOR_MAP_LINES && is_first_reading(gaps->lines_read, map->path)) ||
        (reading.shape == VECTOR_MAP_AREAS && is_first_reading(gaps->areas_read, map->path));
    map->relations_alone = reading.shape == VECTOR_MAP_AREAS;
    if (map->relations_alone)
        set_osm(osm_relations, sizeof osm_relations);
    else
        set_osm(osm_settings, sizeof osm_settings);
    CPLSetConfigOption("OSM_USE_CUSTOM_INDEXING", is_xml(map->path) ? "NO" : NULL);
    GDALDatasetH data = open_map(map->path, error);
    if (!data)
        return -1;
    snprintf(words, sizeof words, "SET interest_layers = %s", osm_layers[which].name);
    GDALDatasetReleaseResultSet(data, GDALDatasetExecuteSQL(data, words, NULL, NULL));
    OGRLayerH layer = GDALDatasetGetLayerByName(data, osm_layers[which].name);
    if (listens) {
        CPLSetConfigOption("CPL_DEBUG", "OSM");
        CPLPushErrorHandlerEx(take_message, &reading);
    }
    int result = layer ? read_layer(map, layer, feature, context, error) : 0;
    if (listens) {
        CPLPopErrorHandler();
        CPLSetConfigOption("CPL_DEBUG", NULL);
    }
    map->unplaced = NULL;
    if (result == 0 && CPLGetLastErrorType() >= CE_Failure)
        result = refuse_osm(map->path, error);
    GDALClose(data);
    return result;
}

static int read_layers(struct vector_map *map, GDALDatasetH data, unsigned shapes, uint32_t *read,
                       vector_map_feature *feature, void *context, struct error_text *error)
{
    for (int i = 0; i < GDALDatasetGetLayerCount(data); i++) {
        OGRLayerH layer = GDALDatasetGetLayer(data, i);
        if (!(shapes_of(OGR_L_GetGeomType(layer)) & shapes))
            continue;
        ++*read;
        if (read_layer(map, layer, feature, context, error) != 0)
            return -1;
        if (CPLGetLastErrorType() >= CE_Failure)
            return error_text_set(error, "%s: cannot be read: %s", map->path, CPLGetLastErrorMsg());
    }
    return 0;
}

int vector_map_read(const char *path, const struct post_grid *grid, unsigned shapes,
                    const char *what, vector_map_feature *feature, void *context,
                    struct vector_map_gaps *gaps, struct error_text *error)
{
    struct vector_map map = {.path = path, .grid = grid};
    uint32_t read = 0;
    int result = 0;
    GDALDatasetH data = open_map(path, error);
    if (!data)
        return -1;
    bool osm = strcmp(GDALGetDriverShortName(GDALGetDatasetDriver(data)), "OSM") == 0;
    if (!osm)
        result = read_layers(&map, data, shapes, &read, feature, context, error);
    GDALClose(data);
    for (uint32_t i = 0; osm && i < OSM_LAYERS && result == 0; i++) {
        read++;
        if (osm_layers[i].shape & shapes)
            result = read_osm(&map, i, feature, context, gaps, error);
    }
    if (result == 0 && read == 0)
        result = error_text_set(error, "%s: has no %s", path, what);
    if (!map.inside && gaps->outsides < VECTOR_MAP_READS_MAX) {
        gaps->outside[gaps->outsides].map = path;
        gaps->outside[gaps->outsides++].what = what;
    }
    return result;
}

static bool touches_square(const struct vector_map *map, const struct vector_map_track *track)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    double side = 2.0 * map->grid->projection.middle_m;
    for (uint32_t i = 0; i < track->count; i++) {
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], track->place[i][k]);
            high[k] = fmax(high[k], track->place[i][k]);
        }
    }
    return low[0] <= side && low[1] <= side && high[0] >= 0.0 && high[1] >= 0.0;
}

bool vector_map_track(struct vector_map *map, OGRGeometryH geometry, struct vector_map_track *track)
{
    int count = OGR_G_GetPointCount(geometry);
    track->count = 0;
    if (count < 1)
        return false;
    if ((uint32_t)count > track->room) {
        double(*larger)[2] = realloc(track->place, (size_t)count * sizeof *track->place);
        map->no_memory |= !larger;
        if (!larger)
            return false;
        track->place = larger;
        track->room = (uint32_t)count;
    }
    for (int i = 0; i < count; i++) {
        double x = OGR_G_GetX(geometry, i), y = OGR_G_GetY(geometry, i);
        if (!isfinite(x) || !isfinite(y) ||
            (map->to_earth && !OCTTransform(map->to_earth, 1, &x, &y, NULL)) ||
            !(fabs(y) <= 90.0) || !(fabs(x) <= 540.0)) {
            CPLErrorReset(); /* the caller counts the geometry as bad, and the map goes on */
            return false;
        }
        projection_world(&map->grid->projection, y, x, &track->place[i][0], &track->place[i][1]);
    }
    track->count = (uint32_t)count;
    map->inside = map->inside || touches_square(map, track);
    return true;
}

void vector_map_track_free(struct vector_map_track *track)
{
    free(track->place);
    *track = (struct vector_map_track){0};
}

#define COURT_MOST_DEG 0.01 /* of latitude; no building is longer */
#define WITHIN_SHARE   0.02 /* of a hole may lie outside of its outline */

/* Returns what a ring of a polygon encloses, mended by GDAL; NULL if it cannot. */
static OGRGeometryH enclosed(OGRGeometryH polygon, int ring)
{
    OGRGeometryH alone = OGR_G_CreateGeometry(wkbPolygon);
    OGR_G_AddGeometry(alone, OGR_G_GetGeometryRef(polygon, ring));
    OGRGeometryH good = OGR_G_MakeValid(alone);
    OGR_G_DestroyGeometry(alone);
    return good;
}

/* GDAL alone fills a hole that has a side on the outline. */
OGRGeometryH vector_map_mend(OGRGeometryH polygon)
{
    OGRGeometryH good = enclosed(polygon, 0);
    for (int i = 1; i < OGR_G_GetGeometryCount(polygon) && good; i++) {
        OGRGeometryH yard = enclosed(polygon, i);
        OGRGeometryH less = yard ? OGR_G_Difference(good, yard) : NULL;
        if (yard)
            OGR_G_DestroyGeometry(yard);
        OGR_G_DestroyGeometry(good);
        good = less;
    }
    CPLErrorReset();
    return good;
}

bool vector_map_lies_within(const struct vector_map_polygon *inner,
                            const struct vector_map_polygon *outer)
{
    const OGREnvelope *in = &inner->box, *out = &outer->box;
    double beyond = WITHIN_SHARE * fmax(in->MaxX - in->MinX, in->MaxY - in->MinY);
    if (inner->area >= outer->area || in->MinX < out->MinX - beyond ||
        in->MinY < out->MinY - beyond || in->MaxX > out->MaxX + beyond ||
        in->MaxY > out->MaxY + beyond)
        return false;
    OGRGeometryH both = OGR_G_Intersection(inner->shape, outer->shape);
    CPLErrorReset(); /* there is none of polygons that cross themselves, which stay as they are */
    bool within = both && OGR_G_Area(both) > (1.0 - WITHIN_SHARE) * inner->area;
    if (both)
        OGR_G_DestroyGeometry(both);
    return within;
}

struct vector_map_polygon *vector_map_polygons(OGRGeometryH areas)
{
    uint32_t count = (uint32_t)OGR_G_GetGeometryCount(areas);
    struct vector_map_polygon *polygon = calloc((size_t)count + 1, sizeof *polygon);
    for (uint32_t i = 0; i < count && polygon; i++) {
        polygon[i].shape = OGR_G_GetGeometryRef(areas, (int)i);
        polygon[i].area = OGR_G_Area(polygon[i].shape);
        OGR_G_GetEnvelope(polygon[i].shape, &polygon[i].box);
    }
    for (uint32_t i = 0; i < count && polygon; i++) {
        for (uint32_t k = 0; k < count; k++)
            polygon[i].around += vector_map_lies_within(&polygon[i], &polygon[k]);
    }
    return polygon;
}

static int by_box(const void *left, const void *right)
{
    const OGREnvelope *p = &((const struct vector_map_court *)left)->box;
    const OGREnvelope *q = &((const struct vector_map_court *)right)->box;
    const double off[4] = {p->MinX - q->MinX, p->MinY - q->MinY, p->MaxX - q->MaxX,
                           p->MaxY - q->MaxY};
    for (int i = 0; i < 4; i++) {
        if (off[i] != 0.0)
            return off[i] < 0.0 ? -1 : 1;
    }
    return 0;
}

bool vector_map_courts_keep(struct vector_map_courts *courts, OGRGeometryH areas)
{
    for (int i = 0; i < OGR_G_GetGeometryCount(areas); i++) {
        struct vector_map_court court = {.shape = OGR_G_GetGeometryRef(areas, i)};
        OGR_G_GetEnvelope(court.shape, &court.box);
        if (wkbFlatten(OGR_G_GetGeometryType(court.shape)) != wkbPolygon ||
            OGR_G_GetGeometryCount(court.shape) < 2 ||
            court.box.MaxY - court.box.MinY > COURT_MOST_DEG)
            continue;
        struct vector_map_court *larger =
            grown_list(courts->court, courts->count, &courts->room, 256, sizeof *larger);
        if (!larger)
            return false;
        courts->court = larger;
        court.shape = OGR_G_Clone(court.shape);
        courts->court[courts->count++] = court;
        courts->sorted = false;
    }
    return true;
}

OGRGeometryH vector_map_courts_find(struct vector_map_courts *courts, OGRGeometryH way)
{
    struct vector_map_court court = {.shape = way};
    if (courts->count == 0)
        return NULL;
    if (!courts->sorted)
        qsort(courts->court, courts->count, sizeof *courts->court, by_box);
    courts->sorted = true;
    OGR_G_GetEnvelope(way, &court.box);
    const struct vector_map_court *found =
        bsearch(&court, courts->court, courts->count, sizeof *courts->court, by_box);
    return found ? found->shape : NULL;
}

void vector_map_courts_free(struct vector_map_courts *courts)
{
    for (uint32_t i = 0; i < courts->count; i++)
        OGR_G_DestroyGeometry(courts->court[i].shape);
    free(courts->court);
    *courts = (struct vector_map_courts){0};
}

static const char other_tags[] = "other_tags";

/* Finds a key in a list "a"=>"b","c"=>"d", in which a backslash stands before quotes. */
static const char *find_in_list(const char *list, const char *key, char *buffer, uint32_t bytes)
{
    size_t length = strlen(key);
    for (const char *at = list; (at = strstr(at, key)) != NULL; at += length) {
        if (at == list || at[-1] != '"' || (at - 1 != list && at[-2] != ',') ||
            strncmp(at + length, "\"=>\"", 4) != 0)
            continue;
        uint32_t used = 0;
        for (at += length + 4; *at && *at != '"' && used + 1 < bytes; at++) {
            if (*at == '\\' && at[1])
                at++;
            buffer[used++] = *at;
        }
        buffer[used] = '\0';
        return buffer;
    }
    return "";
}

long long vector_map_number(OGRFeatureH feature)
{
    static const char *const keys[] = {"osm_id", osm_way_id};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        int field = field_of(feature, keys[i]);
        if (field >= 0 && OGR_F_IsFieldSetAndNotNull(feature, field))
            return OGR_F_GetFieldAsInteger64(feature, field);
    }
    return OGR_F_GetFID(feature);
}

const char *vector_map_tag(OGRFeatureH feature, const char *key, char *buffer, uint32_t bytes)
{
    int field = field_of(feature, key);
    if (field >= 0 && OGR_F_IsFieldSetAndNotNull(feature, field))
        return OGR_F_GetFieldAsString(feature, field);
    field = field_of(feature, other_tags);
    if (field < 0 || !OGR_F_IsFieldSetAndNotNull(feature, field))
        return "";
    return find_in_list(OGR_F_GetFieldAsString(feature, field), key, buffer, bytes);
}
