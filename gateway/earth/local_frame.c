/* The world on its plane, and on the earth. */
#include "gateway/earth/local_frame.h"

#include "gateway/earth/geoid_grid.h"

#define STRAIGHT                                                                                   \
    1e-12 /* as a share of its length, the level part of a nose straight up or down                \
           */

#define AXES_STEP_M 50.0

void local_frame_make(struct local_frame *frame, double latitude_deg, double longitude_deg,
                      double undulation_m, double middle_x, double middle_z)
{
    double latitude_rad = latitude_deg * RAD_PER_DEG, longitude_rad = longitude_deg * RAD_PER_DEG;
    double sin_lat, cos_lat, sin_lon, cos_lon;
    maths_sincos(latitude_rad, &sin_lat, &cos_lat);
    maths_sincos(longitude_rad, &sin_lon, &cos_lon);
    frame->origin = geodesy_ecef((struct geodesy_place){latitude_rad, longitude_rad, undulation_m});
    frame->axes = (struct mat3){{{-sin_lon, cos_lat * cos_lon, sin_lat * cos_lon},
                                 {cos_lon, cos_lat * sin_lon, sin_lat * sin_lon},
                                 {0.0, sin_lat, -cos_lat}}};
    frame->middle_x = middle_x;
    frame->middle_z = middle_z;
    frame->undulation_m = undulation_m;
    frame->uneven = frame->projected = false;
}

void local_frame_project(struct local_frame *frame, double latitude_deg, double longitude_deg,
                         double undulation_m, double middle_m)
{
    local_frame_make(frame, latitude_deg, longitude_deg, undulation_m, middle_m, middle_m);
    projection_make(&frame->projection, latitude_deg, longitude_deg, 2.0 * middle_m);
    frame->projected = true;
}

int local_frame_read_undulation(struct local_frame *frame, const char *path, double undulation_m,
                                struct error_text *error)
{
    struct local_frame read = *frame;
    read.uneven = false;
    for (int i = 0; i < LOCAL_FRAME_NODES; i++) {
        for (int j = 0; j < LOCAL_FRAME_NODES; j++) {
            double step = 2.0 / (LOCAL_FRAME_NODES - 1), there_m;
            struct vec3 at = {j * step * frame->middle_x, 0.0, i * step * frame->middle_z};
            struct geodesy_place place = geodesy_place_of(local_frame_ecef(&read, at));
            if (geoid_grid_read(path, place.latitude_rad * DEG_PER_RAD,
                                place.longitude_rad * DEG_PER_RAD, &there_m, error) != 0)
                return -1;
            read.above[i][j] = (float)(there_m - undulation_m);
        }
    }
    read.uneven = true;
    *frame = read;
    return 0;
}

/* Returns how far the sea at a place is above that of the point of reference [m], linear between
 * the corners around it. Beyond the square it is that of its edge. */
static double sea_above(const struct local_frame *frame, double x, double z)
{
    const int last = LOCAL_FRAME_NODES - 1;
    if (!frame->uneven)
        return 0.0;
    double east = maths_min(maths_max(0.5 * x / frame->middle_x, 0.0), 1.0) * last;
    double south = maths_min(maths_max(0.5 * z / frame->middle_z, 0.0), 1.0) * last;
    int j = east < last ? (int)east : last - 1, i = south < last ? (int)south : last - 1;
    double right = east - j, down = south - i;
    const float *north = frame->above[i], *next = frame->above[i + 1];
    double upper = (double)north[j] + right * (double)(north[j + 1] - north[j]);
    double lower = (double)next[j] + right * (double)(next[j + 1] - next[j]);
    return upper + down * (lower - upper);
}

/* Returns the place of the earth at a place of a projected world. */
static struct geodesy_place place_at(const struct local_frame *frame, struct vec3 world)
{
    double latitude_deg, longitude_deg;
    projection_place(&frame->projection, world.x, world.z, &latitude_deg, &longitude_deg);
    return (struct geodesy_place){latitude_deg * RAD_PER_DEG, longitude_deg * RAD_PER_DEG,
                                  world.y + frame->undulation_m +
                                      sea_above(frame, world.x, world.z)};
}

