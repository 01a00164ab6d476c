/* Simultaneous impulses: contacts on axes of their own, sweeps, and the guard over energy. */
#include "collider/solver/contact_solver.h"

#include "world/runtime/work_done.h"

#include <stdbool.h>

/* A sweep that changes no velocity by more than this share of the greatest closing speed is the
 * last. With a greater value bodies still approach each other afterwards; with a smaller one
 * rounding keeps the sweeps going. */
#define SETTLED 1e-12

/* The same as a share of the greatest speed, for slow contacts of fast bodies: a few units in the
 * last place of a velocity. */
#define SETTLED_ROUNDING 1e-14

/* Bounds of the number of sweeps and of contacts solved in all, so that a great pile takes bounded
 * time. Without friction the sweeps converge wherever there is a solution: most islands take about
 * ten, a hundred bodies of very different masses about two hundred, and nearly locked bodies may
 * take thousands. */
#define SWEEPS_MAX  30000u
#define UPDATES_MAX 400000u

/* If the least change in this many sweeps is above this share of the least change before, the
 * sweeps do not converge. */
#define STALL_SWEEPS 500u
#define STALL_SHARE  0.99

/* With friction few islands need more than a hundred sweeps. One that takes more than this either
 * jams, so that the sweeps go round in circles, or is too large to be worth the time. */
#define FRICTION_SWEEPS_MAX  400u
#define FRICTION_UPDATES_MAX 20000u

/* Attempts with friction: the first with all of it, each next one with half as much. Then friction
 * is left out. */
#define SLACKENINGS 3

/* Sweeps that change a velocity by more than this many times the greatest speed diverge; no impact
 * makes bodies that much faster. */
#define RUNAWAY 1e3

/* An impulse along the normal that moves the contact along the normal by less than this share of
 * the whole motion cannot part the bodies: it would throw them aside. Such a contact is held. */
#define MOBILITY_LEAST 1e-6

/* A tangential direction that moves less than this share of the other is held. */
#define SLIP_LEAST 1e-12

/* Several contacts that lose less than this share of the energy that some of them take are solved
 * without restitution, too: the difference may be too great. */
#define LOST_LEAST 0.5

/* Growth of energy below this share of the work done counts as rounding. */
#define ENERGY_SLACK 1e-13

/* --- a contact's own axes ----------------------------------------------------------------------*/

