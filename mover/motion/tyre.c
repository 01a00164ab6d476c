/* A brush tyre at each wheel, as sequential impulses: the brush's force is the most that the
 * wheel's impulse may be, and the impulse that ends the slip is the other bound. So the forces do
 * not chatter at low speed, and hold a vehicle that stands. */
#include "mover/motion/tyre.h"

#define STIFFNESS 10.0 /* of a brush: force over load and slip [1/rad] */
#define REAR_STIFFNESS                                                                             \
    1.2                 /* times it: of wheels that do not steer, so that no vehicle oversteers */
#define FRONT_GRIP 0.9  /* share of the grip of wheels that steer: they slide first */
#define SLOW_MPS   0.25 /* a wheel that rolls more slowly slips as at this speed */
#define SWEEPS     3
#define SETTLED    1e-3 /* sweeps that change no impulse by this share of a grip are the last */
#define TRACK_SIDE 0.85 /* friction of tracks to the sides over that along them */
#define WIDE       10.0 /* radius of a turn over the track in which tracks hold least */
#define TRACK_PULL 0.95 /* share of the grip by which tracks turn the body */

/* Returns the direction in which the wheel rolls, on the ground. */
static struct vec3 rolling_axis(const struct wheel *wheel, const struct mat3 *turn, double steer)
{
    struct vec3 ahead = {turn->m[0][0], turn->m[1][0], turn->m[2][0]};
    const struct vec3 right = {turn->m[0][2], turn->m[1][2], turn->m[2][2]};
    if (wheel->steers)
        ahead = vec3_add(ahead, vec3_scale(right, steer));
    ahead = vec3_sub(ahead, vec3_scale(wheel->normal, vec3_dot(ahead, wheel->normal)));
    return vec3_scale(ahead, 1.0 / vec3_length(ahead));
}

/* How a body answers impulses. */
struct response {
    struct rigid_body *body;
    const struct mat3 *inverse; /* of the moments of inertia on world axes [1/(kg m2)] */
    double per_kg;              /* 1 over its mass */
};

static void set_axis(struct wheel *wheel, int k, struct vec3 axis, struct vec3 arm,
                     const struct response *response)
{
    wheel->axis[k] = axis;
    wheel->lever[k] = vec3_cross(arm, axis);
    wheel->twist[k] = rotation_apply(response->inverse, wheel->lever[k]);
    wheel->mass_kg[k] = 1.0 / (response->per_kg + vec3_dot(wheel->lever[k], wheel->twist[k]));
    wheel->impulse_ns[k] = 0.0;
}

static inline double speed_along(const struct wheel *wheel, int k, const struct rigid_body *body)
{
    return vec3_dot(body->velocity, wheel->axis[k]) + vec3_dot(body->spin, wheel->lever[k]);
}

static inline void apply(const struct wheel *wheel, int k, double impulse,
                         const struct response *response)
{
    struct rigid_body *body = response->body;
    body->velocity =
        vec3_add(body->velocity, vec3_scale(wheel->axis[k], impulse * response->per_kg));
    body->spin = vec3_add(body->spin, vec3_scale(wheel->twist[k], impulse));
}

/* Returns the share of the grip that a brush gives at this slip angle [rad]. */
static double brush(double slip, double stiffness, double friction)
{
    double s = maths_min(1.0, stiffness * slip / (3.0 * friction));
    double left = 1.0 - s;
    return 1.0 - left * left * left;
}

/* The side force of tracks falls in wide turns (Nikitin). Straight on they hold on a side slope. */
double tyre_side_share(const struct kind *kind, double forward_mps, double yaw_rps)
{
    if (!kind->tracked)
        return 1.0;
    double radius = fabs(forward_mps) / maths_max(fabs(yaw_rps), 1e-3) / kind->track_m;
    double wide = radius < WIDE ? radius : WIDE * WIDE / radius;
    return TRACK_SIDE / (0.925 + 0.15 * wide);
}

