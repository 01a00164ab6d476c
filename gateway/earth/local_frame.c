/* The world's plane on the earth. */
#include "gateway/earth/local_frame.h"

#define STRAIGHT                                                                                   \
    1e-12 /* as a share of its length, the level part of a nose straight up or down                \
           */

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
}

struct vec3 local_frame_ecef_direction(const struct local_frame *frame, struct vec3 world)
{
    return rotation_apply(&frame->axes, world);
}

struct vec3 local_frame_world_direction(const struct local_frame *frame, struct vec3 ecef)
{
    return rotation_back(&frame->axes, ecef);
}

struct vec3 local_frame_ecef(const struct local_frame *frame, struct vec3 world)
{
    struct vec3 local = {world.x - frame->middle_x, world.y, world.z - frame->middle_z};
    return vec3_add(frame->origin, local_frame_ecef_direction(frame, local));
}

struct vec3 local_frame_world(const struct local_frame *frame, struct vec3 ecef)
{
    struct vec3 local = local_frame_world_direction(frame, vec3_sub(ecef, frame->origin));
    return (struct vec3){local.x + frame->middle_x, local.y, local.z + frame->middle_z};
}

struct mat3 local_frame_ecef_turn(const struct local_frame *frame, const struct mat3 *turn)
{
    struct mat3 both = rotation_both(&frame->axes, turn), matrix;
    for (int i = 0; i < 3; i++) { /* columns: forward, right, down */
        matrix.m[i][0] = both.m[i][0];
        matrix.m[i][1] = both.m[i][2];
        matrix.m[i][2] = -both.m[i][1];
    }
    return matrix;
}

struct mat3 local_frame_world_turn(const struct local_frame *frame, const struct mat3 *matrix)
{
    struct mat3 turn;
    const struct vec3 columns[3] = {
        {matrix->m[0][0], matrix->m[1][0], matrix->m[2][0]},    /* forward */
        {-matrix->m[0][2], -matrix->m[1][2], -matrix->m[2][2]}, /* up */
        {matrix->m[0][1], matrix->m[1][1], matrix->m[2][1]},    /* right */
    };
    for (int j = 0; j < 3; j++) {
        struct vec3 world = local_frame_world_direction(frame, columns[j]);
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
