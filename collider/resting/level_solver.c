/* Projected Gauss-Seidel over points of contact, and over the ground's grip on each body. */
#include "collider/resting/level_solver.h"

#include "world/maths/maths.h"

#include <stdbool.h>

/* --- preparation -------------------------------------------------------------------------------*/

/* Returns the lever of an impulse along (x, z) about the vertical through the body's centre: the
 * y component of r x d. */
static double lever(double r_x, double r_z, double x, double z)
{
    return r_z * x - r_x * z;
}

/* Returns the effective mass of both bodies along (x, z) [kg], 0 if neither can move. */
static double mass_along(const struct level_body *a, const struct level_body *b,
                         const struct level_contact *contact, double x, double z)
{
    double lever_a = lever(contact->a_x, contact->a_z, x, z);
    double lever_b = lever(contact->b_x, contact->b_z, x, z);
    double mobility = a->inverse_mass + b->inverse_mass + a->inverse_moment * lever_a * lever_a +
                      b->inverse_moment * lever_b * lever_b;
    return mobility > 0.0 ? 1.0 / mobility : 0.0;
}

static void prepare(struct level_body *body, uint32_t bodies, struct level_contact *contact,
                    uint32_t contacts)
{
    for (uint32_t i = 0; i < bodies; i++) {
        body[i].wanted = body[i].moved;
        body[i].pushed = (struct level_motion){0.0, 0.0, 0.0};
        body[i].along = body[i].across = body[i].turn = 0.0;
    }
    for (uint32_t i = 0; i < contacts; i++) {
        struct level_contact *c = &contact[i];
        const struct level_body *a = &body[c->a], *b = &body[c->b];
        c->normal_kg = mass_along(a, b, c, c->normal_x, c->normal_z);
        c->across_kg = mass_along(a, b, c, -c->normal_z, c->normal_x);
        c->normal_ns = c->friction_ns = c->apart_ns = 0.0;
    }
}

/* --- one point ---------------------------------------------------------------------------------*/

/* Returns the speed of the second body relative to the first along (x, z), at the point. */
static double speed_along(const struct level_motion *a, const struct level_motion *b,
                          const struct level_contact *contact, double x, double z)
{
    double vx = b->x + b->spin * contact->b_z - a->x - a->spin * contact->a_z;
    double vz = b->z - b->spin * contact->b_x - a->z + a->spin * contact->a_x;
    return vx * x + vz * z;
}

double level_solver_closing(const struct level_body *body, const struct level_contact *contact)
{
    return -speed_along(&body[contact->a].moved, &body[contact->b].moved, contact,
                        contact->normal_x, contact->normal_z);
}

/* Gives the second body an impulse along (x, z) at the point, and the first the opposite. */
static void push(const struct level_body *body, struct level_motion *motion, double r_x, double r_z,
                 double x, double z)
{
    motion->x += x * body->inverse_mass;
    motion->z += z * body->inverse_mass;
    motion->spin += body->inverse_moment * lever(r_x, r_z, x, z);
}

/* Returns by how much to change a sum so that it stays within its limits, and changes it. */
static double add_within(double *sum, double step, double low, double high)
{
    double before = *sum;
    *sum = maths_clamp(before + step, low, high);
    return *sum - before;
}

static void solve_point(struct level_body *a, struct level_body *b, struct level_contact *c)
{
    double nx = c->normal_x, nz = c->normal_z;
    double limit = c->friction * c->normal_ns;
    double across = speed_along(&a->moved, &b->moved, c, -nz, nx);
    double step = add_within(&c->friction_ns, -across * c->across_kg, -limit, limit);
    push(a, &a->moved, c->a_x, c->a_z, nz * step, -nx * step);
    push(b, &b->moved, c->b_x, c->b_z, -nz * step, nx * step);
    double along = speed_along(&a->moved, &b->moved, c, nx, nz);
    step = add_within(&c->normal_ns, (c->least_mps - along) * c->normal_kg, 0.0, INFINITY);
    push(a, &a->moved, c->a_x, c->a_z, -nx * step, -nz * step);
    push(b, &b->moved, c->b_x, c->b_z, nx * step, nz * step);
}

/* Recovers the point's overlap, or keeps its gap, by the second velocities and without friction. */
static void part_point(struct level_body *a, struct level_body *b, struct level_contact *c)
{
    double nx = c->normal_x, nz = c->normal_z;
    double along = speed_along(&a->pushed, &b->pushed, c, nx, nz);
    double least = c->apart_mps;
    if (least == 0.0)
        least = c->least_mps - speed_along(&a->moved, &b->moved, c, nx, nz);
    double step = add_within(&c->apart_ns, (least - along) * c->normal_kg, 0.0, INFINITY);
    push(a, &a->pushed, c->a_x, c->a_z, -nx * step, -nz * step);
    push(b, &b->pushed, c->b_x, c->b_z, nx * step, nz * step);
}

/* --- the ground --------------------------------------------------------------------------------*/

/* The ground's grip brings the body back to the motion that its mover gave it. */
static void hold(struct level_body *body)
{
    double fx = body->forward_x, fz = body->forward_z;
    if (body->inverse_mass == 0.0)
        return;
    double off_x = body->moved.x - body->wanted.x, off_z = body->moved.z - body->wanted.z;
    double along = add_within(&body->along, -(off_x * fx + off_z * fz) / body->inverse_mass,
                              -body->grip_along, body->grip_along);
    double across = add_within(&body->across, -(off_z * fx - off_x * fz) / body->inverse_mass,
                               -body->grip_across, body->grip_across);
    body->moved.x += (along * fx - across * fz) * body->inverse_mass;
    body->moved.z += (along * fz + across * fx) * body->inverse_mass;
    double off = body->moved.spin - body->wanted.spin;
    double turn =
        add_within(&body->turn, -off / body->inverse_moment, -body->grip_turn, body->grip_turn);
    body->moved.spin += turn * body->inverse_moment;
}

/* --- all ---------------------------------------------------------------------------------------*/

static struct level_contact *in_turn(struct level_contact *contact, uint32_t contacts,
                                     uint32_t sweep, uint32_t n)
{
    return &contact[sweep % 2 == 0 ? n : contacts - 1 - n];
}

static bool any_overlap(const struct level_contact *contact, uint32_t contacts)
{
    for (uint32_t i = 0; i < contacts; i++) {
        if (contact[i].apart_mps > 0.0)
            return true;
    }
    return false;
}

void level_solver_run(struct level_body *body, uint32_t bodies, struct level_contact *contact,
                      uint32_t contacts)
{
    prepare(body, bodies, contact, contacts);
    for (uint32_t sweep = 0; sweep < LEVEL_SOLVER_SWEEPS; sweep++) {
        for (uint32_t i = 0; i < bodies; i++)
            hold(&body[i]);
        for (uint32_t n = 0; n < contacts; n++) {
            struct level_contact *c = in_turn(contact, contacts, sweep, n);
            solve_point(&body[c->a], &body[c->b], c);
        }
    }
}

void level_solver_part(struct level_body *body, struct level_contact *contact, uint32_t contacts)
{
    if (!any_overlap(contact, contacts))
        return;
    for (uint32_t sweep = 0; sweep < LEVEL_SOLVER_SWEEPS; sweep++) {
        for (uint32_t n = 0; n < contacts; n++) {
            struct level_contact *c = in_turn(contact, contacts, sweep, n);
            part_point(&body[c->a], &body[c->b], c);
        }
    }
}
