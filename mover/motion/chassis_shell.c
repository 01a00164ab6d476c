/* Points of the shell, their paths, and the impulses of the ground. */
#include "mover/motion/chassis_shell.h"

#include "world/terrain/terrain.h"
#include "world/world.h"

#define HARD_MPS 2.0 /* a shell that is hit more slowly takes no harm */

#define ROUNDS        3    /* of paths: impulses turn the points, and these meet other ground */
#define HALVINGS      7    /* of a path, to find where it meets the ground */
#define MARGIN_M      0.02 /* a point this near to the ground touches it at any speed */
#define ROUNDING_M    1e-6 /* by which rounding lets a point that rests sink */
#define NORMAL_M      0.02 /* the normal is that of the heights so far to each side */
#define STEEPEST      (EARTHWORK_STEEPEST + 1.0) /* tangent of any ground, at most */
#define DEEP_M        0.02                       /* deeper points have got new ground over them */
#define WHEEL_DEEP_M  0.006 /* wheels in the ground are pushed out as if they were no deeper */
#define MOST_DEEP_M   0.009 /* and other points: by 0.5 m/s */
#define PUSH_MOST_MPS 0.5   /* by which no point of the body is pushed out faster */
#define PUSHED_M      0.01  /* points this deep are pushed out though they bear nothing */
#define SAME_FACE     0.95  /* cosine between the normals of one face */

void chassis_shell_of(const struct kind *kind, const struct suspension *suspension,
                      struct chassis_shell *shell)
{
    const double front = maths_min(suspension->front_m, 0.5 * kind->length_m);
    const double wide = 0.5 * kind->track_m;
    shell->count = kind->tracked ? VEHICLE_SHELL_POINTS : CHASSIS_SHELL_POINTS;
    for (uint32_t n = 0; n < VEHICLE_SHELL_POINTS; n++)
        shell->point[n] = vehicle_shell_point(kind, n);
    for (uint32_t n = VEHICLE_SHELL_POINTS; n < shell->count; n++)
        shell->point[n] =
            (struct vec3){n & 1 ? front : -front, suspension->reach_m, n & 2 ? wide : -wide};
}

double chassis_shell_bend(const struct kind *kind)
{
    double least = INFINITY;
    for (uint32_t n = 0; n < VEHICLE_SHELL_SIDES; n += 4) {
        struct vec3 point = vehicle_shell_point(kind, n);
        double away = sqrt(point.x * point.x + point.z * point.z);
        least = maths_min(least, 2.0 * point.y / maths_max(away, 1e-9));
    }
    return least;
}

void chassis_shell_follow(struct chassis_shell *shell, const struct suspension *suspension)
{
    for (uint32_t n = VEHICLE_SHELL_POINTS; n < shell->count; n++) {
        uint32_t wheel = (n & 1 ? 0 : suspension->count - 2) + (n & 2 ? 1 : 0);
        double pressed = maths_min(suspension->wheel[wheel].squeeze_m, suspension->most_m);
        shell->point[n].y = suspension->reach_m + pressed - suspension->sag_m;
    }
}

/* The bit of a point's number that says on which side it is. */
enum { LEFT_FIRST = 0, RIGHT_FIRST = 2 };

static inline bool is_middle(uint32_t n)
{
    return n / 4 == VEHICLE_SHELL_MIDDLE / 4;
}

/* --- paths -------------------------------------------------------------------------------------*/

struct shell_ground {
    const struct terrain *terrain;
    const struct crater_index *craters;
};

static double above(const struct shell_ground *ground, struct vec3 at)
{
    return at.y - terrain_height(ground->terrain, ground->craters, at.x, at.z);
}

static struct vec3 normal_at(const struct shell_ground *ground, struct vec3 at)
{
    const struct terrain *terrain = ground->terrain;
    const struct crater_index *craters = ground->craters;
    double west = terrain_height(terrain, craters, at.x - NORMAL_M, at.z);
    double east = terrain_height(terrain, craters, at.x + NORMAL_M, at.z);
    double north = terrain_height(terrain, craters, at.x, at.z - NORMAL_M);
    double south = terrain_height(terrain, craters, at.x, at.z + NORMAL_M);
    struct vec3 normal = {west - east, 2.0 * NORMAL_M, north - south};
    return vec3_scale(normal, 1.0 / vec3_length(normal));
}

