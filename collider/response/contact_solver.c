/* Simultaneous impulses: contacts on axes of their own, sweeps, and the guard over energy. */
#include "collider/response/contact_solver.h"

#include "world/runtime/work_done.h"

#include <stdbool.h>

/* A sweep that changes no velocity by more than this share of the fastest closing speed is the
 * last. Greater: bodies go on nearing each other; smaller: rounding never lets it end. */
#define SETTLED 1e-12

/* The same against the greatest speed itself, for what closes slowly at high speed: some units in
 * the last place of a velocity. */
#define SETTLED_ROUNDING 1e-14

/* At most so many sweeps, and at most so many contacts solved in all, so that a great pile ends in
 * bounded time. Without friction the sweeps settle wherever there is an answer; most islands take
 * some ten, a hundred bodies of very different masses some two hundred, and what is all but jammed
 * may take thousands. */
#define SWEEPS_MAX  30000u
#define UPDATES_MAX 400000u

/* Sweeps of which the least change in so many is above this share of the least before have no
 * answer to settle at. */
#define STALL_SWEEPS 500u
#define STALL_SHARE  0.99

/* With friction few islands need more than a hundred; one that takes more than this either jams,
 * where sweeps go round in circles for ever, or is too great to be worth the time. */
#define FRICTION_SWEEPS_MAX  400u
#define FRICTION_UPDATES_MAX 20000u

/* So often an island is tried with friction, all of it and then half as much each time; then it is
 * left out. */
#define SLACKENINGS 3

/* Sweeps that change a velocity by this many times the greatest run away for ever; no blow makes
 * bodies so much faster. */
#define RUNAWAY 1e3

/* A contact that moves along its normal less than this share of what it moves in all is held there:
 * no impulse along the normal can part the bodies, it would only throw them aside. */
#define MOBILITY_LEAST 1e-6

/* A tangential direction that moves less than this share of the other is held. */
#define SLIP_LEAST 1e-12

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
    return (struct vec3){vec3_dot(v, c->normal), vec3_dot(v, c->notes.tangent[0]),
                         vec3_dot(v, c->notes.tangent[1])};
}

static struct vec3 to_world(const struct solver_contact *c, struct vec3 v)
{
    return vec3_add(vec3_scale(c->normal, v.x), vec3_add(vec3_scale(c->notes.tangent[0], v.y),
                                                         vec3_scale(c->notes.tangent[1], v.z)));
}

/* Perpendicular to the normal. With the normal's sign the first turns round and the second does
 * not, so that swapping the bodies changes nothing but signs, to the bit. */
