/* Finds conflicts and the heights that resolve them. */
#include "mover/agent/aircraft_separation.h"

#include "mover/agent/avoidance.h"
#include "mover/motion/kinematics.h"
#include "world/entity/mass_properties.h"
#include "world/state.h"
#include "world/world.h"

#define AHEAD_S       4.0   /* how far ahead it looks for conflicts */
#define SAMPLE_S      0.5   /* between two of the times at which it compares the courses */
#define STEEPEST_RAD  1.4   /* a steeper bank counts as this one */
#define BESIDE_M      8.0   /* gap at the sides */
#define OVER_M        14.0  /* gap above and below */
#define NEARING_S     1.5   /* the gap is larger by their nearing in this time */
#define SPREAD        0.15  /* how far courses stray, as a share of the way until they meet */
#define LEAD_S        0.5   /* who will be higher after this time is the higher one */
#define LEVEL_M       0.5   /* at the same height to this, the lower row is the higher one */
#define FAR_M         150.0 /* aircraft that are further above or below are in nobody's way */
#define LOW_SHARE     0.6   /* of its usual height, which it keeps above the ground */
#define HOVER_LEVEL_M 0.25  /* between the heights at which those on hold are kept from others */
#define HOVER_ROUNDED 0.1   /* of that: so far from a height they are at it */
#define GROUND_S      3.0   /* flight keeps its height above the ground here and after this time */

/* Ground that an aeroplane looks at: every LOOK_S along its course, LOOKS times. */
#define LOOK_S      2.5
#define LOOKS       12
#define CLEAR_SHARE 0.5 /* of the height that it wants, over the ground ahead */
#define CLIMB_SHARE 0.3 /* of its speed: so fast it climbs for a long time */
#define RATE_SHARE  0.5 /* and of its kind's rate of climb */
#define FOLLOW_PS   0.8 /* its climb, for each metre that it is too low (mover/motion/aircraft.c) */
#define MOST_TURN   PI  /* it looks no further around a turn */

/* The heights [m] between which row i may fly. */
struct clearance {
    double low, high;
};

/* Its acceleration [m/s2] towards its right in a turn, by its bank. */
static double turning_mps2(const struct step_context *context, const struct entities *w, uint32_t i)
{
    double roll = cruise_roll(w, i, step_context_tick(context, w), context->dt_s), sine, cosine;
    maths_sincos(maths_clamp(roll, -STEEPEST_RAD, STEEPEST_RAD), &sine, &cosine);
    return GRAVITY_MPS2 * sine / cosine;
}

/* The course of row i: where it will be if it holds its bank. */
struct course {
    double x, z, vx, vz, ax, az;
};

static struct course course_of(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    const struct vec3 at = step_context_position(context, w, i);
    const struct vec3 velocity = step_context_velocity(context, w, i);
    double right = turning_mps2(context, w, i), sine, cosine;
    maths_sincos(step_context_heading(context, w, i), &sine, &cosine);
    return (struct course){at.x, at.z, velocity.x, velocity.z, right * cosine, right * sine};
}

/* Returns true if the courses come near each other within AHEAD_S. share: how much of their banks
 * they hold, 0 or 1. */
static bool come_near(const struct course *own, const struct course *its, double beside,
                      double share)
{
    double vx = its->vx - own->vx, vz = its->vz - own->vz;
    double spread = SPREAD * sqrt(vx * vx + vz * vz);
    for (uint32_t n = 0; n * SAMPLE_S <= AHEAD_S; n++) {
        double t = n * SAMPLE_S, half = 0.5 * share * t * t;
        double most = beside + spread * maths_max(t, SAMPLE_S);
        double dx = its->x - own->x + vx * t + (its->ax - own->ax) * half;
        double dz = its->z - own->z + vz * t + (its->az - own->az) * half;
        if (dx * dx + dz * dz < most * most)
            return true;
    }
    return false;
}

/* Returns true if the other row comes near, with its bank or, of two that can hover, when both roll
 * out of their turns. Aeroplanes hold theirs for longer. */
static bool meets(const struct step_context *context, uint32_t i, uint32_t other,
                  const struct course *own)
{
    const struct entities *w = &context->committed->entities;
    const double *reach = context->avoidance->reach_m;
    const struct kind *kinds = context->world->kinds;
    const struct course its = course_of(context, other);
    bool nimble = kind_hovers(&kinds[w->kind[i]]) && kind_hovers(&kinds[w->kind[other]]);
    double beside = reach[w->kind[i]] + reach[w->kind[other]] + BESIDE_M;
    return come_near(own, &its, beside, 1.0) || (nimble && come_near(own, &its, beside, 0.0));
}