/* Returns the share of the path at which a point comes below a height over the ground. Its end is
 * below it and its start is not. */
static double meets(const struct shell_ground *ground, struct vec3 at, struct vec3 path,
                    double floor_m)
{
    double out = 0.0, in = 1.0;
    for (int n = 0; n < HALVINGS; n++) {
        double half = 0.5 * (out + in);
        if (above(ground, vec3_add(at, vec3_scale(path, half))) > floor_m)
            out = half;
        else
            in = half;
    }
    return in;
}

/* Adds a contact of a point unless it has one with the same face. Returns true if it was added. */
static bool add(struct ground_contacts *contacts, const struct rigid_body *body,
                const struct mat3 *inverse, struct vec3 arm, struct vec3 normal, double gap_m)
{
    for (uint32_t i = 0; i < contacts->count; i++) {
        const struct ground_contact *other = &contacts->contact[i];
        if (other->arm.x == arm.x && other->arm.y == arm.y && other->arm.z == arm.z &&
            vec3_dot(other->axis[CONTACT_NORMAL], normal) > SAME_FACE)
            return false;
    }
    ground_contacts_add(contacts, body, inverse, arm, normal, gap_m);
    return true;
}

/* Returns the way out of the ground for a point in it. Impacts leave none deeper than DEEP_M. Where
 * a crater has changed the ground around the body, its walls may wedge the body; then the way out
 * is more upwards than their normals. */
static struct vec3 way_out(struct vec3 normal, double high)
{
    struct vec3 out = {normal.x, normal.y + 1.0, normal.z};
    out = vec3_scale(out, 1.0 / vec3_length(out));
    return high * normal.y > -DEEP_M || vec3_dot(out, normal) > SAME_FACE ? normal : out;
}

/* Adds the contacts of a point within dt_s. Returns true if there is a new one. */
static bool sweep_point(struct ground_contacts *contacts, const struct shell_ground *ground,
                        const struct rigid_body *body, const struct mat3 *inverse, struct vec3 arm,
                        double dt_s)
{
    const struct vec3 at = vec3_add(body->centre, arm);
    const struct vec3 path =
        vec3_scale(vec3_add(body->velocity, vec3_cross(body->spin, arm)), dt_s);
    double high = above(ground, at), level = fabs(path.x) + fabs(path.z);
    bool added = false;
    if (high > STEEPEST * (level + MARGIN_M) + fabs(path.y))
        return false;
    struct vec3 normal = way_out(normal_at(ground, at), high);
    if (high * normal.y < MARGIN_M)
        added = add(contacts, body, inverse, arm, normal, high * normal.y);
    /* One that is in the ground gets no deeper. */
    double floor_m = maths_min(high, 0.0) - ROUNDING_M;
    if (above(ground, vec3_add(at, path)) > floor_m)
        return added;
    double share = meets(ground, at, path, floor_m);
    normal = normal_at(ground, vec3_add(at, vec3_scale(path, share)));
    double closing_m = -vec3_dot(path, normal);
    return closing_m > 0.0 ? add(contacts, body, inverse, arm, normal, share * closing_m) || added
                           : added;
}

/* Makes the contacts of a point those of a wheel: it rolls. Its spring moves it against the body.
 * So ground that it has come into stops it, and pushes the body out only slowly. */
static void let_roll(struct ground_contacts *contacts, struct vec3 arm)
{
    for (uint32_t c = 0; c < contacts->count; c++) {
        struct ground_contact *contact = &contacts->contact[c];
        if (contact->arm.x != arm.x || contact->arm.z != arm.z)
            continue;
        contact->friction = 0.0;
        contact->gap_m = maths_max(contact->gap_m, -WHEEL_DEEP_M);
    }
}

static bool sweep(struct ground_contacts *contacts, const struct chassis_shell *shell,
                  const struct shell_ground *ground, const struct rigid_body *body, uint32_t order,
                  double dt_s)
{
    const struct mat3 turn = rotation_matrix(body->turn);
    const struct mat3 inverse = mass_properties_inverse_world(&body->inertia, &turn);
    bool added = false;
    for (uint32_t n = 0; n < shell->count; n++) {
        const uint32_t k = is_middle(n) ? n : n ^ order;
        struct vec3 point = shell->point[k];
        point.y -= body->inertia.centre_m;
        const struct vec3 arm = rotation_apply(&turn, point);
        if (!sweep_point(contacts, ground, body, &inverse, arm, dt_s))
            continue;
        added = true;
        if (k >= VEHICLE_SHELL_POINTS)
            let_roll(contacts, arm);
    }
    return added;
}

