/* Finds conflicts and the heights that resolve them. */
#include "mover/agent/aircraft_separation.h"

#include "mover/agent/avoidance.h"
#include "mover/motion/aircraft.h"
#include "mover/motion/kinematics.h"
#include "world/entity/mass_properties.h"
#include "world/state.h"
#include "world/world.h"

#define AHEAD_S       3.0   /* how far ahead it looks for conflicts */
#define SAMPLE_S      0.5   /* between two of the times at which it compares the courses */
#define SAMPLES       7u    /* of them, up to AHEAD_S */
#define SLOWEST_MPS   10.0  /* a slower one turns by its bank as at this speed */
#define STEEPEST_RAD  1.4   /* a steeper bank counts as this one */
#define BESIDE_M      8.0   /* gap at the sides */
#define OVER_M        14.0  /* gap above and below */
#define NEARING_S     1.5   /* the gap is larger by their nearing in this time */
#define SPREAD        0.15  /* how far courses stray, as a share of the way until they meet */
#define LEAD_S        1.0   /* who will be higher after this time is the higher one */
#define LEVEL_M       0.5   /* at the same height to this, the lower row is the higher one */
#define FAR_M         150.0 /* aircraft that are further above or below are in nobody's way */
#define LOW_SHARE     0.6   /* of its usual height, which it keeps above the ground */
#define LOWEST_SHARE  0.3   /* the same of one that is lower: it does not climb below another */
#define HOVER_LEVEL_M 0.25  /* between the heights at which those on hold are kept from others */
#define HOVER_ROUNDED 0.1   /* of that: so far from a height they are at it */

/* The heights [m] between which row i may fly. */
struct clearance {
    double low, high;
};

/* Where a row will be, every SAMPLE_S from now on. */
struct course {
    double x[SAMPLES], z[SAMPLES];
    double vx, vz; /* now */
};

/* Its rate of turn [rad/s] by its bank, to the right. */
static double turning_rps(const struct step_context *context, uint32_t i, double speed)
{
    const struct entities *w = &context->committed->entities;
    double most = context->world->kinds[w->row[i].kind].turn_rate_rps;
    double roll = cruise_roll(w, i, step_context_tick(context, w), context->dt_s), sine, cosine;
    maths_sincos(maths_clamp(roll, -STEEPEST_RAD, STEEPEST_RAD), &sine, &cosine);
    double rate = GRAVITY_MPS2 * sine / (cosine * maths_max(speed, SLOWEST_MPS));
    return maths_clamp(rate, -most, most);
}

/* The arc of row i if it holds this share of its bank, 0 or 1. */
static void find_course(const struct step_context *context, uint32_t i, double share,
                        struct course *course)
{
    const struct entities *w = &context->committed->entities;
    const struct vec3 at = step_context_position(context, w, i);
    const struct vec3 velocity = step_context_velocity(context, w, i);
    double speed = sqrt(velocity.x * velocity.x + velocity.z * velocity.z), sine, cosine;
    double vx = velocity.x, vz = velocity.z, x = at.x, z = at.z;
    maths_sincos(share * turning_rps(context, i, speed) * SAMPLE_S, &sine, &cosine);
    course->vx = vx;
    course->vz = vz;
    for (uint32_t n = 0; n < SAMPLES; n++) {
        course->x[n] = x;
        course->z[n] = z;
        double next_vx = vx * cosine - vz * sine, next_vz = vz * cosine + vx * sine;
        x += 0.5 * SAMPLE_S * (vx + next_vx);
        z += 0.5 * SAMPLE_S * (vz + next_vz);
        vx = next_vx;
        vz = next_vz;
    }
}

/* Returns true if the courses come near each other. */
static bool come_near(const struct course *own, const struct course *its, double beside)
{
    double vx = its->vx - own->vx, vz = its->vz - own->vz;
    double spread = SPREAD * sqrt(vx * vx + vz * vz);
    for (uint32_t n = 0; n < SAMPLES; n++) {
        double most = beside + spread * SAMPLE_S * (n > 0 ? n : 1);
        double dx = its->x[n] - own->x[n], dz = its->z[n] - own->z[n];
        if (dx * dx + dz * dz < most * most)
            return true;
    }
    return false;
}

/* The courses of the row that decides: with its bank, and when it rolls out of its turn. */
struct courses {
    struct course turning, straight;
};

/* Returns true if the other row comes near, with its bank or, of two that can hover, when both roll
 * out of their turns. Aeroplanes hold theirs for longer. */
