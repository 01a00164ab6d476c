/* A step turns the body by one vector, which is the Magnus expansion of its spin in body axes to
 * the fourth order (Blanes, Casas, Oteo, Ros 2009); the derivatives of the spin follow from Euler's
 * equations. The angular momentum in the world is conserved exactly, because only the body turns.
 * At the end a small turn puts the body back on its energy. */
#include "world/entity/free_rotation.h"

#define STEP_RAD  0.05  /* turned in one step; half as much divides the error by 16 */
#define STEPS_MAX 1280u /* bounds the time of a call */

/* Without this share of |L| |spin| between them, momentum and spin are parallel: the body turns
 * about a principal axis, where no small turn changes the energy. */
#define PARALLEL 1e-6

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

/* Turns the body about an axis in body axes. half is as long as the tangent of half the angle. The
 * momentum in body axes turns the other way. */
static void turn_by(struct spinning_body *b, struct vec3 half)
{
    double k = 2.0 / (1.0 + vec3_dot(half, half));
    struct vec3 once = vec3_cross(b->momentum, half);
    b->momentum = vec3_add(b->momentum, vec3_scale(vec3_add(once, vec3_cross(once, half)), k));
    struct quat q = b->q;
    struct vec3 v = {q.x, q.y, q.z}, axis = vec3_cross(v, half);
    b->q = (struct quat){q.w - vec3_dot(v, half), q.x + q.w * half.x + axis.x,
                         q.y + q.w * half.y + axis.y, q.z + q.w * half.z + axis.z};
}

static void normalise(struct spinning_body *b)
{
    struct quat q = b->q;
    double s = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    b->q = (struct quat){q.w * s, q.x * s, q.y * s, q.z * s};
}

static struct vec3 times(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

/* One step. m, m1 ...: the momentum in body axes and its derivatives; w, w1 ... of the spin. */
static void step(struct spinning_body *b, struct vec3 per_moment, double dt_s)
{
    const struct vec3 m = b->momentum, w = times(m, per_moment);
    const struct vec3 m1 = vec3_cross(m, w), w1 = times(m1, per_moment);
    const struct vec3 m2 = vec3_add(vec3_cross(m1, w), vec3_cross(m, w1)),
                      w2 = times(m2, per_moment);
    const struct vec3 m3 = vec3_add(vec3_add(vec3_cross(m2, w), vec3_cross(m, w2)),
                                    vec3_scale(vec3_cross(m1, w1), 2.0));
    const struct vec3 w3 = times(m3, per_moment);
    struct vec3 fourth = vec3_scale(vec3_add(w3, vec3_cross(w, w2)), dt_s / 24.0);
    struct vec3 third =
        vec3_add(vec3_scale(w2, 1.0 / 6.0), vec3_scale(vec3_cross(w, w1), 1.0 / 12.0));
    struct vec3 turn = vec3_scale(vec3_add(third, fourth), dt_s);
    turn = vec3_scale(vec3_add(vec3_scale(w1, 0.5), turn), dt_s);
    turn = vec3_scale(vec3_add(w, turn), dt_s);
    /* The tangent of half the angle over the angle, by its series: to 1e-11 of STEP_RAD. */
    double square = vec3_dot(turn, turn);
    turn_by(b, vec3_scale(turn, 0.5 + square * (1.0 / 24.0 + square * (1.0 / 240.0))));
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
    turn_by(b, vec3_scale(turn, 0.5));
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
    const struct vec3 per_moment = over((struct vec3){1.0, 1.0, 1.0}, moment);
    double dt_s = share * rotation->duration_s / rotation->steps;
    struct spinning_body b = {rotation->from, rotation_back(&turn, rotation->momentum)};
    double twice_j = vec3_dot(b.momentum, over(b.momentum, moment));
    for (uint32_t i = 0; i < rotation->steps; i++)
        step(&b, per_moment, dt_s);
    normalise(&b);
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