static struct vec3 times(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static struct vec3 turned(const struct mat3 *m, struct vec3 v)
{
    return (struct vec3){m->m[0][0] * v.x + m->m[0][1] * v.y + m->m[0][2] * v.z,
                         m->m[1][0] * v.x + m->m[1][1] * v.y + m->m[1][2] * v.z,
                         m->m[2][0] * v.x + m->m[2][1] * v.y + m->m[2][2] * v.z};
}

static struct vec3 to_axes(const struct solver_contact *c, struct vec3 v)
{
    return (struct vec3){vec3_dot(v, c->normal), vec3_dot(v, c->state.tangent[0]),
                         vec3_dot(v, c->state.tangent[1])};
}

static struct vec3 to_world(const struct solver_contact *c, struct vec3 v)
{
    return vec3_add(vec3_scale(c->normal, v.x), vec3_add(vec3_scale(c->state.tangent[0], v.y),
                                                         vec3_scale(c->state.tangent[1], v.z)));
}

/* Two unit vectors across the normal. When the normal changes its sign, the first does too and the
 * second does not, so swapping the bodies changes only signs, to the bit. */
static void set_tangents(struct solver_contact *c)
{
    struct vec3 n = c->normal;
    struct vec3 first =
        fabs(n.y) < 0.7 ? (struct vec3){-n.z, 0.0, n.x} : (struct vec3){0.0, n.z, -n.y};
    c->state.tangent[0] = vec3_scale(first, 1.0 / vec3_length(first));
    c->state.tangent[1] = vec3_cross(n, c->state.tangent[0]);
}

/* --- bodies ------------------------------------------------------------------------------------*/

struct island {
    struct solver_body *bodies;
    struct solver_contact *contacts;
    uint32_t body_count, count; /* count: of contacts */
    double settled_mps;         /* a smaller change of velocity counts as none */
    double runaway_mps;         /* a greater change means divergence */
    bool rough;                 /* some contact has friction */
    bool level;                 /* bodies move horizontally and turn about the vertical alone */
    double restitution;         /* the greatest of the contacts that close */
    double friction;            /* 0..1 of each contact's own coefficient */
};

/* The same as slip() in a level island: the terms that are left out are 0. */
static struct vec3 slip_level(const struct solver_body *bodies, const struct solver_contact *c)
{
    const struct solver_body *a = &bodies[c->a], *b = &bodies[c->b];
    const struct solver_state *s = &c->state;
    double x = (b->velocity.x + b->spin.y * s->arm_b.z) - (a->velocity.x + a->spin.y * s->arm_a.z);
    double z = (b->velocity.z - b->spin.y * s->arm_b.x) - (a->velocity.z - a->spin.y * s->arm_a.x);
    return (struct vec3){x * c->normal.x + z * c->normal.z,
                         x * s->tangent[0].x + z * s->tangent[0].z, 0.0};
}

/* The same as push() in a level island. */
static void push_level(struct solver_body *bodies, const struct solver_contact *c,
                       struct vec3 impulse)
{
    struct solver_body *a = &bodies[c->a], *b = &bodies[c->b];
    const struct solver_state *s = &c->state;
    double x = c->normal.x * impulse.x + s->tangent[0].x * impulse.y;
    double z = c->normal.z * impulse.x + s->tangent[0].z * impulse.y;
    a->velocity.x -= a->inverse_mass.x * x;
    a->velocity.z -= a->inverse_mass.z * z;
    b->velocity.x += b->inverse_mass.x * x;
    b->velocity.z += b->inverse_mass.z * z;
    a->spin.y -= a->inverse_inertia.m[1][1] * (s->arm_a.z * x - s->arm_a.x * z);
    b->spin.y += b->inverse_inertia.m[1][1] * (s->arm_b.z * x - s->arm_b.x * z);
}

/* Velocity of b relative to a at the point, on the contact's axes. */
static struct vec3 slip(const struct island *island, const struct solver_contact *c)
{
    const struct solver_body *a = &island->bodies[c->a], *b = &island->bodies[c->b];
    if (island->level)
        return slip_level(island->bodies, c);
    struct vec3 va = vec3_add(a->velocity, vec3_cross(a->spin, c->state.arm_a));
    struct vec3 vb = vec3_add(b->velocity, vec3_cross(b->spin, c->state.arm_b));
    return to_axes(c, vec3_sub(vb, va));
}

static void push(const struct island *island, const struct solver_contact *c, struct vec3 impulse)
{
    struct solver_body *a = &island->bodies[c->a], *b = &island->bodies[c->b];
    if (island->level) {
        push_level(island->bodies, c, impulse);
        return;
    }
    struct vec3 p = to_world(c, impulse);
    a->velocity = vec3_sub(a->velocity, times(a->inverse_mass, p));
    b->velocity = vec3_add(b->velocity, times(b->inverse_mass, p));
    a->spin = vec3_sub(a->spin, turned(&a->inverse_inertia, vec3_cross(c->state.arm_a, p)));
    b->spin = vec3_add(b->spin, turned(&b->inverse_inertia, vec3_cross(c->state.arm_b, p)));
}

/* Change of velocity at the point by a unit impulse along a world direction. */
static struct vec3 yielding(const struct solver_body *body, struct vec3 arm, struct vec3 along)
{
    struct vec3 spin = turned(&body->inverse_inertia, vec3_cross(arm, along));
    return vec3_add(times(body->inverse_mass, along), vec3_cross(spin, arm));
}

/* The same for both bodies, on the contact's axes. */
static struct vec3 yielding_both(const struct solver_body *bodies, const struct solver_contact *c,
                                 struct vec3 along)
{
    return to_axes(c, vec3_add(yielding(&bodies[c->a], c->state.arm_a, along),
                               yielding(&bodies[c->b], c->state.arm_b, along)));
}

/* Inverse of the tangential mobility with the normal speed kept; zero along a direction in which
 * nothing moves. */
static void set_slip_mass(struct solver_state *state)
{
    const double(*m)[3] = (const double(*)[3])state->mobility.m;
    double s11 = m[1][1] - m[0][1] * m[0][1] / m[0][0];
    double s12 = m[1][2] - m[0][1] * m[0][2] / m[0][0];
    double s22 = m[2][2] - m[0][2] * m[0][2] / m[0][0];
    double trace = s11 + s22, determinant = s11 * s22 - s12 * s12;
    if (!(trace > SLIP_LEAST * (m[1][1] + m[2][2])))
        return;
    bool one_way = determinant <= SLIP_LEAST * trace * trace;
    double k = one_way ? 1.0 / (trace * trace) : 1.0 / determinant;
    state->slip_mass[0][0] = k * (one_way ? s11 : s22);
    state->slip_mass[1][1] = k * (one_way ? s22 : s11);
    state->slip_mass[0][1] = state->slip_mass[1][0] = k * (one_way ? s12 : -s12);
}

static void begin_contact(const struct island *island, struct solver_contact *c)
{
    const struct solver_body *bodies = island->bodies;
    struct solver_state *state = &c->state;
    *state = (struct solver_state){.arm_a = vec3_sub(c->point, bodies[c->a].centre),
                                   .arm_b = vec3_sub(c->point, bodies[c->b].centre)};
    set_tangents(c);
    struct vec3 n = yielding_both(bodies, c, c->normal);
    struct vec3 first = yielding_both(bodies, c, state->tangent[0]);
    struct vec3 second = yielding_both(bodies, c, state->tangent[1]);
    if (n.x > MOBILITY_LEAST * (n.x + first.y + second.z)) {
        state->mobility =
            (struct mat3){{{n.x, n.y, n.z}, {n.y, first.y, first.z}, {n.z, first.z, second.z}}};
        set_slip_mass(state);
    }
    state->before = slip(island, c);
    c->closing_mps = -state->before.x;
    c->impulse = (struct vec3){0.0, 0.0, 0.0};
    c->lost_j = 0.0;
}

/* --- one contact -------------------------------------------------------------------------------*/

/* Returns the contact's impulse if without it the bodies had this slip: afterwards the speed along
 * the normal is at least the target, and the impulse is within the friction cone. */
static struct vec3 alone(const struct solver_contact *c, double friction, struct vec3 without)
{
    const struct solver_state *state = &c->state;
    const double *n = state->mobility.m[0];
    double normal = (state->target_mps - without.x) / n[0];
    if (!(normal > 0.0))
        return (struct vec3){0.0, 0.0, 0.0};
    /* The slip at the end of the approach if there were no friction. */
    double plastic = normal * state->plastic_share;
    double slip1 = without.y + n[1] * plastic, slip2 = without.z + n[2] * plastic;
    /* The tangential impulse that ends the slip, and the normal one that keeps the normal speed. */
    double t1 = -(state->slip_mass[0][0] * slip1 + state->slip_mass[0][1] * slip2);
    double t2 = -(state->slip_mass[1][0] * slip1 + state->slip_mass[1][1] * slip2);
    double beside = -(n[1] * t1 + n[2] * t2) / n[0];
    double length = sqrt(t1 * t1 + t2 * t2);
    double share = 1.0;
    if (length > friction * (normal + beside))
        share = friction * normal / (length - friction * beside);
    return (struct vec3){normal + share * beside, share * t1, share * t2};
}

/* The same as alone() in a level island. */
static struct vec3 alone_level(const struct solver_contact *c, double friction, double without_n,
                               double without_t)
{
    const struct solver_state *state = &c->state;
    const double *n = state->mobility.m[0];
    double normal = (state->target_mps - without_n) / n[0];
    if (!(normal > 0.0))
        return (struct vec3){0.0, 0.0, 0.0};
    double plastic = normal * state->plastic_share;
    double across = -(state->slip_mass[0][0] * (without_t + n[1] * plastic));
    double beside = -(n[1] * across) / n[0];
    double share = 1.0, length = fabs(across);
    if (length > friction * (normal + beside))
        share = friction * normal / (length - friction * beside);
    return (struct vec3){normal + share * beside, share * across, 0.0};
}

/* The same as update() in a level island. */
static double update_level(const struct island *island, struct solver_contact *c)
{
    struct solver_state *state = &c->state;
    const double(*m)[3] = (const double(*)[3])state->mobility.m;
    struct vec3 now = slip_level(island->bodies, c);
    struct vec3 sum = alone_level(c, c->friction * island->friction,
                                  now.x - (m[0][0] * state->sum.x + m[0][1] * state->sum.y),
                                  now.y - (m[1][0] * state->sum.x + m[1][1] * state->sum.y));
    state->step = (struct vec3){sum.x - state->sum.x, sum.y - state->sum.y, 0.0};
    state->sum = sum;
    push_level(island->bodies, c, state->step);
    return m[0][0] * sqrt(state->step.x * state->step.x + state->step.y * state->step.y);
}

/* Solves a contact against the present velocities; returns the change of speed. */
static double update(const struct island *island, struct solver_contact *c)
{
    struct solver_state *state = &c->state;
    if (state->mobility.m[0][0] == 0.0)
        return 0.0;
    if (island->level)
        return update_level(island, c);
    struct vec3 own = turned(&state->mobility, state->sum);
    struct vec3 without = vec3_sub(slip(island, c), own);
    struct vec3 sum = alone(c, c->friction * island->friction, without);
    state->step = vec3_sub(sum, state->sum);
    state->sum = sum;
    push(island, c, state->step);
    return state->mobility.m[0][0] * vec3_length(state->step);
}

/* --- all of them -------------------------------------------------------------------------------*/

/* One round over the contacts; returns the greatest change of speed. */
static double sweep(const struct island *island)
{
    double most = 0.0;
    for (uint32_t i = 0; i < island->count; i++)
        most = maths_max(most, update(island, &island->contacts[i]));
    return most;
}

static double step_size(const struct island *island)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < island->count; i++) {
        const struct solver_state *state = &island->contacts[i].state;
        sum += state->mobility.m[0][0] * vec3_dot(state->step, state->step);
    }
    return sum;
}

