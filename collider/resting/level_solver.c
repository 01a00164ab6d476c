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

/* Returns the effective mass of both bodies along a line with these levers [kg], 0 if neither can
 * move. */
static double mass_along(const struct level_body *a, const struct level_body *b, double lever_a,
                         double lever_b)
{
    double mobility = a->inverse_mass + b->inverse_mass + a->inverse_moment * lever_a * lever_a +
                      b->inverse_moment * lever_b * lever_b;
    return mobility > 0.0 ? 1.0 / mobility : 0.0;
}

/* Returns the speed of the second body relative to the first at the point, along the normal. */
static double speed_normal(const struct level_motion *a, const struct level_motion *b,
                           const struct level_contact *c)
{
    return (b->x - a->x) * c->normal_x + (b->z - a->z) * c->normal_z + b->spin * c->normal_lever_b -
           a->spin * c->normal_lever_a;
}

/* Returns the same across the normal, to its left. */
static double speed_across(const struct level_motion *a, const struct level_motion *b,
                           const struct level_contact *c)
{
    return (b->z - a->z) * c->normal_x - (b->x - a->x) * c->normal_z + b->spin * c->across_lever_b -
           a->spin * c->across_lever_a;
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
        c->normal_lever_a = lever(c->a_x, c->a_z, c->normal_x, c->normal_z);
        c->normal_lever_b = lever(c->b_x, c->b_z, c->normal_x, c->normal_z);
        c->across_lever_a = lever(c->a_x, c->a_z, -c->normal_z, c->normal_x);
        c->across_lever_b = lever(c->b_x, c->b_z, -c->normal_z, c->normal_x);
        c->normal_kg = mass_along(a, b, c->normal_lever_a, c->normal_lever_b);
        c->across_kg = mass_along(a, b, c->across_lever_a, c->across_lever_b);
        c->normal_before_mps = speed_normal(&a->moved, &b->moved, c);
        c->across_before_mps = speed_across(&a->moved, &b->moved, c);
        c->apart_ns = 0.0;
    }
}

/* --- one point ---------------------------------------------------------------------------------*/

double level_solver_closing(const struct level_body *body, const struct level_contact *contact)
{
    const struct level_motion *a = &body[contact->a].moved, *b = &body[contact->b].moved;
    double vx = b->x + b->spin * contact->b_z - a->x - a->spin * contact->a_z;
    double vz = b->z - b->spin * contact->b_x - a->z + a->spin * contact->a_x;
    return -(vx * contact->normal_x + vz * contact->normal_z);
}

/* Gives the second body an impulse at the point along the normal, and the first the opposite. */
static void push_normal(const struct level_body *a, const struct level_body *b,
                        struct level_motion *of_a, struct level_motion *of_b,
                        const struct level_contact *c, double ns)
{
    double x = ns * c->normal_x, z = ns * c->normal_z;
    of_a->x -= x * a->inverse_mass;
    of_a->z -= z * a->inverse_mass;
    of_a->spin -= ns * c->normal_lever_a * a->inverse_moment;
    of_b->x += x * b->inverse_mass;
    of_b->z += z * b->inverse_mass;
    of_b->spin += ns * c->normal_lever_b * b->inverse_moment;
}

/* The same across the normal, to its left. */
static void push_across(struct level_body *a, struct level_body *b, const struct level_contact *c,
                        double ns)
{
    double x = -ns * c->normal_z, z = ns * c->normal_x;
    a->moved.x -= x * a->inverse_mass;
    a->moved.z -= z * a->inverse_mass;
    a->moved.spin -= ns * c->across_lever_a * a->inverse_moment;
    b->moved.x += x * b->inverse_mass;
    b->moved.z += z * b->inverse_mass;
    b->moved.spin += ns * c->across_lever_b * b->inverse_moment;
}

/* Returns by how much to change a sum so that it stays within its limits, and changes it. */
static double add_within(double *sum, double step, double low, double high)
{
    double before = *sum;
    *sum = maths_clamp(before + step, low, high);
    return *sum - before;
}

/* Bounds the friction at the point by its load. */
static void solve_friction(struct level_body *a, struct level_body *b, struct level_contact *c)
{
    double limit = c->friction * c->normal_ns;
    double off = speed_across(&a->moved, &b->moved, c);
    double slide = add_within(&c->friction_ns, -off * c->across_kg, -limit, limit);
    push_across(a, b, c, slide);
}

/* Returns by how much the speed at the point changes at most [m/s]. Most points bear no load, and
 * cost only the look at their speed. */
