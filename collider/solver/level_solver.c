/* Projected Gauss-Seidel over points of contact, and over the ground's grip on each body. */
#include "collider/solver/level_solver.h"

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

/* --- lanes -------------------------------------------------------------------------------------*/

static void set_motion(struct level_lanes *lanes, uint32_t index, const struct level_motion *motion,
                       double inverse_mass)
{
    lanes->motion[index] = (f64x4){motion->x, motion->z, motion->spin, inverse_mass};
}

/* Sets what stands behind the last body, up to a whole four: it has no motion and is fixed. */
static void set_no_body(struct level_lanes *lanes)
{
    const struct level_motion none = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < 4; i++)
        set_motion(lanes, lanes->bodies + i, &none, 0.0);
}

static struct level_motion motion_of(const struct level_lanes *lanes, uint32_t index)
{
    const f64x4 *motion = &lanes->motion[index];
    return (struct level_motion){(*motion)[0], (*motion)[1], (*motion)[2]};
}

/* Sets the bodies' motions to what they are given, and that of no body to 0. */
static void set_motions(struct level_lanes *lanes, const struct level_body *body)
{
    for (uint32_t i = 0; i < lanes->bodies; i++)
        set_motion(lanes, i, &body[i].moved, body[i].inverse_mass);
    set_no_body(lanes);
}

static void set_held(struct level_lanes *lanes, const struct level_body *body)
{
    if (lanes->bodies % 4 != 0)
        lanes->held[lanes->bodies / 4] = (struct level_held){.forward_x = {0.0}};
    for (uint32_t i = 0; i < lanes->bodies; i++) {
        struct level_held *held = &lanes->held[i / 4];
        uint32_t lane = i % 4;
        held->forward_x[lane] = body[i].forward_x;
        held->forward_z[lane] = body[i].forward_z;
        held->inverse_mass[lane] = body[i].inverse_mass;
        held->inverse_moment[lane] = body[i].inverse_moment;
        held->grip_along[lane] = body[i].grip_along;
        held->grip_across[lane] = body[i].grip_across;
        held->grip_turn[lane] = body[i].grip_turn;
        held->wanted_x[lane] = body[i].wanted.x;
        held->wanted_z[lane] = body[i].wanted.z;
        held->wanted_spin[lane] = body[i].wanted.spin;
        held->along[lane] = held->across[lane] = held->turn[lane] = 0.0;
    }
}

/* Sets what a point's lane needs of the normal, with its sum of impulses and the least speed. */
static void set_normal(struct level_four *four, uint32_t lane, const struct level_body *body,
                       const struct level_contact *c, double least_mps, double sum_ns)
{
    four->a[lane] = c->a;
    four->b[lane] = c->b;
    four->normal_x[lane] = c->normal_x;
    four->normal_z[lane] = c->normal_z;
    four->normal_lever_a[lane] = c->normal_lever_a;
    four->normal_lever_b[lane] = c->normal_lever_b;
    four->normal_kg[lane] = c->normal_kg;
    four->inverse_moment_a[lane] = body[c->a].inverse_moment;
    four->inverse_moment_b[lane] = body[c->b].inverse_moment;
    four->least_mps[lane] = least_mps;
    four->normal_ns[lane] = sum_ns;
}

static void set_points(struct level_lanes *lanes, const struct level_body *body,
                       const struct level_contact *contact, uint32_t contacts)
{
    for (uint32_t i = 0; i < contacts; i++) {
        const struct level_contact *c = &contact[i];
        struct level_four *four = &lanes->four[lanes->place[i] / 4];
        uint32_t lane = lanes->place[i] % 4;
        set_normal(four, lane, body, c, c->least_mps, c->normal_ns);
        four->across_lever_a[lane] = c->across_lever_a;
        four->across_lever_b[lane] = c->across_lever_b;
        four->across_kg[lane] = c->across_kg;
        four->friction[lane] = c->friction;
        four->friction_ns[lane] = c->friction_ns;
    }
}

