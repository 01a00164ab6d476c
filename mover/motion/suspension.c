/* Places of wheels, and their loads by rays. */
#include "mover/motion/suspension.h"

#include "world/terrain/terrain.h"
#include "world/vehicle_shell.h"
#include "world/world.h"

#define DAMPING      0.35 /* share of the critical damping */
#define BUMP_STOP    10.0 /* stiffness of the bump stop over that of the spring */
#define BUMP_MOST_M  0.15 /* by which it is pressed at most; it gives nothing back */
#define ROLL_BAR     0.75 /* of an axle: stiffness against roll over that of a spring */
#define WHEELBASE    0.68 /* between the outer axles over the length */
#define TRACK_LENGTH 0.58 /* of a track on the ground over the length */
#define TANDEM_M     1.2  /* between the axles of a tandem, at most */
#define HARD_MPS     2.0  /* a bump stop that is hit more slowly takes no harm */
#define LEANS_MOST   0.3  /* cosine: a wheel whose ray is flatter to the ground bears nothing */
#define SLOPE_STEP_M 0.1  /* between the heights that give the slope of uneven ground */
#define WHEEL_RADIUS 0.2  /* of a wheel over the height of its vehicle */
#define STEEPEST     3.0  /* tangent: a wheel rolls onto an edge as onto a slope like that */
#define SAMPLES      9    /* points at which a wheel may touch uneven ground */
#define EVEN_AXLES   3u   /* by which a track stands on even ground */

/* Returns where the axle is over the distance between the outer axles: the middle of all axles is
 * the body's. Behind the front axle of a truck the others stand close together. */
static double axle_place(const struct kind *kind, uint32_t axle, double length_m)
{
    uint32_t last = kind->axles - 1;
    if (kind->tracked || kind->axles == 2)
        return length_m * (0.5 - (double)axle / last);
    double spread = maths_min(TANDEM_M, length_m / kind->axles) * (last - 1);
    double front = (length_m - 0.5 * spread) * last / kind->axles;
    double rear = -front / last;
    return axle == 0 ? front : rear + spread * (0.5 - (double)(axle - 1) / maths_max(last - 1, 1));
}

/* Returns how far the ends of a track's axles on even ground are from its middle: so that they have
 * the stiffness against pitch of all road wheels. length_m: between the outer road wheels. */
static double even_half(const struct kind *kind, double length_m)
{
    double squares = 0.0;
    for (uint32_t axle = 0; axle < kind->axles; axle++) {
        double x = axle_place(kind, axle, length_m);
        squares += x * x;
    }
    return sqrt(0.5 * squares * EVEN_AXLES / kind->axles);
}

/* Places the wheels. axles: their number, of which each bears alike. */
static void place_wheels(const struct kind *kind, struct suspension *suspension, uint32_t axles)
{
    const bool all = axles == kind->axles;
    const double length = suspension->ground_m;
    const double half = all ? 0.0 : even_half(kind, length);
    suspension->count = 2 * axles;
    for (uint32_t i = 0; i < suspension->count; i++) {
        struct wheel *wheel = &suspension->wheel[i];
        double x = all ? axle_place(kind, i / 2, length) : half * (1.0 - (double)(i / 2));
        wheel->side = i & 1 ? 1.0 : -1.0;
        wheel->steers = !kind->tracked && i < 2;
        wheel->bow = !kind->tracked ? 0.0 : i < 2 ? 1.0 : i + 2 >= suspension->count ? -1.0 : 0.0;
        wheel->place = (struct vec3){x, -suspension->sag_m, 0.5 * wheel->side * kind->track_m};
    }
}

void suspension_of(const struct kind *kind, bool uneven, struct suspension *suspension)
{
    const bool fewer = kind->tracked && !uneven && kind->axles > EVEN_AXLES;
    const uint32_t axles = fewer ? EVEN_AXLES : kind->axles;
    double rate = TWO_PI * kind->heave_hz, count = 2.0 * axles;
    double length = kind->length_m * (kind->tracked ? TRACK_LENGTH : WHEELBASE);
    suspension->sag_m = GRAVITY_MPS2 / (rate * rate);
    suspension->most_m = suspension->sag_m + kind->travel_m;
    suspension->spring_npm = kind->mass_kg * rate * rate / count;
    suspension->damper_nspm = 2.0 * DAMPING * kind->mass_kg * rate / count;
    suspension->ground_m = length;
    suspension->radius_m = WHEEL_RADIUS * kind->height_m;
    suspension->bow_m = kind->tracked ? VEHICLE_SHELL_BOW * kind->length_m : 0.0;
    suspension->reach_m = vehicle_shell_climbs(kind);
    place_wheels(kind, suspension, axles);
    double front = axle_place(kind, 0, length);
    suspension->wheelbase_m = front * kind->axles / (kind->axles - 1);
    suspension->front_m = front + (kind->tracked ? suspension->bow_m : suspension->radius_m);
}

