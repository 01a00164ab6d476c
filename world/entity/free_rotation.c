/* The kinetic energy is a sum of one term for each body axis. Under one term alone the body turns
 * about that axis at a constant rate, and its angular momentum, in body axes, turns back by the
 * same angle. A symmetric sequence of such turns (x/2 y/2 z y/2 x/2) is of second order, and five
 * of them make one step of fourth order (Suzuki 1990). Each turn conserves the angular momentum in
 * the world exactly. At the end a small turn puts the body back on its energy. */
#include "world/entity/free_rotation.h"

#define STEP_RAD  0.15 /* turned in one step; half as much divides the error by 16 */
#define STEPS_MAX 512u /* bounds the time of a call */

/* Without this share of |L| |spin| between them, momentum and spin are parallel: the body turns
 * about a principal axis, where no small turn changes the energy. */
#define PARALLEL 1e-6

/* Suzuki's fourth order: two of the first, one of the second, two of the first; 4 OUTER + INNER is
 * 1. */
#define OUTER 0.41449077179437573714
#define INNER (-0.65796308717750294857)

/* The body within the computation. */
struct spinning_body {
    struct quat q;        /* of any length */
    struct vec3 momentum; /* body axes */
};

static struct vec3 over(struct vec3 v, struct vec3 moment)
{
    return (struct vec3){v.x / moment.x, v.y / moment.y, v.z / moment.z};
}

/* Returns the angular speed of a body with all its energy about the axis of its least moment. */
static double rate_most(const struct free_rotation *r)
{
    const struct mat3 turn = rotation_matrix(r->from);
    struct vec3 body = rotation_back(&turn, r->momentum);
    double twice_j = vec3_dot(body, over(body, r->moment));
    return sqrt(twice_j / maths_min(r->moment.x, maths_min(r->moment.y, r->moment.z)));
}

/* Half the angle's tangent, nearly: the turn by it is exact, and its angle is right to within 1e-7
 * of a quarter radian. */
static double half_tangent(double angle)
{
    double square = angle * angle;
    return angle * (0.5 + square * (1.0 / 24.0 + square * (1.0 / 240.0)));
}

static void turn_x(struct spinning_body *b, double angle)
{
    double t = half_tangent(angle), k = 2.0 / (1.0 + t * t), c = k - 1.0, s = k * t;
    struct quat q = b->q;
    double y = b->momentum.y, z = b->momentum.z;
    b->momentum.y = c * y + s * z;
    b->momentum.z = c * z - s * y;
    b->q = (struct quat){q.w - t * q.x, q.x + t * q.w, q.y + t * q.z, q.z - t * q.y};
}

static void turn_y(struct spinning_body *b, double angle)
{
    double t = half_tangent(angle), k = 2.0 / (1.0 + t * t), c = k - 1.0, s = k * t;
    struct quat q = b->q;
    double z = b->momentum.z, x = b->momentum.x;
    b->momentum.z = c * z + s * x;
    b->momentum.x = c * x - s * z;
    b->q = (struct quat){q.w - t * q.y, q.x - t * q.z, q.y + t * q.w, q.z + t * q.x};
}

static void turn_z(struct spinning_body *b, double angle)
{
    double t = half_tangent(angle), k = 2.0 / (1.0 + t * t), c = k - 1.0, s = k * t;
    struct quat q = b->q;
    double x = b->momentum.x, y = b->momentum.y;
    b->momentum.x = c * x + s * y;
    b->momentum.y = c * y - s * x;
    b->q = (struct quat){q.w - t * q.z, q.x + t * q.y, q.y - t * q.x, q.z + t * q.w};
}

/* One step of second order; per_moment: its time over each moment. */
static void step2(struct spinning_body *b, struct vec3 per_moment)
{
    turn_x(b, 0.5 * per_moment.x * b->momentum.x);
    turn_y(b, 0.5 * per_moment.y * b->momentum.y);
    turn_z(b, per_moment.z * b->momentum.z);
    turn_y(b, 0.5 * per_moment.y * b->momentum.y);
    turn_x(b, 0.5 * per_moment.x * b->momentum.x);
}

static void normalise(struct spinning_body *b)
{
    struct quat q = b->q;
    double s = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    b->q = (struct quat){q.w * s, q.x * s, q.y * s, q.z * s};
}

static void step4(struct spinning_body *b, struct vec3 per_moment)
{
    const struct vec3 outer = vec3_scale(per_moment, OUTER), inner = vec3_scale(per_moment, INNER);
    step2(b, outer);
    step2(b, outer);
    step2(b, inner);
    step2(b, outer);
    step2(b, outer);
    normalise(b);
}

