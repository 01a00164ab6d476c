/* Buildings, woods, water and poles, from maps of points, lines and areas that GDAL reads
 * (supervisor/ground/vector_map.h). Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_FEATURES_H
#define JOLON_SUPERVISOR_GROUND_FEATURES_H

#include "supervisor/ground/area.h"
#include "supervisor/ground/buildings.h"
#include "supervisor/ground/raster.h"

struct vector_map_gaps;

enum feature_use {
    FEATURE_NONE,
    FEATURE_BUILDING,
    FEATURE_WOOD,  /* trees */
    FEATURE_SCRUB, /* bushes */
    FEATURE_LAKE,  /* an area of still water, which is level */
    FEATURE_RIVER, /* an area of flowing water, or a line */
    FEATURE_COAST, /* a line with land on its left and sea on its right; an area is an island */
    FEATURE_TREE,
    FEATURE_TREE_ROW,
    FEATURE_POLE,
    FEATURE_TOWER,
    FEATURE_WATERTOWER,
    FEATURE_USES
};

/* What was wrong with features. */
enum feature_trouble {
    FEATURE_NO_PLACE, /* left out: no place, one that is none, or too few of them */
    FEATURE_SHAPE,    /* left out: a building or a wood that is a point or a line */
    FEATURE_OPEN,     /* an outline that was open, and is closed */
    FEATURE_MENDED,   /* an outline of a building that crossed itself */
    FEATURE_CROSSED,  /* an area whose outlines cross, or with a hole outside of it */
    FEATURE_NOTCHED,  /* a hole that touches the outline around it */
    FEATURE_BOXED,    /* an outline that could not be split: its smallest rectangle stands for it */
    FEATURE_SMALL,    /* left out: a building of less than BUILDINGS_LEAST_M2 */
    FEATURE_EDGE,     /* left out: a building across the edge of the square */
    FEATURE_LARGE,    /* left out: a building of more than GROUND_BUILDING_REACH_MM */
    FEATURE_HEIGHT,   /* a building with a height that no building has; it is not used */
    FEATURE_WIDTH,    /* the same of a river's width */
    FEATURE_TROUBLES
};

/* A line of flowing water, or a coastline. */
struct feature_line {
    double (*place)[2]; /* [m] */
    uint32_t count;
    double width_m; /* 0: a coastline */
};

struct features {
    struct area *area; /* use: FEATURE_WOOD, _SCRUB, _LAKE or _RIVER; the larger first */
    uint32_t areas, area_room;
    struct feature_line *line;
    uint32_t lines, line_room;
    struct ground_object *object; /* trees and poles that stand in the map */
    uint32_t objects, object_room;
    struct buildings buildings;
    struct feature_trouble_count {
        uint32_t count;
        double latitude_deg, longitude_deg; /* of the first; NaN: it has no place */
        const char *map;
        long long feature; /* its number in the map */
    } trouble[FEATURE_TROUBLES];
};

/* Reads the features of the maps that touch the square. What they are follows from OpenStreetMap's
 * keys and values, or from the field "fclass" of extracts as shapefiles. 0, or -1 with the reason.
 * The caller frees them in any case. */
int features_read(struct features *features, char *const *paths, uint32_t count,
                  const struct post_grid *grid, struct vector_map_gaps *gaps,
                  struct error_text *error);
void features_free(struct features *features);

/* Returns a sentence about a trouble, without its count and place. */
const char *features_trouble_text(enum feature_trouble trouble);

#endif
