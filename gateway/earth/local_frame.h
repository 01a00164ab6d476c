/* The world on the earth. Jolon's world has the axes x east, y up and z south [m] and heights above
 * sea level. It lies on the plane that touches the earth at one point of reference, or, on a ground
 * file, on the earth itself by the projection of the file: up is then another direction at each
 * place. DIS has ECEF places on the WGS 84 ellipsoid. Pure but for what reads a file; any thread.
 */
#ifndef JOLON_GATEWAY_EARTH_LOCAL_FRAME_H
#define JOLON_GATEWAY_EARTH_LOCAL_FRAME_H

#include "gateway/earth/euler.h"
#include "gateway/earth/geodesy.h"
#include "world/runtime/error_text.h"
#include "world/terrain/projection.h"

#include <stdbool.h>

/* The default point of reference: the middle of the square of Fort Hunter Liggett, where the sea
 * level (EGM96) is 33.7 m below the ellipsoid. */
#define LOCAL_FRAME_LATITUDE_DEG  35.95
#define LOCAL_FRAME_LONGITUDE_DEG (-121.25)
#define LOCAL_FRAME_UNDULATION_M  (-33.7)

/* Corners of the parts of the square whose undulation is known, along a side. */
#define LOCAL_FRAME_NODES 33

struct local_frame {
    struct vec3 origin;        /* [m] ECEF of the point of reference at sea level */
    struct mat3 axes;          /* columns: east, up and south in ECEF */
    double middle_x, middle_z; /* [m] world coordinates of the point of reference */
    bool projected;            /* places are those of the projection, not of the plane */
    struct projection projection;
    double undulation_m; /* of the sea above the ellipsoid at the point of reference */
    /* How far the sea is above that of the point of reference, at the corners of equal parts of the
     * square [m]: rows from north to south, each from west to east. All 0: one undulation is that
     * of the whole square. */
    bool uneven;
    float above[LOCAL_FRAME_NODES][LOCAL_FRAME_NODES];
};

/* latitude, longitude [deg] of the world's point (middle_x, middle_z). undulation_m: height of the
 * sea level above the ellipsoid there. */
void local_frame_make(struct local_frame *frame, double latitude_deg, double longitude_deg,
                      double undulation_m, double middle_x, double middle_z);

/* Lays the same world on the earth by the projection of ground files about its middle, whose x and
 * z are both middle_m. */
void local_frame_project(struct local_frame *frame, double latitude_deg, double longitude_deg,
                         double undulation_m, double middle_m);

/* Takes the undulation of each part of the square, whose middle is the point of reference and whose
 * sides have 2 middle_x, from a grid (geoid_grid.h), instead of one for all. Reads the file; for
 * the start. undulation_m is the one of local_frame_make(). Returns 0, or -1 with the reason; the
 * frame is then as before. */
int local_frame_read_undulation(struct local_frame *frame, const char *path, double undulation_m,
                                struct error_text *error);

/* World to ECEF, and back: places. */
struct vec3 local_frame_ecef(const struct local_frame *frame, struct vec3 world);
struct vec3 local_frame_world(const struct local_frame *frame, struct vec3 ecef);

/* Returns the axes of the world at a place of it in ECEF: columns east, up and south. They lead
 * velocities and directions there to ECEF by rotation_apply(), and back by rotation_back(). */
struct mat3 local_frame_axes(const struct local_frame *frame, struct vec3 world);

/* The attitude of a body, world = turn * body with Jolon's body axes (world/maths/rotation.h), to
 * the matrix of euler.h, and back, by the axes at its place. */
struct mat3 local_frame_ecef_turn(const struct mat3 *axes, const struct mat3 *turn);
struct mat3 local_frame_world_turn(const struct mat3 *axes, const struct mat3 *matrix);

/* Body axes of Jolon (forward, up, right) to those of DIS (forward, right, down), and back. */
static inline struct vec3 local_frame_body_to_dis(struct vec3 body)
{
    return (struct vec3){body.x, body.z, -body.y};
}
static inline struct vec3 local_frame_body_from_dis(struct vec3 body)
{
    return (struct vec3){body.x, -body.z, body.y};
}

/* Returns the heading (0..2 pi, clockwise from north), pitch and roll [rad] of an attitude. */
void local_frame_angles(const struct mat3 *turn, double *heading_rad, double *pitch_rad,
                        double *roll_rad);

#endif
