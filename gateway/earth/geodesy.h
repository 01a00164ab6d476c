/* Places on the earth: WGS 84 latitude, longitude and height above the ellipsoid, and
 * earth-centred, earth-fixed coordinates (ECEF: x through the equator at Greenwich, y through 90
 * degrees east, z through the north pole). Uses world/maths alone, so the results are the same on
 * every machine. Source: NIMA TR8350.2 (WGS 84). Pure; any thread. */
#ifndef JOLON_GATEWAY_EARTH_GEODESY_H
#define JOLON_GATEWAY_EARTH_GEODESY_H

#include "world/maths/maths.h"

#define GEODESY_EQUATOR_M  6378137.0
#define GEODESY_FLATTENING (1.0 / 298.257223563)

struct geodesy_place {
    double latitude_rad;  /* -pi/2..pi/2, north positive */
    double longitude_rad; /* -pi..pi, east positive */
    double height_m;      /* above the ellipsoid */
};

struct vec3 geodesy_ecef(struct geodesy_place place);

/* The inverse. Within 1000 km of the ellipsoid geodesy_ecef() of the result is the same point to
 * within 1e-8 m. On the axis the longitude is 0. At the centre of the earth the place is the north
 * pole at its depth. */
struct geodesy_place geodesy_place_of(struct vec3 ecef);

#endif
