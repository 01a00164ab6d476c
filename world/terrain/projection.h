/* The projection of a ground file: transverse Mercator on the WGS 84 ellipsoid about the middle of
 * the square, with the scale 1 on the middle's meridian. x goes east and z south from the
 * north-west corner, as everywhere in a world.
 *
 * Source: Krueger's series in the third flattening to its sixth power (Karney, Transverse Mercator
 * with an accuracy of a few nanometers, J. Geodesy 85, 2011). Within PROJECTION_REACH_M of the
 * middle both ways are good to a micrometre. Uses world/maths alone, so the results are the same on
 * every machine. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_PROJECTION_H
#define JOLON_WORLD_TERRAIN_PROJECTION_H

#define PROJECTION_REACH_M 1.0e6

/* The middle may lie up to this latitude: beyond it a square of 500 km comes near the pole. */
#define PROJECTION_LATITUDE_MAX_DEG 84.0

struct projection {
    double longitude_rad; /* of the middle */
    double north_m;       /* of the middle from the equator, along the meridian */
    double middle_m;      /* x and z of the middle: half of the side */
};

/* latitude, longitude [deg] of the middle of a square of side_m. */
void projection_make(struct projection *projection, double latitude_deg, double longitude_deg,
                     double side_m);

/* World coordinates [m] of a place [deg]. */
void projection_world(const struct projection *projection, double latitude_deg,
                      double longitude_deg, double *x, double *z);

/* The place [deg] of world coordinates [m]; the longitude is -180..180. */
void projection_place(const struct projection *projection, double x, double z, double *latitude_deg,
                      double *longitude_deg);

/* Returns by how much a length on the map exceeds the length on the ground, as a share, at a
 * distance east or west of the middle's meridian: distance^2 / 2 R^2 with the earth's mean radius,
 * good to 1 % of itself. 25 km give 7.7e-6, 7.7 mm a km. */
double projection_stretch(double distance_m);

#endif
