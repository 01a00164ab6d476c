/* Sequential impulses between a rigid body and the ground (Catto, "Iterative Dynamics with Temporal
 * Coherence", GDC 2005), started cold in each sub-step. */
#include "mover/motion/ground_contacts.h"

#include "mover/query/ground_marks.h"
#include "world/terrain/square_bounds.h"
#include "world/world.h"

#define GROUND_FRICTION    0.7 /* of soil; a contact has the geometric mean of kind and soil */
#define GROUND_RESTITUTION 0.2 /* of soil; a contact has the lower value of kind and soil */

/* Restitution falls from its value at SLOW_MPS to nothing at FAST_MPS: soil yields under a hard
 * impact. A slower point does not bounce. */
#define SLOW_MPS 0.5
#define FAST_MPS 10.0

/* Ploughing adds this times the square of the speed to the coefficient of friction [s2/m2]
 * (docs/decisions/031-wrecks-on-the-ground.md). */
#define PLOUGH_S2PM2 2.5e-4

/* The same of pieces: half of the area that bears them digs a furrow, not a tenth. */
#define PLOUGH_PIECES_S2PM2 1.25e-3

#define SOLVED_AGAIN 0.9 /* ploughing that keeps less than this of the speed is solved again */

/* Resistance against rolling: a lever for the normal impulse, as a share of the distance between
 * the point and the centre of mass. Without it a round hull would roll down every slope. */
#define ROLLING 0.1

#define SWEEPS        10   /* of the contacts, forwards and backwards in turn */
#define BOUNCE_SWEEPS 4    /* more, if a point bounces */
#define PUSH_SWEEPS   6    /* of the pseudo-velocity */
#define SETTLED_MPS   1e-9 /* sweeps that change no point's speed by more are the last */

#define PUSH_SHARE   0.3 /* of the depth that a sub-step takes away */
#define PUSH_MAX_MPS 3.0
#define MARGIN_M     0.02 /* points this near to the ground are contacts at any speed */
#define NORMAL_M     1.0  /* terrain_normal() looks no farther than this about a point */
#define STEEPEST     2.0  /* vertical over perpendicular distance to the ground, at most */

void ground_contacts_begin(struct ground_contacts *contacts, const struct kind *kind)
{
    contacts->count = 0;
    contacts->friction = sqrt(kind->friction * GROUND_FRICTION);
    contacts->restitution = maths_min(kind->restitution, GROUND_RESTITUTION);
    contacts->plough_s2pm2 = PLOUGH_S2PM2;
}

void ground_contacts_break(struct ground_contacts *contacts)
{
    contacts->restitution = 0.0;
    contacts->plough_s2pm2 = PLOUGH_PIECES_S2PM2;
}

/* --- the points near the ground ----------------------------------------------------------------*/

static void set_axis(struct ground_contact *contact, int k, struct vec3 axis,
                     const struct rigid_body *body, const struct mat3 *inverse)
{
    contact->axis[k] = axis;
    contact->lever[k] = vec3_cross(contact->arm, axis);
    contact->twist[k] = rotation_apply(inverse, contact->lever[k]);
    contact->mass_kg[k] =
        1.0 / (1.0 / body->inertia.mass_kg + vec3_dot(contact->lever[k], contact->twist[k]));
}

/* Returns the place of a new contact, or of the one with the greatest gap if that is greater than
 * this one; NULL: there is none. */
static struct ground_contact *place_for(struct ground_contacts *contacts, double gap)
{
    struct ground_contact *widest = &contacts->contact[0];
    if (contacts->count < GROUND_CONTACTS_MAX)
        return &contacts->contact[contacts->count++];
    for (uint32_t i = 1; i < contacts->count; i++) {
        if (contacts->contact[i].gap_m > widest->gap_m)
            widest = &contacts->contact[i];
    }
    return widest->gap_m > gap ? widest : NULL;
}

/* Returns the craters if some may be under the body, or NULL. */
static const struct crater_index *craters_under(const struct step_context *context,
                                                const struct body_points *points,
                                                const struct rigid_body *body)
{
    double reach = points->reach_m + body->inertia.centre_m;
    bool marked = ground_marks_at(context->ground_marks, body->centre.x, body->centre.z) &
                  GROUND_MARKS_CRATER;
    return marked || reach + NORMAL_M > GROUND_MARKS_NEAR_M ? context->craters : NULL;
}