static void keep_from(const struct step_context *context, uint32_t i, uint32_t other,
                      const struct course *own, struct clearance *clear)
{
    const struct entities *w = &context->committed->entities;
    const struct kind *kinds = context->world->kinds;
    double its_y = step_context_position(context, w, other).y, up = w->y[i] - its_y;
    double its_vy = step_context_velocity(context, w, other).y;
    if (fabs(up) > FAR_M || !meets(context, i, other, own))
        return;
    double soon = up + LEAD_S * (w->vy[i] - its_vy);
    bool above = fabs(soon) > LEVEL_M ? soon > 0.0 : i < other;
    double gap = 0.5 * (kinds[w->kind[i]].height_m + kinds[w->kind[other]].height_m) + OVER_M;
    double nearing = up > 0.0 ? its_vy - w->vy[i] : w->vy[i] - its_vy;
    gap += NEARING_S * maths_max(nearing, 0.0);
    double middle = 0.5 * (w->y[i] + its_y);
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
    double speed = sqrt(w->vx[i] * w->vx[i] + w->vz[i] * w->vz[i]);
    double radius = aircraft_separation_reach(context, w->kind[i], speed);
    const struct course own = course_of(context, i);
    float x = (float)w->x[i], y = (float)w->y[i], z = (float)w->z[i];
    float square = (float)(radius * radius);
    struct neighbour_query query = neighbour_query_begin(
        context->neighbours, NEIGHBOUR_INDEX_LIVING, w->x[i], w->z[i], radius);
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

/* The ground [m] above which it holds its height. */
static double ground_under(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double here = kinematics_ground(context, m->x[i], m->z[i]);
    return maths_max(here, kinematics_ground(context, m->x[i] + GROUND_S * m->vx[i],
                                             m->z[i] + GROUND_S * m->vz[i]));
}

void aircraft_separation_keep(const struct step_context *context, uint32_t i,
                              struct desired_motion *desired)
{
    struct clearance clear = {-INFINITY, INFINITY};
    look_around(context, i, &clear);
    if (clear.low == -INFINITY && clear.high == INFINITY)
        return;
    if (kinematics_parked(context->m, i))
        keep_levels(&clear);
    double usual = context->world->kinds[context->m->kind[i]].cruise_altitude_m;
    double ground = ground_under(context, i), height = desired->altitude_m;
    /* Between two it goes up: the higher one goes up, too, and the lower one may be near the
     * ground. */
    height = maths_max(maths_min(height, clear.high - ground), clear.low - ground);
    desired->altitude_m = maths_max(height, maths_min(desired->altitude_m, LOW_SHARE * usual));
}

/* Returns the rate [m/s] at which row i must climb to be clear_m over each point of its course. */
static double needed_climb(const struct step_context *context, uint32_t i, double clear_m)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    const double side_m = context->world->terrain.squares.world_m;
    double speed = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]), rate = -INFINITY;
    double turn = (double)m->steer[i] * kind->turn_rate_rps * LOOK_S;
    double heading = maths_heading(m->vx[i], m->vz[i]), x = m->x[i], z = m->z[i], sine, cosine;
    for (uint32_t n = 1; n <= LOOKS && fabs(turn) * n <= MOST_TURN; n++) {
        maths_sincos(heading + (n - 0.5) * turn, &sine, &cosine);
        x = maths_clamp(x + sine * speed * LOOK_S, 0.0, side_m);
        z = maths_clamp(z - cosine * speed * LOOK_S, 0.0, side_m);
        double over = kinematics_ground(context, x, z) + clear_m - m->y[i];
        rate = maths_max(rate, over / (n * LOOK_S));
    }
    return rate;
}

void aircraft_separation_clear_ground(const struct step_context *context, uint32_t i,
                                      struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double speed = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
    double lasting = maths_min(CLIMB_SHARE * speed, RATE_SHARE * kind->climb_rate_mps);
    double needed = needed_climb(context, i, CLEAR_SHARE * desired->altitude_m);
    if (needed <= 0.5 * lasting)
        return;
    /* From half of what it can to all of it the climb begins evenly. */
    double rate = maths_min(2.0 * needed - lasting, kind->climb_rate_mps);
    double height = m->y[i] - ground_under(context, i) + rate / FOLLOW_PS;
    desired->altitude_m = maths_max(desired->altitude_m, height);
}
