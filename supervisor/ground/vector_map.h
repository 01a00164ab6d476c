/* Maps of points, lines and areas, as GDAL reads them: OpenStreetMap (.osm, .pbf), GeoPackage,
 * Shapefile, GeoJSON. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_VECTOR_MAP_H
#define JOLON_SUPERVISOR_GROUND_VECTOR_MAP_H

#include "supervisor/ground/raster.h"

#include <ogr_api.h>

#include <stdbool.h>
#include <stdint.h>

/* Where the places of a geometry are: x to the east and z to the south of the north-west corner. */
struct vector_map_track {
    double (*place)[2]; /* [m] */
    uint32_t count, room;
};

/* What an extract of OpenStreetMap names and does not hold. */
enum vector_map_gap {
    VECTOR_MAP_GAP_NODES,    /* a line or an outline has the nodes that are there */
    VECTOR_MAP_GAP_WAY,      /* fewer than two nodes are there: the way is left out */
    VECTOR_MAP_GAP_RELATION, /* a way is missing, or makes no outline: the area is left out */
    VECTOR_MAP_GAPS
};

#define VECTOR_MAP_READS_MAX 256u

struct vector_map_gap_count {
    uint32_t count;
    const char *map;                    /* the first, */
    long long id;                       /* OpenStreetMap's number of its way or relation, */
    double latitude_deg, longitude_deg; /* and where it begins; NaN: nowhere in the map */
};

/* Gaps of all maps that were read; a map that is read for two purposes counts once. */
struct vector_map_gaps {
    struct vector_map_gap_count gap[VECTOR_MAP_GAPS];
    const char *lines_read[VECTOR_MAP_READS_MAX], *areas_read[VECTOR_MAP_READS_MAX];
    /* Readings in which no track came near the square: of these maps, for these shapes. */
    struct {
        const char *map, *what;
    } outside[VECTOR_MAP_READS_MAX];
    uint32_t outsides;
};

/* Returns what is said of gaps: "ways ...". */
const char *vector_map_gap_text(enum vector_map_gap gap);

struct vector_map {
    const char *path;
    const struct post_grid *grid;
    OGRCoordinateTransformationH to_earth; /* of the layer that is read */
    struct vector_map_gap_count *unplaced; /* its way is still to come */
    bool relations_alone;                  /* closed ways were read as lines */
    bool no_memory;
    bool inside; /* the rectangle around one of the tracks touches the square */
};

/* Called for each feature. geometry: NULL if it has none. Closed ways of OpenStreetMap are lines,
 * and come after its relations, which are areas. */
typedef void vector_map_feature(void *context, struct vector_map *map, OGRFeatureH feature,
                                OGRGeometryH geometry);

enum vector_map_shapes { VECTOR_MAP_POINTS = 1, VECTOR_MAP_LINES = 2, VECTOR_MAP_AREAS = 4 };

/* Reads the layers of a map that may have these shapes, a bit each. what: "lines, of which roads
 * could be made", for the refusal of a map without them. 0, or -1 with the reason: no map that GDAL
 * reads, no known projection, no such layer, no memory. Adds what is missing to the gaps, and the
 * map if none of the tracks that were read of it touches the square. */
int vector_map_read(const char *path, const struct post_grid *grid, unsigned shapes,
                    const char *what, vector_map_feature *feature, void *context,
                    struct vector_map_gaps *gaps, struct error_text *error);

/* Reads the places of a point, a line or a ring into the track. Returns false if one of them is no
 * place on the earth, or without memory, which *map notes. */
bool vector_map_track(struct vector_map *map, OGRGeometryH geometry,
                      struct vector_map_track *track);
void vector_map_track_free(struct vector_map_track *track);

/* Mends a polygon whose rings cross themselves or others: what the outline encloses, without what
 * the holes do. Returns a geometry that the caller destroys; NULL if GDAL cannot. */
OGRGeometryH vector_map_mend(OGRGeometryH polygon);

/* One of the polygons of an area. */
struct vector_map_polygon {
    OGRGeometryH shape; /* of the area */
    OGREnvelope box;
    double area;
    uint32_t around; /* how many of the others it lies within */
};

/* Returns true if a polygon lies within another, but for what rounding of its corners moves. */
bool vector_map_lies_within(const struct vector_map_polygon *inner,
                            const struct vector_map_polygon *outer);

/* Returns a row for each polygon of an area, which the caller frees; NULL without memory. */
struct vector_map_polygon *vector_map_polygons(OGRGeometryH areas);

/* Outlines with courtyards, of relations of OpenStreetMap without words that are known. Until 2017
 * the words of such a one stood on the way that is its outline. */
struct vector_map_courts {
    struct vector_map_court {
        OGRGeometryH shape;
        OGREnvelope box;
    } * court;
    uint32_t count, room;
    bool sorted;
};

/* Keeps a relation's outlines that have courtyards. Returns false without memory. */
bool vector_map_courts_keep(struct vector_map_courts *courts, OGRGeometryH areas);

/* Returns the outline with courtyards whose extent is that of a way; NULL if there is none. */
OGRGeometryH vector_map_courts_find(struct vector_map_courts *courts, OGRGeometryH way);
void vector_map_courts_free(struct vector_map_courts *courts);

/* Returns the number that OpenStreetMap gives to a feature, or, in other maps, its own. */
long long vector_map_number(OGRFeatureH feature);

/* Returns a feature's value for a key of OpenStreetMap, a text that stays where it is, from a field
 * of this name or from the list "other_tags" of GDAL's driver; "" without one. A value of the list
 * is cut to the size of buffer. */
const char *vector_map_tag(OGRFeatureH feature, const char *key, char *buffer, uint32_t bytes);

#endif