/* Returns the steepest slope of the ground under the body, as a tangent, or more. */
static double steepest_under(const struct step_context *context, const struct rigid_body *body,
                             double reach_m, bool cratered)
{
    struct vec3 at = body->centre;
    const struct gridsquares *squares = &context->world->terrain.squares;
    struct gridsquare_box box =
        gridsquare_box_of(squares, at.x - reach_m, at.z - reach_m, at.x + reach_m, at.z + reach_m);
    if (cratered || box.x0 != box.x1 || box.z0 != box.z1)
        return STEEPEST;
    uint16_t bound = square_bounds_of(context->slopes, gridsquare_index(squares, box.x0, box.z0));
    return bound == SQUARE_BOUNDS_NONE ? STEEPEST : bound * SQUARE_BOUNDS_SLOPE_STEP;
}

void ground_contacts_add(struct ground_contacts *contacts, const struct rigid_body *body,
                         const struct mat3 *inverse, struct vec3 arm, struct vec3 normal,
                         double gap_m)
{
    struct ground_contact *contact = place_for(contacts, gap_m);
    struct vec3 n = normal, along = {n.y, -n.x, 0.0};
    if (contact == NULL)
        return;
    *contact = (struct ground_contact){.gap_m = gap_m, .friction = contacts->friction, .arm = arm};
    along = vec3_scale(along, 1.0 / vec3_length(along)); /* the ground is never vertical */
    set_axis(contact, CONTACT_NORMAL, n, body, inverse);
    set_axis(contact, CONTACT_ALONG, along, body, inverse);
    set_axis(contact, CONTACT_ACROSS, vec3_cross(n, along), body, inverse);
}

void ground_contacts_find(struct ground_contacts *contacts, const struct step_context *context,
                          const struct body_points *points, const struct rigid_body *body,
                          double dt_s)
{
    struct mat3 turn = rotation_matrix(body->turn);
    struct mat3 inverse = mass_properties_inverse_world(&body->inertia, &turn);
    double speed = vec3_length(body->velocity) + vec3_length(body->spin) * points->reach_m;
    double margin = MARGIN_M + speed * dt_s;
    const struct terrain *terrain = &context->world->terrain;
    const struct crater_index *craters = craters_under(context, points, body);
    double reach = points->reach_m + body->inertia.centre_m;
    double ground = terrain_height(terrain, craters, body->centre.x, body->centre.z);
    /* No point higher than this can be near the ground. */
    double high = ground + reach * steepest_under(context, body, reach, craters != NULL) +
                  STEEPEST * margin - body->centre.y;
    contacts->count = 0;
    if (high < -reach)
        return;
    for (uint32_t i = 0; i < points->count; i++) {
        struct vec3 point = points->point[i];
        point.y -= body->inertia.centre_m;
        if (turn.m[1][0] * point.x + turn.m[1][1] * point.y + turn.m[1][2] * point.z > high)
            continue;
        struct vec3 arm = rotation_apply(&turn, point), at = vec3_add(body->centre, arm);
        double above = at.y - terrain_height(terrain, craters, at.x, at.z);
        if (above > STEEPEST * margin)
            continue;
        struct vec3 normal = terrain_normal(terrain, craters, at.x, at.z);
        if (above * normal.y <= margin)
            ground_contacts_add(contacts, body, &inverse, arm, normal, above * normal.y);
    }
}

/* --- impulses ----------------------------------------------------------------------------------*/

static inline double speed_along(const struct ground_contact *contact, int k, struct vec3 velocity,
                                 struct vec3 spin)
{
    return vec3_dot(velocity, contact->axis[k]) + vec3_dot(spin, contact->lever[k]);
}

static inline void apply(const struct ground_contact *contact, int k, double impulse,
                         double inverse_mass, struct vec3 *velocity, struct vec3 *spin)
{
    *velocity = vec3_add(*velocity, vec3_scale(contact->axis[k], impulse * inverse_mass));
    *spin = vec3_add(*spin, vec3_scale(contact->twist[k], impulse));
}

/* Gives the point its least speed along the normal, as far as a push can. Returns the change of its
 * speed. */
static inline double solve_normal(struct ground_contact *contact, double inverse_mass,
                                  struct rigid_body *body)
{
    double off =
        contact->least_mps - speed_along(contact, CONTACT_NORMAL, body->velocity, body->spin);
    double before = contact->impulse_ns[CONTACT_NORMAL];
    double after = maths_max(0.0, before + off * contact->mass_kg[CONTACT_NORMAL]);
    contact->impulse_ns[CONTACT_NORMAL] = after;
    if (after == before)
        return 0.0;
    apply(contact, CONTACT_NORMAL, after - before, inverse_mass, &body->velocity, &body->spin);
    return fabs(after - before) / contact->mass_kg[CONTACT_NORMAL];
}