/* Turns the body slightly, about the axis across momentum and spin, to where its energy is half of
 * this. */
static void restore_energy(const struct free_rotation *r, struct spinning_body *b, double twice_j)
{
    struct vec3 m = b->momentum, spin = over(m, r->moment), across = vec3_cross(m, spin);
    double length2 = vec3_dot(across, across);
    if (!(length2 > PARALLEL * PARALLEL * vec3_dot(m, m) * vec3_dot(spin, spin)))
        return;
    /* The body turns by this vector, the momentum in body axes the other way. */
    struct vec3 turn = vec3_scale(across, 0.5 * (vec3_dot(m, spin) - twice_j) / length2);
    struct vec3 half = vec3_scale(turn, 0.5);
    double k = 2.0 / (1.0 + vec3_dot(half, half));
    struct vec3 once = vec3_cross(m, half);
    b->momentum = vec3_add(m, vec3_scale(vec3_add(once, vec3_cross(once, half)), k));
    struct quat q = b->q;
    struct vec3 v = {q.x, q.y, q.z}, axis = vec3_cross(v, half);
    b->q = (struct quat){q.w - vec3_dot(v, half), q.x + q.w * half.x + axis.x,
                         q.y + q.w * half.y + axis.y, q.z + q.w * half.z + axis.z};
    normalise(b);
}

struct vec3 free_rotation_momentum(struct vec3 moment, struct quat turned, struct vec3 spin_rps)
{
    const struct mat3 turn = rotation_matrix(turned);
    struct vec3 body = rotation_back(&turn, spin_rps);
    return rotation_apply(&turn,
                          (struct vec3){moment.x * body.x, moment.y * body.y, moment.z * body.z});
}

struct vec3 free_rotation_spin(struct vec3 moment, struct quat turned, struct vec3 momentum)
{
    const struct mat3 turn = rotation_matrix(turned);
    return rotation_apply(&turn, over(rotation_back(&turn, momentum), moment));
}

struct free_rotation free_rotation_of(struct vec3 moment, struct quat from, struct vec3 spin_rps,
                                      double duration_s)
{
    struct free_rotation r = {.from = from,
                              .moment = moment,
                              .momentum = free_rotation_momentum(moment, from, spin_rps),
                              .duration_s = duration_s};
    double steps = rate_most(&r) * duration_s / STEP_RAD;
    if (steps > STEPS_MAX) /* its orientation says nothing any more */
        r.duration_s *= STEPS_MAX / steps;
    if (steps > 0.0)
        r.steps = steps < STEPS_MAX ? 1 + (uint32_t)steps : STEPS_MAX;
    return r;
}

struct quat free_rotation_at(const struct free_rotation *rotation, double share)
{
    if (rotation->steps == 0 || share == 0.0)
        return rotation->from;
    struct vec3 moment = rotation->moment;
    if (moment.x == moment.y && moment.y == moment.z)
        return rotation_spun(rotation->from, over(rotation->momentum, moment),
                             share * rotation->duration_s);
    const struct mat3 turn = rotation_matrix(rotation->from);
    double dt_s = share * rotation->duration_s / rotation->steps;
    const struct vec3 per_moment = over((struct vec3){dt_s, dt_s, dt_s}, moment);
    struct spinning_body b = {rotation->from, rotation_back(&turn, rotation->momentum)};
    double twice_j = vec3_dot(b.momentum, over(b.momentum, moment));
    for (uint32_t i = 0; i < rotation->steps; i++)
        step4(&b, per_moment);
    restore_energy(rotation, &b, twice_j);
    restore_energy(rotation, &b, twice_j);
    return b.q;
}

double free_rotation_rate(const struct free_rotation *rotation, double *bend)
{
    double rate = rate_most(rotation);
    /* The centripetal part is at most rate^2. By Euler's equations the angular acceleration is at
     * most rate^2 / sqrt(3), as no moment of a body is more than the sum of the other two. */
    *bend = rate * rate * (1.0 + 0.57735026918962576451);
    return rate;
}

void free_rotation_turn(struct vec3 moment, struct quat *turned, struct vec3 *spin_rps, double dt_s)
{
    struct free_rotation rotation = free_rotation_of(moment, *turned, *spin_rps, dt_s);
    *turned = free_rotation_at(&rotation, 1.0);
    *spin_rps = free_rotation_spin(moment, *turned, rotation.momentum);
}