/* Returns the share of the grip that a wheel has to its side: that of the turn, and that of
 * standing tracks for tracks which slide aside as fast as they roll. */
static double side_share(const struct tyre_demand *demand, double slip)
{
    return maths_max(demand->side,
                     maths_min(slip, tyre_side_share(demand->drivetrain->kind, 0.0, 0.0)));
}

/* Lets the hand brake hold a wheel. A wheel that does not roll slides along its slip, so that it
 * hardly holds to the sides. slip: to the side over along. */
static void pull_hand_brake(struct wheel *wheel, double share, double slip)
{
    double aside = slip / sqrt(1.0 + slip * slip);
    wheel->most_ns[WHEEL_ALONG] =
        maths_min(wheel->grip_ns, wheel->most_ns[WHEEL_ALONG] + share * wheel->grip_ns);
    wheel->most_ns[WHEEL_ACROSS] *= maths_max(1.0 - share, aside);
    wheel->drive_ns *= 1.0 - share;
}

/* Sets the axes of a wheel that touches, and the most that its impulses can be. */
static void prepare(struct wheel *wheel, const struct response *response, const struct mat3 *turn,
                    const struct tyre_demand *demand, double steer)
{
    const struct rigid_body *body = response->body;
    const bool tracked = demand->drivetrain->kind->tracked;
    const struct vec3 right = {turn->m[0][2], turn->m[1][2], turn->m[2][2]};
    struct vec3 along = rolling_axis(wheel, turn, steer), arm = wheel->arm;
    /* The tracks' difference of speed is their own. */
    struct vec3 level = vec3_sub(arm, vec3_scale(right, vec3_dot(arm, right)));
    set_axis(wheel, WHEEL_ALONG, along, tracked ? level : arm, response);
    set_axis(wheel, WHEEL_ACROSS, vec3_cross(along, wheel->normal), arm, response);
    double rolls = fabs(speed_along(wheel, WHEEL_ALONG, body));
    double slip = fabs(speed_along(wheel, WHEEL_ACROSS, body)) / maths_max(rolls, SLOW_MPS);
    double share = wheel->friction * wheel->load_n / demand->grip_n;
    double stiffness = STIFFNESS * (wheel->steers || tracked ? 1.0 : REAR_STIFFNESS);
    double grip = wheel->friction * (wheel->steers && !tracked ? FRONT_GRIP : 1.0);
    wheel->grip_ns = grip * wheel->load_n * demand->dt_s;
    wheel->most_ns[WHEEL_ALONG] = demand->force.brake_n * share * demand->dt_s;
    wheel->most_ns[WHEEL_ACROSS] =
        side_share(demand, slip) * wheel->grip_ns * brush(slip, stiffness, wheel->friction);
    wheel->drive_ns =
        maths_clamp(demand->force.drive_n * share * demand->dt_s, -wheel->grip_ns, wheel->grip_ns);
    if (!wheel->steers && demand->drivetrain->hand_brake > 0.0)
        pull_hand_brake(wheel, demand->drivetrain->hand_brake, slip);
    apply(wheel, WHEEL_ALONG, wheel->drive_ns, response);
}

/* Returns the impulse of an axis that ends its slip, as far as its bound allows. */
static inline double end_slip(const struct wheel *wheel, int k, const struct rigid_body *body)
{
    if (wheel->most_ns[k] == 0.0)
        return 0.0; /* a wheel that rolls freely */
    return maths_clamp(wheel->impulse_ns[k] - wheel->mass_kg[k] * speed_along(wheel, k, body),
                       -wheel->most_ns[k], wheel->most_ns[k]);
}

/* Ends the slip of the wheel, as far as brakes, brush and grip allow. Returns true if its impulses
 * have changed by more than SETTLED. */
