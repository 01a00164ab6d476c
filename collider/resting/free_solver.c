/* One point after the other: normal, friction, rolling; then the ground's grip. */
#include "collider/resting/free_solver.h"

#define PUSH_SWEEPS 20
#define SETTLED_MPS 1e-5 /* sweeps that change no point's speed by more are the last */

/* Heavy bodies on light ones need many sweeps. Their number is bounded, and so is their work. */
#define SWEEPS_LEAST 40u
#define SWEEPS_MOST  400u
#define SOLVED_MOST  20000u /* contacts in all sweeps */

/* --- impulses ----------------------------------------------------------------------------------*/

static struct vec3 slip_of(const struct free_motion *a, const struct free_motion *b,
                           const struct free_contact *contact)
{
    struct vec3 at_a = vec3_add(a->velocity, vec3_cross(a->spin, contact->arm_a));
    struct vec3 at_b = vec3_add(b->velocity, vec3_cross(b->spin, contact->arm_b));
    return vec3_sub(at_b, at_a);
}

/* Returns the part of a direction in which a body can move. */
static struct vec3 free_part(const struct free_body *body, struct vec3 axis)
{
    return body->held ? vec3_sub(axis, vec3_scale(body->up, vec3_dot(axis, body->up))) : axis;
}

/* Gives one side an impulse of this size along an axis. */
static void push_side(const struct free_body *body, struct free_motion *motion, struct vec3 axis,
                      struct vec3 twist, double impulse_ns)
{
    struct vec3 change = vec3_scale(free_part(body, axis), impulse_ns * body->inverse_mass);
    motion->velocity = vec3_add(motion->velocity, change);
    motion->spin = vec3_add(motion->spin, vec3_scale(twist, impulse_ns));
}

static void apply(struct free_body *a, struct free_body *b, const struct free_contact *contact,
                  int k, double impulse_ns)
{
    push_side(a, &a->moved, contact->axis[k], contact->twist_a[k], -impulse_ns);
    push_side(b, &b->moved, contact->axis[k], contact->twist_b[k], impulse_ns);
}

double free_solver_closing(const struct free_body *body, const struct free_contact *contact)
{
    return -vec3_dot(slip_of(&body[contact->a].moved, &body[contact->b].moved, contact),
                     contact->normal);
}

/* --- a contact's axes --------------------------------------------------------------------------*/

/* Returns the speed that a unit impulse along the axis gives one side at the point [1/kg]. */
static double mobility(const struct free_body *body, struct vec3 arm, struct vec3 axis,
                       struct vec3 *twist)
{
    struct vec3 lever = vec3_cross(arm, axis);
    struct vec3 part = free_part(body, axis);
    double level = body->held ? vec3_dot(part, part) : 1.0;
    *twist = rotation_apply(&body->inverse_inertia, lever);
    return body->inverse_mass * level + vec3_dot(lever, *twist);
}

static void begin(const struct free_body *body, struct free_contact *contact)
{
    struct vec3 n = contact->normal;
    struct vec3 along =
        fabs(n.y) > 0.7 ? (struct vec3){n.y, -n.x, 0.0} : (struct vec3){n.z, 0.0, -n.x};
    along = vec3_scale(along, 1.0 / vec3_length(along));
    contact->axis[FREE_NORMAL] = n;
    contact->axis[FREE_ALONG] = along;
    contact->axis[FREE_ACROSS] = vec3_cross(n, along);
    for (int k = 0; k < FREE_AXES; k++) {
        double light =
            mobility(&body[contact->a], contact->arm_a, contact->axis[k], &contact->twist_a[k]) +
            mobility(&body[contact->b], contact->arm_b, contact->axis[k], &contact->twist_b[k]);
        contact->mass_kg[k] = light > 0.0 ? 1.0 / light : 0.0;
        contact->impulse_ns[k] = 0.0;
    }
    contact->rolling_nms = (struct vec3){0.0, 0.0, 0.0};
    contact->push_ns = 0.0;
}

/* --- one contact -------------------------------------------------------------------------------*/

/* Returns by how much the speed of the point changes [m/s]. */
static double solve_normal(struct free_body *a, struct free_body *b, struct free_contact *contact)
{
    double speed = vec3_dot(slip_of(&a->moved, &b->moved, contact), contact->normal);
    double before = contact->impulse_ns[FREE_NORMAL];
    double after =
        maths_max(0.0, before + (contact->least_mps - speed) * contact->mass_kg[FREE_NORMAL]);
    contact->impulse_ns[FREE_NORMAL] = after;
    apply(a, b, contact, FREE_NORMAL, after - before);
    return contact->mass_kg[FREE_NORMAL] > 0.0
               ? fabs(after - before) / contact->mass_kg[FREE_NORMAL]
               : 0.0;
}

/* Returns by how much the speed of the point changes [m/s]. */
static double solve_friction(struct free_body *a, struct free_body *b, struct free_contact *contact)
{
    struct vec3 slip = slip_of(&a->moved, &b->moved, contact);
    double most = contact->friction * contact->impulse_ns[FREE_NORMAL], after[FREE_AXES];
    for (int k = FREE_ALONG; k < FREE_AXES; k++)
        after[k] = contact->impulse_ns[k] - contact->mass_kg[k] * vec3_dot(slip, contact->axis[k]);
    double whole =
        sqrt(after[FREE_ALONG] * after[FREE_ALONG] + after[FREE_ACROSS] * after[FREE_ACROSS]);
    double share = whole > most ? most / whole : 1.0, changed = 0.0;
    for (int k = FREE_ALONG; k < FREE_AXES; k++) {
        double change = share * after[k] - contact->impulse_ns[k];
        contact->impulse_ns[k] += change;
        apply(a, b, contact, k, change);
        changed = maths_max(changed,
                            contact->mass_kg[k] > 0.0 ? fabs(change) / contact->mass_kg[k] : 0.0);
    }
    return changed;
}