static void set_tangents(struct solver_contact *c)
{
    struct vec3 n = c->normal;
    struct vec3 first =
        fabs(n.y) < 0.7 ? (struct vec3){-n.z, 0.0, n.x} : (struct vec3){0.0, n.z, -n.y};
    c->notes.tangent[0] = vec3_scale(first, 1.0 / vec3_length(first));
    c->notes.tangent[1] = vec3_cross(n, c->notes.tangent[0]);
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Velocity of b off a at the point, on the contact's axes. */
static struct vec3 slip(const struct solver_body *bodies, const struct solver_contact *c)
{
    const struct solver_body *a = &bodies[c->a], *b = &bodies[c->b];
    struct vec3 va = vec3_add(a->velocity, vec3_cross(a->spin, c->notes.arm_a));
    struct vec3 vb = vec3_add(b->velocity, vec3_cross(b->spin, c->notes.arm_b));
    return to_axes(c, vec3_sub(vb, va));
}

static void push(struct solver_body *bodies, const struct solver_contact *c, struct vec3 impulse)
{
    struct solver_body *a = &bodies[c->a], *b = &bodies[c->b];
    struct vec3 p = to_world(c, impulse);
    a->velocity = vec3_sub(a->velocity, times(a->inverse_mass, p));
    b->velocity = vec3_add(b->velocity, times(b->inverse_mass, p));
    a->spin = vec3_sub(a->spin, turned(&a->inverse_inertia, vec3_cross(c->notes.arm_a, p)));
    b->spin = vec3_add(b->spin, turned(&b->inverse_inertia, vec3_cross(c->notes.arm_b, p)));
}

/* What a unit impulse along a world direction changes of the velocity at the point. */
static struct vec3 yielding(const struct solver_body *body, struct vec3 arm, struct vec3 along)
{
    struct vec3 spin = turned(&body->inverse_inertia, vec3_cross(arm, along));
    return vec3_add(times(body->inverse_mass, along), vec3_cross(spin, arm));
}

/* On the contact's axes. */
static struct vec3 yielding_both(const struct solver_body *bodies, const struct solver_contact *c,
                                 struct vec3 along)
{
    return to_axes(c, vec3_add(yielding(&bodies[c->a], c->notes.arm_a, along),
                               yielding(&bodies[c->b], c->notes.arm_b, along)));
}

/* Inverse of the tangential mobility that is left when the normal speed is kept; along a direction
 * in which nothing moves it is zero. */
static void set_slip_mass(struct solver_state *notes)
{
    const double(*m)[3] = (const double(*)[3])notes->mobility.m;
    double s11 = m[1][1] - m[0][1] * m[0][1] / m[0][0];
    double s12 = m[1][2] - m[0][1] * m[0][2] / m[0][0];
    double s22 = m[2][2] - m[0][2] * m[0][2] / m[0][0];
    double trace = s11 + s22, determinant = s11 * s22 - s12 * s12;
    if (!(trace > SLIP_LEAST * (m[1][1] + m[2][2])))
        return;
    bool one_way = determinant <= SLIP_LEAST * trace * trace;
    double k = one_way ? 1.0 / (trace * trace) : 1.0 / determinant;
    notes->slip_mass[0][0] = k * (one_way ? s11 : s22);
    notes->slip_mass[1][1] = k * (one_way ? s22 : s11);
    notes->slip_mass[0][1] = notes->slip_mass[1][0] = k * (one_way ? s12 : -s12);
}

static void begin_contact(const struct solver_body *bodies, struct solver_contact *c)
{
    struct solver_state *notes = &c->notes;
    *notes = (struct solver_state){.arm_a = vec3_sub(c->point, bodies[c->a].centre),
                                   .arm_b = vec3_sub(c->point, bodies[c->b].centre)};
    set_tangents(c);
    struct vec3 n = yielding_both(bodies, c, c->normal);
    struct vec3 first = yielding_both(bodies, c, notes->tangent[0]);
    struct vec3 second = yielding_both(bodies, c, notes->tangent[1]);
    if (n.x > MOBILITY_LEAST * (n.x + first.y + second.z)) {
        notes->mobility =
            (struct mat3){{{n.x, n.y, n.z}, {n.y, first.y, first.z}, {n.z, first.z, second.z}}};
        set_slip_mass(notes);
    }
    notes->before = slip(bodies, c);
    c->closing_mps = -notes->before.x;
    c->impulse = (struct vec3){0.0, 0.0, 0.0};
    c->lost_j = 0.0;
}

struct island {
    struct solver_body *bodies;
    struct solver_contact *contacts;
    uint32_t body_count, count; /* of contacts */
    double settled_mps;         /* a change of velocity below this is none */
    double runaway_mps;         /* one above this leads nowhere */
    bool rough;                 /* there is friction */
    bool bouncy;                /* something comes back */
    double friction;            /* 0..1 of each contact's own */
};

/* --- one contact -------------------------------------------------------------------------------*/

/* The contact's impulse when without it the bodies would move like this: at least the target speed
 * along the normal, within the friction cone. */
static struct vec3 alone(const struct solver_contact *c, double friction, struct vec3 without)
{
    const struct solver_state *notes = &c->notes;
    const double *n = notes->mobility.m[0];
    double normal = (notes->target_mps - without.x) / n[0];
    if (!(normal > 0.0))
        return (struct vec3){0.0, 0.0, 0.0};
    /* The slip at the moment in which they stop closing, if there were no friction. */
    double plastic = normal * notes->plastic_share;
    double slip1 = without.y + n[1] * plastic, slip2 = without.z + n[2] * plastic;
    /* What ends it, and the normal part that keeps the normal speed as it is. */
    double t1 = -(notes->slip_mass[0][0] * slip1 + notes->slip_mass[0][1] * slip2);
    double t2 = -(notes->slip_mass[1][0] * slip1 + notes->slip_mass[1][1] * slip2);
    double beside = -(n[1] * t1 + n[2] * t2) / n[0];
    double length = sqrt(t1 * t1 + t2 * t2);
    double share = 1.0;
    if (length > friction * (normal + beside))
        share = friction * normal / (length - friction * beside);
    return (struct vec3){normal + share * beside, share * t1, share * t2};
}

/* Solves a contact against what the others do now; returns the speed that it changed. */
static double update(const struct island *island, struct solver_contact *c)
{
    struct solver_state *notes = &c->notes;
    if (notes->mobility.m[0][0] == 0.0)
        return 0.0;
    struct vec3 own = turned(&notes->mobility, notes->sum);
    struct vec3 without = vec3_sub(slip(island->bodies, c), own);
    struct vec3 sum = alone(c, c->friction * island->friction, without);
    notes->step = vec3_sub(sum, notes->sum);
    notes->sum = sum;
    push(island->bodies, c, notes->step);
    return notes->mobility.m[0][0] * vec3_length(notes->step);
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
        const struct solver_state *notes = &island->contacts[i].notes;
        sum += notes->mobility.m[0][0] * vec3_dot(notes->step, notes->step);
    }
    return sum;
}