/* Continues along the conjugate direction of the sweeps so far. The next sweep brings every contact
 * back into its friction cone. */
static void search(const struct island *island, double keep)
{
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_contact *c = &island->contacts[i];
        struct solver_state *state = &c->state;
        struct vec3 further = vec3_scale(state->search, keep);
        if (keep > 0.0) {
            state->sum = vec3_add(state->sum, further);
            push(island, c, further);
        }
        state->search = vec3_add(further, state->step);
    }
}

/* Computes the velocities again from the first ones and the present impulses, which removes the
 * rounding of the sweeps. */
static void renew(const struct island *island)
{
    for (uint32_t i = 0; i < island->body_count; i++) {
        struct solver_body *body = &island->bodies[i];
        body->velocity = body->velocity_before;
        body->spin = body->spin_before;
    }
    for (uint32_t i = 0; i < island->count; i++)
        push(island, &island->contacts[i], island->contacts[i].state.sum);
}

static void take_out(const struct island *island)
{
    for (uint32_t i = 0; i < island->count; i++)
        island->contacts[i].state.sum = island->contacts[i].state.search =
            (struct vec3){0.0, 0.0, 0.0};
    renew(island);
}

/* Returns true if the sweeps converged within the given numbers of sweeps and of contacts
 * solved. */