/* --- impulses ----------------------------------------------------------------------------------*/

/* Returns the greatest speed at which a contact's point came down on the ground. */
static double fastest(const struct ground_contacts *contacts)
{
    double most = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        if (contacts->contact[i].impulse_ns[CONTACT_NORMAL] > 0.0)
            most = maths_max(most, contacts->contact[i].closing_mps);
    }
    return most;
}

/* Returns the share of the impulses that came from upright ground: a wall, a bank. */
static double upright_share(const struct ground_contacts *contacts)
{
    double all = 0.0, upright = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        double impulse = contacts->contact[i].impulse_ns[CONTACT_NORMAL];
        double rise = contacts->contact[i].axis[CONTACT_NORMAL].y;
        all += impulse;
        upright += impulse * maths_max(0.0, 1.0 - rise * rise);
    }
    return all > 0.0 ? upright / all : 0.0;
}

/* Lets the ground act on the shell, with the points in an order: LEFT_FIRST or RIGHT_FIRST. */
static struct chassis_shell_push press(const struct chassis_shell *shell,
                                       const struct shell_ground *ground, const struct kind *kind,
                                       struct rigid_body *body, uint32_t order, double dt_s)
{
    const struct rigid_body before = *body;
    struct chassis_shell_push push = {0};
    struct ground_contacts contacts;
    ground_contacts_begin(&contacts, kind);
    for (int n = 0; n < ROUNDS && sweep(&contacts, shell, ground, body, order, dt_s); n++) {
        body->velocity = before.velocity;
        body->spin = before.spin;
        push.impulse_ns = ground_contacts_solve(&contacts, body, dt_s);
    }
    push.acts = push.impulse_ns > 0.0 || ground_contacts_depth(&contacts) > PUSHED_M;
    if (!push.acts)
        return push;
    if (fastest(&contacts) > HARD_MPS)
        push.hard_j = maths_max(0.0, ground_contacts_taken(&contacts, body));
    push.strike_j = push.hard_j * upright_share(&contacts);
    for (uint32_t c = 0; c < contacts.count; c++)
        contacts.contact[c].gap_m = maths_max(contacts.contact[c].gap_m, -MOST_DEEP_M);
    ground_contacts_push(&contacts, body, dt_s, &push.velocity_mps, &push.spin_rps);
    double fast =
        vec3_length(push.velocity_mps) + vec3_length(push.spin_rps) * vehicle_shell_reach(kind);
    double share = maths_min(1.0, PUSH_MOST_MPS / maths_max(fast, 1e-9));
    push.velocity_mps = vec3_scale(push.velocity_mps, share);
    push.spin_rps = vec3_scale(push.spin_rps, share);
    return push;
}

static struct vec3 mean(struct vec3 a, struct vec3 b)
{
    return vec3_scale(vec3_add(a, b), 0.5);
}

/* Sequential impulses favour the points that come first. So the mean of two orders counts, which
 * mirror each other: what hits a wall squarely does not turn. */
struct chassis_shell_push chassis_shell_press(const struct chassis_shell *shell,
                                              const struct terrain *terrain,
                                              const struct crater_index *craters,
                                              const struct kind *kind, struct rigid_body *body,
                                              double dt_s)
{
    const struct shell_ground ground = {terrain, craters};
    struct rigid_body mirrored = *body;
    struct chassis_shell_push push = press(shell, &ground, kind, body, LEFT_FIRST, dt_s);
    if (!push.acts)
        return push;
    struct chassis_shell_push other = press(shell, &ground, kind, &mirrored, RIGHT_FIRST, dt_s);
    body->velocity = mean(body->velocity, mirrored.velocity);
    body->spin = mean(body->spin, mirrored.spin);
    return (struct chassis_shell_push){.velocity_mps = mean(push.velocity_mps, other.velocity_mps),
                                       .spin_rps = mean(push.spin_rps, other.spin_rps),
                                       .impulse_ns = 0.5 * (push.impulse_ns + other.impulse_ns),
                                       .acts = true,
                                       .hard_j = 0.5 * (push.hard_j + other.hard_j),
                                       .strike_j = 0.5 * (push.strike_j + other.strike_j)};
}