/* Goes on along the directions of the sweeps so far. The next sweep brings every contact back into
 * its friction cone. */
static void search(const struct island *island, double keep)
{
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_contact *c = &island->contacts[i];
        struct solver_state *notes = &c->notes;
        struct vec3 further = vec3_scale(notes->search, keep);
        if (keep > 0.0) {
            notes->sum = vec3_add(notes->sum, further);
            push(island->bodies, c, further);
        }
        notes->search = vec3_add(further, notes->step);
    }
}

/* The velocities that the impulses of now make of the first ones: what the sweeps left of rounding
 * goes. */
static void renew(const struct island *island)
{
    for (uint32_t i = 0; i < island->body_count; i++) {
        struct solver_body *body = &island->bodies[i];
        body->velocity = body->velocity_before;
        body->spin = body->spin_before;
    }
    for (uint32_t i = 0; i < island->count; i++)
        push(island->bodies, &island->contacts[i], island->contacts[i].notes.sum);
}

static void take_out(const struct island *island)
{
    for (uint32_t i = 0; i < island->count; i++)
        island->contacts[i].notes.sum = island->contacts[i].notes.search =
            (struct vec3){0.0, 0.0, 0.0};
    renew(island);
}

/* Whether the sweeps settled within so many, of so many contacts in all. */
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

/* Solves all contacts from no impulses at all, with as much friction as they settle with; whether
 * they did. */
static bool settle(struct island *island, bool bouncing)
{
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_contact *c = &island->contacts[i];
        bool bounces = bouncing && c->closing_mps > 0.0;
        c->notes.target_mps = bounces ? c->restitution * c->closing_mps : 0.0;
        c->notes.plastic_share = bounces ? 1.0 / (1.0 + c->restitution) : 1.0;
    }
    island->friction = 1.0;
    for (int n = 0; n < SLACKENINGS && island->rough; n++) {
        take_out(island);
        if (sweep_all(island, FRICTION_SWEEPS_MAX, FRICTION_UPDATES_MAX))
            return true;
        island->friction *= 0.5;
    }
    island->friction = 0.0;
    take_out(island);
    return sweep_all(island, SWEEPS_MAX, UPDATES_MAX);
}

/* --- energy ------------------------------------------------------------------------------------*/

/* What the contact took out of the bodies [J]: force times way, the impulse being spread evenly. */
static double work(const struct island *island, const struct solver_contact *c)
{
    struct vec3 twice = vec3_add(c->notes.before, slip(island->bodies, c));
    return -0.5 * vec3_dot(c->notes.sum, twice);
}