static bool sweep_all(const struct island *island, uint32_t sweeps, uint32_t updates)
{
    double size_before = 0.0, least = island->runaway_mps, least_before = least;
    for (uint32_t n = 1;; n++) {
        double change = sweep(island);
        work_done();
        if (change <= island->settled_mps || island->count == 1)
            return true;
        if (n == sweeps || (uint64_t)n * island->count >= updates)
            return false;
        if (!(change < island->runaway_mps))
            return false;
        least = maths_min(least, change);
        if (n % STALL_SWEEPS == 0) {
            if (least > STALL_SHARE * least_before)
                return false;
            least_before = least;
        }
        double size = step_size(island);
        search(island, size < size_before ? size / size_before : 0.0);
        size_before = size;
    }
}

/* Work that the contact took out of the bodies [J]: force times distance, the impulse being spread
 * evenly in time. */
static double work(const struct island *island, const struct solver_contact *c)
{
    struct vec3 twice = vec3_add(c->state.before, slip(island, c));
    return -0.5 * vec3_dot(c->state.sum, twice);
}

/* Kinetic energy that the impulses added [J]; 0 if it is below the rounding of the work done. */
static double gain(const struct island *island)
{
    double sum = 0.0, whole = 0.0;
    for (uint32_t i = 0; i < island->count; i++) {
        sum -= work(island, &island->contacts[i]);
        whole += fabs(vec3_dot(island->contacts[i].state.sum, island->contacts[i].state.before));
    }
    return sum > ENERGY_SLACK * whole ? sum : maths_min(sum, 0.0);
}