/* Forgets all impulses. */
static void begin_cold(struct level_lanes *lanes, const struct level_body *body)
{
    const f64x4 none = SIMD_EVERY(0.0);
    set_motions(lanes, body);
    set_held(lanes, body);
    for (uint32_t i = 0; i < lanes->fours; i++)
        lanes->four[i].normal_ns = lanes->four[i].friction_ns = none;
}

/* Takes the result of the sweeps. */
static void take_result(const struct level_lanes *lanes, struct level_body *body,
                        struct level_contact *contact, uint32_t contacts)
{
    for (uint32_t i = 0; i < lanes->bodies; i++)
        body[i].moved = motion_of(lanes, i);
    for (uint32_t i = 0; i < contacts; i++) {
        const struct level_four *four = &lanes->four[lanes->place[i] / 4];
        contact[i].normal_ns = four->normal_ns[lanes->place[i] % 4];
        contact[i].friction_ns = four->friction_ns[lanes->place[i] % 4];
    }
}

/* --- all ---------------------------------------------------------------------------------------*/

static bool any_overlap(const struct level_contact *contact, uint32_t contacts)
{
    for (uint32_t i = 0; i < contacts; i++) {
        if (contact[i].apart_mps > 0.0)
            return true;
    }
    return false;
}

static void sweep_all(struct level_lanes *lanes, uint32_t sweeps)
{
    double change = INFINITY;
    for (uint32_t sweep = 0; sweep < sweeps && change > LEVEL_SOLVER_ENOUGH_MPS; sweep++) {
        level_lanes_hold(lanes);
        change = level_lanes_sweep(lanes, sweep % 2 != 0);
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

void level_solver_run(struct level_lanes *lanes, struct level_body *body, uint32_t bodies,
                      struct level_contact *contact, uint32_t contacts)
{
    prepare(body, bodies, contact, contacts);
    level_lanes_arrange(lanes, bodies, contact, contacts);
    set_motions(lanes, body);
    set_held(lanes, body);
    set_points(lanes, body, contact, contacts);
    bool warm = level_lanes_begin(lanes);
    sweep_all(lanes, warm ? LEVEL_SOLVER_WARM_SWEEPS : LEVEL_SOLVER_COLD_SWEEPS);
    take_result(lanes, body, contact, contacts);
    if (!warm || work_of(body, contact, contacts) <= 0.0)
        return;
    for (uint32_t i = 0; i < bodies; i++)
        body[i].moved = body[i].wanted;
    begin_cold(lanes, body);
    sweep_all(lanes, LEVEL_SOLVER_COLD_SWEEPS);
    take_result(lanes, body, contact, contacts);
}

void level_solver_part(struct level_lanes *lanes, struct level_body *body, uint32_t bodies,
                       struct level_contact *contact, uint32_t contacts)
{
    if (!any_overlap(contact, contacts))
        return;
    for (uint32_t i = 0; i < contacts; i++) {
        struct level_contact *c = &contact[i];
        struct level_four *four = &lanes->four[lanes->place[i] / 4];
        c->part_mps = c->apart_mps != 0.0
                          ? c->apart_mps
                          : c->least_mps - speed_normal(&body[c->a].moved, &body[c->b].moved, c);
        four->least_mps[lanes->place[i] % 4] = c->part_mps;
        four->normal_ns[lanes->place[i] % 4] = 0.0;
    }
    for (uint32_t i = 0; i < bodies; i++)
        set_motion(lanes, i, &body[i].pushed, body[i].inverse_mass);
    set_no_body(lanes);
    double change = INFINITY;
    for (uint32_t sweep = 0; sweep < LEVEL_SOLVER_PART_SWEEPS && change > LEVEL_SOLVER_ENOUGH_MPS;
         sweep++)
        change = level_lanes_sweep_smooth(lanes, sweep % 2 != 0);
    for (uint32_t i = 0; i < bodies; i++)
        body[i].pushed = motion_of(lanes, i);
}