static bool solve_wheel(struct wheel *wheel, const struct response *response)
{
    double after[WHEEL_AXES];
    bool changed = false;
    for (int k = 0; k < WHEEL_AXES; k++)
        after[k] = end_slip(wheel, k, response->body);
    double along = after[WHEEL_ALONG] + wheel->drive_ns;
    double square = along * along + after[WHEEL_ACROSS] * after[WHEEL_ACROSS];
    if (square > wheel->grip_ns * wheel->grip_ns) {
        double share = wheel->grip_ns / sqrt(square);
        after[WHEEL_ALONG] = along * share - wheel->drive_ns;
        after[WHEEL_ACROSS] *= share;
    }
    for (int k = 0; k < WHEEL_AXES; k++) {
        double change = after[k] - wheel->impulse_ns[k];
        if (change == 0.0)
            continue;
        apply(wheel, k, change, response);
        wheel->impulse_ns[k] = after[k];
        changed |= fabs(change) > SETTLED * wheel->grip_ns;
    }
    return changed;
}

/* The tracks turn the body about its upward axis. */
struct skid {
    struct vec3 up, twist; /* twist: change of spin by a unit of angular impulse */
    double inertia_kgm2;   /* angular impulse for a unit change of the turn rate */
    double wanted_rps, most_nms, impulse_nms;
};

static struct skid skid_of(const struct mat3 *turn, const struct mat3 *inverse,
                           const struct tyre_demand *demand)
{
    const struct kind *kind = demand->drivetrain->kind;
    struct skid skid = {.up = {turn->m[0][1], turn->m[1][1], turn->m[2][1]},
                        .wanted_rps = -demand->drivetrain->yaw_rps};
    skid.twist = rotation_apply(inverse, skid.up);
    skid.inertia_kgm2 = 1.0 / vec3_dot(skid.up, skid.twist);
    double left = TRACK_PULL * demand->grip_n - fabs(demand->force.drive_n);
    skid.most_nms = maths_max(left, 0.0) * 0.5 * kind->track_m * demand->dt_s;
    return skid;
}

/* Returns true if the moment has changed by more than SETTLED. */
static bool solve_skid(struct skid *skid, struct rigid_body *body)
{
    double off = skid->wanted_rps - vec3_dot(body->spin, skid->up);
    double after =
        maths_clamp(skid->impulse_nms + off * skid->inertia_kgm2, -skid->most_nms, skid->most_nms);
    if (after == skid->impulse_nms)
        return false;
    double change = after - skid->impulse_nms;
    body->spin = vec3_add(body->spin, vec3_scale(skid->twist, change));
    skid->impulse_nms = after;
    return fabs(change) > SETTLED * skid->most_nms;
}

void tyre_solve(struct suspension *suspension, struct rigid_body *body, const struct mat3 *turn,
                const struct mat3 *inverse, const struct tyre_demand *demand)
{
    const struct kind *kind = demand->drivetrain->kind;
    const struct response response = {body, inverse, 1.0 / body->inertia.mass_kg};
    struct skid skid = skid_of(turn, inverse, demand);
    double curve = demand->drivetrain->curve, half = suspension->wheel[0].place.x;
    double base = suspension->wheelbase_m, rear = base - half; /* of the middle over the rear */
    /* The circle of the middle is wider than that of the rear axle. */
    double steer = base * curve / sqrt(maths_max(1.0 - curve * curve * rear * rear, 0.1));
    for (uint32_t i = 0; i < suspension->count; i++) {
        if (suspension->wheel[i].load_n > 0.0)
            prepare(&suspension->wheel[i], &response, turn, demand, steer);
    }
    bool changed = true;
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = false;
        for (uint32_t i = 0; i < suspension->count; i++) {
            if (suspension->wheel[i].load_n > 0.0)
                changed |= solve_wheel(&suspension->wheel[i], &response);
        }
        if (kind->tracked)
            changed |= solve_skid(&skid, body);
    }
}
