/* The bodies' motion is that of one rigid body with their momentum, which has the least energy of
 * all motions with this momentum, and a rest that has no momentum. The rest must have none after
 * the shift either. It is made smaller where the energy would grow. */
#include "collider/solver/overlap_shift.h"

/* Growth of energy below this share of all of it is rounding. */
#define ROUNDING 1e-12

/* The bodies as one rigid body. */
struct whole {
    struct vec3 centre, velocity; /* [m], [m/s] of mass */
    struct vec3 angular;          /* [N m s] about the centre */
    struct mat3 inverse;          /* [1/(kg m2)] of the inertia */
    struct vec3 spin;             /* [rad/s] */
};

static struct mat3 inverse_of(const struct mat3 *a)
{
    const double(*m)[3] = a->m;
    struct mat3 inverse;
    for (int i = 0; i < 3; i++) {
        int p = (i + 1) % 3, q = (i + 2) % 3;
        for (int j = 0; j < 3; j++) {
            int r = (j + 1) % 3, s = (j + 2) % 3;
            inverse.m[j][i] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
        }
    }
    double determinant =
        m[0][0] * inverse.m[0][0] + m[0][1] * inverse.m[1][0] + m[0][2] * inverse.m[2][0];
    for (int i = 0; i < 9; i++)
        inverse.m[i / 3][i % 3] /= determinant;
    return inverse;
}

/* Returns the momentum [N m s] of a body's own rotation. */
static struct vec3 own_momentum(const struct solver_body *body, struct vec3 spin)
{
    struct mat3 inertia = inverse_of(&body->inverse_inertia);
    return rotation_apply(&inertia, spin);
}

static void find_centre(const struct solver_body *bodies, uint32_t count, struct whole *whole)
{
    double mass_kg = 0.0;
    *whole = (struct whole){.angular = {0.0, 0.0, 0.0}};
    for (uint32_t i = 0; i < count; i++) {
        double kg = 1.0 / bodies[i].inverse_mass.x;
        mass_kg += kg;
        whole->centre =
            vec3_add(whole->centre, vec3_scale(vec3_sub(bodies[i].centre, bodies[0].centre), kg));
        whole->velocity = vec3_add(whole->velocity, vec3_scale(bodies[i].velocity, kg));
    }
    whole->centre = vec3_add(bodies[0].centre, vec3_scale(whole->centre, 1.0 / mass_kg));
    whole->velocity = vec3_scale(whole->velocity, 1.0 / mass_kg);
}

static void find_inertia(const struct solver_body *bodies, uint32_t count, struct whole *whole)
{
    struct mat3 inertia = {{{0.0}}};
    for (uint32_t i = 0; i < count; i++) {
        const struct mat3 own = inverse_of(&bodies[i].inverse_inertia);
        struct vec3 off = vec3_sub(bodies[i].centre, whole->centre);
        const double d[3] = {off.x, off.y, off.z};
        double kg = 1.0 / bodies[i].inverse_mass.x, square = vec3_dot(off, off);
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++)
                inertia.m[row][column] += own.m[row][column] - kg * d[row] * d[column] +
                                          (row == column ? kg * square : 0.0);
        }
    }
    whole->inverse = inverse_of(&inertia);
}

/* Returns the angular momentum about the centre. */
static struct vec3 angular_of(const struct solver_body *bodies, uint32_t count,
                              const struct whole *whole)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 off = vec3_sub(bodies[i].centre, whole->centre);
        struct vec3 momentum = vec3_scale(vec3_sub(bodies[i].velocity, whole->velocity),
                                          1.0 / bodies[i].inverse_mass.x);
        sum = vec3_add(
            sum, vec3_add(vec3_cross(off, momentum), own_momentum(&bodies[i], bodies[i].spin)));
    }
    return sum;
}

/* Adds the motion of one rigid body, `share` times, to all bodies. */
static void add_rigid(struct solver_body *bodies, uint32_t count, const struct whole *whole,
                      struct vec3 spin, double share)
{
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 off = vec3_sub(bodies[i].centre, whole->centre);
        bodies[i].velocity = vec3_add(bodies[i].velocity, vec3_scale(vec3_cross(spin, off), share));
        bodies[i].spin = vec3_add(bodies[i].spin, vec3_scale(spin, share));
    }
}