/* Kinetic energy that the impulses added [J]; below what rounding makes of the work done, 0. */
static double gain(const struct island *island)
{
    double sum = 0.0, whole = 0.0;
    for (uint32_t i = 0; i < island->count; i++) {
        sum -= work(island, &island->contacts[i]);
        whole += fabs(vec3_dot(island->contacts[i].notes.sum, island->contacts[i].notes.before));
    }
    return sum > ENERGY_SLACK * whole ? sum : maths_min(sum, 0.0);
}

/* The greatest share 0..1 of a way along which energy starts at gain0 <= 0 with this slope and ends
 * at gain1 > 0 that does not go above 0: energy is a quadratic along it. */
static double share_of_way(double gain0, double slope, double gain1)
{
    double bend = gain1 - gain0 - slope;
    double root = sqrt(maths_max(0.0, slope * slope - 4.0 * bend * gain0));
    if (slope > 0.0)
        return maths_clamp(-2.0 * gain0 / (slope + root), 0.0, 1.0);
    return bend > 0.0 ? maths_clamp((root - slope) / (2.0 * bend), 0.0, 1.0) : 0.0;
}

/* Takes the impulses out of the bodies again and keeps them. */
static void set_aside(const struct island *island)
{
    for (uint32_t i = 0; i < island->count; i++)
        island->contacts[i].notes.bouncy = island->contacts[i].notes.sum;
    take_out(island);
}

/* Goes from the impulses of now towards those set aside as far as energy does not grow. */
static void approach(const struct island *island, double gain0, double gain1)
{
    double slope = 0.0;
    for (uint32_t i = 0; i < island->count; i++) {
        const struct solver_contact *c = &island->contacts[i];
        slope += vec3_dot(vec3_sub(c->notes.bouncy, c->notes.sum), slip(island->bodies, c));
    }
    double share = share_of_way(gain0, slope, gain1);
    for (uint32_t i = 0; i < island->count; i++) {
        struct solver_state *notes = &island->contacts[i].notes;
        notes->sum = vec3_lerp(notes->sum, notes->bouncy, share);
    }
    renew(island);
}

/* Without restitution: energy does not grow where the sweeps settle, and elsewhere impulses are
 * scaled down. Returns what was gained before that. */
static double settle_softly(struct island *island)
{
    settle(island, false);
    renew(island);
    double gained = gain(island);
    if (gained > 0.0) {
        set_aside(island);
        approach(island, 0.0, gained);
    }
    return gained;
}

static void settle_all(struct island *island)
{
    if (!island->bouncy || !settle(island, true)) {
        settle_softly(island);
        return;
    }
    renew(island);
    double gained = gain(island);
    if (!(gained > 0.0))
        return;
    set_aside(island);
    double soft = settle_softly(island);
    if (soft <= 0.0)
        approach(island, soft, gained);
}

/* Each contact bears of what the island lost as it took out; some may have put in. */
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

void contact_solver_island(struct solver_body *bodies, uint32_t body_count,
                           struct solver_contact *contacts, uint32_t contact_count)
{
    struct island island = {
        .bodies = bodies, .contacts = contacts, .body_count = body_count, .count = contact_count};
    double closing = 0.0, speed = 0.0;
    for (uint32_t i = 0; i < body_count; i++) {
        speed = maths_max(speed, vec3_length(bodies[i].velocity));
        bodies[i].velocity_before = bodies[i].velocity;
        bodies[i].spin_before = bodies[i].spin;
    }
    for (uint32_t i = 0; i < contact_count; i++) {
        begin_contact(bodies, &contacts[i]);
        island.rough |= contacts[i].friction > 0.0;
        island.bouncy |= contacts[i].restitution > 0.0 && contacts[i].closing_mps > 0.0;
        closing = maths_max(closing, contacts[i].closing_mps);
        speed = maths_max(speed, vec3_length(contacts[i].notes.before));
    }
    if (!(closing > 0.0))
        return;
    island.settled_mps = SETTLED * closing + SETTLED_ROUNDING * speed;
    island.runaway_mps = RUNAWAY * speed;
    settle_all(&island);
    share_loss(&island);
    for (uint32_t i = 0; i < contact_count; i++)
        contacts[i].impulse = to_world(&contacts[i], contacts[i].notes.sum);
}