/* --- the ground --------------------------------------------------------------------------------*/

/* Where a wheel touches. */
struct wheel_contact {
    double height_m; /* of the ground for the wheel */
    double ahead_m;  /* from the wheel along the body's heading */
    struct vec3 normal;
};

static struct vec3 normal_of(double east, double south)
{
    return vec3_scale((struct vec3){-east, 1.0, -south},
                      1.0 / sqrt(1.0 + east * east + south * south));
}

static double height_at(const struct step_context *context, double x, double z)
{
    return terrain_height(&context->world->terrain, context->craters, x, z);
}

/* Returns the height of the rim of a wheel, or of the end of a track, over its lowest point.
 * *slope: its tangent there. ahead_m: within the wheel or the end. */
static double rim(const struct suspension *suspension, const struct wheel *wheel, double ahead_m,
                  double *slope)
{
    double r = suspension->radius_m, d = fabs(ahead_m);
    if (wheel->bow * ahead_m > 0.0) {
        *slope = VEHICLE_SHELL_BOW_RISE * wheel->bow;
        return VEHICLE_SHELL_BOW_RISE * d;
    }
    double left = sqrt(maths_max(r * r - d * d, 1e-9));
    *slope = maths_clamp(ahead_m / left, -STEEPEST, STEEPEST);
    return r - left;
}

/* Returns sample n of the points at which a wheel may contact. */
static double sample(const struct suspension *suspension, const struct wheel *wheel, int n)
{
    static const double share[SAMPLES] = {-0.98, -0.85, -0.6, -0.3, 0.3, 0.6, 0.85, 0.98, 1.0};
    static const double bow[SAMPLES] = {-0.85, -0.4, 0.12, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0};
    if (wheel->bow == 0.0)
        return share[n] * suspension->radius_m;
    return wheel->bow * bow[n] * (bow[n] < 0.0 ? suspension->radius_m : suspension->bow_m);
}

/* How a body stands on uneven ground. */
struct wheel_footing {
    struct vec3 ahead;      /* its heading on the map, unit */
    double level, rise, up; /* of its forward axis: the parts on the map and upwards; of its
                               upward axis: the part upwards */
};

/* Finds where a wheel touches uneven ground. */
static struct wheel_contact contact_uneven(const struct suspension *suspension,
                                           const struct wheel *wheel,
                                           const struct step_context *context, struct vec3 at,
                                           const struct wheel_footing *footing)
{
    const struct vec3 ahead = footing->ahead;
    double here = height_at(context, at.x, at.z), slope;
    double wall = maths_max(here, at.y) + suspension->reach_m;
    double east = (height_at(context, at.x + SLOPE_STEP_M, at.z) - here) / SLOPE_STEP_M;
    double south = (height_at(context, at.x, at.z + SLOPE_STEP_M) - here) / SLOPE_STEP_M;
    double steep = east * ahead.x + south * ahead.z, most = 0.0;
    if (fabs(steep) > 1.0) /* the side of an edge: its top bears the wheel */
        east = south = steep = 0.0;
    struct wheel_contact contact = {here, 0.0, normal_of(east, south)};
    for (int n = 0; n < SAMPLES; n++) {
        double d = sample(suspension, wheel, n);
        double far = d * footing->level, rise = d * footing->rise;
        double height = height_at(context, at.x + far * ahead.x, at.z + far * ahead.z);
        double plane = maths_max(rise, steep * far); /* of the body or the ground */
        double over = height - here - plane - rim(suspension, wheel, d, &slope) * footing->up;
        if (over <= most || height > wall + rise)
            continue;
        most = over;
        slope += steep;
        contact =
            (struct wheel_contact){here + over, far, normal_of(slope * ahead.x, slope * ahead.z)};
    }
    return contact;
}

static struct wheel_contact contact_plane(const struct step_context *context, struct vec3 at)
{
    double east, south;
    double height = terrain_base_plane(&context->world->terrain, at.x, at.z, &east, &south);
    return (struct wheel_contact){height, 0.0, normal_of(east, south)};
}

/* --- loads -------------------------------------------------------------------------------------*/