static double solve_point(struct level_body *a, struct level_body *b, struct level_contact *c)
{
    if (c->normal_ns > 0.0 || c->friction_ns != 0.0)
        solve_friction(a, b, c);
    double off = c->least_mps - speed_normal(&a->moved, &b->moved, c);
    double step = add_within(&c->normal_ns, off * c->normal_kg, 0.0, INFINITY);
    if (step == 0.0)
        return 0.0;
    push_normal(a, b, &a->moved, &b->moved, c, step);
    return fabs(step) / c->normal_kg;
}

/* Recovers the point's overlap, or keeps its gap, by the second velocities and without friction.
 * Returns by how much the speed at the point changes [m/s]. */
static double part_point(struct level_body *a, struct level_body *b, struct level_contact *c)
{
    double along = speed_normal(&a->pushed, &b->pushed, c);
    double step = add_within(&c->apart_ns, (c->part_mps - along) * c->normal_kg, 0.0, INFINITY);
    if (step == 0.0)
        return 0.0;
    push_normal(a, b, &a->pushed, &b->pushed, c, step);
    return fabs(step) / c->normal_kg;
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

/* Gives the bodies the impulses with which the points begin. Returns true if there is one. */
static bool begin(struct level_body *body, struct level_contact *contact, uint32_t contacts)
{
    bool any = false;
    for (uint32_t i = 0; i < contacts; i++) {
        struct level_contact *c = &contact[i];
        struct level_body *a = &body[c->a], *b = &body[c->b];
        double limit = c->friction * c->normal_ns;
        c->friction_ns = maths_clamp(c->friction_ns, -limit, limit);
        if (c->normal_ns == 0.0)
            continue;
        push_normal(a, b, &a->moved, &b->moved, c, c->normal_ns);
        push_across(a, b, c, c->friction_ns);
        any = true;
    }
    return any;
}

static void sweep_all(struct level_body *body, uint32_t bodies, struct level_contact *contact,
                      uint32_t contacts, uint32_t sweeps)
{
    double change = INFINITY;
    for (uint32_t sweep = 0; sweep < sweeps && change > LEVEL_SOLVER_ENOUGH_MPS; sweep++) {
        change = 0.0;
        for (uint32_t i = 0; i < bodies; i++)
            hold(&body[i]);
        for (uint32_t n = 0; n < contacts; n++) {
            struct level_contact *c = in_turn(contact, contacts, sweep, n);
            change = maths_max(change, solve_point(&body[c->a], &body[c->b], c));
        }
    }
}

/* Returns the work that the contacts have done on the bodies [J]: each impulse times the mean of
 * the speeds before and after. */
static double work_of(const struct level_body *body, const struct level_contact *contact,
                      uint32_t contacts)
{
    double work = 0.0;
    for (uint32_t i = 0; i < contacts; i++) {
        const struct level_contact *c = &contact[i];
        const struct level_motion *a = &body[c->a].moved, *b = &body[c->b].moved;
        work += 0.5 * c->normal_ns * (c->normal_before_mps + speed_normal(a, b, c)) +
                0.5 * c->friction_ns * (c->across_before_mps + speed_across(a, b, c));
    }
    return work;
}

void level_solver_run(struct level_body *body, uint32_t bodies, struct level_contact *contact,
                      uint32_t contacts)
{
    prepare(body, bodies, contact, contacts);
    bool warm = begin(body, contact, contacts);
    sweep_all(body, bodies, contact, contacts,
              warm ? LEVEL_SOLVER_WARM_SWEEPS : LEVEL_SOLVER_COLD_SWEEPS);
    if (!warm || work_of(body, contact, contacts) <= 0.0)
        return;
    for (uint32_t i = 0; i < bodies; i++) {
        body[i].moved = body[i].wanted;
        body[i].along = body[i].across = body[i].turn = 0.0;
    }
    for (uint32_t i = 0; i < contacts; i++)
        contact[i].normal_ns = contact[i].friction_ns = 0.0;

    sweep_all(body, bodies, contact, contacts, LEVEL_SOLVER_COLD_SWEEPS);
}

void level_solver_part(struct level_body *body, struct level_contact *contact, uint32_t contacts)
{
    if (!any_overlap(contact, contacts))
        return;
    for (uint32_t i = 0; i < contacts; i++) {
        struct level_contact *c = &contact[i];
        c->part_mps = c->apart_mps != 0.0
                          ? c->apart_mps
                          : c->least_mps - speed_normal(&body[c->a].moved, &body[c->b].moved, c);
    }
    double change = INFINITY;
    for (uint32_t sweep = 0; sweep < LEVEL_SOLVER_PART_SWEEPS && change > LEVEL_SOLVER_ENOUGH_MPS;
         sweep++) {
        change = 0.0;
        for (uint32_t n = 0; n < contacts; n++) {
            struct level_contact *c = in_turn(contact, contacts, sweep, n);
            change = maths_max(change, part_point(&body[c->a], &body[c->b], c));
        }
    }
}
