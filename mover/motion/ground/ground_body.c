/* Sub-steps of a body with contacts to the ground. */
#include "mover/motion/ground/ground_body.h"

#define STEP_MAX_S (1.0 / 120.0)
#define STEP_MAX_M 0.5
#define STEPS_MAX  48.0

/* A body that has no energy for it is lifted out of the ground only from a greater depth [m]. */
#define LIFT_DEPTH_M (2.0 * GROUND_CONTACTS_SLOP_M)
#define LIFT_MPS     0.008 /* and so fast: the energy of its height comes from nothing */

/* Moves a body that rounding alone has lifted, without lifting it: it slides where the ground is
 * too steep for its friction, if that takes no energy. Elsewhere it stays. */
static void slide_or_stay(const struct ground_contacts *contacts, struct rigid_body *body,
                          const struct rigid_body *solved, double energy_j, double dt_s)
{
    struct rigid_body slid = *solved;
    body->centre = solved->centre;
    body->turn = solved->turn;
    if (!ground_contacts_too_steep(contacts))
        return;
    slid.centre = vec3_add(slid.centre, vec3_scale(slid.velocity, dt_s));
    rigid_body_turn(&slid, (struct vec3){0.0, 0.0, 0.0}, dt_s);
    if (rigid_body_limit_energy(&slid, energy_j))
        *body = slid;
}

/* Lifts a body less that has no energy for it, and turns it less if that would bring a point
 * deeper into the ground. solved: the body before it was moved. */
static void lift_less(const struct ground_contacts *contacts, struct rigid_body *body,
                      const struct rigid_body *solved, struct vec3 push, struct vec3 twist,
                      double energy_j, double dt_s)
{
    struct rigid_body turned = *solved;
    if (ground_contacts_depth(contacts) <= LIFT_DEPTH_M) {
        slide_or_stay(contacts, body, solved, energy_j, dt_s);
        return;
    }
    push.y = maths_min(push.y, LIFT_MPS);
    double share = ground_contacts_twist_share(contacts, push, twist);
    body->centre.y = maths_min(body->centre.y, solved->centre.y + LIFT_MPS * dt_s);
    rigid_body_turn(&turned, vec3_scale(twist, share), dt_s);
    body->turn = turned.turn;
}

double ground_body_steps(const struct rigid_body *body, const struct body_points *points,
                         double dt_s)
{
    double speed = vec3_length(body->velocity) + vec3_length(body->spin) * points->reach_m;
    double steps = ceil(maths_max(dt_s / STEP_MAX_S, speed * dt_s / STEP_MAX_M) - 1e-9);
    return maths_clamp(steps, 1.0, STEPS_MAX);
}

double ground_body_step(struct ground_contacts *contacts, struct rigid_body *body, double lift_mps2,
                        double dt_s)
{
    const double fall = (GRAVITY_MPS2 - lift_mps2) * dt_s;
    double energy = rigid_body_energy(body);
    if (lift_mps2 > 0.0)
        energy += body->inertia.mass_kg * lift_mps2 * dt_s *
                  (maths_max(body->velocity.y, 0.0) + lift_mps2 * dt_s);
    struct vec3 push = {0.0, 0.0, 0.0}, twist = {0.0, 0.0, 0.0};
    body->velocity.y -= fall;
    double impulse = ground_contacts_solve(contacts, body, dt_s);
    double taken = ground_contacts_taken(contacts, body);
    const bool touches = impulse > 0.0 || ground_contacts_depth(contacts) > LIFT_DEPTH_M;
    if (impulse > 0.0) {
        ground_contacts_plough(contacts, body, impulse);
        ground_contacts_roll(contacts, body);
    } else {
        push.y = 0.5 * fall;
    }
    if (touches)
        ground_contacts_push(contacts, body, dt_s, &push, &twist);
    const struct rigid_body solved = *body;
    body->centre = vec3_add(body->centre, vec3_scale(vec3_add(body->velocity, push), dt_s));
    rigid_body_turn(body, twist, dt_s);
    if (touches && !rigid_body_limit_energy(body, energy))
        lift_less(contacts, body, &solved, push, twist, energy, dt_s);
    return taken;
}