/* Returns the force of spring, damper and bump stop; they do not pull. */
static double force_of(const struct suspension *suspension, double squeeze_m, double closing_mps)
{
    double beyond = maths_clamp(squeeze_m - suspension->most_m, 0.0, BUMP_MOST_M);
    double pressed = maths_min(squeeze_m, suspension->most_m + beyond);
    if (closing_mps <= 0.0)
        pressed -= beyond, beyond = 0.0;
    return maths_max(0.0, suspension->spring_npm * (pressed + BUMP_STOP * beyond) +
                              suspension->damper_nspm * closing_mps);
}

/* Returns the power by which the bump stop is hit beyond what it bears without harm [W]. */
static double stop_power(const struct suspension *suspension, double squeeze_m, double closing_mps)
{
    double beyond = squeeze_m - suspension->most_m;
    if (beyond <= 0.0 || closing_mps <= HARD_MPS)
        return 0.0;
    return BUMP_STOP * suspension->spring_npm * beyond *
           (closing_mps - HARD_MPS * HARD_MPS / closing_mps);
}

/* Moves load from the less pressed wheel of each axle to the other one. Returns the sum of loads.
 */
static double roll_bars(struct suspension *suspension)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < suspension->count; i += 2) {
        struct wheel *left = &suspension->wheel[i], *right = &suspension->wheel[i + 1];
        double moved = ROLL_BAR * suspension->spring_npm * (right->squeeze_m - left->squeeze_m);
        if (left->load_n > 0.0 || right->load_n > 0.0)
            moved = maths_clamp(moved, -right->load_n, left->load_n);
        if ((moved > 0.0 && right->load_n > 0.0) || (moved < 0.0 && left->load_n > 0.0)) {
            left->load_n -= moved;
            right->load_n += moved;
        }
        sum += left->load_n + right->load_n;
    }
    return sum;
}

/* Finds how far the ground presses a wheel, and its load. */
static void press(struct suspension *suspension, struct wheel *wheel,
                  const struct step_context *context, const struct rigid_body *body,
                  const struct mat3 *turn, const struct wheel_footing *footing)
{
    const struct vec3 up = {turn->m[0][1], turn->m[1][1], turn->m[2][1]};
    const struct vec3 at = vec3_add(body->centre, wheel->arm);
    const struct wheel_contact contact =
        footing ? contact_uneven(suspension, wheel, context, at, footing)
                : contact_plane(context, at);
    double above = at.y - contact.height_m, leans = vec3_dot(up, contact.normal);
    wheel->normal = contact.normal;
    wheel->squeeze_m = wheel->load_n = wheel->stop_w = 0.0;
    if (above >= 0.0 || leans < LEANS_MOST)
        return;
    wheel->squeeze_m = -above * wheel->normal.y / leans;
    wheel->arm = vec3_add(wheel->arm, vec3_scale(up, wheel->squeeze_m));
    if (footing)
        wheel->arm = vec3_add(wheel->arm, vec3_scale(footing->ahead, contact.ahead_m));
    struct vec3 speed = vec3_add(body->velocity, vec3_cross(body->spin, wheel->arm));
    double closing = -vec3_dot(speed, wheel->normal) / leans;
    wheel->load_n = force_of(suspension, wheel->squeeze_m, closing);
    wheel->stop_w = stop_power(suspension, wheel->squeeze_m, closing);
}

double suspension_load(struct suspension *suspension, const struct step_context *context,
                       const struct rigid_body *body, const struct mat3 *turn, bool uneven)
{
    struct vec3 ahead = {turn->m[0][0], 0.0, turn->m[2][0]};
    double level = maths_max(vec3_length(ahead), 1e-9);
    const struct wheel_footing footing = {.ahead = vec3_scale(ahead, 1.0 / level),
                                          .level = level,
                                          .rise = turn->m[1][0],
                                          .up = turn->m[1][1]};
    for (uint32_t i = 0; i < suspension->count; i++) {
        struct wheel *wheel = &suspension->wheel[i];
        struct vec3 place = wheel->place;
        place.y -= body->inertia.centre_m;
        wheel->arm = rotation_apply(turn, place);
        press(suspension, wheel, context, body, turn, uneven ? &footing : NULL);
    }
    return roll_bars(suspension);
}

double suspension_grip(const struct suspension *suspension)
{
    double grip = 0.0;
    for (uint32_t i = 0; i < suspension->count; i++)
        grip += suspension->wheel[i].friction * suspension->wheel[i].load_n;
    return grip;
}
