/* Dead reckoning with a constant angular velocity in body axes. With a = rates * time and x = |a|,
 * the rotation since the state is R = f1 a a^T + cos(x) I + f2 [a], where [a] b = a x b, and the
 * integrals of R that bring body velocity and body acceleration into the axes of the state have the
 * same form. For small x the factors are their series. */
#include "world/maths/dead_reckoning.h"

#include <stdbool.h>

#define SERIES     0.03 /* [rad] below it, rounding costs more than the series leaves out */
#define TURN_LIMIT 1e5  /* [rad] */

/* weights: of a a^T, of I and of [a]. */
static struct vec3 turned(struct vec3 a, const double weights[3], struct vec3 body)
{
    struct vec3 along = vec3_scale(a, weights[0] * vec3_dot(a, body));
    struct vec3 across = vec3_scale(vec3_cross(a, body), weights[2]);
    return vec3_add(vec3_add(along, across), vec3_scale(body, weights[1]));
}

/* The weights of the rotation, of its integral over time, divided by the time, and of the integral
 * of time times rotation, divided by the time squared. */
static void weigh(double x, double rotation[3], double velocity[3], double acceleration[3])
{
    double s, c, x2 = x * x, x4 = x2 * x2;
    maths_sincos(x, &s, &c);
    bool series = x < SERIES;
    double f1 = series ? 1.0 / 2 - x2 / 24 + x4 / 720 : (1.0 - c) / x2;
    double f2 = series ? 1.0 - x2 / 6 + x4 / 120 : s / x;
    rotation[0] = f1;
    rotation[1] = c;
    rotation[2] = f2;
    velocity[0] = series ? 1.0 / 6 - x2 / 120 + x4 / 5040 : (x - s) / (x2 * x);
    velocity[1] = f2;
    velocity[2] = f1;
    acceleration[0] = series ? 1.0 / 8 - x2 / 144 + x4 / 5760 : (0.5 * x2 + 1.0 - c - x * s) / x4;
    acceleration[1] = series ? 1.0 / 2 - x2 / 8 + x4 / 144 : (c + x * s - 1.0) / x2;
    acceleration[2] = series ? 1.0 / 3 - x2 / 30 + x4 / 840 : (s - x * c) / (x2 * x);
}

/* Velocity and acceleration in axes that do not turn. */
static struct vec3 moved(const struct dead_reckoning *state, double time_s, bool accelerated)
{
    struct vec3 way = vec3_scale(state->velocity, time_s);
    if (accelerated)
        way = vec3_add(way, vec3_scale(state->acceleration, 0.5 * time_s * time_s));
    return way;
}

void dead_reckoning_at(const struct dead_reckoning *state, double time_s, struct vec3 *position,
                       struct mat3 *matrix)
{
    double rotation[3], velocity[3], acceleration[3];
    struct vec3 a = vec3_scale(state->rates, time_s), way = {0};
    if (!(vec3_length(a) < TURN_LIMIT))
        a = (struct vec3){0};
    weigh(vec3_length(a), rotation, velocity, acceleration);
    unsigned model = state->model;
    bool accelerated = model == DEAD_RECKONING_RVW || model == DEAD_RECKONING_FVW ||
                       model == DEAD_RECKONING_RVB || model == DEAD_RECKONING_FVB;
    bool turns = model == DEAD_RECKONING_RPW || model == DEAD_RECKONING_RVW ||
                 model == DEAD_RECKONING_RPB || model == DEAD_RECKONING_RVB;
    bool body = model >= DEAD_RECKONING_FPB && model <= DEAD_RECKONING_FVB;
    if (body && turns) {
        way = vec3_scale(turned(a, velocity, state->velocity), time_s);
        if (accelerated)
            way = vec3_add(
                way, vec3_scale(turned(a, acceleration, state->acceleration), time_s * time_s));
    } else if (model >= DEAD_RECKONING_FPW && model <= DEAD_RECKONING_FVB) {
        way = moved(state, time_s, accelerated);
    }
    *position = vec3_add(state->position, body ? rotation_apply(&state->matrix, way) : way);
    *matrix = state->matrix;
    if (!turns)
        return;
    struct mat3 since;
    for (int j = 0; j < 3; j++) {
        struct vec3 axis = {j == 0, j == 1, j == 2};
        struct vec3 column = turned(a, rotation, axis);
        since.m[0][j] = column.x;
        since.m[1][j] = column.y;
        since.m[2][j] = column.z;
    }
    *matrix = rotation_both(&state->matrix, &since);
}