struct vec3 local_frame_ecef(const struct local_frame *frame, struct vec3 world)
{
    if (frame->projected)
        return geodesy_ecef(place_at(frame, world));
    struct vec3 local = {world.x - frame->middle_x, world.y + sea_above(frame, world.x, world.z),
                         world.z - frame->middle_z};
    return vec3_add(frame->origin, rotation_apply(&frame->axes, local));
}

/* Beyond the reach of the projection a place is that of the plane, which is far outside of any
 * square, too. */
struct vec3 local_frame_world(const struct local_frame *frame, struct vec3 ecef)
{
    struct vec3 from = vec3_sub(ecef, frame->origin);
    struct vec3 local = rotation_back(&frame->axes, from);
    double x = local.x + frame->middle_x, z = local.z + frame->middle_z, height = local.y;
    if (frame->projected && vec3_length(from) < 0.5 * PROJECTION_REACH_M) {
        struct geodesy_place place = geodesy_place_of(ecef);
        projection_world(&frame->projection, place.latitude_rad * DEG_PER_RAD,
                         place.longitude_rad * DEG_PER_RAD, &x, &z);
        height = place.height_m - frame->undulation_m;
    }
    return (struct vec3){x, height - sea_above(frame, x, z), z};
}

/* East on the map is found by two places of it, as it turns against the parallel away from the
 * middle's meridian. */
struct mat3 local_frame_axes(const struct local_frame *frame, struct vec3 world)
{
    if (!frame->projected)
        return frame->axes;
    struct vec3 west = world, east = world, up;
    double sin_lat, cos_lat, sin_lon, cos_lon;
    struct geodesy_place place = place_at(frame, world);
    maths_sincos(place.latitude_rad, &sin_lat, &cos_lat);
    maths_sincos(place.longitude_rad, &sin_lon, &cos_lon);
    up = (struct vec3){cos_lat * cos_lon, cos_lat * sin_lon, sin_lat};
    west.x -= AXES_STEP_M;
    east.x += AXES_STEP_M;
    struct vec3 along = vec3_sub(local_frame_ecef(frame, east), local_frame_ecef(frame, west));
    along = vec3_sub(along, vec3_scale(up, vec3_dot(along, up)));
    along = vec3_scale(along, 1.0 / vec3_length(along));
    struct vec3 south = vec3_cross(along, up);
    return (struct mat3){
        {{along.x, up.x, south.x}, {along.y, up.y, south.y}, {along.z, up.z, south.z}}};
}

struct mat3 local_frame_ecef_turn(const struct mat3 *axes, const struct mat3 *turn)
{
    struct mat3 both = rotation_both(axes, turn), matrix;
    for (int i = 0; i < 3; i++) { /* columns: forward, right, down */
        matrix.m[i][0] = both.m[i][0];
        matrix.m[i][1] = both.m[i][2];
        matrix.m[i][2] = -both.m[i][1];
    }
    return matrix;
}

struct mat3 local_frame_world_turn(const struct mat3 *axes, const struct mat3 *matrix)
{
    struct mat3 turn;
    const struct vec3 columns[3] = {
        {matrix->m[0][0], matrix->m[1][0], matrix->m[2][0]},    /* forward */
        {-matrix->m[0][2], -matrix->m[1][2], -matrix->m[2][2]}, /* up */
        {matrix->m[0][1], matrix->m[1][1], matrix->m[2][1]},    /* right */
    };
    for (int j = 0; j < 3; j++) {
        struct vec3 world = rotation_back(axes, columns[j]);
        turn.m[0][j] = world.x;
        turn.m[1][j] = world.y;
        turn.m[2][j] = world.z;
    }
    return turn;
}

void local_frame_angles(const struct mat3 *turn, double *heading_rad, double *pitch_rad,
                        double *roll_rad)
{
    const double(*m)[3] = turn->m;
    double level = sqrt(m[0][0] * m[0][0] + m[2][0] * m[2][0]);
    *pitch_rad = maths_atan2(m[1][0], level);
    if (level < STRAIGHT) {
        *heading_rad = maths_wrap_turn(maths_atan2(m[2][2], m[0][2]));
        *roll_rad = 0.0;
        return;
    }
    *heading_rad = maths_heading(m[0][0], m[2][0]);
    *roll_rad = maths_atan2(-m[1][2], m[1][1]);
}