/* Ends the slip of the point, as far as the friction cone allows. */
static inline void solve_friction(struct ground_contact *contact, double friction,
                                  double inverse_mass, struct rigid_body *body)
{
    double most = friction * contact->impulse_ns[CONTACT_NORMAL], after[CONTACT_AXES];
    if (most == 0.0 && contact->impulse_ns[CONTACT_ALONG] == 0.0 &&
        contact->impulse_ns[CONTACT_ACROSS] == 0.0)
        return;
    for (int k = CONTACT_ALONG; k < CONTACT_AXES; k++)
        after[k] = contact->impulse_ns[k] -
                   contact->mass_kg[k] * speed_along(contact, k, body->velocity, body->spin);
    double whole = sqrt(after[CONTACT_ALONG] * after[CONTACT_ALONG] +
                        after[CONTACT_ACROSS] * after[CONTACT_ACROSS]);
    double share = whole > most ? most / whole : 1.0;
    for (int k = CONTACT_ALONG; k < CONTACT_AXES; k++) {
        double change = share * after[k] - contact->impulse_ns[k];
        contact->impulse_ns[k] += change;
        apply(contact, k, change, inverse_mass, &body->velocity, &body->spin);
    }
}

static void sweep(struct ground_contacts *contacts, struct rigid_body *body, int sweeps)
{
    double inverse_mass = 1.0 / body->inertia.mass_kg;
    for (int s = 0; s < sweeps; s++) {
        double most = 0.0;
        for (uint32_t n = 0; n < contacts->count; n++) {
            uint32_t i = s & 1 ? contacts->count - 1 - n : n;
            struct ground_contact *contact = &contacts->contact[i];
            most = maths_max(most, solve_normal(contact, inverse_mass, body));
            solve_friction(contact, contact->friction, inverse_mass, body);
        }
        if (most < SETTLED_MPS)
            return;
    }
}

/* Sets the speeds with which points bounce. Returns true if one does. */
static bool set_bounces(struct ground_contacts *contacts)
{
    bool any = false;
    for (uint32_t i = 0; i < contacts->count; i++) {
        struct ground_contact *contact = &contacts->contact[i];
        double closing = contact->closing_mps;
        if (contact->impulse_ns[CONTACT_NORMAL] <= 0.0 || closing < SLOW_MPS || closing > FAST_MPS)
            continue;
        double softer = (FAST_MPS - closing) / (FAST_MPS - SLOW_MPS);
        contact->least_mps =
            maths_max(contact->least_mps, contacts->restitution * softer * closing);
        any = true;
    }
    return any;
}

double ground_contacts_solve(struct ground_contacts *contacts, struct rigid_body *body, double dt_s)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        struct ground_contact *contact = &contacts->contact[i];
        for (int k = 0; k < CONTACT_AXES; k++)
            contact->impulse_ns[k] = 0.0;
        contact->closing_mps = -speed_along(contact, CONTACT_NORMAL, body->velocity, body->spin);
        contact->least_mps = -maths_max(0.0, contact->gap_m) / dt_s;
    }
    sweep(contacts, body, SWEEPS);
    if (set_bounces(contacts))
        sweep(contacts, body, BOUNCE_SWEEPS);
    for (uint32_t i = 0; i < contacts->count; i++)
        sum += contacts->contact[i].impulse_ns[CONTACT_NORMAL];
    return sum;
}

double ground_contacts_taken(const struct ground_contacts *contacts, const struct rigid_body *body)
{
    double taken = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        const struct ground_contact *contact = &contacts->contact[i];
        double leaving = speed_along(contact, CONTACT_NORMAL, body->velocity, body->spin);
        taken += 0.5 * contact->impulse_ns[CONTACT_NORMAL] * (contact->closing_mps - leaving);
    }
    return taken;
}

/* Returns the sum of the impulses along the normals [N s]. */
static struct vec3 bearing_of(const struct ground_contacts *contacts)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < contacts->count; i++)
        sum = vec3_add(sum, vec3_scale(contacts->contact[i].axis[CONTACT_NORMAL],
                                       contacts->contact[i].impulse_ns[CONTACT_NORMAL]));
    return sum;
}

bool ground_contacts_too_steep(const struct ground_contacts *contacts)
{
    struct vec3 bearing = bearing_of(contacts);
    return sqrt(bearing.x * bearing.x + bearing.z * bearing.z) > contacts->friction * bearing.y;
}