/* Solves all contacts from zero impulses, with as much friction as converges and, without
 * restitution, adds no energy. Returns true if some attempt converged. */
static bool settle(struct island *island, bool bouncing)
{
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_contact *c = &island->contacts[i];
        bool bounces = bouncing && c->closing_mps > 0.0;
        c->state.target_mps = bounces ? c->restitution * c->closing_mps : 0.0;
        c->state.plastic_share = bounces ? 1.0 / (1.0 + c->restitution) : 1.0;
    }
    island->friction = 1.0;
    for (int n = 0; n < SLACKENINGS && island->rough; n++) {
        take_out(island);
        bool converged = sweep_all(island, FRICTION_SWEEPS_MAX, FRICTION_UPDATES_MAX);
        renew(island);
        if (converged && (bouncing || !(gain(island) > 0.0)))
            return true;
        island->friction *= 0.5;
    }
    island->friction = 0.0;
    take_out(island);
    return sweep_all(island, SWEEPS_MAX, UPDATES_MAX);
}

/* --- energy ------------------------------------------------------------------------------------*/

/* Energy is quadratic along a line; at its start it is gain0 <= 0 with this slope, at its end gain1
 * > 0. Returns the greatest share 0..1 of the line up to which it stays at most 0. */
static double share_of_way(double gain0, double slope, double gain1)
{
    double bend = gain1 - gain0 - slope;
    double root = sqrt(maths_max(0.0, slope * slope - 4.0 * bend * gain0));
    if (slope > 0.0)
        return maths_clamp(-2.0 * gain0 / (slope + root), 0.0, 1.0);
    return bend > 0.0 ? maths_clamp((root - slope) / (2.0 * bend), 0.0, 1.0) : 0.0;
}

/* Takes the impulses out of the bodies and keeps them as bouncy. */
static void set_aside(const struct island *island)
{
    for (uint32_t i = 0; i < island->count; i++)
        island->contacts[i].state.bouncy = island->contacts[i].state.sum;
    take_out(island);
}

/* Moves from the present impulses towards the bouncy ones as far as the gain of energy stays at
 * most this much [J]. */
static void approach(const struct island *island, double gain0, double gain1, double most)
{
    double slope = 0.0;
    for (uint32_t i = 0; i < island->count; i++) {
        const struct solver_contact *c = &island->contacts[i];
        slope += vec3_dot(vec3_sub(c->state.bouncy, c->state.sum), slip(island, c));
    }
    double share = share_of_way(gain0 - most, slope, gain1 - most);
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_state *state = &island->contacts[i].state;
        state->sum = vec3_lerp(state->sum, state->bouncy, share);
    }
    renew(island);
}

/* Solves without restitution. Energy does not grow where the sweeps converge; elsewhere the
 * impulses are scaled down. Returns the gain before that. */