/* Returns twice the kinetic energy [J] relative to the centre. */
static double twice_energy(const struct solver_body *bodies, uint32_t count,
                           const struct whole *whole)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 velocity = vec3_sub(bodies[i].velocity, whole->velocity);
        sum += vec3_dot(velocity, velocity) / bodies[i].inverse_mass.x +
               vec3_dot(bodies[i].spin, own_momentum(&bodies[i], bodies[i].spin));
    }
    return sum;
}

static void scale_rest(struct solver_body *bodies, uint32_t count, const struct whole *whole,
                       double share)
{
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 velocity = vec3_sub(bodies[i].velocity, whole->velocity);
        bodies[i].velocity = vec3_add(whole->velocity, vec3_scale(velocity, share));
        bodies[i].spin = vec3_scale(bodies[i].spin, share);
    }
}

static void shift_all(struct solver_body *bodies, const struct vec3 *shift, uint32_t count,
                      double share)
{
    for (uint32_t i = 0; i < count; i++)
        bodies[i].centre = vec3_add(bodies[i].centre, vec3_scale(shift[i], share));
}

/* Gives bodies at rest relative to each other, but for a rest of motion, the motion of one rigid
 * body and as much of that rest as `left`, twice its energy, allows. */
static void take_up(struct solver_body *bodies, uint32_t count, const struct whole *moved,
                    double left)
{
    struct vec3 gained = angular_of(bodies, count, moved);
    add_rigid(bodies, count, moved, rotation_apply(&moved->inverse, gained), -1.0);
    double now = twice_energy(bodies, count, moved);
    if (now > left)
        scale_rest(bodies, count, moved, sqrt(maths_max(left, 0.0) / now));
    add_rigid(bodies, count, moved, moved->spin, 1.0);
}

bool overlap_shift_restore(const struct solver_body *before, struct solver_body *bodies,
                           uint32_t count)
{
    struct whole whole, moved;
    find_centre(before, count, &whole);
    find_centre(bodies, count, &moved);
    find_inertia(bodies, count, &moved);
    whole.angular = angular_of(before, count, &whole);
    moved.spin = rotation_apply(&moved.inverse, whole.angular);
    double energy = twice_energy(before, count, &whole);
    double left = energy - vec3_dot(moved.spin, whole.angular);
    if (left < -ROUNDING * energy)
        return false;
    struct vec3 change = vec3_sub(whole.velocity, moved.velocity);
    moved.velocity = whole.velocity;
    for (uint32_t i = 0; i < count; i++)
        bodies[i].velocity = vec3_add(bodies[i].velocity, change);
    take_up(bodies, count, &moved, left);
    return true;
}

bool overlap_shift_free(struct solver_body *bodies, const struct vec3 *shift, uint32_t count)
{
    struct whole whole = {.angular = {0.0, 0.0, 0.0}};
    double slack = ROUNDING * twice_energy(bodies, count, &whole);
    find_centre(bodies, count, &whole);
    find_inertia(bodies, count, &whole);
    whole.angular = angular_of(bodies, count, &whole);
    whole.spin = rotation_apply(&whole.inverse, whole.angular);
    add_rigid(bodies, count, &whole, whole.spin, -1.0);
    double rest = twice_energy(bodies, count, &whole);
    struct whole moved = whole;
    shift_all(bodies, shift, count, 1.0);
    find_inertia(bodies, count, &moved);
    moved.spin = rotation_apply(&moved.inverse, whole.angular);
    double left = rest + vec3_dot(vec3_sub(whole.spin, moved.spin), whole.angular);
    if (left < -slack) { /* as one rigid body alone they would have more energy */
        shift_all(bodies, shift, count, -1.0);
        add_rigid(bodies, count, &whole, whole.spin, 1.0);
        return false;
    }
    take_up(bodies, count, &moved, left);
    return true;
}
