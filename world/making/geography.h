/* The real places of the generated ground: Fort Hunter Liggett, from the Pacific to the Salinas
 * Valley. Constant tables in world coordinates; some points lie outside the square, so that rivers
 * and ridges do not end at its edge. */
#ifndef JOLON_WORLD_MAKING_GEOGRAPHY_H
#define JOLON_WORLD_MAKING_GEOGRAPHY_H

#include <stddef.h>
#include <stdint.h>

#define GEOGRAPHY_LAKE_M 238.0 /* Lake San Antonio's surface */

/* A point of a river, a ridge or the coast. */
struct geography_point {
    double x_m, z_m;
    double height_m;     /* of the river's bed or the ridge's crest */
    double half_width_m; /* rivers: of the flat ground beside them */
};

struct geography_line {
    const char *name;
    const struct geography_point *points;
    size_t count;
};

/* Ground of known height. */
struct geography_place {
    const char *name;
    double latitude_deg, longitude_deg;
    double height_m;
    int peak; /* 1: the highest ground of its ridge */
};

#define GEOGRAPHY_RIVER_COUNT 4
#define GEOGRAPHY_RIDGE_COUNT 5
#define GEOGRAPHY_PLACE_COUNT 4

/* The river whose lower course is under the reservoir. */
#define GEOGRAPHY_SAN_ANTONIO 0

#define GEOGRAPHY_MISSION 2
#define GEOGRAPHY_JOLON   3

extern const struct geography_line geography_rivers[GEOGRAPHY_RIVER_COUNT];
extern const struct geography_line geography_ridges[GEOGRAPHY_RIDGE_COUNT];
extern const struct geography_line geography_coast; /* north to south: z ascends */
extern const struct geography_place geography_places[GEOGRAPHY_PLACE_COUNT];

/* The nearest point of a line to (x, z): its distance [m], height and half-width there. */
struct geography_near {
    double distance_m, height_m, half_width_m;
};
struct geography_near geography_nearest(const struct geography_line *line, double x, double z);

/* Distance from the coast [m], positive on land. */
double geography_inland(double x, double z);

#endif