static double settle_softly(struct island *island)
{
    settle(island, false);
    renew(island);
    double gained = gain(island);
    if (gained > 0.0) {
        set_aside(island);
        approach(island, 0.0, gained, 0.0);
    }
    return gained;
}

/* Returns true if the bouncy solution may give the bodies more energy than restitution returns. Of
 * several contacts some then add much of the energy that the others take: bodies that are wedged
 * between others would be thrown out. */
static bool is_suspect(const struct island *island, double gained)
{
    double taken = 0.0;
    if (island->count == 1)
        return gained > 0.0;
    for (uint32_t i = 0; i < island->count; i++)
        taken += maths_max(0.0, work(island, &island->contacts[i]));
    return gained > -LOST_LEAST * taken;
}

/* Restitution returns at most its square of the energy that the same impact takes without it. */
static void settle_all(struct island *island)
{
    double e = island->restitution;
    if (e == 0.0 || !settle(island, true)) {
        settle_softly(island);
        return;
    }
    renew(island);
    double gained = gain(island);
    if (!is_suspect(island, gained))
        return;
    set_aside(island);
    double soft = settle_softly(island);
    if (soft <= 0.0)
        approach(island, soft, gained, maths_max(soft, soft * (1.0 - e * e)));
}

/* Splits the island's loss of energy among the contacts, in proportion to the work of each; some
 * may have added energy. */
static void share_loss(const struct island *island)
{
    double taken = 0.0;
    for (uint32_t i = 0; i < island->count; i++)
        taken += maths_max(0.0, work(island, &island->contacts[i]));
    double lost = maths_max(0.0, -gain(island));
    for (uint32_t i = 0; i < island->count && lost > 0.0; i++) {
        struct solver_contact *c = &island->contacts[i];
        c->lost_j = lost * (maths_max(0.0, work(island, c)) / taken);
    }
}

/* Returns true if the bodies can only move horizontally and turn about the vertical, and the
 * normals are level. A third of the arithmetic then gives the same bits. */
static bool is_level(const struct island *island)
{
    for (uint32_t i = 0; i < island->body_count; i++) {
        const struct solver_body *body = &island->bodies[i];
        const double(*m)[3] = (const double(*)[3])body->inverse_inertia.m;
        if (body->inverse_mass.y != 0.0 || body->velocity.y != 0.0 || body->spin.x != 0.0 ||
            body->spin.z != 0.0 || m[0][0] != 0.0 || m[0][1] != 0.0 || m[0][2] != 0.0 ||
            m[1][2] != 0.0 || m[2][2] != 0.0)
            return false;
    }
    for (uint32_t i = 0; i < island->count; i++) {
        if (island->contacts[i].normal.y != 0.0)
            return false;
    }
    return true;
}

void contact_solver_island(struct solver_body *bodies, uint32_t body_count,
                           struct solver_contact *contacts, uint32_t contact_count)
{
    struct island island = {
        .bodies = bodies, .contacts = contacts, .body_count = body_count, .count = contact_count};
    double closing = 0.0, speed = 0.0;
    island.level = is_level(&island);
    for (uint32_t i = 0; i < body_count; i++) {
        speed = maths_max(speed, vec3_length(bodies[i].velocity));
        bodies[i].velocity_before = bodies[i].velocity;
        bodies[i].spin_before = bodies[i].spin;
    }
    for (uint32_t i = 0; i < contact_count; i++) {
        begin_contact(&island, &contacts[i]);
        island.rough |= contacts[i].friction > 0.0;
        if (contacts[i].closing_mps > 0.0)
            island.restitution = maths_max(island.restitution, contacts[i].restitution);
        closing = maths_max(closing, contacts[i].closing_mps);
        speed = maths_max(speed, vec3_length(contacts[i].state.before));
    }
    if (!(closing > 0.0))
        return;
    island.settled_mps = SETTLED * closing + SETTLED_ROUNDING * speed;
    island.runaway_mps = RUNAWAY * speed;
    settle_all(&island);
    share_loss(&island);
    for (uint32_t i = 0; i < contact_count; i++)
        contacts[i].impulse = to_world(&contacts[i], contacts[i].state.sum);
}
