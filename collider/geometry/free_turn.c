/* Free rotation and steering, one after the other at each time. */
#include "collider/geometry/free_turn.h"

/* A smaller rest is rounding [rad, half of it]. */
#define STEERS_RAD 1e-12

static const struct quat none = {1.0, 0.0, 0.0, 0.0};

struct free_turn free_turn_to(const struct free_rotation *rotation, struct quat to)
{
    struct quat end = free_rotation_at(rotation, 1.0);
    struct quat rest = rotation_product(to, rotation_inverse(end));
    double size = sqrt(rest.x * rest.x + rest.y * rest.y + rest.z * rest.z);
    return (struct free_turn){.rotation = *rotation, .steered = rest, .steers = size > STEERS_RAD};
}

void free_turn_at(const struct free_turn *turn, double share, struct quat *turned,
                  struct vec3 *spin)
{
    struct quat spun = free_rotation_at(&turn->rotation, share);
    struct vec3 rate =
        vec3_scale(free_rotation_spin(turn->rotation.moment, spun, turn->rotation.momentum),
                   turn->rotation.duration_s);
    if (turn->steers) {
        struct quat by = rotation_between(none, turn->steered, share);
        struct mat3 turns = rotation_matrix(by);
        spun = rotation_product(by, spun);
        rate = vec3_add(rotation_speed(none, turn->steered, share), rotation_apply(&turns, rate));
    }
    *turned = spun;
    *spin = rate;
}

double free_turn_rate(const struct free_turn *turn, double *bend)
{
    double duration = turn->rotation.duration_s;
    double rate = free_rotation_rate(&turn->rotation, bend) * duration;
    *bend *= duration * duration;
    if (!turn->steers)
        return rate;
    double steering = rotation_rate(none, turn->steered);
    *bend += steering * (steering + 2.0 * rate); /* its own, and Coriolis's */
    return rate + steering;
}

static int order_of(double a, double b)
{
    return (a > b) - (a < b);
}

int free_turn_order(const struct free_turn *a, const struct free_turn *b)
{
    int order = order_of(a->rotation.steps, b->rotation.steps);
    if (order == 0)
        order = order_of(a->rotation.momentum.x, b->rotation.momentum.x);
    if (order == 0)
        order = order_of(a->rotation.momentum.y, b->rotation.momentum.y);
    return order != 0 ? order : order_of(a->rotation.momentum.z, b->rotation.momentum.z);
}