/* --- ploughing ---------------------------------------------------------------------------------*/

void ground_contacts_plough(struct ground_contacts *contacts, struct rigid_body *body,
                            double impulse_ns)
{
    struct vec3 normal = bearing_of(contacts);
    normal = vec3_scale(normal, 1.0 / vec3_length(normal));
    struct vec3 off = vec3_scale(normal, vec3_dot(body->velocity, normal));
    struct vec3 along = vec3_sub(body->velocity, off);
    double speed = vec3_length(along);
    /* The solution of dv/dt = -PLOUGH v2 N/m over the sub-step. */
    double keeps =
        1.0 / (1.0 + contacts->plough_s2pm2 * speed * impulse_ns / body->inertia.mass_kg);
    body->velocity = vec3_add(off, vec3_scale(along, keeps));
    body->spin = vec3_scale(body->spin, keeps);
    if (keeps < SOLVED_AGAIN) /* points would go into the ground without the spin that it had */
        sweep(contacts, body, SWEEPS);
}

void ground_contacts_roll(const struct ground_contacts *contacts, struct rigid_body *body)
{
    double moment = 0.0, rate = vec3_length(body->spin);
    for (uint32_t i = 0; i < contacts->count; i++) {
        const struct ground_contact *contact = &contacts->contact[i];
        moment += ROLLING * vec3_length(contact->arm) * contact->impulse_ns[CONTACT_NORMAL];
    }
    if (rate == 0.0)
        return;
    struct mat3 turn = rotation_matrix(body->turn);
    struct mat3 inverse = mass_properties_inverse_world(&body->inertia, &turn);
    struct vec3 axis = vec3_scale(body->spin, 1.0 / rate);
    double slower = moment * vec3_dot(axis, rotation_apply(&inverse, axis));
    body->spin = vec3_scale(axis, maths_max(0.0, rate - slower));
}

/* --- out of the ground -------------------------------------------------------------------------*/

/* Returns the pseudo-speed that the point needs along its normal [m/s]; negative: what it can give
 * up. */
static double wanted_push(const struct ground_contact *contact, const struct rigid_body *body,
                          double dt_s)
{
    double leaving = speed_along(contact, CONTACT_NORMAL, body->velocity, body->spin);
    double deep = -contact->gap_m - GROUND_CONTACTS_SLOP_M - leaving * dt_s;
    return deep > 0.0 ? maths_min(PUSH_SHARE * deep / dt_s, PUSH_MAX_MPS) : deep / dt_s;
}

void ground_contacts_push(struct ground_contacts *contacts, const struct rigid_body *body,
                          double dt_s, struct vec3 *velocity_mps, struct vec3 *spin_rps)
{
    struct vec3 velocity = {0.0, 0.0, 0.0}, spin = {0.0, 0.0, 0.0};
    double inverse_mass = 1.0 / body->inertia.mass_kg;
    for (uint32_t n = 0; n < contacts->count; n++)
        contacts->contact[n].push_kgmps = 0.0;
    for (uint32_t n = 0; n < PUSH_SWEEPS * contacts->count; n++) {
        struct ground_contact *contact = &contacts->contact[n % contacts->count];
        double off =
            wanted_push(contact, body, dt_s) - speed_along(contact, CONTACT_NORMAL, velocity, spin);
        double before = contact->push_kgmps;
        contact->push_kgmps = maths_max(0.0, before + off * contact->mass_kg[CONTACT_NORMAL]);
        apply(contact, CONTACT_NORMAL, contact->push_kgmps - before, inverse_mass, &velocity,
              &spin);
    }
    *velocity_mps = velocity;
    *spin_rps = spin;
}

double ground_contacts_twist_share(const struct ground_contacts *contacts, struct vec3 velocity_mps,
                                   struct vec3 spin_rps)
{
    double share = 1.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        const struct ground_contact *contact = &contacts->contact[i];
        double rises = vec3_dot(velocity_mps, contact->axis[CONTACT_NORMAL]);
        double turns = vec3_dot(spin_rps, contact->lever[CONTACT_NORMAL]);
        if (contact->gap_m < -GROUND_CONTACTS_SLOP_M && turns < 0.0)
            share = maths_min(share, maths_max(rises, 0.0) / -turns);
    }
    return share;
}

double ground_contacts_depth(const struct ground_contacts *contacts)
{
    double deepest = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++)
        deepest = maths_max(deepest, -contacts->contact[i].gap_m);
    return deepest;
}