/* A torque against the relative spin, at most the lever times the impulse along the normal. */
static void solve_rolling(struct free_body *a, struct free_body *b, struct free_contact *contact)
{
    struct vec3 spin = vec3_sub(b->moved.spin, a->moved.spin), before = contact->rolling_nms;
    double rate = vec3_length(spin);
    double most = contact->rolling_m * contact->impulse_ns[FREE_NORMAL];
    if (rate == 0.0 || (most == 0.0 && vec3_dot(before, before) == 0.0))
        return;
    struct vec3 about = vec3_scale(spin, 1.0 / rate);
    double light = vec3_dot(about, rotation_apply(&a->inverse_inertia, about)) +
                   vec3_dot(about, rotation_apply(&b->inverse_inertia, about));
    if (!(light > 0.0))
        return;
    struct vec3 after = vec3_sub(before, vec3_scale(about, rate / light));
    double whole = vec3_length(after);
    if (whole > most)
        after = vec3_scale(after, most / whole);
    struct vec3 change = vec3_sub(after, before);
    contact->rolling_nms = after;
    a->moved.spin = vec3_sub(a->moved.spin, rotation_apply(&a->inverse_inertia, change));
    b->moved.spin = vec3_add(b->moved.spin, rotation_apply(&b->inverse_inertia, change));
}

/* --- the ground's grip -------------------------------------------------------------------------*/

/* Returns the change of an impulse that brings the speed to the wanted one, within a bound. */
static double bounded(double *sum, double most, double off, double inverse)
{
    double before = *sum;
    *sum = inverse > 0.0 ? maths_clamp(before + off / inverse, -most, most) : 0.0;
    return *sum - before;
}

static void hold(struct free_body *body)
{
    struct vec3 across = {-body->forward.z, 0.0, body->forward.x};
    struct vec3 off = vec3_sub(body->wanted.velocity, body->moved.velocity);
    double turn = body->inverse_inertia.m[1][1];
    double along_ns = bounded(&body->grip.along, body->most.along, vec3_dot(off, body->forward),
                              body->inverse_mass);
    double across_ns =
        bounded(&body->grip.across, body->most.across, vec3_dot(off, across), body->inverse_mass);
    double turn_nms =
        bounded(&body->grip.turn, body->most.turn, body->wanted.spin.y - body->moved.spin.y, turn);
    struct vec3 impulse =
        vec3_add(vec3_scale(body->forward, along_ns), vec3_scale(across, across_ns));
    body->moved.velocity = vec3_add(body->moved.velocity, vec3_scale(impulse, body->inverse_mass));
    body->moved.spin.y += turn_nms * turn;
    /* What the ground holds stays where it is to the bit, and may sleep. */
    if (fabs(body->grip.along) < body->most.along && fabs(body->grip.across) < body->most.across)
        body->moved.velocity = body->wanted.velocity;
    if (fabs(body->grip.turn) < body->most.turn)
        body->moved.spin = body->wanted.spin;
}

/* --- all ---------------------------------------------------------------------------------------*/

static void sweep(struct free_body *body, uint32_t bodies, struct free_contact *contact,
                  uint32_t contacts)
{
    uint32_t sweeps =
        SOLVED_MOST / (contacts + 1) < SWEEPS_MOST ? SOLVED_MOST / (contacts + 1) : SWEEPS_MOST;
    for (uint32_t s = 0; s < SWEEPS_LEAST || s < sweeps; s++) {
        double most = 0.0;
        for (uint32_t n = 0; n < contacts; n++) {
            struct free_contact *one = &contact[s & 1 ? contacts - 1 - n : n];
            struct free_body *a = &body[one->a], *b = &body[one->b];
            solve_rolling(a, b, one);
            most = maths_max(most, solve_friction(a, b, one));
            most = maths_max(most, solve_normal(a, b, one));
        }
        for (uint32_t i = 0; i < bodies; i++) {
            if (body[i].held)
                hold(&body[i]);
        }
        if (most < SETTLED_MPS)
            return;
    }
}

/* Held bodies are not pushed. */
static void part(struct free_body *body, struct free_contact *contact, uint32_t contacts)
{
    for (uint32_t n = 0; n < PUSH_SWEEPS * contacts; n++) {
        struct free_contact *one = &contact[n % contacts];
        struct free_body *a = &body[one->a], *b = &body[one->b];
        double speed = vec3_dot(slip_of(&a->pushed, &b->pushed, one), one->normal);
        double before = one->push_ns;
        double wanted = one->apart_mps > 0.0 ? one->apart_mps : one->least_mps;
        one->push_ns = maths_max(0.0, before + (wanted - speed) * one->mass_kg[FREE_NORMAL]);
        if (!a->held)
            push_side(a, &a->pushed, one->normal, one->twist_a[FREE_NORMAL], before - one->push_ns);
        if (!b->held)
            push_side(b, &b->pushed, one->normal, one->twist_b[FREE_NORMAL], one->push_ns - before);
    }
}

void free_solver_run(struct free_body *body, uint32_t bodies, struct free_contact *contact,
                     uint32_t contacts)
{
    bool overlaps = false;
    for (uint32_t i = 0; i < bodies; i++) {
        body[i].wanted = body[i].moved;
        body[i].pushed = (struct free_motion){{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
        body[i].grip = (struct free_grip){0.0, 0.0, 0.0};
    }
    for (uint32_t i = 0; i < contacts; i++) {
        begin(body, &contact[i]);
        overlaps |= contact[i].apart_mps > 0.0;
    }
    sweep(body, bodies, contact, contacts);
    if (overlaps)
        part(body, contact, contacts);
}
