/* The roads of a ground, from maps of lines that GDAL reads: OpenStreetMap (.osm, .pbf),
 * GeoPackage, Shapefile, GeoJSON. */
#ifndef JOLON_SUPERVISOR_GROUND_ROAD_MAP_H
#define JOLON_SUPERVISOR_GROUND_ROAD_MAP_H

#include "supervisor/ground/raster.h"
#include "world/terrain/ground_format.h"

struct vector_map_gaps;

struct road_map {
    struct ground_road_point *points; /* road after road, the more important first */
    uint32_t count;
    uint32_t roads;
    uint32_t left_out;     /* roads for which there was no room */
    uint32_t bad;          /* lines of one point or none, or with places that are none: */
    const char *bad_map;   /* the map of the first, */
    long long bad_feature; /* and its number there */
    double kept_m, all_m;  /* lengths, with and without those left out */
};

/* Reads the roads within the square from the maps at paths, in any order. In a map with a field
 * "highway" or "fclass" (OpenStreetMap's words), lines that no car may use are no roads. In any
 * other map every line is a road. Lines are cut at the edge of the square and simplified by 2 m. At
 * most GROUND_ROAD_POINTS_MAX points are kept: of the most important roads, and of those the
 * longest. 0, or -1 with the reason. */
int road_map_read(struct road_map *map, char *const *paths, uint32_t count,
                  const struct post_grid *grid, struct vector_map_gaps *gaps,
                  struct error_text *error);
void road_map_free(struct road_map *map);

/* Makes the cover of posts near a road that of a road, where posts are dense enough to show one,
 * and wherever it crosses water: agents drive on roads, and a bridge is a dam. From a bank that is
 * higher than the water the dam falls slowly. 0; -1: no memory. */
int road_map_pave(const struct road_map *map, const struct post_grid *grid, float *posts,
                  uint8_t *cover);

#endif
