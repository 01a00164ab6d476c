/* Geodetic and earth-centred coordinates. */
#include "gateway/earth/geodesy.h"

#define E2 (GEODESY_FLATTENING * (2.0 - GEODESY_FLATTENING)) /* first eccentricity, squared */

/* The fixed point below gains a factor of about 1/E2 = 149 in each round, so eight rounds are more
 * than a double holds. The count is fixed, so that the work does not depend on the point. */
#define ROUNDS 8

/* Radius of curvature across the meridian [m]. */
static double across(double sine)
{
    return GEODESY_EQUATOR_M / sqrt(1.0 - E2 * sine * sine);
}

struct vec3 geodesy_ecef(struct geodesy_place place)
{
    double sin_lat, cos_lat, sin_lon, cos_lon;
    maths_sincos(place.latitude_rad, &sin_lat, &cos_lat);
    maths_sincos(place.longitude_rad, &sin_lon, &cos_lon);
    double radius = across(sin_lat);
    return (struct vec3){(radius + place.height_m) * cos_lat * cos_lon,
                         (radius + place.height_m) * cos_lat * sin_lon,
                         (radius * (1.0 - E2) + place.height_m) * sin_lat};
}

struct geodesy_place geodesy_place_of(struct vec3 ecef)
{
    double from_axis = sqrt(ecef.x * ecef.x + ecef.y * ecef.y);
    /* The normal through the point meets the axis at -E2 radius sine. */
    double latitude_rad = maths_atan2(ecef.z, from_axis * (1.0 - E2));
    double sine = 0.0, cosine = 1.0;
    for (int i = 0; i < ROUNDS; i++) {
        maths_sincos(latitude_rad, &sine, &cosine);
        latitude_rad = maths_atan2(ecef.z + E2 * across(sine) * sine, from_axis);
    }
    maths_sincos(latitude_rad, &sine, &cosine);
    /* The length along the normal, which is stable at the poles and at the equator. */
    double height_m =
        from_axis * cosine + ecef.z * sine - GEODESY_EQUATOR_M * sqrt(1.0 - E2 * sine * sine);
    return (struct geodesy_place){latitude_rad, maths_atan2(ecef.y, ecef.x), height_m};
}
