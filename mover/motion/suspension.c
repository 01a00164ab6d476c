/* Places of wheels, and their loads by rays. */
#include "mover/motion/suspension.h"

#include "world/terrain/terrain.h"
#include "world/world.h"

#define DAMPING       0.35 /* share of the critical damping */
#define BUMP_STOP     10.0 /* stiffness of the bump stop over that of the spring */
#define ROLL_BAR      0.75 /* of an axle: stiffness against roll over that of a spring */
#define WHEELBASE     0.68 /* between the outer axles over the length */
#define TRACK_LENGTH  0.58 /* of a track on the ground over the length */
#define TANDEM_M      1.2  /* between the axles of a tandem, at most */
#define HARD_MPS      2.0  /* a bump stop that is hit more slowly takes no harm */
#define LEANS_MOST    0.3  /* cosine: a wheel whose ray is flatter to the ground bears nothing */
#define CRATER_STEP_M 0.1  /* between the heights that give the slope of a crater */

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

void suspension_of(const struct kind *kind, struct suspension *suspension)
{
    double rate = TWO_PI * kind->heave_hz, count = 2.0 * kind->axles;
    double length = kind->length_m * (kind->tracked ? TRACK_LENGTH : WHEELBASE);
    suspension->count = 2 * kind->axles;
    suspension->sag_m = GRAVITY_MPS2 / (rate * rate);
    suspension->most_m = suspension->sag_m + kind->travel_m;
    suspension->spring_npm = kind->mass_kg * rate * rate / count;
    suspension->damper_nspm = 2.0 * DAMPING * kind->mass_kg * rate / count;
    suspension->ground_m = length;
    for (uint32_t i = 0; i < suspension->count; i++) {
        struct wheel *wheel = &suspension->wheel[i];
        wheel->side = i & 1 ? 1.0 : -1.0;
        wheel->steers = !kind->tracked && i < 2;
        wheel->place = (struct vec3){axle_place(kind, i / 2, length), -suspension->sag_m,
                                     0.5 * wheel->side * kind->track_m};
    }
    double front = suspension->wheel[0].place.x;
    suspension->wheelbase_m = front * kind->axles / (kind->axles - 1);
}

/* Returns the height of the ground and its upward normal. */
static double ground_at(const struct step_context *context, bool cratered, double x, double z,
                        struct vec3 *normal)
{
    double east, south;
    double height = terrain_base_plane(&context->world->terrain, x, z, &east, &south);
    if (cratered) {
        const struct crater_index *craters = context->craters;
        double dug = crater_offset(craters, x, z);
        east += (crater_offset(craters, x + CRATER_STEP_M, z) - dug) / CRATER_STEP_M;
        south += (crater_offset(craters, x, z + CRATER_STEP_M) - dug) / CRATER_STEP_M;
        height += dug;
    }
    *normal = vec3_scale((struct vec3){-east, 1.0, -south},
                         1.0 / sqrt(1.0 + east * east + south * south));
    return height;
}

/* Returns the force of spring, damper and bump stop; they do not pull. */
static double force_of(const struct suspension *suspension, double squeeze_m, double closing_mps)
{
    double beyond = maths_max(0.0, squeeze_m - suspension->most_m);
    return maths_max(0.0, suspension->spring_npm * (squeeze_m + BUMP_STOP * beyond) +
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

double suspension_load(struct suspension *suspension, const struct step_context *context,
                       const struct rigid_body *body, const struct mat3 *turn, bool cratered)
{
    const struct vec3 up = {turn->m[0][1], turn->m[1][1], turn->m[2][1]};
    for (uint32_t i = 0; i < suspension->count; i++) {
        struct wheel *wheel = &suspension->wheel[i];
        struct vec3 place = wheel->place;
        place.y -= body->inertia.centre_m;
        wheel->arm = rotation_apply(turn, place);
        struct vec3 at = vec3_add(body->centre, wheel->arm);
        double above = at.y - ground_at(context, cratered, at.x, at.z, &wheel->normal);
        double leans = vec3_dot(up, wheel->normal);
        wheel->squeeze_m = wheel->load_n = wheel->stop_w = 0.0;
        if (above >= 0.0 || leans < LEANS_MOST)
            continue;
        wheel->squeeze_m = -above * wheel->normal.y / leans;
        wheel->arm = vec3_add(wheel->arm, vec3_scale(up, wheel->squeeze_m));
        struct vec3 speed = vec3_add(body->velocity, vec3_cross(body->spin, wheel->arm));
        double closing = -vec3_dot(speed, wheel->normal) / leans;
        wheel->load_n = force_of(suspension, wheel->squeeze_m, closing);
        wheel->stop_w = stop_power(suspension, wheel->squeeze_m, closing);
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