static bool meets(const struct step_context *context, uint32_t i, uint32_t other,
                  const struct courses *own)
{
    const struct entities *w = &context->committed->entities;
    const double *reach = context->avoidance->reach_m;
    const struct kind *kinds = context->world->kinds;
    bool nimble = kind_hovers(&kinds[w->row[i].kind]) && kind_hovers(&kinds[w->row[other].kind]);
    double beside = reach[w->row[i].kind] + reach[w->row[other].kind] + BESIDE_M;
    struct course its;
    find_course(context, other, 1.0, &its);
    if (come_near(&own->turning, &its, beside))
        return true;
    if (!nimble)
        return false;
    find_course(context, other, 0.0, &its);
    return come_near(&own->straight, &its, beside);
}

static void keep_from(const struct step_context *context, uint32_t i, uint32_t other,
                      const struct courses *own, struct clearance *clear)
{
    const struct entities *w = &context->committed->entities;
    const struct kind *kinds = context->world->kinds;
    double its_y = step_context_position(context, w, other).y, up = w->row[i].y - its_y;
    double its_vy = step_context_velocity(context, w, other).y;
    if (fabs(up) > FAR_M || !meets(context, i, other, own))
        return;
    double soon = up + LEAD_S * (w->row[i].vy - its_vy);
    bool above = fabs(soon) > LEVEL_M ? soon > 0.0 : i < other;
    double gap =
        0.5 * (kinds[w->row[i].kind].height_m + kinds[w->row[other].kind].height_m) + OVER_M;
    double nearing = up > 0.0 ? its_vy - w->row[i].vy : w->row[i].vy - its_vy;
    gap += NEARING_S * maths_max(nearing, 0.0);
    double middle = 0.5 * (w->row[i].y + its_y);
    if (above)
        clear->low = maths_max(clear->low, its_y + gap);
    else
        clear->high = maths_min(clear->high, middle - 0.5 * gap);
}

double aircraft_separation_reach(const struct step_context *context, uint32_t kind,
                                 double speed_mps)
{
    return 2.0 * AHEAD_S * speed_mps + 2.0 * context->avoidance->reach_m[kind] + AHEAD_S * BESIDE_M;
}

static void look_around(const struct step_context *context, uint32_t i, struct clearance *clear)
{
    const struct entities *w = &context->committed->entities;
    double speed = sqrt(w->row[i].vx * w->row[i].vx + w->row[i].vz * w->row[i].vz);
    double radius = aircraft_separation_reach(context, w->row[i].kind, speed);
    struct courses own;
    find_course(context, i, 1.0, &own.turning);
    find_course(context, i, 0.0, &own.straight);
    float x = (float)w->row[i].x, y = (float)w->row[i].y, z = (float)w->row[i].z;
    float square = (float)(radius * radius);
    struct neighbour_query query = neighbour_query_begin(
        context->neighbours, NEIGHBOUR_INDEX_LIVING, w->row[i].x, w->row[i].z, radius);
    while (neighbour_query_next_span(&query)) {
        for (const struct neighbour_index_entry *at = query.at; at < query.end; at++) {
            float dx = at->x - x, dz = at->z - z;
            if ((fabsf(at->y - y) <= (float)FAR_M + 1.0f) & (dx * dx + dz * dz <= square) &&
                at->row != i && context->world->kinds[at->kind].domain == DOMAIN_AIR)
                keep_from(context, i, at->row, &own, clear);
        }
    }
}

/* Two that hover see each other where they are, with small errors. Without levels they would follow
 * these for ever. */
static void keep_levels(struct clearance *clear)
{
    clear->low = -floor(HOVER_ROUNDED - clear->low / HOVER_LEVEL_M) * HOVER_LEVEL_M;
    clear->high = floor(clear->high / HOVER_LEVEL_M + HOVER_ROUNDED) * HOVER_LEVEL_M;
}

double aircraft_separation_keep(const struct step_context *context, uint32_t i,
                                struct desired_motion *desired)
{
    struct clearance clear = {-INFINITY, INFINITY};
    look_around(context, i, &clear);
    if (clear.low == -INFINITY && clear.high == INFINITY)
        return INFINITY;
    if (kinematics_parked(context->m, i))
        keep_levels(&clear);
    double usual = context->world->kinds[context->m->row[i].kind].cruise_altitude_m;
    double ground = aircraft_ground(context, i), height = desired->altitude_m;
    /* Between two it goes up: the higher one goes up, too, and the lower one may be near the
     * ground. */
    height = maths_max(maths_min(height, clear.high - ground), clear.low - ground);
    double low =
        maths_clamp(context->m->row[i].y - ground, LOWEST_SHARE * usual, LOW_SHARE * usual);
    desired->altitude_m = maths_max(height, maths_min(desired->altitude_m, low));
    return clear.high < INFINITY ? desired->altitude_m : INFINITY;
}
